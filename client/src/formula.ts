// A flow from a formula: its velocity at any nodes, computed here. flowtex/field/formula/grammar.py makes
// the trees, and flowtex/rendering/webgl/velocity.py what else comes. As there is no finest level of a
// formula, the source has tiles of every level, each a grid of nodes in the plane.

import type { Camera } from "./camera.ts";
import { closedOrbits, fixedPoints, nullclines, separatrices, trajectory, type Ends, type Pair } from "./fixedpoints.ts";
import { LINE, stepOf, type FormulaHeader, type Header, type MarkKind, type NamedPart, type Settings, type TileHeader, type RangeRules, type Tree } from "./protocol.ts";
import { rangeOf } from "./ranges.ts";
import { nameOf, type PlaceOf, type TileKey } from "./tilechoice.ts";
import { subtract, toFrame, type Vector } from "./vectors.ts";

type Values = Record<string, number>;
type Evaluate = (values: Values) => number;

/** Before the name of a parameter among the settings. */
const PARAMETER = "formula.";
/** Cells that a tile has around it, and texels before its first node. */
const [HALO, BEFORE] = [36, 8];
/** Mip levels of a tile, numbers of a block's place, and one in half precision. */
const [LEVELS, PLACE, HALF_ONE] = [3, 5, 0x3c00];
/** Speeds from which on a formula counts as undefined. */
const MOST_SPEED = 1e30;
/** Saddles of which there are lines: as many as can be asked for. */
const MOST_SADDLES = 50;
/** Size of a window over that of the view, at least, and steps of its middle over its size: as in Python. */
const [WINDOW_VIEWS, WINDOW_STEPS] = [2, 4];

/** What operations do with two numbers or more; as OPERATIONS of Python. */
const OPERATIONS = new Map<string, (...values: number[]) => number>(
  Object.entries({
    "+": (a, b) => a + b,
    "*": (a, b) => a * b,
    "/": (a, b) => a / b,
    "^": (a, b) => a ** b,
    "<": (a, b) => Number(a < b),
    ">": (a, b) => Number(a > b),
    "<=": (a, b) => Number(a <= b),
    ">=": (a, b) => Number(a >= b),
    neg: (a) => -a,
    ln: Math.log,
    mod: (a, b) => a - b * Math.floor(a / b),
    where: (a, b, c) => (a ? b : c),
    min: (a, b) => Math.min(a, b),
    max: (a, b) => Math.max(a, b),
  } as Record<string, (...values: number[]) => number>),
);
for (const name of "sin cos tan asin acos atan atan2 sinh cosh tanh exp log log2 log10 sqrt abs sign floor ceil hypot".split(" ")) {
  OPERATIONS.set(name, Math[name as "sin"]);
}

/** What computes a tree: closures of numbers, names and operations alone. */
export function compiled(tree: Tree): Evaluate {
  if (typeof tree === "number") return () => tree;
  if (typeof tree === "string") return (values) => values[tree];
  const [name, ...parts] = tree;
  const call = OPERATIONS.get(String(name));
  if (!call) throw new Error(`the formula has the operation "${name}", which this client does not support`);
  const [first, second, ...rest] = parts.map(compiled);
  if (!second) return (values) => call(first(values));
  if (!rest.length) return (values) => call(first(values), second(values));
  if (name === "where") return (values) => (first(values) ? second(values) : rest[0](values));
  return (values) => rest.reduce((sum, part) => call(sum, part(values)), call(first(values), second(values)));
}

/** Rows and columns of nodes of a level, from one to another, both among them. */
interface Window {
  level: number;
  from: [row: number, column: number];
  to: [row: number, column: number];
}

/** The nodes of a formula in the plane of its surface. */
class Grid {
  private readonly header: Header;
  private readonly formula: FormulaHeader;
  private readonly rates: Evaluate[];
  private readonly gradients: Evaluate[];

  constructor(header: Header, formula: FormulaHeader) {
    [this.header, this.formula] = [header, formula];
    this.rates = formula.trees.map(compiled);
    this.gradients = formula.gradient.map(compiled);
  }

  /** Coordinate of a line of nodes of a level; `axis` is 0 for rows. */
  private at(axis: number, level: number, line: number): number {
    const [low, high] = this.formula.ends[1 - axis];
    const cells = (this.header.geometry.shape[axis] - 1) * 2 ** this.doublings(level);
    return line === cells ? high : low + ((high - low) * line) / cells;
  }

  get ends(): FormulaHeader["ends"] {
    return this.formula.ends;
  }

  /** What computes the rates at a time, and their derivatives. */
  rate(time: number, parameters: Values): { rate: (x: number, y: number) => Pair; gradient: (x: number, y: number) => number[] } {
    const values: Values = { ...parameters, t: time };
    const [xName, yName] = this.formula.names;
    const at = (evaluates: Evaluate[]) => (x: number, y: number) => {
      values[xName] = x;
      values[yName] = y;
      return evaluates.map((evaluate) => evaluate(values));
    };
    return { rate: at(this.rates) as (x: number, y: number) => Pair, gradient: at(this.gradients) };
  }

  /** How many times a level is finer than the root. */
  doublings(level: number): number {
    return (this.header.pyramid?.depth ?? 0) - level;
  }

  /** Number of nodes of a level. */
  shape(level: number): [number, number] {
    return this.header.geometry.shape.map((n) => (n - 1) * 2 ** this.doublings(level) + 1) as [number, number];
  }

  /** Where a node is in the surface's frame. */
  local(level: number, row: number, column: number): Vector {
    return this.localOf([this.at(1, level, column), this.at(0, level, row)]);
  }

  /** The same of a place in the plane. */
  localOf([x, y]: Pair): Vector {
    const { center, frame } = this.header.geometry;
    return toFrame(frame, subtract([x, y, 0], center as Vector));
  }

  /** The flow at the nodes of a window, as Python sends it, and the speed. */
  flow({ level, from, to }: Window, step: number, parameters: Values) {
    const [rows, columns] = [to[0] - from[0] + 1, to[1] - from[1] + 1];
    const { speed: { typical }, slices } = this.header;
    const share = 2 ** -this.doublings(level);
    const size = (slices.trace?.unit ?? 1) * share;
    const [dx, dy] = [1, 0].map((axis) => this.at(axis, level, 1) - this.at(axis, level, 0));
    const data = new Float32Array(3 * rows * columns);
    const speeds = new Float32Array(rows * columns);
    const values: Values = { ...parameters, t: slices.times[step] };
    const [xName, yName] = this.formula.names;
    for (let j = 0, n = 0; j < rows; j += 1) {
      values[yName] = this.at(0, level, from[0] + j);
      for (let i = 0; i < columns; i += 1, n += 1) {
        values[xName] = this.at(1, level, from[1] + i);
        const [u, v] = this.rates.map((rate) => rate(values));
        const speed = Math.hypot(u, v);
        // Where it is undefined the velocity is zero.
        if (!(speed > 0 && speed < MOST_SPEED)) continue;
        speeds[n] = speed;
        data.set([((u / dx) * size) / speed, ((v / dy) * size) / speed, speed / typical], 3 * n);
      }
    }
    return { flow: { data, shape: [rows, columns, 3] }, speeds };
  }

  /** Speeds at the nodes of the whole at a time, where they are defined. */
  speeds(time: number, parameters: Values): number[] {
    const { rate } = this.rate(time, parameters);
    const [rows, columns] = this.header.geometry.shape;
    const root = this.header.pyramid?.depth ?? 0;
    const speeds: number[] = [];
    for (let j = 0; j < rows; j += 1) {
      const y = this.at(0, root, j);
      for (let i = 0; i < columns; i += 1) {
        const speed = Math.hypot(...rate(this.at(1, root, i), y));
        if (speed < MOST_SPEED) speeds.push(speed);
      }
    }
    return speeds;
  }

  /** Positions of the nodes of a window and of those around it, relative to its middle. */
  padded({ level, from, to }: Window) {
    const middle = this.local(level, 0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]));
    const [rows, columns] = [to[0] - from[0] + 3, to[1] - from[1] + 3];
    const data = new Float32Array(3 * rows * columns);
    for (let j = 0, n = 0; j < rows; j += 1) {
      for (let i = 0; i < columns; i += 1, n += 3) {
        data.set(subtract(this.local(level, from[0] + j - 1, from[1] + i - 1), middle), n);
      }
    }
    return { middle, part: { data, shape: [rows, columns, 3] } };
  }
}

/** Where the blocks of each level lie, and how large their cells are. */
export function placesOf(header: Header): PlaceOf | null {
  const { formula, mesh } = header;
  if (!formula) return null;
  const grid = new Grid(header, formula);
  return (level, row, column) => {
    const shape = grid.shape(level);
    const corner = (far: number) =>
      grid.local(
        level,
        Math.min((row + far) * mesh.tileCells, shape[0] - 1),
        Math.min((column + far) * mesh.tileCells, shape[1] - 1),
      );
    const [low, high] = [corner(0), corner(1)];
    const cell = Math.hypot(...subtract(grid.local(level, 0, 1), grid.local(level, 0, 0)));
    const own = low.map((x, k) => 0.5 * (x + high[k]));
    const { center, frame } = header.geometry;
    const place = [0, 1, 2].map((k) => center[k] + own.reduce((sum, x, m) => sum + frame[3 * m + k] * x, 0));
    return [...place, 0.5 * Math.hypot(...subtract(high, low)) + cell, cell];
  };
}

/** Most time steps of which the speeds are measured. */
const MEASURED_STEPS = 8;

/** Gives what a formula is at the nodes of the whole, and of tiles: a Source. */
export class FormulaSource {
  readonly hasSteps = true;
  readonly hasMarks = true;
  readonly atOnce = 2;
  private readonly header: Header;
  private readonly grid: Grid;
  private readonly rules: RangeRules;
  private parameters: Values = {};
  /** Whether they have been others than those of the header. */
  private hasMoved = false;
  /** Says which numbers belong to digests. */
  private state = "";
  /** Where nullclines are as fine as the view. */
  private window: Ends | null = null;

  constructor(header: Header, formula: FormulaHeader) {
    this.header = header;
    this.grid = new Grid(header, formula);
    this.rules = formula.range;
    this.follow(header.settings);
  }

  /** Take parameters from settings; returns whether they have changed. */
  follow(settings: Settings): boolean {
    const own = Object.entries(settings).filter(([name]) => name.startsWith(PARAMETER));
    this.parameters = Object.fromEntries(own.map(([name, value]) => [name.slice(PARAMETER.length), Number(value)]));
    const before = this.state;
    this.state = JSON.stringify([this.header.formula, this.header.geometry, this.parameters]);
    return before !== this.state;
  }

  /** Put the typical speed and the ranges of other parameters than its own into the header, if they are others. */
  fit(): boolean {
    const { table } = this.header;
    const isMoved = table.some(({ name, default: own }) => name.startsWith(PARAMETER) && this.parameters[name.slice(PARAMETER.length)] !== own);
    if (isMoved || this.hasMoved) this.measure();
    this.hasMoved ||= isMoved;
    return this.hasMoved;
  }

  private measure(): void {
    const { speed, scalars, slices } = this.header;
    const every = Math.ceil(slices.times.length / MEASURED_STEPS);
    const steps = [...slices.times.keys()].filter((step) => step % every === 0);
    const values = steps.flatMap((step) => this.grid.speeds(slices.times[step], this.parameters));
    const moving = values.filter((value) => value > 0);
    const sum = moving.reduce((total, value) => total + value ** 2, 0);
    if (!slices.trace?.timed && moving.length) speed.typical = Math.sqrt(sum / moving.length);
    const range = rangeOf(Float64Array.from(values), this.rules);
    const choice = scalars.choices[scalars.number];
    if (choice && range) Object.assign(choice, range);
  }

  /** Follow a camera: the nullclines of these parts that it sees otherwise than before. */
  look(camera: Camera, names: Iterable<string>): NamedPart[] {
    const { ends } = this.grid;
    const side = Math.max(...ends.map(([low, high]) => high - low));
    const size = side / 2 ** Math.floor(Math.log2(side / (2 * WINDOW_VIEWS * camera.height * Math.max(camera.aspect, 1))));
    const step = size / WINDOW_STEPS;
    const window = ends.map(([low, high], k) => {
      const middle = low + step * Math.round((camera.state.focal_point[k] - low) / step);
      return [Math.max(middle - size / 2, low), Math.min(middle + size / 2, high)];
    }) as Ends;
    const isPart = size < side && window.every(([low, high]) => low < high);
    if (String(this.window) === String(isPart ? window : null)) return [];
    this.window = isPart ? window : null;
    return [...names].filter((name) => name.startsWith("nullclines/")).map((name) => this.marks("nullclines", stepOf(name)));
  }

  readonly load = (key: TileKey | null, steps: number[], _signal?: unknown, _has?: unknown, mark?: MarkKind) => {
    if (mark) return Promise.resolve(steps.map((step) => this.marks(mark, step)));
    return Promise.resolve(key ? this.tile(key, steps) : this.whole(steps));
  };

  /** Fixed points, nullclines, or separatrices and closed orbits, at a step; flowtex/rendering/webgl/marks.py says in which form. */
  private marks(kind: MarkKind, step: number): NamedPart {
    const { grid, header } = this;
    const { rate, gradient } = grid.rate(header.slices.times[step], this.parameters);
    const points = kind === "nullclines" ? [] : fixedPoints(rate, gradient, grid.ends);
    const kinds = header.structure?.kinds.map(({ name }) => name) ?? [];
    const row = (at: Pair, number: number) => [...grid.localOf(at), number];
    const rows: number[][] = [];
    if (kind === "nullclines") {
      nullclines(rate, grid.ends, this.window).forEach((pieces, component) => rows.push(...pieces.flat().map((at) => row(at, component))));
    } else if (kind === "critical") rows.push(...points.map((point) => row(point.at, kinds.indexOf(point.kind))));
    else {
      closedOrbits(rate, grid.ends, points).forEach(({ path, isStable }, n) => {
        const number = LINE.orbit + LINE.leaving * Number(isStable) + (n % 2);
        rows.push(...path.map((at) => row(at, number)));
      });
      const saddles = points.filter(({ ways }) => ways.length).slice(0, MOST_SADDLES);
      separatrices(rate, gradient, grid.ends, points, saddles).forEach(({ path, orbit, saddle, leaves }, n) => {
        const number = LINE.saddle * saddles.indexOf(saddle) + LINE.leaving * Number(leaves) + (n % 2);
        rows.push(...path.map((at) => row(at, number)));
        rows.push(...(orbit ?? []).map((at) => row(at, number + LINE.orbit)));
      });
    }
    const part = this.named(`${kind}/${step}`, { data: Float32Array.from(rows.flat()), shape: [rows.length, 4] });
    return kind === "nullclines" ? { ...part, digest: `${part.digest} ${this.window}` } : part;
  }

  /** The trajectory through a point and the velocity there; none of a flow that varies. */
  trajectory([x, y]: Vector): { path: Vector[]; velocity: Vector } | null {
    const { grid, header } = this;
    if (header.slices.times.length > 1) return null;
    const { rate, gradient } = grid.rate(header.slices.times[0], this.parameters);
    const inSpace = ([u, v]: Pair): Vector => [u, v, 0];
    const velocity = inSpace(rate(x, y));
    if (!velocity.every(Number.isFinite)) return null;
    const points = fixedPoints(rate, gradient, grid.ends);
    return { path: trajectory(rate, grid.ends, points, [x, y]).map(inSpace), velocity };
  }

  /** The flow and the values of the whole at some steps. */
  private whole(steps: number[]): NamedPart[] {
    const { shape } = this.header.geometry;
    const level = this.header.pyramid?.depth ?? 0;
    return this.parts({ level, from: [0, 0], to: [shape[0] - 1, shape[1] - 1] }, steps, [0, 0], shape);
  }

  private named(name: string, part: Pick<NamedPart, "data" | "shape">): NamedPart {
    return { ...part, name, digest: `${this.state} ${name}` };
  }

  private parts(window: Window, steps: number[], drawn: number[], shape: readonly number[], prefix = ""): NamedPart[] {
    return steps.flatMap((step) => {
      const { flow, speeds } = this.grid.flow(window, step, this.parameters);
      const width = flow.shape[1];
      const data = new Float32Array(shape[0] * shape[1]);
      for (let j = 0; j < shape[0]; j += 1) {
        const start = (j + drawn[0]) * width + drawn[1];
        data.set(speeds.subarray(start, start + shape[1]), j * shape[1]);
      }
      const values = `scalars/${this.header.scalars.steps > 1 ? step : 0}`;
      return [this.named(`${prefix}flow/${step}`, flow), this.named(`${prefix}${values}`, { data, shape: [...shape] })];
    });
  }

  private tile(key: TileKey, steps: number[]): NamedPart[] {
    const { header, grid } = this;
    const { mesh, pyramid, geometry, slices } = header;
    const { trace } = slices;
    if (!pyramid || !trace) throw new Error("the levels of the formula are missing");
    const [level, ...place] = key;
    const cells = pyramid.tileBlocks * mesh.tileCells;
    const count = grid.shape(level);
    const first = place.map((at) => at * cells);
    const last = first.map((at, axis) => Math.min(at + cells, count[axis] - 1));
    const from = first.map((at) => Math.max(at - HALO, 0)) as [number, number];
    const to = last.map((at, axis) => Math.min(at + HALO, count[axis] - 1)) as [number, number];
    const nodes = to.map((at, axis) => at - from[axis] + 1) as [number, number];
    const drawn = first.map((at, axis) => at - from[axis]) as [number, number];
    const shape = last.map((at, axis) => at - first[axis] + 1) as [number, number];
    const window = { level, from, to };
    const { middle, part: padded } = grid.padded(window);
    const share = 2 ** -grid.doublings(level);
    const lags = [...slices.lags.filter((lag) => lag < pyramid.pathCells), pyramid.pathCells];
    const texels = (n: number) => ({ before: BEFORE, size: BEFORE * Math.ceil((n + 2 * BEFORE) / BEFORE) });
    const own: TileHeader = {
      geometry: { ...geometry, shape, rows: texels(shape[0]), columns: texels(shape[1]), levels: LEVELS },
      slices: {
        ...slices,
        lags,
        count: slices.count - slices.sides * (slices.lags.length - lags.length),
        extra: [],
        unit: slices.unit * share,
        lagUnit: slices.lagUnit * share,
        cell: slices.cell * share,
        critical: slices.critical * share,
        trace: {
          ...trace,
          nodes,
          drawn,
          first: drawn.map((n) => n - BEFORE) as [number, number],
          middle,
          unit: trace.unit * share,
          timed: trace.timed && { ...trace.timed, unit: trace.timed.unit * share },
        },
      },
    };
    const prefix = `tile/${nameOf(key)}/`;
    const text = new TextEncoder().encode(JSON.stringify(own));
    const parts = this.parts(window, steps, drawn, shape, prefix);
    return [
      this.named(`${prefix}header`, { data: text, shape: [text.length] }),
      this.named(`${prefix}padded`, padded),
      this.named(`${prefix}unit`, { data: new Uint16Array(nodes[0] * nodes[1]).fill(HALF_ONE), shape: nodes }),
      this.named(`${prefix}mesh`, this.blocks(key, shape)),
      ...parts,
    ];
  }

  /** The places of blocks, by which triangles are chosen. */
  private blocks(key: TileKey, shape: [number, number]) {
    const { mesh, pyramid } = this.header;
    const [rows, columns] = shape.map((n) => Math.ceil((n - 1) / mesh.tileCells));
    const data = new Float32Array(rows * columns * PLACE);
    const place = placesOf(this.header);
    const tileBlocks = pyramid?.tileBlocks ?? 1;
    for (let block = 0; block < rows * columns; block += 1) {
      const [row, column] = [Math.floor(block / columns), block % columns];
      const where = place?.(key[0], key[1] * tileBlocks + row, key[2] * tileBlocks + column) ?? [];
      data.set(where, block * PLACE);
    }
    return { data, shape: [rows, columns, PLACE] };
  }
}
