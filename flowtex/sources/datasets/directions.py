"""How two variables give the components of a velocity, and what an angle of a flow means."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from flowtex._util.array_types import Floats

if TYPE_CHECKING:
    import xarray as xr

#: The two variables of a velocity are its components.
CARTESIAN = "cartesian"
#: They are along a radius and an angle.
POLAR = "polar"
#: They are along colatitude and longitude, southward and eastward.
SPHERICAL = "spherical"
#: They are a magnitude, and the angle from x, or from east, counterclockwise.
ANGLE = "angle from x"
#: They are the speed, and the direction from which the flow comes.
FROM = "direction from"
#: They are the speed, and the direction to which the flow goes.
TOWARDS = "direction towards"
#: Kinds whose second variable is an angle.
ANGULAR = (ANGLE, FROM, TOWARDS)

#: Greatest angle in radians.
MOST_RADIANS = 2 * np.pi + 1e-3
#: Kinds by the words for them in ``components=``.
BY_WORD = {"angle": ANGLE, "from": FROM, "to": TOWARDS}
#: Meanings of these words.
MEANINGS = {
    "angle": "an angle from x, counterclockwise",
    "from": "a direction from which the flow comes, clockwise from north",
    "to": "a direction to which the flow goes, clockwise from north",
}

#: Units behind the name of a speed.
_UNITS = r"(_(kn|kts?|knots?|mps|m_?s|cm_?s|km_?h|kmph|kph|mph))?"
#: Names of speeds.
SPEEDS = re.compile(
    rf"^(.*_)?(speed|magnitude|mag)(_\d+m)?{_UNITS}$|^(w|c)?(spd|spe)\d*m?{_UNITS}$|^ws\d*m?{_UNITS}$|"
    r"^wspd\w*$",
    re.I,
)
#: Names of magnitudes, beside which an angle is that of the vector.
MAGNITUDES = re.compile(r"(^|_)mag(nitude)?$", re.I)
#: Words that tell a speed from its direction, of which the other words are the same.
OF_SPEED = re.compile(r"(^|_)(speed|magnitude|mag|direction|dir|angle|from|to)(?=_|$)", re.I)
#: Names of directions.
TURNS = re.compile(r"(^|_)(direction|dir)(_\w+)?$|^w(d|dir)\w*$|^dir\w*$", re.I)
#: Names of angles that are not names of directions.
ANGLES = re.compile(r"^(angle|phase|arg|argument|phi|theta)(_?\d*|_\w+)$|_angle$", re.I)
#: Names of angles that are those of a speed beside them, whatever it is called.
PLAIN_ANGLES = re.compile(r"angles?|(flow|vel|velocity)_angle", re.I)
#: Words for angles from x or from east.
FROM_X = re.compile(
    r"(counter|anti)[- ]?clockwise|mathematic|from (the )?(positive )?(east|\+?x)\b", re.I
)
#: Words for the axis from which an angle is counted.
AXIS = re.compile(r"from (the )?(true |geographic |magnetic |grid )?(north|east|\+?x)\b", re.I)
COMES = re.compile(r"\b(from|coming|comes)\b", re.I)
GOES = re.compile(r"\b(to|towards?|going|goes|into)\b", re.I)


class Convention(NamedTuple):
    """The meaning of an angle: its kind, its words, and whether the data say it."""

    kind: str
    words: str
    is_declared: bool


def convention(speed: xr.DataArray, angle: xr.DataArray) -> Convention:
    """Return the meaning of an angle beside a speed, by its attributes, then by its name.

    Without a word about it, wind comes from a direction, and anything else goes there.
    """
    texts = [str(angle.attrs.get(word, "")) for word in ("standard_name", "long_name")]
    texts += [str(angle.attrs.get(word, "")) for word in ("description", "comment")]
    described = " ".join(texts).replace("_", " ")
    if FROM_X.search(described):
        return Convention(ANGLE, "an angle from x, counterclockwise", is_declared=True)
    name = str(angle.name)
    said = AXIS.sub("", f"{described} {name.replace('_', ' ')}")
    if COMES.search(said):
        return Convention(FROM, "a direction from", is_declared=True)
    if GOES.search(said):
        return Convention(TOWARDS, "a direction to", is_declared=True)
    if ANGLES.search(name) and not TURNS.search(name):
        return Convention(ANGLE, "an angle from x, counterclockwise", is_declared=False)
    speed_name = str(speed.attrs.get("standard_name", speed.name))
    is_wind = re.search(r"wind|^w", f"{speed_name} {name}", re.I) or "wind" in described.lower()
    if is_wind:
        return Convention(FROM, "a direction from", is_declared=False)
    return Convention(TOWARDS, "a direction to", is_declared=False)


def in_components(kind: str, u: Floats, v: Floats, angle: Floats | None) -> tuple[Floats, Floats]:
    """Return components along x and y, or eastward and northward, of two values of a kind.

    ``angle`` is that of the places of polar components.
    """
    if kind == FROM:
        return -u * np.sin(v), -u * np.cos(v)
    if kind == TOWARDS:
        return u * np.sin(v), u * np.cos(v)
    if kind == ANGLE:
        return u * np.cos(v), u * np.sin(v)
    if kind == POLAR and angle is not None:
        cos = np.cos(angle)
        sin = np.sin(angle)
        return u * cos - v * sin, u * sin + v * cos
    if kind == SPHERICAL:
        return v, -u
    return u, v
