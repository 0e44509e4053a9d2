const told = (error) => {
  const fault = document.getElementById("fault");
  fault.hidden = false;
  fault.textContent = error?.message ?? String(error);
};
const textOf = (id) => document.getElementById(id).textContent;
const blobOf = (text) => URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
/** Load a file of MapLibre, which must have its digest; return the address of a copy. */
const checked = async ({ href, integrity }) => blobOf(await (await fetch(href, { integrity })).text());
try {
  const [library, worker] = await Promise.all([...document.querySelectorAll("[data-module]")].map(checked));
  const { FullscreenControl, GlobeControl, Map, NavigationControl, Popup, setWorkerUrl } = await import(library);
  setWorkerUrl(worker);
  const { FlowtexLayer } = await import(blobOf(textOf("layer")));
  const scene = JSON.parse(textOf("scene"));
  const { label, unit } = scene.headers[0].speed;
  const map = new Map({ container: "map", style: JSON.parse(textOf("basemap")) });
  for (const control of [new NavigationControl(), new GlobeControl(), new FullscreenControl()]) map.addControl(control);
  const look = () => map.fitBounds(flow.bounds, { padding: 20, duration: 0 });
  const flow = new FlowtexLayer({ id: "flow", scene, onOpen: look });
  map.on("error", ({ error }) => told(error));
  map.on("style.load", () => map.addLayer(flow, map.getStyle().layers.find(({ type }) => type === "symbol")?.id));
  map.on("click", async ({ lngLat }) => {
    const point = await flow.pointAt(lngLat);
    if (!point) return;
    const speed = Math.hypot(point.eastward, point.northward).toPrecision(3);
    new Popup().setLngLat(lngLat).setText([label, speed, unit].filter(Boolean).join(" ")).addTo(map);
  });
  Object.assign(window, { map, flow });
} catch (error) {
  told(error);
}
