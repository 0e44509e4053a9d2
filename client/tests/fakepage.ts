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

export class FakeButton extends FakeElement {}

/** Observers, of sizes and of changes, in the order of their making; `tell` is what the browser would do. */
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
  location: { hash: "" },
  setTimeout: (call: () => void, wait: number) => setTimeout(call, wait),
  Vue: {
    h: (kind: string, ...content: unknown[]) => ({ kind, content }),
    ref: (value: unknown) => ({ value }),
    watch: (source: () => unknown, call: () => void) => watched.push([source, call]),
    onMounted: (call: () => void) => mounting.push(call),
    onBeforeUnmount: (call: () => void) => leaving.push(call),
  },
});
export const root = new FakeElement();
const mounting: (() => void)[] = [];
const leaving: (() => void)[] = [];
const watched: [source: () => unknown, call: () => void][] = [];

Object.assign(globalThis, {
  window: page,
  document: Object.assign(new EventTarget(), { documentElement: root, baseURI: "http://page.test/" }),
  Element: FakeElement,
  HTMLButtonElement: FakeButton,
  ResizeObserver: FakeObserver,
  MutationObserver: FakeObserver,
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
  /** Change properties, as the page does. */
  change(values: object): void;
  leave(): void;
}

/** Set a component up in the page, with an element in its place. */
export function shown(
  component: { setup: (props: never, context: never) => unknown },
  element: FakeElement | null,
  props: object = {},
): Shown {
  const told: unknown[][] = [];
  for (const list of [mounting, leaving, watched]) list.length = 0;
  const emit = (...values: unknown[]) => told.push(values);
  const draw = component.setup(props as never, { emit } as never) as Shown["draw"];
  const [first = {}] = (draw()?.content ?? []) as { ref?: { value: unknown } }[];
  if (first.ref) first.ref.value = element;
  mounting.forEach((call) => call());
  const mine = [...watched];
  const ends = [...leaving];
  const change = (values: object) => {
    const before = mine.map(([source]) => source());
    Object.assign(props, values);
    mine.forEach(([source, call], n) => source() !== before[n] && call());
  };
  return { told, draw, change, leave: () => ends.forEach((call) => call()) };
}

/** An event with what tells more about it. */
export const eventOf = (kind: string, more: object = {}) =>
  Object.defineProperties(new Event(kind, { cancelable: true }), Object.getOwnPropertyDescriptors(more));
