"""Moves of the camera: pan, turn, and zoom towards the point under the pointer.

Places in the view are given as (x, y) from -1 to 1, right and up, so that no move depends on the
size of the picture. A flat surface is looked at without perspective: a drag then carries the
point under the pointer along exactly, at every zoom.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["DEEPEST", "Navigator"]

#: Farthest in and out, relative to the whole surface: single precision ends beyond.
DEEPEST, FARTHEST = 1e6, 0.25
#: View angle in perspective, in degrees, and how many times closer the camera comes.
ANGLE, CLOSEST = 30.0, 16.0
#: Zoom by one notch of the wheel.
NOTCH = 1.25

Vector = NDArray[np.float64]
Hit = Callable[[float, float], Vector | None]


class Navigator:
    """Moves one camera as a person drags and turns the wheel.

    Parameters
    ----------
    camera
        A VTK camera.
    flat
        Whether it looks at a flat surface: a drag then pans, otherwise it turns.
    hit
        Tells which point of the surface is at a place of the view, or ``None``.
    """

    def __init__(self, camera: Any, *, flat: bool, hit: Hit | None = None) -> None:
        self.camera = camera
        self.flat = flat
        self.aspect = 1.0
        self._hit = hit
        self.settle()
        self._drag: tuple[str, float, float] | None = None

    @property
    def height(self) -> float:
        """Half the height of the view at the focal point, in the mesh's units."""
        if self.camera.GetParallelProjection():
            return float(self.camera.GetParallelScale())
        angle = math.radians(self.camera.GetViewAngle()) / 2
        return float(self.camera.GetDistance() * math.tan(angle))

    @property
    def zoom(self) -> float:
        """How far in: 1 shows the whole surface."""
        return self._home / self.height

    @property
    def axes(self) -> tuple[Vector, Vector, Vector]:
        """Unit vectors to the right of the view, upwards, and away from the eye."""
        ahead = self._focus - np.asarray(self.camera.GetPosition())
        ahead /= np.linalg.norm(ahead)
        right = np.cross(ahead, self.camera.GetViewUp())
        right /= np.linalg.norm(right)
        return right, np.cross(right, ahead), ahead

    @property
    def _focus(self) -> Vector:
        return np.asarray(self.camera.GetFocalPoint(), dtype=float)

    def settle(self) -> None:
        """Take the present view for the one that shows the whole surface."""
        self._home = self.height
        self._nearest = float(self.camera.GetDistance()) / CLOSEST

    def press(self, x: float, y: float, *, other: bool = False) -> None:
        """Begin a drag; the ``other`` one turns a flat surface and pans a curved one."""
        self._drag = ("turn" if self.flat is other else "pan", x, y)

    def move(self, x: float, y: float) -> bool:
        """Go on with a drag; tells whether the camera moved."""
        if self._drag is None or (x, y) == self._drag[1:]:
            return False
        kind, x0, y0 = self._drag
        if kind == "pan":
            self.pan(x0 - x, y0 - y)
        else:
            self.turn(x - x0, y - y0)
        self._drag = (kind, x, y)
        return True

    def release(self) -> None:
        """End a drag."""
        self._drag = None

    def pan(self, dx: float, dy: float) -> None:
        """Move what is seen by a part of the view."""
        right, up, _ = self.axes
        self._shift((right * dx * self.aspect + up * dy) * self.height)

    def turn(self, dx: float, dy: float) -> None:
        """Go around the focal point, by half a turn for the whole view."""
        self.camera.Azimuth(-90 * dx * min(self.aspect, 2.0))
        self.camera.Elevation(-90 * dy)
        self.camera.OrthogonalizeViewUp()

    def wheel(self, notches: float, x: float, y: float) -> None:
        """Zoom in by turns of the wheel, towards (x, y)."""
        self.zoom_by(NOTCH**notches, x, y)

    def zoom_by(self, factor: float, x: float = 0.0, y: float = 0.0) -> None:
        """Zoom in by a factor; the point at (x, y) stays where it is."""
        if not math.isfinite(factor) or factor <= 0:
            return
        if not self.flat:
            self._focus_at(x, y)
        factor = min(max(factor, FARTHEST / self.zoom), DEEPEST / self.zoom)
        right, up, ahead = self.axes
        offset = (right * x * self.aspect + up * y) * self.height
        self._shift(offset * (1 - 1 / factor))
        if self.camera.GetParallelProjection():
            self.camera.SetParallelScale(self.camera.GetParallelScale() / factor)
        else:
            self._come_to(self.height / factor, ahead)

    def _come_to(self, height: float, ahead: Vector) -> None:
        """See half a height at the focal point: come closer, and from near look more narrowly."""
        half = math.tan(math.radians(ANGLE / 2))
        distance = max(height / half, self._nearest)
        self.camera.SetPosition(*(self._focus - ahead * distance))
        self.camera.SetViewAngle(2 * math.degrees(math.atan(height / distance)))

    def _focus_at(self, x: float, y: float) -> None:
        """Bring the focal point to the depth of the surface under the pointer.

        The view stays the same; a zoom then never runs into what is pointed at.
        """
        point = self._hit(x, y) if self._hit is not None else None
        if point is None:
            return
        position, ahead = np.asarray(self.camera.GetPosition()), self.axes[2]
        depth = float((point - position) @ ahead)
        if depth > 0:
            self.camera.SetFocalPoint(*(position + ahead * depth))

    def _shift(self, by: Vector) -> None:
        self.camera.SetFocalPoint(*(self._focus + by))
        self.camera.SetPosition(*(np.asarray(self.camera.GetPosition()) + by))
