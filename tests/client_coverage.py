"""Coverage of the browser client in Chromium, as V8 counts it, for ``make coverage``.

As a pytest plugin (``-p client_coverage``) it writes what ran of each built file, a JSON
file for each page and document, into the folder that ``FLOWTEX_CLIENT_COVERAGE`` names;
``client/coverage.js`` maps that to the sources.
"""

from __future__ import annotations

import functools
import json
import os
import uuid
from pathlib import Path
from typing import Any

import pytest
from playwright import sync_api

BUNDLES = {
    path.name: path.read_text(encoding="utf-8")
    for folder in ("host/static", "app/ui/static")
    for path in (Path(__file__).parents[1] / "flowtex" / folder).glob("*.js")
}
SHORTEST = min(map(len, BUNDLES.values()))


class PageCoverage:
    """The counts of one page: which of its scripts hold a built file, and what of them ran."""

    def __init__(self, page: sync_api.Page, folder: Path) -> None:
        self._folder = folder
        self._lengths: dict[str, int] = {}
        self._session = page.context.new_cdp_session(page)
        self._session.on("Debugger.scriptParsed", self._note_script)
        for command, arguments in [
            ("Profiler.enable", {}),
            ("Profiler.startPreciseCoverage", {"callCount": True, "detailed": True}),
            ("Debugger.enable", {}),
            ("Debugger.setSkipAllPauses", {"skip": True}),
        ]:
            self._session.send(command, arguments)

    def _note_script(self, script: dict[str, Any]) -> None:
        self._lengths[script["scriptId"]] = script["length"]

    def take(self) -> None:
        """Write the counts since the last call."""
        found = []
        for script in self._session.send("Profiler.takePreciseCoverage")["result"]:
            identifier = script["scriptId"]
            if self._lengths.get(identifier, 0) < SHORTEST:
                continue
            try:
                answer = self._session.send("Debugger.getScriptSource", {"scriptId": identifier})
            except sync_api.Error:  # the script is gone with its frame
                continue
            for name, text in BUNDLES.items():
                start = answer["scriptSource"].find(text)
                if start >= 0:
                    functions = _shifted(script["functions"], start, len(text))
                    found.append({"bundle": name, "functions": functions})
        if found:
            path = self._folder / f"{uuid.uuid4()}.json"
            path.write_text(json.dumps(found), encoding="utf-8")


def _shifted(functions: list[Any], start: int, length: int) -> list[Any]:
    """Functions with ranges counted from the built file, which a script holds from ``start`` on."""
    kept = []
    for function in functions:
        ranges = [
            {
                "startOffset": max(each["startOffset"] - start, 0),
                "endOffset": min(each["endOffset"] - start, length),
                "count": each["count"],
            }
            for each in function["ranges"]
            if each["endOffset"] > start and each["startOffset"] < start + length
        ]
        if ranges:
            kept.append({**function, "ranges": ranges})
    return kept


def _before(patch: pytest.MonkeyPatch, owner: type, name: str, act: Any) -> None:
    """Let ``act(self)`` run before a method does."""
    method = getattr(owner, name)

    @functools.wraps(method)
    def wrapper(self: Any, *arguments: Any, **named: Any) -> Any:
        act(self)
        return method(self, *arguments, **named)

    patch.setattr(owner, name, wrapper)


def pytest_configure(config: pytest.Config) -> None:
    """Count from the creation of each page until it is closed, and before it goes elsewhere."""
    folder = Path(os.environ["FLOWTEX_CLIENT_COVERAGE"])
    folder.mkdir(parents=True, exist_ok=True)
    patch = pytest.MonkeyPatch()
    config.add_cleanup(patch.undo)
    counted: dict[sync_api.Page, PageCoverage] = {}

    def take(page: sync_api.Page) -> None:
        if page in counted and not page.is_closed():
            counted[page].take()

    def take_all(context: sync_api.BrowserContext) -> None:
        for page in context.pages:
            take(page)

    def take_contexts(browser: sync_api.Browser) -> None:
        for context in browser.contexts:
            take_all(context)

    for name in ("close", "goto", "reload", "set_content"):
        _before(patch, sync_api.Page, name, take)
    _before(patch, sync_api.BrowserContext, "close", take_all)
    _before(patch, sync_api.Browser, "close", take_contexts)
    for owner in (sync_api.Browser, sync_api.BrowserContext):
        _count_new_pages(patch, owner, counted, folder)


def _count_new_pages(
    patch: pytest.MonkeyPatch, owner: type, counted: dict[Any, PageCoverage], folder: Path
) -> None:
    new_page = owner.new_page  # type: ignore[attr-defined]

    @functools.wraps(new_page)
    def counted_page(self: Any, *arguments: Any, **named: Any) -> Any:
        page = new_page(self, *arguments, **named)
        if page.context.browser.browser_type.name == "chromium":
            counted[page] = PageCoverage(page, folder)
        return page

    patch.setattr(owner, "new_page", counted_page)
