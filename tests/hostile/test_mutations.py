"""Files of meshes with changed bytes, counts and numbers: a flow, or an error of flowtex.

No file ends the process: VTK trusts each number of a corner.
"""

from __future__ import annotations

import gzip
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import mutations
import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st
from strategies import property_test
from waiting import PATIENCE_S

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.sources.inspection.foam_files import check_foam

#: Changed files that one process reads.
BATCH = 60


@property_test(1, fuzz=4)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_changed_file_never_ends_the_process(
    tmp_path_factory: pytest.TempPathFactory, seed: int
) -> None:
    folder = tmp_path_factory.mktemp("changed")
    tests = Path(mutations.__file__).parents[1]
    places = os.pathsep.join([str(tests), str(tests / "hostile")])
    command = [sys.executable, mutations.__file__, str(folder), str(seed), str(BATCH)]
    done = subprocess.run(
        command,
        env={**os.environ, "PYTHONPATH": places},
        capture_output=True,
        text=True,
        check=False,
        timeout=10 * PATIENCE_S,
    )
    last = done.stdout.rpartition("\n")[2]
    assert done.returncode == 0, f"seed {seed}: {last}\n{done.stderr[-2000:]}"
    assert len(done.stdout.splitlines()) == BATCH


def written(folder: Path, name: str) -> Path:
    path = folder / name
    mutations.formats()[name](path)
    return path


def replaced(path: Path, old: bytes, new: bytes) -> Path:
    """Replace a text that a file has once."""
    data = path.read_bytes()
    assert data.count(old) == 1
    path.write_bytes(data.replace(old, new))
    return path


@pytest.mark.parametrize("count", [-1, 0, 2, 4, -(2**31), 2**40])
@pytest.mark.parametrize("mode", ["text", "inline", "appended", "packed"])
def test_xml_with_another_number_of_cells_is_refused(tmp_path: Path, mode: str, count: int) -> None:
    path = written(tmp_path, f"cells-{mode}.vtu")
    replaced(path, b'NumberOfCells="3"', f'NumberOfCells="{count}"'.encode())
    with pytest.raises(FieldError, match=r"declares|expected 0 or more|has more than"):
        FlowField.from_file(path)


@pytest.mark.parametrize("count", [-1, 0, 5, 7])
@pytest.mark.parametrize("mode", ["text", "inline", "appended", "packed"])
def test_xml_with_another_number_of_points_is_refused(
    tmp_path: Path, mode: str, count: int
) -> None:
    path = written(tmp_path, f"cells-{mode}.vtu")
    replaced(path, b'NumberOfPoints="6"', f'NumberOfPoints="{count}"'.encode())
    with pytest.raises(FieldError, match=r"declares|expected 0 or more|has more than"):
        FlowField.from_file(path)


@pytest.mark.parametrize("name", ["cells-text.vtk", "cells-text-old.vtk"])
@pytest.mark.parametrize("corner", [-1, 6, 2**31 - 1])
def test_legacy_cells_with_a_corner_out_of_range_are_refused(
    tmp_path: Path, name: str, corner: int
) -> None:
    path = written(tmp_path, name)
    data = path.read_bytes()
    begin = data.rindex(b"4", 0, data.index(b"CELL_TYPES"))
    path.write_bytes(data[:begin] + str(corner).encode() + data[begin + 1 :])
    with pytest.raises(FieldError, match="refer to points"):
        FlowField.from_file(path)


def test_legacy_cells_whose_sizes_do_not_add_up_are_refused(tmp_path: Path) -> None:
    path = replaced(written(tmp_path, "cells-text-old.vtk"), b"\n4 0 1 4 3", b"\n9 0 1 4 3")
    with pytest.raises(FieldError, match="do not add up to 3 cells of 13 numbers"):
        FlowField.from_file(path)


@pytest.mark.parametrize("extent", ["0 9 0 2 0 0", "-1 3 0 2 0 0", "0 3 0 2 0 1"])
@pytest.mark.parametrize("name", ["grid-text.vts", "image-text.vti", "lines-text.vtr"])
def test_pieces_that_do_not_fill_the_grid_are_refused(
    tmp_path: Path, name: str, extent: str
) -> None:
    path = written(tmp_path, name)
    replaced(path, b'WholeExtent="0 3 0 2 0 0"', f'WholeExtent="{extent}"'.encode())
    with pytest.raises(FieldError, match="WholeExtent"):
        FlowField.from_file(path)


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (b"element vertex 9", b"element vertex 8", "where a whole number was expected"),
        (b"element vertex 9", b"element vertex -9", "the line 'element vertex -9'"),
        (b"element face 8", b"element face 7", "more follows"),
        (b"element face 8", b"element face 9", "declares 9 lines"),
        (b"property float y\n", b"", "with the properties x, y and z"),
        (b"\n3 0 1 3", b"\n3 0 1 9", "refers to points 0 to 9, but there are 9"),
        (b"\n3 0 1 3", b"\n-1 0 1 3", "has -1 corners"),
        (b"\n3 0 1 3", b"\n2 0 1", "has 2 corners; expected 3"),
    ],
)
def test_ply_that_does_not_match_its_header_is_refused(
    tmp_path: Path, old: bytes, new: bytes, fault: str
) -> None:
    path = written(tmp_path, "text.ply")
    data = path.read_bytes()
    assert old in data
    path.write_bytes(data.replace(old, new, 1))
    with pytest.raises(FieldError, match=fault):
        FlowField.from_file(path)


@pytest.mark.parametrize("corners", [[[0, 1, 9]], [[-1, 1, 2]], [[0, 1, 2], [3, 4, 5, 200]]])
@pytest.mark.parametrize("order", ["little", "big"])
def test_binary_ply_with_a_corner_out_of_range_is_refused(
    tmp_path: Path, corners: list[list[int]], order: str
) -> None:
    sign = ">"
    if order == "little":
        sign = "<"
    head = f"""ply
format binary_{order}_endian 1.0
element vertex 9
property float x
property float y
property float z
element face {len(corners)}
property list uchar int vertex_indices
end_header
"""
    points = np.zeros((9, 3), f"{sign}f4").tobytes()
    faces = b"".join(bytes([len(face)]) + np.array(face, f"{sign}i4").tobytes() for face in corners)
    path = tmp_path / "flow.ply"
    path.write_bytes(head.encode() + points + faces)
    with pytest.raises(FieldError, match=r"refers to points .*, but there are 9"):
        FlowField.from_file(path)


@pytest.mark.parametrize(
    "corner", [b"10//1", b"1//10", b"0//1", b"-10//1", b"1/1/1", b"x", b"1000000"]
)
def test_obj_with_a_corner_out_of_range_is_refused(tmp_path: Path, corner: bytes) -> None:
    path = written(tmp_path, "text.obj")
    data = path.read_bytes()
    begin = data.index(b"f ") + 2
    path.write_bytes(data[:begin] + corner + data[data.index(b" ", begin) :])
    with pytest.raises(FieldError, match="but there are 9 points, 0 texture coordinates and 9 nor"):
        FlowField.from_file(path)


@pytest.mark.parametrize("count", [0, 7, 9, 2**31, 2**32 - 1])
@pytest.mark.parametrize("title", [b"", b"solid hull"])
def test_binary_stl_with_another_number_of_triangles_is_refused(
    tmp_path: Path, title: bytes, count: int
) -> None:
    path = written(tmp_path, "binary.stl")
    triangles = path.read_bytes()[84:]
    path.write_bytes(title.ljust(80, b"\0") + count.to_bytes(4, "little") + triangles)
    with pytest.raises(FieldError, match=f"declares .*{count:,} triangles|header of {count:,} tri"):
        FlowField.from_file(path)


@pytest.mark.parametrize("size", [40, 83, 84 + 50 * 8 - 1])
def test_binary_stl_that_is_cut_is_refused(tmp_path: Path, size: int) -> None:
    path = written(tmp_path, "binary.stl")
    path.write_bytes(path.read_bytes()[:size])
    with pytest.raises(FieldError, match="the file is truncated or damaged: the header"):
        FlowField.from_file(path)


@pytest.mark.filterwarnings("ignore:.*of the flow is normal:flowtex.errors.Notice")
def test_ply_of_faces_with_different_corners_is_read(tmp_path: Path) -> None:
    path = tmp_path / "flow.ply"
    mesh = pv.PolyData(mutations.cells().points, [4, 0, 1, 4, 3, 3, 1, 2, 4, 3, 2, 5, 4])
    mesh.save(path)
    np.save(path.with_suffix(".npy"), np.ones((3, 3)))
    field = FlowField.from_file(path)
    assert field.triangles is not None and len(field.triangles) == 4


def test_a_mesh_of_a_user_with_a_corner_out_of_range_is_refused() -> None:
    mesh = mutations.cells()
    mesh.GetCells().GetConnectivityArray().SetValue(2, 10**6)
    with pytest.raises(FieldError, match="its cells refer to points 0 to 1000000, but there are 6"):
        FlowField.from_pyvista(mesh)


def test_polyhedra_with_a_corner_out_of_range_are_refused() -> None:
    mesh = mutations.polyhedra()
    mesh.GetPolyhedronFaces().GetConnectivityArray().SetValue(2, 99)
    with pytest.raises(FieldError, match="refer to points 0 to 99, but there are 12"):
        FlowField.from_pyvista(mesh)


@pytest.mark.parametrize("count", [-1, 0, 3, 5, 10**6])
def test_legacy_polyhedra_with_wrong_counts_are_refused(tmp_path: Path, count: int) -> None:
    path = written(tmp_path, "polyhedra-text.vtk")
    data = path.read_bytes()
    begin = data.index(b"\n6 4 ", data.index(b"CONNECTIVITY")) + 3
    path.write_bytes(data[:begin] + str(count).encode() + data[begin + 1 :])
    with pytest.raises(FieldError, match="faces of polyhedron 0 do not match their counts"):
        FlowField.from_file(path)


def test_a_cell_too_short_for_its_type_is_refused() -> None:
    mesh = mutations.cells()
    mesh.GetCellTypes().SetValue(1, pv.CellType.QUAD)
    with pytest.raises(FieldError, match="a cell of type 9 has 3 points; expected 4"):
        FlowField.from_pyvista(mesh)


@pytest.mark.filterwarnings("ignore:.*of the flow is normal:flowtex.errors.Notice")
@pytest.mark.parametrize("number", [-1, 0, 7, 2**31 - 1])
def test_ensight_with_another_part_ends_its_reader_alone(tmp_path: Path, number: int) -> None:
    """VTK writes the values of a part that does not exist wherever its number leads."""
    path = written(tmp_path, "flow.case")
    replaced(tmp_path / "flow.velocity000", b"part\n         1\n", b"part\n%10d\n" % number)
    fault = rf"^{re.escape(str(path))}: the (reader of this file crashed|file is damaged)"
    with pytest.raises(FieldError, match=fault):
        FlowField.from_file(path, vectors="velocity")
    replaced(tmp_path / "flow.velocity000", b"part\n%10d\n" % number, b"part\n         1\n")
    assert FlowField.from_file(path, vectors="velocity").shape == (3, 4)


def foam_list(path: Path, values: list[int], form: str, *, wide: bool = False) -> None:
    """Write numbers of cells as OpenFOAM does: a text, packed, one for all, or numbers."""
    kind: np.dtype[Any] = np.dtype(np.int32)
    if wide:
        kind = np.dtype(np.int64)
    arch = f'arch "LSB;label={8 * kind.itemsize};scalar=64"'
    encoding = "ascii"
    if form == "binary":
        encoding = "binary"
    head = f"/* a case */ FoamFile {{ version 2.0; format {encoding}; {arch}; class labelList; "
    head += f"object {path.name}; }}\n// * * //\n\n"
    body = f"{len(values)}\n(\n{' '.join(map(str, values))}\n)\n// * * //\n".encode()
    if form == "uniform":
        body = f"{len(values)}{{{values[0]}}}\n".encode()
    if form == "binary":
        body = f"{len(values)}\n(".encode() + np.array(values, kind).tobytes() + b")\n"
    if form == "packed":
        path.unlink()
        path = path.with_name(f"{path.name}.gz")
        body = gzip.compress(head.encode() + body)
        head = ""
    path.write_bytes(head.encode() + body)


@pytest.mark.parametrize("form", ["text", "binary", "wide", "packed", "uniform"])
@pytest.mark.parametrize("name", ["owner", "neighbour"])
@pytest.mark.parametrize("cell", [11, -2, 2**31 - 1])
def test_openfoam_with_a_cell_out_of_range_is_refused(
    tmp_path: Path, name: str, form: str, cell: int
) -> None:
    """VTK makes as many cells as the greatest number, which takes minutes."""
    path = written(tmp_path, "flow.foam")
    count = {"owner": 11, "neighbour": 1}[name]
    values = [cell] * count
    place = tmp_path / "constant" / "polyMesh" / name
    foam_list(place, values, form.replace("wide", "binary"), wide=form == "wide")
    with pytest.raises(
        FieldError, match=f"{name}: the file is damaged: a face has the cell {cell}"
    ):
        FlowField.from_file(path)


@pytest.mark.filterwarnings("ignore::flowtex.errors.Notice")
@pytest.mark.parametrize("form", ["text", "binary", "packed"])
def test_openfoam_of_every_encoding_is_read(tmp_path: Path, form: str) -> None:
    path = written(tmp_path, "flow.foam")
    expected = FlowField.from_file(path)
    owner = [0, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1]
    place = tmp_path / "constant" / "polyMesh" / "owner"
    foam_list(place, owner, form)
    assert np.array_equal(FlowField.from_file(path).points, expected.points)


def test_openfoam_with_labels_of_64_bits_passes_the_check(tmp_path: Path) -> None:
    """VTK reads such labels only where it is told."""
    written(tmp_path, "flow.foam")
    mesh = tmp_path / "constant" / "polyMesh"
    foam_list(mesh / "owner", [0, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1], "binary", wide=True)
    foam_list(mesh / "neighbour", [-1] * 11, "binary", wide=True)
    check_foam(tmp_path)
