// The keyboard of the page that trame serves.

import {
  CAMERA_KEYS,
  CLOSE_KEY,
  FULLSCREEN_KEY,
  hasModifier,
  PLAY_KEY,
  toggleFullscreen,
} from "../keyboard.ts";
import { vue, type Emit } from "./vue.ts";

/** Keys, and the command that each one sends to the server. */
const COMMANDS: Record<string, string> = { ...CAMERA_KEYS, d: "detail", ".": "next", ",": "previous" };
/** Keys that only change the page. */
const TOGGLES: Record<string, string> = {
  [PLAY_KEY]: "play",
  [CLOSE_KEY]: "close",
  t: "theme",
  "?": "help",
};
/** Elements that keep their keys for themselves. */
const OWNERS = "input, textarea, select, [contenteditable], [role=slider], .v-overlay--active";

function press(event: KeyboardEvent, emit: Emit): void {
  const { target, key } = event;
  const isClose = key === CLOSE_KEY;
  if (hasModifier(event)) return;
  if (!isClose && target instanceof Element && target.closest(OWNERS)) return;
  if (key === PLAY_KEY && target instanceof HTMLButtonElement) return;
  if (key === FULLSCREEN_KEY) toggleFullscreen(document.documentElement);
  else if (key in COMMANDS) emit("command", COMMANDS[key]);
  else if (key in TOGGLES) emit("toggle", TOGGLES[key]);
  else return;
  if (!isClose) event.preventDefault();
}

export const keys = {
  name: "flowtex-keys",
  emits: ["command", "toggle", "linked"],
  setup(_: object, { emit }: { emit: Emit }) {
    const onKeyDown = (event: KeyboardEvent) => press(event, emit);
    vue().onMounted(() => {
      window.addEventListener("keydown", onKeyDown);
      // A link to a state holds it behind the #, of which browsers tell no server.
      if (window.location.hash.length > 1) emit("linked", window.location.hash);
    });
    vue().onBeforeUnmount(() => window.removeEventListener("keydown", onKeyDown));
    return () => null;
  },
};
