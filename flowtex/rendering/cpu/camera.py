"""A view as plain numbers: from the mesh's coordinates to clip space, as VTK's camera gives it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Floats

__all__ = ["Camera"]

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Camera:
    """Where a picture is taken from.

    Attributes
    ----------
    position, focal_point
        Where the camera stands and what it looks at, in the mesh's own coordinates.
    up
        Direction that is up in the picture, of any length.
    size
        Width and height of the picture in pixels.
    parallel_scale
        Half the height of what a parallel projection shows, in the mesh's units; ``None`` for
        a view in perspective.
    view_angle
        Angle from the lower to the upper border of a view in perspective, in degrees.

    Raises
    ------
    ValueError
        When one of them is out of its range, or they span no picture; all faults are told.
    """

    position: Point
    focal_point: Point
    up: Point
    size: tuple[int, int]
    parallel_scale: float | None = None
    view_angle: float = 30.0

    def __post_init__(self) -> None:
        """Check the values."""
        faults = [
            f"{name} is {value!r}; expected three finite numbers"
            for name in ("position", "focal_point", "up")
            if not _is_point(value := getattr(self, name))
        ]
        if np.shape(self.size) != (2,) or any(int(n) != n or n < 1 for n in self.size):
            faults.append(
                f"size is {self.size!r}; expected a width and a height of a pixel or more"
            )
        if self.parallel_scale is not None and not 0 < self.parallel_scale < np.inf:
            faults.append(
                f"parallel_scale is {self.parallel_scale!r}; expected a positive length, or None "
                "for a view in perspective"
            )
        if not 0 < self.view_angle < 180:
            faults.append(f"view_angle is {self.view_angle!r}; expected 0 to 180 degrees")
        if not faults and not np.linalg.norm(np.cross(self._forward, self.up)) > 0:
            faults.append(
                f"position {self.position!r}, focal_point {self.focal_point!r} and up {self.up!r} "
                "lie on one line; expected up to point away from the line of sight"
            )
        if faults:
            raise ValueError("; ".join(faults))

    @property
    def _forward(self) -> Floats:
        return np.subtract(self.focal_point, self.position, dtype=float)

    @property
    def axes(self) -> Floats:
        """Unit vectors to the right, up, and into the picture, by row, (3, 3)."""
        forward = self._forward / np.linalg.norm(self._forward)
        right = np.cross(forward, self.up)
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(right, forward), forward])

    @property
    def eye(self) -> Floats:
        """The eye and 1, or the way to it and 0 where all rays are parallel, (4,)."""
        if self.parallel_scale is None:
            return np.array([*self.position, 1.0])
        return np.array([*-self.axes[2], 0.0])

    def matrix(self, origin: ArrayLike = (0.0, 0.0, 0.0)) -> Floats:
        """Matrix that takes (x, y, z, 1) to clip space (x, y, z, w), (4, 4).

        x / w and y / w go from -1 to 1 across the picture, to the right and up, as in VTK. There
        is no near and no far plane: w is the distance in perspective and 1 otherwise, and z / w
        grows with the distance, without a bound.

        Parameters
        ----------
        origin
            Point that (x, y, z) is counted from, (3,). One in the middle of the surface keeps
            the digits of a mesh far from the origin.
        """
        axes = self.axes
        width, height = self.size
        half = self.parallel_scale or float(np.tan(np.radians(self.view_angle / 2)))
        view = np.zeros((3, 4))
        view[:, :3] = axes
        view[:, 3] = axes @ np.subtract(origin, self.position, dtype=float)
        result = np.zeros((4, 4))
        result[0] = view[0] / (half * width / height)
        result[1] = view[1] / half
        if self.parallel_scale is None:
            result[2, 3] = -1.0
            result[3] = view[2]
        else:
            result[2] = view[2]
            result[3, 3] = 1.0
        return result


def _is_point(value: object) -> bool:
    try:
        numbers = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        return False
    return numbers.shape == (3,) and bool(np.isfinite(numbers).all())
