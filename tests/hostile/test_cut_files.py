"""Files of every format, cut anywhere or with changed bytes: an error of ours, or the truth."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from cfd_files import CGNS, box, write_ensight, write_exodus, write_foam
from hypothesis import given
from hypothesis import strategies as st
from lying_files import winds
from mutations import legacy, xml
from strategies import property_test

from flowtex import FlowField
from flowtex._util.child.child import Child
from flowtex.errors import FieldError
from flowtex.sources.inspection.inspect_file import inspect_file
from flowtex.sources.remote import open_remote

#: Cuts, or changes, of a file of each format.
CASES = 24


def flow(mesh: Any) -> Any:
    """Give a mesh a velocity."""
    mesh["velocity"] = np.cos(mesh.points) + 2
    return mesh


def structured() -> Any:
    x, y, z = np.meshgrid(np.arange(7.0), np.arange(5.0), np.zeros(1), indexing="ij")
    return flow(pv.StructuredGrid(x, y, z))


def surface() -> Any:
    return flow(pv.Plane(i_resolution=4, j_resolution=4).triangulate())


def saved(mesh: Any, *, binary: bool = True) -> Callable[[Path], None]:
    return lambda path: mesh.save(path, binary=binary)


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
            mesh = surface()
            lines = [f"v {x:g} {y:g} {z:g}" for x, y, z in mesh.points]
            lines += [f"f {i} {j} {k}" for i, j, k in mesh.regular_faces + 1]
            path.write_text("\n".join([*lines, ""]))
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
    "encoded.vtp": xml(surface(), "Binary", compressed=True),
    "classic.nc": dataset("NETCDF3_CLASSIC"),
    "offset.nc": dataset("NETCDF3_64BIT_OFFSET"),
    "cdf5.nc": dataset("NETCDF3_64BIT_DATA"),
    "four.nc": dataset("NETCDF4"),
    "wind.grib": grib,
    "wind.json": wind_map,
    "wing.xyz": plot3d,
    "wing.cgns": cgns,
    "wing.ex2": lambda path: write_exodus(path, box(4, 3, 2)),
    "mesh.obj": with_vectors(binary=False),
    "flow.case": lambda path: write_ensight(path, [("Tip", box(4, 3, 2))]),
    "flow.foam": write_foam,
}
#: Formats of text that ends anywhere: a number of which digits are missing is a number.
FREE_TEXT = ("text.vtk", "cells.vtk", "polygons.vtk", "mesh.obj")
#: Formats without a count of all that they have: at the end of an entry they look whole.
NO_COUNTS = ("mesh.obj", "flow.case")


class Whole(dict[str, dict[str, bytes]]):
    """All files of a case by their paths in its folder, by the name of its format."""

    __repr__ = object.__repr__


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Whole:
    """A whole file of each format, with those that belong to it."""
    found = Whole()
    for name, write in FORMATS.items():
        folder = tmp_path_factory.mktemp("whole")
        write(folder / name)
        every = sorted(path for path in folder.rglob("*") if path.is_file())
        found[name] = {path.relative_to(folder).as_posix(): path.read_bytes() for path in every}
    return found


def lay(folder: Path, files: Whole, name: str, changed: str, content: bytes) -> Path:
    """Write the files of a format, one of them with another content."""
    for place, data in files[name].items():
        path = folder / place
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if place == changed else data)
    return folder / name


@pytest.fixture
def read(monkeypatch: pytest.MonkeyPatch) -> Callable[[Path], str]:
    """Read a file in a child, which continues to the next one unless it dies.

    Returns a digest of the flow, or the error.
    """
    children: list[Child] = []

    def child(*given: Any, **named: Any) -> Child:
        if not children or not children[-1].alive:
            children.append(Child(*given, **named))
        return children[-1]

    monkeypatch.setattr("flowtex.sources.remote.Child", child)

    def digest(path: Path) -> str:
        try:
            field = open_remote([path]).field()
            data = field.points.tobytes() + np.asarray(field.velocity).tobytes()
            return hashlib.sha256(data).hexdigest()
        except FieldError as error:
            assert len(str(error)) < 1000, error
            return f"error: {error}"

    return digest


@pytest.fixture
def truths(
    files: Whole, read: Callable[[Path], str], tmp_path_factory: pytest.TempPathFactory
) -> dict[str, str]:
    """What each whole file has."""
    folder = tmp_path_factory.mktemp("truths")
    return {name: read(lay(folder / name, files, name, name, files[name][name])) for name in files}


def cut(name: str, whole: bytes, share: float) -> bytes:
    """Return the beginning of a file."""
    end = int(share * len(whole))
    if name in FREE_TEXT:
        end = min(end, whole.rindex(whole.split()[-1]))
    return whole[:end]


def cases(files: Whole, rng: np.random.Generator) -> Iterator[tuple[str, str, float]]:
    """Draw for each format some of its files, and shares of them."""
    for name, every in files.items():
        places = [place for place, data in every.items() if data]
        for place in [name, *rng.choice(places, CASES - 1)] if every[name] else places:
            yield name, str(place), rng.random()


@pytest.mark.filterwarnings("ignore::UserWarning")
@property_test(1)
@given(st.integers(0, 2**32 - 1))
def test_a_file_that_is_cut_is_refused_or_whole(
    files: Whole,
    read: Callable[[Path], str],
    truths: dict[str, str],
    tmp_path_factory: pytest.TempPathFactory,
    seed: int,
) -> None:
    assert all(len(truth) == 64 for truth in truths.values()), truths
    folder = tmp_path_factory.mktemp("cut")
    wrong = []
    for n, (name, place, share) in enumerate(cases(files, np.random.default_rng(seed))):
        data = cut(name, files[name][place], share)
        result = read(lay(folder / str(n), files, name, place, data))
        if not result.startswith("error: ") and result != truths[name]:
            wrong.append((name, place, len(data), data[-40:]))
    assert not [case for case in wrong if case[0] not in NO_COUNTS]


@pytest.mark.filterwarnings("ignore::UserWarning")
@property_test(1)
@given(st.integers(0, 2**32 - 1))
def test_a_file_with_flipped_bits_is_an_error_of_ours_or_a_flow(
    files: Whole, read: Callable[[Path], str], tmp_path_factory: pytest.TempPathFactory, seed: int
) -> None:
    """A reader may crash: its process ends, and the next file is read by another."""
    rng = np.random.default_rng(seed)
    folder = tmp_path_factory.mktemp("flipped")
    for n, (name, place, _) in enumerate(cases(files, rng)):
        data = np.frombuffer(files[name][place], "u1").copy()
        at = rng.integers(0, len(data), rng.integers(1, 5))
        data[at] ^= 1 << rng.integers(0, 8, len(at)).astype("u1")
        result = read(lay(folder / str(n), files, name, place, data.tobytes()))
        assert result.startswith("error: ") or len(result) == 64


@pytest.mark.parametrize("share", [0.4, 0.8])
@pytest.mark.parametrize(
    "name", [name for name in FORMATS if not name.startswith(("wi", "flow", "mesh"))]
)
def test_what_is_missing_is_told(files: Whole, tmp_path: Path, name: str, share: float) -> None:
    data = files[name][name]
    data = data[: int(share * len(data))]
    # At the end of a line a text looks whole.
    data = data[: data.rfind(b"\n") + 1] if name.startswith(("text", "cells", "poly")) else data
    with pytest.raises(FieldError, match="truncated"):
        inspect_file(lay(tmp_path / "cut", files, name, name, data))


@pytest.mark.parametrize("name", ["binary.vtk", "image.vtk", "old.vtk"])
def test_missing_byte_in_binary_block_raises(files: Whole, tmp_path: Path, name: str) -> None:
    data = files[name][name]
    begin = data.index(b"LOOKUP_TABLE default\n") + 21
    for at in (begin, begin + 100, begin + 299):
        path = lay(tmp_path / str(at), files, name, name, data[:at] + data[at + 1 :])
        with pytest.raises(FieldError, match=r"no newline follows the \d+ bytes of scalars"):
            FlowField.from_file(path)


def test_inspection_decodes_only_the_ends_of_base64(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    path = tmp_path / "large.vtp"
    writer = vtkXMLPolyDataWriter(file_name=str(path))
    writer.SetDataModeToBinary()
    writer.SetCompressorTypeToNone()
    writer.SetInputData(flow(pv.Plane(i_resolution=60, j_resolution=60)))
    writer.Write()
    lengths: list[int] = []
    decode = base64.b64decode

    def counted(text: bytes) -> bytes:
        lengths.append(len(text))
        return decode(text)

    monkeypatch.setattr(base64, "b64decode", counted)
    inspect_file(path)
    assert lengths and max(lengths) < 100 and path.stat().st_size > 200_000


def test_a_grid_that_is_cut_to_one_of_two_dimensions_is_refused(
    files: Whole, tmp_path: Path
) -> None:
    data = files["wing.xyz"]["wing.xyz"][: 4 * (2 + 2 * 35)]
    with pytest.raises(
        FieldError, match="the grid file is truncated, or the solution belongs to another"
    ):
        FlowField.from_file(lay(tmp_path, files, "wing.xyz", "wing.xyz", data))


def test_a_mesh_whose_cells_name_points_that_it_has_not_is_refused() -> None:
    mesh = surface()
    mesh.faces = np.where(mesh.faces == 5, 99, mesh.faces)
    with pytest.raises(FieldError, match="its cells refer to points 0 to 99, but there are 25"):
        FlowField.from_pyvista(mesh)
