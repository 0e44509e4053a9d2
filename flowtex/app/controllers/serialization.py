"""Conversion of the state of a page to a link and back, and to Python code that draws it.

The state is a mapping with the names of ``_FORMS`` below, all optional, and ``settings`` by name.
A link contains the differences from the defaults as a readable query, and keeps numbers exactly.
A link may come from anybody, so flowtex omits and reports unknown and invalid values.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl, quote, urlencode

from flowtex._util.arguments import brief
from flowtex._util.written import NUMBER, Form, UnreadableError
from flowtex.app.controllers.appearance import (
    BACKGROUNDS,
    COLOUR_BY,
    COMPARISONS,
    FILE,
    LOOK,
    PLAIN,
    TIME,
    comparison,
    look_shown,
)
from flowtex.app.controllers.context import State
from flowtex.app.server.page import shortened
from flowtex.app.streaming.viewport import BACKGROUNDS as THEMES
from flowtex.errors import FieldError
from flowtex.rendering.camera import Camera
from flowtex.scene.forms import FORMS
from flowtex.scene.options import Appearance as Look
from flowtex.scene.options import default_cmap
from flowtex.settings import TABLE, SettingsError
from flowtex.sources.open_source import OUTER
from flowtex.sources.opening.dataset_files import is_dataset_file

#: Values that a link leaves out, with the default colour map of the scalar.
DEFAULTS: dict[str, Any] = {
    "clock": 0.0,
    "colour": "speed",
    **look_shown(Look.of()),
    "theme": "dark",
    "background": BACKGROUNDS[0],
    "split": "nothing",
}
#: Characters of a link, at most.
LINK_LENGTH = 8_000
#: Values of a link, at most.
MOST_VALUES = 100
#: Characters of a name, at most.
NAME_LENGTH = 400
#: Characters of a fault, at most.
FAULT_LENGTH = 250
#: Names in a link that are no part of the state.
IGNORED = ("secret",)

#: Arguments that select the part of a file.
FILE_ARGUMENTS = ("vectors", "plane", "block")
#: Form of a plane in a link.
PLANE = re.compile(r"[A-Za-z]\w{0,59}=\d{1,9}|[xyz]=-?[\d.]{1,16}(e[-+]?\d{1,3})?", re.ASCII)
#: Form of the name of a colour map in a link.
CMAP = re.compile(r"[A-Za-z]\w{0,59}", re.ASCII)


def _defaults_of(state: State) -> dict[str, Any]:
    """Return the values that a link of a state leaves out."""
    colour = state.get("colour", DEFAULTS["colour"])
    return {**DEFAULTS, "cmap": default_cmap(colour)}


def to_link(state: State, first: State | None = None) -> str:
    """Return a state as the query of a link, such as ``plane=k=20&lod=off``.

    It leaves out defaults, unless a new page shows another value.

    Parameters
    ----------
    state
        The state of a page.
    first
        The state with which a new page begins; the defaults if it is omitted.

    Raises
    ------
    SettingsError
        When the state has a setting that :data:`flowtex.settings.TABLE` lacks.
    """
    first = first or {}
    defaults = _defaults_of(state)
    first_settings = first.get("settings") or {}
    pairs = []
    for name, form in _FORMS.items():
        value = state.get(name)
        if value is None:
            continue
        if value != defaults.get(name) or value != first.get(name, value):
            pairs.append((name, form.write(value)))
    for name, value in (state.get("settings") or {}).items():
        if name not in TABLE:
            raise SettingsError(
                f"the setting {name!r} of a link does not exist; expected one of: "
                f"{', '.join(TABLE)}"
            )
        is_default = value == TABLE[name].default == first_settings.get(name, value)
        # An image is a person's own; a link has no room for it.
        if not is_default and value != "image":
            pairs.append((name, TABLE[name].format(value)))
    return urlencode(pairs, safe=",:/=", quote_via=quote)


def from_link(text: str, faults: list[str] | None = None) -> dict[str, Any]:
    """Return the checked values of a link; ``faults`` gets a sentence for each invalid part."""
    if faults is None:
        messages: list[str] = []
    else:
        messages = faults
    state: dict[str, Any] = {}
    for name, value in _pairs(text, messages):
        try:
            if name in _FORMS:
                state[name] = _FORMS[name].read(value)
            elif name in TABLE:
                state.setdefault("settings", {})[name] = TABLE[name].parse(value)
            elif name not in IGNORED:
                messages.append(f"the link has the unknown name {brief(name)}")
        except UnreadableError as fault:
            messages.append(f"the link's {name} is {brief(value)}; expected {fault}")
        except FieldError as fault:
            messages.append(f"error in the link: {shortened(str(fault), FAULT_LENGTH)}")
    return state


def _pairs(text: str, faults: list[str]) -> list[tuple[str, str]]:
    """Return names and values of the query of a link; none, and a fault, if it is too long."""
    query = re.split(r"[?#]", text)[-1]
    if len(query) > LINK_LENGTH:
        faults.append(f"the link has {len(query):,} characters; expected {LINK_LENGTH:,} at most")
        return []
    try:
        return parse_qsl(query, max_num_fields=MOST_VALUES)
    except ValueError:
        faults.append(f"the link has too many values; expected {MOST_VALUES} at most")
        return []


def _matching(pattern: re.Pattern[str], expected: str) -> Form:
    def read(text: str) -> str:
        if not pattern.fullmatch(text):
            raise UnreadableError(expected)
        return text

    return Form(read=read)


def _one_of(*choices: str) -> Form:
    pattern = re.compile("|".join(map(re.escape, choices)))
    return _matching(pattern, " or ".join(map(repr, choices)))


def _name(text: str) -> str:
    if not text.isprintable() or len(text) > NAME_LENGTH:
        raise UnreadableError(f"a name of at most {NAME_LENGTH} printable characters")
    return text


NAME = Form(read=_name)


def _split(text: str) -> str:
    """Return the name of a comparison, which must exist."""
    if text.startswith(TIME):
        NUMBER.read(text.removeprefix(TIME))
        return text
    if text.startswith((COLOUR_BY, FILE)):
        return NAME.read(text)
    return _one_of(*COMPARISONS).read(text)


#: How each name is read and written, in the order of a link.
_FORMS: dict[str, Form] = {
    "file": NAME,
    "block": NAME,
    "vectors": NAME,
    "plane": _matching(PLANE, "an axis and a number, such as k=20 or x=0.5"),
    "time": NUMBER,
    "clock": NUMBER,
    "colour": NAME,
    **{name: FORMS[name] for name in LOOK},
    "cmap": _matching(CMAP, "the name of a colour map, such as viridis"),
    "theme": _one_of(*THEMES),
    "background": _one_of(*BACKGROUNDS),
    "split": Form(read=_split),
    "camera": Form(
        read=lambda text: Camera.from_text(text).to_dict(),
        write=lambda camera: Camera.from_dict(camera).to_text(),
    ),
}


def to_python(
    state: State,
    *,
    source: str | None = None,
    source_beside: str | None = None,
    size: tuple[int, int] = (1024, 768),
) -> str:
    """Return the lines of Python that draw a picture of each view where its file is available.

    ``source`` and ``source_beside`` are expressions that make the fields of the two views where
    they are not those of files, such as ``"flowtex.examples.cylinder_field()"``.
    """
    split = state.get("split") or "nothing"
    lines = ["import flowtex", "", f"picture = {_render(state, source, size)}"]
    beside = comparison(split)
    if split.startswith(FILE):
        beside = {"file": split.removeprefix(FILE), "time": None}
        source = source_beside
    if beside:
        settings = {}
        for n, value in beside.items():
            if n in TABLE:
                settings[n] = value
        other = {**state, **beside, "settings": {**(state.get("settings") or {}), **settings}}
        if "scalars" in beside:  # with its own range
            other |= {"colour": beside["scalars"], "clim": None}
        lines.append(f"beside = {_render(other, source, size)}")
    return "\n".join([*lines, ""])


def _render(state: State, source: str | None, size: tuple[int, int]) -> str:
    """Return a call of :func:`flowtex.render` that draws what a state shows, as Python code."""
    values: dict[str, Any] = {}
    if source is None:
        if not state.get("file"):
            raise FieldError("the state has no file; pass the expression that makes its field")
        source = _literal(state["file"])
        values = _part(state)
    state_or_default = dict(DEFAULTS)
    for name, value in state.items():
        if value is not None:
            state_or_default[name] = value
    state = state_or_default
    defaults = _defaults_of(state)
    values |= {"size": size, "scalars": state["colour"]}
    if state["colour"] == PLAIN:
        values["scalars"] = False
    for name in (*LOOK, "time", "clock"):
        if state.get(name) != defaults.get(name):
            values[name] = state[name]
    values["background"] = state["background"]
    if state["background"] == DEFAULTS["background"]:
        values["background"] = THEMES[state["theme"]]
    if "camera" in state:
        values["camera"] = state["camera"]
    settings = state.get("settings", {})
    if settings.get("noise") != "image":  # the image is not in the state
        for name, value in settings.items():
            if value != TABLE[name].default:
                values[name] = value
    lines = ["flowtex.render(", f"    {source},"]
    for name, value in values.items():
        lines.append(f"    {name}={_literal(value)},")
    lines.append(")")
    return "\n".join(lines)


def _part(state: State) -> dict[str, Any]:
    """Return the part of the file that a state shows, as arguments of :func:`flowtex.render`."""
    values = {}
    for name in FILE_ARGUMENTS:
        if state.get(name):
            values[name] = state[name]
    axis, _, number = values.get("plane", "").partition("=")
    is_dataset = is_dataset_file(Path(str(state["file"])))
    if is_dataset and "block" in values:
        values["projection"] = values.pop("block")
    if is_dataset or axis in ("x", "y", "z", OUTER):
        plane = values.pop("plane", None)
        if is_dataset:
            if number.isdecimal():
                values["isel"] = {axis: int(number)}
        elif axis != OUTER:
            values["slice"] = plane
    return values


def _literal(value: object) -> str:
    text = repr(value)
    plain = isinstance(value, str) and text[0] == "'" and '"' not in text and "\\" not in text
    if plain:
        return f'"{text[1:-1]}"'
    return text
