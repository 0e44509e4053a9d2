"""Arguments of public functions: common checks, and suggestions for misspelt names."""

from __future__ import annotations

import difflib
import functools
import math
import os
import stat
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError

#: Names that other packages give to arguments, and those of ours.
SYNONYMS = {
    **dict.fromkeys(("vmin", "vmax", "range"), "clim"),
    **dict.fromkeys(("colormap", "palette", "cm"), "cmap"),
    **dict.fromkeys(("normal", "plane_normal", "cut", "origin"), "slice"),
    **dict.fromkeys(("variables", "vector", "velocity"), "vectors"),
    **dict.fromkeys(("scalar", "color_by", "field"), "scalars"),
    **dict.fromkeys(("depth", "height", "lev", "altitude"), "level"),
    **dict.fromkeys(("fixed_points", "equilibria"), "critical_points"),
    **{"alpha": "opacity", "duration": "seconds", "bgcolor": "background", "crs": "projection"},
}
_LENGTH = "a streak has samples times spacing grains, as in samples=49, spacing=0.7"
_LEGEND = (
    "show_scalar_bar=True draws a legend of the colours, annotations=True one with scale and time; "
    "on axes of matplotlib use plt.colorbar(image)"
)
_PART = "all times of the data are drawn; time=5 draws one of them"
#: What is reached in another way than by an argument of the same kind.
ELSEWHERE = {
    **dict.fromkeys(("length", "streak_length", "streaklength", "line_length"), _LENGTH),
    **dict.fromkeys(("colorbar", "cbar", "legend"), _LEGEND),
    **dict.fromkeys(("start", "stop", "end"), _PART),
    **dict.fromkeys(
        ("quiet", "silent", "verbose"),
        "in a shell send the output to /dev/null, in Python use warnings.simplefilter('ignore')",
    ),
    "group": "give the path of the group in the file, such as 'model.nc/ocean'",
    "transform": (
        "it is not needed: longitudes and latitudes in the data are recognised, and "
        'projection="north" chooses the map'
    ),
    "duration": "the length of a movie is seconds=5",
    "title": "pictures have none; on axes of matplotlib use ax.set_title",
}
#: Longest value that is written in a message, in letters.
LONGEST_SHOWN = 100


def brief(value: Any) -> str:
    """Return a value as a message writes it: on one line, and cut where it is long."""
    text = " ".join(repr(value).split())
    return text if len(text) <= LONGEST_SHOWN else f"{text[: LONGEST_SHOWN - 3]}..."


def is_number(value: Any) -> bool:
    """Return whether a value is one real number, not NaN, a string or a boolean."""
    try:
        return not isinstance(value, (bool, str, bytes)) and float(value) == float(value)
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
    """Return up to two names that a text stands for, begins, as "proj" does, or resembles."""
    synonym = SYNONYMS.get(name.replace("-", "_"), "")
    if synonyms := [each for each in names if each.replace("-", "_") == synonym]:
        return synonyms
    begun = [candidate for candidate in names if len(name) > 2 and candidate.startswith(name)]
    return begun[:2] or difflib.get_close_matches(name, names, n=2)


def elsewhere(name: str, names: Sequence[str]) -> str:
    """Return how else to reach what a name stands for, if none of these names is an argument."""
    name = name.replace("-", "_")
    return "" if SYNONYMS.get(name) in names else ELSEWHERE.get(name, "")


def near_names(name: str, known: Iterable[str], usual: Iterable[str] = ()) -> str:
    """Return known names that resemble a text, or a list of them; of many the ``usual`` ones."""
    names, examples = tuple(known), ", ".join(usual)
    if close := closest(name, names):
        return f"did you mean {' or '.join(map(repr, close))}?"
    if examples:
        return f"expected one of {len(names)} names, such as {examples}"
    return f"expected one of: {', '.join(names)}" if names else "expected none: there are no names"


Function = TypeVar("Function", bound=Callable[..., Any])


def sized(function: Function) -> Function:
    """Return a function whose ``size`` may be given as ``window_size``, as in PyVista."""

    @functools.wraps(function)
    def call(*args: Any, window_size: Any = None, **options: Any) -> Any:
        if window_size is not None and "size" in options:
            raise FieldError(
                f"size is {options['size']!r} and window_size is {window_size!r}; omit one of them"
            )
        return function(*args, **options, **({"size": window_size} if window_size else {}))

    return call  # type: ignore[return-value]
