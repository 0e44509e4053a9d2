// What MyST asks for each page of a site, and saves: the widgets of its text, for public/page.js.

const { createServer } = require("node:http");

const { PORT, CONTENT_CDN_PORT } = process.env;

/** All widgets in a tree of MyST's. */
const widgetsOf = (node) =>
  node.type === "anywidget" ? [node] : (node.children ?? []).flatMap(widgetsOf);

createServer(async (request, response) => {
  const content = await fetch(`http://localhost:${CONTENT_CDN_PORT}/content/index.json`);
  const widgets = JSON.stringify(widgetsOf((await content.json()).mdast));
  response.end(`<!doctype html><meta charset="utf-8"><title>A flow</title>
<script type="application/json">${widgets}</script><script type="module" src="/page.js"></script>`);
  // MyST takes a line with an address as the sign that the server is there.
}).listen(PORT, () => console.log(`http://localhost:${PORT}`));
