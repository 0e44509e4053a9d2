// What of client/src the tests execute: counts of V8 in Node's unit tests and in Chromium, which
// tests/client_coverage.py collects, put together by line and by branch.
//
// `node coverage.js build FOLDER` builds the bundles so that each branch of the sources is one of theirs,
// `node coverage.js report FOLDER [LEAST]` fails below that per cent. `make coverage` does all of it.
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join, relative, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";
import ts from "typescript";
import { BUILDS } from "./build.js";

const HERE = fileURLToPath(new URL(".", import.meta.url));
const SOURCES = join(HERE, "src");
const [command, place, least = "0"] = process.argv.slice(2);
const folder = resolve(place);

async function build() {
  const readable = { minifySyntax: false, minifyWhitespace: false, lineLimit: 0, sourcemap: "external", write: false };
  mkdirSync(join(folder, "maps"), { recursive: true });
  for (const options of BUILDS) {
    const { outputFiles } = await esbuild.build({ ...options, ...readable, outfile: resolve(HERE, options.outfile) });
    const [map, script] = outputFiles.sort((a, b) => b.path.endsWith(".map") - a.path.endsWith(".map"));
    writeFileSync(script.path, script.contents);
    writeFileSync(join(folder, "maps", basename(script.path)), script.contents);
    writeFileSync(join(folder, "maps", basename(map.path)), map.contents);
  }
}

/** Number of times that each character was executed: of ranges the innermost counts. */
function countsOf(length, functions) {
  const counts = new Int32Array(length);
  const ranges = functions.flatMap(({ ranges: own }) => own);
  ranges.sort((a, b) => a.startOffset - b.startOffset || b.endOffset - a.endOffset);
  for (const { startOffset, endOffset, count } of ranges) counts.fill(count, startOffset, endOffset);
  return counts;
}

/** Offsets at which lines begin. */
const linesOf = (text) => [0, ...[...text.matchAll(/\n/g)].map(({ index }) => index + 1)];

/** Counts at the places of the sources that a bundle has, as [source, offset, count]. */
function* mapped({ entries, lines }, counts, sources) {
  for (const { generatedLine, generatedColumn, originalSource, originalLine, originalColumn } of entries) {
    const source = sources.get(originalSource.split("client/src/")[1]);
    if (!source) continue;
    yield [source, source.lines[originalLine] + originalColumn, counts[lines[generatedLine] + generatedColumn]];
  }
}

/** All entries of a source map. */
function entriesOf(map) {
  const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const entries = [];
  let [source, originalLine, originalColumn] = [0, 0, 0];
  map.mappings.split(";").forEach((line, generatedLine) => {
    let generatedColumn = 0;
    for (const segment of line ? line.split(",") : []) {
      const values = [];
      let [value, shift] = [0, 0];
      for (const letter of segment) {
        const digit = digits.indexOf(letter);
        value += (digit & 31) << shift;
        shift += 5;
        if (digit & 32) continue;
        values.push(value & 1 ? -(value >> 1) : value >> 1);
        [value, shift] = [0, 0];
      }
      generatedColumn += values[0];
      if (values.length < 4) continue;
      source += values[1];
      originalLine += values[2];
      originalColumn += values[3];
      const originalSource = map.sources[source];
      entries.push({ generatedLine, generatedColumn, originalSource, originalLine, originalColumn });
    }
  });
  return entries;
}

/** Statements, and arms of branches, of a module: where each begins and ends. */
function partsOf(name, text) {
  const file = ts.createSourceFile(name, text, ts.ScriptTarget.Latest, true);
  const [statements, arms] = [[], []];
  const at = (node) => [node.getStart(file), node.getEnd()];
  const isLogical = ({ kind }) =>
    [ts.SyntaxKind.AmpersandAmpersandToken, ts.SyntaxKind.BarBarToken, ts.SyntaxKind.QuestionQuestionToken].includes(kind);
  const visit = (node) => {
    if (ts.isTypeNode(node) || ts.isInterfaceDeclaration(node) || ts.isTypeAliasDeclaration(node)) return;
    if (ts.isIfStatement(node)) {
      arms.push(at(node.thenStatement));
      if (node.elseStatement) arms.push(at(node.elseStatement));
    } else if (ts.isConditionalExpression(node)) arms.push(at(node.whenTrue), at(node.whenFalse));
    else if (ts.isBinaryExpression(node) && isLogical(node.operatorToken)) arms.push(at(node.right));
    else if (ts.isCaseOrDefaultClause(node) && node.statements.length) arms.push(at(node.statements[0]));
    else if (ts.isFunctionLike(node) && node.body) arms.push(at(node.body));
    if (ts.isStatement(node) && !ts.isBlock(node) && !ts.isImportDeclaration(node)) statements.push(at(node));
    ts.forEachChild(node, visit);
  };
  visit(file);
  return { statements, arms };
}

function read() {
  const sources = new Map();
  for (const path of readdirSync(SOURCES, { recursive: true, encoding: "utf8" })) {
    if (!path.endsWith(".ts") || path.endsWith(".d.ts")) continue;
    const text = readFileSync(join(SOURCES, path), "utf8");
    // What is not there in what was executed is -1.
    sources.set(path, { text, lines: linesOf(text), counts: new Int32Array(text.length).fill(-1), ...partsOf(path, text) });
  }
  return sources;
}

function add({ counts }, offset, count) {
  counts[offset] = Math.max(counts[offset], count);
}

function addNode(sources) {
  const logs = join(folder, "node");
  for (const file of readdirSync(logs)) {
    for (const { url, functions } of JSON.parse(readFileSync(join(logs, file), "utf8")).result) {
      if (!url.startsWith("file:")) continue;
      const source = sources.get(relative(SOURCES, fileURLToPath(url)));
      if (!source) continue;
      const counts = countsOf(source.text.length, functions);
      counts.forEach((count, offset) => add(source, offset, count));
    }
  }
}

function addBrowser(sources) {
  const maps = readdirSync(join(folder, "maps")).filter((name) => name.endsWith(".js"));
  const bundles = maps.map((name) => {
    const text = readFileSync(join(folder, "maps", name), "utf8").trim();
    const map = JSON.parse(readFileSync(join(folder, "maps", `${name}.map`), "utf8"));
    return { text, lines: linesOf(text), entries: entriesOf(map) };
  });
  const known = new Map();
  for (const file of readdirSync(folder).filter((name) => name.endsWith(".json"))) {
    const { script, functions } = JSON.parse(readFileSync(join(folder, file), "utf8"));
    if (!known.has(script)) {
      const text = readFileSync(join(folder, `${script}.js`), "utf8");
      const bundle = bundles.find((each) => text.trim() === each.text);
      if (!bundle) console.error(`a script of the pages is none of the bundles: ${script}.js`);
      known.set(script, { bundle, length: text.length, ahead: text.length - text.trimStart().length });
    }
    const { bundle, length, ahead } = known.get(script);
    if (!bundle) continue;
    const counts = countsOf(length, functions).subarray(ahead);
    for (const [source, offset, count] of mapped(bundle, counts, sources)) add(source, offset, count);
  }
}

/** Whether a part was executed: its first place that is known. */
function isExecuted(counts, [start, end]) {
  for (let n = start; n < end; n += 1) if (counts[n] >= 0) return counts[n] > 0;
  return false;
}

function report() {
  const sources = read();
  addNode(sources);
  addBrowser(sources);
  const share = ([some, all]) => `${(all ? (100 * some) / all : 100).toFixed(1)} %`.padStart(9);
  const sums = [[0, 0], [0, 0]];
  const missed = {};
  for (const [path, { text, counts, lines, statements, arms }] of [...sources].sort()) {
    const lineOf = (offset) => lines.findLastIndex((start) => start <= offset) + 1;
    const rows = [statements, arms].map((parts, n) => {
      const some = parts.filter((part) => isExecuted(counts, part));
      sums[n][0] += some.length;
      sums[n][1] += parts.length;
      return [some.length, parts.length];
    });
    const left = (parts) => [
      ...new Set(parts.filter((part) => !isExecuted(counts, part)).map(([start]) => lineOf(start))),
    ];
    missed[path] = { statements: left(statements), branches: left(arms), texts: text.split("\n").length };
    const where = [...new Set([...missed[path].statements, ...missed[path].branches])].sort((a, b) => a - b);
    console.log(`${path.padEnd(22)}${rows.map(share).join("")}  ${where.join(" ")}`);
  }
  console.log(`${"statements, branches".padEnd(22)}${sums.map(share).join("")}`);
  writeFileSync(join(folder, "missed.txt"), JSON.stringify(missed, null, 1));
  const [statements, branches] = sums;
  if (Math.min((100 * branches[0]) / branches[1], (100 * statements[0]) / statements[1]) < Number(least)) {
    console.error(`less than ${least} % of client/src is executed by the tests`);
    process.exitCode = 1;
  }
}

if (command === "build") await build();
else if (command === "report") report();
else console.error("expected: node coverage.js build|report FOLDER [LEAST]");
