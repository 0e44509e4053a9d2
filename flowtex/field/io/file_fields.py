"""From a file, or several that belong together, to a field: of a mesh, or of data of the Earth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from flowtex.errors import FieldError
from flowtex.field.datasets.files import common_name, dataset_paths, open_datasets
from flowtex.field.datasets.pairs import two_names
from flowtex.field.io.files import read_file
from flowtex.field.io.reader_errors import errors_of_file

__all__ = ["field_of_file"]


def field_of_file(
    kind: Any,
    path: str | Path | Sequence[str | Path],
    vectors: str | None,
    time: float | str | None,
    of_meshes: Mapping[str, Any],
    of_earth: Mapping[str, Any],
) -> Any:
    """Make a field; :meth:`FlowField.from_file` has the parameters, here sorted by their kind.

    ``kind`` is that class.
    """
    paths = dataset_paths(path)
    first = paths[0] if paths else path
    with errors_of_file(first if isinstance(first, (str, Path)) else "several files"):
        if paths:
            _refuse(of_meshes, "meshes, and this is data of the Earth")
            choices = {name: value for name, value in of_earth.items() if value is not None}
            if time is not None:
                choices["sel"] = {**choices.get("sel", {}), "time": time}
            names: dict[str, Any] = two_names(vectors)
            name = common_name(paths)
            return kind.from_xarray(open_datasets(paths), **names, **choices, name=name)
        _refuse(of_earth, "data of the Earth, and this is a mesh")
        if not isinstance(path, (str, Path)):
            msg = f"{len(path)} files are given, and a mesh is read from one; name one of them"
            raise FieldError(msg)
        if isinstance(time, str):
            msg = f"time is {time!r}; expected a number, one of the times of the file"
            raise FieldError(msg)
        options = {name: of_meshes[name] for name in ("periodic", "sign_free")}
        arguments = read_file(path, time=time, vectors=vectors, **of_meshes)
        return kind._of_mesh(arguments, Path(path).stem, options)


def _refuse(choices: Mapping[str, Any], what: str) -> None:
    if given := [name for name, value in choices.items() if value not in (None, False)]:
        msg = f"{', '.join(given)} is for {what}; leave it out"
        raise FieldError(msg)
