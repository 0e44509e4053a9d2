// The view of the page that trame serves: a Vue component around <flowtex-view>, whose module is loaded
// beside the page. flowtex/app/streaming/element.py is the other side.
//
// Without a graphics card, or if the user chooses so, the server draws: its pictures come by the
// stream of trame-rca, whose events the view does not need, as it moves the camera by itself.

import type { CameraState } from "../camera.ts";
import { drawsFloats } from "../context.ts";
import type * as Client from "../core.ts";
import type { FlowtexView } from "../element.ts";
import { forwardKeys } from "../keyboard.ts";
import { throttled } from "../lifetime.ts";
import type { Options, Reader, Reading } from "../options.ts";
import type { Header, Settings } from "../protocol.ts";
import { loadFiles } from "../sources/source.ts";
import type { Viewer } from "../viewer.ts";
import { trame, vue, type Emit } from "./vue.ts";

/** Milliseconds between two messages to the server, while it draws and while it does not. */
const DRAWN_MS = 33;
const MESSAGE_MS = 100;
/** Milliseconds in which the scene arrives that replaces one whose parts the server has withdrawn. */
const SUCCESSOR_MS = 1500;
/** Pixels between two panes of a picture. */
const GAP_PX = 2;
const STREAM = "trame.rca.topic.stream";

type Painter = "server" | "browser";

/** A scene's header, and the address of its parts before their names. */
interface Handed {
  header: Header;
  parts: string;
}

/**
 * What may change from one moment to the next; a camera of null sees the whole surface. Of what one page
 * says, named in `by`, the others hear, such as the frames of a notebook.
 */
interface Present {
  by: string;
  scenes: Handed[];
  settings: Settings;
  camera: CameraState | null;
  time: number;
  timeBeside: number | null;
  clock: number;
  playing: boolean;
}

/** What a page needs to begin: the same, where the client is found, and the name of the stream. */
interface Beginning extends Present {
  client: string;
  area: string;
}

interface Frame {
  name: string;
  meta: { w: number; h: number; type: string; sharp: boolean; number: number };
  content: Blob | Uint8Array<ArrayBuffer>;
}

interface Props {
  /** Names of what the server is asked to begin, and to read a point. */
  begin: string;
  read: string;
}

const session = () => trame().client.getConnection().getSession();

/** Names of what draws on the processor; VTK beside the server's data does so several times as fast. */
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
/** Under which a page keeps whom a person lets draw. */
const CHOICE = "flowtex painter";

/** Who draws best: the browser, where it has WebGL2 and a graphics card. */
export function bestPainter(): Painter {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl || !drawsFloats(gl)) return "server";
  const name = gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER;
  return SOFTWARE.test(String(gl.getParameter(name))) ? "server" : "browser";
}

/** Whom a person lets draw, also after the page is loaded again. */
function chosen(painter?: Painter): Painter | null {
  try {
    if (painter) sessionStorage.setItem(CHOICE, painter);
    return sessionStorage.getItem(CHOICE) as Painter | null;
  } catch {
    return painter ?? null; // a frame may be refused a storage
  }
}

class TrameView {
  private readonly props: Props;
  private readonly emit: Emit;
  private readonly element: HTMLElement;
  private readonly name = Math.random().toString(36).slice(2);
  private readonly ended = new AbortController();
  private client: typeof Client | null = null;
  private view: FlowtexView | null = null;
  private painter: Painter = "browser";
  private scenes: Handed[] = [];
  /** Numbers of the scenes whose parts each view has. */
  private loaded: (number | undefined)[] = [];
  private area = "";
  /** Size of the picture that the server was asked for. */
  private size = "";
  private early: Partial<Present>[] | null = null;
  /** Pictures that came, and the number of the one that is shown. */
  private came = 0;
  private shown = 0;
  private subscription: unknown = null;
  private readonly watcher = new ResizeObserver(() => this.resize());

  constructor(props: Props, emit: Emit, element: HTMLElement) {
    this.props = props;
    this.emit = emit;
    this.element = element;
    const listener = (event: KeyboardEvent) => this.view && forwardKeys(this.view.first.root, event);
    document.addEventListener("keydown", listener, { signal: this.ended.signal });
  }

  /** Begin, or continue with a painter that the user chooses. */
  async paint(painter?: Painter): Promise<void> {
    this.painter = chosen(painter) ?? bestPainter();
    const start = (await trame().trigger(this.props.begin, [this.painter])) as Beginning;
    // What changes from here on, before there is a view, is taken over then.
    const early = (this.early = []);
    const address = new URL(start.client, document.baseURI).href;
    this.client ??= (await import(address)) as typeof Client;
    if (this.ended.signal.aborted) return;
    this.area = start.area;
    this.size = "";
    this.subscription ??= session().subscribe(STREAM, ([frame]) => void this.takeFrame(frame as Frame));
    this.view?.dispose();
    this.view?.remove();
    const view = (this.view = new this.client.FlowtexView());
    view.options = this.options();
    this.connect(view);
    this.element.append(view);
    this.scenes = [];
    this.early = null;
    await Promise.all([start, ...early].map((changes) => this.take(changes)));
  }

  private options(): Options {
    return {
      rebuild: true,
      named: true,
      streamed: this.painter === "server",
      onColours: (choice) => this.tell("colours", choice),
    };
  }

  private connect(view: FlowtexView): void {
    const wait = this.painter === "server" ? DRAWN_MS : MESSAGE_MS;
    for (const name of ["camera", "time", "clock"]) {
      const send = throttled<[value: unknown, place?: number]>(setTimeout, wait, (said) => this.tell(name, ...said));
      view.addEventListener(name, (event) => send([(event as CustomEvent).detail, view.first?.header?.place]));
    }
    for (const name of ["playing", "setting"]) {
      view.addEventListener(name, (event) => this.tell(name, (event as CustomEvent).detail));
    }
  }

  /** Report a value, and of which place it is, as the server may show another one meanwhile. */
  private tell(name: string, value: unknown, place: number | null = null): void {
    this.emit(name, { value, page: this.name, place });
  }

  /** Take over what has changed on the server; also called by it. */
  async take(changes: Partial<Present>): Promise<void> {
    const { view, early } = this;
    if (early) return void early.push(changes);
    if (!view || changes.by === this.name) return;
    const { scenes, settings, camera, time, timeBeside, clock, playing } = changes;
    const loading = scenes && this.show(scenes);
    const { viewers, first } = view;
    const isStill = !first.playing;
    for (const viewer of viewers) {
      for (const [name, value] of Object.entries(settings ?? {})) viewer.followSetting(name, value);
      if (camera !== undefined) viewer.setCamera(camera);
      if (time !== undefined && isStill) viewer.followTime(time);
      if (clock !== undefined && isStill) viewer.setClock(clock);
    }
    if (typeof timeBeside === "number") viewers[1]?.setTime(timeBeside);
    if (playing === true) first.play();
    else if (playing === false) first.pause();
    await loading;
  }

  private async show(scenes: Handed[]): Promise<void> {
    const { view, scenes: before } = this;
    if (!view) return;
    this.scenes = scenes;
    const loads = scenes.map((_, n) => this.load(n));
    if (before.length !== scenes.length) {
      this.loaded = [];
      view.open(scenes.length, (n) => ({
        reader: this.reader(n),
        source: this.painter === "browser" ? { load: loads[n], hasSteps: true, hasMarks: true } : undefined,
      }));
      this.watcher.disconnect();
      for (const { stage } of view.viewers) this.watcher.observe(stage);
    }
    const fill = async (viewer: Viewer, n: number) => {
      const { generation } = scenes[n].header;
      const isThere = this.loaded[n] === generation;
      const name = this.painter === "server" ? "controls" : isThere ? "colours" : undefined;
      viewer.setHeader(scenes[n].header);
      try {
        const parts = await loads[n](null, [], undefined, undefined, name);
        if (this.scenes !== scenes) return;
        if (!name) viewer.keepParts(parts.map((part) => part.name));
        for (const part of parts) viewer.setPart(part);
        this.loaded[n] = generation;
      } catch (error) {
        // Of a scene that is not shown any more there is nothing to be had.
        if (this.scenes === scenes) viewer.panel.fail("The flow could not be loaded.", String(error));
      }
      // The server sends its full picture again, if that came before the change.
      if (this.painter === "server" && viewer.sharp) this.size = "";
      viewer.change();
    };
    const filled = view.viewers.map(fill);
    this.resize();
    await Promise.all(filled);
    this.resize();
  }

  private load(n: number) {
    const address = () => this.scenes[n]?.parts ?? "";
    const load = loadFiles(address, (file) => this.client?.partsOfFile(file) ?? []);
    return async (...request: Parameters<typeof load>) => {
      const asked = address();
      try {
        return await load(...request);
      } catch (error) {
        if (!request[1].length) throw error;
        // The server has withdrawn the parts of a scene whose successor is on its way.
        await new Promise((resolve) => setTimeout(resolve, asked === address() ? SUCCESSOR_MS : 0));
        if (asked === address()) throw error;
        return [];
      }
    };
  }

  private reader(n: number): Reader {
    return (at, path) => {
      const time = this.view?.viewers[n]?.player.time;
      return trame().trigger(this.props.read, [n, { ...at, path, time }]) as Promise<Reading | null>;
    };
  }

  /** Send the size of the picture of all views. */
  private resize(): void {
    const { view, area } = this;
    if (!view?.viewers.length || !area) return;
    view.first.resize();
    const { width, height } = view.first.canvas;
    const count = view.viewers.length;
    const size = { w: count * width + (count - 1) * GAP_PX, h: height, p: 1 };
    // A size that comes again has the server draw again.
    const text = JSON.stringify(size);
    if (text === this.size) return;
    this.size = text;
    void session().call("trame.rca.size", [area, "view", size]);
  }

  /** Show a picture, unless a later one has been decoded before it. */
  private async takeFrame({ name, meta, content }: Frame): Promise<void> {
    if (name !== this.area || this.painter !== "server") return;
    const number = (this.came += 1);
    const picture = await createImageBitmap(new Blob([content], { type: meta.type }));
    // The server waits for this before it sends further ones.
    const seconds = performance.now() / 1000;
    void session().call("trame.rca.event", [name, this.name, { number: meta.number, seconds }]);
    if (number < this.shown || this.painter !== "server") return;
    this.shown = number;
    const { view } = this;
    const whole = (view?.viewers.length ?? 1) * (view?.first.canvas.width ?? 1);
    view?.paint(picture, Math.max(Math.round((GAP_PX * picture.width) / whole), 1), meta.sharp);
    picture.close();
  }

  dispose(): void {
    this.ended.abort();
    this.watcher.disconnect();
    if (this.subscription) session().unsubscribe(this.subscription);
    this.view?.dispose();
  }
}

export const browser = {
  name: "flowtex-client",
  props: ["begin", "read"],
  emits: ["camera", "time", "clock", "playing", "setting", "colours"],
  setup(props: Props, { emit, expose }: { emit: Emit; expose: (methods: object) => void }) {
    const { h, ref, onMounted, onBeforeUnmount } = vue();
    const place = ref<HTMLElement | null>(null);
    let view: TrameView | null = null;
    onMounted(() => {
      if (!place.value) return;
      view = new TrameView(props, emit, place.value);
      void view.paint();
    });
    onBeforeUnmount(() => view?.dispose());
    expose({
      take: (changes: Partial<Present>) => void view?.take(changes),
      paint: (painter: Painter) => void view?.paint(painter),
    });
    return () => h("div", { ref: place });
  },
};
