"""The private part of xarray that flowtex uses is there, and is used in one module."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import flowtex
from flowtex._util.xarray_internals import held_array

xarray = pytest.importorskip("xarray")


def test_the_array_of_a_variable_is_what_it_holds() -> None:
    pint = pytest.importorskip("pint")
    speeds = np.ones(3) * pint.UnitRegistry().knot
    assert held_array(xarray.Variable("x", speeds)) is speeds


def test_a_file_is_not_read(tmp_path: Path) -> None:
    pytest.importorskip("netCDF4")
    path = tmp_path / "a.nc"
    xarray.Dataset({"u": ("x", np.ones(3))}).to_netcdf(path)
    with xarray.open_dataset(path) as opened:
        held = held_array(opened["u"].variable)
        assert held is not None
        assert not isinstance(held, np.ndarray)


def test_no_other_module_uses_it() -> None:
    package = Path(flowtex.__file__).parent
    users = []
    for path in package.rglob("*.py"):
        text = path.read_text()
        if "variable._data" in text or '"_data"' in text:
            users.append(path.name)
    assert users == ["xarray_internals.py"]
