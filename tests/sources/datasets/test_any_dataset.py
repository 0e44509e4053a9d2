"""Any small dataset is a field with finite numbers, or one error of ours."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from strategies import property_test

from flowtex import FlowField
from flowtex.errors import FieldError

pytestmark = pytest.mark.hypothesis


def mostly(*usual: Any, rare: tuple[Any, ...] = ()) -> Any:
    """Draw one of the usual values, and a rare one in one of twelve cases."""
    return st.sampled_from([*usual * max(11 * len(rare) // len(usual), 1), *rare])


NAMES = mostly(("u", "v"), ("uo", "vo"), ("U10", "V10"), rare=(("a", "b"), ("u", "w")))
WORDS = mostly("eastward_wind", "sea_water_x_velocity", "u velocity", rare=("", "zonal drift"))
UNITS = mostly("m/s", "cm s-1", rare=(None, "", "knots", "degrees", "m s**-1", "K", "µ"))
LINES = mostly(None, rare=("", "degrees_east", "degrees_north", "m", "km", "hours"))
KINDS = mostly("f8", rare=("f4", "i2", "c8", "O", "M8[ns]", "?"))
SCALES = mostly(1.0, 30.0, rare=(0.0, 1e-12, 1e12, np.nan, np.inf))
OWN_UNITS = {"lat": "degrees_north", "lon": "degrees_east", "x": "m", "y": "m", "time": "hours"}
PARTNERS = (("eastward", "northward"), ("_x_", "_y_"), ("u ", "v "), ("zonal", "meridional"))


@st.composite
def datasets(draw: Any) -> xr.Dataset:
    """Two variables on up to four axes, with coordinates of any kind or none."""
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return drawn(draw)


def drawn(draw: Any) -> xr.Dataset:
    """Return one of the datasets."""
    dims = draw(st.permutations(["lat", "lon"] if draw(st.integers(0, 4)) else ["x", "y"]))
    dims += draw(
        st.lists(st.sampled_from(["time", "level", "number", "z"]), max_size=2, unique=True)
    )
    dims = draw(st.permutations(dims))
    shape = [
        draw(st.sampled_from([3, 4, 5, 9, 12, 2, 1, 0][: 7 + (n == 0)])) for n in range(len(dims))
    ]
    seed = np.random.default_rng(draw(st.integers(0, 99)))
    word, unit = draw(WORDS), draw(UNITS)
    ds = xr.Dataset()
    for n, name in enumerate(draw(NAMES)):
        kind = draw(KINDS)
        values = seed.normal(size=shape) * draw(SCALES)
        values[seed.random(shape) < draw(mostly(0, 0.3, rare=(1,)))] = np.nan
        values = np.nan_to_num(values).astype(kind) if kind != "f8" else values
        text = word
        for one, other in PARTNERS:
            text = text.replace(one, other) if n else text
        attrs = {"standard_name": text} if "_" in text else {"long_name": text}
        ds[name] = tuple(dims), values, {**attrs, **({} if unit is None else {"units": unit})}
    for dim, count in zip(dims, shape, strict=True):
        if draw(st.booleans()) or dim in ("lat", "lon"):
            step, start = draw(SCALES), draw(mostly(0.0, -60.0, rare=(-180.0, 350.0, 89.0)))
            line = start + step * np.arange(count)
            if draw(st.integers(0, 5)) == 0:
                line = seed.permutation(line)
            ds = ds.assign_coords(
                {dim: (dim, line, {"units": draw(LINES) or OWN_UNITS.get(dim, "")})}
            )
    return ds


@property_test(75, fuzz=150)
@given(
    datasets(), st.sampled_from([None, "globe", "platecarree", "north", "robinson", "EPSG:3413"])
)
def test_a_dataset_is_a_field_or_one_error(ds: xr.Dataset, projection: str | None) -> None:
    with warnings.catch_warnings(), np.errstate(all="raise", under="ignore"):
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", UserWarning)  # what was chosen, and zero velocity
        warnings.simplefilter("ignore", xr.SerializationWarning)
        try:
            field = FlowField.from_xarray(ds, projection=projection)
            values = [np.asarray(field.velocity[0]), np.asarray(field.speed[0])]
        except FieldError as error:
            assert str(error)
            return
    assert all(np.isfinite(v).all() for v in values)
    assert np.isfinite(field.points[field.valid]).all()
