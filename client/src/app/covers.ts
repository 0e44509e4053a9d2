// What lies on the picture for good, so that the surface can be fitted to the rest.

import { clamp } from "../vectors.ts";
import { vue, type Emit } from "./vue.ts";

/** Panels that stay; the figures and the scale bar have another width with each picture. */
const PANELS = ".flowtex-title, .flowtex-buttons, .flowtex-panel, .flowtex-corner, .flowtex-player";
/** Pixels of the corner that the colour bar has at most, and that are left free beside a panel. */
const CORNER_PX = 200;
const GAP_PX = 4;

type Cover = [left: number, top: number, right: number, bottom: number];

/** Where a panel lies, from 0 to 1; groups of the settings unfold downwards. */
function coverOf(panel: Element, whole: DOMRect): Cover | null {
  const { left, top, right, bottom, width } = panel.getBoundingClientRect();
  if (!width) return null;
  const end = panel.matches(".flowtex-corner") ? Math.min(right, left + CORNER_PX) : right;
  const foot = panel.matches(".flowtex-panel") ? whole.bottom : bottom;
  const share = (edge: number, start: number, size: number) =>
    Number(clamp((edge - start) / size, 0, 1).toFixed(4));
  return [
    share(left - GAP_PX, whole.left, whole.width),
    share(top - GAP_PX, whole.top, whole.height),
    share(end + GAP_PX, whole.left, whole.width),
    share(foot + GAP_PX, whole.top, whole.height),
  ];
}

export const covers = {
  name: "flowtex-covers",
  emits: ["change"],
  setup(_: object, { emit }: { emit: Emit }) {
    const { h, ref, onMounted, onBeforeUnmount } = vue();
    const place = ref<HTMLElement | null>(null);
    let last = "";
    const look = () => {
      const page = place.value?.parentElement;
      if (!page?.clientWidth || !page.clientHeight) return;
      const whole = page.getBoundingClientRect();
      const player = page.querySelector(".flowtex-player")?.getBoundingClientRect();
      if (player) page.style.setProperty("--foot", `${whole.bottom - player.top}px`);
      const found = [...page.querySelectorAll(PANELS)].map((panel) => coverOf(panel, whole));
      const present = found.filter((cover) => cover !== null);
      if (JSON.stringify(present) === last) return;
      last = JSON.stringify(present);
      emit("change", present);
    };
    const watcher = new ResizeObserver(look);
    onMounted(() => {
      const page = place.value?.parentElement;
      if (!page) return;
      for (const element of [page, ...page.querySelectorAll(PANELS)]) watcher.observe(element);
    });
    onBeforeUnmount(() => watcher.disconnect());
    return () => h("div", { ref: place, hidden: true });
  },
};
