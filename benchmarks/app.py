"""How smooth the page is: ``python benchmarks/app.py``.

A browser drags the view for some seconds, and counts the pictures; then it lets go, and the time
until the full picture is there is taken. The browser draws, then the server, and then whom the
page chooses by itself. The same is done with PyVista's own trame viewer and a plain sphere, where
that is installed (``pip install trame-pyvista``). Server, browser and this program share the
processors, as they do on a small machine.

``--link 80 10`` draws by the server only, over a connection with 80 ms there and back and 10
Mbit/s, and counts the bytes. For another version of the package, set ``PYTHONPATH``.
"""

from __future__ import annotations

import argparse
import asyncio
import itertools
import re
import shutil
import socket
import statistics
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

from rich.console import Console
from rich.table import Table

SIZE = {"width": 1000, "height": 700}
FLOWS = ("double_gyre", "cylinder", "delta_wing")
#: A page of ours; the flow is the first argument.
OURS = """
import sys, flowtex, flowtex.app
flow = getattr(flowtex.examples, sys.argv[1] + "_field")()
flowtex.app.serve(flow, open_browser=False, announce=lambda text: print(text, flush=True))
"""
#: PyVista's own page: a sphere of 60 x 60, without edges and without anti-aliasing.
BARE = """
import pyvista as pv
from trame_pyvista.widgets import PyVistaRCAView
from trame.app import get_server
from trame.ui.vuetify3 import SinglePageLayout

server = get_server("bare", client_type="vue3")
pl = pv.Plotter(off_screen=True, theme=pv.themes.DocumentTheme())
pl.disable_anti_aliasing()
pl.add_mesh(pv.Sphere(theta_resolution=60, phi_resolution=60))
with SinglePageLayout(server) as layout, layout.content:
    PyVistaRCAView(pl)
server.controller.on_server_ready.add(
    lambda **_: print(f"http://127.0.0.1:{server.port}/", flush=True))
server.start(port=0, host="127.0.0.1", open_browser=False, show_connection_info=False)
"""
#: A page of ours, and the full picture of it.
VIEW, SHARP = ".flowtex-views", '.flowtex[data-sharp="true"]'
#: Chooses who draws, as *Drawn by* does.
CHOOSE = """
try { sessionStorage["flowtex painter"] = "%s"; } catch { /* a page of no origin */ }"""
PAINTERS = {
    "browser": "by the browser",
    "server": "by the server",
    "": "by whom the page chooses",
}
#: Counts the pictures that a view of ours draws or an <img> shows, with the time of each.
COUNT = """selector => {
  window.seen = [];
  const image = document.querySelector(selector);
  const note = () => window.seen.push(performance.now());
  if (image.first) {
    const { painter } = image.first;
    const drawer = painter.renderer ?? painter;
    for (const name of ["draft", "show"].filter((name) => drawer[name])) {
      const draw = drawer[name].bind(drawer);
      drawer[name] = (...values) => { note(); return draw(...values); };
    }
    return;
  }
  new MutationObserver(note).observe(image, { attributeFilter: ["src"] });
}"""


#: Seconds of data that wait in the simulated connection, at most, before the sender has to wait.
BUFFER_S = 0.2


@dataclass(frozen=True)
class Smoothness:
    """What a drag was like."""

    rate: float
    gap: float
    bytes_per_s: float
    sharp: float | None


class Link:
    """A connection to a port of this machine with a delay each way and a limited rate."""

    def __init__(self, port: int, round_trip_ms: float, mbit: float) -> None:
        self.target, self.delay, self.rate = port, round_trip_ms / 2000, mbit * 125_000
        self.received = 0  #: Bytes that have come from the server.
        self.loop = asyncio.new_event_loop()
        self.port = 0
        started = threading.Event()
        threading.Thread(target=self._serve, args=(started,), daemon=True).start()
        started.wait()

    def _serve(self, started: threading.Event) -> None:
        asyncio.set_event_loop(self.loop)
        server = self.loop.run_until_complete(asyncio.start_server(self._connect, "127.0.0.1", 0))
        self.port = server.sockets[0].getsockname()[1]
        started.set()
        self.loop.run_forever()

    async def _connect(self, reader: Any, writer: Any) -> None:
        bare = socket.socket()
        bare.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 16)
        bare.settimeout(0)
        await self.loop.sock_connect(bare, ("127.0.0.1", self.target))
        from_server, to_server = await asyncio.open_connection(sock=bare)
        await asyncio.gather(
            self._pass_on(reader, to_server), self._pass_on(from_server, writer, counts=True)
        )

    async def _pass_on(self, reader: Any, writer: Any, *, counts: bool = False) -> None:
        """Pass on what comes, each piece when the rate and the delay allow."""
        free = 0.0

        def arrive(data: bytes) -> None:
            self.received += len(data) if counts else 0
            writer.write(data)

        while data := await reader.read(4096):
            free = max(free, self.loop.time()) + len(data) / self.rate
            self.loop.call_at(free + self.delay, arrive, data)
            await asyncio.sleep(free - self.loop.time() - BUFFER_S)
        self.loop.call_at(free + self.delay, writer.close)


def drag(page: Any, seconds: float) -> tuple[float, float]:
    """Drag in circles, and return pictures in a second and the longest of 20 gaps, in ms."""
    width, height = SIZE["width"], SIZE["height"]
    page.mouse.move(width / 2, height / 2)
    page.mouse.down()
    page.evaluate("window.seen.length = 0")
    begun, turn = time.perf_counter(), 0
    while time.perf_counter() - begun < seconds:
        turn += 1
        x = width / 2 + 4 * (turn % 40 if turn % 80 < 40 else 40 - turn % 40)
        page.mouse.move(x, height / 2 + 2 * (turn % 30))
        page.wait_for_timeout(12)
    seen = page.evaluate("window.seen")
    page.mouse.up()
    gaps = [b - a for a, b in itertools.pairwise(seen)]
    return len(seen) / seconds, statistics.quantiles(gaps, n=20)[-1] if len(gaps) > 2 else 0.0


def measure(
    browser: Any,
    script: str,
    words: list[str],
    image: str,
    given: argparse.Namespace,
    painter: str,
) -> Smoothness:
    """Start a page, drag it, and end it; tells what it was like, drawn by the one that is named."""
    seconds = given.seconds
    process = subprocess.Popen(
        [sys.executable, "-c", script, *words], stdout=subprocess.PIPE, text=True
    )
    try:
        address = next(
            found.group() for line in process.stdout if (found := re.search(r"http://\S+", line))
        )
        link = None
        if given.link:
            place = urlsplit(address)
            link = Link(place.port or 0, *given.link)
            address = address.replace(str(place.port), str(link.port), 1)
        page = browser.new_page(viewport=SIZE)
        if painter:
            page.add_init_script(CHOOSE % painter)
        page.goto(address)
        page.wait_for_selector(image, timeout=60_000)
        ours = script is OURS
        if ours:
            page.wait_for_selector(SHARP, timeout=60_000)
        page.wait_for_timeout(1500)
        page.evaluate(COUNT, image)
        before = link.received if link else 0
        rate, gap = drag(page, seconds)
        came = link.received - before if link else 0
        sharp = None
        if ours:
            released = time.perf_counter()
            page.wait_for_selector(SHARP, timeout=60_000)
            sharp = time.perf_counter() - released
        page.close()
        return Smoothness(rate, gap, came / seconds, sharp)
    finally:
        process.terminate()
        process.wait(20)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=5.0, help="of dragging")
    parser.add_argument("--flows", nargs="*", default=FLOWS)
    parser.add_argument(
        "--link", nargs=2, type=float, metavar=("MS", "MBIT"), help="round trip and rate"
    )
    given = parser.parse_args()
    from playwright.sync_api import TimeoutError, sync_playwright

    table = Table("page", "pictures in a second", "gap, 95 %", "kB/s", "sharp after")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"))
        cases = [
            (OURS, [flow], VIEW, f"flowtex, {flow}, drawn {by}", painter)
            for painter, by in PAINTERS.items()
            if not given.link or painter == "server"
            for flow in given.flows
        ]
        if not given.link:
            cases.append((BARE, [], "img", "PyVista, a sphere", ""))
        for script, words, image, name, painter in cases:
            try:
                found = measure(browser, script, words, image, given, painter)
            except (StopIteration, TimeoutError) as error:
                table.add_row(name, f"not to be had: {error}"[:60])
                continue
            sharp = "" if found.sharp is None else f"{1000 * found.sharp:.0f} ms"
            figures = f"{found.rate:.1f}", f"{found.gap:.0f} ms", f"{found.bytes_per_s / 1000:.0f}"
            table.add_row(name, *figures, sharp)
        browser.close()
    Console().print(f"{SIZE['width']} x {SIZE['height']}", table)


if __name__ == "__main__":
    main()
