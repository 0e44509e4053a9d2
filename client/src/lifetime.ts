// What a viewer holds on to outside of itself, so that nothing stays behind.

export type Timer = ReturnType<typeof setTimeout>;

export class Lifetime {
  private readonly controller = new AbortController();
  private readonly observers = new Set<{ disconnect(): void }>();
  private readonly timers = new Set<Timer>();
  private globalListeners = 0;

  get isOver(): boolean {
    return this.controller.signal.aborted;
  }

  listen<E extends Event>(
    target: EventTarget,
    kind: string,
    call: (event: E) => void,
    options: AddEventListenerOptions = {},
  ): void {
    if (target === document || target === window) this.globalListeners += 1;
    const { signal } = this.controller;
    target.addEventListener(kind, call as EventListener, { ...options, signal });
  }

  later(call: () => void, delay: number): Timer {
    const timer = setTimeout(() => {
      this.timers.delete(timer);
      call();
    }, delay);
    this.timers.add(timer);
    return timer;
  }

  cancel(timer: Timer | null): void {
    if (timer === null) return;
    clearTimeout(timer);
    this.timers.delete(timer);
  }

  observe(observer: ResizeObserver | IntersectionObserver, element: Element): void {
    observer.observe(element);
    this.observers.add(observer);
  }

  /** Observe changes of an element's own. */
  watch(observer: MutationObserver, element: Element, what: MutationObserverInit): void {
    observer.observe(element, what);
    this.observers.add(observer);
  }

  /** What is still held, for tests. */
  stats(): { listeners: number; observers: number; timers: number } {
    const { globalListeners: listeners, observers, timers } = this;
    return { listeners, observers: observers.size, timers: timers.size };
  }

  end(): void {
    this.controller.abort();
    this.globalListeners = 0;
    for (const observer of this.observers) observer.disconnect();
    this.observers.clear();
    for (const timer of this.timers) clearTimeout(timer);
    this.timers.clear();
  }
}

/** Call at most once in this many milliseconds; the last call always takes place. */
export function throttled<T>(
  later: (call: () => void, delay: number) => unknown,
  wait: number,
  call: (value: T) => void,
): (value: T) => void {
  let next: { value: T } | null = null;
  let running = false;
  const run = () => {
    running = next !== null;
    if (!next) return;
    const { value } = next;
    next = null;
    call(value);
    later(run, wait);
  };
  return (value) => {
    next = { value };
    if (!running) run();
  };
}
