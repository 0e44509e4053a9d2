"""The page around the view: ``page.html``, a template of Vue's, with its names filled in."""

from __future__ import annotations

import string
from collections.abc import Callable
from pathlib import Path
from typing import Any

from trame.ui.vuetify3 import VAppLayout

from flowtex.app.controllers import Controllers
from flowtex.app.controllers.appearance import ANOTHER_FILE, ANOTHER_TIME, BACKGROUNDS
from flowtex.app.controllers.sharing import FORMATS
from flowtex.app.server.uploads import UPLOAD_SUFFIXES
from flowtex.app.streaming.element import PAINTERS
from flowtex.settings import TABLE

TEMPLATE = Path(__file__).parent / "page.html"
#: Mark of the view in the template.
VIEW = "<!-- the view -->"
#: Error messages are dark in both themes.
COMPLAINT = {"surface-variant": "#2a3440", "on-surface-variant": "#e8edf2"}
THEMES = {
    "dark": {"dark": True, "colors": {"primary": "#4fd1c5", "surface": "#171c23", **COMPLAINT}},
    "light": {"dark": False, "colors": {"primary": "#0f766e", "surface": "#ffffff", **COMPLAINT}},
}
#: Words of the template that are the same on each page.
WORDS = {
    "UPLOADS": ",".join(UPLOAD_SUFFIXES),
    "BACKGROUNDS": str(list(BACKGROUNDS)),
    "FORMATS": str(list(FORMATS)),
    "PAINTERS": str(list(PAINTERS)),
    "ANOTHER_FILE": ANOTHER_FILE,
    "ANOTHER_TIME": ANOTHER_TIME,
    "LOD": TABLE["lod"].label.lower(),
    # Attributes of widgets of a kind.
    "BUTTON": 'icon size="small" variant="text"',
    "NUMBER": 'type="number" step="any" class="flowtex-number"',
    "SELECT": 'density="compact" variant="plain" hide-details class="flowtex-select" '
    ":menu-props=\"{ contentClass: 'flowtex-list' }\" :list-props=\"{ density: 'compact' }\"",
    "SLIDER": 'density="compact" color="primary" hide-details thumb-size="14" track-size="3"',
    "SWITCH": 'density="compact" color="primary" hide-details inset class="flowtex-switch"',
    "TOGGLE": 'density="compact" color="primary" variant="text" mandatory class="flowtex-toggle"',
}


class _Page(string.Template):
    delimiter = "%"


class _Names(dict[str, str]):
    """Words of the template; all others are names of values of the page's state."""

    def __init__(self, key: Callable[[str], str], words: dict[str, str]) -> None:
        super().__init__(words)
        self._key = key

    def __missing__(self, name: str) -> str:
        return self._key(name)


def build_page(controllers: Controllers) -> Any:
    """Build the page; return trame's layout, whose ``html`` is the text of the page."""
    context, data, sharing = controllers.context, controllers.data, controllers.sharing
    state, server = context.state, context.state.server
    actions = {
        "list_files": data.list_files,
        "reload": data.reload,
        "cancel_opening": controllers.cancel_opening,
        "look_from": controllers.viewpoint.look_from,
        "save": sharing.start,
        "cancel_saving": sharing.cancel,
        "show_state": sharing.show_state,
        "take_link": sharing.take_link,
    }
    words = {**WORDS, **{name: server.trigger_name(call) for name, call in actions.items()}}
    words["TYPED"] = "true" if context.library.typed else "false"
    page = _Page(TEMPLATE.read_text("utf-8")).substitute(_Names(state.key, words))
    config = {"theme": {"defaultTheme": "dark", "themes": THEMES}}
    before, after = page.split(VIEW)
    with VAppLayout(server, vuetify_config=config) as layout:
        layout.root.theme = (state.key("theme"),)
        layout.root.add_child(before)
        context.area.ui(classes="flowtex-area")
        layout.root.add_child(after)
    return layout
