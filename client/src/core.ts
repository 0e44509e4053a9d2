// All that draws, built into flowtex/host/static/core.js, which defines `flowtex`. A host adds its line: an
// exported page `flowtex.openPage()`, a module its exports (flowtex/host/static/exports.mjs). Elements of the class
// "flowtex-live" are shown without one.

import { showLiveViews } from "./live.ts";

export { FlowtexView, mountPage } from "./element.ts";
export { openPage } from "./packed.ts";
export { packedModule } from "./packed.ts";
export { decoded, partsOfFile } from "./protocol.ts";
export { Viewer } from "./viewer.ts";
export { initialize, render } from "./widget.ts";

if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", showLiveViews);
else showLiveViews();
