"""Structured surfaces that meet at their borders are one surface, which streaks cross."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from cfd_files import CGNS
from scipy.spatial import cKDTree

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError, Notice
from flowtex.sources.open_source import MeshSource
from flowtex.sources.read_files import describe
from flowtex.trace.trace import trace

#: The flow of the zones of CGNS goes through their plane.
ACROSS = "ignore:.*of the flow is normal to the surface:flowtex.errors.Notice"
X = np.linspace(-1.0, 1.2, 23)
Y = np.linspace(-0.9, 1.0, 20)
TOGETHER = "3 blocks are drawn together: left, below, above"


def flow(points: Floats, time: float = 0.0) -> Floats:
    """A flow to the right, which bends."""
    x, y, _ = np.asarray(points, dtype=float).T
    return np.stack([1 + 0.2 * np.sin(3 * y + time), 0.6 * np.cos(2 * x), 0 * x], axis=-1)


def block(x: Floats, y: Floats, *, mirrored: bool = False, time: float = 0.0) -> pv.StructuredGrid:
    """Return a structured surface with the flow; a mirrored one has its rows from above."""
    if mirrored:
        y = y[::-1]
    across, upward = np.meshgrid(x, y, indexing="ij")
    grid = pv.StructuredGrid(across[..., None], upward[..., None], 0 * across[..., None])
    grid["velocity"] = flow(grid.points, time)
    grid["pressure"] = np.asarray(grid.points)[:, 0]
    return grid


def parts(*, mirrored: bool = False, time: float = 0.0) -> dict[str, pv.StructuredGrid]:
    """Return three blocks that meet in one node, and are the grid of X and Y together."""
    return {
        "left": block(X[:9], Y, time=time),
        "below": block(X[8:], Y[:7], mirrored=mirrored, time=time),
        "above": block(X[8:], Y[6:], time=time),
    }


def three(*, mirrored: bool = False, time: float = 0.0) -> pv.MultiBlock:
    return pv.MultiBlock(parts(mirrored=mirrored, time=time))


def check(field: FlowField, points: Floats, time: float = 0.0, step: int = 0) -> None:
    """Compare a field with the flow at every node, each of which it has once."""
    nearest = cKDTree(points).query(field.points[field.valid])
    distance, number = (np.asarray(found) for found in nearest)
    assert distance.max() < 1e-6
    assert sorted(number.tolist()) == list(range(len(points)))
    np.testing.assert_allclose(
        field.velocity[step][field.valid], flow(points, time)[number], atol=1e-6
    )


@pytest.mark.parametrize("mirrored", [False, True])
def test_each_node_is_there_once_with_its_flow(mirrored: bool) -> None:
    with pytest.warns(Notice, match=TOGETHER):
        field = FlowField.from_pyvista(three(mirrored=mirrored))
    check(field, block(X, Y).points)
    np.testing.assert_allclose(field.scalars["pressure"][0], field.points[..., 0], atol=1e-6)


@pytest.mark.parametrize("mirrored", [False, True])
def test_streaks_cross_borders_as_those_of_a_single_grid(mirrored: bool) -> None:
    with pytest.warns(Notice, match=TOGETHER):
        joined = FlowField.from_pyvista(three(mirrored=mirrored))
    single = FlowField.from_pyvista(block(X, Y).cast_to_unstructured_grid())
    ways = []
    for field in (joined, single):
        slices = trace(field, lags=[0.2, 0.6, 1.0], unit=1.0, parameter="time", tolerance=1e-6)
        assert slices.displacement is not None
        order = np.lexsort(np.round(field.points[0], 6).T)
        ways.append(np.asarray(slices.displacement)[0, :, 0][:, order])
    inside = np.isfinite(ways[1]).all(axis=(0, 2))
    assert inside.all()
    # Diagonals of cells may differ.
    np.testing.assert_allclose(ways[0], ways[1], atol=2e-3)
    assert np.linalg.norm(ways[0][-1], axis=-1).max() > 0.9


def test_a_ring_of_sectors_closes() -> None:
    """Three sectors of a ring, of which the last meets the first."""
    angles = np.linspace(0, 2 * np.pi, 49)
    radii = np.linspace(0.5, 1.0, 6)
    sectors = pv.MultiBlock()
    for first in (0, 16, 32):
        radius, angle = np.meshgrid(radii, angles[first : first + 17], indexing="ij")
        x, y = radius * np.cos(angle), radius * np.sin(angle)
        sector = pv.StructuredGrid(x[..., None], y[..., None], 0 * x[..., None])
        sector["velocity"] = np.cross([0, 0, 1.0], np.asarray(sector.points))
        sectors.append(sector)
    with pytest.warns(Notice, match="3 blocks are drawn together"):
        field = FlowField.from_pyvista(sectors)
    assert field.valid.sum() == 48 * 6
    slices = trace(field, lags=[2 * np.pi], unit=1.0, parameter="time", tolerance=1e-6)
    assert slices.displacement is not None
    # A turn leads back, up to the error of straight edges, which the outer nodes leave.
    inside = np.abs(np.linalg.norm(field.points[0], axis=-1) - 0.75) < 0.2
    assert np.abs(np.asarray(slices.displacement)[0, -1, 0][inside]).max() < 0.1


def test_values_of_both_sides_of_a_border_are_averaged() -> None:
    left, right = block(X[:9], Y), block(X[8:], Y)
    right["velocity"] = np.asarray(right["velocity"]) + np.array([0.1, 0.1, 0.0])
    with pytest.warns(Notice, match="2 blocks are drawn together"):
        field = FlowField.from_pyvista(pv.MultiBlock({"left": left, "right": right}))
    at = np.isclose(field.points[0, :, 0], X[8])
    expected = flow(field.points[0, at]) + np.array([0.05, 0.05, 0.0])
    np.testing.assert_allclose(field.velocity[0, 0, at], expected, atol=1e-6)


def test_velocities_on_cells() -> None:
    blocks = parts()
    for grid in blocks.values():
        grid.clear_point_data()
        grid.cell_data["velocity"] = np.tile([1.0, 0.5, 0.0], (grid.n_cells, 1))
    with pytest.warns(Notice, match=TOGETHER):
        field = FlowField.from_pyvista(pv.MultiBlock(blocks))
    assert field.valid.sum() == len(X) * len(Y)
    np.testing.assert_allclose(field.velocity[0, 0], np.tile([1.0, 0.5, 0.0], (460, 1)))


def test_nodes_that_one_block_hides_stay_hidden() -> None:
    blocks = parts()
    hidden = np.ones(blocks["above"].n_points, int)
    hidden[40] = 0
    blocks["above"]["IBlank"] = hidden
    with pytest.warns(Notice, match=TOGETHER):
        field = FlowField.from_pyvista(pv.MultiBlock(blocks))
    (lost,) = np.flatnonzero(~field.valid[0])
    np.testing.assert_allclose(field.points[0, lost], blocks["above"].points[40], atol=1e-6)


def test_blocks_without_vectors_are_named() -> None:
    blocks = parts()
    blocks["wall"] = block(X, Y[-1] + Y[:3] - Y[0])
    blocks["wall"].clear_data()
    missing = pytest.warns(Notice, match="wall has no vectors, and is not drawn")
    with missing, pytest.warns(Notice, match=TOGETHER):
        field = FlowField.from_pyvista(pv.MultiBlock(blocks))
    check(field, block(X, Y).points)


def test_one_block_can_be_chosen() -> None:
    field = FlowField.from_pyvista(three(), block="below")
    assert field.shape == (7, 15)


@pytest.mark.parametrize(
    "other",
    [block(X + 0.05, Y), block(X[4:], Y), block(X + 5, Y), block(X[-1] + X - X[0], Y + 0.03)],
)
def test_blocks_that_overlap_or_lie_apart_are_a_choice(other: Any) -> None:
    blocks = pv.MultiBlock({"one": block(X, Y), "other": other})
    with pytest.raises(FieldError, match=re.escape('choose one, as in block="one"')):
        FlowField.from_pyvista(blocks)


def test_a_series_of_blocks() -> None:
    steps = [three(time=time) for time in (0.0, 0.7)]
    with pytest.warns(Notice, match=TOGETHER):
        field = FlowField.from_pyvista(steps, times=[0.0, 0.7])
    for step, time in enumerate((0.0, 0.7)):
        check(field, block(X, Y).points, time, step)


def test_a_file_of_blocks(tmp_path: Path) -> None:
    path = tmp_path / "flow.vtm"
    three().save(path)
    with pytest.warns(Notice, match=TOGETHER):
        check(FlowField.from_file(path), block(X, Y).points)
    assert describe(path).problem == ""
    source = MeshSource.from_file(path)
    assert source.blocks == ()
    check(source.field(), block(X, Y).points)


@pytest.mark.filterwarnings(ACROSS)
def test_surface_zones_of_cgns(tmp_path: Path) -> None:
    def zone(x: Floats, y: Floats) -> Floats:
        upward, across = np.meshgrid(y, x, indexing="ij")
        return np.stack([across, upward, 0 * across], axis=-1)[None]

    with CGNS.write(tmp_path / "flow.cgns") as file:
        file.base("Wing", [("A", zone(X[:9], Y)), ("B", zone(X[8:], Y))])
    with pytest.warns(Notice, match="2 blocks are drawn together: Wing/A, Wing/B"):
        field = FlowField.from_file(tmp_path / "flow.cgns")
    assert field.valid.sum() == len(X) * len(Y)
