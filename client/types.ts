// The types of the package flowtex-maplibre: `node types.ts` writes distribution/npm/maplibre.d.ts.
import { readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import ts from "typescript";

/** Declarations of the module, which is read alone; it names the types of what it exports. */
export function declarations(): string {
  const text = readFileSync(new URL("src/maplibre.ts", import.meta.url), "utf8");
  const { outputText, diagnostics } = ts.transpileDeclaration(text, { fileName: "maplibre.ts", reportDiagnostics: true });
  const faults = (diagnostics ?? []).map((fault) => ts.flattenDiagnosticMessageText(fault.messageText, " "));
  if (faults.length) throw new Error(faults.join("; "));
  return outputText;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  writeFileSync(new URL("../distribution/npm/maplibre.d.ts", import.meta.url), declarations());
}
