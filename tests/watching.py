"""Looking at the page of the app as a person does: at its pixels, once they are at rest."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np
from PIL import Image
from waiting import wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Page

#: Ends when what the page draws is on the screen.
DRAWN = "() => new Promise((f) => requestAnimationFrame(() => requestAnimationFrame(f)))"
#: Ends when the server has answered what the page, which gathers for 0.1 s, has sent.
SENT = """async () => {
  await new Promise((f) => setTimeout(f, 120));
  await window.trame.trigger("nothing");
}"""
#: Full pictures of all views so far; none before all of them have one.
COUNT = """() => {
  const views = [...document.querySelectorAll(".flowtex")];
  const frames = views.map(({ dataset }) => Number(dataset.frames));
  return frames.some((count) => !count) ? 0 : frames.reduce((sum, count) => sum + count, 0);
}"""
#: Whether the full picture of each view is there.
SHARP = """() => [...document.querySelectorAll(".flowtex")].every((view) =>
  view.matches('[data-sharp="true"][data-tiles="0"][data-lacking="0"]'))"""
#: Takes WebGL2 away from a page.
NO_WEBGL2 = """
const getContext = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
  return kind === "webgl2" ? null : getContext.call(this, kind, ...more);
};"""
#: Has the browser draw, also on a processor, as after a choice of *Renderer*.
CHOSEN = """
try { sessionStorage["flowtex painter"] ??= "browser"; } catch { /* a page of no origin */ }"""


def server_draws(page: Any) -> None:
    """Have the server draw what a page, or those of a context, will show, without WebGL2."""
    page.add_init_script(NO_WEBGL2)


def browser_draws(page: Any) -> None:
    """Have the browser draw what a page, or those of a context, will show."""
    page.add_init_script(CHOSEN)


def count(page: Page) -> int:
    """Full pictures that the page has shown."""
    return int(page.evaluate(COUNT))


def zoom_of(page: Page) -> float:
    """How far in the first view is."""
    return float(page.evaluate("document.querySelector('.flowtex-views').first.camera.zoom"))


def difference(one: Any, other: Any) -> float:
    """Mean difference of two pictures, in 8-bit steps."""
    return float(np.abs(one - other).mean())


class Watch:
    """A part of the page that nothing lies on, as left, top, right, bottom."""

    def __init__(self, bare: tuple[int, int, int, int], mode: str = "L") -> None:
        self._bare, self._mode = bare, mode
        self.left = bare[0]

    def shot(self, page: Page) -> Any:
        """Return what is seen there, (h, w) or (h, w, 3)."""
        with Image.open(io.BytesIO(page.screenshot())) as picture:
            return np.asarray(picture.convert(self._mode).crop(self._bare), dtype=float)

    def settled(self, page: Page, before: int = 0) -> Any:
        """Wait for a full picture after so many that nothing follows, and return what is seen."""
        while True:
            page.wait_for_function(f"n => ({COUNT})() > n && ({SHARP})()", arg=before)
            seen = count(page)
            # What the page has still to send may move the picture once more.
            page.evaluate(SENT)
            if page.evaluate(SHARP) and count(page) == seen:
                break
        page.evaluate(DRAWN)
        return self.shot(page)

    def comes_to(self, page: Page, wanted: Any) -> None:
        """Wait until the page shows what it showed before."""
        apart: list[float] = []

        def is_there() -> bool:
            apart.append(difference(self.shot(page), wanted))
            return apart[-1] < 2

        wait_until(is_there, lambda: f"it is apart by {apart[-1]:.1f} steps of 8 bits")
