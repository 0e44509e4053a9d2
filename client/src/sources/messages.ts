// A source that a kernel answers by messages: flowtex/host/feed.py is the other side. Parts come to all
// views of a widget as ever, before the message that ends their request.

import type { NamedPart } from "../protocol.ts";
import type { LoadTile, Source } from "./source.ts";

/** The end of a request, with what went wrong. */
export interface Loaded {
  kind: "loaded";
  request: string;
  error?: string;
}

export class Messages implements Source {
  readonly hasSteps = true;
  readonly hasMarks = true;
  private readonly send: (content: object) => void;
  private readonly requests = new Map<string, (error?: string) => void>();

  constructor(send: (content: object) => void) {
    this.send = send;
  }

  readonly load: LoadTile = (key, steps, signal, _has, mark) => {
    const request = String(Math.random()); // no other view of the widget has it
    this.send({ kind: "load", request, key, steps, ...(mark && { mark }) });
    signal.addEventListener("abort", () => {
      this.requests.delete(request);
      this.send({ kind: "drop", request });
    });
    return new Promise<NamedPart[]>((resolve, reject) => {
      this.requests.set(request, (error) => (error ? reject(new Error(error)) : resolve([])));
    });
  };

  end({ request, error }: Loaded): void {
    this.requests.get(request)?.(error);
    this.requests.delete(request);
  }
}
