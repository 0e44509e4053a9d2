// The keys of the page that trame serves, beside those of the view.

import { CLOSE_KEY, hasModifier } from "../keyboard.ts";
import { vue, type Emit } from "./vue.ts";

/** Keys, and what each one changes of the page. */
const TOGGLES: Record<string, string> = { [CLOSE_KEY]: "close", t: "theme", "?": "help" };
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

export const keys = {
  name: "flowtex-keys",
  emits: ["toggle", "linked"],
  setup(_: object, { emit }: { emit: Emit }) {
    const onKeyDown = (event: KeyboardEvent) => press(event, emit);
    vue().onMounted(() => {
      // In the capturing phase, as the view keeps Escape for itself.
      window.addEventListener("keydown", onKeyDown, { capture: true });
      // A link to a state contains it after the #, which browsers do not send to servers.
      if (window.location.hash.length > 1) emit("linked", window.location.hash);
    });
    vue().onBeforeUnmount(() => window.removeEventListener("keydown", onKeyDown, { capture: true }));
    return () => null;
  },
};
