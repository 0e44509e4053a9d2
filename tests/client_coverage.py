"""What of the browser client a test run executes, as Chromium counts it.

With ``FLOWTEX_CLIENT_COVERAGE`` in the environment each page writes its counts into that folder
before it is left; ``client/coverage.js`` maps them to the sources.
"""

from __future__ import annotations

import hashlib
import json
import os
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from playwright.sync_api import Browser, BrowserContext, Error, Page

if TYPE_CHECKING:
    import pytest
    from playwright.sync_api import CDPSession

__all__ = ["FOLDER", "count_in"]

FOLDER = os.environ.get("FLOWTEX_CLIENT_COVERAGE", "")
#: First words of a bundle: client/build.js.
BUILT = "// Built from client/src"


def count_in(folder: Path, patch: pytest.MonkeyPatch) -> None:
    """Count in all pages that are opened, and write the counts before a page is left or closed."""
    folder.mkdir(parents=True, exist_ok=True)
    sessions: dict[Page, CDPSession] = {}

    def begin(page: Page) -> Page:
        session = page.context.new_cdp_session(page)
        for method in ("Debugger.enable", "Profiler.enable"):
            session.send(method)
        session.send("Profiler.startPreciseCoverage", {"callCount": True, "detailed": True})
        sessions[page] = session
        return page

    def take(page: Page) -> None:
        session = sessions.get(page)
        if session is None:
            return
        try:
            for script in session.send("Profiler.takePreciseCoverage")["result"]:
                _write(folder, session, script)
        except Error:  # the page has crashed
            sessions.pop(page)

    def before(owner: type, name: str, pages: Callable[[Any], list[Page]]) -> None:
        method = getattr(owner, name)

        def called(self: Any, *args: Any, **options: Any) -> Any:
            for page in pages(self):
                take(page)
            return method(self, *args, **options)

        patch.setattr(owner, name, called)

    def after(owner: type) -> None:
        method = owner.new_page  # type: ignore[attr-defined]
        patch.setattr(owner, "new_page", lambda self, **options: begin(method(self, **options)))

    after(BrowserContext)
    after(Browser)
    for name in ("goto", "reload", "set_content", "close"):
        before(Page, name, lambda page: [page])
    before(BrowserContext, "close", lambda context: context.pages)


def _write(folder: Path, session: CDPSession, script: dict[str, Any]) -> None:
    if not any(function["ranges"][0]["count"] for function in script["functions"]):
        return
    source = session.send("Debugger.getScriptSource", {"scriptId": script["scriptId"]})
    text = source["scriptSource"]
    if not text.lstrip().startswith(BUILT):
        return
    name = hashlib.sha1(text.encode()).hexdigest()
    (folder / f"{name}.js").write_text(text, encoding="utf-8", newline="")
    counts = {"script": name, "functions": script["functions"]}
    (folder / f"{uuid.uuid4().hex}.json").write_text(json.dumps(counts), encoding="utf-8")
