// Sizes of textures, and what is sent to them, with as much of WebGL as that touches.

import assert from "node:assert/strict";
import { test } from "node:test";
import { makeLayers } from "../src/half.ts";

type Call = [name: string, ...values: unknown[]];

/** A context whose constants are their names, and that writes down what is called. */
function recorded(most: Record<string, number> = {}): { gl: WebGL2RenderingContext; calls: Call[] } {
  const calls: Call[] = [];
  const call = (name: string) => (...values: unknown[]) => {
    if (name === "getParameter") return most[String(values[0])] ?? 16;
    return void calls.push([name, ...values]);
  };
  const get = (_: object, name: string) => (name === name.toUpperCase() ? name : call(name));
  return { gl: new Proxy({}, { get }) as WebGL2RenderingContext, calls };
}

const SIZE = { width: 4, height: 2, layers: 3, channels: 4, levels: 1 };

test("a texture that the graphics card has no room for is refused with what it has", () => {
  const wrong = [{ width: 17 }, { height: 17 }, { layers: 17 }];
  for (const more of wrong) {
    const { gl, calls } = recorded();
    assert.throws(() => makeLayers(gl, {}, { ...SIZE, ...more }), /this graphics card supports at most 16 x 16 in 16;/);
    assert.deepEqual(calls, []);
  }
  for (const [channels, format] of [[1, "R16F"], [4, "RGBA16F"]] as const) {
    const { gl, calls } = recorded();
    makeLayers(gl, {}, { ...SIZE, channels });
    const made = calls.filter(([name]) => name === "texStorage3D");
    assert.deepEqual(made, [["texStorage3D", "TEXTURE_2D_ARRAY", 2, format, 4, 2, 3]]);
  }
});
