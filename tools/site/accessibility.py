"""Look at the built site with axe in Chromium: two widths, light and dark."""

from __future__ import annotations

import functools
import os
import shutil
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from playwright.sync_api import Page, sync_playwright

AXE = Path(__file__).parent / "node_modules" / "axe-core" / "axe.min.js"
WIDTHS = (390, 1400)
THEMES = ("light", "dark")
#: Of pages in a folder, which are made alike, so many are looked at; of those at the top all.
ALIKE = 4
#: What others do that is against a rule, by rule: a part of the element's path, and why it stays.
EXCUSED = {
    "label-content-name-mismatch": {"search-button": "the theme's button, with its keys beside"},
}
#: Milliseconds after which the theme has made what scrolls at another width focusable.
SETTLED_MS = 400
#: Colours are those of a theme at once.
STILL = "* { transition: none !important; animation: none !important; }"
#: Lines of the console that are not faults of a page: of drivers, and of the theme's first visit.
HARMLESS = ("GL Driver Message", "Automatic fallback to software", "Got invalid theme mode")


class Quiet(SimpleHTTPRequestHandler):
    """A server that says nothing."""

    def log_message(self, *_: Any) -> None:
        """Keep still."""


@contextmanager
def served(site: Path) -> Iterator[str]:
    """Serve a folder; gives its address."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(site)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/"
    finally:
        server.shutdown()


def chosen(site: Path) -> list[str]:
    """Return the pages to look at."""
    pages: dict[str, list[str]] = {}
    for page in sorted(site.rglob("*.html")):
        name = page.relative_to(site)
        if not name.parts[0].startswith("_"):
            pages.setdefault(str(name.parent), []).append(str(name))
    return [n for room, names in pages.items() for n in names[: None if room == "." else ALIKE]]


def violations(page: Page) -> Iterator[str]:
    """Give what axe finds on the page that is open."""
    for fault in page.evaluate("axe.run(document)")["violations"]:
        excused = EXCUSED.get(fault["id"], {})
        for node in fault["nodes"]:
            place = " ".join(map(str, node["target"]))
            if not any(part in place for part in excused):
                why = " ".join(node["failureSummary"].split())
                yield f"{fault['id']} at {place}: {why}"


def look(page: Page, address: str) -> dict[str, list[str]]:
    """Return the faults of a page, each with the widths and themes in which it is there."""
    found: dict[str, list[str]] = {}
    said: list[str] = []
    page.on("request", lambda asked: _leaves(asked.url, address) and said.append(asked.url))
    page.on("pageerror", lambda error: said.append(f"error: {error}"))
    page.on("console", lambda line: line.type == "error" and said.append(f"error: {line.text}"))
    page.goto(address)
    page.add_script_tag(path=AXE)
    page.add_style_tag(content=STILL)
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 900})
        page.wait_for_timeout(SETTLED_MS)
        for theme in THEMES:
            page.emulate_media(color_scheme=theme, reduced_motion="reduce")
            page.wait_for_function(f"document.documentElement.dataset.theme === {theme!r}")
            wide = page.evaluate("document.documentElement.scrollWidth")
            faults = [*violations(page), *([f"is {wide} pixels wide"] if wide > width else [])]
            for fault in faults:
                found.setdefault(fault, []).append(f"{width} {theme}")
    for line in said:
        if not any(part in line for part in HARMLESS):
            found[line] = ["while it was loaded"]
    return found


def _leaves(url: str, address: str) -> bool:
    """Return whether a request goes elsewhere."""
    return not url.startswith((address[: address.index("/", 8) + 1], "data:", "blob:"))


def chromium() -> str | None:
    """Return the browser to drive."""
    names = ("chromium", "chromium-browser", "google-chrome")
    return os.environ.get("FLOWTEX_CHROMIUM") or next(filter(None, map(shutil.which, names)), None)


def main(site: Path) -> int:
    """Look at the site; return how many faults there are."""
    path = chromium()
    if path is None:
        print("  not looked at: there is no Chromium; FLOWTEX_CHROMIUM can name one")  # noqa: T201
        return 0
    names, count = chosen(site), 0
    with served(site) as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path)
        for name in names:
            page = browser.new_page()
            for fault, where in look(page, address + name).items():
                count += 1
                print(f"  {name}: {fault} ({', '.join(where)})")  # noqa: T201
            page.close()
        browser.close()
    print(f"  {len(names)} pages at {len(WIDTHS)} widths in both themes, {count} faults")  # noqa: T201
    return count


if __name__ == "__main__":
    sys.exit(bool(main(Path(sys.argv[1]).resolve())))
