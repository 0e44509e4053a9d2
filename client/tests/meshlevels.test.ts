import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { join, MeshLevels, type Sight } from "../src/meshlevels.ts";
import type { MeshLimits } from "../src/protocol.ts";

interface Mesh {
  shape: [number, number];
  periodic: [boolean, boolean];
  tiles: number[];
  hole: number[];
  limits: MeshLimits;
  views: { sight: Sight; levels: number[]; triangles: number; checksum: number }[];
}

// What Python computes: tests/rendering/test_client_numbers.py.
const file = new URL("mesh.json", import.meta.url);
const data: Mesh = JSON.parse(readFileSync(file, "utf8"));

function mesh(): MeshLevels {
  const { shape, hole, limits } = data;
  const cells = new Uint8Array((shape[0] - 1) * (shape[1] - 1)).fill(1);
  for (let j = hole[0]; j < hole[1]; j += 1) {
    cells.fill(0, j * (shape[1] - 1) + hole[2], j * (shape[1] - 1) + hole[3]);
  }
  const blocks = Float32Array.from(data.tiles, (value) => (value >= 1e30 ? Infinity : value));
  return new MeshLevels({ ...data, blocks, cells }, limits);
}

for (const [n, { sight, levels, triangles, checksum }] of data.views.entries()) {
  test(`levels and triangles are those of Python: view ${n}`, () => {
    const found = mesh().levels(sight);
    assert.deepEqual(Array.from(found), levels);
    const { shape } = mesh();
    const region = { step: 0, row: 0, column: 0, shape, levels: found };
    const [joins] = join([region], shape, data.periodic, Math.log2(data.limits.tileCells));
    const index = mesh().triangles(found, joins);
    const nodes = Array.from({ length: index.length / 3 }, (_, k) =>
      Array.from(index.slice(3 * k, 3 * k + 3)).sort((a, b) => a - b),
    );
    nodes.sort((a, b) => a[0] - b[0] || a[1] - b[1] || a[2] - b[2]);
    assert.equal(nodes.length, triangles);
    const sum = nodes.flat().reduce((result, node) => (31 * result + node) % 1000003, 0);
    assert.equal(sum, checksum);
  });
}
