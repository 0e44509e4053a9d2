// Drawing in the browser, in the page that trame serves: a Vue component around a viewer, whose client
// is loaded when it is first needed. flowtex/app/controllers/browser.py is the other side.

import type { CameraState } from "../camera.ts";
import type * as Client from "../client.ts";
import { throttled } from "../lifetime.ts";
import type { Options } from "../options.ts";
import { placeIn } from "../pointers.ts";
import type { Header, Settings } from "../protocol.ts";
import { loadFiles } from "../sources/files.ts";
import type { Viewer } from "../viewer.ts";
import { vue, type Emit } from "./vue.ts";

/** Milliseconds between two messages to the server. */
const MESSAGE_MS = 100;

/** Where the client is found, the scene's header, and the address of its parts before their names. */
interface Scene {
  client: string;
  header: Header;
  parts: string;
}

interface Props {
  source: Scene;
  settings: Settings;
  camera: CameraState | null;
  time: number;
  playing: boolean;
}

const PROPS = ["source", "settings", "camera", "time", "playing"] as const;

const isEqual = (a: unknown, b: unknown) => JSON.stringify(a) === JSON.stringify(b);
const slowly = <T>(call: (value: T) => void) => throttled<T>(setTimeout, MESSAGE_MS, call);

/** A viewer in the page, with the camera and the time that it sent last. */
class BrowserView {
  private readonly props: Props;
  private readonly emit: Emit;
  private client: typeof Client | null = null;
  private viewer: Viewer | null = null;
  private lastCamera: CameraState | null = null;
  private lastTime = NaN;
  private isDisposed = false;
  private started = 0;
  private readonly load = loadFiles(
    () => this.props.source.parts,
    (file) => this.client?.partsOfFile(file) ?? [],
  );
  private readonly watcher = new MutationObserver(() => this.look());

  constructor(props: Props, emit: Emit) {
    this.props = props;
    this.emit = emit;
  }

  async begin(element: HTMLElement): Promise<void> {
    const address = new URL(this.props.source.client, document.baseURI).href;
    this.client = (await import(address)) as typeof Client;
    if (this.isDisposed) return;
    const viewer = new this.client.Viewer(element, this.options());
    this.viewer = viewer;
    viewer.root.style.height = "100%";
    this.watcher.observe(viewer.root, { attributeFilter: ["data-sharp"] });
    await this.show();
  }

  private options(): Options {
    const { emit } = this;
    const sendCamera = slowly((camera) => emit("update:camera", camera));
    const sendTime = slowly((time) => emit("update:time", time));
    return {
      rebuild: true,
      controls: false,
      bare: true,
      onCamera: (camera) => sendCamera((this.lastCamera = camera)),
      onTime: (time) => sendTime((this.lastTime = time)),
      onPlaying: (playing) => emit("update:playing", playing),
      // Triangles have other numbers at each level.
      onPoint: ({ index, position }) =>
        emit("point", this.viewer?.header?.geometry.triangles ? position : [...index]),
      onSetting: (name, value) => emit("setting", [name, value]),
      source: { load: this.load, hasSteps: true },
    };
  }

  async show(): Promise<void> {
    const { source, playing } = this.props;
    this.started = performance.now();
    this.viewer?.setHeader(source.header);
    for (const part of await this.load(null, [])) if (!this.isDisposed) this.viewer?.setPart(part);
    if (playing) this.viewer?.play();
  }

  /** Tell how long the full picture took. */
  private look(): void {
    const now = performance.now();
    if (this.viewer?.sharp) this.emit("sharp", now - this.started);
    else this.started = now;
  }

  /** Take over a property that has changed; what the viewer sent itself comes back as well. */
  take(name: keyof Props): void {
    const { viewer, lastCamera, lastTime } = this;
    const { settings, camera, time, playing } = this.props;
    if (!viewer) return;
    const takers: Record<keyof Props, () => void> = {
      source: () => void this.show(),
      settings: () => viewer.setSettings(settings),
      camera: () => camera && !isEqual(camera, lastCamera) && viewer.setCamera(camera),
      time: () => time !== lastTime && !viewer.playing && viewer.setTime(time),
      playing: () => (playing ? viewer.play() : viewer.pause()),
    };
    takers[name]();
  }

  dispose(): void {
    this.isDisposed = true;
    this.watcher.disconnect();
    this.viewer?.dispose();
  }
}

export const browser = {
  name: "flowtex-client",
  props: PROPS,
  emits: ["update:camera", "update:time", "update:playing", "setting", "sharp", "point", "hover"],
  setup(props: Props, { emit }: { emit: Emit }) {
    const { h, ref, watch, onMounted, onBeforeUnmount } = vue();
    const place = ref<HTMLElement | null>(null);
    const view = new BrowserView(props, emit);
    onMounted(() => place.value && void view.begin(place.value));
    onBeforeUnmount(() => view.dispose());
    const follow = (name: keyof Props) => watch(() => props[name], () => view.take(name));
    PROPS.forEach(follow);
    const sendHover = slowly<[number, number] | null>((at) => emit("hover", at));
    const onPointermove = (event: PointerEvent) => {
      if (!place.value) return;
      const { x, y } = placeIn(place.value, event);
      sendHover(event.buttons ? null : [x, y]);
    };
    const onPointerleave = () => sendHover(null);
    return () => h("div", { ref: place, onPointermove, onPointerleave });
  },
};
