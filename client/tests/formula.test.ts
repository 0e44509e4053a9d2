import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { compiled, FormulaSource, placesOf } from "../src/formula.ts";
import type { FormulaHeader, Header, NamedPart, TileHeader, Tree } from "../src/protocol.ts";
import { assertClose as close } from "./close.ts";

// What Python computes: tests/rendering/test_client_numbers.py.
const data = JSON.parse(readFileSync(new URL("formula.json", import.meta.url), "utf8"));
const header = data.header as Header & { formula: FormulaHeader };

const find = (parts: NamedPart[], name: string) => {
  const part = parts.find((each) => each.name === name);
  assert.ok(part, `${name} is among ${parts.map((each) => each.name)}`);
  return part;
};

test("trees have the values of Python", () => {
  const [trees, values, results] = data.trees as [Tree[], Record<string, number>, (number | null)[]];
  trees.forEach((tree, n) => {
    const value = compiled(tree)(values);
    const result = results[n];
    if (result === null) assert.ok(Number.isNaN(value), JSON.stringify(tree));
    else close(value, result, 1e-12);
  });
});

test("nothing but operations is called", () => {
  for (const name of ["constructor", "__proto__", "eval", "toString", "sin.call"]) {
    assert.throws(() => compiled([name, 1]), /does not support/);
  }
});

test("the flow of the whole is that of Python", async () => {
  const source = new FormulaSource(header, header.formula);
  const flow = find(await source.load(null, [0]), "flow/0");
  const [rows, columns] = flow.shape;
  assert.deepEqual([rows, columns], header.geometry.shape);
  (data.velocity as number[][][]).forEach((row, j) => {
    row.forEach((own, i) => {
      const at = 3 * (20 * j * columns + 32 * i);
      // Rates are rounded to steps of 2^-9 on their way from Python.
      own.forEach((value, k) => assert.ok(Math.abs(flow.data[at + k] - value) < 2 ** -9, `${[j, i, k]}`));
    });
  });
});

test("a tile is that of a finer grid", async () => {
  const source = new FormulaSource(header, header.formula);
  const { depth = 0 } = header.pyramid ?? {};
  const parts = await source.load([depth - 1, 0, 1], [0]);
  const name = `tile/${depth - 1}/0/1`;
  const own = JSON.parse(new TextDecoder().decode(find(parts, `${name}/header`).data)) as TileHeader;
  const { geometry, slices } = data.tile as TileHeader;
  const plain = (value: unknown) => JSON.parse(JSON.stringify(value));
  close(own.slices.lags, slices.lags, 2e-3);
  assert.deepEqual(own.geometry, plain(geometry));
  const { trace } = own.slices;
  const { trace: traced } = slices;
  for (const [key, value] of Object.entries(slices)) {
    if (typeof value === "number") close(own.slices[key as "unit"], value, 1e-3);
  }
  for (const key of ["nodes", "first", "drawn", "closed", "parts"] as const) {
    assert.deepEqual(trace?.[key], traced?.[key]);
  }
  close(trace?.middle ?? [], traced?.middle ?? [], 1e-9);
  close(trace?.unit ?? 0, traced?.unit ?? 1, 1e-6);
  assert.deepEqual(find(parts, `${name}/padded`).shape, [(traced?.nodes[0] ?? 0) + 2, (traced?.nodes[1] ?? 0) + 2, 3]);
  const place = placesOf(header);
  (data.places as number[][]).forEach((each, n) => close([...(place?.(depth - 1, 1, 5 * n) ?? [])], each, 0.03));
});

test("positions are exact at any depth", async () => {
  const source = new FormulaSource(header, header.formula);
  const row = 2 ** 17 + 5;
  const parts = await source.load([0, row, row], [0]);
  const own = JSON.parse(new TextDecoder().decode(find(parts, `tile/0/${row}/${row}/header`).data)) as TileHeader;
  const cell = 16 / (256 * 2 ** 20);
  const [columns] = own.slices.trace?.nodes.slice(1) ?? [0];
  const first = 256 * row - 36;
  close(own.slices.trace?.middle[0] ?? 0, -8 + cell * (first + (columns - 1) / 2), 1e-12);
  const padded = find(parts, `tile/0/${row}/${row}/padded`);
  close(padded.data[3] - padded.data[0], cell, 1e-3 * cell);
});

test("parameters change the flow, and what it is known by", async () => {
  const source = new FormulaSource(header, header.formula);
  const before = find(await source.load(null, [0]), "flow/0");
  assert.equal(source.follow({ ...header.settings, samples: 5 }), false);
  assert.equal(source.follow({ ...header.settings, "formula.b": 0.9 }), true);
  const after = find(await source.load(null, [0]), "flow/0");
  assert.notEqual(before.digest, after.digest);
  assert.notDeepEqual(before.data, after.data);
});
