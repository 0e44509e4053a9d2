"""Files of data of the Earth, real ones where they are available."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from earth_data import east_and_north, winds
from lying_files import grib

from flowtex import FlowField
from flowtex.errors import FieldError, Notice
from flowtex.field.earth.projection import EARTH_RADIUS
from flowtex.sources.opening import dataset_files as files

pytestmark = [
    pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice"),
    pytest.mark.filterwarnings("ignore::xarray.SerializationWarning"),  # of a file itself
]

LON, LAT = np.arange(-180.0, 180.0, 10.0), np.arange(90.0, -90.1, -10.0)
DATA = Path(os.environ.get("FLOWTEX_DATA", ""))
needs_data = pytest.mark.skipif(
    not (DATA / "eraint_uvz.nc").is_file(), reason="FLOWTEX_DATA names no folder of real data"
)


def same(one: FlowField, other: FlowField) -> bool:
    pairs = ((one.points, other.points), (one.velocity[0], other.velocity[0]))
    return all(np.allclose(a, b, atol=1e-4) for a, b in pairs)


def wind_json(ds: Any) -> list[dict[str, Any]]:
    """The form of grib2json."""
    header = {"nx": ds.sizes["lon"], "ny": ds.sizes["lat"], "lo1": float(ds.lon[0])}
    header |= {"la1": float(ds.lat[0]), "la2": float(ds.lat[-1]), "dx": 10, "dy": 10}
    header |= {"refTime": "2016-04-30T06:00:00Z", "forecastTime": 6, "parameterUnit": "m.s-1"}
    return [
        {"header": {**header, "parameterNumber": n}, "data": ds[name].values.ravel().tolist()}
        for n, name in ((2, "u"), (3, "v"))
    ]


def test_netcdf_zarr_and_json_are_the_same_field(tmp_path: Path) -> None:
    ds = winds(LON, LAT)
    wanted = FlowField.from_xarray(ds, globe=True)
    ds.to_netcdf(tmp_path / "a.nc")
    paths = [tmp_path / "a.nc"]
    ds.to_zarr(tmp_path / "a.zarr", consolidated=False)
    paths.append(tmp_path / "a.zarr")
    (tmp_path / "a.json").write_text(json.dumps(wind_json(ds)))
    paths.append(tmp_path / "a.json")
    for path in paths:
        field = FlowField.from_file(path, globe=True)
        assert same(field, wanted), path
        assert field.name == "a"
    assert str(field.start) == "2016-04-30 12:00:00"


def test_files_that_are_not_drawn_are_told(tmp_path: Path) -> None:
    air, sea = winds(LON, LAT), winds(LON, LAT).rename(u="uo", v="vo")
    for name, along in (("uo", "eastward"), ("vo", "northward")):
        sea[name].attrs = {"units": "m/s", "standard_name": f"{along}_sea_water_velocity"}
    paths = [tmp_path / "air.nc", tmp_path / "sea.nc"]
    air.drop_attrs().to_netcdf(paths[0])
    sea.to_netcdf(paths[1])
    with pytest.warns(Notice, match=r"^uo and vo are drawn, and u and v of air\.nc are not; to"):
        FlowField.from_file(paths)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("{", "not valid JSON"),
        ("{}", "not a list of records"),
        ("[]", "record of the eastward component is missing"),
        ("[{}, 3]", "not a list of records"),
        (
            '[{"header": {"parameterNumber": 2, "nx": 3}, "data": []}]',
            "eastward component is damaged",
        ),
        (
            '[{"header": {"parameterNumber": 2, "nx": 1e99, "ny": 2}, "data": [1]}]',
            "the eastward component declares",
        ),
    ],
)
def test_json_of_another_form_is_refused(tmp_path: Path, content: str, words: str) -> None:
    path = tmp_path / "a.json"
    path.write_text(content)
    with pytest.raises(FieldError, match=words) as error:
        FlowField.from_file(path)
    assert str(error.value).startswith(str(path))


def reference(lon: Any, lat: Any, u: Any, v: Any) -> Any:
    """Velocities on the sphere by the definition of east and north alone."""
    east, north = east_and_north(*np.meshgrid(lon, lat))
    return u[..., None] * east + v[..., None] * north


@needs_data
@pytest.mark.parametrize("level", [200, 500, 850])
def test_era_interim_on_the_globe(level: int) -> None:
    field = FlowField.from_file(DATA / "eraint_uvz.nc", level=level, globe=True)
    with xr.open_dataset(DATA / "eraint_uvz.nc") as ds:
        one = ds.isel(month=0).sel(level=level)
        wanted = reference(one.longitude, one.latitude, one.u.values, one.v.values)
    assert np.allclose(field.velocity[0][1:-1, :480], wanted[1:-1], atol=1e-5)
    assert field.periodic == (False, True)
    assert len(list(field.surface.poles or ())) == 2
    assert set(field.scalars) == {"z"} and field.unit_of("z") == "m**2 s**-2"


@needs_data
def test_grib_winds_have_levels_that_both_components_have() -> None:
    try:
        files.import_cfgrib()
    except ModuleNotFoundError as missing:
        pytest.skip(str(missing))
    field = FlowField.from_file(DATA / "winds.grib", level=500, globe=True)
    assert len(field.times) == 2 and str(field.start) == "2017-10-18 18:00:00"
    with pytest.raises(FieldError, match="only one of the components has the level"):
        FlowField.from_file(DATA / "winds.grib", level=850)


def test_without_its_library_grib_names_the_remedy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "cfgrib.py").write_text('raise RuntimeError("Cannot find the ecCodes library")')
    (tmp_path / "a.grib").write_bytes(grib(2))
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "cfgrib", raising=False)
    with pytest.raises(FieldError, match=r"library ecCodes, which is missing .* conda-forge"):
        FlowField.from_file(tmp_path / "a.grib")


@needs_data
def test_nemo_in_three_files_and_in_two() -> None:
    names = ("U", "V", "coordinates")
    paths = [DATA / f"nemo_orca025_{name}.nc" for name in names]
    field = FlowField.from_file(paths, globe=True)
    with xr.open_dataset(paths[2], decode_times=False) as places:
        lon, lat = (places[n].values[0] for n in ("glamt", "gphit"))
    # What lies on the sides of cells, or belongs to the grid, is nothing to colour by.
    assert not field.scalars
    assert field.projection is not None
    a, b = field.projection.lonlat(field.points)
    ok = field.valid
    assert np.abs((a - lon[1:, 1:])[ok]).max() < 1e-6
    assert np.abs((b - lat[1:, 1:])[ok]).max() < 1e-6
    with xr.open_dataset(paths[0]) as u, xr.open_dataset(paths[1]) as v:
        u, v = np.nan_to_num(u.uo.values[0, 0]), np.nan_to_num(v.vo.values[0, 0])
    mean = (u[1:, :-1] + u[1:, 1:]) / 2, (v[:-1, 1:] + v[1:, 1:]) / 2
    speed = np.linalg.norm(field.velocity[0], axis=-1)
    # The grid has right angles but for a few hundredths.
    assert np.abs(speed - np.hypot(*mean))[ok].max() < 0.02 * np.hypot(*mean)[ok].max()
    other = FlowField.from_file(paths[:2], globe=True)
    distance = np.linalg.norm(other.points - field.points, axis=-1)[ok & other.valid]
    assert distance.max() < 1e-3 * EARTH_RADIUS * np.radians(0.25)
