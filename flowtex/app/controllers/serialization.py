"""The state of a page as text: as a link, and back, and as the lines of Python that draw it.

The state is a mapping with the names below, each of which may be missing::

    file vectors plane block   which flow: names as a library has them; k=20 or x=0.5
    time clock                 the field's own time; seconds of the streaming
    colour cmap clim           scalar, colour map, and the values at its ends
    log_scale opacity          as :class:`flowtex.scene.options.Appearance` has them
    coastlines graticule       whether these lines of a map are drawn
    settings                   a mapping of settings by name
    camera                     as :meth:`flowtex.rendering.camera.Camera.to_dict` has it
    theme background split     as the page names them
    time_beside beside_file    contents of the second view, depending on split
    beside                     of another file: vectors, plane, block, time and scalars; no link
                               has it, for it follows from the rest

A link holds what differs from the defaults, as a query that people can read. Numbers come back
exactly. A link may come from anybody: what is unknown or out of range is left out, and reported.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl, quote, urlencode

from flowtex._util.arguments import brief
from flowtex._util.written import NUMBER, Form, UnreadableError
from flowtex.app.controllers.appearance import (
    ANOTHER_FILE,
    ANOTHER_TIME,
    BACKGROUNDS,
    COLOUR_BY,
    COMPARISONS,
    LOOK,
    PLAIN,
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
from flowtex.settings import TABLE, SettingsError
from flowtex.sources.open_source import OUTER
from flowtex.sources.opening.dataset_files import is_dataset_file

#: Values that a link leaves out.
DEFAULTS: dict[str, Any] = {
    "clock": 0.0,
    "colour": "speed",
    **look_shown(Look()),
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

#: Longest line of Python.
LINE_LENGTH = 88
#: Arguments of ``FlowField.from_file``.
FILE_ARGUMENTS = ("vectors", "plane", "block")
#: Their names for data of the Earth.
OF_DATASETS = {"block": "projection"}
#: Form of a plane in a link.
PLANE = re.compile(r"[A-Za-z]\w{0,59}=\d{1,9}|[xyz]=-?[\d.]{1,16}(e[-+]?\d{1,3})?", re.ASCII)
#: Form of the name of a colour map in a link.
CMAP = re.compile(r"[A-Za-z]\w{0,59}", re.ASCII)


def to_link(state: State) -> str:
    """Return a state as the query of a link, such as ``plane=k=20&lod=off``, without defaults."""
    pairs = [
        (name, form.write(state[name]))
        for name, form in _FORMS.items()
        if state.get(name) is not None and state[name] != DEFAULTS.get(name)
    ]
    for name, value in (state.get("settings") or {}).items():
        if name not in TABLE:
            raise SettingsError(
                f"the setting {name!r} of a link does not exist; expected one of: "
                f"{', '.join(TABLE)}"
            )
        # An image is a person's own; a link has no room for it.
        if value not in (TABLE[name].default, "image"):
            pairs.append((name, TABLE[name].format(value)))
    return urlencode(pairs, safe=",:/=", quote_via=quote)


def from_link(text: str, faults: list[str] | None = None) -> dict[str, Any]:
    """Return the checked values of a link; ``faults`` gets a sentence for each invalid part."""
    messages: list[str] = [] if faults is None else faults
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
_SPLIT = _one_of(*COMPARISONS, ANOTHER_TIME, ANOTHER_FILE)
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
    "split": Form(read=lambda text: (NAME if text.startswith(COLOUR_BY) else _SPLIT).read(text)),
    "time_beside": NUMBER,
    "beside_file": NAME,
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
    picture: str | None = None,
) -> str:
    """Return the lines of Python that draw a state again, where its file is available.

    A window is opened, or a picture written to a file. ``source`` and ``source_beside`` are
    expressions that make the fields of the two views where they are not those of files, such as
    ``"flowtex.examples.cylinder_field()"``.
    """
    fields = {"field": source or _from_file(state)}
    panes: list[State] = [{}]
    if (split := state.get("split") or "nothing") == ANOTHER_FILE:
        if name := state.get("beside_file"):
            beside = {"time": None, **(state.get("beside") or {})}
            fields["field_beside"] = source_beside or _from_file({**beside, "file": name})
            differences = {n: beside[n] for n in ("time", "scalars") if n in beside}
            panes.append({**differences, "field": "field_beside"})
    elif split != "nothing":
        panes.append(comparison(split, state.get("time_beside") or 0.0))
    window = [f"window_size={list(size)!r}"]
    window += ["off_screen=True"] if picture is not None else []
    window += ["shape=(1, 2)", "border=False"] if len(panes) > 1 else []
    lines = ["import pyvista as pv", "", "import flowtex", ""]
    lines += [f"{name} = {expression}" for name, expression in fields.items()]
    lines += [_call("pl = pv.Plotter", window)]
    for column, different in enumerate(panes):
        lines += [f"pl.subplot(0, {column})"] if len(panes) > 1 else []
        lines += _add_lines(state, different)
    lines += ["pl.link_views()", "pl.subplot(0, 0)"] if len(panes) > 1 else []
    background = str(state.get("background", DEFAULTS["background"]))
    if background == DEFAULTS["background"]:
        background = THEMES[str(state.get("theme", DEFAULTS["theme"]))]
    lines.append(f"pl.set_background({_literal(background)})")
    if camera := state.get("camera"):
        lines.append(f"pl.camera.parallel_projection = {bool(camera['parallel'])!r}")
        for name in ("position", "focal_point", "up", "parallel_scale", "view_angle"):
            value = camera[name]
            plain = float(value) if isinstance(value, (int, float)) else tuple(map(float, value))
            lines.append(f"pl.camera.{name} = {plain!r}")
    lines.append("pl.show()" if picture is None else f"pl.screenshot({_literal(picture)})")
    return "\n".join(lines) + "\n"


def _from_file(state: State) -> str:
    if not state.get("file"):
        raise FieldError(
            "the state has no file; pass the expression that makes its field as source"
        )
    values = {name: state[name] for name in FILE_ARGUMENTS if state.get(name)}
    axis, _, number = values.get("plane", "").partition("=")
    if is_dataset_file(Path(str(state["file"]))):
        values.pop("plane", None)
        values = {OF_DATASETS.get(name, name): value for name, value in values.items()}
        values |= {"isel": {axis: int(number)}} if number.isdecimal() else {}
    elif axis in ("x", "y", "z", OUTER):
        plane = values.pop("plane")
        values |= {} if axis == OUTER else {"slice": plane}
    choices = [f"{name}={_literal(value)}" for name, value in values.items()]
    return _call("flowtex.FlowField.from_file", [_literal(state["file"]), *choices])


def _literal(value: object) -> str:
    """Return a value as a literal with double quotes."""
    text = repr(value)
    plain = isinstance(value, str) and text[0] == "'" and '"' not in text and "\\" not in text
    return f'"{text[1:-1]}"' if plain else text


def _call(function: str, arguments: list[str]) -> str:
    """Return a call on one line, or with a line for each argument where it is long."""
    line = f"{function}({', '.join(arguments)})"
    if len(line) <= LINE_LENGTH:
        return line
    return "\n".join([f"{function}(", *(f"    {argument}," for argument in arguments), ")"])


def _add_lines(state: State, different: State) -> list[str]:
    """Return the lines that add the flow to a view, with settings other than the defaults."""
    colour = state.get("colour", DEFAULTS["colour"])
    appearance = {"scalars": False if colour == PLAIN else colour}
    if colour != PLAIN:
        appearance |= {name: state[name] for name in ("cmap", "clim") if state.get(name)}
    others = (name for name in LOOK if name not in ("cmap", "clim"))
    appearance |= {n: state[n] for n in others if state.get(n) not in (None, DEFAULTS[n])}
    if "scalars" in different:  # with its own range
        appearance = {**appearance, "scalars": different["scalars"]}
        appearance.pop("clim", None)
    settings = {**(state.get("settings") or {}), **different}
    state = {**state, "time": settings.pop("time", state.get("time"))}
    settings.pop("scalars", None)
    field = settings.pop("field", "field")
    if settings.get("noise") == "image":  # the image is not in the state
        del settings["noise"]
    changed = {k: v for k, v in settings.items() if v != TABLE[k].default}
    arguments = [f"{name}={_literal(value)}" for name, value in {**appearance, **changed}.items()]
    lines = [_call("handle = pl.flowtex.add", [field, *arguments])]
    instants = [(name, state.get(name)) for name in ("time", "clock")]
    changes = [(n, v) for n, v in instants if v is not None and v != DEFAULTS.get(n)]
    return lines + [f"handle.{name} = {value!r}" for name, value in changes]
