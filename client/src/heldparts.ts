// The arrays that a view holds, shared with the other views of the page, and which of them it gives up.

import type { Graphics } from "./context.ts";
import { MARKS, isOfStep, stepOf, type Header, type NamedPart, type Part } from "./protocol.ts";
import type { Source } from "./sources/source.ts";
import { flowsOf } from "./tracer.ts";

/** Time steps that are held where the host can send the others again, and where memory is short. */
const STEPS_HELD = { slices: [12, 4], flow: [100, 24] };
/** Time steps whose marks are held where the host can send the others again. */
const MARKS_HELD = 24;

export class HeldParts {
  readonly all = new Map<string, Part>();
  private readonly graphics: Graphics;

  constructor(graphics: Graphics) {
    this.graphics = graphics;
  }

  /** Hold a part; returns whether it has changed. */
  set(part: NamedPart): boolean {
    const { name, digest } = part;
    if (digest && this.all.get(name)?.digest === digest) return false;
    const held = this.graphics.hold(part);
    this.remove(name);
    this.all.set(name, held);
    return true;
  }

  remove(name: string): void {
    this.graphics.release(this.all.get(name));
    this.all.delete(name);
  }

  /** Remove all parts, or those whose names match. */
  clear(isGone: (name: string) => boolean = () => true): void {
    for (const name of [...this.all.keys()]) if (isGone(name)) this.remove(name);
  }

  /** Hold a few time steps, those of `shown` among them, where the others can be traced or sent again. */
  trim(header: Header | null, source: Source | undefined, shown: number[]): void {
    const { hasSteps = false, hasMarks = false, memory = 0 } = source ?? {};
    if (!header || !hasSteps) return;
    for (const kind of hasMarks ? Object.keys(MARKS) : []) {
      const held = [...this.all.keys()].filter((name) => name.startsWith(`${kind}/`));
      for (const name of held.slice(0, -MARKS_HELD)) if (!shown.includes(stepOf(name))) this.remove(name);
    }
    const kind = header.slices.trace ? "flow" : "slices";
    const named = (some: string) => [...this.all.keys()].filter((name) => name.startsWith(some));
    const needed = shown.flatMap((step) => flowsOf(header, step));
    for (const name of named(`${kind}/`).slice(0, -STEPS_HELD[kind][Number(memory > 0)])) {
      const step = stepOf(name);
      if (needed.includes(step)) continue;
      for (const held of [kind, "extra"]) this.remove(`${held}/${step}`);
      const values = memory ? named("scalars/") : [];
      for (const other of values) if (isOfStep(other, step, header)) this.remove(other);
    }
  }
}
