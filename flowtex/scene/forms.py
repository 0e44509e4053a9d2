"""Read and write arguments as text, for the command line and for links."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from flowtex._util.written import (
    NUMBER,
    PLAIN,
    SWITCH,
    Form,
    UnreadableError,
    named_texts,
    number_or_text,
    numbers,
    or_none,
)
from flowtex.field.options import FieldOptions, option_names
from flowtex.rendering.camera import Camera
from flowtex.scene.options import EARTH_LINES, ROBUST, SWITCHES, Appearance, ViewOptions
from flowtex.settings import TABLE, setting


def _read_ends(text: str) -> str | tuple[float, ...]:
    """Return the two ends of a range of colours, or the word for a robust one."""
    if text == ROBUST:
        return ROBUST
    low, high = numbers(2, expected="two numbers, such as 1.5,3")(text)
    if not low < high:
        raise UnreadableError("two numbers, the lower one first")
    return low, high


def _read_differences(words: Sequence[str]) -> dict[str, Any]:
    """Read words such as ``lod=false`` as settings and as fields of :class:`Appearance`."""
    texts = named_texts(str, "name=value, such as --beside lod=false")(words)
    values = {}
    for flag, text in texts.items():
        name = flag.replace("-", "_")
        if name in option_names(Appearance):
            values[name] = FORMS[name].read(text)
        else:
            values[name] = setting(name).parse(text)
    return values


#: Form of a whole number or a name.
def _read_whole(text: str) -> int | str:
    """Return a whole number; any other text as it is, for the check of its argument."""
    if text.isdecimal():
        return int(text)
    return text


def _read_mask(text: str) -> str | bool:
    """Return the name of a mask, or ``False`` for none."""
    if text.lower() in ("none", "false"):
        return False
    return text


WHOLE = Form(read=_read_whole)
_SPECIAL = {
    "block": WHOLE,
    "periodic": Form(read=or_none("")),
    "level": Form(read=number_or_text),
    "sel": Form(
        read=named_texts(number_or_text, "an axis and a value, such as number=3"), repeated=True
    ),
    "isel": Form(
        read=named_texts(int, "an axis and a whole number, such as number=2"), repeated=True
    ),
    "max_edge": Form(read=number_or_text),
    "mask": Form(read=_read_mask),
    "scalars": Form(read=or_none(value=False)),
    "component": WHOLE,
    "cmap": Form(
        "Colour map, a matplotlib name; by default RdBu_r for vorticity, divergence and "
        "okubo_weiss, otherwise viridis."
    ),
    "clim": Form(read=_read_ends, write=lambda ends: ",".join(repr(float(end)) for end in ends)),
    "norm": Form("Norm from values to colours: the name of a matplotlib scale, such as symlog."),
    "n_colors": WHOLE,
    "opacity": NUMBER,
    "image": Form("PNG or JPEG that the flow smears, instead of the noise.", Path),
    "land": Form(read=or_none()),
    "focus": Form(read=numbers(2, 3, expected="two or three coordinates, such as 1.5,0")),
    "camera": Form(
        "Position, focal point and up direction, nine numbers separated by commas; or the "
        "camera from a page's link.",
        Camera.from_text,
    ),
    "background": Form("Background colour; by default white, or that of the surrounding page."),
    "beside": Form(read=_read_differences, repeated=True),
}
#: Form of each argument that can be written as text.
FORMS: dict[str, Form] = {}
for _kind in (FieldOptions, Appearance, ViewOptions):
    for _name in option_names(_kind):
        if _name in (*SWITCHES, *EARTH_LINES):
            FORMS[_name] = SWITCH
        elif _name not in ("times", "slices"):
            FORMS[_name] = _SPECIAL.get(_name, PLAIN)
#: Names of the arguments of Python that have a flag in the shell.
FLAGS = frozenset((*FORMS, "time", *TABLE))
