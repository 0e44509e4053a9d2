"""Units and directions of the two components.

==========================================  =============================================
the data say                                the components are
==========================================  =============================================
``components=``                             as given
speed and direction                         eastward and northward
along a radius and an angle                 along x and y, by the angle
``GRIB_uvRelativeToGrid``                   along the grid if 1, else eastward and northward
standard or long names with *eastward*      eastward and northward
standard names ``x_wind``, ``grid_...``     along the grid
values on the sides of cells (Arakawa C)    along the grid
positions in a plane                        along x and y
unknown, rows and columns of the Earth      eastward and northward
unknown, meshes and points of the Earth     eastward and northward
unknown, a curvilinear grid of the Earth    along the grid, as WRF, ROMS, NEMO and POP have it
==========================================  =============================================
"""

from __future__ import annotations

import re
from typing import NamedTuple

from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.sources.datasets.coordinates import Places
from flowtex.sources.datasets.select import CARTESIAN, FROM, POLAR, TOWARDS, Pair, velocity_unit
from flowtex.sources.record import Record

#: Values of ``components=``, in words.
DIRECTIONS = {"earth": "eastward and northward", "grid": "along the grid", "plane": "along x and y"}


#: Coordinates of models whose components are along the grid: WRF, NEMO, ROMS, POP, MITgcm, MOM.
MODELS = re.compile(r"XLONG|nav_lon|lon_(rho|u|v|psi)\b|glam|[TU]_?LONG?|XC|XG|geolon")
#: The reason where neither names nor positions tell.
UNKNOWN = "a curvilinear grid, and no name that tells"


class Orientation(NamedTuple):
    """Directions of the components: a key of :data:`DIRECTIONS`, and the reason."""

    along: str
    why: str

    def __str__(self) -> str:
        return f"{DIRECTIONS[self.along]} ({self.why})"


#: Directions before the names and the grid are known.
EASTWARD = Orientation("earth", "")


def component_units(pair: Pair, record: Record) -> tuple[str, tuple[float, float]]:
    """Return the unit of a velocity, and the factors of its variables to it.

    The unit is empty where neither has one. The factor of a direction is that to radians.
    """
    if pair.kind in (FROM, TOWARDS):
        angle = str(pair.v.attrs.get("units", "")) or "degree"
        record("units", f"{pair.v.name} is a {pair.kind} north, clockwise")
        return velocity_unit(pair.u), (1.0, units.factor(angle, "radian") or 1.0)
    one, other = velocity_unit(pair.u), velocity_unit(pair.v)
    if not one or not other:
        if one != other:
            named, bare = (pair.u, pair.v) if one else (pair.v, pair.u)
            text = f"{bare.name} has no unit; that of {named.name}, {one or other}, is assumed"
            record("units", text, notable=True)
        return one or other, (1.0, 1.0)
    factor = units.factor(other, one)
    if factor is None:
        msg = (
            f"the units of {pair.u.name!r} and {pair.v.name!r} are {one!r} and {other!r}, of which "
            "neither can be converted to the other"
        )
        raise FieldError(msg)
    if factor != 1.0:
        record("units", f"{pair.v.name} converted from {other} to {one}")
    return one, (1.0, factor)


def orientation(
    pair: Pair, places: Places, *, staggered: bool, wanted: str | None, record: Record
) -> Orientation:
    """Return the directions of components by the rules of this module."""
    if wanted is not None and wanted not in DIRECTIONS:
        expected = ", ".join(f"{key!r} ({words})" for key, words in DIRECTIONS.items())
        msg = f"components is {wanted!r}; expected {expected}"
        raise FieldError(msg)
    found = _orientation(pair, places, staggered=staggered, wanted=wanted)
    if not places.is_earth and found.along == "earth":
        found = Orientation("plane", "positions in a plane")
    if places.is_earth and found.along == "plane":
        msg = (
            "components is 'plane', but the positions are longitude and latitude; expected 'earth' "
            "or 'grid'"
        )
        raise FieldError(msg)
    record("components", str(found))
    return found


def _orientation(pair: Pair, places: Places, *, staggered: bool, wanted: str | None) -> Orientation:
    if wanted is not None:
        return Orientation(wanted, f"components={wanted!r}")
    if pair.kind != CARTESIAN:
        return Orientation("plane" if pair.kind == POLAR else "earth", pair.why)
    if len(places.a) == 1 and places.is_earth:
        return Orientation("earth", "nodes without rows and columns")
    # Components on the sides of cells are across these, whatever a long name says.
    by_words = "standard_name" not in pair.u.attrs
    if staggered and (by_words or pair.along != "earth"):
        return Orientation("grid", "values on the sides of cells")
    if not places.is_earth:
        named = "grid" in str(pair.u.attrs.get("standard_name", pair.u.name)).split("_")
        return Orientation("grid" if named else "plane", "positions in a plane")
    if pair.along:
        return Orientation(pair.along, "by the names of the variables")
    if places.is_line:
        return Orientation("earth", "rows and columns of the Earth")
    if MODELS.match(places.why):
        return Orientation("grid", "as models with these coordinates have it")
    return Orientation("grid", UNKNOWN)
