"""Display of a widget in a cell, once, and of a still where widgets do not run.

A cell gets two outputs: the widget, and below it a still, that is a picture of it, alone or among
others in a box. JupyterLab shows a message in place of an output whose widget is missing, even if
the output has other forms; so the style of the still hides the output above it until a view is
drawn, and such a view hides the still. Thus a notebook without a kernel shows stills.
"""

from __future__ import annotations

import base64
import html
import sys
import time
import uuid
from collections import Counter, defaultdict
from typing import Any, Self

import anywidget
import ipywidgets

#: Most seconds that a cell waits for small pictures, however many widgets it shows.
MAX_WAIT_S = 6.0
#: Stills of one cell: of more than fifty outputs JupyterLab hides the rest.
MOST_STILLS = 20
VIEW = "application/vnd.jupyter.widget-view+json"
#: Hides the output above a still, where that has no view that is drawn.
STYLE = (
    ":is(.jp-OutputArea-child,.output_area):not(:has([data-live])):has(+ * > * > .flowtex-still)"
    "{display:none !important}"
)


_waits_of_cells: defaultdict[int | None, float] = defaultdict(float)
_stills_of_cells: Counter[int | None] = Counter()


class Displayed(anywidget.AnyWidget):
    """A widget that can be displayed by a function and be the value of the same cell."""

    _shown_in: int | None = None

    def __init__(self, **traits: Any) -> None:
        self._stills: dict[str, Any] = {}  # widgets with this one in them, by the still's name
        super().__init__(**traits)
        if (shell := _kernel_shell()) is not None:
            shell.display_formatter.ipython_display_formatter.for_type(ipywidgets.Box, _display_box)

    def _picture(self, timeout_s: float) -> bytes | None:
        """Return a PNG or JPEG of the widget, waiting for it at most ``timeout_s``."""
        raise NotImplementedError

    def _encoded_picture(self) -> tuple[str, str] | None:
        """Return the type of the still of a widget and its text in base64, if there is one."""
        cell = _cell_number()
        started = time.monotonic()
        picture = self._picture(max(MAX_WAIT_S - _waits_of_cells[cell], 0.0))
        _waits_of_cells[cell] += time.monotonic() - started
        if not picture or self.comm is None:
            return None
        if picture.startswith(b"\xff\xd8"):
            kind = "image/jpeg"
        else:
            kind = "image/png"
        return kind, base64.b64encode(picture).decode()

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """Return the widget, and a picture and a line of text for hosts without widgets."""
        bundle = super()._repr_mimebundle_(**kwargs)
        if not isinstance(bundle, tuple):
            return bundle
        data, metadata = bundle
        picture = self._encoded_picture()
        if picture:
            kind, content = picture
            data = {**data, kind: content}
        return data, metadata

    def _ipython_display_(self) -> None:
        """Display the widget, unless :func:`flowtex.show` has done so in this very cell."""
        number = _cell_number()
        shown = self._shown_in
        self._shown_in = None
        if shown is None or shown != number:
            _display(self)

    def show(self) -> Self:
        """Display the widget now, and not once more as the value of the same cell."""
        _display(self)
        self._shown_in = _cell_number()
        return self

    def _update_stills(self, *, last: bool = False) -> None:
        """Replace the stills below cells by present ones."""
        stills: dict[str, Any] = vars(self).get("_stills", {})  # missing if the constructor failed
        for name, shown in stills.items():
            _display_still(shown, name, update=True)
        if last:  # a widget is closed once more when it is collected
            stills.clear()


def _display(shown: Any) -> None:
    """Display a widget or a box of widgets, and its still, except in marimo."""
    if (marimo := sys.modules.get("marimo")) is not None and marimo.running_in_notebook():
        marimo.output.append(shown)
        return
    from IPython.display import display

    bundle = shown._repr_mimebundle_()
    if isinstance(bundle, tuple):
        data, metadata = bundle
    else:
        data = bundle
        metadata = {}
    cell = _cell_number()
    _stills_of_cells[cell] += 1
    if _kernel_shell() is None or _stills_of_cells[cell] > MOST_STILLS:
        display(data, metadata=metadata, raw=True)
        return
    # Some readers warn about an output without any text.
    display({VIEW: data[VIEW], "text/html": "", "text/plain": ""}, metadata=metadata, raw=True)
    name = uuid.uuid4().hex
    _display_still(shown, name)
    for widget in _displayed_in(shown):
        widget._stills[name] = shown


def _display_still(shown: Any, name: str, *, update: bool = False) -> None:
    """Display a still picture of widgets below a cell, or replace the one of this name."""
    from IPython.display import display

    keys = []
    for widget in _displayed_in(shown):
        if widget.comm is not None:
            keys.append(widget._key)
    data = {"text/plain": repr(shown), "text/html": ""}
    if keys:
        attributes = f'class="flowtex-still" data-flowtex="{" ".join(keys)}"'
        pictures = f"<div {attributes}>{_pictures(shown)}</div>"
        data["text/html"] = f"<style>{STYLE}</style>{pictures}"
        if isinstance(shown, Displayed) and (picture := shown._encoded_picture()):
            data |= [picture]
    display(data, raw=True, display_id=name, update=update)


def _pictures(shown: Any) -> str:
    """Return still pictures of widgets as HTML, arranged as the widgets are."""
    if isinstance(shown, ipywidgets.Box):
        if isinstance(shown, ipywidgets.VBox):
            direction = "column"
        else:
            direction = "row"
        style = f"display:flex;flex-direction:{direction};align-items:flex-start;gap:4px"
        return f'<div style="{style}">{"".join(map(_pictures, shown.children))}</div>'
    if isinstance(shown, Displayed):
        picture = shown._encoded_picture()
    else:
        picture = None
    if picture is None:
        return f"<p>{html.escape(repr(shown))}: run this notebook in a browser to see the flow.</p>"
    source = f"data:{picture[0]};base64,{picture[1]}"
    return (
        f'<img alt="{html.escape(repr(shown))}" style="max-width:100%;min-width:0" src="{source}">'
    )


def _displayed_in(shown: Any) -> list[Displayed]:
    """Return the widgets with a flow among a widget and its children."""
    if isinstance(shown, ipywidgets.Box):
        found = []
        for child in shown.children:
            for widget in _displayed_in(child):
                found.append(widget)
        return found
    if isinstance(shown, Displayed):
        return [shown]
    return []


def _display_box(box: Any) -> None:
    """Display a box that contains flows; for others IPython falls back to its own way."""
    if (display := getattr(box, "_ipython_display_", None)) is not None:
        display()
    elif not _displayed_in(box):
        raise NotImplementedError
    else:
        _display(box)


def _shell() -> Any:
    """Return IPython's shell, ``None`` outside of IPython."""
    ipython = sys.modules.get("IPython")
    if ipython is not None:
        return ipython.get_ipython()
    return None


def _kernel_shell() -> Any:
    """Return the shell of a notebook's kernel; Solara's substitute for one displays nothing."""
    shell = _shell()
    shows = hasattr(shell, "display_formatter") and getattr(shell, "kernel", None) is not None
    if shows:
        return shell
    return None


def _cell_number() -> int | None:
    return getattr(_shell(), "execution_count", None)
