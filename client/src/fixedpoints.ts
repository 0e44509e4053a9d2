// Fixed points of a formula, the separatrices of its saddles, and closed orbits: zeros of the rates themselves,
// and lines that are followed along them. What a point is called is as in flowtex/trace/structure/critical_points.py.

export type Pair = [x: number, y: number];
/** The rates of change at a place; not finite if they do not exist. */
export type Rate = (x: number, y: number) => Pair;
/** Least and greatest x and y. */
export type Ends = [x: Pair, y: Pair];

export interface FixedPoint {
  at: Pair;
  kind: string;
  /** By which the strongest come first. */
  steepness: number;
  /** Of a saddle, unit vectors along which the flow leaves and comes. */
  ways: { leaving: Pair; coming: Pair } | null;
}

export interface Separatrix {
  /** Points from the saddle on, as far as a line does not wind up more than twice. */
  path: Pair[];
  saddle: FixedPoint;
  leaves: boolean;
  /** The closed orbit on which it ends. */
  orbit: Pair[] | null;
}

export interface ClosedOrbit {
  path: Pair[];
  /** Whether the lines beside it come to it; they leave it otherwise. */
  isStable: boolean;
}

/** Cells in which zeros are looked for along the longer side, steps of Newton's method and how far they may lead. */
const [CELLS, NEWTON_STEPS, FAR_CELLS] = [160, 40, 2];
/** Cells in which the lines of zeros are straight, along the longer side. */
const NULLCLINE_CELLS = 256;
/** Halvings of a side that such a line crosses, and what they leave of a rate that goes to zero there at most. */
const [NULLCLINE_HALVINGS, LEFT] = [12, 0.25];
/**
 * Speed over that at the corners of its cell, at which a zero is one; tolerances for a zero
 * determinant and for equal positions.
 */
const [ZERO_SHARE, SINGULAR, SAME_CELLS] = [1e-7, 1e-7, 1e-3];
/** Growth of a spiral, as a share of its rotation, up to which it is a centre. */
const CENTRE_SHARE = 0.01;
/** Steps along the diagonal, and those of a line at most; the first one and the last one to a point, in steps. */
const [STEPS, MOST_STEPS, BEGIN, END] = [800, 2400, 0.02, 1.5];
/** Steps of a turn at least; distances of two turns at which a line is closed, and winds up, in steps. */
const [LEAST_TURN, CLOSED, WOUND] = [8, 0.08, 2];

/** Points around which closed orbits are looked for; places of a ray: ratio, and distance as a share of the diagonal. */
const [MOST_AROUND, RATIO, APART] = [8, 1.2, 0.03];
/** How much farther out or in lines return where they move away, as a share of the distance; halvings of a stretch. */
const [MOVED, HALVINGS] = [0.05, 24];

const difference = (a: Pair, b: Pair): Pair => [a[0] - b[0], a[1] - b[1]];
const along = (a: Pair, way: Pair, step: number): Pair => [a[0] + step * way[0], a[1] + step * way[1]];
const distance = (a: Pair, b: Pair) => Math.hypot(a[0] - b[0], a[1] - b[1]);

/** The gradient of the rates at a place, row by row. */
function gradient(rate: Rate, [x, y]: Pair, [dx, dy]: Pair): number[] {
  const [east, west, north, south] = [rate(x + dx, y), rate(x - dx, y), rate(x, y + dy), rate(x, y - dy)];
  return [0, 1].flatMap((k) => [(east[k] - west[k]) / (2 * dx), (north[k] - south[k]) / (2 * dy)]);
}

/** What the flow around a point does. */
function described(at: Pair, [a, b, c, d]: number[]): FixedPoint {
  const [trace, steepness] = [a + d, Math.abs(a * d - b * c)];
  const square = trace ** 2 / 4 - (a * d - b * c);
  const root = Math.sqrt(Math.abs(square));
  const turned = Math.abs(trace) / 2 <= CENTRE_SHARE * root ? "centre" : trace > 0 ? "spiral source" : "spiral sink";
  const kind = a * d - b * c < 0 ? "saddle" : square < 0 ? turned : trace > 0 ? "source" : "sink";
  const way = (value: number): Pair => {
    const [one, two]: Pair[] = [[b, value - a], [value - d, c]];
    const [x, y] = Math.hypot(...one) > Math.hypot(...two) ? one : two;
    return [x / Math.hypot(x, y), y / Math.hypot(x, y)];
  };
  const ways = kind === "saddle" ? { leaving: way(trace / 2 + root), coming: way(trace / 2 - root) } : null;
  return { at, kind, steepness, ways };
}

/** The fixed points in a box, the strongest first. */
export function fixedPoints(rate: Rate, [xs, ys]: Ends): FixedPoint[] {
  const sides: Pair = [xs[1] - xs[0], ys[1] - ys[0]];
  const [columns, rows] = sides.map((side) => Math.max(Math.round((CELLS * side) / Math.max(...sides)), 8));
  const cell: Pair = [sides[0] / columns, sides[1] / rows];
  const nodes = Array.from({ length: (rows + 1) * (columns + 1) }, (_, n) =>
    rate(xs[0] + cell[0] * (n % (columns + 1)), ys[0] + cell[1] * Math.floor(n / (columns + 1))),
  );
  const points: FixedPoint[] = [];
  for (let n = 0; n < rows * columns; n += 1) {
    const low = n + Math.floor(n / columns);
    const corners = [low, low + 1, low + columns + 1, low + columns + 2].map((node) => nodes[node]);
    const isCrossed = [0, 1].every((k) => corners.some((v) => v[k] >= 0) && corners.some((v) => v[k] <= 0));
    if (!isCrossed) continue;
    const middle: Pair = [xs[0] + cell[0] * ((n % columns) + 0.5), ys[0] + cell[1] * (Math.floor(n / columns) + 0.5)];
    const found = zero(rate, middle, cell, Math.max(...corners.map((v) => Math.hypot(...v))));
    const isInside = found && [xs, ys].every(([least, most], k) => found.at[k] >= least - SAME_CELLS * cell[k] && found.at[k] <= most + SAME_CELLS * cell[k]);
    if (!found || !isInside) continue;
    if (!points.some(({ at }) => distance(at, found.at) < SAME_CELLS * Math.hypot(...cell))) points.push(found);
  }
  return points.sort((one, two) => two.steepness - one.steepness);
}

/** Straight pieces of the lines in a box along which the rate of x is zero, and of those along which that of y is. */
export function nullclines(rate: Rate, [xs, ys]: Ends): [Pair, Pair][][] {
  const sides: Pair = [xs[1] - xs[0], ys[1] - ys[0]];
  const [columns, rows] = sides.map((side) => Math.max(Math.round((NULLCLINE_CELLS * side) / Math.max(...sides)), 8));
  const nodes = Array.from({ length: (rows + 1) * (columns + 1) }, (_, n) => {
    const at: Pair = [xs[0] + (sides[0] * (n % (columns + 1))) / columns, ys[0] + (sides[1] * Math.floor(n / (columns + 1))) / rows];
    return { at, value: rate(...at) };
  });
  return [0, 1].map((k) => {
    const pieces: [Pair, Pair][] = [];
    for (let n = 0; n < rows * columns; n += 1) {
      const low = n + Math.floor(n / columns);
      const [a, b, c, d] = [low, low + 1, low + columns + 1, low + columns + 2].map((node) => nodes[node]);
      for (const corners of [[a, b, d], [a, d, c]]) {
        // A side along which it is zero is a piece, and may be the border of the box.
        const isSide = corners.filter(({ value }) => value[k] !== 0).length === 1;
        const above = corners.map(({ value }) => (isSide ? value[k] !== 0 : value[k] > 0));
        const alone = above.findIndex((one, m) => one !== above[(m + 1) % 3] && one !== above[(m + 2) % 3]);
        if (alone < 0 || !corners.every(({ value }) => Number.isFinite(value[k]))) continue;
        const one = corners[alone];
        const others = [1, 2].map((m) => corners[(alone + m) % 3]);
        if (!others.every((other) => vanishes((at) => rate(...at)[k], one.at, other.at))) continue;
        const [start, end] = others.map((other): Pair =>
          along(one.at, difference(other.at, one.at), one.value[k] / (one.value[k] - other.value[k])),
        );
        pieces.push([start, end]);
      }
    }
    return pieces;
  });
}

/**
 * Whether a rate goes to zero between two places, and neither jumps nor has a pole there. It has different signs at
 * the places, or is zero at the second one.
 */
function vanishes(rate: (at: Pair) => number, one: Pair, two: Pair): boolean {
  const size = () => Math.max(Math.abs(rate(one)), Math.abs(rate(two)));
  const [first, isAbove] = [size(), rate(one) > 0];
  for (let n = 0; n < NULLCLINE_HALVINGS; n += 1) {
    const middle = along(one, difference(two, one), 0.5);
    if (rate(middle) > 0 === isAbove) one = middle;
    else two = middle;
  }
  return size() < LEFT * first;
}

/** The zero near a place, by Newton's method; none where the rates are zero along a line, or jump. */
function zero(rate: Rate, start: Pair, cell: Pair, speed: number): FixedPoint | null {
  const small: Pair = [1e-5 * cell[0], 1e-5 * cell[1]];
  let at = start;
  for (let n = 0; n < NEWTON_STEPS; n += 1) {
    const [u, v] = rate(...at);
    const matrix = gradient(rate, at, small);
    const [a, b, c, d] = matrix;
    const determinant = a * d - b * c;
    const isSingular = !(Math.abs(determinant) > SINGULAR * (a * a + b * b + c * c + d * d));
    if (isSingular) return null;
    const step: Pair = [(b * v - d * u) / determinant, (c * u - a * v) / determinant];
    // A step that is too long leads elsewhere.
    const share = Math.min(1, 1 / Math.max(Math.abs(step[0] / cell[0]), Math.abs(step[1] / cell[1]), 1e-30));
    at = along(at, step, share);
    if (!(Math.max(...difference(at, start).map((x, k) => Math.abs(x / cell[k]))) < FAR_CELLS)) return null;
    if (Math.hypot(step[0] / cell[0], step[1] / cell[1]) < 1e-10) break;
  }
  return Math.hypot(...rate(...at)) <= ZERO_SHARE * speed ? described(at, gradient(rate, at, small)) : null;
}

/** The separatrices of some saddles, of each those along which the flow leaves and those along which it comes. */
export function separatrices(rate: Rate, ends: Ends, points: FixedPoint[], saddles: FixedPoint[]): Separatrix[] {
  const step = Math.hypot(...ends.map(([low, high]) => high - low)) / STEPS;
  return saddles.flatMap((saddle) => {
    const { ways } = saddle;
    if (!ways) return [];
    return [true, false].flatMap((leaves) =>
      [1, -1].map((side) => {
        const way = leaves ? ways.leaving : ways.coming;
        const begin = along(saddle.at, way, side * BEGIN * step);
        const path = followed(rate, ends, points, [saddle.at, begin], leaves ? step : -step);
        const closed = turnOf(path, step, CLOSED);
        const turn = closed && path.slice(closed[0], closed[1] + 1);
        const ended = points.some(({ at }) => at === path[path.length - 1]);
        const wound = turnOf(path, step, WOUND);
        return {
          path: wound ? path.slice(0, 2 * wound[1] - wound[0] + 1) : path,
          saddle,
          leaves,
          // A line that comes back to its saddle closes, and is no orbit.
          orbit: turn && !ended && isIsolated(rate, turn) ? turn : null,
        };
      }),
    );
  });
}

/**
 * Whether lines beside a turn come to it or leave it, by the divergence over its time; as in
 * flowtex/trace/structure/orbits.py.
 */
function isIsolated(rate: Rate, turn: Pair[]): boolean {
  let growth = 0;
  for (let n = 1; n < turn.length; n += 1) {
    const length = distance(turn[n], turn[n - 1]);
    const [a, , , d] = gradient(rate, turn[n], [1e-3 * length, 1e-3 * length]);
    growth += ((a + d) * length) / Math.hypot(...rate(...turn[n]));
  }
  return Math.abs(growth) > MOVED;
}

/**
 * Closed orbits to which lines come, or which they leave: where lines return to a ray from a point that is no
 * saddle. flowtex/trace/structure/orbits.py finds them on grids.
 */
export function closedOrbits(rate: Rate, ends: Ends, points: FixedPoint[]): ClosedOrbit[] {
  const diagonal = Math.hypot(...ends.map(([low, high]) => high - low));
  const step = diagonal / STEPS;
  const found: ClosedOrbit[] = [];
  for (const { at: [x, y] } of points.filter(({ ways }) => !ways).slice(0, MOST_AROUND)) {
    /** The turn from a place of the ray on, forward or back; its last point is on the ray. */
    const turn = (place: number, way: number): Pair[] | null => {
      const side = Math.sign(way * rate(x + place, y)[1]);
      const isBack = (path: Pair[]) => {
        const [before, after] = path.slice(-2).map((at) => side * (at[1] - y));
        return path.length > LEAST_TURN && before < 0 && after >= 0 && path[path.length - 1][0] > x;
      };
      const path = followed(rate, ends, points, [[x + place, y]], way * step, isBack);
      if (path.length < 2 || !isBack(path)) return null;
      const [before, after] = path.slice(-2);
      return [...path.slice(0, -1), along(before, difference(after, before), (y - before[1]) / (after[1] - before[1]))];
    };
    const moved = (place: number, way: number) => (turn(place, way)?.at(-1)?.[0] ?? NaN) - x - place;
    let last: { place: number; out: number } | null = null;
    for (let place = 2 * step; x + place < ends[0][1]; place += Math.min((RATIO - 1) * place, APART * diagonal)) {
      const forward = moved(place, 1);
      const out: number = Number.isNaN(forward) ? -moved(place, -1) : forward;
      if (Math.abs(out) <= Math.max(MOVED * place, CLOSED * step)) continue;
      if (last && last.out * out < 0) {
        const way = Math.sign(last.out);
        let [low, high] = [last.place, place];
        for (let n = 0; n < HALVINGS; n += 1) {
          const middle = (low + high) / 2;
          if (moved(middle, way) > 0) low = middle;
          else high = middle;
        }
        const path = turn(low, way);
        // Where the ray meets another fixed point, lines turn around that one.
        const isNew = path && windsAround(path, [x, y]) && !found.some((other) => other.path.some((at) => distance(at, path[0]) < 2 * step));
        if (path && isNew && distance(path[0], path[path.length - 1]) < CLOSED * step) found.push({ path, isStable: way > 0 });
      }
      last = Number.isNaN(out) ? null : { place, out };
    }
  }
  return found;
}

/** The line through a place, downstream: to fixed points or borders, once around, or as far as lines are followed. */
export function trajectory(rate: Rate, ends: Ends, at: Pair): Pair[] {
  const points = fixedPoints(rate, ends);
  const step = Math.hypot(...ends.map(([low, high]) => high - low)) / STEPS;
  const ahead = followed(rate, ends, points, [at], step);
  const closed = turnOf(ahead, step, CLOSED);
  if (closed) return ahead.slice(0, closed[1] + 1);
  return [...followed(rate, ends, points, [at], -step).reverse(), ...ahead.slice(1)];
}

/** Whether a line turns around a place. */
function windsAround(path: Pair[], [x, y]: Pair): boolean {
  let turned = 0;
  for (let n = 1; n < path.length; n += 1) {
    const [[a, b], [c, d]] = [path[n - 1], path[n]].map((at) => difference(at, [x, y]));
    turned += Math.atan2(a * d - b * c, a * c + b * d);
  }
  return Math.abs(turned) > Math.PI;
}

/** The line from the last of some points on, of so long steps, to a fixed point, a border, or where it is to end. */
function followed(
  rate: Rate,
  ends: Ends,
  points: FixedPoint[],
  path: Pair[],
  step: number,
  isEnd: (path: Pair[]) => boolean = () => false,
): Pair[] {
  const unit = (at: Pair): Pair => {
    const [u, v] = rate(...at);
    const size = Math.hypot(u, v);
    return [u / size, v / size];
  };
  const near = END * Math.abs(step);
  let isAway = false;
  for (let n = 0; n < MOST_STEPS; n += 1) {
    const at = path[path.length - 1];
    const one = unit(at);
    const two = unit(along(at, one, step / 2));
    const three = unit(along(at, two, step / 2));
    const four = unit(along(at, three, step));
    const next = along(at, [0, 1].map((k) => (one[k] + 2 * two[k] + 2 * three[k] + four[k]) / 6) as Pair, step);
    if (!next.every(Number.isFinite)) return path;
    // It ends where it leaves the box.
    const share = Math.min(...ends.map(([low, high], k) => {
      const beyond = next[k] > high ? high : next[k] < low ? low : NaN;
      return Number.isNaN(beyond) ? 1 : Math.max((beyond - at[k]) / (next[k] - at[k]), 0);
    }));
    path.push(along(at, difference(next, at), share));
    if (share < 1 || isEnd(path)) return path;
    const end = points.find((point) => distance(point.at, next) < near);
    if (end && isAway) return [...path, end.at];
    isAway ||= !points.some((point) => distance(point.at, next) < 2 * near);
  }
  return path;
}

/** Numbers of two points between which a line turns once, and comes so many steps beside itself. */
function turnOf(path: Pair[], step: number, apart: number): Pair | null {
  const around = Math.max(0.75, 1.25 * apart) * step;
  const places = new Map<string, number[]>();
  const cellOf = (at: Pair) => at.map((x) => Math.floor(x / around));
  for (let n = 0; n < path.length; n += 1) {
    const [i, j] = cellOf(path[n]);
    for (let m = 0; m < 9; m += 1) {
      for (const before of places.get(`${i + (m % 3) - 1} ${j + Math.floor(m / 3) - 1}`) ?? []) {
        if (n - before <= LEAST_TURN || distance(path[n], path[before]) > around || before + 1 >= path.length) continue;
        const way = difference(path[before + 1], path[Math.max(before - 1, 0)]);
        const gap = difference(path[n], path[before]);
        const aside = Math.abs(gap[0] * way[1] - gap[1] * way[0]) / Math.max(Math.hypot(...way), 1e-300);
        if (aside < apart * step) return [before, n];
      }
    }
    const name = `${i} ${j}`;
    places.set(name, [...(places.get(name) ?? []), n]);
  }
  return null;
}
