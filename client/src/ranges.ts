// The range of colours that values have by default: usual_ends and widened of flowtex/textures/tiles/shared.py.

import type { RangeRules } from "./protocol.ts";

export interface Range {
  /** Ends of the colours by default. */
  low: number;
  high: number;
  /** Ends of the values. */
  least: number;
  most: number;
}

/** The percentile of sorted values, between the nearest two. */
function percentileOf(sorted: Float64Array, percent: number): number {
  const place = (percent / 100) * (sorted.length - 1);
  const before = Math.floor(place);
  const after = Math.min(before + 1, sorted.length - 1);
  return sorted[before] + (place - before) * (sorted[after] - sorted[before]);
}

/** Ends that are apart, also where all values are the same up to rounding. */
function widened([low, high]: [number, number], { same, widening }: RangeRules): [number, number] {
  const size = Math.max(Math.abs(low), Math.abs(high));
  if (high - low > same * size) return [low, high];
  return size > 0 ? [low - widening * size, high + widening * size] : [0, 1];
}

/** The whole range, and that without a tail that is longer than the robust one; null without values. */
export function rangeOf(values: Float64Array, rules: RangeRules): Range | null {
  const sorted = values.filter(Number.isFinite).sort();
  if (!sorted.length) return null;
  const [least, most] = widened([sorted[0], sorted[sorted.length - 1]], rules);
  const [from, to] = rules.percentiles.map((percent) => percentileOf(sorted, percent));
  const [low, high] = widened([from, to], rules);
  const tail = rules.tail * (high - low);
  if (tail < rules.leastShare * (most - least)) return { low: least, high: most, least, most };
  return {
    low: low - least > tail ? low : least,
    high: most - high > tail ? high : most,
    least,
    most,
  };
}
