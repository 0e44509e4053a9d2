"""Files that lie are refused by name, before a value is read or memory is taken."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import lying_files as lies
import numpy as np
import pytest
import pyvista as pv

from flowtex import FlowField
from flowtex._util import memory
from flowtex.errors import FieldError
from flowtex.sources.inspection.inspect_file import inspect_file


def refused(path: Path) -> str:
    """Return why a file is refused by every way in."""
    from flowtex.sources.open_source import open_source

    with pytest.raises(FieldError) as caught:
        FlowField.from_file(path)
    with pytest.raises(FieldError) as again:
        open_source(path)
    assert str(caught.value).startswith(f"{path}: ")
    # The memory that is free changes meanwhile.
    first, second = (re.sub(r"[\d.]+ GB of", "", str(e.value)) for e in (caught, again))
    assert first == second
    return str(caught.value)


@pytest.mark.parametrize("suffix", [".nc", ".cgns"])
@pytest.mark.parametrize(
    ("write", "what"),
    [
        (lies.external_storage, "u has external storage"),
        (lies.external_link, "deep/link is an external link"),
        (lies.virtual_dataset, "u is a virtual dataset"),
    ],
)
def test_hdf5_that_leads_to_another_file_is_refused(
    tmp_path: Path, suffix: str, write: Callable[[Path, Path], None], what: str
) -> None:
    secret = tmp_path / "secret.txt"
    secret.write_bytes(b"the words of somebody else, " * 20)
    path = tmp_path / f"upload{suffix}"
    write(path, secret)
    assert f"{what} in the file '{secret}'" in refused(path)


def test_hdf5_behind_a_block_of_the_user_is_looked_into(tmp_path: Path) -> None:
    path = tmp_path / "plain.nc"
    lies.external_storage(path, tmp_path / "secret")
    behind = tmp_path / "behind.nc"
    behind.write_bytes(b"#" * 4096 + path.read_bytes())
    with pytest.raises(FieldError, match="external storage"):
        inspect_file(behind)


def test_a_virtual_dataset_of_the_file_itself_is_read(tmp_path: Path) -> None:
    import h5py

    with h5py.File(tmp_path / "own.h5", "w") as file:
        file["x"] = np.ones((3, 4))
        layout = h5py.VirtualLayout((3, 4), "f8")
        layout[:] = h5py.VirtualSource(file["x"])
        file.create_virtual_dataset("y", layout)
    inspect_file(tmp_path / "own.h5")


@pytest.mark.parametrize(
    ("name", "content", "what"),
    [
        ("bomb.vtu", lies.vtu(10**12), "declares 3,000,000,000,000 values"),
        ("cells.vtu", lies.vtu(3, 10**11), "the offsets of cells declares 100,000,000,000 nodes"),
        ("image.vti", lies.image("0 99999 0 99999 0 0"), "declares 30,000,000,000 values"),
        ("points.vtk", lies.legacy("DATASET POLYDATA\nPOINTS 100000000000 float"), "300,000,000"),
        (
            "cells.vtk",
            lies.legacy("DATASET POLYDATA\nPOINTS 1 float\n1 2 3\nPOLYGONS 1 2000000000"),
            "polygons declares 2,000,000,000 numbers, but the file has 3",
        ),
        ("winds.json", lies.winds(20_000, 20_000), "declares 400,000,000 numbers"),
        ("deep.json", b"[" * 200_000, "it is not valid JSON"),
        ("classic.nc", lies.netcdf_header(1, 2**31), "2,147,483,8"),
        ("wide.nc", lies.netcdf_header(5, 2**60), "declares 1,152,921,504,606,847,176 bytes"),
        ("constant.grib", lies.grib2(2**32 - 1), "the grid of message 1 declares 34.4 GB"),
        (
            "length.grib",
            lies.grib2(4)[:19] + b"\x16" + lies.grib2(4)[20:],
            "message 1 has section 0 where 2 or 3 was expected",
        ),
        ("sections.grib", lies.grib2(4), "the sections of message 1 do not match its length"),
        ("data.grib", lies.grib2_without_data(), "message 1 has section 5 where 7 was expected"),
        ("bits.grib", lies.grib(2, bits=4), "message 1 declares 4 bits for each of 496 values"),
        ("wide.grib", lies.grib(2, bits=24), "the packing of message 1 declares 1,488 bytes"),
        ("one.grib", lies.grib(1, bits=4), "message 1 declares 4 bits for each of 496 values"),
        ("pole.grib", lies.grib(1, latitude=120.0), "message 1 has the latitude 120"),
        ("pole2.grib", lies.grib(2, latitude=160.0), "has the latitude 160"),
        ("spaces.vtu", b"\n" * 300 + lies.vtu(10**12)[21:], "3,000,000,000,000 values"),
        (
            "piece.vtu",
            lies.vtu(10**8).replace(b"><Points", b"><Piece NumberOfPoints='3'/><Points"),
            "300,000,000 values",
        ),
        ("wide.vti", lies.image("0 9 0 9 0 9").decode().encode("utf-16-be"), "in UTF-16"),
        ("prefix.vtk", lies.legacy("DATASETS POLYDATA\nPOINTS_ 100000000 float"), "300,000,000"),
        (
            "axis.vtk",
            lies.legacy("DATASET RECTILINEAR_GRID\nX_COORDINATE 100000000 float"),
            "100,000,000 numbers",
        ),
        (
            "joined.vtk",
            lies.legacy("DATASET POLYDATA\nPOINTS 1float\n1 2 3\nLINES 1 100000000"),
            "has '1float' where a whole number was expected",
        ),
        (
            "end.vtk",
            lies.legacy("DATASET POLYDATA\nPOINTS 1 float", "")[:-2],
            "points declares 3 numbers, but the file has 0",
        ),
        ("kind.vtk", lies.legacy("DATASET POLYDATA\nPOINTS 1 real"), "the type of points"),
        ("word.vtk", lies.legacy("DATASET POLYDATA\nPINTS 1 float"), "has 'pints' where a keyword"),
        (
            "head.vtk",
            lies.legacy("DATASET POLYDATA\nPOINTS 1 float").replace(b"Version", b"Versioo"),
            "where the version of a legacy file of VTK was expected",
        ),
        ("laughs.vtu", b'<!DOCTYPE x [<!ENTITY a "b">]><VTKFile/>', "the XML entity a"),
    ],
)
def test_a_size_that_the_file_has_not_is_refused(
    tmp_path: Path, name: str, content: bytes, what: str
) -> None:
    (tmp_path / name).write_bytes(content)
    assert what in refused(tmp_path / name)


def test_grib_with_any_packing_is_read(tmp_path: Path) -> None:
    for edition in (1, 2):
        for bits in (0, 1, 12, 24):
            path = tmp_path / f"{edition}_{bits}.grib"
            path.write_bytes(lies.grib(edition, packed=bits))
            inspect_file(path)


def test_too_many_variables_raise(tmp_path: Path) -> None:
    import netCDF4

    for name, kind in (("classic.nc", "NETCDF3_CLASSIC"), ("four.nc", "NETCDF4")):
        with netCDF4.Dataset(tmp_path / name, "w", format=kind) as file:  # type: ignore[arg-type]
            for number in range(2_001):
                file.createVariable(f"x{number}", "f4", ())
        assert "the file has 2,001 variables" in refused(tmp_path / name)


def test_an_array_beside_a_surface_is_as_long_as_it_says(tmp_path: Path) -> None:
    pv.Sphere().save(tmp_path / "ball.stl")
    about = {"descr": "<f8", "fortran_order": False, "shape": (10**11, 3)}
    with (tmp_path / "ball.npy").open("wb") as file:
        np.lib.format.write_array_header_1_0(file, about)
    assert "is not a NumPy array" in refused(tmp_path / "ball.stl")


@pytest.mark.filterwarnings("ignore:.*of the flow is normal to the surface")
@pytest.mark.parametrize("compressor", ["zlib", None])
def test_what_does_not_fit_into_memory_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, compressor: Any
) -> None:
    grid = pv.ImageData(dimensions=(100, 100, 1))
    grid["velocity"] = np.ones((grid.n_points, 3))
    path = tmp_path / "calm.vti"
    grid.save(path, compression=compressor)
    monkeypatch.setattr(memory, "available_bytes", lambda: 1_000_000)
    FlowField.from_file(path)  # 240 kB, however small the file is
    monkeypatch.setattr(memory, "available_bytes", lambda: 400_000)
    path.touch()
    assert "the file declares 240 kB, but 200 kB of memory are available" in refused(path)


def test_a_chunk_and_a_variable_have_to_fit_into_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lies.large_chunk(tmp_path / "chunk.nc")
    monkeypatch.setattr(memory, "available_bytes", lambda: 20_000_000)
    assert "one chunk of u declares 32 MB, but 10 MB" in refused(tmp_path / "chunk.nc")


def test_a_member_of_a_series_is_looked_into(tmp_path: Path) -> None:
    (tmp_path / "step.vtu").write_bytes(lies.vtu(10**12))
    (tmp_path / "series.pvd").write_text(
        '<VTKFile type="Collection"><Collection><DataSet timestep="0" file="step.vtu"/>'
        '<DataSet timestep="1" file="series.pvd"/></Collection></VTKFile>'
    )
    assert f"{tmp_path / 'step.vtu'}: the file is truncated" in refused(tmp_path / "series.pvd")
