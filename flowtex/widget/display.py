"""How a widget gets into a cell, once, and what stands there where widgets do not run."""

from __future__ import annotations

import base64
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Self

import anywidget

__all__ = ["Displayed"]

#: Seconds that cells wait for small pictures, at most; how much comes back in a second.
MAX_WAIT_S, WAIT_REGAINED = 1.0, 0.2


class WaitBudget:
    """Time that may be waited for pictures, however many widgets are shown at once."""

    def __init__(self) -> None:
        self._left, self._at = MAX_WAIT_S, time.monotonic()

    @contextmanager
    def spend(self) -> Iterator[float]:
        """Give the seconds that are left; those that pass meanwhile are used up."""
        started = time.monotonic()
        self._left = min(MAX_WAIT_S, self._left + WAIT_REGAINED * (started - self._at))
        try:
            yield self._left
        finally:
            self._at = time.monotonic()
            self._left = max(self._left - (self._at - started), 0.0)


_wait_budget = WaitBudget()


class Displayed(anywidget.AnyWidget):
    """A widget that can be displayed by a function and be the value of the same cell."""

    _shown_in: int | None = None

    def _picture(self, timeout_s: float) -> bytes | None:
        """Return a PNG of the widget, which may be waited for."""
        raise NotImplementedError

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """Return the widget, and for where there are none a picture and a line of text."""
        bundle = super()._repr_mimebundle_(**kwargs)
        if not isinstance(bundle, tuple):
            return bundle
        data, metadata = bundle
        with _wait_budget.spend() as seconds:
            picture = self._picture(seconds)
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
