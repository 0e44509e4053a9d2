// Which module may import which: from its own layer or a lower one, and never in a circle.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";

const FOLDER = new URL("../src/", import.meta.url);
/** Layers, the lowest first. */
const LAYERS = [
  "vectors half ticks dom keyboard lifetime sources/store modules.d app/vue",
  "camera focus globesight help",
  "protocol",
  "uniforms quality",
  "poles programs mesh lonlat meshlevels tilechoice arrowseeds player colours ground legend mercator",
  "fixedpoints ranges",
  "formula",
  "tracer sources/source",
  "sources/embedded sources/stream",
  "context",
  "heldparts samples viewstate",
  "earthlayer arrows",
  "bodies",
  "marks",
  "scene even",
  "places",
  "tiles",
  "pointpath pixelsum progressive",
  "onearth",
  "picking",
  "painter",
  "options webgl2painter",
  "controls colourcontrols pointcard axes",
  "panel pointers",
  "bareview",
  "viewer",
  "element mappicture",
  "packed explanation widget",
  "live",
  "core store maplibre",
  "app/browser app/hints app/keys app/upload",
  "app/app",
].map((names) => names.split(" "));

/** Modules that a module imports, for types as well but those of the view that it belongs to. */
function importsOf(name: string): string[] {
  const text = readFileSync(new URL(`${name}.ts`, FOLDER), "utf8");
  const own = /^import type \{ (SceneView|Viewer) \} from .+$/gm;
  const addresses = text.replace(own, "").matchAll(/(?:from|import)\s*\(?\s*"(\..+?)\.ts"/g);
  return [...addresses].map(([, address]) => join(dirname(name), address));
}

const modules = readdirSync(FOLDER, { recursive: true, encoding: "utf8" })
  .filter((path) => path.endsWith(".ts"))
  .map((path) => path.slice(0, -3));
const graph = new Map(modules.map((name) => [name, importsOf(name)]));

test("each module has a layer, and imports from there or below", () => {
  const layerOf = (name: string) => LAYERS.findIndex((names) => names.includes(name));
  assert.deepEqual(LAYERS.flat().sort(), [...modules].sort());
  for (const [name, imports] of graph) {
    const higher = imports.filter((other) => layerOf(other) > layerOf(name));
    assert.deepEqual(higher, [], `${name} imports from a higher layer`);
  }
});

test("modules do not import each other in a circle", () => {
  const complete = new Set<string>();
  const follow = (name: string, path: string[]) => {
    assert.ok(!path.includes(name), `a circle of imports: ${[...path, name].join(" > ")}`);
    if (complete.has(name)) return;
    for (const other of graph.get(name) ?? []) follow(other, [...path, name]);
    complete.add(name);
  };
  for (const name of modules) follow(name, []);
});
