"""Files of every format, cut anywhere or with changed bytes: an error of ours, or the truth."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from cfd_files import CGNS, box, write_exodus
from hypothesis import given
from hypothesis import strategies as st
from lying_files import winds
from reading_process import CRASHED, read_all
from strategies import property_test

from flowtex.errors import FieldError
from flowtex.field.io.inspection.files import inspect_file
from flowtex.field.remote import open_remote

#: Cuts, or changes, of a file of each format.
CASES = 40


def flow(mesh: Any) -> Any:
    """Give a mesh a velocity."""
    mesh["velocity"] = np.cos(mesh.points) + 2
    return mesh


def structured() -> Any:
    x, y, z = np.meshgrid(np.arange(7.0), np.arange(5.0), np.zeros(1), indexing="ij")
    return flow(pv.StructuredGrid(x, y, z))


def surface() -> Any:
    return flow(pv.Plane(i_resolution=4, j_resolution=4).triangulate())


def legacy(mesh: Any, *, text: bool, version: int) -> Callable[[Path], None]:
    def write(path: Path) -> None:
        from vtkmodules import vtkIOLegacy

        kind = type(mesh).__name__.replace("ImageData", "StructuredPoints")
        writer = getattr(vtkIOLegacy, f"vtk{kind}Writer")()
        writer.SetFileVersion(version)
        writer.SetFileType(1 if text else 2)
        writer.SetFileName(str(path))
        writer.SetInputData(mesh)
        writer.Write()

    return write


def saved(mesh: Any, *, binary: bool = True) -> Callable[[Path], None]:
    return lambda path: mesh.save(path, binary=binary)


def encoded(mesh: Any) -> Callable[[Path], None]:
    def write(path: Path) -> None:
        from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

        writer = vtkXMLPolyDataWriter()
        writer.SetDataModeToBinary()
        writer.SetFileName(str(path))
        writer.SetInputData(mesh)
        writer.Write()

    return write


def dataset(kind: Any) -> Callable[[Path], None]:
    def write(path: Path) -> None:
        import netCDF4

        with netCDF4.Dataset(path, "w", format=kind) as file:
            file.createDimension("time", None)
            for name, values, unit in (
                ("lat", np.linspace(10, 20, 5), "degrees_north"),
                ("lon", np.linspace(30, 40, 7), "degrees_east"),
                ("time", np.arange(2.0), "hours since 2000-01-01"),
            ):
                if name != "time":
                    file.createDimension(name, len(values))
                file.createVariable(name, "f8", (name,))[:] = values
                file[name].units = unit
            for name in "uv":
                wind = file.createVariable(name, "i2", ("time", "lat", "lon"))
                wind.standard_name = f"{'east' if name == 'u' else 'north'}ward_wind"
                wind[:] = np.arange(70).reshape(2, 5, 7) + 1

    return write


def with_vectors(*, binary: bool) -> Callable[[Path], None]:
    """Surfaces whose formats have no room for vectors: they stand in a file beside."""

    def write(path: Path) -> None:
        if path.suffix == ".obj":
            pv.save_meshio(path, surface())
        else:
            surface().save(path, binary=binary)
        np.save(path.with_suffix(".npy"), np.ones((surface().n_cells, 3)))

    return write


def grib(path: Path) -> None:
    import eccodes

    with path.open("wb") as file:
        for name in ("10u", "10v"):
            message = eccodes.codes_grib_new_from_samples("regular_ll_sfc_grib2")
            axes: dict[str, Any] = {"Ni": 7, "Nj": 5, "iDirectionIncrementInDegrees": 2}
            axes |= {"jDirectionIncrementInDegrees": 2.5, "shortName": name}
            axes |= {"latitudeOfFirstGridPointInDegrees": 20}
            axes |= {"latitudeOfLastGridPointInDegrees": 10}
            axes |= {"longitudeOfFirstGridPointInDegrees": 30}
            axes |= {"longitudeOfLastGridPointInDegrees": 42}
            for key, value in axes.items():
                eccodes.codes_set(message, key, value)
            eccodes.codes_set_values(message, np.arange(35.0) + 1)
            eccodes.codes_write(message, file)
            eccodes.codes_release(message)


def plot3d(path: Path) -> None:
    """Write a grid of one layer in blocks of FORTRAN, and its solution beside it."""
    x, y, z = np.moveaxis(box(7, 5, 1)[0], -1, 0).astype("<f4")
    size = np.array([7, 5, 1], "<i4").tobytes()
    path.write_bytes(size + np.stack([x, y, z]).tobytes())
    state = np.array([0.5, 0, 1e3, 7], "<f4").tobytes()
    values = np.stack([0 * x + 2, x + 1, y, z, 0 * x + 9]).astype("<f4")
    path.with_suffix(".q").write_bytes(size + state + values.tobytes())


def wind_map(path: Path) -> None:
    path.write_bytes(winds(2, 2))


def cgns(path: Path) -> None:
    with CGNS.write(path) as file:
        file.base("Base", [("Zone", box(4, 3, 1))])


FORMATS: dict[str, Callable[[Path], None]] = {
    "text.vtk": legacy(structured(), text=True, version=51),
    "binary.vtk": legacy(structured(), text=False, version=51),
    "image.vtk": legacy(flow(pv.ImageData(dimensions=(6, 5, 1))), text=False, version=42),
    "cells.vtk": legacy(surface().cast_to_unstructured_grid(), text=True, version=51),
    "old.vtk": legacy(surface().cast_to_unstructured_grid(), text=False, version=42),
    "polygons.vtk": legacy(surface(), text=True, version=42),
    "appended.vts": saved(structured()),
    "text.vts": saved(structured(), binary=False),
    "cells.vtu": saved(surface().cast_to_unstructured_grid()),
    "encoded.vtp": encoded(surface()),
    "classic.nc": dataset("NETCDF3_CLASSIC"),
    "offset.nc": dataset("NETCDF3_64BIT_OFFSET"),
    "cdf5.nc": dataset("NETCDF3_64BIT_DATA"),
    "four.nc": dataset("NETCDF4"),
    "text.ply": with_vectors(binary=False),
    "binary.ply": with_vectors(binary=True),
    "text.stl": with_vectors(binary=False),
    "binary.stl": with_vectors(binary=True),
    "wind.grib": grib,
    "wind.json": wind_map,
    "wing.xyz": plot3d,
    "wing.cgns": cgns,
    "wing.ex2": lambda path: write_exodus(path, box(4, 3, 2)),
}
#: Formats of text that ends anywhere: a number of which digits are missing is a number.
FREE_TEXT = ("text.vtk", "cells.vtk", "polygons.vtk")

#: The file, and what lies beside it, by the name of its format.
Whole = dict[str, dict[str, bytes]]


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Whole:
    """A whole file of each format."""
    found: Whole = {}
    for name, write in FORMATS.items():
        folder = tmp_path_factory.mktemp("whole")
        write(folder / name)
        found[name] = {path.name: path.read_bytes() for path in folder.iterdir()}
    return found


def lay(folder: Path, files: Whole, name: str, content: bytes) -> Path:
    """Write a file of a format with another content, and what it needs beside it."""
    folder.mkdir()
    for beside, data in files[name].items():
        (folder / beside).write_bytes(content if beside == name else data)
    return folder / name


@pytest.fixture(scope="module")
def truths(files: Whole, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """What each whole file has."""
    folder = tmp_path_factory.mktemp("truths")
    found = read_all([lay(folder / name, files, name, files[name][name]) for name in FORMATS])
    return dict(zip(FORMATS, found, strict=True))


def cut(name: str, whole: bytes, share: float) -> bytes:
    """Return the beginning of a file."""
    end = int(share * len(whole))
    last = re.search(rb"\S+\s*$", whole)
    if name in FREE_TEXT and last and end > last.start():
        end = last.start()
    return whole[:end]


@property_test(1)
@given(st.integers(0, 2**32 - 1))
def test_a_file_that_is_cut_is_refused_or_whole(
    files: Whole, truths: dict[str, str], tmp_path_factory: pytest.TempPathFactory, seed: int
) -> None:
    folder = tmp_path_factory.mktemp("cut")
    shares = np.random.default_rng(seed).random((len(FORMATS), CASES))
    cases = [
        (name, lay(folder / f"{name}{n}", files, name, cut(name, files[name][name], share)))
        for name, row in zip(FORMATS, shares, strict=True)
        for n, share in enumerate(row)
    ]
    for (name, path), result in zip(cases, read_all([p for _, p in cases]), strict=True):
        ours = result.startswith(f"FieldError: {path}: ")
        assert ours or result == truths[name], (name, path.stat().st_size, result)


@property_test(1)
@given(st.integers(0, 2**32 - 1))
def test_a_file_with_flipped_bits_is_an_error_of_ours_or_a_flow(
    files: Whole, tmp_path_factory: pytest.TempPathFactory, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    folder = tmp_path_factory.mktemp("flipped")
    paths = []
    for name in FORMATS:
        for n in range(CASES):
            data = np.frombuffer(files[name][name], "u1").copy()
            places = rng.integers(0, len(data), rng.integers(1, 5))
            data[places] ^= 1 << rng.integers(0, 8, len(places)).astype("u1")
            paths.append(lay(folder / f"{name}{n}", files, name, data.tobytes()))
    crashed = {}
    for path, result in zip(paths, read_all(paths), strict=True):
        ours = result.startswith(f"FieldError: {path}: ") and len(result) < 1000
        assert ours or len(result) == 64 or result == CRASHED, (path.parent.name, result)
        if result == CRASHED:
            crashed[path.name] = path
    # VTK's readers crash on some; whoever reads for somebody else has them die apart.
    for path in crashed.values():
        with pytest.raises(FieldError, match=f"^{re.escape(str(path))}: "):
            open_remote([path]).field()


@pytest.mark.parametrize("name", FORMATS)
def test_a_whole_file_is_read(truths: dict[str, str], name: str) -> None:
    assert len(truths[name]) == 64


@pytest.mark.parametrize("share", [0.4, 0.8])
@pytest.mark.parametrize("name", [name for name in FORMATS if not name.startswith("wi")])
def test_what_is_missing_is_told(files: Whole, tmp_path: Path, name: str, share: float) -> None:
    data = files[name][name]
    data = data[: int(share * len(data))]
    # At the end of a line a text looks whole.
    data = data[: data.rfind(b"\n") + 1] if name.startswith(("text", "cells", "poly")) else data
    with pytest.raises(FieldError, match="cut short"):
        inspect_file(lay(tmp_path / "cut", files, name, data))
