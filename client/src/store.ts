// Built into flowtex/host/static/store.js, for scenes that have only the coarsest level of a store with them.

import type { Header } from "./protocol.ts";
import { Stream } from "./sources/stream.ts";

/** Open the store that a header names, from the page on. */
export const open = (header: Header): Stream => new Stream(header, location.href);
