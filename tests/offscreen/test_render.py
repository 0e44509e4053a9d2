"""Pictures of the same numbers, one after the other."""

from __future__ import annotations

import gc
import importlib
import weakref
from typing import Any

import numpy as np
import pytest

import flowtex
from flowtex import FlowField, examples
from flowtex.offscreen.render import _drawn
from flowtex.trace import store

SMALL: dict[str, Any] = {"size": (64, 48), "samples": 3}


@pytest.fixture(autouse=True)
def _nothing_kept() -> None:
    _drawn.clear()
    gc.collect()


@pytest.fixture
def traced(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Numbers of nodes that were traced."""
    counts: list[int] = []
    trace = importlib.import_module("flowtex.trace.trace").trace

    def counted(field: FlowField, **options: Any) -> Any:
        counts.append(field.valid.size)
        return trace(field, **options)

    monkeypatch.setattr(store, "trace", counted)
    return counts


@pytest.mark.usefixtures("opengl")
def test_a_mesh_is_traced_once_until_it_changes(traced: list[int]) -> None:
    mesh = examples.double_gyre()
    first = flowtex.render(mesh, **SMALL)
    again = flowtex.render(mesh.copy(), **SMALL)
    flowtex.render(mesh, zoom=2, **SMALL)
    assert np.array_equal(first, again)
    assert len(traced) == 1
    np.asarray(mesh["velocity"])[:, 0] *= -1  # PyVista does not see it
    assert not np.array_equal(first, flowtex.render(mesh, **SMALL))
    assert len(traced) == 2


@pytest.mark.usefixtures("opengl")
def test_what_is_kept_fits_into_some_memory(
    traced: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    fields = [examples.double_gyre_field(shape=(21, 25 + n)) for n in range(3)]
    flowtex.render(fields[0], **SMALL)
    monkeypatch.setattr(_drawn, "max_bytes", int(1.5 * _drawn.nbytes))
    flowtex.render(fields[1], **SMALL)
    flowtex.render(fields[1], **SMALL)
    assert len(_drawn) == 1 and len(traced) == 2
    gone = weakref.ref(fields.pop(0))
    gc.collect()
    assert gone() is None
