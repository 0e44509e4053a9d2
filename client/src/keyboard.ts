// Keys, and the command that each one gives: in a view, and in the app's page.

export const CAMERA_KEYS: Record<string, string> = {
  ArrowLeft: "left",
  ArrowRight: "right",
  ArrowUp: "up",
  ArrowDown: "down",
  "+": "closer",
  "=": "closer",
  "-": "farther",
  _: "farther",
  0: "whole",
  d: "detail",
  ".": "next",
  ",": "previous",
};

export const PLAY_KEY = " ";
export const FULLSCREEN_KEY = "f";
export const CLOSE_KEY = "Escape";
export const HELP_KEY = "?";

/** Directions of the keys that pan, right and up. */
export const DIRECTIONS: Record<string, [number, number]> = {
  left: [-1, 0],
  right: [1, 0],
  up: [0, 1],
  down: [0, -1],
};

/** Whether a key is for the browser. */
export function hasModifier(event: KeyboardEvent): boolean {
  return event.ctrlKey || event.metaKey || event.altKey;
}

/** Keys that move a slider. */
const SLIDER_KEYS = /^(Arrow|Page|Home$|End$)/;

/** Whether a control takes a key for itself. */
export function isOfControl(control: EventTarget | undefined, key: string): boolean {
  if (key === CLOSE_KEY || !(control instanceof Element)) return false;
  const { tagName, type } = control as HTMLInputElement;
  if (tagName === "BUTTON" || type === "checkbox") return key === PLAY_KEY;
  if (type === "range") return SLIDER_KEYS.test(key);
  return tagName === "INPUT" || tagName === "SELECT";
}

/** Give a view keys that nothing else of the page wants, without a click on it. */
export function forwardKeys(root: HTMLElement, event: KeyboardEvent): void {
  const isFree = event.target === document.body && !event.defaultPrevented;
  if (isFree && !root.dispatchEvent(new KeyboardEvent("keydown", event))) event.preventDefault();
}

/** Fill the screen with an element, or no longer. */
export function toggleFullscreen(element: Element): void {
  if (document.fullscreenElement) void document.exitFullscreen();
  else void element.requestFullscreen?.().catch(() => undefined);
}
