"""Flags of the command line: of the file, the picture, the page, and the settings.

Most are made from option classes such as :class:`flowtex.scene.options.Appearance` and from
:data:`flowtex.settings.TABLE`; this module adds those of the shell only.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, fields, make_dataclass
from dataclasses import field as data_field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

from cyclopts import Group, Parameter
from cyclopts.validators import Number

from flowtex._util.written import SWITCH, Form, UnreadableError, number_or_text
from flowtex.errors import FieldError
from flowtex.field.options import FieldOptions
from flowtex.scene.forms import FORMS
from flowtex.scene.options import COASTLINES, Appearance, ViewOptions
from flowtex.settings import TABLE, Setting

FLOW = Group("The flow", sort_key=1)
PICTURE = Group("The picture", sort_key=2)
PAGE = Group("The page", sort_key=3)
SETTINGS = Group("Settings", sort_key=4)

FLAT = Parameter(name="*")
FILE = Annotated[
    Path,
    Parameter(
        help=(
            "A mesh: any file that PyVista reads, or PLOT3D; or data of the Earth: NetCDF, Zarr, "
            "GRIB or the JSON of wind maps. Several files of the Earth are opened as one dataset."
        )
    ),
]


class UsageError(FieldError):
    """Invalid arguments of a command; the text names the remedy."""


def _option_flags(kind: type, group: Group) -> dict[str, Any]:
    """Return a flag for each field of an option class that can be written as text."""
    flags = {}
    for option in fields(kind):
        if (form := FORMS.get(option.name)) is None:
            continue
        of_python = {"bool": bool, "bool | None": bool, "float": float}.get(str(option.type), str)
        if form.repeated:
            value: Any = tuple[str, ...]
        elif form is SWITCH:
            value = bool
        else:
            value = of_python
        text = form.words or _in_shell(option.metadata["text"])
        if isinstance(option.default, (str, float)) and "default" not in text:
            text = f"{text} [default: {option.default}]"
        others: dict[str, Any] = {}
        if form.repeated:
            others["negative"] = ()
        if option.name == "sel":
            others["name"] = ["--sel", "--select"]
        parameter = Parameter(group=group, help=text, allow_leading_hyphen=value is str, **others)
        flags[option.name] = Annotated[value | None, parameter]
    return flags


def _in_shell(text: str) -> str:
    text = re.sub(r'``\{"(\w+)": (\w+)\}``', r"``\1=\2``", text)
    text = re.sub(r'``"([^" ]*)"``', lambda match: f"``{match[1] or 'none'}``", text)
    return re.sub(r"``(False|None)``", "``none``", text)


def _setting_flag(row: Setting) -> Any:
    if row.choices:
        kind: Any = Literal[row.choices]
    else:
        kind = row.kind
    if row.low is not None:
        span = f" From {row.low:g} to {row.high:g}."
    else:
        span = ""
    text = f"{row.text}{span} [default: {row.default}]"
    if row.switch is not None:  # on, off or a number
        kind = str
        text = text.replace("True", "on")
    return Annotated[kind | None, Parameter(group=SETTINGS, help=text)]


def _flags(name: str, text: str, flags: dict[str, Any]) -> Any:
    """Return a class whose fields are flags of the command line."""
    members = []
    for flag, kind in flags.items():
        members.append((flag, kind, data_field(default=None)))
    return make_dataclass(
        name,
        members,
        kw_only=True,
        # Annotations are resolved in the module that the class names.
        namespace={"__module__": __name__, "__doc__": text},
    )


SIZE = Annotated[str, Parameter(group=PICTURE, help="Width and height in pixels.")]
TIME = Annotated[
    str | None,
    Parameter(
        group=FLOW,
        help=(
            "One time of a series, a number or a date, drawn with its streamlines; all times by "
            "default."
        ),
    ),
]

#: The flag of a file with other lines than the coasts.
COASTLINES_FILE = "coastlines_file"
COASTS = Annotated[
    Path | None,
    Parameter(
        group=PICTURE,
        help="GeoJSON, shapefile or GeoPackage whose lines are drawn in place of the coasts.",
    ),
]

if TYPE_CHECKING:
    FieldFlags: TypeAlias = object
    LookFlags: TypeAlias = object
    SettingFlags: TypeAlias = object
else:
    FieldFlags = _flags(
        "FieldFlags",
        "Selects the flow from a file.",
        {**_option_flags(FieldOptions, FLOW), "time": TIME},
    )
    LookFlags = _flags(
        "LookFlags",
        "Colours and visibility.",
        {
            **_option_flags(Appearance, PICTURE),
            COASTLINES_FILE: COASTS,
            **_option_flags(ViewOptions, PICTURE),
        },
    )
    SettingFlags = _flags(
        "SettingFlags",
        "One flag for each setting.",
        {name: _setting_flag(row) for name, row in TABLE.items()},
    )


@dataclass(kw_only=True)
class FrameFlags:
    """Flags of pictures and movies."""

    size: SIZE = "1024x768"
    supersampling: Annotated[
        int,
        Parameter(group=PICTURE, help="Draw larger by this factor along each side, and average."),
    ] = 1
    annotations: Annotated[
        bool, Parameter(group=PICTURE, help="Add legend, scale bar, time and name.", negative="")
    ] = False


@dataclass(kw_only=True)
class AddressFlags:
    """Address of a page."""

    port: Annotated[
        int,
        Parameter(group=PAGE, help="Port; 0 takes a free one.", validator=Number(gte=0, lt=65536)),
    ] = 0
    host: Annotated[
        str,
        Parameter(
            group=PAGE,
            help=(
                "Address to listen on; with any but the default, other machines may reach the page."
            ),
        ),
    ] = "127.0.0.1"
    allow_host: Annotated[
        tuple[str, ...],
        Parameter(
            group=PAGE,
            help=(
                "Host name by which browsers may address the page, besides localhost and --host, "
                "such as that of a proxy. Repeat it for several; '*' allows any."
            ),
            negative=(),
        ),
    ] = ()
    open_browser: Annotated[
        bool,
        Parameter(group=PAGE, name=["--browser", "--open"], help="Open the page in the browser."),
    ] = True


@dataclass(kw_only=True)
class ServeFlags(AddressFlags):
    """Address of a page, and the number of its users."""

    limit: Annotated[
        int | None,
        Parameter(
            group=PAGE,
            help=(
                "Largest number of open pages, each with its own state; by default as many as "
                "cores and memory allow."
            ),
        ),
    ] = None
    idle: Annotated[
        float, Parameter(group=PAGE, help="Minutes during which a closed page can be opened again.")
    ] = 15.0


def arguments(*groups: object) -> dict[str, Any]:
    """Return the flags that were set, as arguments of Python functions.

    Raises
    ------
    UsageError
        When the text of a flag cannot be read, as in ``--at 1,x``.
    """
    forms = {**FORMS, "time": Form(read=number_or_text)}
    for row in TABLE.values():
        if row.switch is not None:
            forms[row.name] = Form(read=row.parse)
    values = {}
    for group in groups:
        if group:
            values.update(vars(group))
    for name, value in list(values.items()):
        if value in (None, ()):
            del values[name]
        elif name in forms and isinstance(value, (str, tuple)):
            try:
                values[name] = forms[name].read(value)
            except UnreadableError as error:
                if isinstance(value, tuple):
                    text = " ".join(value)
                else:
                    text = repr(value)
                raise UsageError(
                    f"--{name.replace('_', '-')} is {text}; expected {error}"
                ) from error
    return _with_coasts(values)


def _with_coasts(values: dict[str, Any]) -> dict[str, Any]:
    """Return arguments with a file of coasts as their argument of Python."""
    path = values.pop(COASTLINES_FILE, None)
    if path is None:
        return values
    if COASTLINES in values:
        raise UsageError("--coastlines and --coastlines-file are given; expected one of them")
    return {**values, COASTLINES: path}


def pixels(size: str) -> tuple[int, int]:
    """Return width and height of a text such as ``"1024x768"``.

    Raises
    ------
    UsageError
        When the text is not two whole numbers from 1 to 16384 with an ``x`` between.
    """
    words = size.lower().replace("×", "x").split("x")
    is_readable = [word.isdecimal() and 1 <= int(word) <= 16384 for word in words]
    if len(words) != 2 or not all(is_readable):
        raise UsageError(f"--size is {size!r}; expected width x height up to 16384, as in 1024x768")
    return int(words[0]), int(words[1])
