"""LLC tiles with components on the sides of cells are one surface, which streaks cross."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from llc_grid import AXIS, CAP, llc, rotation, turning, unit

from flowtex import FlowField
from flowtex._util.array_types import Bools, Floats
from flowtex.errors import FieldError
from flowtex.trace.trace import trace

N = 12
#: Degrees from the corners of the cap, where a conformal map turns by a finite angle.
CORNER = 9.0
#: Error of means of two sides as a share of the greatest speed.
AVERAGED = 0.02


def read(data: Any, **options: Any) -> FlowField:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return FlowField.from_xarray(data, **{"globe": True, **options})


def nodes(field: FlowField) -> Floats:
    p = field.points.reshape(-1, 3)
    return np.asarray(p / np.linalg.norm(p, axis=-1, keepdims=True))


def away_from_corners(p: Floats) -> Bools:
    corners = unit(np.array([-135.0, -45.0, 45.0, 135.0]), CAP)
    return np.asarray((p @ corners.T).max(axis=-1) < np.cos(np.radians(CORNER)))


def check(field: FlowField, scale: float = 1.0, step: int = 0, unknown: int = 2 * N) -> None:
    """Compare the velocity at each node with that of the rotation."""
    p = nodes(field)
    known = field.valid.ravel()
    wrong = np.asarray(field.velocity[step]).reshape(-1, 3) - scale * rotation(p)
    error = np.linalg.norm(wrong, axis=-1) / np.linalg.norm(AXIS) / scale
    # By default the southern ends of two turned tiles are unknown.
    assert known.sum() == 13 * N * N - unknown
    assert error[known & away_from_corners(p)].max() < AVERAGED
    assert np.median(error[known]) < AVERAGED / 4


@pytest.mark.parametrize("angles", [True, False])
@pytest.mark.parametrize("face", ["face", "tile"])
def test_components_on_sides_are_turned_at_every_node(*, angles: bool, face: str) -> None:
    field = read(llc(N, angles=angles, face=face))
    check(field)
    source = "CS and SN" if angles else "XC and YC"
    assert f"turned to east and north by {source}" in str(field.reading)


@pytest.mark.parametrize("angles", [True, False])
@pytest.mark.parametrize(
    ("sides", "unknown"),
    [
        (("eastern", "northern"), 2 * N),  # the southern ends of two tiles that are not turned
        # Where rows of one tile go on as columns of another one, none has the sides between.
        (("eastern", "southern"), 10 * N - 3),
        (("western", "northern"), 10 * N - 2),
    ],
)
def test_components_on_any_sides(*, sides: tuple[str, str], unknown: int, angles: bool) -> None:
    check(read(llc(N, angles=angles, sides=sides)), unknown=unknown)


def test_sides_of_a_conformal_grid_are_exact_with_angles() -> None:
    errors = []
    for n in (12, 24):
        field = read(llc(n, angles=True))
        p = nodes(field)
        wrong = np.asarray(field.velocity[0]).reshape(-1, 3) - rotation(p)
        errors.append(np.linalg.norm(wrong, axis=-1)[field.valid.ravel() & away_from_corners(p)])
    assert np.quantile(errors[1], 0.9) < 0.3 * np.quantile(errors[0], 0.9)


def test_files_of_a_model_and_of_its_grid(tmp_path: Path) -> None:
    """Components in files of their own, with levels and times, and the grid in another one."""
    ds = llc(N)
    growth = xr.DataArray([1.0, 2.0], {"time": np.array(["2000", "2001"], "M8[ns]")}, ("time",))
    depth = xr.DataArray([1.0, 0.5], {"k": ("k", [0, 1])}, ("k",))
    paths = []
    for name, long_name in (("U", "UVEL"), ("V", "VVEL")):
        array = (growth * depth * ds[name]).assign_attrs(units="m s-1")
        path = tmp_path / f"{long_name}.nc"
        array.rename(long_name).to_dataset().drop_vars(["XC", "YC"], errors="ignore").to_netcdf(
            path
        )
        paths.append(path)
    ds.drop_vars(["U", "V"]).to_netcdf(tmp_path / "GRID.nc")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        field = FlowField.from_file([*paths, tmp_path / "GRID.nc"], globe=True)
    check(field)
    check(field, 2.0, step=1)


def test_land_at_rest_and_without_values_is_left_out() -> None:
    ds = llc(N)
    for value in (0.0, np.nan):
        changed = ds.copy(deep=True)
        changed.U[1, 3:6, 3:7] = value
        changed.V[1, 3:7, 3:6] = value
        field = read(changed)
        lost = read(ds).valid & ~field.valid
        assert lost.sum() == 9


def test_centred_components_are_turned_if_the_user_says_so() -> None:
    ds = llc(N, angles=True)
    east, north = turning(ds.XC.values, ds.YC.values)
    dims = ("face", "j", "i")
    unit_of = {"units": "m s-1"}
    cos, sin = ds.CS.values, ds.SN.values
    ds["U"] = dims, east * cos + north * sin, unit_of
    ds["V"] = dims, north * cos - east * sin, unit_of
    with pytest.raises(FieldError, match="components='grid' turns them"):
        read(ds)
    field = read(ds, components="grid")
    wrong = np.asarray(field.velocity[0]).reshape(-1, 3) - rotation(nodes(field))
    assert field.valid.all() and np.abs(wrong).max() < 1e-6 * np.linalg.norm(AXIS)


def test_streaks_cross_the_borders_of_tiles() -> None:
    """Paths lie on circles around the axis, through tiles that are turned."""
    field = read(llc(24, angles=True))
    axis = np.array(AXIS) / np.linalg.norm(AXIS)
    p = field.points.reshape(-1, 3)
    turn = 0.5  # radians
    lag = turn * np.linalg.norm(p[0]) / np.linalg.norm(AXIS)
    slices = trace(field, lags=[1.0], unit=lag, parameter="time", tolerance=1e-6)
    assert slices.displacement is not None
    moved = np.asarray(slices.displacement)[0, 0, 0]
    sphere = p / np.linalg.norm(p, axis=-1, keepdims=True)
    radius = np.linalg.norm(p[0])
    cos, sin = np.cos(-turn), np.sin(-turn)
    along = (sphere @ axis)[:, None] * axis
    expected = cos * (sphere - along) + sin * np.cross(axis, sphere) + along
    found = sphere + moved / radius
    known = np.isfinite(moved).all(axis=-1) & field.valid.ravel()
    distance = np.linalg.norm(found - expected, axis=-1)[known & away_from_corners(sphere)]
    assert known.mean() > 0.85
    assert np.quantile(distance, 0.95) < 0.02 and np.median(distance) < 0.004


def test_one_tile_is_drawn_as_a_grid() -> None:
    field = read(llc(N), isel={"face": 1})
    assert field.triangles is None
    p = nodes(field)
    wrong = np.asarray(field.velocity[0]).reshape(-1, 3) - rotation(p)
    error = np.linalg.norm(wrong, axis=-1)[field.valid.ravel()] / np.linalg.norm(AXIS)
    assert error.max() < AVERAGED


def test_missing_positions_are_named() -> None:
    with pytest.raises(FieldError, match="positions of the centres, such as XC and YC"):
        read(llc(N).drop_vars(["XC", "YC"]))
