"""Fields from datasets, against velocities that are known exactly."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
import xarray as xr
from earth_data import RATE, c_grid, components, on_sphere, turning, winds

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.field.earth.projection import EARTH_RADIUS
from flowtex.sources.notices import DatasetNotice

LON, LAT = np.arange(-180.0, 180.0, 5.0), np.arange(-90.0, 90.1, 5.0)


def globe_error(field: FlowField, inside: Any = ...) -> float:
    """Greatest deviation of a field on a globe from the rigid rotation, in m/s."""
    points = field.points
    exact = turning(points / np.linalg.norm(points, axis=-1, keepdims=True))
    return float(np.abs(np.asarray(field.velocity)[0] - exact)[inside].max())


def test_a_globe_has_the_velocities_of_the_earth() -> None:
    field = FlowField.from_xarray(winds(LON, LAT), globe=True)
    assert field.periodic == (False, True)
    assert field.length_unit == "m" and field.unit_of("speed") == "m/s"
    assert np.allclose(np.linalg.norm(field.points, axis=-1), EARTH_RADIUS)
    assert globe_error(field) < 1e-9
    assert field.speed.max() == pytest.approx(RATE, rel=1e-2)


@pytest.mark.parametrize("kind", ["nemo", "roms", "mitgcm", "comodo"])
@pytest.mark.parametrize("turn", [0.0, 40.0, 90.0, 200.0])
def test_a_staggered_grid_may_be_turned(kind: str, turn: float) -> None:
    """Components along the grid are means in the middle of the cells, to second order."""
    errors = []
    for count in (20, 40):
        with pytest.warns(DatasetNotice) if kind == "roms" else _silence():
            field = FlowField.from_xarray(c_grid(kind, turn, count), globe=True)
        assert field.valid.all()
        assert min(field.shape) >= count - 2
        # At an edge the direction of the grid is known to first order alone.
        errors.append(globe_error(field, np.s_[1:-1, 1:-1]))
        assert globe_error(field) < 1e-3 * RATE
    assert errors[0] < 1e-4 * RATE
    assert errors[1] < 0.3 * errors[0]


def test_what_a_long_name_calls_zonal_is_along_the_grid_on_sides_of_cells() -> None:
    ds = c_grid("comodo", 30.0)[0]
    for name, word in (("U", "Zonal"), ("V", "Meridional")):
        ds[name].attrs = {"long_name": f"{word} velocity", "units": "m s-1"}
    field = FlowField.from_xarray(ds, globe=True)
    assert globe_error(field, np.s_[1:-1, 1:-1]) < 1e-3 * RATE


@pytest.mark.parametrize(("south", "name"), [(70.0, "north"), (30.0, "platecarree")])
def test_a_region_around_a_pole_is_drawn_around_it(south: float, name: str) -> None:
    field = FlowField.from_xarray(winds(np.arange(0.0, 60.0, 2.0), np.arange(south, south + 20)))
    assert field.projection is not None and field.projection.family == name


def test_coordinates_of_another_model_do_not_count() -> None:
    zeros = (("y", "x"), np.zeros((3, 4)))
    nemo = xr.Dataset({"glamt": zeros, "gphit": zeros, "glamu": zeros})
    with pytest.warns(DatasetNotice):
        alone = FlowField.from_xarray(c_grid("roms"), globe=True)
    with pytest.warns(DatasetNotice):
        together = FlowField.from_xarray([nemo, *c_grid("roms")], globe=True)
    np.testing.assert_array_equal(together.points, alone.points)


def test_a_flat_map_has_the_paths_of_particles() -> None:
    """A particle that moves on the Earth moves along its place on the map."""
    lon, lat = np.linspace(20.0, 40.0, 21), np.linspace(30.0, 60.0, 31)
    for projection in ("platecarree", "mercator", "lambert", "EPSG:3413", "north"):
        field = FlowField.from_xarray(winds(lon, lat), projection=projection)
        assert field.projection is not None
        a, b = field.projection.lonlat(field.points)
        later = on_sphere(a, b) + turning(on_sphere(a, b)) / EARTH_RADIUS
        x, y, z = np.moveaxis(later, -1, 0)
        moved = field.projection.positions(
            np.degrees(np.arctan2(y, x)), np.degrees(np.arctan2(z, np.hypot(x, y)))
        )
        difference = np.abs(moved - field.points - field.velocity[0])[field.valid]
        assert difference.max() < 1e-2 * RATE, projection
        # Colours are of the speed on the Earth, whatever the map does to lengths.
        true = np.hypot(*components(a, b))
        assert np.allclose(np.asarray(field.scalars["speed"])[0], true, atol=1e-6)


def test_all_times_are_there_and_read_when_they_are_shown() -> None:
    dask = pytest.importorskip("dask.array")
    read: list[int] = []

    def block(block_info: Any) -> Any:
        (step, *_), *_ = block_info[None]["array-location"]
        read.append(step)
        return np.full((1, 30, 40), step + 1.0)

    values = dask.map_blocks(block, chunks=((1,) * 9, 30, 40), dtype=float, meta=np.empty(()))
    times = np.datetime64("2000-01-01") + np.arange(9) * np.timedelta64(1, "D")
    lon, lat = np.linspace(0, 20, 40), np.linspace(0, 15, 30)
    ds = xr.Dataset(
        {n: (("time", "lat", "lon"), values, {"units": "cm/s"}) for n in ("uo", "vo")},
        {"time": times, "lon": lon, "lat": lat},
    )
    ds["temperature"] = ds.uo.rename("temperature")
    field = FlowField.from_xarray(ds, globe=True)
    assert set(field.scalars) == {"speed", "temperature"}
    assert len(field.times) == 9 and field.times[1] == 86400.0
    assert set(read) == {0}
    speed = field.at_step(4).speed
    assert set(read) == {0, 4}
    assert field.unit_of("speed") == "cm/s"
    assert speed.mean() == pytest.approx(5 * np.sqrt(2), rel=1e-6)
    assert str(field.start) == "2000-01-01 00:00:00"
    one = FlowField.from_xarray(ds, time="2000-01-03", globe=True)
    assert one.steady and str(one.start)[:10] == "2000-01-03"
    with pytest.raises(FieldError, match="time is '2001-01-01'; expected one of 2000-01-01"):
        FlowField.from_xarray(ds, time="2001-01-01")


def levels() -> Any:
    ds = winds(np.arange(0.0, 30.0), np.arange(40.0, 60.0))
    pressure = ("level", [200.0, 500.0, 850.0], {"units": "millibars"})
    return xr.concat([ds, 2 * ds, 3 * ds], "level", coords="minimal").assign_coords(level=pressure)


def test_the_level_nearest_the_surface_is_said() -> None:
    with pytest.warns(
        DatasetNotice, match="level is 850 millibars, the nearest to the surface of 3"
    ):
        field = FlowField.from_xarray(levels(), globe=True)
    assert np.allclose(
        field.velocity, 3 * FlowField.from_xarray(levels(), globe=True, isel={"level": 0}).velocity
    )
    runs = xr.concat([levels()] * 2, "run").assign_coords(run=["a", "b"])
    with pytest.raises(FieldError, match="run is 'c'; expected one of a, b"):
        FlowField.from_xarray(runs, sel={"run": "c"}, level=500)
    with pytest.raises(FieldError, match=r"level is 20; expected one of 200, 500, 850"):
        FlowField.from_xarray(levels(), level=20)
    with pytest.raises(FieldError, match="the axis 'lvel' does not exist"):
        FlowField.from_xarray(levels(), lvel=500)


def _nameless(ds: Any) -> Any:
    return xr.Dataset(
        {n: (ds.u.dims, ds[m].values) for n, m in (("a", "u"), ("b", "v"))}, ds.coords
    )


def _unplaced(ds: xr.Dataset) -> xr.Dataset:
    return ds.stack(cell=("lat", "lon"), create_index=False).drop_vars(["lat", "lon"])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda ds: ds.drop_vars("v"), "one component of a velocity, 'u'.*'northward_wind'"),
        (lambda ds: ds.drop_vars(["lon", "lat"]), "has no positions.*assign_coords"),
        (lambda ds: ds.assign_coords(lat=ds.lat * np.nan), "NaN everywhere"),
        (
            lambda ds: ds.assign_coords(lat=("lat", ds.lat.values * 3, ds.lat.attrs)),
            "expected degrees",
        ),
        (
            lambda ds: ds.assign_coords(lon=("lon", np.roll(ds.lon, 1) // 2, ds.lon.attrs)),
            "lon increases and decreases.*drop_duplicates",
        ),
        (_nameless, "Name the components, as in u="),
        (
            lambda ds: ds.assign(
                {n: (ds.u.dims, ds[n].values, {"units": "furlong"}) for n in "uv"}
            ),
            r"in a unit such as m/s; the variables are u \(furlong\), v",
        ),
        (_unplaced, "no variable has two axes; expected the two components"),
    ],
    ids=[
        "one component",
        "no coordinates",
        "NaN",
        "no degrees",
        "scrambled",
        "no names",
        "no unit of velocity",
        "one axis",
    ],
)
def test_what_cannot_be_told_is_one_error(change: Any, words: str) -> None:
    with pytest.raises(FieldError, match=words):
        FlowField.from_xarray(change(winds(np.arange(0.0, 30.0), np.arange(40.0, 60.0))))


def test_a_region_is_cut_from_the_dataset() -> None:
    ds = winds(np.arange(0.0, 30.0), np.arange(60.0, 40.0, -1.0))
    with pytest.raises(
        FieldError, match=r"'lon' is one of the surface's own axes, .*: data\.sel\(lon="
    ):
        FlowField.from_xarray(ds, sel={"lon": slice(5, 9)})
    with pytest.raises(FieldError, match=r"the axis may run the other way: slice\(high, low\)"):
        FlowField.from_xarray(ds.sel(lat=slice(45, 50)))


def test_several_pairs_are_asked_for_by_name() -> None:
    ds = winds(np.arange(0.0, 30.0), np.arange(40.0, 60.0))
    both = ds.assign(u2=ds.u, v2=ds.v).rename(u2="u100", v2="v100")
    for name, (a, b) in {"eastward": ("u", "u100"), "northward": ("v", "v100")}.items():
        both[a].attrs["standard_name"] = f"{name}_wind_at_10m"
        both[b].attrs["standard_name"] = f"{name}_wind_at_100m"
    with pytest.raises(FieldError, match=r"several pairs.*u, v.*u100, v100.*u=\"u\", v=\"v\""):
        FlowField.from_xarray(both)
    assert FlowField.from_xarray(both, "u100", "v100").steady


def _silence() -> Any:
    from contextlib import nullcontext

    return nullcontext()


@pytest.mark.parametrize("fill", [-999.0, np.nan])
def test_gaps_of_late_lazy_steps_are_told_when_they_are_read(fill: float) -> None:
    pytest.importorskip("dask")
    lon, lat = np.arange(0.0, 12), np.arange(30.0, 41)
    u = np.ones((4, 11, 12))
    u[2, 5:, 6:] = fill
    dims = ("time", "lat", "lon")
    ds = xr.Dataset(
        {"u": (dims, u, {"units": "m/s"}), "v": (dims, u, {"units": "m/s"})},
        {"lon": lon, "lat": lat, "time": np.arange(4)},
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error", DatasetNotice)
        warnings.filterwarnings("ignore", "times have no unit")
        field = FlowField.from_xarray(ds.chunk(time=1))
    with pytest.warns(DatasetNotice) as caught:
        assert np.nanmax(np.abs(field.velocity[2])) < 2
    texts = [str(notice.message) for notice in caught]
    if fill == -999:
        assert "27% of u masked at step 2: -999" in texts[0] and "of v masked" in texts[1]
    assert texts[-1].startswith("36 of 132 nodes lack data at some times, such as step 2")
    with warnings.catch_warnings():  # it is told once
        warnings.simplefilter("error", DatasetNotice)
        assert np.isfinite(field.velocity[3]).all()
