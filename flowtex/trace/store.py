"""Trace slices by destination time, traced when they are first asked for.

A field of many time steps is drawn at one moment, so only the steps around that moment are
traced, and those asked for last are kept; unless all of them fit in memory and can be composed,
which is quicker.
"""

from __future__ import annotations

import threading
import weakref
from collections import OrderedDict

import numpy as np
from numpy.typing import NDArray

from flowtex.field import FlowField
from flowtex.trace.compose import landings
from flowtex.trace.lags import choose_lags, lag_unit
from flowtex.trace.slices import TraceSlices
from flowtex.trace.trace import trace

__all__ = ["SliceStore", "shared_store"]

#: Bytes of slices that are kept, besides the ones in use.
KEEP = 512_000_000


class SliceStore:
    """Slices of one field, one destination time at a time.

    Parameters
    ----------
    field
        The flow.
    parameter
        What a lag measures, as for :func:`flowtex.trace`.
    slices
        Slices of all steps that were traced already; nothing is traced then.
    compose
        Whether all steps may be composed together, which is quicker than step by step, but
        slower for one or two of them.

    Raises
    ------
    ValueError
        When slices of a field without a sign lead to one side only.
    """

    def __init__(
        self,
        field: FlowField,
        *,
        parameter: str = "arclength",
        slices: TraceSlices | None = None,
        compose: bool = True,
    ) -> None:
        if field.sign_free and slices is not None and slices.forward is None:
            msg = "the slices lead backward only; expected both sides of a field without a sign"
            raise ValueError(msg)
        self.field = field
        self._whole = slices
        self._compose = compose
        self._kept: OrderedDict[int, TraceSlices] = OrderedDict()
        self._lock = threading.Lock()
        if slices is None:
            self.parameter = parameter if field.steady else "time"
            self.lags: NDArray[np.float64] = choose_lags(field, self.parameter)
            self.unit: NDArray[np.float64] = lag_unit(field, self.parameter)
        else:
            self.parameter, self.lags, self.unit = slices.parameter, slices.lags, slices.unit

    @property
    def steps(self) -> int:
        """Number of destination times."""
        return len(self.field.times)

    @property
    def nbytes(self) -> int:
        """Bytes of the slices that it holds."""
        whole = [] if self._whole is None else [self._whole]
        return sum(slices.nbytes for slices in (*whole, *self._kept.values()))

    @property
    def two_sided(self) -> bool:
        """Whether paths lead forward too."""
        return self.field.steady if self._whole is None else self._whole.forward is not None

    def at(self, step: int) -> TraceSlices:
        """Slices of one destination time, T = 1."""
        with self._lock:
            if step in self._kept:
                self._kept.move_to_end(step)
                return self._kept[step]
            found = self._trace(step) if self._whole is None else self._whole.at_step(step)
            self._kept[step] = found
            while len(self._kept) > max(2, KEEP // max(found.nbytes, 1)):
                self._kept.popitem(last=False)
            return found

    def _trace(self, step: int) -> TraceSlices:
        if self.field.steady:
            return trace(self.field, parameter=self.parameter)
        size = self.steps * len(self.lags) * self.unit.size * 2 * np.float32().nbytes
        if self._compose and size < KEEP and landings(self.field, self.lags, self.unit) is not None:
            # Composed, all steps together take about as long as four that are integrated.
            self._whole = trace(self.field, lags=self.lags, unit=self.unit, compose=True)
            return self._whole.at_step(step)
        return trace(self.field, lags=self.lags, unit=self.unit, steps=[step])


_shared: weakref.WeakValueDictionary[tuple[int, str], SliceStore] = weakref.WeakValueDictionary()


def shared_store(field: FlowField, parameter: str) -> SliceStore:
    """Return the store of a field, one for all that show the field at the same time.

    Parameters
    ----------
    field
        The flow.
    parameter
        What a lag measures, as for :func:`flowtex.trace`.
    """
    # A store keeps its field alive, so the number of the field is its own while the store lives.
    key = (id(field), parameter)
    store = _shared.get(key)
    if store is None:
        store = _shared[key] = SliceStore(field, parameter=parameter)
    return store
