"""Meshes of TUFLOW FV and TELEMAC, and directions that are classes."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from flowtex import FlowField

pytestmark = pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")

FORMS = Path(os.environ.get("FLOWTEX_DATA", "")) / "forms"
needs_data = pytest.mark.skipif(
    not FORMS.is_dir(), reason="FLOWTEX_DATA names no folder of real data"
)


@needs_data
def test_tuflow_matches_means_of_cells() -> None:
    ds = xr.open_dataset(FORMS / "tuflow_cone.nc")
    field = FlowField.from_file(FORMS / "tuflow_cone.nc")
    assert len(field.times) == 16 and np.allclose(np.diff(field.times), 60, rtol=1e-3)
    step, nodes = 3, ds.cell_node.values - 1
    wet = ds.stat.values[step] != 0
    area = np.where(wet, ds.cell_A.values, 0.0)
    for name, component in (("V_x", 0), ("V_y", 1)):
        totals, weights = np.zeros(ds.sizes["NumVert2D"]), np.zeros(ds.sizes["NumVert2D"])
        for corner in range(4):
            at, has = nodes[:, corner], nodes[:, corner] >= 0
            np.add.at(totals, at[has], (area * ds[name].values[step])[has])
            np.add.at(weights, at[has], area[has])
        known = weights > 0
        drawn = np.asarray(field.velocity[step])[0, :, component]
        assert known.any() and not known.all()
        assert np.allclose(drawn[known], totals[known] / weights[known], atol=1e-5)
    assert np.allclose(field.points[0, :, 0], ds.node_X) and field.length_unit == "m"


def test_tuflow_with_layers_draws_the_top() -> None:
    x, y = (c.ravel() for c in np.meshgrid(np.arange(4.0), np.arange(4.0)))
    first = (np.arange(3) + 4 * np.arange(3)[:, None]).ravel() + 1
    cells = np.stack([first, first + 1, first + 5, first + 4], axis=-1)
    top = np.cumsum([0, *[1, 2, 3] * 3])[:9] + 1
    values = np.full(18, -9.0)
    values[top - 1] = 2.0
    ds = xr.Dataset(
        {
            "cell_node": (("NumCells2D", "MaxNumCellVert"), cells),
            "cell_Nvert": ("NumCells2D", np.full(9, 4)),
            "idx3": ("NumCells2D", top),
            "node_X": ("NumVert2D", x, {"units": "m"}),
            "node_Y": ("NumVert2D", y, {"units": "m"}),
            "V_x": (("Time", "NumCells3D"), values[None], {"units": "m s^-1"}),
            "V_y": (("Time", "NumCells3D"), 2 * values[None], {"units": "m s^-1"}),
            "stat": (("Time", "NumCells2D"), np.full((1, 9), -1)),
            "ResTime": ("Time", [0.5], {"units": "hours"}),
        }
    )
    field = FlowField.from_xarray(ds)
    assert np.allclose(field.velocity[0][0], [2, 4, 0]) and field.triangles is not None
    assert len(field.triangles) == 18


def test_telemac_uses_its_triangles() -> None:
    x, y = (c.ravel() for c in np.meshgrid(np.arange(6.0), np.arange(6.0)))
    number = np.arange(36).reshape(6, 6) + 1
    a, b, c, d = (
        number[r, c].ravel()
        for r, c in [
            (np.s_[:-1], np.s_[:-1]),
            (np.s_[:-1], np.s_[1:]),
            (np.s_[1:], np.s_[1:]),
            (np.s_[1:], np.s_[:-1]),
        ]
    )
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])[:-1]
    ds = xr.Dataset(
        {"U": (("time", "node"), x[None]), "V": (("time", "node"), y[None])},
        {"x": ("node", x), "y": ("node", y)},
        {"ikle2": faces},
    )
    field = FlowField.from_xarray(ds)
    assert field.triangles is not None
    assert {*map(frozenset, field.triangles.tolist())} == {*map(frozenset, (faces - 1).tolist())}
    assert np.allclose(field.velocity[0][0, :, :2], np.stack([x, y], -1))


def ring() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return coordinates of nodes around a hole, (N,) each, and triangles, (M, 3), from 0."""
    turn, radius = np.meshgrid(2 * np.pi * np.arange(12) / 12, [1.0, 2.0, 3.0])
    number = np.arange(36).reshape(3, 12)
    inner, outer = number[:-1], number[1:]
    following = np.roll(number, -1, axis=1)
    one = np.stack([inner, outer, following[1:]], axis=-1).reshape(-1, 3)
    two = np.stack([inner, following[1:], following[:-1]], axis=-1).reshape(-1, 3)
    return (radius * np.cos(turn)).ravel(), (radius * np.sin(turn)).ravel(), np.vstack([one, two])


@pytest.mark.parametrize(("name", "first"), [("faces", 0), ("triangles", 1), ("elements", 1)])
def test_faces_without_a_convention_are_taken_by_their_name(name: str, first: int) -> None:
    x, y, triangles = ring()
    ds = xr.Dataset(
        {
            "u": ("node", -y, {"units": "m/s"}),
            "v": ("node", x, {"units": "m/s"}),
            "x": ("node", x, {"units": "m"}),
            "y": ("node", y, {"units": "m"}),
            name: (("cell", "corner"), (triangles + first).astype(np.int32)),
        }
    )
    field = FlowField.from_xarray(ds)
    assert field.triangles is not None
    assert {*map(frozenset, field.triangles.tolist())} == {*map(frozenset, triangles.tolist())}
    np.testing.assert_allclose(field.points[0, :, :2], np.column_stack([x, y]))
    np.testing.assert_allclose(field.velocity[0, 0, :, :2], np.column_stack([-y, x]))


@needs_data
def test_faces_of_a_real_ring_leave_its_hole() -> None:
    ds = xr.open_dataset(FORMS / "tri_ring.nc")
    field = FlowField.from_file(FORMS / "tri_ring.nc")
    assert field.triangles is not None and len(field.triangles) == ds.sizes["nele"] == 360
