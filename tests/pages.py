"""Pages of a browser: each in its own context, and as patient as all that waits."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from waiting import PATIENCE_S

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page

#: A view of the client whose picture is the full one, of all that belongs to it.
COMPLETE = '.flowtex[data-sharp="true"][data-tiles="0"][data-lacking="0"]'
#: Ends when the browser has drawn what it knew of when it was called.
PAINTED = "() => new Promise((f) => requestAnimationFrame(() => requestAnimationFrame(f)))"

_contexts: WeakKeyDictionary[Browser, dict[str, BrowserContext]] = WeakKeyDictionary()


def new_context(browser: Browser, **options: Any) -> BrowserContext:
    """Return a context that waits for as long as any test does."""
    context = browser.new_context(**options)
    context.set_default_timeout(1000 * PATIENCE_S)
    return context


@contextmanager
def opened_page(
    browser: Browser, width: int = 300, height: int = 200, **options: Any
) -> Iterator[Page]:
    """Yield a new page without cookies, and close it.

    Pages with the same options share a context and its process, which an empty page keeps: in a
    new one a page takes three times the processor time, as everything is compiled again. The client
    stores nothing but what ends with the page.
    """
    kept = _contexts.setdefault(browser, {})
    name = repr(sorted(options.items()))
    if name not in kept:
        kept[name] = new_context(browser, **options)
        kept[name].new_page()
    page = kept[name].new_page()
    page.set_viewport_size({"width": width, "height": height})
    try:
        yield page
    finally:
        page.close()
        kept[name].clear_cookies()


def painted(page: Page) -> None:
    """Wait for two frames of the page: what was begun before is on the screen."""
    page.evaluate(PAINTED)


@contextmanager
def acted(page: Page, nth: int = 0) -> Iterator[None]:
    """Do something to one of the views, and wait for the full picture that comes after it."""
    view = f"document.querySelectorAll('.flowtex')[{nth}]"
    before = page.evaluate(f"() => Number({view}.dataset.frames)")
    yield
    page.wait_for_function(
        f"(n) => Number({view}.dataset.frames) > n && {view}.matches('{COMPLETE}')", arg=before
    )


#: Roles of what a person operates, which needs a name.
OPERATED = {
    *("button", "checkbox", "combobox", "link", "listbox", "menuitem", "radio", "searchbox"),
    *("slider", "spinbutton", "switch", "tab", "textbox", "application"),
}


def operated(page: Page) -> list[tuple[str, str]]:
    """Return role and name of all that a person operates, as a screen reader gets them."""
    session = page.context.new_cdp_session(page)
    nodes = session.send("Accessibility.getFullAXTree")["nodes"]
    session.detach()
    found = [(node.get("role", {}).get("value"), node) for node in nodes if not node["ignored"]]
    return [
        (role, node.get("name", {}).get("value", "").strip())
        for role, node in found
        if role in OPERATED and _has(node, "focusable")
    ]


def _has(node: Any, name: str) -> bool:
    values = {each["name"]: each["value"].get("value") for each in node.get("properties", [])}
    return bool(values.get(name))


#: Gives the name of the element that has the focus, also in a shadow.
FOCUSED = """() => {
  let at = document.activeElement;
  while (at?.shadowRoot?.activeElement) at = at.shadowRoot.activeElement;
  return at.getAttribute("aria-label") ?? at.textContent;
}"""


def focused(page: Page) -> str:
    """Return the name of the element that has the focus."""
    return str(page.evaluate(FOCUSED))
