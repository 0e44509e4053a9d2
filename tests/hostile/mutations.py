"""Small files of every format of meshes and of GRIB, of which bytes and numbers are changed.

``python mutations.py FOLDER SEED COUNT`` reads ``COUNT`` changed files. It prints each change
before it reads the file, so the last line names the file that ended the process.
"""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np
import pyvista as pv
from cfd_files import CGNS, box, write_ensight, write_exodus, write_foam
from lying_files import grib
from vtkmodules.vtkCommonCore import vtkIdList

from flowtex import FlowField
from flowtex.errors import FieldError

Write: TypeAlias = Callable[[Path], None]
Change: TypeAlias = Callable[[bytes, np.random.Generator], tuple[bytes, str]]
#: Numbers that replace a count or an index, beside its neighbours.
WRONG = (-1, 0, 1, 2, 7, 10**6, 2**31 - 1, 2**31, 2**32 - 1, 2**40, 2**63 - 1, -(2**31), -(10**12))
#: A whole number in a text, also as the value of an attribute.
_NUMBER = re.compile(rb"(?<![\w.+-])-?\d+(?![\w.])")


def flow(mesh: Any) -> Any:
    """Give a mesh a velocity and a scalar on cells."""
    mesh["velocity"] = np.cos(mesh.points) + 2
    mesh.cell_data["number"] = np.arange(float(mesh.n_cells))
    return mesh


def grid() -> Any:
    x, y, z = np.meshgrid(np.arange(4.0), np.arange(3.0), np.zeros(1), indexing="ij")
    return flow(pv.StructuredGrid(x, y, z))


def surface() -> Any:
    return flow(pv.Plane(i_resolution=2, j_resolution=2).triangulate())


def cells() -> Any:
    """Triangles and a quadrilateral."""
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 2, 0]], float)
    connectivity = [4, 0, 1, 4, 3, 3, 1, 2, 4, 3, 2, 5, 4]
    return flow(pv.UnstructuredGrid(connectivity, [9, 5, 5], points))


def polyhedra() -> Any:
    """Two cubes as polyhedra, which have faces of their own."""
    image = pv.ImageData(dimensions=(3, 2, 2))
    mesh = pv.UnstructuredGrid()
    mesh.points = image.points.astype(float)
    for number in range(image.n_cells):
        cell = image.get_cell(number)
        faces = [[len(face.point_ids), *face.point_ids] for face in cell.faces]
        listed = [len(faces), *(corner for face in faces for corner in face)]
        ids = vtkIdList()
        for value in listed:
            ids.InsertNextId(value)
        mesh.InsertNextCell(pv.CellType.POLYHEDRON, ids)
    return flow(mesh)


def image() -> Any:
    return flow(pv.ImageData(dimensions=(4, 3, 1)))


def rectilinear() -> Any:
    return flow(pv.RectilinearGrid(np.arange(4.0), np.arange(3.0) ** 2, np.zeros(1)))


def legacy(mesh: Any, *, text: bool, version: int) -> Write:
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


def xml(mesh: Any, mode: str, *, compressed: bool = False) -> Write:
    def write(path: Path) -> None:
        from vtkmodules import vtkIOXML

        writer = getattr(vtkIOXML, f"vtkXML{type(mesh).__name__}Writer")()
        getattr(writer, f"SetDataModeTo{mode}")()
        writer.EncodeAppendedDataOff()
        if not compressed:
            writer.SetCompressorTypeToNone()
        writer.SetFileName(str(path))
        writer.SetInputData(mesh)
        writer.Write()

    return write


def hdf(mesh: Any) -> Write:
    def write(path: Path) -> None:
        from vtkmodules.vtkIOHDF import vtkHDFWriter

        writer = vtkHDFWriter()
        writer.SetFileName(str(path))
        writer.SetInputData(mesh)
        writer.Write()

    return write


def bare(mesh: Any, *, binary: bool) -> Write:
    """Surfaces whose formats store no vectors, which are in a file beside."""

    def write(path: Path) -> None:
        if path.suffix == ".obj":
            lines = [f"v {x:g} {y:g} {z:g}" for x, y, z in mesh.points]
            lines += ["vn 0 0 1" for _ in mesh.points]
            lines += [f"f {i}//{i} {j}//{j} {k}//{k}" for i, j, k in mesh.regular_faces + 1]
            path.write_text("\n".join([*lines, ""]))
        else:
            mesh.save(path, binary=binary)
        np.save(path.with_suffix(".npy"), np.ones((mesh.n_cells, 3)))

    return write


def blocks(path: Path) -> None:
    pv.MultiBlock({"one": surface()}).save(path, binary=False)


def cgns(path: Path) -> None:
    with CGNS.write(path) as file:
        file.base("Base", [("Zone", box(4, 3, 1))])


def ensight(path: Path) -> None:
    """Write a case of one time with one part, in a file for each array."""
    write_ensight(path, [("Tip", box(4, 3, 1))], times=(0.5,))


def exodus(path: Path) -> None:
    write_exodus(path, box(4, 3, 2))


def plot3d(path: Path) -> None:
    """Write a grid of one layer, and its solution beside it."""
    x, y, z = np.moveaxis(box(7, 5, 1)[0], -1, 0).astype("<f4")
    size = np.array([7, 5, 1], "<i4").tobytes()
    path.write_bytes(size + np.stack([x, y, z]).tobytes())
    state = np.array([0.5, 0, 1e3, 7], "<f4").tobytes()
    values = np.stack([0 * x + 2, x + 1, y, z, 0 * x + 9]).astype("<f4")
    path.with_suffix(".q").write_bytes(size + state + values.tobytes())


MESHES = {
    "grid": (grid, "vts"),
    "surface": (surface, "vtp"),
    "cells": (cells, "vtu"),
    "polyhedra": (polyhedra, "vtu"),
    "image": (image, "vti"),
    "lines": (rectilinear, "vtr"),
}


def formats() -> dict[str, Write]:
    """Return what writes a file of each format, by the name of the file."""
    found: dict[str, Write] = {}
    for name, (make, suffix) in MESHES.items():
        mesh = make()
        for text in (True, False):
            kind = "text" if text else "binary"
            found[f"{name}-{kind}.vtk"] = legacy(mesh, text=text, version=51)
            if name != "polyhedra":
                found[f"{name}-{kind}-old.vtk"] = legacy(mesh, text=text, version=42)
        found[f"{name}-text.{suffix}"] = xml(mesh, "Ascii")
        found[f"{name}-inline.{suffix}"] = xml(mesh, "Binary")
        found[f"{name}-appended.{suffix}"] = xml(mesh, "Appended")
        found[f"{name}-packed.{suffix}"] = xml(mesh, "Appended", compressed=True)
    for name in ("surface", "cells", "image"):
        found[f"{name}.vtkhdf"] = hdf(MESHES[name][0]())
    for suffix in ("ply", "stl"):
        found[f"text.{suffix}"] = bare(surface(), binary=False)
        found[f"binary.{suffix}"] = bare(surface(), binary=True)
    found["text.obj"] = bare(surface(), binary=False)
    found["blocks.vtm"] = blocks
    found["wing.xyz"] = plot3d
    found["wing.cgns"] = cgns
    found["flow.case"] = ensight
    found["flow.ex2"] = exodus
    found["flow.foam"] = write_foam
    for edition in (1, 2):
        found[f"winds-{edition}.grib"] = partial(winds, edition)
    return found


def winds(edition: int, path: Path) -> None:
    """Write messages of GRIB."""
    path.write_bytes(grib(edition))


def changed(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    """Return a file with one change, and the change in words."""
    is_text = b"\0" not in data[:4000]
    numbers = list(_NUMBER.finditer(data))
    kinds: list[Change] = [_flipped]
    if is_text:
        kinds.append(_other_line)
    else:
        kinds += [_other_word, _other_word]
    if numbers:
        kinds += [_other_number, _other_number]
    return kinds[rng.integers(len(kinds))](data, rng)


def _flipped(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    array = bytearray(data)
    at = int(rng.integers(len(data)))
    bit = int(rng.integers(8))
    array[at] ^= 1 << bit
    return bytes(array), f"bit {bit} of byte {at} flipped"


def _other_number(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    matches = list(_NUMBER.finditer(data))
    match = matches[rng.integers(len(matches))]
    value = int(match.group())
    choices = [*WRONG, value - 1, value + 1, value + 3]
    wrong = choices[rng.integers(len(choices))]
    text = data[: match.start()] + str(wrong).encode() + data[match.end() :]
    return text, f"{value} at {match.start()} replaced by {wrong}"


def _other_line(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    lines = data.split(b"\n")
    at = int(rng.integers(len(lines)))
    if rng.random() < 0.5:
        return b"\n".join(lines[:at] + lines[at + 1 :]), f"line {at} left out"
    return b"\n".join(lines[: at + 1] + lines[at:]), f"line {at} repeated"


def _other_word(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    array = bytearray(data)
    width = int(rng.choice([1, 2, 4, 8]))
    at = int(rng.integers(max(len(data) - width, 1)))
    if rng.random() < 0.7:
        at -= at % width
    value = WRONG[rng.integers(len(WRONG))] % 2 ** (8 * width)
    order: Literal["little", "big"] = "little"
    if rng.random() < 0.5:
        order = "big"
    array[at : at + width] = value.to_bytes(width, order)
    return bytes(array), f"{width} bytes at {at} replaced by {value}"


def read(path: Path) -> str:
    """Read the flow of a file and return its size, or the error of flowtex."""
    try:
        field = FlowField.from_file(path)
    except FieldError as error:
        return f"error: {error}"
    return f"{field.shape[0]} by {field.shape[1]} nodes"


def main(folder: Path, seed: int, count: int) -> None:
    """Read changed files of formats that are drawn."""
    warnings.simplefilter("ignore")
    rng = np.random.default_rng(seed)
    writers = formats()
    names = list(writers)
    whole: dict[str, dict[Path, bytes]] = {}
    for _ in range(count):
        name = names[rng.integers(len(names))]
        path = folder / name / name
        if name not in whole:
            path.parent.mkdir()
            writers[name](path)
            files = [file for file in sorted(path.parent.rglob("*")) if file.is_file()]
            whole[name] = {file: file.read_bytes() for file in files}
            result = read(path)
            if result.startswith("error"):
                raise RuntimeError(f"{name} is not read: {result}")
        targets = [file for file, data in whole[name].items() if data and file.suffix != ".npy"]
        target = targets[rng.integers(len(targets))]
        content, change = changed(whole[name][target], rng)
        target.write_bytes(content)
        sys.stdout.write(f"{target.relative_to(folder)}: {change}: ")
        sys.stdout.flush()
        sys.stdout.write(f"{read(path)}\n")
        target.write_bytes(whole[name][target])


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))
