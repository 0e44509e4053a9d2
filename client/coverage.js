// Coverage of client/src: `node coverage.js FOLDER` joins what the unit tests ran (FOLDER/node, which Node
// writes for NODE_V8_COVERAGE) with what ran in pages (FOLDER/pages, from tests/client_coverage.py), and
// writes FOLDER/client.
import { readdir, readFile } from "node:fs/promises";
import { stripTypeScriptTypes } from "node:module";
import { basename, join } from "node:path";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";
import { CoverageReport } from "monocart-coverage-reports";
import { BUILDS } from "./build.js";

const LEAST = 90;
const folder = process.argv[2];
const report = new CoverageReport({
  baseDir: fileURLToPath(new URL(".", import.meta.url)),
  outputDir: join(folder, "client"),
  reports: ["console-summary", "json-summary", "lcovonly"],
  sourceFilter: (path) => path.endsWith(".ts") && !path.includes("node_modules"),
  // Those of libraries keep their folder, by which they are left out.
  sourcePath: (path) => (path.includes("node_modules") ? path : path.slice(path.lastIndexOf("src/"))),
});

/** A source as Node runs it: types are blanked out, so that each place stays where it is. */
const untyped = (text) => stripTypeScriptTypes(text);

/** The text of a built file, and the map from it to the sources. */
async function built(options) {
  const { outputFiles } = await esbuild.build({ ...options, sourcemap: "external", write: false });
  const [map, script] = ["js.map", ".js"].map((end) => outputFiles.find(({ path }) => path.endsWith(end)));
  const sourceMap = JSON.parse(map.text);
  sourceMap.sourcesContent = sourceMap.sourcesContent.map((text, n) =>
    sourceMap.sources[n].endsWith(".ts") && !sourceMap.sources[n].includes("node_modules") ? untyped(text) : text,
  );
  return { url: `built/${basename(options.outfile)}`, source: script.text, sourceMap };
}

/** The records of a folder's JSON files; none where the tests of a kind did not run. */
async function* records(kind) {
  for (const file of await readdir(join(folder, kind)).catch(() => [])) {
    yield JSON.parse(await readFile(join(folder, kind, file), "utf8"));
  }
}

const bundles = new Map();
for (const options of BUILDS) bundles.set(basename(options.outfile), await built(options));
for await (const found of records("pages")) {
  await report.add(found.map(({ bundle, functions }) => ({ ...bundles.get(bundle), functions })));
}
for await (const { result } of records("node")) {
  const own = result.filter(({ url }) => url.includes("/client/src/"));
  for (const entry of own) {
    entry.source = untyped(await readFile(new URL(entry.url), "utf8"));
  }
  if (own.length) await report.add(own);
}
const { summary } = await report.generate();
if (Math.min(summary.lines.pct, summary.branches.pct) < LEAST) {
  console.error(`client/src: expected at least ${LEAST} % of lines and branches`);
  process.exitCode = 1;
}
