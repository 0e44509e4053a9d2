"""Vectors along a radius and angles, turned to the axes of space before they are averaged or cut.

================  =================================================================
``components=``   the components are along
================  =================================================================
``polar``         the distance from the z axis, and the angle around it (and z)
``cylindrical``   the same
``spherical``     [the distance from the origin,] the angle from the z axis, southward,
                  and the angle around it, eastward
================  =================================================================
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.sources.meshes.vectors import MeshArray, data_of, values_of
from flowtex.sources.notices import Record

#: Values of ``components=`` for meshes, and the directions in words.
DIRECTIONS = {
    "polar": "along the radius, the angle around z, and z",
    "cylindrical": "along the radius, the angle around z, and z",
    "spherical": "along the radius, the angle from z, and the angle around z",
}


@dataclass(frozen=True)
class MeshVelocity:
    """The array of a mesh with the velocity, and the one that is drawn, in directions of space."""

    stored: MeshArray
    drawn: MeshArray
    components: str | None = None  #: A key of :data:`DIRECTIONS`; ``None`` for along x, y and z.

    @classmethod
    def of(cls, stored: MeshArray, components: str | None, record: Record) -> MeshVelocity:
        """Return the velocity for the directions that the user names.

        Parameters
        ----------
        stored
            The vectors of the mesh.
        components
            Directions of their components; ``None`` for x, y and z.
        record
            Record of what was done.

        Raises
        ------
        FieldError
            When ``components`` is not one of ``DIRECTIONS``.
        """
        if components is None:
            return cls(stored, stored)
        if components not in DIRECTIONS:
            expected = ", ".join(f"{key!r} ({words})" for key, words in DIRECTIONS.items())
            raise FieldError(f"components is {components!r}; expected for a mesh {expected}")
        text = f"{stored.name}: {DIRECTIONS[components]} (components={components!r})"
        record("components", text)
        drawn = replace(stored, components=3, parts=())
        return cls(stored, drawn, components)

    def in_space(self, mesh: Any) -> Any:
        """Return a mesh with the drawn array."""
        if self.components is None:
            return mesh
        values = np.asarray(values_of(mesh, self.stored), dtype=float)
        if self.stored.where == "points":
            places = mesh.points
        else:
            places = mesh.cell_centers().points
        changed = mesh.copy(deep=False)
        turned = in_space(values, np.asarray(places, dtype=float), self.components)
        data_of(changed, self.drawn.where)[self.drawn.name] = turned
        return changed


def in_space(values: Floats, places: Floats, components: str) -> Floats:
    """Return vectors along x, y and z, (N, 3), of two or three components at places (N, 3).

    Two components are those on a sphere around the origin, or those in planes across z.
    """
    x, y, z = places.T
    around = np.arctan2(y, x)
    zero = np.zeros_like(around)
    outward = np.stack([np.cos(around), np.sin(around), zero], axis=-1)
    eastward = np.stack([-np.sin(around), np.cos(around), zero], axis=-1)
    upward = np.array([0.0, 0.0, 1.0])
    if components != "spherical":
        directions = [outward, eastward, upward]
        count = values.shape[1]
        return _sum_of(values, directions[:count])
    polar = np.arctan2(np.hypot(x, y), z)[:, None]
    radial = np.sin(polar) * outward + np.cos(polar) * upward
    southward = np.cos(polar) * outward - np.sin(polar) * upward
    if values.shape[1] == 2:
        return _sum_of(values, [southward, eastward])
    return _sum_of(values, [radial, southward, eastward])


def _sum_of(values: Floats, directions: list[Floats]) -> Floats:
    """Return the vectors with components (N, C) along C directions, (N, 3) or (3,) each."""
    total = np.zeros((len(values), 3))
    for component, direction in zip(values.T, directions, strict=True):
        total += component[:, None] * direction
    return total
