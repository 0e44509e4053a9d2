"""Data of the Earth on the page: maps, levels, and the link and lines of Python."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from earth_data import winds

from flowtex.app import Choice, Library
from flowtex.app.controllers.serialization import to_python
from flowtex.errors import FieldError


def levels() -> Any:
    ds = winds(np.arange(-180.0, 180.0, 20.0), np.arange(-80.0, 81.0, 20.0))
    pressure = ("level", [200.0, 500.0, 850.0], {"units": "hPa"})
    several = xr.concat([ds, 2 * ds, 3 * ds], "level", coords="minimal", join="exact")
    for name, word in (("u", "eastward"), ("v", "northward")):
        several[name].attrs = {"standard_name": f"{word}_wind", "units": "m/s"}
    return several.assign_coords(level=pressure, lon=ds.lon, lat=ds.lat)


def test_a_file_offers_maps_and_levels(tmp_path: Path) -> None:
    levels().to_netcdf(tmp_path / "winds.nc")
    library = Library.of(tmp_path)
    assert library.names == ("winds.nc",)
    source = library.source("winds.nc")
    assert source.vectors == ("u,v",) and source.planes == {"level": 3}
    assert source.blocks[:2] == ("platecarree", "globe") and "mercator" in source.blocks
    choice = library.complete("winds.nc", Choice())
    assert choice == Choice("u,v", "level=2", "platecarree")
    assert source.plane_text(choice.plane) == "850 hPa"
    flat = library.field("winds.nc", choice)
    assert flat.surface.frame is not None and flat.name == "winds, 850 hPa"
    globe = library.field("winds.nc", Choice("u,v", "level=0", "globe"))
    assert globe.projection is not None and globe.projection.is_globe
    whole = library.field("winds.nc", Choice("u,v", "level=1", "globe"))
    assert np.allclose(whole.velocity[0], 2 * globe.velocity[0])
    for wrong in (
        Choice("u,v", "level=7", "globe"),
        Choice("u,v", "", "mars"),
        Choice("a", "", ""),
    ):
        with pytest.raises(FieldError):
            library.field("winds.nc", wrong)


def test_the_lines_of_python_select_the_same_field(tmp_path: Path) -> None:
    path = tmp_path / "winds.nc"
    levels().to_netcdf(path)
    state = {"file": str(path), "vectors": "u,v", "plane": "level=1", "block": "globe"}
    text = to_python(state, size=(600, 400))
    assert 'projection="globe"' in text and "isel={'level': 1}" in text and "plane" not in text
