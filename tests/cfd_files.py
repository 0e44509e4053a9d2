"""Small files as flow solvers write them: CGNS, EnSight Gold, Exodus and OpenFOAM.

All hold the same turning flow on boxes of a few nodes, twice as fast in the second of two times.
VTK reads CGNS and has no writer for it, but it carries the CGNS library, whose functions are
called as they are. EnSight and OpenFOAM are text.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Numbers of the CGNS library: modes, data types, zone types and places of values.
_WRITE, _DOUBLE, _TEXT, _STRUCTURED, _UNSTRUCTURED = 1, 4, 5, 2, 3
_PLACES = {"points": 2, "cells": 3}
TIMES = (0.5, 1.0)  #: The times of a series.


def box(i: int, j: int, k: int, x: float = 0.0) -> Floats:
    """Nodes of a box with sides of 1 between nodes, (K, J, I, 3), from ``x`` on."""
    z, y, x_ = np.meshgrid(*[np.arange(float(n)) for n in (k, j, i)], indexing="ij")
    return np.stack([x_ + x, y, z], axis=-1)


def turning(points: Floats, speed: float = 1.0) -> Floats:
    """Velocity of the flow at points."""
    x, y, z = np.moveaxis(points, -1, 0)
    return speed * np.stack([1.0 - y, 1.0 + x, 0.5 + 0 * z], axis=-1)


def centres(points: Floats) -> Floats:
    """Middles of the cells between nodes (K, J, I, 3)."""
    for axis in range(3):
        if points.shape[axis] > 1:
            ends = np.swapaxes(points, 0, axis)
            points = np.swapaxes((ends[1:] + ends[:-1]) / 2, 0, axis)
    return points


class CGNS:
    """Writes a CGNS file: bases, each with zones that are boxes of nodes (K, J, I, 3)."""

    def __init__(self, number: int, library: Any) -> None:
        self._number, self._library = number, library
        self._bases = 0

    @classmethod
    @contextmanager
    def write(cls, path: Path) -> Iterator[CGNS]:
        """Begin a file, and end it."""
        import vtkmodules

        folder = Path(vtkmodules.__path__[0])
        library = ctypes.CDLL(str(next(folder.glob("*vtkcgns*"))))
        number = ctypes.c_int()
        if library.vtkcgns_cg_open(str(path).encode(), _WRITE, ctypes.byref(number)):
            raise OSError(path)
        yield cls(number.value, library)
        library.vtkcgns_cg_close(number)

    def _call(self, name: str, *arguments: Any, numbered: bool = True) -> int:
        """Call a function, and return the number of what it made."""
        words = [a.encode() if isinstance(a, str) else a for a in arguments]
        new = ctypes.c_int()
        end = [ctypes.byref(new)] if numbered else []
        function = getattr(self._library, f"vtkcgns_cg_{name}")
        if function(self._number, *words, *end):
            self._library.vtkcgns_cg_get_error.restype = ctypes.c_char_p
            raise OSError(self._library.vtkcgns_cg_get_error().decode())
        return new.value

    def base(
        self,
        name: str,
        zones: Iterable[tuple[str, Floats]],
        *,
        where: str = "points",
        times: Sequence[float] = (),
        hexahedra: bool = False,
    ) -> None:
        """Add a base with its zones, whose velocity is three scalars as CGNS has it.

        All zones are flat, with one layer of nodes, or none is.
        """
        zones = list(zones)
        base = self._call("base_write", name, 3 - _flat(zones[0][1]), 3)
        if times:
            self._call("biter_write", base, "BaseIterativeData", len(times), numbered=False)
            self._call("gopath", f"/{name}/BaseIterativeData", numbered=False)
            self._array("TimeValues", _DOUBLE, [len(times)], np.asarray(times, float))
        for zone_name, points in zones:
            self._zone(base, name, zone_name, points, where, times, hexahedra=hexahedra)

    def _zone(
        self,
        base: int,
        base_name: str,
        name: str,
        points: Floats,
        where: str,
        times: Sequence[float],
        *,
        hexahedra: bool,
    ) -> None:
        shape = np.array(points.shape[:3][::-1])[: 3 - _flat(points)]
        size = np.array([shape, shape - 1, 0 * shape], dtype=self._size)
        kind = _STRUCTURED
        if hexahedra:
            kind, cells = _UNSTRUCTURED, int((shape - 1).prod())
            size = np.array([shape.prod(), cells, 0], dtype=self._size)
        zone = self._call("zone_write", base, name, _pointer(size), kind)
        for axis, letter in enumerate("XYZ"):
            values = np.ascontiguousarray(points[..., axis])
            self._call("coord_write", base, zone, _DOUBLE, f"Coordinate{letter}", _pointer(values))
        if hexahedra:
            nodes = np.ascontiguousarray(_hexahedra(points) + 1, dtype=self._size)
            hexa_8, ends = 17, [ctypes.c_int64(1), ctypes.c_int64(cells)]
            self._call("section_write", base, zone, "Cells", hexa_8, *ends, 0, _pointer(nodes))
        at = points if where == "points" else centres(points)
        names = [f"Flow{n}" for n in range(len(times))] or ["Flow"]
        for n, solution in enumerate(names):
            number = self._call("sol_write", base, zone, solution, _PLACES[where])
            velocity = turning(at, n + 1.0)
            arrays = dict(zip("XYZ", np.moveaxis(velocity, -1, 0), strict=True))
            arrays = {f"Velocity{letter}": v for letter, v in arrays.items()}
            arrays["Pressure"] = at[..., 0]
            for array, values in arrays.items():
                place = (base, zone, number, _DOUBLE, array)
                self._call("field_write", *place, _pointer(np.ascontiguousarray(values)))
        if times:
            self._call("ziter_write", base, zone, "ZoneIterativeData", numbered=False)
            self._call("gopath", f"/{base_name}/{name}/ZoneIterativeData", numbered=False)
            text = np.frombuffer("".join(s.ljust(32) for s in names).encode(), "S1")
            self._array("FlowSolutionPointers", _TEXT, [32, len(names)], text)

    def _array(self, name: str, kind: int, shape: list[int], values: Any) -> None:
        size = np.array(shape, dtype=self._size)
        arguments = (name.encode(), kind, len(shape), _pointer(size), _pointer(values))
        if self._library.vtkcgns_cg_array_write(*arguments):
            raise OSError(name)

    _size = np.int64  #: How the library was built for VTK's wheels.


def _flat(points: Floats) -> bool:
    return len(points) == 1


def _pointer(values: NDArray[Any]) -> Any:
    return values.ctypes.data_as(ctypes.c_void_p)


def _hexahedra(points: Floats) -> NDArray[np.int64]:
    """Return the nodes of the cells of a box, (N, 8), from 0."""
    n = np.arange(points[..., 0].size).reshape(points.shape[:3])
    low = [n[:-1, :-1, :-1], n[:-1, :-1, 1:], n[:-1, 1:, 1:], n[:-1, 1:, :-1]]
    high = [n[1:, :-1, :-1], n[1:, :-1, 1:], n[1:, 1:, 1:], n[1:, 1:, :-1]]
    return np.stack([*low, *high], axis=-1).reshape(-1, 8)


def write_ensight(
    path: Path, blocks: Sequence[tuple[str, Floats]], times: Sequence[float] = TIMES
) -> None:
    """Write a case of EnSight Gold in text, with a vector and three scalars on nodes."""
    names = {"vector": ["velocity"], "scalar": ["p", "u", "v", "w"]}
    lines = ["FORMAT", "type: ensight gold", "GEOMETRY", f"model: {path.stem}.geo", "VARIABLE"]
    for kind, arrays in names.items():
        lines += [f"{kind} per node: 1 {name} {path.stem}.{name}***" for name in arrays]
    values = " ".join(f"{t:g}" for t in times)
    lines += ["TIME", "time set: 1", f"number of steps: {len(times)}"]
    lines += ["filename start number: 0", "filename increment: 1", f"time values: {values}"]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
    parts = ["flow", "boxes", "node id off", "element id off"]
    for number, (name, points) in enumerate(blocks, 1):
        size = "".join(f"{n:10d}" for n in points.shape[2::-1])
        parts += [
            "part",
            f"{number:10d}",
            name,
            "block",
            size,
            *_column(np.moveaxis(points, -1, 0)),
        ]
    path.with_suffix(".geo").write_text("\n".join(parts) + "\n", encoding="ascii")
    for n in range(len(times)):
        for name in [name for kind in names.values() for name in kind]:
            rows = [name]
            for number, (_, points) in enumerate(blocks, 1):
                u, v, w = np.moveaxis(turning(points, n + 1.0), -1, 0)
                all_ = {"u": u, "v": v, "w": w, "p": points[..., 0], "velocity": [u, v, w]}
                rows += ["part", f"{number:10d}", "block", *_column(np.asarray(all_[name]))]
            file = path.with_name(f"{path.stem}.{name}{n:03d}")
            file.write_text("\n".join(rows) + "\n", encoding="ascii")


def _column(values: Floats) -> list[str]:
    return [f"{value:12.5e}" for value in values.ravel()]


def write_exodus(path: Path, points: Floats) -> None:
    """Write hexahedra with a velocity in a file of Exodus, by VTK's writer."""
    import pyvista as pv
    from vtkmodules.vtkIOExodus import vtkExodusIIWriter

    mesh = pv.UnstructuredGrid({pv.CellType.HEXAHEDRON: _hexahedra(points)}, points.reshape(-1, 3))
    mesh["velocity"] = turning(points).reshape(-1, 3)
    writer = vtkExodusIIWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(mesh)
    writer.Write()


def write_foam(path: Path, *, decomposed: bool = False) -> None:
    """Write a case of OpenFOAM: two cubes side by side, and the velocity at two times."""
    path.touch()
    folder = path.parent / "processor0" if decomposed else path.parent
    mesh = folder / "constant" / "polyMesh"
    mesh.mkdir(parents=True)
    points = box(3, 2, 2).reshape(-1, 3)
    faces = ["1 4 10 7", "0 6 9 3", "2 5 11 8", "0 1 7 6", "1 2 8 7", "3 9 10 4", "4 10 11 5"]
    faces += ["0 3 4 1", "1 4 5 2", "6 7 10 9", "7 8 11 10"]
    owner = [0, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1]
    _foam(mesh / "points", "vectorField", _listed(f"({x:g} {y:g} {z:g})" for x, y, z in points))
    _foam(mesh / "faces", "faceList", _listed(f"4({face})" for face in faces))
    _foam(mesh / "owner", "labelList", _listed(map(str, owner)))
    _foam(mesh / "neighbour", "labelList", _listed(["1"]))
    patches = [("inlet", 1, 1), ("outlet", 1, 2), ("walls", 8, 3)]
    entries = [f"{n} {{ type patch; nFaces {c}; startFace {s}; }}" for n, c, s in patches]
    _foam(mesh / "boundary", "polyBoundaryMesh", _listed(entries))
    control = "startFrom startTime; startTime 0; endTime 1; deltaT 0.5; writeInterval 1;"
    (path.parent / "system").mkdir()
    _foam(path.parent / "system" / "controlDict", "dictionary", control)
    for n, time in enumerate(TIMES):
        values = _listed(f"({n + 1} {cell} 0)" for cell in (0, 1))
        text = "dimensions [0 1 -1 0 0 0 0];\n"
        text += f"internalField nonuniform List<vector> {values};\nboundaryField {{\n"
        text += "".join(f"{name} {{ type zeroGradient; }}\n" for name, _, _ in patches) + "}\n"
        (folder / f"{time:g}").mkdir()
        _foam(folder / f"{time:g}" / "U", "volVectorField", text)


def write_wall_stress(path: Path) -> Floats:
    """Add a stress on the walls at the last time, and no slip there; return it, (8, 3)."""
    walls = "walls { type fixedValue; value uniform (0 0 0); }"
    for time in TIMES:
        file = path.parent / f"{time:g}" / "U"
        text = file.read_text(encoding="ascii").replace("walls { type zeroGradient; }", walls)
        file.write_text(text, encoding="ascii")
    stress = np.stack([np.arange(1.0, 9.0), 0.5 * np.arange(8.0), np.zeros(8)], axis=1)
    values = _listed(f"({x:g} {y:g} {z:g})" for x, y, z in stress)
    text = "dimensions [0 2 -2 0 0 0 0];\ninternalField uniform (0 0 0);\nboundaryField {\n"
    for name in ("inlet", "outlet"):
        text += f"{name} {{ type calculated; value uniform (0 0 0); }}\n"
    text += f"walls {{ type calculated; value nonuniform List<vector> {values}; }}\n}}\n"
    _foam(path.parent / f"{TIMES[-1]:g}" / "wallShearStress", "volVectorField", text)
    return stress


def _foam(path: Path, kind: str, text: str) -> None:
    head = f"FoamFile {{ version 2.0; format ascii; class {kind}; object {path.name}; }}\n"
    path.write_text(f"{head}{text}\n", encoding="ascii")


def _listed(entries: Iterable[str]) -> str:
    lines = list(entries)
    return "\n".join([str(len(lines)), "(", *lines, ")"])


#: Points (N, 3) and triangles (M, 3).
Piece = tuple[Any, Any]
VTK_TRIANGLE = 5


def _write_cells(group: Any, cells: list[Any]) -> None:
    group["NumberOfCells"] = [len(part) for part in cells]
    group["NumberOfConnectivityIds"] = [part.size for part in cells]
    group["Connectivity"] = np.concatenate([part.ravel() for part in cells]).astype("i8")
    group["Offsets"] = np.concatenate([np.arange(0, part.size + 1, 3) for part in cells])


def write_vtkhdf(
    path: Path, kind: str, pieces: list[Piece], times: tuple[float, ...], vectors: Any
) -> None:
    """Write partitions of a mesh as VTKHDF, with the velocity of a function at some times."""
    import h5py

    points = [piece[0] for piece in pieces]
    cells = [piece[1] for piece in pieces]
    every = np.concatenate(points)
    zeros = np.zeros(len(times), "i8")
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = (2, 2)
        root.attrs.create("Type", np.bytes_(kind))
        root["Points"] = every
        root["NumberOfPoints"] = [len(part) for part in points]
        root["PointData/velocity"] = np.concatenate([vectors(every, time) for time in times])
        if kind == "PolyData":
            none = [np.zeros((0, 3), "i8")] * len(cells)
            for name in ("Vertices", "Lines", "Polygons", "Strips"):
                _write_cells(root.create_group(name), cells if name == "Polygons" else none)
        else:
            _write_cells(root, cells)
            root["Types"] = np.full(sum(map(len, cells)), VTK_TRIANGLE, "u1")
        if len(times) == 1:
            return
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = len(times)
        steps["Values"] = np.asarray(times)
        steps["NumberOfParts"] = zeros + len(pieces)
        steps["PartOffsets"] = steps["PointOffsets"] = zeros
        columns = 4 if kind == "PolyData" else 1
        for name in ("CellOffsets", "ConnectivityIdOffsets"):
            steps[name] = np.zeros((len(times), columns), "i8")
        steps["PointDataOffsets/velocity"] = np.arange(len(times)) * len(every)
