// The script of an exported page whose flow lies in a store, but for the coarsest level.

import { openPage } from "./openpage.ts";
import { Stream } from "./sources/stream.ts";

void openPage((header) => new Stream(header, location.href));
