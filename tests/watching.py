"""Looking at the page of the app as a person does: at its pixels, once they are at rest."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np
from PIL import Image
from waiting import wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Page

#: Ends when the picture that the page was given is on the screen.
DECODED = """async () => {
  const image = document.querySelector(".flowtex-view img");
  if (image?.src) await image.decode().catch(() => null);
  await new Promise((f) => requestAnimationFrame(() => requestAnimationFrame(f)));
}"""
#: Ends when the server has answered what the page, which gathers for 0.1 s, has sent.
SENT = """async () => {
  await new Promise((f) => setTimeout(f, 120));
  await window.trame.trigger("nothing");
}"""


def count(page: Page) -> int:
    """Full pictures that the page has shown."""
    return int(page.get_attribute("[data-sharp]", "data-sharp") or 0)


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
            page.wait_for_function(
                "n => Number(document.querySelector('[data-sharp]')?.dataset.sharp) > n"
                " && document.querySelector('[data-picture=sharp]')",
                arg=before,
            )
            seen = count(page)
            # What the page has still to send may move the picture once more.
            page.evaluate(SENT)
            if page.query_selector("[data-picture=sharp]") and count(page) == seen:
                break
        page.evaluate(DECODED)
        return self.shot(page)

    def comes_to(self, page: Page, wanted: Any) -> None:
        """Wait until the page shows what it showed before."""
        apart: list[float] = []

        def is_there() -> bool:
            apart.append(difference(self.shot(page), wanted))
            return apart[-1] < 2

        wait_until(is_there, lambda: f"it is apart by {apart[-1]:.1f} steps of 8 bits")
