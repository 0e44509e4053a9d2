"""Planes across x or y in space, as of cuts through a volume: their axes and components.

A coordinate along such a plane has an attribute that says where the plane is. Datasets without it
have the axes of the plane as their dimensions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flowtex._util.array_types import Floats

if TYPE_CHECKING:
    import xarray as xr

#: Attribute of a coordinate: the normal axis and the place along it, as in ``"x=0.5"``.
ATTRIBUTE = "plane_in_space"
LETTERS = "xyz"
#: Words of the components along a plane across an axis, and those of their partners.
PARTNERS: Mapping[str, Mapping[str, str]] = {
    "x": {"y": "z", "v": "w"},
    "y": {"x": "z", "u": "w"},
}


class SpacePlane(NamedTuple):
    """A plane across an axis of space."""

    normal: int  #: The number of that axis.
    place: float  #: The position along it.

    def __str__(self) -> str:
        return f"{LETTERS[self.normal]} = {self.place:g}"

    @property
    def axes(self) -> tuple[int, int]:
        """Numbers of the axes across and upward."""
        first, second = (axis for axis in range(3) if axis != self.normal)
        return first, second

    def points(self, positions: Floats) -> Floats:
        """Return positions in space, (..., 3), of those in the plane, (..., 2 or 3)."""
        placed = np.full((*positions.shape[:-1], 3), self.place)
        placed[..., self.axes] = positions[..., :2]
        return placed

    def vectors(self, u: Floats, v: Floats) -> Floats:
        """Return vectors in space, (..., 3)."""
        placed = np.zeros((*u.shape, 3), dtype=u.dtype)
        for axis, part in zip(self.axes, (u, v), strict=True):
            placed[..., axis] = part
        return placed


def plane_of(*coordinates: xr.DataArray) -> SpacePlane | None:
    """Return the plane in which coordinates lie; ``None`` for the plane of x and y."""
    for coordinate in coordinates:
        text = str(coordinate.attrs.get(ATTRIBUTE, ""))
        if text:
            letter, _, place = text.partition("=")
            return SpacePlane(LETTERS.index(letter), float(place))
    return None


def partners_along(
    arrays: Sequence[xr.DataArray], dims: Sequence[tuple[str, ...]]
) -> list[Mapping[str, str]]:
    """Return words of components along the planes across x or y that arrays have.

    ``dims`` are the dimensions of the surface of each array.
    """
    found = []
    for array, along in zip(arrays, dims, strict=True):
        normal = _normal(array, along)
        if normal and PARTNERS[normal] not in found:
            found.append(PARTNERS[normal])
    return found


def is_marked(array: xr.DataArray) -> bool:
    """Return whether a coordinate of an array says in which plane of space it lies."""
    return plane_of(*array.coords.values()) is not None


def _normal(array: xr.DataArray, dims: Sequence[str]) -> str:
    """Return the letter of the axis across which an array lies, if it is x or y."""
    plane = plane_of(*array.coords.values())
    if plane is not None:
        return LETTERS[plane.normal]
    along = letters_of(dims)
    missing = [letter for letter in PARTNERS if letter not in along]
    if "z" in along and len(missing) == 1:
        return missing[0]
    return ""


def letters_of(dims: Sequence[Any]) -> dict[str, str]:
    """Return the dimensions that are called x, y or z, by these letters."""
    found = {}
    for dim in dims:
        letter = str(dim).lower()
        if len(letter) == 1 and letter in LETTERS:
            found[letter] = str(dim)
    return found
