"""Files of other programs: what a user can do with them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import flowtex
from flowtex import FieldError, FlowField
from flowtex.sources.datasets import is_dataset
from flowtex.sources.reader_errors import errors_of_file


class LibraryError(Exception):
    """An error of a reader that has no class in common with others."""


LibraryError.__module__ = "some_reader.errors"


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("wing.sim", r"STAR-CCM\+.*EnSight Gold.*flowtex\.show\(\"flow\.case\"\)"),
        ("wing.ccm", r"STAR-CCM\+.*EnSight Gold"),
        ("wing.mph", r"COMSOL.*file type VTK.*flowtex\.show\(\"flow\.vtu\"\)"),
        ("wing.plt", r"Tecplot.*ParaView.*flowtex\.show\(\"flow\.vtm\"\)"),
        ("wing.szplt", r"Tecplot.*ParaView"),
    ],
)
def test_file_of_another_program_names_the_way(name: str, expected: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(b"\x01\x02\x03")
    with pytest.raises(FieldError, match=expected):
        FlowField.from_file(tmp_path / name)


def test_arrays_of_hdf5_are_named_with_their_positions(tmp_path: Path) -> None:
    """As of cutouts of the Johns Hopkins turbulence database."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "cutout.h5", "w") as file:
        file["Velocity_0001"] = np.zeros((2, 3, 4, 3))
        file["xcoor"] = np.zeros(4)
    expected = r'Velocity_0001 \(2 x 3 x 4 x 3\), xcoor \(4\)\..*such as file\["Velocity_0001"\]'
    with pytest.raises(FieldError, match=expected):
        FlowField.from_file(tmp_path / "cutout.h5")


@pytest.mark.parametrize(
    ("error", "expected"),
    [
        (AssertionError(), r"its content is invalid \(AssertionError\); write or copy it again"),
        (LibraryError("no header"), "flow.abc: cannot be read: no header"),
    ],
)
def test_error_of_a_reader_names_the_file(error: Exception, expected: str) -> None:
    with pytest.raises(FieldError, match=expected), errors_of_file("flow.abc"):
        raise error


class OwnError(Exception):
    """An error of the code, not of a file."""


OwnError.__module__ = "flowtex.sources.example"


def test_error_of_the_code_stays() -> None:
    with pytest.raises(OwnError), errors_of_file("flow.abc"):
        raise OwnError


def test_objects_of_other_libraries_name_what_to_pass(tmp_path: Path) -> None:
    netcdf = pytest.importorskip("netCDF4")
    polars = pytest.importorskip("polars")
    with netcdf.Dataset(tmp_path / "flow.nc", "w") as data:
        expected = r"Dataset of netCDF4; pass xarray.open_dataset\(data.filepath\(\)\)"
        with pytest.raises(FieldError, match=expected):
            flowtex.render(data)
    with pytest.raises(FieldError, match=r"LazyFrame of polars; pass data.collect\(\)"):
        flowtex.render(polars.LazyFrame({"x": [0.0]}))


def test_subclasses_of_datasets_are_datasets() -> None:
    """Such as those of uxarray."""
    xarray = pytest.importorskip("xarray")

    own = type("Own", (xarray.Dataset,), {"__slots__": ()})
    u, v = np.mgrid[:3.0, :4.0]
    variables = {"u": (("y", "x"), u), "v": (("y", "x"), v)}
    data = own(variables, {"x": np.arange(4.0), "y": np.arange(3.0)})
    assert is_dataset(data)
    assert np.array_equal(FlowField.from_xarray(data).velocity[0][..., 0], u)
