// A source of files that a server makes: flowtex/app/streaming/element.py is the other side.

import type { NamedPart } from "../protocol.ts";
import type { TileKey } from "../tilechoice.ts";

/**
 * Gives parts from an address and a name, such as "whole", or some parts of it by another name, for what is the same at all times, "whole.3" for a
 * time step, and "0,2,5.3.4" for a tile at two.
 */
export function loadFiles(address: () => string, partsOfFile: (file: ArrayBuffer) => NamedPart[]) {
  return async (
    key: TileKey | null,
    steps: number[],
    signal?: AbortSignal,
    _has?: unknown,
    whole = "whole",
  ): Promise<NamedPart[]> => {
    const name = address() + [String(key ?? whole), ...steps].join(".");
    const answer = await fetch(name, { signal });
    if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
    return partsOfFile(await answer.arrayBuffer());
  };
}
