"""Units of data: conversion, what they measure, and their symbols, by pint with CF's units."""

from __future__ import annotations

import re
from functools import cache
from itertools import product
from typing import Any

from flowtex.errors import FieldError, import_extra
from flowtex.remedies import Remedy

#: Texts of data without a unit, also numbers of levels.
NONE = ("", "1", "-", "none", "unknown", "n/a", "dimensionless", "level", "levels", "layer")
LENGTHS = ("[length]", "[printing_unit]")  #: Dimensions of lengths in pint; images have pixels.
TIMES = ("[time]", "[frame]")  #: Dimensions of times in pint; images have frames.
PRESSURES = ("[mass] / [length] / [time] ** 2",)  #: Dimensions of pressures in pint.
#: Dimensions of velocities in pint.
VELOCITIES = tuple(map(" / ".join, product(LENGTHS, TIMES)))
#: Spellings that pint reads otherwise, or not at all: its px is a length of web pages, its mb a
#: unit of area, and its ms a millisecond.
SPELLINGS = (
    (re.compile(r"[\u2010-\u2015\u2212]"), "-"),
    (re.compile(r"[{}\[\]]"), ""),
    (re.compile(r"(?<=[A-Za-z])\s+(?=-\d)"), ""),
    (re.compile(r"(?<=[A-Za-z])\.(?=[A-Za-z])"), " "),
    (re.compile(r"\b(px|pix)\b"), "pixel"),
    (re.compile(r"(?<=/)\s*dt\b"), "frame"),
    (re.compile(r"\bmb\b", re.IGNORECASE), "millibar"),
    (re.compile(r"\bhpa\b", re.IGNORECASE), "hPa"),
    (re.compile(r"\bkts?\b", re.IGNORECASE), "knot"),
    (re.compile(r"^([ckm]?m)s\s*(?:\*\*|\^)?\s*-1$", re.IGNORECASE), r"\1/s"),
    (re.compile(r"^k(m/?h|mph)(-1)?$", re.IGNORECASE), "km/h"),
    (re.compile(r"^m\s*/\s*s(ec)?$", re.IGNORECASE), "m/s"),
)


#: A number before or behind a unit, or a power such as 10^-2.
_NUMBER = (
    r"(?:10\s*(?:(?:\^|\*\*)\s*(?=[-+\d])|(?=[-+]))(?P<power>[-+]?\d{1,2})"
    r"|(?P<number>\d+\.?\d*(?:e[-+]?\d{1,2})?))"
)
_SCALED = (
    re.compile(rf"{_NUMBER}\s*[*·×]?\s*(?!e[-+]?\d)(?P<unit>[a-z°µμ].*)", re.IGNORECASE),
    re.compile(rf"(?P<unit>.*[^*·×\s])\s*[*·×]\s*{_NUMBER}", re.IGNORECASE),
)


@cache
def registry() -> Any:
    """Return pint's registry with CF's units, which takes a second at first."""
    import_extra("pint", "xarray")
    from cf_xarray.units import units

    if "frame" not in units:
        units.define("frame = [frame]")
    return units


def parsed(text: str) -> Any:
    """Return pint's unit of a text; ``None`` for no unit, or one that pint does not know.

    That of ``"0.01 m/s"`` is m/s, see :func:`scaled`.
    """
    return scaled(text)[1]


def scaled(text: str) -> tuple[float, Any]:
    """Return the number in a unit such as ``"0.01 m/s"``, else 1, and pint's unit or ``None``."""
    number, bare = without_number(text)
    return number, _unit_of(bare)


@cache
def without_number(text: str) -> tuple[float, str]:
    """Return the number in a unit, and the rest of it: 0.01 and ``"m/s"`` of ``"0.01 m/s"``."""
    text = text.strip()
    if _unit_of(text) is not None:
        return 1.0, text
    for pattern in _SCALED:
        match = pattern.fullmatch(text)
        if match is None:
            continue
        value = float(match["number"] or f"1e{match['power']}")
        if _unit_of(match["unit"]) is not None and value > 0:
            return value, str(match["unit"])
    return 1.0, text


@cache
def _unit_of(text: str) -> Any:
    """Return the unit of pint that a text spells in any usual way, or ``None``."""
    if text.lower() in NONE:
        return None
    for pattern, replacement in SPELLINGS:
        text = pattern.sub(replacement, text)
    unit = _known(text)
    if unit is None:  # such as Meters
        return _known(text.lower())
    return unit


def _known(text: str) -> Any:
    try:
        return registry().parse_units(text)
    except ModuleNotFoundError:
        raise
    except Exception:  # pint raises whatever the tokenizer of Python does
        return None


def measures(text: str, dimensions: tuple[str, ...]) -> bool:
    """Return whether a unit has one of some dimensions, such as :data:`VELOCITIES`."""
    unit = parsed(text)
    return unit is not None and str(unit.dimensionality) in dimensions


def is_angle(text: str) -> bool:
    """Return whether a unit is one of angles: degrees or radians."""
    unit = parsed(text)
    return unit is not None and text.strip().lower().startswith(("deg", "rad", "°"))


def factor(unit: str, other: str) -> float | None:
    """Return the factor from a unit to another one; ``None`` where they measure other things."""
    number, one = scaled(unit)
    divisor, two = scaled(other)
    if one is None or two is None or one.dimensionality != two.dimensionality:
        return None
    return float(registry().Quantity(number, one).to(two).magnitude) / divisor


def unit_remedy(name: str, assumed: str) -> Remedy:
    """Return the argument for another unit than the assumed one, by its name."""
    length = assumed.partition("/")[0]
    others = {"length_unit": ("km", "m"), "time_unit": ("h", "s"), "velocity_unit": ("km/h", "m/s")}
    if name == "velocity_unit" and length not in ("m", "km"):
        other = f"{length}/h"
    elif assumed == others[name][0]:
        other = others[name][1]
    else:
        other = others[name][0]
    return Remedy(name, other, "for another unit,")


def symbol(text: str) -> str:
    """Return the short form of a unit for legends, as ``"m/s"`` for ``"m s-1"``."""
    number, unit = scaled(text)
    if unit is None or not unit.dimensionality:
        return text
    short = f"{unit:~C}".replace("**", "^")
    if number == 1.0:
        return short
    return f"{number:g} {short}"


def speed_unit(length: str, time: str) -> str:
    """Return the unit of length per time; empty where one of the units is unknown."""
    if not length or not time:
        return ""
    if time.startswith(f"{length} / "):  # of examples: times in lengths per free-stream speed
        return time.removeprefix(f"{length} / ")
    if "/" in time:
        return f"{length} / ({time})"
    return f"{length}/{time}"


def velocity_units(length: str, time: str, velocity: str) -> tuple[float, str, str]:
    """Return the factor from a unit of velocity to length per time, the unit of time, and a symbol.

    An unknown unit of time is the velocity's own one. Velocities without a unit, or along positions
    without one, are not converted, nor are other vectors such as stress.

    Raises
    ------
    FieldError
        When the unit of velocity cannot be converted to the unit of positions per time.
    """
    if not velocity or velocity == speed_unit(length, time):
        return 1.0, time, velocity
    given = time
    if length and not time:
        time = _time_of(velocity)
    own = speed_unit(length, time)
    if own:
        scale = factor(velocity, own)
    else:
        scale = 1.0
    if scale is None and not measures(velocity, VELOCITIES) and parsed(velocity) is not None:
        return 1.0, given, symbol(velocity)
    if scale is None:
        raise FieldError(
            f"velocity_unit is {velocity!r}, which cannot be converted to {own!r}, the unit of "
            "the positions per unit of time; expected a unit of the same kind"
        )
    return scale, time, symbol(velocity)


def _time_of(velocity: str) -> str:
    """Return the symbol of the unit of time in a unit of velocity; of seconds if it has none."""
    unit = parsed(velocity)
    if unit is None:
        return "s"
    for name, _ in (1 * unit).unit_items():
        if measures(name, TIMES):
            return symbol(name)
    return "s"
