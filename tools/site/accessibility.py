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
#: Of pages made alike so many are looked at, in folders of these names; elsewhere all of them.
ALIKE = {"api": 4, "gallery": 4}
#: What the theme does that is against a rule, by rule: the elements, and why it stays.
OF_THE_THEME: dict[str, dict[str, str]] = {}
#: Rules of axe that are left out, with the reason.
RULES: dict[str, str] = {}
#: Lines of the console that are no fault of a page.
HARMLESS = ("GPU stall due to ReadPixels", "GL Driver Message", "Automatic fallback to software")


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
            pages.setdefault(name.parts[0] if len(name.parts) > 1 else "", []).append(str(name))
    return [name for folder, names in pages.items() for name in names[: ALIKE.get(folder)]]


def violations(page: Page) -> Iterator[str]:
    """Give what axe finds on the page that is open."""
    options = {"rules": {rule: {"enabled": False} for rule in RULES}}
    result = page.evaluate("options => axe.run(document, options)", options)
    for fault in result["violations"]:
        excused = OF_THE_THEME.get(fault["id"], {})
        for node in fault["nodes"]:
            place = " ".join(map(str, node["target"]))
            if not any(part in place for part in excused):
                why = " ".join(node["failureSummary"].split())
                yield f"{fault['id']} at {place}: {why}"


def look(browser: Any, address: str, names: list[str], width: int, theme: str) -> Iterator[str]:
    """Give the faults of pages at a width and in a theme."""
    size = {"width": width, "height": 900}
    context = browser.new_context(viewport=size, color_scheme=theme, reduced_motion="reduce")
    page, said = context.new_page(), []
    page.on("request", lambda r: said.append(f"asks for {r.url}") if leaves(r.url, address) else 0)
    page.on("pageerror", lambda error: said.append(f"error: {error}"))
    page.on("console", lambda line: said.append(line.text) if line.type == "error" else 0)
    for name in names:
        said.clear()
        page.goto(address + name)
        page.add_script_tag(path=AXE)
        wide = page.evaluate("document.documentElement.scrollWidth")
        faults = [*violations(page), *said]
        if wide > width:
            faults.append(f"is {wide} pixels wide")
        for fault in faults:
            if not any(part in fault for part in HARMLESS):
                yield f"{name} ({width}, {theme}): {fault}"
    context.close()


def leaves(url: str, address: str) -> bool:
    """Tell whether a request goes elsewhere."""
    return not url.startswith((address, "data:", "blob:"))


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
        for width in WIDTHS:
            for theme in THEMES:
                for fault in look(browser, address, names, width, theme):
                    count += 1
                    print(f"  {fault}")  # noqa: T201
        browser.close()
    print(f"  {len(names)} pages at {len(WIDTHS)} widths in both themes, {count} faults")  # noqa: T201
    return count


if __name__ == "__main__":
    sys.exit(bool(main(Path(sys.argv[1]).resolve())))
