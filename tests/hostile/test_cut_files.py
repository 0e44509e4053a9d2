"""Files of every format, cut anywhere or with changed bytes: an error of ours, or the truth."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st
from reading_process import read_all
from strategies import property_test

from flowtex.errors import FieldError
from flowtex.field.io.inspection.files import inspect_file

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
}
SURFACES = {"text.ply": False, "binary.ply": True, "text.stl": False, "binary.stl": True}


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Whole files by name, and what is in them."""
    folder = tmp_path_factory.mktemp("whole")
    for name, write in FORMATS.items():
        write(folder / name)
    for name, binary in SURFACES.items():
        surface().save(folder / name, binary=binary)
    # Vectors of the triangles: these formats have no room for them.
    np.save(folder / "vectors.npy", np.ones((surface().n_cells, 3)))
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def lay(folder: Path, files: dict[str, bytes], name: str, content: bytes) -> Path:
    """Write a file, and what it needs beside it."""
    folder.mkdir()
    (folder / name).write_bytes(content)
    if name in SURFACES:
        (folder / name).with_suffix(".npy").write_bytes(files["vectors.npy"])
    return folder / name


NAMES = st.sampled_from([*FORMATS, *SURFACES])


@pytest.fixture(scope="module")
def truths(files: dict[str, bytes], tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """What each whole file has."""
    folder = tmp_path_factory.mktemp("truths")
    names = [*FORMATS, *SURFACES]
    found = read_all([lay(folder / name, files, name, files[name]) for name in names])
    assert not [one for one in found if one.startswith("FieldError")]
    return dict(zip(names, found, strict=True))


@property_test(1)
@given(st.lists(st.tuples(NAMES, st.floats(0, 1)), min_size=CASES, max_size=CASES))
def test_a_file_that_is_cut_is_refused_or_whole(
    files: dict[str, bytes],
    truths: dict[str, str],
    tmp_path_factory: pytest.TempPathFactory,
    cuts: list[tuple[str, float]],
) -> None:
    folder = tmp_path_factory.mktemp("cut")
    cases = []
    for number, (name, share) in enumerate(cuts):
        end = int(share * len(files[name]))
        last = re.search(rb"\S+\s*$", files[name])
        if name in ("text.vtk", "cells.vtk", "polygons.vtk") and last and end > last.start():
            end = last.start()  # a number of which digits are missing is a number
        cases.append((name, lay(folder / str(number), files, name, files[name][:end])))
    found = read_all([path for _, path in cases])
    for (name, path), result in zip(cases, found, strict=True):  # none crashed
        ours = result.startswith(f"FieldError: {path}: ")
        assert ours or result == truths[name], (name, path.stat().st_size, result)


@property_test(CASES)
@given(NAMES, st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), min_size=1, max_size=4))
def test_changed_bytes_are_looked_into_without_another_error(
    files: dict[str, bytes],
    tmp_path_factory: pytest.TempPathFactory,
    name: str,
    changes: list[tuple[float, int]],
) -> None:
    data = bytearray(files[name])
    for place, value in changes:
        data[int(place * (len(data) - 1))] = value
    path = lay(tmp_path_factory.mktemp("changed") / "one", files, name, bytes(data))
    try:
        inspect_file(path)
    except FieldError as error:
        assert len(str(error)) < 500


@pytest.mark.parametrize("name", [*FORMATS, *SURFACES])
def test_a_whole_file_is_read(truths: dict[str, str], name: str) -> None:
    assert len(truths[name]) == 64


@pytest.mark.parametrize("share", [0.4, 0.8])
@pytest.mark.parametrize("name", [*FORMATS, *SURFACES])
def test_what_is_missing_is_told(
    files: dict[str, bytes], tmp_path: Path, name: str, share: float
) -> None:
    cut = files[name][: int(share * len(files[name]))]
    # At the end of a line a text looks whole.
    cut = cut[: cut.rfind(b"\n") + 1] if name.startswith(("text", "cells", "poly")) else cut
    with pytest.raises(FieldError, match="cut short"):
        inspect_file(lay(tmp_path / "cut", files, name, cut))
