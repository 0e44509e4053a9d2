// The notebook widget: what anywidget calls. flowtex/host/flow_widget.py is the other side; traits hold the state of
// the view, messages carry arrays.

import type { CameraState } from "./camera.ts";
import { sharedGraphics } from "./context.ts";
import { pictureOf } from "./dom.ts";
import { FlowtexView } from "./element.ts";
import { throttled, type Timer } from "./lifetime.ts";
import { decoded, type AxesKind, type Header, type NamedPart, type PartInfo, type Value } from "./protocol.ts";
import { Messages, type Loaded } from "./sources/source.ts";
import type { Viewer } from "./viewer.ts";

/** Milliseconds between two messages about the camera, and about the time. */
const CAMERA_MS = 100;
const TIME_MS = 250;
/** Milliseconds that a picture stands before the kernel gets it as the still of a saved notebook. */
const STILL_MS = 1500;
const STILL_FORMAT = { type: "image/jpeg", quality: 0.9 };
/** Traits with the headers of the views. */
const HEADERS = ["_header", "_header_beside"];
/** In a row of boxes a view takes the room that the others leave. */
const ROOM = ".flowtex-room { width: 100%; min-width: 160px; flex: 0 9999 auto }";
/** Height of the picture where the widget has none, in pixels. */
const HEIGHT_PX = 480;

type Handler = (...values: never[]) => void;

export interface Model {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  save_changes(): void;
  on(event: string, call: Handler): void;
  off(event: string, call: Handler): void;
  send(content: unknown, callbacks?: unknown, buffers?: ArrayBuffer[]): void;
}

/** A message of the kernel: `parts` come with it, or a request has been `loaded`. */
interface Message extends Partial<Omit<Loaded, "kind">> {
  kind: "parts" | "loaded" | "error";
  view?: number;
  generation?: number;
  parts?: PartInfo[];
  text?: string;
}

/** The parts of a message, which the page keeps until they are taken. */
interface Delivery {
  view: number;
  generation: number;
  parts: NamedPart[];
}

function opened(message: Message, buffers: ArrayBufferView[]): Delivery {
  const graphics = sharedGraphics();
  const { view = 0, generation = 0, parts: infos = [] } = message;
  const delivery: Delivery = { view, generation, parts: [] };
  infos.forEach((info, n) => {
    const part = graphics.hold(graphics.stock.get(info.digest)?.part ?? decoded(info, buffers[n]));
    delivery.parts.push({ ...part, name: info.name });
  });
  return delivery;
}

function discard(deliveries: Delivery[]): void {
  for (const { parts } of deliveries) for (const part of parts) sharedGraphics().release(part);
}

/** Deliveries that came before there was a view, by the widget's key. */
const mailbox = new Map<unknown, Delivery[]>();

/**
 * What anywidget calls for each widget: arrays come as soon as the kernel has them, while the cell
 * that shows the widget may still be running.
 */
export function initialize({ model }: { model: Model }): () => void {
  const key = model.get("_key");
  mailbox.set(key, []);
  const receive = (message: Message, buffers: ArrayBufferView[]) => {
    if (message?.kind === "parts") mailbox.get(key)?.push(opened(message, buffers));
  };
  model.on("msg:custom", receive);
  return () => {
    model.off("msg:custom", receive);
    discard(mailbox.get(key) ?? []);
    mailbox.delete(key);
  };
}

/** What anywidget calls for each view of a widget. */
export function render({ model, el }: { model: Model; el: HTMLElement }): () => void {
  const view = new WidgetView(model, el);
  return () => view.dispose();
}

/** A camera, or null where a host has none yet. */
function cameraOf(state: unknown): CameraState | null {
  const camera = state as CameraState | null | undefined;
  return camera && Array.isArray(camera.position) ? camera : null;
}

class WidgetView {
  private readonly model: Model;
  private readonly view = new FlowtexView();
  private readonly viewers: Viewer[];
  private readonly first: Viewer;
  /** Values on their way to the kernel, which sends them back. */
  private readonly sent = new Map<string, string>();
  private readonly handlers: [string, Handler][] = [];
  private early: Delivery[];
  private readonly sources = HEADERS.map(
    (_, view) => new Messages((content) => this.model.send({ ...content, view })),
  );
  private frameTimer: Timer | null = null;
  private hasSentFrame = false;
  /** Style of the page around: the element's own is the widget's layout's. */
  private readonly sheet = new CSSStyleSheet();

  constructor(model: Model, element: HTMLElement) {
    this.model = model;
    const beside = model.get("_header_beside") as Header | undefined;
    element.append(this.view);
    this.viewers = this.makeViewers(beside?.format ? 2 : 1);
    [this.first] = this.viewers;
    // The first view takes what has come; further ones ask.
    const key = model.get("_key");
    this.early = mailbox.get(key) ?? [];
    mailbox.delete(key);
    this.sheet.replaceSync(ROOM);
    document.adoptedStyleSheets.push(this.sheet);
    this.connect();
    this.resize();
    this.viewers.forEach((_, n) => this.takeHeader(n));
    if (model.get("playing")) this.first.play();
    // What came before the client was loaded is lost.
    const whole = this.viewers.every(({ scene, lacking }) => scene && !lacking.length);
    if (!whole) model.send({ kind: "ready" });
  }

  private makeViewers(count: number): Viewer[] {
    const { model, view } = this;
    view.options = {
      rebuild: true,
      guarded: true,
      controls: (model.get("bar") as boolean | undefined) ?? true,
      onColours: (changes: unknown) => model.send({ kind: "appearance", changes }),
    };
    view.open(count, (n) => ({ source: this.sources[n] }));
    const hear = <T>(name: string, take: (value: T) => void) =>
      view.addEventListener(name, (event) => take((event as CustomEvent<T>).detail));
    const slowly = <T>(name: string, wait: number) => {
      const later = (call: () => void, delay: number) => view.first.lifetime.later(call, delay);
      hear(name, throttled<T>(later, wait, (value) => this.send(name, value)));
    };
    slowly<CameraState>("camera", CAMERA_MS);
    slowly<number>("time", TIME_MS);
    slowly<number>("clock", TIME_MS);
    hear<boolean>("playing", (playing) => this.send("playing", playing));
    hear<unknown>("point", (point) => this.send("point", point));
    hear<[string, Value]>("setting", ([name, value]) => this.send(name, value));
    hear<boolean>("controls", (shown) => this.send("bar", shown));
    hear<AxesKind>("axes", (kind) => this.send("axes", kind));
    hear("frame", () => this.planFrame());
    return view.viewers;
  }

  private send(name: string, value: unknown): void {
    this.sent.set(name, JSON.stringify(value));
    this.model.set(name, value);
    this.model.save_changes();
  }

  /** Send the first full picture, and later ones when they have stood for a while. */
  private planFrame(): void {
    const { lifetime } = this.first;
    lifetime.cancel(this.frameTimer);
    const wait = this.hasSentFrame ? STILL_MS : 0;
    this.frameTimer = lifetime.later(() => void this.sendFrame(), wait);
  }

  private async sendFrame(): Promise<void> {
    const { first, viewers } = this;
    if (!viewers.every(({ sharp }) => sharp)) return;
    const { dataset } = first.root;
    const { frames } = dataset;
    this.hasSentFrame = true;
    const picture = await pictureOf(viewers, 1 / first.ratio, STILL_FORMAT);
    const data = await picture.arrayBuffer();
    if (first.lifetime.isOver) return;
    const size = [this.view.clientWidth, this.view.clientHeight];
    this.model.send({ kind: "frame", size, ground: first.header?.background }, undefined, [data]);
    dataset.still = frames; // the picture that the kernel has
  }

  /** The kernel is there and so is what to draw: the still goes. */
  private becomeLive(): void {
    const { root } = this.first;
    if (root.dataset.live || root.dataset.failed) return;
    root.dataset.live = "true";
    // Made by flowtex/host/cell.py, in its own output.
    const still = `[data-flowtex~="${String(this.model.get("_key"))}"]`;
    const output = ":is(.jp-OutputArea-child, .output_area)";
    this.sheet.insertRule(`${still}, ${output}:has(> * > ${still}) { display: none !important }`);
  }

  private listen(event: string, call: Handler): void {
    if (this.handlers.some(([other]) => other === event)) return;
    this.handlers.push([event, call]);
    this.model.on(event, call);
  }

  /** Follow a trait that the view sets as well. */
  private follow(name: string, take: (value: unknown) => void): void {
    this.listen(`change:${name}`, () => {
      const value = this.model.get(name);
      // What comes back from the kernel is what was sent, and may be late.
      if (this.sent.get(name) !== JSON.stringify(value)) take(value);
      this.sent.delete(name);
    });
  }

  private connect(): void {
    const { viewers, first } = this;
    this.listen("msg:custom", (message: Message, buffers: ArrayBufferView[]) => {
      if (message?.kind === "parts") this.take(opened(message, buffers));
      if (message?.kind === "loaded") this.sources[message.view ?? 0]?.end(message as Loaded);
      if (message?.kind === "error") {
        first.panel.fail("The kernel could not continue.", message.text ?? "");
      }
    });
    viewers.forEach((_, n) => this.listen(`change:${HEADERS[n]}`, () => this.takeHeader(n)));
    this.listen("change:size", () => this.resize());
    this.follow("camera", (value) => {
      const camera = cameraOf(value);
      if (camera) viewers.forEach((viewer) => viewer.setCamera(camera));
    });
    this.follow("time", (time) => viewers.forEach((viewer) => viewer.setTime(Number(time))));
    this.follow("clock", (clock) => viewers.forEach((viewer) => viewer.setClock(Number(clock))));
    this.follow("playing", (playing) => (playing ? first.play() : first.pause()));
    this.follow("bar", (shown) => first.panel.toggle(Boolean(shown)));
    this.follow("axes", (kind) => viewers.forEach(({ panel }) => panel.chooseAxes(kind as AxesKind | null)));
  }

  private resize(): void {
    const [width, height] = (this.model.get("size") as [number, number] | undefined) ?? [0, 0];
    const { style, parentElement } = this.view;
    style.width = width ? `${width}px` : "100%";
    style.height = `${height || HEIGHT_PX}px`;
    parentElement?.classList.toggle("flowtex-room", !width);
  }

  private takeHeader(n: number): void {
    const { model } = this;
    const header = model.get(HEADERS[n]) as Header | undefined;
    if (!header?.format) return;
    const rows = header.table ?? [];
    const values = rows.map((row) => [row.name, model.get(row.name) ?? row.default]);
    const now = {
      shaders: (model.get("_shaders") as Header["shaders"][])[n],
      settings: Object.fromEntries(values),
      camera: cameraOf(model.get("camera")),
      time: (model.get("time") as number | undefined) ?? 0,
      clock: (model.get("clock") as number | undefined) ?? 0,
      axes: (model.get("axes") as AxesKind | null | undefined) ?? null,
    };
    this.viewers[n].setHeader({ ...header, ...now }, true);
    for (const delivery of this.early.splice(0)) this.take(delivery);
    for (const { name } of rows) {
      this.follow(name, (value) => {
        for (const viewer of this.viewers) viewer.followSetting(name, value as Value);
      });
    }
  }

  private take(delivery: Delivery): void {
    const viewer = this.viewers[delivery.view];
    if (!viewer) return;
    const generation = viewer.header ? (viewer.header.generation ?? 0) : -1;
    if (delivery.generation > generation) return void this.early.push(delivery);
    // Slices that the kernel has made again meanwhile are arriving.
    const isOld = (name: string) => delivery.generation !== generation && name.includes("/");
    for (const part of delivery.parts) if (!isOld(part.name)) viewer.setPart(part);
    discard([delivery]);
    this.becomeLive();
  }

  dispose(): void {
    for (const [event, call] of this.handlers) this.model.off(event, call);
    discard(this.early);
    document.adoptedStyleSheets = document.adoptedStyleSheets.filter((s) => s !== this.sheet);
    this.view.dispose();
    this.view.remove();
  }
}
