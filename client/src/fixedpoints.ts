// Fixed points of a formula, the separatrices of its saddles, and closed orbits: zeros of the rates themselves,
// and lines that are followed along them. The search for points is that of
// flowtex/trace/structure/formula_lines.py, which describes the constants.

export type Pair = [x: number, y: number];
/** The rates of change at a place; not finite if they do not exist. */
export type Rate = (x: number, y: number) => Pair;
/** Their derivatives, row by row. */
export type Gradient = (x: number, y: number) => number[];
/** Least and greatest x and y. */
export type Ends = [x: Pair, y: Pair];

export interface FixedPoint {
  at: Pair;
  kind: string;
  /** Turns of the rates on a small circle around it. */
  index: number;
  /** Real and imaginary part of both, the larger real part first. */
  eigenvalues: [Pair, Pair];
  /** By which the strongest come first. */
  steepness: number;
  /** Unit vectors along which separatrices leave it, or come to it. */
  ways: Way[];
}

interface Way {
  way: Pair;
  leaves: boolean;
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

const [CELLS, LEAST_CELLS] = [160, 8];
const [NEWTON_STEPS, FAR] = [100, 3];
const [LAST_STEP, REMAINS, BEYOND] = [1e-6, 1e-11, 1e-6];
const [SAME, SAME_DEGENERATE] = [1e-6, 0.05];
const [CHANGE, DEGENERATE] = [1e-2, 1e-5];
const [SINGULAR, ROUNDING, REAL_SHARE] = [1e-13, 1e-9, 1e-6];
const [AROUND, ON_LINE] = [0.1, 0.02];
const [RADIUS, CIRCLE, MOST_DIRECTIONS] = [0.05, 720, 24];
const [TURN_RADIUS, TURN_STEPS, RETURNED] = [2, 400, 1e-7];
/** Cells in which the lines of zeros are straight, along the longer side. */
const NULLCLINE_CELLS = 256;
/** Halvings of a side that such a line crosses, and what they leave of a rate that goes to zero there at most. */
const [NULLCLINE_HALVINGS, LEFT] = [12, 0.25];
/** Steps along the diagonal, and those of a line at most; the first one and the last one to a point, in steps. */
const [STEPS, MOST_STEPS, BEGIN, END] = [800, 2400, 0.02, 1.5];
/** Steps of a turn at least; distances of two turns at which a line is closed, and winds up, in steps. */
const [LEAST_TURN, CLOSED, WOUND] = [8, 0.08, 2];

/** Points around which closed orbits are looked for; places of a ray: ratio, and distance as a share of the diagonal. */
const [MOST_AROUND, RATIO, APART] = [8, 1.2, 0.03];
/** How much farther out or in lines return where they move away, as a share of the distance; halvings of a stretch. */
const [MOVED, HALVINGS] = [1e-5, 28];
/** Longest step of a turn, as a share of the distance. */
const FINER = 1 / 16;
/** Growth beside a turn, as an exponent, from which it is an orbit. */
const GROWTH = 1e-3;

const difference = (a: Pair, b: Pair): Pair => [a[0] - b[0], a[1] - b[1]];
const along = (a: Pair, way: Pair, step: number): Pair => [a[0] + step * way[0], a[1] + step * way[1]];
const distance = (a: Pair, b: Pair) => Math.hypot(a[0] - b[0], a[1] - b[1]);
const larger = (a: Pair) => Math.max(Math.abs(a[0]), Math.abs(a[1]));
const clipped = (at: Pair, ends: Ends) => at.map((x, k) => Math.min(Math.max(x, ends[k][0]), ends[k][1])) as Pair;

interface Zero {
  at: Pair;
  scale: Pair;
  left: number;
  isDegenerate: boolean;
}

/** The isolated fixed points in a box, the strongest first. */
export function fixedPoints(rate: Rate, gradient: Gradient, ends: Ends): FixedPoint[] {
  const sides = ends.map(([low, high]) => high - low) as Pair;
  const counts = sides.map((side) => Math.max(Math.round((CELLS * side) / Math.max(...sides)), LEAST_CELLS)) as Pair;
  const cell: Pair = [sides[0] / counts[0], sides[1] / counts[1]];
  const search = new Search(rate, gradient, cell);
  const apart = (one: Pair, other: Pair) => larger([(one[0] - other[0]) / cell[0], (one[1] - other[1]) / cell[1]]);
  const found: Zero[] = [];
  for (const { at: start, scale } of starts(rate, ends, counts, cell)) {
    const zero = search.zero(start, scale);
    if (!zero || apart(zero.at, clipped(zero.at, ends)) > BEYOND) continue;
    found.push({ ...zero, at: clipped(zero.at, ends), isDegenerate: search.isDegenerate(zero.at, scale) });
  }
  found.sort((one, two) => Number(two.isDegenerate) - Number(one.isDegenerate) || one.left - two.left);
  const kept: Zero[] = [];
  for (const zero of found) {
    const isNew = kept.every(({ at, isDegenerate }) => apart(zero.at, at) >= (isDegenerate ? SAME_DEGENERATE : SAME));
    if (isNew) kept.push(zero);
  }
  const isOnLine = ({ at, scale, isDegenerate }: Zero) => isDegenerate && search.sides(AROUND, at).some((near) => {
    const other = search.zero(near, scale);
    return other && apart(other.at, at) > ON_LINE;
  });
  const zeros = kept.filter((zero) => !isOnLine(zero));
  for (const { at } of zeros) at.forEach((x, k) => { if (Math.abs(x) < REMAINS * cell[k]) at[k] = 0; });
  const points = zeros.map((zero) => {
    const free = (other: Zero) => Math.hypot((other.at[0] - zero.at[0]) / cell[0], (other.at[1] - zero.at[1]) / cell[1]);
    return search.point(zero, Math.min(Infinity, ...zeros.filter((other) => other !== zero).map(free)));
  });
  return points.sort((one, two) => two.steepness - one.steepness);
}

/** Middles of cells that may have a zero, and the largest rates near them: each changes there by as much as it is. */
function starts(rate: Rate, [xs, ys]: Ends, [columns, rows]: Pair, cell: Pair): { at: Pair; scale: Pair }[] {
  const nodes = [0, 1].map(() => new Float64Array((columns + 1) * (rows + 1)));
  for (let n = 0; n < nodes[0].length; n += 1) {
    const values = rate(xs[0] + cell[0] * (n % (columns + 1)), ys[0] + cell[1] * Math.floor(n / (columns + 1)));
    values.forEach((value, k) => (nodes[k][n] = Number.isFinite(value) ? value : NaN));
  }
  const found: { at: Pair; scale: Pair }[] = [];
  for (let j = 0; j < rows; j += 1) {
    for (let i = 0; i < columns; i += 1) {
      const scale: Pair = [0, 0];
      let isChosen = true;
      for (let k = 0; k < 2 && isChosen; k += 1) {
        let least = Infinity;
        let top = -Infinity;
        let bottom = Infinity;
        for (let row = Math.max(j - 1, 0); row <= Math.min(j + 2, rows); row += 1) {
          for (let column = Math.max(i - 1, 0); column <= Math.min(i + 2, columns); column += 1) {
            const value = nodes[k][row * (columns + 1) + column];
            if (Number.isNaN(value)) continue;
            if (value > top) top = value;
            if (value < bottom) bottom = value;
            const isCorner = (row === j || row === j + 1) && (column === i || column === i + 1);
            if (isCorner && Math.abs(value) < least) least = Math.abs(value);
          }
        }
        scale[k] = Math.max(Math.abs(top), Math.abs(bottom));
        isChosen = scale[k] < Infinity && least <= top - bottom;
      }
      if (!isChosen || !(larger(scale) > 0)) continue;
      found.push({ at: [xs[0] + cell[0] * (i + 0.5), ys[0] + cell[1] * (j + 0.5)], scale: [scale[0] || 1, scale[1] || 1] });
    }
  }
  return found;
}

/** Newton's method for rates, and what they are around zeros. */
class Search {
  private readonly rate: Rate;
  private readonly gradient: Gradient;
  private readonly cell: Pair;

  constructor(rate: Rate, gradient: Gradient, cell: Pair) {
    [this.rate, this.gradient, this.cell] = [rate, gradient, cell];
  }

  /** Eight places so many cells around one. */
  sides(cells: number, at: Pair): Pair[] {
    const { cell } = this;
    const ways: Pair[] = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
    return ways.map(([x, y]) => [at[0] + cells * cell[0] * x, at[1] + cells * cell[1] * y]);
  }

  private matrix(at: Pair, scale: Pair): number[] {
    return this.gradient(...at).map((value, n) => (value * this.cell[n % 2]) / scale[n >> 1]);
  }

  /** The largest rate, Newton's step in cells, and the share of the determinant. */
  private step(at: Pair, scale: Pair): { left: number; step: Pair; share: number } {
    const [u, v] = this.rate(...at).map((value, k) => value / scale[k]);
    const [a, b, c, d] = this.matrix(at, scale);
    const [size, determinant] = [a * a + b * b + c * c + d * d, a * d - b * c];
    const share = Math.abs(determinant) / size;
    // Along a line of zeros the shortest step.
    const step: Pair = share > 0.1 * SINGULAR
      ? [(b * v - d * u) / determinant, (c * u - a * v) / determinant]
      : [-(a * u + c * v) / size, -(b * u + d * v) / size];
    return { left: larger([u, v]), step, share };
  }

  /** The zero near a place. */
  zero(start: Pair, scale: Pair): { at: Pair; scale: Pair; left: number } | null {
    const { cell } = this;
    let [at, best, least] = [start, start, Infinity];
    for (let n = 0; n < NEWTON_STEPS; n += 1) {
      const { left, step } = this.step(at, scale);
      if (left < least) [best, least] = [at, left];
      const length = larger(step);
      const share = 1 / Math.max(length, 1);
      at = [at[0] + cell[0] * step[0] * share, at[1] + cell[1] * step[1] * share];
      const isNear = at.every((x, k) => Math.abs(x - start[k]) <= FAR * cell[k]);
      if (!isNear || !(length > SINGULAR)) break;
    }
    const { left, step, share } = this.step(best, scale);
    const isZero = left <= REMAINS || (larger(step) < LAST_STEP && share > SINGULAR);
    return isZero ? { at: best, scale, left } : null;
  }

  /** Whether the determinant is zero, or so near that rounding hides it. */
  isDegenerate(at: Pair, scale: Pair): boolean {
    const [here, ...near] = [at, ...this.sides(CHANGE, at)].map((place) => {
      const [a, b, c, d] = this.matrix(place, scale);
      return { determinant: a * d - b * c, size: a * a + b * b + c * c + d * d };
    });
    const changes = near.map(({ determinant }) => Math.abs(determinant - here.determinant)).filter(Number.isFinite);
    const determinant = Math.abs(here.determinant);
    return !(determinant > SINGULAR * here.size && determinant * CHANGE >= DEGENERATE * Math.max(0, ...changes));
  }

  /** What the flow around a zero does, which is so many cells away from others. */
  point({ at, isDegenerate }: Zero, free: number): FixedPoint {
    const [a, b, c, d] = this.gradient(...at);
    const [trace, determinant] = [a + d, a * d - b * c];
    const [square, size] = [trace ** 2 / 4 - determinant, Math.max(...[a, b, c, d].map(Math.abs))];
    const root = Math.sqrt(Math.abs(square));
    const eigenvalues: [Pair, Pair] = square > 0 ? [[trace / 2 + root, 0], [trace / 2 - root, 0]] : [[trace / 2, root], [trace / 2, -root]];
    const result = { at, eigenvalues, steepness: Math.abs(determinant), ways: [] as Way[], kind: "degenerate", index: Math.sign(determinant) };
    if (isDegenerate) return { ...result, index: this.turns(at, Math.min(RADIUS, 0.3 * free)), ways: this.directions(at) };
    if (determinant < 0) {
      const way = (value: number): Pair => {
        const [one, two]: Pair[] = [[b, value - a], [value - d, c]];
        const [x, y] = Math.hypot(...one) > Math.hypot(...two) ? one : two;
        return [x / Math.hypot(x, y), y / Math.hypot(x, y)];
      };
      const ways = [root, -root].flatMap((part) => {
        const [x, y] = way(trace / 2 + part);
        return ([[x, y], [-x, -y]] as Pair[]).map((each) => ({ way: each, leaves: part > 0 }));
      });
      return { ...result, kind: "saddle", ways };
    }
    if (!(square < 0 && root > REAL_SHARE * Math.sqrt(determinant))) return { ...result, kind: trace > 0 ? "source" : "sink" };
    const growth = Math.abs(trace) <= ROUNDING * size ? this.growth(at, [a, b, c, d], Math.min(TURN_RADIUS, 0.2 * free)) : trace;
    return { ...result, kind: growth > 0 ? "spiral source" : growth < 0 ? "spiral sink" : "centre" };
  }

  /** Turns of the rates on a circle of so many cells. */
  private turns(at: Pair, radius: number): number {
    const angles = circle().map((angle) => {
      const [u, v] = this.rate(at[0] + radius * this.cell[0] * Math.cos(angle), at[1] + radius * this.cell[1] * Math.sin(angle));
      return Math.atan2(v, u);
    });
    const turned = angles.slice(1).reduce((sum, angle, n) => sum + folded(angle - angles[n]), 0);
    return Math.round(turned / (2 * Math.PI)) || 0;
  }

  /** Directions of the separatrices of a degenerate zero: those of lines between its sectors. */
  private directions(at: Pair): Way[] {
    const radius = RADIUS * Math.max(...this.cell);
    const wayOf = (angle: number): Pair => [Math.cos(angle), Math.sin(angle)];
    const radial = (angle: number) => {
      const way = wayOf(angle);
      const [u, v] = this.rate(...along(at, way, radius));
      return { across: way[0] * v - way[1] * u, out: way[0] * u + way[1] * v };
    };
    const angles = circle();
    const across = angles.map((angle) => radial(angle).across);
    const found = angles.flatMap((low, n) => {
      if (!(across[n] * across[n + 1] < 0)) return [];
      let high = angles[n + 1];
      for (let k = 0; k < 50; k += 1) {
        const middle = 0.5 * (low + high);
        if (radial(middle).across * across[n] > 0) low = middle;
        else high = middle;
      }
      return [{ way: wayOf(low), leaves: radial(low).out > 0 }];
    });
    if (found.length > MOST_DIRECTIONS) return [];
    return found.filter(({ leaves }, n) => [-1, 1].some((m) => found.at((n + m) % found.length)?.leaves !== leaves));
  }

  /** Growth of the radius in a turn around a zero with imaginary eigenvalues. */
  private growth(at: Pair, [a, b, c]: number[], cells: number): number {
    const turn = Math.sqrt(-a * a - b * c);
    // In w = (x, (a x + b y) / turn) the linear flow turns on circles.
    const radius = cells / Math.max(1 / this.cell[0], (turn + Math.abs(a)) / Math.abs(b) / this.cell[1]);
    const rate: Rate = (x, y) => {
      const [u, v] = this.rate(at[0] + x, at[1] + (turn * y - a * x) / b);
      return [u, (a * u + b * v) / turn];
    };
    let w: Pair = [radius, 0];
    for (let n = 0; n < TURN_STEPS + 4; n += 1) {
      w = stepped(rate, w, n < TURN_STEPS ? (2 * Math.PI) / TURN_STEPS / turn : w[1] / (turn * w[0]));
    }
    const growth = w[0] / radius - 1;
    return Math.abs(growth) > RETURNED ? growth : 0;
  }
}

const folded = (angle: number) => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));

/** Angles around a circle, the first one also at the end: no usual direction is one of these. */
function circle(): number[] {
  return Array.from({ length: CIRCLE + 1 }, (_, n) => 0.3 + (2 * Math.PI * n) / CIRCLE);
}

/** The place after a step of fourth order. */
function stepped(rate: Rate, at: Pair, step: number): Pair {
  const one = rate(...at);
  const two = rate(...along(at, one, step / 2));
  const three = rate(...along(at, two, step / 2));
  const four = rate(...along(at, three, step));
  const sum = (k: number) => (one[k] + 2 * two[k] + 2 * three[k] + four[k]) / 6;
  return along(at, [sum(0), sum(1)], step);
}

/**
 * Straight pieces of the lines in a box along which the rate of x is zero, and of those along which that of y is; in
 * a window they are finer.
 */
export function nullclines(rate: Rate, ends: Ends, window: Ends | null = null): [Pair, Pair][][] {
  const coarse = piecesIn(rate, ends);
  if (!window) return coarse;
  const isOutside = ([one, two]: [Pair, Pair]) => window.some(([low, high], k) => Math.abs(one[k] + two[k] - low - high) > high - low);
  const fine = piecesIn(rate, window);
  return coarse.map((pieces, k) => [...pieces.filter(isOutside), ...fine[k]]);
}

function piecesIn(rate: Rate, [xs, ys]: Ends): [Pair, Pair][][] {
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
        const [start, end] = [1, 2].map((m) => crossing((at) => rate(...at)[k], one.at, corners[(alone + m) % 3].at));
        if (start && end) pieces.push([start, end]);
      }
    }
    return pieces;
  });
}

/**
 * Where a rate goes to zero between two places; none where it jumps or has a pole. It has different signs at the
 * places, or is zero at the second one.
 */
function crossing(rate: (at: Pair) => number, one: Pair, two: Pair): Pair | null {
  const size = () => Math.max(Math.abs(rate(one)), Math.abs(rate(two)));
  const [first, isAbove] = [size(), rate(one) > 0];
  for (let n = 0; n < NULLCLINE_HALVINGS; n += 1) {
    const middle = along(one, difference(two, one), 0.5);
    if (rate(middle) > 0 === isAbove) one = middle;
    else two = middle;
  }
  const share = rate(one) / (rate(one) - rate(two));
  return size() < LEFT * first ? along(one, difference(two, one), Number.isFinite(share) ? share : 0.5) : null;
}

/** The separatrices of some points, along their ways. */
export function separatrices(rate: Rate, gradient: Gradient, ends: Ends, points: FixedPoint[], saddles: FixedPoint[]): Separatrix[] {
  const step = Math.hypot(...ends.map(([low, high]) => high - low)) / STEPS;
  return saddles.flatMap((saddle) =>
    saddle.ways.map(({ way, leaves }) => {
      const begin = along(saddle.at, way, BEGIN * step);
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
        orbit: turn && !ended && isIsolated(rate, gradient, turn) ? turn : null,
      };
    }),
  );
}

/**
 * Whether lines beside a turn come to it or leave it, by the divergence over its time; as in
 * flowtex/trace/structure/orbits.py.
 */
function isIsolated(rate: Rate, gradient: Gradient, turn: Pair[]): boolean {
  let growth = 0;
  for (let n = 1; n < turn.length; n += 1) {
    const [a, , , d] = gradient(...turn[n]);
    growth += ((a + d) * distance(turn[n], turn[n - 1])) / Math.hypot(...rate(...turn[n]));
  }
  return Math.abs(growth) > GROWTH;
}

/**
 * Closed orbits to which lines come, or which they leave: where lines return to a ray from a point that is no
 * saddle. flowtex/trace/structure/orbits.py finds them on grids.
 */
export function closedOrbits(rate: Rate, ends: Ends, points: FixedPoint[]): ClosedOrbit[] {
  const diagonal = Math.hypot(...ends.map(([low, high]) => high - low));
  const step = diagonal / STEPS;
  const found: ClosedOrbit[] = [];
  for (const { at: [x, y] } of points.filter(({ index }) => index > 0).slice(0, MOST_AROUND)) {
    /** The turn from a place of the ray on, forward or back; its last point is on the ray. */
    const turn = (place: number, way: number): Pair[] | null => {
      const length = Math.min(step, FINER * place);
      const side = Math.sign(way * rate(x + place, y)[1]);
      const isBack = (path: Pair[]) => {
        if (path.length <= LEAST_TURN) return false;
        const before = path[path.length - 2];
        const after = path[path.length - 1];
        return side * (before[1] - y) < 0 && side * (after[1] - y) >= 0 && after[0] > x;
      };
      const path = followed(rate, ends, points, [[x + place, y]], way * length, isBack);
      if (path.length < 2 || !isBack(path)) return null;
      const [before, after] = path.slice(-2);
      let rest = (way * length * (y - before[1])) / (after[1] - before[1]);
      for (let n = 0; n < 3; n += 1) {
        const at = stepped(unit(rate), before, rest);
        rest += (y - at[1]) / unit(rate)(...at)[1];
      }
      return [...path.slice(0, -1), stepped(unit(rate), before, rest)];
    };
    const moved = (place: number, way: number) => (turn(place, way)?.at(-1)?.[0] ?? NaN) - x - place;
    let last: { place: number; out: number } | null = null;
    for (let place = 2 * step; x + place < ends[0][1]; place += Math.min((RATIO - 1) * place, APART * diagonal)) {
      const forward = moved(place, 1);
      const out: number = Number.isNaN(forward) ? -moved(place, -1) : forward;
      if (Math.abs(out) <= MOVED * place) continue;
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
export function trajectory(rate: Rate, ends: Ends, points: FixedPoint[], at: Pair): Pair[] {
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

/** The rates as unit vectors. */
function unit(rate: Rate): Rate {
  return (x, y) => {
    const [u, v] = rate(x, y);
    const size = Math.hypot(u, v);
    return [u / size, v / size];
  };
}

/** The share of a step from one coordinate to another that lies before an end. */
function shareInside(from: number, to: number, [low, high]: Pair): number {
  if (to > high) return Math.max((high - from) / (to - from), 0);
  if (to < low) return Math.max((low - from) / (to - from), 0);
  return 1;
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
  const near = END * Math.abs(step);
  const direction = unit(rate);
  let isAway = false;
  for (let n = 0; n < MOST_STEPS; n += 1) {
    const at = path[path.length - 1];
    const next = stepped(direction, at, step);
    if (!Number.isFinite(next[0]) || !Number.isFinite(next[1])) return path;
    // It ends where it leaves the box.
    const share = Math.min(shareInside(at[0], next[0], ends[0]), shareInside(at[1], next[1], ends[1]));
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
