// Builds the client into the package: `node build.js [--watch | --check | --plain]`.
//
// The built files are kept in the repository, so that nobody who only uses flowtex needs Node; --check
// tells whether they are what the sources give. Identifiers stay as they are, for the debugger; --plain
// keeps statements as well, for coverage.
import { readFile } from "node:fs/promises";
import { parse } from "node:path";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";

const minified = !process.argv.includes("--plain");
const HOST = "../flowtex/host/static";
const STATIC = "../flowtex/app/ui/static";

const COMMON = {
  absWorkingDir: fileURLToPath(new URL(".", import.meta.url)),
  bundle: true,
  charset: "utf8",
  // Packings that no store of ours has, of which zarrita would bring the decoders.
  external: ["numcodecs/*"],
  legalComments: "inline",
  lineLimit: 120,
  loader: { ".css": "text", ".glsl": "text" },
  minifySyntax: minified,
  minifyWhitespace: minified,
  target: "es2022",
};

/** What a web map never asks for: flows from formulas, and packings and types that no store of ours has. */
const UNUSED = {
  formula: "export const placesOf = () => null; export class FormulaSource {}",
  bitround: "export class BitroundCodec {}",
  cast_value: "export class CastValueCodec {}",
  delta: "export class DeltaCodec {}",
  json2: "export class JsonCodec {}",
  scale_offset: "export class ScaleOffsetCodec {}",
  shuffle: "export class ShuffleCodec {}",
  transpose: "export class TransposeCodec {}",
  "vlen-utf8": "export class VLenUTF8 {}",
  zlib: "export class ZlibCodec {}",
  // Arrays of truth values and of texts.
  typedarray: "export class BoolArray {} export class ByteStringArray {} export class UnicodeStringArray {}",
};
const LESS = {
  name: "less",
  setup({ onResolve, onLoad }) {
    const filter = new RegExp(`/(${Object.keys(UNUSED).join("|")})\\.[jt]s$`);
    // With names of their own, they are not taken for the sources where coverage is counted.
    onResolve({ filter }, ({ path }) => ({ path: parse(path).name, namespace: "unused" }));
    onLoad({ filter: /./, namespace: "unused" }, ({ path }) => ({ contents: UNUSED[path] }));
  },
};
/** A module for web maps, which is to be small. */
const MODULE = { format: "esm", minifyIdentifiers: minified, plugins: [LESS] };

const ORIGIN = "// Built from client/src by client/build.js; change that instead.";
const NOTICE = await noticeOf("gl-matrix", "LICENSE.md");
const STORE_NOTICE = await noticeOf("zarrita", "LICENSE");

async function noticeOf(name, file) {
  const licence = await readFile(new URL(`node_modules/${name}/${file}`, import.meta.url), "utf8");
  return `/*! Holds parts of ${name}, of which this is the licence:\n\n${licence.trim()} */`;
}

export const BUILDS = [
  ["src/core.ts", `${HOST}/core.js`, "flowtex", NOTICE],
  ["src/store.ts", `${HOST}/store.js`, "flowtexStore", STORE_NOTICE],
  ["src/app/app.ts", `${STATIC}/flowtex.js`, undefined, ""],
  ["src/maplibre.ts", `${HOST}/maplibre.js`, undefined, `${NOTICE}\n${STORE_NOTICE}`, MODULE],
].map(([entry, outfile, globalName, notice, own = {}]) => ({
  ...COMMON,
  entryPoints: [entry],
  outfile,
  format: "iife",
  globalName,
  ...own,
  banner: { js: `${ORIGIN}\n${notice}`.trim() },
}));

async function check(options) {
  const { outputFiles } = await esbuild.build({ ...options, write: false });
  const kept = await readFile(new URL(options.outfile, import.meta.url));
  return Buffer.compare(kept, outputFiles[0].contents) === 0 ? [] : [options.outfile];
}

if (process.argv[1] !== fileURLToPath(import.meta.url)) {
  // coverage.js asks for the builds alone.
} else if (process.argv.includes("--watch")) {
  for (const options of BUILDS) await (await esbuild.context(options)).watch();
} else if (process.argv.includes("--check")) {
  const stale = (await Promise.all(BUILDS.map(check))).flat();
  if (stale.length) {
    console.error(`not what client/src gives: ${stale.join(", ")}; run: make client`);
    process.exitCode = 1;
  }
} else {
  await Promise.all(BUILDS.map((options) => esbuild.build(options)));
}
