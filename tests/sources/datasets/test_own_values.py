"""Arrays beside a dataset have the order of its axes, whatever order these are read in."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from flowtex import FieldError, FlowField
from flowtex._util.array_types import Floats
from flowtex.scene.fields import DATA, read_field
from flowtex.scene.options import Options

NORTHWARD = np.arange(20.0, 61.0, 4.0)
EASTWARD = np.arange(0.0, 41.0, 4.0)  # as many as rows, so that shapes do not tell them apart


def winds(lon: Floats, lat: Floats, *dims: str) -> xr.Dataset:
    """Return winds with a variable ``place``, longitude and a thousandth of latitude."""
    east, north = np.meshgrid(lon, lat)
    on = ("lat", "lon")
    ds = xr.Dataset(
        {
            "u": (on, 2 + np.cos(np.radians(north)), {"standard_name": "eastward_wind"}),
            "v": (on, np.sin(np.radians(east)), {"standard_name": "northward_wind"}),
            "place": (on, east + north / 1000),
        },
        {
            "lon": ("lon", lon, {"units": "degrees_east"}),
            "lat": ("lat", lat, {"units": "degrees_north"}),
        },
    )
    ds.u.attrs["units"] = ds.v.attrs["units"] = "m s-1"
    return ds.transpose(*dims)


def off(field: FlowField, name: str) -> float:
    """Return how far a scalar is from the place of its node, in degrees."""
    assert field.projection is not None
    lon, lat = field.projection.lonlat(field.surface.points)
    values = np.asarray(field.scalars[name])[0]
    away = (values - lat / 1000 - lon + 180) % 360 - 180
    return float(np.abs(away).max())


FORMS = {
    "in order": winds(EASTWARD, NORTHWARD, "lat", "lon"),
    "from the north": winds(EASTWARD, NORTHWARD[::-1], "lat", "lon"),
    "from the east": winds(EASTWARD[::-1], NORTHWARD, "lat", "lon"),
    "columns first": winds(EASTWARD, NORTHWARD, "lon", "lat"),
    "around the Earth": winds(np.arange(0.0, 360.0, 20.0), NORTHWARD, "lat", "lon"),
    "across 180 degrees": winds((EASTWARD + 340) % 360 - 180, NORTHWARD, "lat", "lon"),
}


@pytest.mark.parametrize("form", FORMS)
def test_colours_from_an_array_lie_at_their_nodes(form: str) -> None:
    ds = FORMS[form]
    options = Options.split(scalars=ds.place.values).field
    assert off(read_field(ds.drop_vars("place"), options), DATA) < 1e-6


@pytest.mark.parametrize("form", FORMS)
def test_uncertainty_from_an_array_lies_at_its_nodes(form: str) -> None:
    ds = FORMS[form]
    share = np.abs(ds.place.values) / 1000
    field = FlowField.from_xarray(ds.drop_vars("place"), uncertainty=share)
    named = FlowField.from_xarray(ds.assign(share=(ds.place.dims, share)), uncertainty="share")
    assert field.uncertainty == "uncertainty"
    given = np.asarray(field.scalars["uncertainty"])
    np.testing.assert_allclose(given, np.asarray(named.scalars["share"]))


def test_colours_of_a_table_follow_its_rows() -> None:
    frame = FORMS["in order"].to_dataframe().reset_index()
    names = {"u": "u [m/s]", "v": "v [m/s]"}
    table = frame.rename(columns=names).sample(frac=1, random_state=2)
    options = Options.split(scalars=table.place.to_numpy()).field
    assert off(read_field(table.drop(columns="place"), options), DATA) < 1e-6


def test_colours_follow_the_steps_of_a_series() -> None:
    ds = FORMS["from the north"]
    series = xr.concat([ds, ds], pd.date_range("2024-01-01", periods=2, name="time"))
    values = series.place.values + np.array([0.0, 5.0])[:, None, None]
    options = Options.split(scalars=values).field
    field = read_field(series.drop_vars("place"), options)
    steps = np.asarray(field.scalars[DATA])
    assert off(field, DATA) < 1e-6
    np.testing.assert_allclose(steps[1] - steps[0], 5.0)


def test_array_with_exchanged_axes_raises() -> None:
    x, y = np.arange(6.0), np.arange(4.0)
    field = FlowField.from_arrays((x, y), np.ones((4, 6, 2)))
    options = Options.split(scalars=np.zeros((6, 4))).field
    with pytest.raises(FieldError, match=r"scalars is \(6, 4\); expected .* shape \(4, 6\)"):
        read_field(field, options)


def test_array_beside_a_file_of_a_model_raises(tmp_path: Any) -> None:
    path = tmp_path / "wind.nc"
    FORMS["from the north"].to_netcdf(path)
    options = Options.split(scalars=FORMS["from the north"].place.values).field
    with pytest.raises(FieldError, match=r"order of the axes of .*wind\.nc; open the file"):
        read_field(path, options)


def test_array_that_no_dataset_of_several_has_raises() -> None:
    ds = FORMS["in order"]
    options = Options.split(scalars=np.zeros((3, 3))).field
    with pytest.raises(FieldError, match=r"no dataset has 'u' with axes of these lengths"):
        read_field([ds[["u"]], ds[["v"]]], options)
