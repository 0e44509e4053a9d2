"""The first view of several flows on one plotter."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from itertools import permutations
from typing import Any

import numpy as np
import pytest
import pyvista as pv

from flowtex.rendering.camera import read_camera

pytestmark = [
    pytest.mark.usefixtures("opengl"),
    pytest.mark.filterwarnings("ignore::flowtex.errors.Notice"),
]
SLICES = ("x=0.9", "y=0.7", "z=0.5")
ASPECT = 1.5


def box() -> Any:
    mesh: Any = pv.ImageData(dimensions=(10, 9, 8), spacing=(0.2, 0.2, 0.2))
    x, y, z = np.asarray(mesh.points).T
    mesh["v"] = np.stack([1 + y, 1 + z, 1 + x], axis=-1)
    return mesh


@pytest.fixture
def window() -> Iterator[Any]:
    made: Any = pv.Plotter(off_screen=True, window_size=[240, 160])
    with closing(made):
        yield made


@pytest.mark.parametrize("order", list(permutations(SLICES)), ids=str)
def test_orthogonal_slices_are_all_seen(window: Any, order: tuple[str, ...]) -> None:
    mesh = box()
    handles = [window.flowtex.add(mesh, slice=cut, samples=3) for cut in order]
    camera = read_camera(window.camera)
    for handle in handles:
        surface = handle.field.surface
        assert not camera.sees_edge_on(surface)
        places = camera.project(surface.points, ASPECT)
        assert np.abs(places).max() < 1
        # Each covers a good part of the picture, which its corners span.
        assert np.ptp(places.reshape(-1, 2), axis=0).min() > 0.4


def test_parallel_slices_are_seen_straight_on(window: Any) -> None:
    mesh = box()
    for cut in ("z=0.5", "z=0.7"):
        window.flowtex.add(mesh, slice=cut, samples=3)
    assert read_camera(window.camera).axes[2] == pytest.approx([0, 0, -1])


def test_camera_that_was_moved_or_kept_stays(window: Any) -> None:
    mesh = box()
    window.flowtex.add(mesh, slice="z=0.5", samples=3)
    pointed = read_camera(window.camera)
    window.flowtex.add(mesh, slice="x=0.9", samples=3, reset_camera=False)
    assert read_camera(window.camera) == pointed
    window.camera.zoom(1.5)
    moved = read_camera(window.camera)
    window.flowtex.add(mesh, slice="y=0.7", samples=3)
    assert read_camera(window.camera) == moved
