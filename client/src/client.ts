// What flowtex/web/client.js is built of: the widget for anywidget, and views for other pages.

import { initialize, render } from "./widget.ts";

export { decoded, partsOfFile } from "./protocol.ts";
export { Viewer } from "./viewer.ts";
export { FlowtexView, mountPage } from "./element.ts";

export default { initialize, render };
