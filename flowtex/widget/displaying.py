"""How a widget gets into a cell, once, and what stands there where widgets do not run."""

from __future__ import annotations

import base64
import sys
from typing import Any, Self

import anywidget

__all__ = ["Displayed"]

#: Seconds that a cell waits for the small picture, at most.
PATIENCE = 1.0


class Displayed(anywidget.AnyWidget):
    """A widget that can be displayed by a function and be the value of the same cell."""

    _shown_in: int | None = None

    def _picture(self, patience: float) -> bytes | None:
        """Return a PNG of the widget, which may be waited for."""
        raise NotImplementedError

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """Return the widget, and for where there are none a picture and a line of text."""
        bundle = super()._repr_mimebundle_(**kwargs)
        if not isinstance(bundle, tuple):
            return bundle
        data, metadata = bundle
        picture = self._picture(PATIENCE)
        encoded = {"image/png": base64.b64encode(picture).decode()} if picture else {}
        return {**data, **encoded}, metadata

    def _ipython_display_(self) -> None:
        """Display the widget, unless :func:`flowtex.show` has done so in this very cell."""
        number = _cell_number()
        shown, self._shown_in = self._shown_in, None
        if shown is not None and shown == number:
            return
        self._display()

    def _display(self) -> None:
        from IPython.display import display

        data, metadata = self._repr_mimebundle_()
        display(data, metadata=metadata, raw=True)

    def show(self) -> Self:
        """Display the widget now, and not once more as the value of the same cell."""
        self._display()
        self._shown_in = _cell_number()
        return self


def _cell_number() -> int | None:
    """Return the number of the cell that runs; ``None`` outside IPython."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return None if shell is None else int(shell.execution_count)
