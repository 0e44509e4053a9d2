"""Slices made ready before they are shown."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pytest

import flowtex
from flowtex.textures.texture_set import LayerPrefetch, TextureSet
from flowtex.trace.store import SliceStore


@pytest.fixture(scope="module")
def made() -> TextureSet:
    y, x = np.mgrid[0:1:9j, 0:1:11j]
    velocity = np.stack([np.stack([1 + 0 * x, k + 0 * x], -1) for k in range(4)])
    field = flowtex.FlowField.from_arrays(np.stack([x, y], -1), velocity, times=[0, 1, 2, 3])
    return TextureSet.build(SliceStore(field))


@pytest.fixture
def counted(made: TextureSet, monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, str]]:
    """Steps whose layers were made, and by which thread."""
    found: list[tuple[int, str]] = []
    layers = TextureSet.layers

    def count(self: TextureSet, step: int = 0) -> Any:
        found.append((step, threading.current_thread().name))
        return layers(self, step)

    monkeypatch.setattr(TextureSet, "layers", count)
    return found


@pytest.mark.threads
def test_what_is_ready_is_not_made_again(made: TextureSet, counted: list[tuple[int, str]]) -> None:
    prefetch = LayerPrefetch(made)
    prefetch.prepare(2)
    prefetch.prepare(2)
    taken = prefetch.take(2)
    assert [step for step, _ in counted] == [2]
    assert counted[0][1].startswith("flowtex-prefetch")
    np.testing.assert_array_equal(taken, made.layers(2))
    prefetch.close()


def test_another_step_is_made_at_once(made: TextureSet, counted: list[tuple[int, str]]) -> None:
    prefetch = LayerPrefetch(made)
    prefetch.prepare(3)
    np.testing.assert_array_equal(prefetch.take(1), made.layers(1))
    assert (1, threading.current_thread().name) in counted
    prefetch.close()


@pytest.mark.parametrize("step", [-1, 4])
def test_beyond_the_ends_there_is_nothing_to_make(
    made: TextureSet, counted: list[tuple[int, str]], step: int
) -> None:
    prefetch = LayerPrefetch(made)
    prefetch.prepare(step)
    prefetch.close()
    assert counted == []


@pytest.mark.parametrize("forward", [True, False])
def test_playing_makes_the_next_step_ready_in_either_direction(
    plotter: Any, made: TextureSet, forward: bool
) -> None:
    handle = plotter.flowtex.add(made.geometry.field, scalars=False)
    handle.time = 1.5
    plotter.screenshot()
    prepared: list[int] = []
    handle._surface._base._prefetch.prepare = prepared.append
    handle.time = 1.6 if forward else 1.4
    assert prepared == [3 if forward else 0]
