// The keys of the page that trame serves, beside those of the view.

import { CLOSE_KEY, hasModifier, HELP_KEY } from "../keyboard.ts";
import { Focus } from "../focus.ts";
import { Lifetime } from "../lifetime.ts";
import { vue, type Emit } from "./vue.ts";

/** Keys, and what each one changes of the page. */
const TOGGLES: Record<string, string> = { [CLOSE_KEY]: "close", t: "theme", [HELP_KEY]: "help" };
/** Elements that keep their keys for themselves. */
const OWNERS = "input, textarea, select, [contenteditable], [role=slider], .v-overlay--active";

function press(event: KeyboardEvent, emit: Emit): void {
  const [target] = event.composedPath();
  const { key } = event;
  const isClose = key === CLOSE_KEY;
  if (hasModifier(event) || !(key in TOGGLES)) return;
  if (!isClose && target instanceof Element && target.closest(OWNERS)) return;
  emit("toggle", TOGGLES[key]);
  if (!isClose) event.preventDefault();
}

/**
 * Emit the state of a link, which follows the # as browsers do not send that to servers. It leaves the address,
 * so that the page keeps its later state when it is loaded again, and takes the same link again.
 */
function takeLink(emit: Emit): void {
  const { hash, pathname, search } = window.location;
  if (hash.length <= 1) return;
  window.history.replaceState(window.history.state, "", pathname + search);
  emit("linked", hash);
}

export const keys = {
  name: "flowtex-keys",
  emits: ["toggle", "linked"],
  setup(_: object, { emit }: { emit: Emit }) {
    const lifetime = new Lifetime();
    const capture = { capture: true };
    vue().onMounted(() => {
      // In the capturing phase, as the view keeps Escape for itself.
      lifetime.listen(window, "keydown", (event: KeyboardEvent) => press(event, emit), capture);
      // What a key or a click hides is hidden in the next frame.
      const focus = new Focus(document, lifetime, () => document.querySelector<HTMLElement>(".flowtex"));
      const keep = () => requestAnimationFrame(() => focus.keep());
      for (const kind of ["keydown", "click"]) lifetime.listen(window, kind, keep, capture);
      lifetime.listen(window, "hashchange", () => takeLink(emit));
      takeLink(emit);
    });
    vue().onBeforeUnmount(() => lifetime.end());
    return () => null;
  },
};
