"""One data set gives one field, however it comes: paths, datasets, trees; units by any name."""

from __future__ import annotations

import ast
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from earth_data import winds

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.sources.notices import DatasetNotice
from flowtex.sources.open_source import open_source

pytest.importorskip("netCDF4")


def days(count: int, **attributes: str) -> list[xr.Dataset]:
    """Winds that grow day by day, in datasets of a day, whose times are numbers."""
    one = winds(np.arange(0.0, 50, 5), np.arange(0.0, 40, 5))
    return [
        (one * (1.0 + day))
        .map(lambda array: array.assign_attrs(one[array.name].attrs))
        .expand_dims("time")
        .assign_coords(time=("time", [float(day)], attributes))
        for day in range(count)
    ]


def same(one: FlowField, other: FlowField) -> bool:
    parts = ((f.points, np.asarray(f.velocity), f.times) for f in (one, other))
    return one.start == other.start and all(
        np.array_equal(a, b) for a, b in zip(*parts, strict=True)
    )


def test_paths_datasets_and_what_xarray_joined_are_the_same(tmp_path: Path) -> None:
    steps = days(3, Unit="days since 2001-02-27")
    paths = [tmp_path / f"flow_{n}.nc" for n in range(3)]
    for ds, path in zip(steps, paths, strict=True):
        ds.to_netcdf(path)
    field = FlowField.from_file(paths)
    assert len(field.times) == 3 and f"{field.start:%Y-%m-%d}" == "2001-02-27"
    for data in (steps, steps[::-1], xr.concat(steps, "time")):
        assert same(field, FlowField.from_xarray(data))
    with xr.open_mfdataset(paths) as opened:
        assert same(field, FlowField.from_xarray(opened))
    assert all("Unit" in ds.time.attrs and "units" not in ds.time.attrs for ds in steps)


@pytest.mark.parametrize("key", ["Unit", "Units", "unit", "UNITS"])
def test_a_unit_is_read_by_any_name(key: str) -> None:
    ds = winds(np.arange(0.0, 50, 5), np.arange(0.0, 40, 5))
    slow = ds.copy(deep=True)
    for name in "uv":
        slow[name].attrs = {"standard_name": ds[name].attrs["standard_name"], key: "cm/s"}
    slow_field, fast_field = (FlowField.from_xarray(d) for d in (slow, ds))
    low, high = slow_field.speed.max(), fast_field.speed.max()
    assert slow_field.velocity.max() == pytest.approx(fast_field.velocity.max() / 100)
    assert low == pytest.approx(high) and slow_field.unit_of("speed") == "cm/s"


def test_steps_are_joined_on_the_positions_that_all_have() -> None:
    one, other = days(2, units="days since 2001-01-01")
    with pytest.warns(DatasetNotice, match="lon: 9 values that all steps have in common"):
        field = FlowField.from_xarray([one, other.isel(lon=slice(1, None))])
    assert len(field.times) == 2 and field.shape == (8, 9)
    turned = [one, other.isel(lat=slice(None, None, -1))]
    assert same(FlowField.from_xarray([one, other]), FlowField.from_xarray(turned))


def test_groups_are_chosen_by_path(tmp_path: Path) -> None:
    ds = winds(np.arange(0.0, 50, 5), np.arange(0.0, 40, 5))
    places = ds.drop_vars(["u", "v"])
    parts = {"/": places, "/ocean/top": ds[["u", "v"]].drop_vars(["lon", "lat"])}
    tree, path = xr.DataTree.from_dict(parts), tmp_path / "model.nc"
    tree.to_netcdf(path)
    whole = FlowField.from_xarray(ds)
    found: Any = [tree, tree["ocean"], tree["ocean/top"]]
    assert all(same(whole, FlowField.from_xarray(one)) for one in found)
    assert all(
        same(whole, FlowField.from_file(p)) for p in (path, path / "ocean", f"{path}/ocean/top")
    )
    assert same(whole, open_source(path / "ocean").field())
    with pytest.raises(FieldError, match=r"model.nc.*group 'air' does not exist; expected /ocean"):
        FlowField.from_file(path / "air")
    tree["air"] = tree["ocean/top"]
    with pytest.raises(FieldError, match=r"the groups /air, /ocean/top have a velocity; give one"):
        FlowField.from_xarray(tree)
    path = tmp_path / "two.nc"
    tree.to_netcdf(path)
    with pytest.raises(FieldError, match="give one, as in ") as caught:
        FlowField.from_file(path)
    given = str(caught.value).rpartition(" as in ")[2]  # what it names can be opened
    assert same(whole, FlowField.from_file(ast.literal_eval(given)))


@pytest.mark.parametrize("globe", [True, False])
@pytest.mark.parametrize("has_gaps", [True, False])
def test_own_speed_with_gaps_does_not_hide_the_velocity(*, globe: bool, has_gaps: bool) -> None:
    pytest.importorskip("dask")
    ds = winds(np.arange(0.0, 50, 5), np.arange(0.0, 40, 5))
    growth = xr.DataArray(np.arange(1.0, 10), dims="time", coords={"time": np.arange(9)})
    ds = ds.assign({name: (ds[name] * growth).assign_attrs(ds[name].attrs) for name in "uv"})
    is_late = ds.time > ds.time[0]
    ds["speed"] = np.hypot(ds.u, ds.v).where(~(is_late & (ds.lon > ds.lon[4])))
    hole = (ds.time == ds.time[3]) & (ds.lat > ds.lat[-3])
    if has_gaps:
        for name in "uv":
            ds[name] = ds[name].where(~hole).assign_attrs(ds[name].attrs)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        field = FlowField.from_xarray(ds.chunk(time=1), globe=globe)
        known = [field.known_nodes(step, step) for step in range(9)]
    for step, here in enumerate(known):
        lacking = field.valid & ~here
        assert lacking.any() == (has_gaps and step == 3)
        assert lacking.sum() in (0, 2 * ds.sizes["lon"])
