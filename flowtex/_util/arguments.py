"""Arguments of public functions: common checks, and suggestions for misspelt names."""

from __future__ import annotations

import difflib
import math
import os
import stat
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError

#: Names that other packages give to arguments, and flowtex's names for them.
SYNONYMS = {
    **dict.fromkeys(("vmin", "vmax", "range"), "clim"),
    **dict.fromkeys(("colormap", "palette", "cm"), "cmap"),
    **dict.fromkeys(("normal", "plane_normal", "cut", "origin"), "slice"),
    **dict.fromkeys(("variables", "vector", "velocity"), "vectors"),
    **dict.fromkeys(("scalar", "color_by", "field"), "scalars"),
    **dict.fromkeys(("depth", "height", "lev", "altitude"), "level"),
    **dict.fromkeys(("fixed_points", "equilibria"), "critical_points"),
    **dict.fromkeys(("colorbar", "cbar", "legend"), "show_scalar_bar"),
    **dict.fromkeys(("length", "streak_length", "streaklength", "line_length"), "samples"),
    **dict.fromkeys(("window_size", "figsize", "width"), "size"),
    **{"alpha": "opacity", "duration": "seconds", "bgcolor": "background", "crs": "projection"},
}
#: What is accepted for the fields of a dataclass, by their declared type, and what errors expect.
ACCEPTED: dict[str, tuple[tuple[type, ...], str]] = {
    "str": ((str,), "a text"),
    "bool": ((bool, np.bool_), "True or False"),
    "str | bool": ((str, bool, np.bool_), "a name, True or False"),
    "int | str": ((int, np.integer, str), "a whole number or a text"),
    "float | str": ((int, float, np.number, str), "a number or a text"),
    "Mapping[str, str]": ((Mapping,), "a mapping of texts by name"),
    "Mapping[str, Any]": ((Mapping,), "a mapping by name"),
}
LONGEST_SHOWN = 100  #: Longest value that is written in a message, in letters.


def brief(value: Any) -> str:
    """Return a value as a message writes it: on one line, and cut where it is long."""
    text = " ".join(repr(value).split())
    if len(text) <= LONGEST_SHOWN:
        return text
    return f"{text[: LONGEST_SHOWN - 3]}..."


def check_types(values: Any) -> None:
    """Raise a FieldError for a field of a dataclass whose value has not the declared type.

    Fields whose types are not in :data:`ACCEPTED`, and values that are ``None``, are not checked.
    """
    for each in fields(values):
        value = getattr(values, each.name)
        accepted = ACCEPTED.get(str(each.type).removesuffix(" | None"))
        if value is None or accepted is None:
            continue
        types, expected = accepted
        if not isinstance(value, types):
            meaning = each.metadata.get("text", "").replace("``", "'")
            if meaning:
                expected = f"{expected}: {meaning}"
            raise FieldError(f"{each.name} is {brief(value)}; expected {expected}")


def is_number(value: Any) -> bool:
    """Return whether a value is one real number, not NaN, a string, a boolean or a list."""
    if isinstance(value, (bool, str, bytes)):
        return False
    try:
        return np.ndim(value) == 0 and float(value) == float(value)
    except (TypeError, ValueError, OverflowError):  # a whole number may have any size
        return False


def checked_number(
    name: str,
    value: Any,
    low: float = -math.inf,
    high: float = math.inf,
    *,
    expected: str,
    error: type[FieldError] = FieldError,
) -> float:
    """Return a number from ``low`` to ``high``; otherwise ``error`` names what was expected."""
    if not (is_number(value) and low <= value <= high):
        raise error(f"{name} is {brief(value)}; expected {expected}")
    return float(value)


def checked_count(
    name: str, value: Any, low: int = 1, high: float = math.inf, *, expected: str
) -> int:
    """Return a whole number from ``low`` to ``high``; a FieldError names what was expected."""
    number = checked_number(name, value, low, high, expected=expected)
    if not number.is_integer():
        raise FieldError(f"{name} is {brief(value)}; expected {expected}")
    return int(value)


def checked_flag(name: str, value: Any) -> bool:
    """Return True or False; a FieldError names the argument that has another value."""
    if not isinstance(value, (bool, np.bool_)):
        raise FieldError(f"{name} is {brief(value)}; expected True or False")
    return bool(value)


def checked_array(name: str, value: Any, *, expected: str) -> Floats:
    """Return real numbers of any shape; a FieldError names what was expected."""
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise FieldError(f"{name} is {brief(value)}; expected {expected}") from error


def checked_size(size: Any, low: int = 1) -> tuple[int, int]:
    """Return width and height in pixels, from ``low``."""
    expected = "width and height in pixels, such as (1024, 768)"
    sides = checked_array("size", size, expected=expected)
    if sides.shape != (2,) or not (sides >= low).all() or (sides % 1).any():
        raise FieldError(f"size is {brief(size)}; expected {expected}")
    return int(sides[0]), int(sides[1])


def are_paths(items: Iterable[object]) -> bool:
    """Return whether all items are paths, or texts."""
    return all(isinstance(item, (str, Path)) for item in items)


def checked_path(name: str, path: Any) -> Path:
    """Return a path as one of Python's."""
    if not isinstance(path, (str, os.PathLike)) or "\0" in str(path):
        raise FieldError(f"{name} is {brief(path)}; expected a path")
    return Path(path)


def checked_source(path: Any) -> Path:
    """Return the real path of a file or folder to read, which may be missing."""
    real = Path(os.path.realpath(checked_path("path", path).expanduser()))
    try:
        kind = stat.S_IFMT(real.stat().st_mode)
    except (FileNotFoundError, NotADirectoryError):
        return real
    except OSError as error:
        raise FieldError(f"{brief(str(path))}: cannot be opened ({error.strerror})") from error
    if kind not in (stat.S_IFREG, stat.S_IFDIR):
        raise FieldError(f"{path}: this is a pipe or a device; expected a file or a folder")
    return real


def checked_target(path: Any) -> Path:
    """Return the path of a file to write, whose folder must exist."""
    target = checked_path("path", path)
    if not target.parent.is_dir():
        folder = str(target.parent)
        raise FieldError(
            f"{target}: the folder {folder!r} does not exist; create it, or choose another"
        )
    return target


def check_field(field: Any, kind: type) -> None:
    """Raise a FieldError if ``field`` is not a field, an instance of ``kind``."""
    if not isinstance(field, kind):
        raise FieldError(
            f"field is {brief(field)}; expected a FlowField, such as FlowField.from_pyvista(mesh)"
        )


def closest(name: str, names: Sequence[str]) -> list[str]:
    """Return suggestions for an unknown name.

    They are its synonym, otherwise up to two names that begin with it, as ``projection`` does with
    ``proj``, otherwise up to two similar names.
    """
    if synonym := SYNONYMS.get(name.replace("-", "_")):
        found = []
        for each in names:
            if each.replace("-", "_") == synonym:
                found.append(each)
        return found
    begun = []
    for candidate in names:
        if len(name) > 2 and candidate.startswith(name):
            begun.append(candidate)
    return begun[:2] or difflib.get_close_matches(name, names, n=2)


def near_names(name: str, known: Iterable[str], usual: Iterable[str] = ()) -> str:
    """Return known names that resemble a text, or a list of them; of many the ``usual`` ones."""
    names = tuple(known)
    examples = ", ".join(usual)
    if close := closest(name, names):
        return f"did you mean {' or '.join(map(repr, close))}?"
    if examples:
        return f"expected one of {len(names)} names, such as {examples}"
    if names:
        return f"expected one of: {', '.join(names)}"
    return "there are none"
