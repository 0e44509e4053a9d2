"""Readers of VTK in a separate process, for formats whose damaged files crash VTK.

A mesh comes back as the content of a legacy VTK file, which is checked as such a file is. So wrong
memory in the other process is an error, or a mesh that is whole.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.child.child import Child, ChildError
from flowtex._util.child.worker import Answer
from flowtex.errors import FieldError, notify
from flowtex.sources.inspection.vtk_legacy import check_vtk_legacy
from flowtex.sources.reader_errors import errors_of_file

if TYPE_CHECKING:
    import pyvista as pv

#: Time limit of a request in seconds.
REQUEST_TIMEOUT_S = 60.0
#: Bytes of a file that extend the limit by a second.
BYTES_PER_S = 10e6
#: Endings of the formats that are read so. A few bytes of text crash their readers.
SUFFIXES = (
    ".case",
    ".dem",
    ".inp",
    ".nek5000",
    ".neu",
    ".p3d",
    ".pts",
    ".res",
    ".segy",
    ".sgy",
)
HANDLER = "flowtex.sources.meshes.separate:Handler"
PRELOAD = ("flowtex.sources.meshes.separate", "pyvista", "vtkmodules.vtkIOEnSight")
#: Kinds of arrays of a mesh that VTK marks as the active ones.
ACTIVE = ("Scalars", "Vectors")
#: Number of a mesh among arrays with the names of its active ones, blocks by name, or nothing.
Tree: TypeAlias = Any


def time_limit(nbytes: int) -> float:
    """Return the most seconds for a request to a process that reads a file of a size."""
    return REQUEST_TIMEOUT_S + nbytes / BYTES_PER_S


def end_of_reader(child: Child, error: ChildError) -> str:
    """Return the text of an error for a process that ended while it read a file."""
    memory = f"{child.memory / 1e9:.1f} GB of memory"
    return f"the reader of this file {error}; it is damaged, or needs more than {memory}"


class SeparateReader:
    """Reads a file in another process, and has what is used of PyVista's readers.

    Parameters
    ----------
    path : Path
        The file.
    nbytes : int
        Size of all its files in bytes, which extends the time limit.

    Raises
    ------
    FieldError
        For a file that VTK cannot read, or that crashes VTK or takes it too long.
    """

    def __init__(self, path: Path, nbytes: int) -> None:
        self._path = path.absolute()
        self._timeout = time_limit(nbytes)
        self._child = _start()
        #: Times of the file; empty if it has none.
        self.time_values: list[float] = self._ask("times", None)[0]
        self.active_time_value = 0.0
        if self.time_values:
            self.active_time_value = self.time_values[0]

    def set_active_time_value(self, time: float) -> None:
        """Set the time to read."""
        self.active_time_value = time

    def read(self) -> pv.DataObject:
        """Read the mesh, or its blocks, at the active time."""
        time = None
        if self.time_values:
            time = self.active_time_value
        tree, arrays = self._ask("read", time)
        return _unpacked(tree, arrays)

    def _ask(self, do: str, time: float | None) -> tuple[Any, list[AnyArray]]:
        if not self._child.alive:
            self._child = _start()
        request = {"do": do, "path": str(self._path), "time": time}
        try:
            answer, arrays = self._child.request(request, timeout=self._timeout)
        except ChildError as error:
            if error.kind:
                raise FieldError(str(error).removeprefix(f"{self._path}: ")) from error
            raise FieldError(end_of_reader(self._child, error)) from error
        for text in answer["warnings"]:
            notify(str(text), UserWarning)
        return answer["value"], arrays


def _start() -> Child:
    return Child(HANDLER, preload=PRELOAD)


class Handler:
    """Answers the requests of a :class:`SeparateReader`."""

    def __init__(self) -> None:
        self._reader: Any = None

    def __call__(self, request: dict[str, Any]) -> Answer:
        """Return the times of a file, or the mesh at one of them."""
        action: Callable[[float | None], Answer] = self._times
        if request["do"] == "read":
            action = self._read
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            with errors_of_file(request["path"]):
                self._open(request["path"])
                value, arrays = action(request["time"])
        texts = []
        for warning in caught:
            if issubclass(warning.category, UserWarning):
                texts.append(str(warning.message))
        return {"value": value, "warnings": texts}, arrays

    def _open(self, path: str) -> None:
        import pyvista as pv

        if self._reader is None:
            self._reader = pv.get_reader(path)

    def _times(self, _: float | None) -> Answer:
        times = getattr(self._reader, "time_values", None) or []  # not all formats have times
        return list(map(float, times)), []

    def _read(self, time: float | None) -> Answer:
        if time is not None:
            self._reader.set_active_time_value(time)
        arrays: list[AnyArray] = []
        return _packed(self._reader.read(), arrays), arrays


def _packed(mesh: Any, arrays: list[AnyArray]) -> Tree:
    """Append the meshes of a tree of blocks to arrays, and return the tree."""
    import pyvista as pv

    if mesh is None:
        return None
    if isinstance(mesh, pv.MultiBlock):
        named = zip(mesh.keys(), mesh, strict=True)
        return {"blocks": [[name, _packed(block, arrays)] for name, block in named]}
    bare = mesh.copy(deep=False)
    active = []
    for data in (bare.GetPointData(), bare.GetCellData()):
        names = []
        for kind in ACTIVE:
            array = getattr(data, f"Get{kind}")()
            names.append(array and array.GetName())
            # Written apart from others, it would change its place among them.
            data.SetActiveAttribute(-1, getattr(data, kind.upper()))
        active.append(names)
    arrays.append(_written(bare))
    return {"mesh": len(arrays) - 1, "active": active}


def _written(mesh: Any) -> AnyArray:
    """Return the bytes of a mesh in VTK's legacy format."""
    from vtkmodules.vtkIOLegacy import vtkDataSetWriter

    writer = vtkDataSetWriter()
    writer.SetInputData(mesh)
    writer.SetFileTypeToBinary()
    writer.WriteToOutputStringOn()
    writer.Write()
    # VTK returns a text where the bytes happen to be one.
    content: str | bytes = writer.GetOutputStdString()
    if isinstance(content, str):
        content = content.encode()
    return np.frombuffer(content, np.uint8)


def _unpacked(tree: Tree, arrays: list[AnyArray]) -> Any:
    """Return the mesh, or the blocks, of a tree."""
    import pyvista as pv
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkMultiBlockDataSet

    if tree is None:
        return None
    if "mesh" in tree:
        return _mesh(arrays[tree["mesh"]].tobytes(), tree["active"])
    blocks = vtkMultiBlockDataSet()
    for number, (name, block) in enumerate(tree["blocks"]):
        blocks.SetBlock(number, _unpacked(block, arrays))
        if name is not None:
            blocks.GetMetaData(number).Set(vtkCompositeDataSet.NAME(), name)
    return pv.wrap(blocks)


def _mesh(content: bytes, active: list[list[str | None]]) -> Any:
    import pyvista as pv
    from vtkmodules.vtkCommonCore import vtkCharArray
    from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader

    check_vtk_legacy(content)
    characters = vtkCharArray()
    characters.SetVoidArray(content, len(content), 1)
    reader = vtkGenericDataObjectReader()
    reader.ReadFromInputStringOn()
    reader.SetInputArray(characters)
    reader.Update()
    mesh = pv.wrap(reader.GetOutput())
    for data, names in zip((mesh.GetPointData(), mesh.GetCellData()), active, strict=True):
        for kind, name in zip(ACTIVE, names, strict=True):
            if name is not None:
                getattr(data, f"SetActive{kind}")(name)
    return mesh
