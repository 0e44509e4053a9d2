"""Where a camera stands to show a flow well, as plain numbers that any renderer can take.

A flat surface is seen straight on and without perspective, its own axes to the right and up; a
curved one from above and aside, from so far away that the whole of it just fits.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.field import FlowField

__all__ = ["FirstLook", "first_look"]

Point = tuple[float, float, float]

#: Share of the window that is left empty around a flat surface.
MARGIN = 0.04
#: How many times closer the camera comes; nearer, what is close would be cut off with what is far.
CLOSEST = 16.0
#: View angle from above and aside at zoom 1, in degrees.
VIEW_ANGLE = 30.0
#: The way from a curved surface to the camera, and what is up there.
ASIDE, UP = (1.0, 1.0, 1.0), (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class FirstLook:
    """A camera.

    Attributes
    ----------
    position, focal_point
        Where it stands and what it looks at, in the mesh's own coordinates.
    up
        Direction that is up in the picture.
    parallel
        Whether it has no perspective.
    parallel_scale
        Half the height of what it shows without perspective, in the mesh's units.
    view_angle
        Angle from the lower to the upper border in perspective, in degrees.
    """

    position: Point
    focal_point: Point
    up: Point
    parallel: bool
    parallel_scale: float
    view_angle: float


def first_look(
    field: FlowField,
    aspect: float,
    *,
    zoom: float = 1.0,
    focus: tuple[float, ...] | None = None,
    toward: Point = ASIDE,
    up: Point = UP,
) -> FirstLook:
    """Return the camera that shows a field.

    Parameters
    ----------
    field
        What to look at.
    aspect
        Width of the picture over its height.
    zoom
        1 shows the whole surface, 8 an eighth of its width.
    focus
        Point of the mesh to look at, two or three coordinates; the middle by default.
    toward, up
        The way from a curved surface to the camera, and what is up there: no parallels.

    Raises
    ------
    ValueError
        When ``zoom`` is not positive, or ``focus`` is no point.
    """
    if not zoom > 0:
        msg = f"zoom is {zoom!r}; expected a positive number, 1 for the whole surface"
        raise ValueError(msg)
    surface = field.surface
    centre = surface.center.copy()
    if focus is not None:
        point = np.asarray(focus, dtype=float)
        if point.shape not in ((2,), (3,)) or not np.isfinite(point).all():
            msg = f"focus is {focus!r}; expected two or three coordinates in the mesh's units"
            raise ValueError(msg)
        centre[: len(point)] = point
    if surface.frame is None:
        sides = (np.asarray(toward, dtype=float), np.asarray(up, dtype=float))
        return _at_curved(field, centre, aspect, zoom, sides, come_closer=focus is not None)
    return _at_flat(field, surface.frame, centre, aspect, zoom)


def _at_flat(
    field: FlowField, frame: NDArray[Any], centre: NDArray[Any], aspect: float, zoom: float
) -> FirstLook:
    """Straight on, without perspective, the surface's own axes to the right and up."""
    surface = field.surface
    right, up = frame
    local = (surface.points[surface.valid] - surface.center) @ frame.T
    width, height = np.ptp(local, axis=0)
    return FirstLook(
        position=_point(centre + np.cross(right, up) * surface.extent),
        focal_point=_point(centre),
        up=_point(up),
        parallel=True,
        parallel_scale=float(0.5 * max(height, width / aspect) / (1 - 2 * MARGIN) / zoom),
        view_angle=VIEW_ANGLE,
    )


def _at_curved(
    field: FlowField,
    centre: NDArray[Any],
    aspect: float,
    zoom: float,
    sides: tuple[NDArray[Any], NDArray[Any]],
    *,
    come_closer: bool,
) -> FirstLook:
    """From a side, so far away that the whole surface just fits.

    With a point on the surface to look at, the camera comes closer to it, and then the view grows
    narrower. The middle of a sphere is not on it, so without a point the view only grows narrower.
    """
    toward = sides[0] / np.linalg.norm(sides[0])
    right = np.cross(sides[1], toward)
    right /= np.linalg.norm(right)
    up = np.cross(toward, right)
    half = np.tan(np.radians(VIEW_ANGLE / 2))
    surface = field.surface
    x, y, z = np.stack([right, up, toward]) @ (surface.points[surface.valid] - surface.center).T
    wide, high = np.abs(x) / aspect, np.abs(y)
    distance = float(np.max(z + np.maximum(wide, high) / half / (1 - 2 * MARGIN)))
    closer = min(zoom, CLOSEST) if come_closer else 1.0
    return FirstLook(
        position=_point(centre + toward * (distance / closer)),
        focal_point=_point(centre),
        up=_point(sides[1]),
        parallel=False,
        parallel_scale=float(distance / closer * half * closer / zoom),
        view_angle=float(2 * np.degrees(np.arctan(half * closer / zoom))),
    )


def _point(values: NDArray[Any]) -> Point:
    x, y, z = (float(v) for v in values)
    return x, y, z
