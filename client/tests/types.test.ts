// The declarations of flowtex-maplibre, as a project that uses the package meets them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import ts from "typescript";
import { declarations } from "../types.ts";

const FOLDER = fileURLToPath(new URL("..", import.meta.url));
const USE = `
import type { Map } from "maplibre-gl";
import { FlowtexLayer, type FlowPoint } from "./flow";
export function add(map: Map): Promise<FlowPoint | null> {
  const flow = new FlowtexLayer({ id: "flow", scene: "winds.json", opacity: 0.8, onTime: (time) => time.toFixed() });
  map.addLayer(flow);
  flow.set({ samples: 15 });
  flow.setColours({ cmap: "magma", clim: [0, 40] });
  const [first] = flow.bounds ?? [[0, 0]];
  return flow.pointAt({ lng: first[0], lat: first[1] });
}
`;

/** Libraries and MapLibre's declarations, which are parsed once. */
const parsed = new Map<string, ts.SourceFile | undefined>();

/** Faults that the compiler finds in a module that uses the package. */
function faults(text: string): string[] {
  const files = new Map([[`${FOLDER}flow.d.ts`, declarations()], [`${FOLDER}use.ts`, text]]);
  const options = { strict: true, noEmit: true, skipLibCheck: true, types: [], module: ts.ModuleKind.ES2022 };
  const resolved = { ...options, target: ts.ScriptTarget.ES2022, moduleResolution: ts.ModuleResolutionKind.Bundler };
  const host = ts.createCompilerHost(resolved);
  const { fileExists, readFile, getSourceFile } = host;
  host.fileExists = (name) => files.has(name) || fileExists(name);
  host.readFile = (name) => files.get(name) ?? readFile(name);
  host.getSourceFile = (name, version) => {
    const own = files.get(name);
    if (own !== undefined) return ts.createSourceFile(name, own, version);
    if (!parsed.has(name)) parsed.set(name, getSourceFile(name, version));
    return parsed.get(name);
  };
  const program = ts.createProgram([...files.keys()], resolved, host);
  return ts.getPreEmitDiagnostics(program).map((fault) => ts.flattenDiagnosticMessageText(fault.messageText, " "));
}

test("the declarations need nothing but MapLibre's", () => {
  const sources = [...declarations().matchAll(/from "(.*)"/g)].map((found) => found[1]);
  assert.deepEqual(sources, ["maplibre-gl"]);
});

test("a project in TypeScript can use the layer, and is told what does not exist", () => {
  assert.deepEqual(faults(USE), []);
  assert.match(faults(USE.replace("samples: 15", "samples: [15]")).join(), /not assignable/);
  assert.match(faults(USE.replace("flow.bounds", "flow.extent")).join(), /'extent' does not exist/);
});
