// Time and clock, and how they advance.

import type { Header, Settings } from "./protocol.ts";
import { momentOf, type Moment } from "./uniforms.ts";
import { clamp } from "./vectors.ts";

/** Seconds in which a whole series is shown: for each step, at least and at most. */
const SERIES_STEP_S = 0.5;
const SERIES_LEAST_S = 6;
const SERIES_MOST_S = 60;
/** Longest time between two pictures that counts as gone by. */
const LONGEST_GAP_S = 0.5;

export class Player {
  time = 0;
  /** Seconds of a steady flow that streams. */
  clock = 0;
  playing = false;
  /** How many times faster than usual time goes by. */
  pace = 1;
  private times: number[] = [0];
  private lastFrame = 0;
  private hasHeader = false;

  /** Take the times of a scene; begins with its time where it has others than before. */
  setHeader(header: Header): void {
    const { times } = header.slices;
    const same = times.length === this.times.length && times.every((t, n) => t === this.times[n]);
    if (!same || !this.hasHeader) {
      this.time = header.time;
      this.clock = header.clock;
    }
    this.hasHeader = true;
    this.times = times;
  }

  /** Whether the flow on show changes with time. */
  get varies(): boolean {
    return this.times.length > 1;
  }

  get span(): [number, number] {
    return [this.times[0], this.times[this.times.length - 1]];
  }

  get moment(): Moment {
    return momentOf(this.times, this.time);
  }

  /** Time of a moment, in the field's own unit. */
  timeOf([before, after, between]: Moment): number {
    return this.times[before] + between * (this.times[after] - this.times[before]);
  }

  seek(time: number): void {
    this.time = clamp(time, ...this.span);
  }

  /** Time of the step after the present time, or of the one before it, round and round. */
  stepFrom(count: number): number {
    const { times, time } = this;
    const after = times.findIndex((each) => (count > 0 ? each > time : each >= time));
    const steps = times.length;
    const at = after < 0 ? steps : after;
    return times[(count > 0 ? at : at - 1 + steps) % steps];
  }

  start(): void {
    this.playing = true;
    this.lastFrame = 0;
  }

  /** Where the slider stands: first and last value, and the present one. */
  range(settings: Settings): { first: number; last: number; now: number } {
    if (this.varies) return { first: this.span[0], last: this.span[1], now: this.time };
    const period = Number(settings.period);
    return { first: 0, last: period, now: this.clock % period };
  }

  /**
   * Go on to the moment `now`, in milliseconds; returns whether anything moved. `ready` says
   * whether the steps of a moment are loaded: what is on the way is waited for, not jumped over.
   */
  advance(now: number, ready: (steps: [number, number]) => boolean): boolean {
    const passed = this.lastFrame ? Math.min((now - this.lastFrame) / 1000, LONGEST_GAP_S) * this.pace : 0;
    this.lastFrame = now;
    if (!this.varies) {
      this.clock += passed;
      return true;
    }
    const [first, last] = this.span;
    const series = clamp(SERIES_STEP_S * (this.times.length - 1), SERIES_LEAST_S, SERIES_MOST_S);
    const next = this.time + (passed * (last - first)) / series;
    const [before, after] = momentOf(this.times, Math.min(next, last));
    if (!ready([before, after])) return false;
    this.time = next > last ? first : next;
    return true;
  }
}
