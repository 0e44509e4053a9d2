"""Tripolar grids of MOM6 and NEMO: right at every node, and across the fold."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
from llc_grid import AXIS, rotation, turning, unit
from tripolar_grid import CAP, COLUMNS, POLE, ROWS, mom6, nemo

from flowtex import FlowField
from flowtex._util.array_types import Bools, Floats
from flowtex.trace.trace import trace

GRIDS: dict[str, Any] = {
    "MOM6": lambda: mom6(symmetric=False, nominal=True),
    "MOM6, symmetric": lambda: mom6(symmetric=True, nominal=True),
    "MOM6 without axes": lambda: mom6(symmetric=False, nominal=False),
    "NEMO without halo": lambda: nemo("F", "own", halo=False),
}
for pivot in "TF":
    for kind in ("own", "mesh mask", "one dataset"):
        GRIDS[f"NEMO, {pivot}, {kind}"] = lambda p=pivot, k=kind: nemo(p, k)
MAPS: tuple[dict[str, Any], ...] = ({"globe": True}, {"projection": "north"}, {})
#: Degrees around the two poles of the cap, where cells are needles, that are not compared.
AROUND = 12.0
#: Error of means of two sides as a share of the greatest speed.
AVERAGED = 0.015


def read(data: Any, options: dict[str, Any]) -> FlowField:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return FlowField.from_xarray(data, **options)


def places(field: FlowField) -> tuple[Floats, Floats]:
    assert field.projection is not None
    return field.projection.lonlat(field.points.reshape(-1, 3))


def away_from_poles(p: Floats) -> Bools:
    poles = unit(np.array([POLE, POLE + 180]), CAP)
    return np.asarray((p @ poles.T).max(axis=-1) < np.cos(np.radians(AROUND)))


@pytest.mark.parametrize("options", MAPS, ids=["globe", "north", "default"])
@pytest.mark.parametrize("name", GRIDS)
def test_rotation_is_right_at_every_node(name: str, options: dict[str, Any]) -> None:
    field = read(GRIDS[name](), options)
    assert field.projection is not None
    lon, lat = places(field)
    east, north = field.projection.components(
        lon, lat, np.asarray(field.velocity[0]).reshape(-1, 3)
    )
    u, v = turning(lon, lat)
    error = np.hypot(east - u, north - v) / np.linalg.norm(AXIS)
    used = field.valid.ravel() & away_from_poles(unit(lon, lat))
    assert error[used].max() < AVERAGED
    if options.get("globe"):
        assert used.sum() > 0.85 * COLUMNS * ROWS


def test_fold_of_a_grid_that_is_too_large_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.sources.tripolar.MOST_FOLDED", 40 * COLUMNS)
    ds = mom6(symmetric=False, nominal=False)
    field = read(ds, {"globe": True})
    assert field.triangles is None
    text = str(field.reading)
    assert "the fold along the last row is not joined" in text
    assert "ds.isel(yh=slice(-40, None))" in text
    part = ds.isel(yh=slice(-40, None), yq=slice(-40, None))
    assert read(part, {"globe": True}).triangles is not None


@pytest.mark.parametrize("options", MAPS[:2], ids=["globe", "north"])
@pytest.mark.parametrize("name", ["MOM6", "NEMO, T, own", "NEMO, F, mesh mask"])
def test_streaks_cross_the_fold(name: str, options: dict[str, Any]) -> None:
    field = read(GRIDS[name](), options)
    assert field.projection is not None
    lon, lat = places(field)
    start = unit(lon, lat)
    turn = 0.3
    lag = turn * 6_371_000.0 / float(np.linalg.norm(AXIS))
    slices = trace(field, lags=[1.0], unit=lag, parameter="time", tolerance=1e-6)
    assert slices.displacement is not None
    moved = np.asarray(slices.displacement)[0, 0].reshape(len(start), 3)
    found = unit(*field.projection.lonlat(field.points.reshape(-1, 3) + moved))
    axis = np.array(AXIS) / np.linalg.norm(AXIS)
    along = (start @ axis)[:, None] * axis
    side = np.cross(axis, start)
    expected = np.cos(turn) * (start - along) - np.sin(turn) * side + along
    arctic = (lat > 72) & field.valid.ravel()
    arctic &= away_from_poles(start) & away_from_poles(expected)
    assert arctic.sum() > 500
    assert np.linalg.norm(found - expected, axis=-1)[arctic].max() < 1e-3


def test_no_cell_is_missing_at_the_fold() -> None:
    """Triangles cover the globe from the first row to the poles."""
    field = read(GRIDS["MOM6"](), {"globe": True})
    assert field.triangles is not None
    p = field.points.reshape(-1, 3)[field.triangles] / 6_371_000.0
    sides = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    area = np.linalg.norm(sides, axis=-1).sum() / 2
    _, lat = places(field)
    expected = 2 * np.pi * (1 - np.sin(np.radians(lat.min())))
    assert area == pytest.approx(expected, rel=2e-3)
    assert (np.einsum("nk,nk->n", sides, p[:, 0]) > 0).mean() > 0.99
    assert np.abs(rotation(p[:, 0])).max() > 1
