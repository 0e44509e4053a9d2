// Round numbers along an axis or a legend, and distinct texts for them.

/** Steps between ticks, as multiples of a power of ten, of which each is at most 2.5 times the one before. */
const STEPS = [1, 2, 2.5, 5];
/** Steps between ticks in degrees. */
const DEGREES = [1, 2, 5, 10, 15, 30, 60, 90];
/** Ticks of a logarithmic decade, from few to many. */
const DECADES = [[1], [1, 3], [1, 2, 5]];
/** Share of the larger end by which ends that are the same may differ. */
const SAME = 1e-9;
/** Share of the range by which a tick may lie beyond an end: less than a pixel of a legend. */
const BEYOND = 0.004;
/** Numbers from which on, and below which, texts have a power of ten. */
const [LARGE, SMALL] = [1e6, 1e-3];

/** Letters of the longest text beside an axis. */
const LONGEST = 7;

export interface Tick {
  readonly value: number;
  readonly text: string;
}

/** Round values from `low` to `high`, three to `most` where there are as many. */
export function ticksOf(low: number, high: number, log = false, most = 5): Tick[] {
  if (!(high - low > SAME * Math.max(Math.abs(low), Math.abs(high)))) {
    return Number.isFinite(low) ? [{ value: low, text: textOf(low, Math.abs(low) / 1e3 || 1) }] : [];
  }
  return (log && decades(low, high, most)) || evenly(low, high, most);
}

/** A round number to take from those of an axis whose texts would be too long; `null` if they are not. */
export function offsetOf(low: number, high: number, most: number): Tick | null {
  const isLong = (offset: number) =>
    ticksOf(low - offset, high - offset, false, most).some(({ text }) => text.length > LONGEST);
  if (!isLong(0)) return null;
  const size = Math.max(Math.abs(low), Math.abs(high));
  for (let power = 10 ** Math.floor(Math.log10(size)); power > high - low; power /= 10) {
    const value = Math.round((low + high) / 2 / power) * power;
    if (!isLong(value)) return { value, text: textOf(value, power) };
  }
  return null;
}

function evenly(low: number, high: number, most: number): Tick[] {
  const least = 10 ** Math.floor(Math.log10((high - low) / most));
  for (let power = least; ; power *= 10) {
    for (const factor of STEPS) {
      const step = factor * power;
      const slack = BEYOND * (high - low);
      const [first, last] = [Math.ceil((low - slack) / step), Math.floor((high + slack) / step)];
      if (last - first + 1 > most) continue;
      return Array.from({ length: last - first + 1 }, (_, n) => {
        const value = (first + n) * step;
        return { value, text: textOf(value, step, Math.max(Math.abs(low), Math.abs(high))) };
      });
    }
  }
}

/** Ticks of a longitude or a latitude, with the letters of its two sides, such as "EW". */
export function degreeTicks(low: number, high: number, letters: string, most = 5): Tick[] {
  const step = DEGREES.find((each) => Math.floor(high / each) - Math.ceil(low / each) < most);
  const isFine = high - low < 3 * DEGREES[0] || step === undefined;
  const values = isFine
    ? ticksOf(low, high, false, most)
    : Array.from({ length: Math.floor(high / step) - Math.ceil(low / step) + 1 }, (_, n) => {
        const value = (Math.ceil(low / step) + n) * step;
        return { value, text: String(value) };
      });
  return values.map(({ value, text }) => {
    const turned = value - 360 * Math.round(value / 360);
    const digits = text.split(".")[1]?.length ?? 0;
    const side = turned === 0 || Math.abs(turned) === 180 ? "" : letters[Number(turned < 0)];
    return { value, text: `${Math.abs(turned).toFixed(digits)}°${side}` };
  });
}

/** Ticks at powers of ten and between them; `undefined` where the ends are closer than such. */
function decades(low: number, high: number, most: number): Tick[] | undefined {
  const [first, last] = [Math.floor(Math.log10(low)), Math.ceil(Math.log10(high))];
  const powers = Array.from({ length: last - first + 1 }, (_, n) => first + n);
  const isInside = (value: number) => value >= low * (1 - SAME) && value <= high * (1 + SAME);
  const valuesOf = (factors: number[], every: number) =>
    powers
      .filter((power) => power % every === 0)
      .flatMap((power) => factors.map((factor) => Number(`${factor}e${power}`)))
      .filter(isInside);
  const finer = [...DECADES].reverse().map((factors) => valuesOf(factors, 1));
  const coarser = powers.slice(1).map((_, n) => valuesOf([1], n + 2));
  const chosen = [...finer, ...coarser].find((values) => values.length <= most);
  if (!chosen || chosen.length < 3) return undefined;
  return chosen.map((value) => ({ value, text: textOf(value, value, value) }));
}

/** A number to the digits that a step asks for, beside numbers up to a size. */
function textOf(value: number, step: number, size = Math.abs(value)): string {
  if (value === 0) return "0";
  const digits = -Math.floor(Math.log10(step) + SAME);
  const isHalf = Math.abs(step * 10 ** digits - 2.5) < SAME ? 1 : 0; // steps of 2.5 have one more
  if (size >= LARGE || size < SMALL) {
    const mantissa = Math.max(Math.floor(Math.log10(Math.abs(value)) + SAME) + digits + isHalf, 0);
    const [number, power] = value.toExponential(Math.min(mantissa, 15)).split("e");
    return `${minus(number)}e${Number(power)}`;
  }
  return minus(value.toFixed(Math.max(digits + isHalf, 0)));
}

const minus = (text: string) => text.replace("-", "−");
