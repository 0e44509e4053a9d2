"""The state of a page as the text of a link, and back.

What a page shows is a mapping with the names below, each of which may be missing::

    file vectors plane block   which flow: names as a library has them, and a plane such as k=20
    time clock                 the field's own time; seconds of the streaming
    colour cmap clim           scalar, colour map, and the values at its ends
    settings                   a mapping of settings by name
    camera                     position, focal_point, up, parallel, parallel_scale, view_angle
    theme background split     as the page names them

A link holds what differs from the defaults, as a query that people can read. Numbers come back
exactly. A link may come from anybody: what is unknown or out of range is left out and told.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import Any
from urllib.parse import parse_qsl, quote, urlencode

from flowtex.app.controllers.look import BACKGROUNDS, COMPARISONS
from flowtex.settings import TABLE, Setting, SettingsError

__all__ = ["DEFAULTS", "from_link", "to_link"]

#: Values that a link leaves out.
DEFAULTS: dict[str, Any] = {
    "clock": 0.0,
    "colour": "speed",
    "cmap": "viridis",
    "theme": "dark",
    "background": BACKGROUNDS[0],
    "split": "nothing",
}
#: Characters and values of a link, and characters of a name, at most.
LONGEST, MOST_VALUES, LONGEST_NAME = 8_000, 100, 400
#: What is the page's own and no part of its state.
NOT_OURS = ("secret",)

#: Parts of a camera: how many numbers, in the order of the link.
CAMERA = {"position": 3, "focal_point": 3, "up": 3, "parallel_scale": 1, "view_angle": 1}
PLANE, CMAP = re.compile(r"[ijk]=\d{1,9}"), re.compile(r"[A-Za-z]\w{0,59}", re.ASCII)


class _Fault(ValueError):
    """A value of a link is of no use; the text says what was expected."""


def to_link(state: Mapping[str, Any]) -> str:
    """Return a state as the text of a link.

    Parameters
    ----------
    state
        What a page shows; values that are ``None`` or defaults are left out.

    Returns
    -------
    str
        A query such as ``file=post.vtk&plane=k=20&lod=off``, for behind a ``?`` or a ``#``;
        empty where everything is as by default.

    Raises
    ------
    SettingsError
        When there is no setting of a name.
    """
    pairs = [
        (name, _WRITE.get(name, str)(state[name]))
        for name in _READ
        if state.get(name) is not None and state[name] != DEFAULTS.get(name)
    ]
    for name, value in (state.get("settings") or {}).items():
        if name not in TABLE:
            msg = f"there is no setting {name!r} to put in a link; there are: {', '.join(TABLE)}"
            raise SettingsError(msg)
        # An image is a person's own; a link has no room for it.
        if value not in (TABLE[name].default, "image"):
            pairs.append((name, _setting_text(TABLE[name], value)))
    return urlencode(pairs, safe=",:/=", quote_via=quote)


def from_link(text: str, faults: list[str] | None = None) -> dict[str, Any]:
    """Return the state that a link holds; defaults are not filled in.

    Parameters
    ----------
    text
        A link, or the part of it behind the ``?`` or the ``#``.
    faults
        Takes a sentence for each part of the link that is of no use and was left out.

    Returns
    -------
    dict
        A state of which every value has been checked. Names of files and arrays are as they
        were given: whether there are such is for whoever opens them to find out.
    """
    told: list[str] = [] if faults is None else faults
    state: dict[str, Any] = {}
    for name, value in _pairs(text, told):
        try:
            if name in _READ:
                state[name] = _READ[name](value)
            elif name in TABLE:
                checked = TABLE[name].check(_setting_value(TABLE[name], value))
                state.setdefault("settings", {})[name] = checked
            elif name not in NOT_OURS:
                told.append(f"the link says {_short(name)}, which means nothing here")
        except _Fault as fault:
            told.append(f"the link's {name} is {_short(value)}; expected {fault}")
        except SettingsError as fault:
            told.append(f"in the link {fault}")
    return state


def _pairs(text: str, faults: list[str]) -> list[tuple[str, str]]:
    """Take a link apart."""
    query = re.split(r"[?#]", text)[-1]
    if len(query) > LONGEST:
        faults.append(f"the link has {len(query):,} characters; expected {LONGEST:,} at most")
        return []
    try:
        return parse_qsl(query, max_num_fields=MOST_VALUES)
    except ValueError:
        faults.append(f"the link has too many values; expected {MOST_VALUES} at most")
        return []


def _short(text: str) -> str:
    return repr(text if len(text) <= 60 else f"{text[:57]}...")


def _name(text: str) -> str:
    if not text.isprintable() or len(text) > LONGEST_NAME:
        msg = f"a name of at most {LONGEST_NAME} characters that can be printed"
        raise _Fault(msg)
    return text


def _matching(pattern: re.Pattern[str], expected: str) -> Callable[[str], str]:
    def read(text: str) -> str:
        if not pattern.fullmatch(text):
            raise _Fault(expected)
        return text

    return read


def _one_of(*choices: str) -> Callable[[str], str]:
    def read(text: str) -> str:
        if text not in choices:
            raise _Fault(" or ".join(map(repr, choices)))
        return text

    return read


def _number(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        msg = "a number"
        raise _Fault(msg)
    return value


def _numbers(text: str, count: int) -> list[float]:
    words = text.split(",")
    if len(words) != count:
        msg = f"{count} numbers with commas between them"
        raise _Fault(msg)
    return [_number(word) for word in words]


def _span(text: str) -> tuple[float, float]:
    low, high = _numbers(text, 2)
    if not low < high:
        msg = "a lower number and a higher one"
        raise _Fault(msg)
    return low, high


def _span_text(span: Any) -> str:
    return ",".join(repr(float(end)) for end in span)


def _camera(text: str) -> dict[str, Any]:
    """Read a camera that sees something."""
    kind, _, rest = text.partition(",")
    numbers = iter(_numbers(rest, sum(CAMERA.values())))
    camera: dict[str, Any] = {"parallel": kind == "parallel"}
    for part, count in CAMERA.items():
        values = [next(numbers) for _ in range(count)]
        camera[part] = values if count > 1 else values[0]
    way = [f - p for p, f in zip(camera["position"], camera["focal_point"], strict=True)]
    sees = math.hypot(*way) > 0 and math.hypot(*_cross(way, camera["up"])) > 0
    fits = camera["parallel_scale"] > 0 and 0 < camera["view_angle"] < 180
    if not (kind in ("parallel", "perspective") and sees and fits):
        msg = "a camera that looks at something"
        raise _Fault(msg)
    return camera


def _cross(a: list[float], b: list[float]) -> list[float]:
    return [a[n - 2] * b[n - 1] - a[n - 1] * b[n - 2] for n in range(3)]


def _camera_text(camera: Mapping[str, Any]) -> str:
    numbers: list[float] = []
    for part, count in CAMERA.items():
        numbers += camera[part] if count > 1 else [camera[part]]
    kind = "parallel" if camera["parallel"] else "perspective"
    return ",".join([kind, *(repr(float(number)) for number in numbers)])


def _setting_text(row: Setting, value: Any) -> str:
    if row.kind is bool:
        return "on" if value else "off"
    return repr(float(value)) if row.kind is float else str(value)


def _setting_value(row: Setting, text: str) -> Any:
    """Take a setting from its text; what cannot be read is left for the row to refuse."""
    if row.kind is bool:
        return {"on": True, "off": False}.get(text, text)
    if row.kind is str:
        return text
    try:
        return float(text)
    except ValueError:
        return text


#: How each name is read, in the order of a link, and how it is written.
_READ: dict[str, Callable[[str], Any]] = {
    "file": _name,
    "block": _name,
    "vectors": _name,
    "plane": _matching(PLANE, "an axis and a number, such as k=20"),
    "time": _number,
    "clock": _number,
    "colour": _name,
    "cmap": _matching(CMAP, "the name of a colour map, such as viridis"),
    "clim": _span,
    "theme": _one_of("dark", "light"),
    "background": _one_of(*BACKGROUNDS),
    "split": _one_of(*COMPARISONS),
    "camera": _camera,
}
_WRITE: dict[str, Callable[[Any], str]] = {
    "time": lambda value: repr(float(value)),
    "clock": lambda value: repr(float(value)),
    "clim": _span_text,
    "camera": _camera_text,
}
