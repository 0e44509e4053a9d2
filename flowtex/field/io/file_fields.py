"""What a field needs from a file, or several that belong together: of a mesh, or of the Earth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from flowtex.errors import FieldError
from flowtex.field.datasets.files import common_name, dataset_paths, open_datasets
from flowtex.field.datasets.pairs import two_names
from flowtex.field.datasets.read import read_datasets
from flowtex.field.datasets.regions import Regions
from flowtex.field.io.arrays import GridArrays, TriangleArrays
from flowtex.field.io.files import read_file
from flowtex.field.io.reader_errors import errors_of_file

#: Arguments that are for meshes; the others are for data of the Earth.
OF_MESHES = ("plane", "slice", "contour", "block", "periodic", "sign_free")


def read_files(
    path: str | Path | Sequence[str | Path],
    *,
    vectors: str | None = None,
    time: float | str | None = None,
    regions: bool = False,
    **options: Any,
) -> GridArrays | TriangleArrays | Regions:
    """Read what a field needs; :meth:`FlowField.from_file` has the parameters.

    ``regions`` is that of :func:`~flowtex.field.datasets.read.read_datasets`. Whatever this raises
    is to be named by :func:`errors_of`.
    """
    paths = dataset_paths(path)
    of_meshes = {name: options.pop(name) for name in OF_MESHES if name in options}
    chosen = {name: value for name, value in options.items() if value is not None}
    if paths:
        _refuse(of_meshes, "meshes, and this is data of the Earth")
        if time is not None:
            chosen["sel"] = {**chosen.get("sel", {}), "time": time}
        chosen |= {**two_names(vectors), "name": common_name(paths), "regions": regions}
        return read_datasets(open_datasets(paths), **chosen)
    _refuse(chosen, "data of the Earth, and this is a mesh")
    if not isinstance(path, (str, Path)):
        msg = f"{len(path)} files are given, and a mesh is read from one; name one of them"
        raise FieldError(msg)
    if isinstance(time, str):
        msg = f"time is {time!r}; expected a number, one of the times of the file"
        raise FieldError(msg)
    return read_file(path, time=time, vectors=vectors, **of_meshes)


def errors_of(path: str | Path | Sequence[str | Path]) -> AbstractContextManager[None]:
    """Name a file, or the first of several, in what goes wrong until a field is made of it."""
    paths = dataset_paths(path)
    first = paths[0] if paths else path
    return errors_of_file(first if isinstance(first, (str, Path)) else "several files")


def _refuse(choices: Mapping[str, Any], what: str) -> None:
    if given := [name for name, value in choices.items() if value not in (None, False)]:
        msg = f"{', '.join(given)} is for {what}; leave it out"
        raise FieldError(msg)
