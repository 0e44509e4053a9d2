// As much of a page and of Vue as the components of the app's page touch; import it before them.

type Call = (...values: never[]) => unknown;

/** An element: where it lies, what it matches and what it holds are told. */
export class FakeElement extends EventTarget {
  dataset: Record<string, string> = {};
  style: Record<string, unknown> = {};
  hidden = false;
  textContent = "";
  box = { left: 0, top: 0, width: 100, height: 50 };
  kinds: string[];
  parentElement: FakeElement | null = null;
  inside: FakeElement[] = [];

  constructor(...kinds: string[]) {
    super();
    this.kinds = kinds;
    this.style.setProperty = (name: string, value: string) => (this.style[name] = value);
  }

  get offsetWidth() {
    return this.box.width;
  }

  get offsetHeight() {
    return this.box.height;
  }

  get clientWidth() {
    return this.box.width;
  }

  get clientHeight() {
    return this.box.height;
  }

  getBoundingClientRect() {
    const { left, top, width, height } = this.box;
    return { ...this.box, right: left + width, bottom: top + height };
  }

  matches(selector: string): boolean {
    return this.kinds.some((kind) => selector.split(", ").includes(kind));
  }

  closest(selector: string): FakeElement | null {
    return this.matches(selector) ? this : (this.parentElement?.closest(selector) ?? null);
  }

  querySelectorAll(selector: string): FakeElement[] {
    return this.inside.filter((element) => element.matches(selector));
  }

  querySelector(selector: string): FakeElement | null {
    return this.querySelectorAll(selector)[0] ?? null;
  }
}

/** The server: what it was asked by triggers, its answer, what was called of it, and its stream. */
export const asked: unknown[][] = [];
export const server = {
  answer: {} as object,
  /** What WebGL2 draws with; empty where there is none. */
  card: "",
  called: [] as unknown[],
  push: (frame: object): void => void frame,
};

/**
 * Observers, of sizes and of changes, in the order of their making; `tell` does what the browser
 * would do.
 */
export const observers: FakeObserver[] = [];

export class FakeObserver {
  readonly watched = new Set<unknown>();
  readonly tell: Call;

  constructor(tell: Call) {
    this.tell = tell;
    observers.push(this);
  }

  observe(element: unknown): void {
    this.watched.add(element);
  }

  disconnect(): void {
    this.watched.clear();
  }
}

export const page = Object.assign(new EventTarget(), {
  location: { hash: "", pathname: "/page/", search: "?a=b" },
  history: {
    state: null,
    replaceState: (_state: unknown, _title: string, address: string) => {
      page.location.hash = new URL(address, "http://host").hash;
      asked.push(["address", address]);
    },
  },
  setTimeout: (call: () => void, wait: number) => setTimeout(call, wait),
  Vue: {
    h: (kind: string, ...content: unknown[]) => ({ kind, content }),
    ref: (value: unknown) => ({ value }),
    onMounted: (call: () => void) => mounting.push(call),
    onBeforeUnmount: (call: () => void) => leaving.push(call),
  },
});
export const root = new FakeElement();
const context = { RENDERER: 1, getExtension: (name: string) => (name.includes("float") ? {} : null), getParameter: () => server.card };
const session = {
  call: (...values: unknown[]) => {
    server.called = values;
    return Promise.resolve();
  },
  subscribe: (_: string, call: (frames: object[]) => void) => {
    server.push = (frame) => call([frame]);
    return call;
  },
  unsubscribe: () => undefined,
};
Object.assign(page, {
  trame: {
    trigger: (name: string, args: unknown[]) => {
      asked.push([name, ...args]);
      return Promise.resolve(server.answer);
    },
    client: { getConnection: () => ({ getSession: () => session }) },
  },
});
const mounting: (() => void)[] = [];
const leaving: (() => void)[] = [];

Object.assign(globalThis, {
  window: page,
  document: Object.assign(new EventTarget(), {
    documentElement: root,
    baseURI: "http://page.test/",
    createElement: () => ({ getContext: () => (server.card ? context : null) }),
  }),
  Element: FakeElement,
  ResizeObserver: FakeObserver,
  requestAnimationFrame: (call: () => void) => queueMicrotask(call),
  innerWidth: 400,
  innerHeight: 300,
});

export interface Drawn {
  kind: string;
  content: unknown[];
}

export interface Shown {
  told: unknown[][];
  draw: () => Drawn | null;
  /** What the component offers to be called. */
  exposed: object;
  leave(): void;
}

/** Set a component up in the page, with an element in its place. */
export function shown(
  component: { setup: (props: never, context: never) => unknown },
  element: FakeElement | null,
  props: object = {},
): Shown {
  const told: unknown[][] = [];
  const exposed = {};
  for (const list of [mounting, leaving]) list.length = 0;
  const emit = (...values: unknown[]) => told.push(values);
  const expose = (methods: object) => Object.assign(exposed, methods);
  const draw = component.setup(props as never, { emit, expose } as never) as Shown["draw"];
  const [first = {}] = (draw()?.content ?? []) as { ref?: { value: unknown } }[];
  if (first.ref) first.ref.value = element;
  mounting.forEach((call) => call());
  const ends = [...leaving];
  return { told, draw, exposed, leave: () => ends.forEach((call) => call()) };
}

/** An event with its details. */
export const eventOf = (kind: string, more: object = {}) =>
  Object.defineProperties(new Event(kind, { cancelable: true }), Object.getOwnPropertyDescriptors(more));
