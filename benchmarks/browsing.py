"""A browser on a page whose tiles come from object storage, for the benchmark of pyramids."""

from __future__ import annotations

import math
import multiprocessing
import shutil
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from ocean import LATITUDES, part
from playwright.sync_api import TimeoutError as PlaywrightTimeoutError
from playwright.sync_api import sync_playwright

import flowtex
from flowtex.rendering.camera import CAMERA_LIMITS

#: Software drawing: Mesa's, which is several times as fast as Chromium's own.
MESA = ["--use-angle=gl-egl", "--ignore-gpu-blocklist"]
SIZE = (1000, 600)
#: Nothing is missing, and the picture is the full one.
COMPLETE = '[data-tiles="0"][data-sharp="true"]'
#: Places that are looked at, cells across the closest view, and zoom of the pan.
PLACES, CLOSEST_CELLS, PAN_ZOOM = 20, 8, 64
#: Share of the page that the whole fills, pixels of a drag, and its parts.
FILLED, DRAG_PX, DRAG_PARTS = 0.9 * 0.92, 800, 4
#: Pixels of a notch of the wheel, and most notches of one event.
NOTCH_PX, MOST_NOTCHES = 100, 4
#: Milliseconds after which a picture is given up.
PATIENCE_MS = 60_000


def write_page(place: str, url: str, path: str, options: dict[str, Any]) -> None:
    """Export the page, as whoever shares it does."""
    flowtex.export(place, path, store=url, **options)


class Visit:
    """A page that is open, with passes on it."""

    def __init__(
        self, page: Any, storage: Any, album: Path, tally: Callable[[Any], dict[str, Any]]
    ) -> None:
        self.page, self._storage, self._album, self._tally = page, storage, album, tally
        self.given_up = 0

    def timed(self, act: Callable[[], None]) -> dict[str, Any]:
        """Do something, and wait for the full picture."""
        self._storage.requests()
        act()
        start = time.perf_counter()
        # What is to be seen has changed before anything is looked for.
        self.page.wait_for_timeout(50)
        self.wait()
        seconds = time.perf_counter() - start
        got = self._tally(self._storage.requests())
        count = sum(got["requests"].values())
        return {"seconds": seconds, "bytes": sum(got["read"].values()), "requests": count}

    def wait(self) -> None:
        """Wait for the full picture; what keeps it from coming is in the picture of the page."""
        try:
            self.page.wait_for_selector(COMPLETE, timeout=PATIENCE_MS)
        except PlaywrightTimeoutError:
            self.given_up += 1
            self.page.screenshot(path=self._album / f"page_given_up_{self.given_up}.png")

    def whole(self) -> None:
        """Go back to the whole."""
        self.page.keyboard.press("0")
        self.page.wait_for_timeout(50)
        self.wait()

    def zoom(self, zoom: float, at: tuple[float, float]) -> None:
        """Turn the wheel over a pixel."""
        self.page.mouse.move(*at)
        notches = round(math.log(zoom) / math.log(CAMERA_LIMITS.wheel_zoom))
        while notches:
            some = min(notches, MOST_NOTCHES)
            self.page.mouse.wheel(0, -some * NOTCH_PX)
            notches -= some

    def drag(self) -> None:
        """Drag the picture to the left."""
        y, right = SIZE[1] / 2, SIZE[0] - (SIZE[0] - DRAG_PX) / 2
        self.page.mouse.move(right, y)
        self.page.mouse.down()
        self.page.mouse.move(right - DRAG_PX, y, steps=DRAG_PARTS)
        self.page.mouse.up()


def browsed(
    storage: Any,
    place: str,
    size: tuple[int, int],
    folder: Path,
    album: Path,
    tally: Callable[[Any], dict[str, Any]],
) -> dict[str, Any]:
    """Look at the whole, at random places, and pan, and return what it took."""
    path = folder / "page.html"
    url = f"{storage.url}/{place.removeprefix('s3://flows/')}"
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        pool.submit(
            write_page, place, url, str(path), {"cmap": "viridis", "clim": "robust"}
        ).result()
    with sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium") or shutil.which("google-chrome"), args=MESA
        )
        page = browser.new_page(viewport={"width": SIZE[0], "height": SIZE[1]})
        heard: list[str] = []
        page.on("console", lambda m: heard.append(m.text) if m.type == "error" else None)
        visit = Visit(page, storage, album, tally)
        result: dict[str, Any] = {"page_bytes": path.stat().st_size}
        before = _memory(browser)
        result["whole"] = visit.timed(lambda: page.goto(path.as_uri()) and None)
        page.screenshot(path=album / "page_whole.png")
        result["places"] = _places(visit, size, album)
        result["pan"] = _pan(visit, size, album)
        session = page.context.new_cdp_session(page)
        session.send("HeapProfiler.collectGarbage")
        page.wait_for_timeout(1000)
        after = _memory(browser)
        result["memory"] = {kind: after[kind] - before.get(kind, 0) for kind in after}
        result["errors"], result["given_up"] = heard, visit.given_up
        browser.close()
    return result


def _places(visit: Visit, size: tuple[int, int], album: Path) -> list[dict[str, Any]]:
    rng = np.random.default_rng(16)
    found: list[dict[str, Any]] = []
    closest = size[0] / CLOSEST_CELLS
    while len(found) < PLACES:
        # Places with water, and zooms of all sizes; of the last ones all are the closest.
        u, v = (int(rng.integers(0, n - 1)) for n in size)
        if np.isnan(part(*size, slice(v, v + 1), slice(u, u + 1))[0]).any():
            continue
        zoom = closest ** (1.0 if len(found) >= PLACES // 2 else float(rng.uniform(0, 1)))
        visit.whole()
        at = _pixel(size, u, v)
        found.append({"zoom": zoom, **visit.timed(lambda z=zoom, p=at: visit.zoom(z, p))})
        if len(found) in (1, PLACES // 2, PLACES):
            visit.page.screenshot(path=album / f"page_place_{len(found)}.png")
    return found


def _pan(visit: Visit, size: tuple[int, int], album: Path) -> dict[str, Any]:
    """Go along a parallel around the Earth."""
    visit.whole()
    left, _ = _pixel(size, 0, 0)
    first = visit.timed(lambda: visit.zoom(PAN_ZOOM, (left + 4, SIZE[1] / 2)))
    drags = math.ceil(FILLED * PAN_ZOOM * SIZE[0] / DRAG_PX)

    def cross() -> None:
        for _ in range(drags):
            visit.drag()
            visit.page.wait_for_timeout(250)

    start = time.perf_counter()
    rest = visit.timed(cross)
    visit.page.screenshot(path=album / "page_pan.png")
    return {
        "arriving": first,
        "drags": drags,
        "seconds": time.perf_counter() - start,
        "last_seconds": rest["seconds"],
        "bytes": rest["bytes"],
        "requests": rest["requests"],
    }


def _pixel(size: tuple[int, int], column: int, row: int) -> tuple[float, float]:
    """Return where a node is in the picture of the whole."""
    height = LATITUDES[1] - LATITUDES[0]
    degree = max(height, 360 * SIZE[1] / SIZE[0]) / FILLED / SIZE[1]
    x = (column / size[0] * 360 - 180) / degree
    y = (row / (size[1] - 1) * height - height / 2) / degree
    return SIZE[0] / 2 + x, SIZE[1] / 2 - y


def _memory(browser: Any) -> dict[str, int]:
    """Return the private memory of the browser's processes in bytes, by their kind.

    Up to 100 MB of a page are answers that Chromium keeps for what drives it.
    """
    import psutil

    session = browser.new_browser_cdp_session()
    processes = session.send("SystemInfo.getProcessInfo")["processInfo"]
    session.detach()
    taken: dict[str, int] = {}
    for one in processes:
        own = psutil.Process(one["id"]).memory_full_info().uss
        taken[one["type"]] = taken.get(one["type"], 0) + own
    return taken
