"""Data of the Earth as ocean and weather models write them, computed and not observed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.extras import import_extra
from flowtex.examples._shipped import OCEAN, WEATHER, shipped
from flowtex.field.earth import EARTH_RADIUS

if TYPE_CHECKING:
    import xarray as xr

#: Earth's turning in radians a second, gravity in m/s², metres of a degree.
TURNING, GRAVITY, DEGREE = 7.2921e-5, 9.81, np.radians(EARTH_RADIUS)


def ocean() -> xr.Dataset:
    """Return eight days of synthetic currents in the Northwest Atlantic.

    A meandering Gulf Stream leaves the coast at Cape Hatteras; rings and smaller eddies move west,
    like Rossby waves, by about 4 km a day.

    Returns
    -------
    xarray.Dataset
        ``uo`` and ``vo`` in m/s, eastward and northward, and ``zos``, the sea surface height in m,
        with which they are in geostrophic balance; (time, latitude, longitude) = (8, 109, 217), NaN
        on land.

    Raises
    ------
    ModuleNotFoundError
        When xarray is missing.

    Examples
    --------
    >>> flowtex.render(flowtex.examples.ocean(), cmap="viridis")  # doctest: +SKIP
    """
    ds = _read(OCEAN)
    lat = np.radians(ds.latitude)
    turning = 2 * TURNING * np.sin(lat) * DEGREE / GRAVITY
    # The file has attributes of the currents, and the height on land too.
    u, v = -ds.zos.differentiate("latitude"), ds.zos.differentiate("longitude") / np.cos(lat)
    for name, current in (("uo", u), ("vo", v)):
        ds[name] = ds.zos.dims, (current / turning).values, ds[name].attrs
    sea: xr.Dataset = ds[["uo", "vo", "zos"]].where(ds.land == 0)
    return sea


def weather() -> xr.Dataset:
    """Return synthetic global winds at three levels: jets, planetary waves, lows and highs.

    Returns
    -------
    xarray.Dataset
        ``u`` and ``v`` in m/s, eastward and northward, (level, latitude, longitude) =
        (3, 91, 180), at 850, 500 and 250 hPa. They are free of divergence, and smooth across the
        date line and the poles.

    Raises
    ------
    ModuleNotFoundError
        When xarray is missing.

    Examples
    --------
    >>> flowtex.render(flowtex.examples.weather(), level=250, globe=True)  # doctest: +SKIP
    """
    return _read(WEATHER)


def _read(name: str) -> xr.Dataset:
    xarray = import_extra("xarray", "xarray")
    # Plain numbers, so that a copy that a user writes is as exact.
    ds: xr.Dataset = xarray.load_dataset(shipped(name), engine="scipy").drop_encoding()
    return ds
