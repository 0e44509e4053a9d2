"""The camera of a picture, as plain numbers that every renderer takes.

Positions in the view are (x, y) from -1 to 1, right and up, so only ``aspect``, width over height,
depends on the size of a picture. A flat surface is seen straight on and without perspective, a
curved one from above and aside. The numbers of :data:`CAMERA_LIMITS` travel to the
browser in the header, so that both sides move the camera alike.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import brief, checked_number, is_number
from flowtex._util.array_types import Floats
from flowtex._util.written import number_or_text
from flowtex.errors import FieldError
from flowtex.field import Surface
from flowtex.field.earth.projection import EARTH_RADIUS

Point = tuple[float, float, float]
CameraValues: TypeAlias = dict[str, Any]  #: Attributes of a camera by name, for JSON.

ASIDE = (1.0, 1.0, 1.0)  #: Direction from a curved surface to the camera.
UP = (0.0, 0.0, 1.0)  #: The direction up.
#: The same for all of a globe: above longitude 0 and 20 degrees north.
WHOLE_GLOBE = (math.cos(math.radians(20)), 0.0, math.sin(math.radians(20)))
LEAST_ASIDE = 0.2  #: Share of the radius from which a direction counts.
LEAST_FACING = 0.1  #: Cosine between the view and the normal of a surface that is seen edge-on.
LEAST_PARALLEL = 0.8  #: Cosine between the normals of planes that share a camera.
MOST_LARGER = 4.0  #: Greatest ratio of the extents of two surfaces that share a camera.
MOST_APART = 0.5  #: Greatest distance of their centres over the larger extent.
FARTHEST_REACH = 1e9  #: Farthest that a camera may be, in extents: beyond, numbers end.
NEAREST_REACH = 1e-9  #: Nearest that a camera may be, in extents of the surface.


@dataclass(frozen=True)
class CameraLimits:
    """How far a camera may go, and how fast it moves."""

    #: Greatest and least zoom relative to the whole surface; single precision ends beyond.
    deepest_zoom: float = 1e6
    farthest_zoom: float = 0.25
    closest: float = 16.0  #: Times that a camera comes closer before its view angle narrows.
    view_angle: float = 30.0  #: View angle in perspective while the camera is farther than that.
    margin: float = 0.04  #: Share of the picture that is left empty at each side of a flat surface.
    wheel_zoom: float = 1.25  #: Zoom by one notch of the wheel.
    turn: float = 90.0  #: Degrees that a drag over half the height turns a curved surface.
    widest_turn: float = 2.0  #: Aspect beyond which a drag to the side turns no farther.


CAMERA_LIMITS = CameraLimits()


class CameraError(FieldError):
    """The values do not describe a camera, or the camera sees nothing.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.Camera(position=(0, 0, 1), focal_point=(0, 0, 0), up=(0, 1))
    Traceback (most recent call last):
    flowtex.rendering.camera.CameraError: camera.up is (0, 1); expected three finite numbers
    """


@dataclass(frozen=True)
class Camera:
    """The camera of a picture.

    Attributes
    ----------
    position, focal_point
        Position of the camera and the point that it looks at, in the mesh's coordinates.
    up
        Direction that points up in the picture, of any length.
    parallel
        Whether the projection is parallel, that is, without perspective.
    parallel_scale
        Half the height of the view in a parallel projection, in the mesh's units.
    view_angle
        Angle between the lower and the upper border of a perspective view, in degrees.

    Raises
    ------
    CameraError
        When values are out of range, or the camera sees nothing; the text lists all faults.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field()
    >>> camera = flowtex.Camera.fit(field.surface, aspect=2.0, zoom=4, focus=(0.5, 0.5))
    >>> flowtex.render(field, camera=camera, size=(160, 80), samples=5).shape
    (80, 160, 3)
    """

    position: Point
    focal_point: Point
    up: Point
    parallel: bool = False
    parallel_scale: float = 1.0
    view_angle: float = CAMERA_LIMITS.view_angle

    def __post_init__(self) -> None:
        """Check the values and bring them into plain Python numbers."""
        faults = []
        for name in ("position", "focal_point", "up"):
            value = getattr(self, name)
            if _is_point(value):
                object.__setattr__(self, name, _point(value))
            else:
                faults.append(f"camera.{name} is {brief(value)}; expected three finite numbers")
        for name, greatest, expected in (
            ("parallel_scale", sys.float_info.max, "a positive length"),
            ("view_angle", 180.0, "0 to 180 degrees"),
        ):
            value = getattr(self, name)
            if is_number(value) and 0 < value < greatest:
                object.__setattr__(self, name, float(value))
            else:
                faults.append(f"camera.{name} is {brief(value)}; expected {expected}")
        object.__setattr__(self, "parallel", bool(self.parallel))
        if not faults and not self._sees():
            faults.append(
                f"camera has position {self.position!r}, focal_point {self.focal_point!r} and up "
                f"{self.up!r} on one line; expected up to point away from the line of sight"
            )
        if faults:
            raise CameraError("; ".join(faults))

    def _sees(self) -> bool:
        with np.errstate(over="ignore", invalid="ignore", under="ignore"):
            ahead = np.subtract(self.focal_point, self.position)
            return 0 < float(np.linalg.norm(np.cross(ahead, self.up))) < math.inf

    @classmethod
    def fit(
        cls,
        surface: Surface,
        aspect: float = 1.5,
        *,
        zoom: float = 1.0,
        focus: ArrayLike | None = None,
        toward: Point | None = None,
        up: Point | None = None,
        margin: float = CAMERA_LIMITS.margin,
    ) -> Self:
        """Return the camera that shows a surface.

        Parameters
        ----------
        surface
            Surface to look at.
        aspect
            Width of the picture over its height.
        zoom
            1 shows the whole surface, 8 an eighth of its width.
        focus
            Point of the mesh to look at, two or three coordinates; the middle by default.
        toward, up
            Direction from a curved surface to the camera, and the direction up; they must not be
            parallel. By default a globe is seen from above its data, or above ``focus``, with north
            up.
        margin
            Share of the picture that stays empty at each side, from 0 to less than 0.5.

        Raises
        ------
        FieldError
            When ``zoom`` is not positive, ``focus`` is not a point, or ``margin`` is out of range.
        """
        expected = "a number from 0 to less than 0.5, such as 0.04"
        most = math.nextafter(0.5, 0.0)
        share = 1 - 2 * checked_number("margin", margin, 0.0, most, expected=expected)
        ends = NEAREST_REACH, FARTHEST_REACH
        expected = "a positive number, 1 for the whole surface, from {:g} to {:g}".format(*ends)
        zoom = checked_number("zoom", zoom, *ends, expected=expected)
        center = surface.center.copy()
        if focus is not None:
            if not (_is_point(focus, 2) or _is_point(focus, 3)):
                raise FieldError(
                    f"focus is {brief(focus)}; expected two or three coordinates of the mesh"
                )
            point = np.asarray(focus, dtype=float)
            center[: len(point)] = point
        if surface.frame is not None:  # straight on, the surface's own axes to the right and up
            right, upward = surface.frame
            width, height = surface.plane_size
            return cls(
                position=_point(center + np.cross(right, upward) * surface.extent),
                focal_point=_point(center),
                up=_point(upward),
                parallel=True,
                parallel_scale=float(0.5 * max(height, width / aspect) / share / zoom),
            )
        # A curved one from a side, so far away that the whole of it just fits.
        side = _side(center) if surface.on_globe else (ASIDE, UP)
        ahead = np.array(toward or side[0], dtype=float)
        up = up or side[1]
        ahead /= np.linalg.norm(ahead)
        right = np.cross(np.asarray(up, dtype=float), ahead)
        right /= np.linalg.norm(right)
        half = np.tan(np.radians(CAMERA_LIMITS.view_angle / 2))
        axes = np.stack([right, np.cross(ahead, right), ahead])
        offsets = surface.points[surface.valid] - surface.center
        distance = _distance_to_all(offsets, axes, aspect, share)
        # The middle of a sphere is not on it, so without a point the view only narrows.
        closer = min(zoom, CAMERA_LIMITS.closest if focus is not None else 1.0)
        return cls(
            position=_point(center + ahead * (distance / closer)),
            focal_point=_point(center),
            up=_point(up),
            parallel=False,
            parallel_scale=float(distance / closer * half * closer / zoom),
            view_angle=float(2 * np.degrees(np.arctan(half * closer / zoom))),
        )

    @classmethod
    def aside(cls, points: Floats, aspect: float, margin: float = CAMERA_LIMITS.margin) -> Self:
        """Return the camera that shows points in space (N, 3) from above and aside.

        Parameters
        ----------
        points
            Points in the mesh's coordinates, (N, 3).
        aspect
            Width of the picture over its height.
        margin
            Share of the picture that stays empty at each side.
        """
        center = (points.min(axis=0) + points.max(axis=0)) / 2
        ahead = np.array(ASIDE) / np.linalg.norm(ASIDE)
        right = np.cross(UP, ahead)
        right /= np.linalg.norm(right)
        axes = np.stack([right, np.cross(ahead, right), ahead])
        distance = _distance_to_all(points - center, axes, aspect, 1 - 2 * margin)
        return cls(position=_point(center + ahead * distance), focal_point=_point(center), up=UP)

    def sees_edge_on(self, surface: Surface) -> bool:
        """Return whether a flat surface is seen edge-on, or nearly so."""
        if surface.frame is None:
            return False
        normal = np.cross(*surface.frame)
        return bool(abs(self.axes[2] @ normal) < LEAST_FACING)

    @classmethod
    def from_dict(cls, values: Any, base: Camera | None = None) -> Self:
        """Return a camera from values by name, as :meth:`to_dict` returns them.

        All values are checked. Missing ones are taken from ``base``.

        Raises
        ------
        CameraError
            When a name is unknown, a value is missing without ``base``, or a value is invalid.
        """
        names = [f.name for f in fields(cls)]
        if not isinstance(values, Mapping) or not set(values) <= set(names):
            raise CameraError(
                f"camera is {brief(values)}; expected a mapping with some of {', '.join(names)}"
            )
        attributes = {**({} if base is None else asdict(base)), **values}
        missing = []
        for name in ("position", "focal_point", "up"):
            if name not in attributes:
                missing.append(name)
        if missing:
            raise CameraError(f"camera is {brief(values)}; expected {', '.join(missing)} as well")
        return cls(**attributes)

    @classmethod
    def from_points(cls, points: Any) -> Self:
        """Return a perspective camera from position, focal point and up direction.

        Raises
        ------
        CameraError
            When ``points`` are not three points.
        """
        try:
            position, focal_point, up = points
        except (TypeError, ValueError) as error:
            raise CameraError(
                f"camera is {brief(points)}; expected position, focal point and up, three points"
            ) from error
        return cls(position, focal_point, up)

    @classmethod
    def from_text(cls, text: str) -> Self:
        """Return the camera of :meth:`to_text`, or of the nine numbers of :meth:`from_points`.

        Raises
        ------
        CameraError
            When the text does not describe a camera, or the camera sees nothing.
        """
        kind, *words = re.split(r"[,\s]+", text.strip())
        numbers = [number_or_text(word) for word in ([kind, *words] if len(words) == 8 else words)]
        points = [tuple(numbers[start : start + 3]) for start in (0, 3, 6)]
        if len(words) == 8:
            return cls.from_points(points)
        if kind not in ("parallel", "perspective") or len(numbers) != 11:
            raise CameraError(
                f"camera is {text!r}; expected nine numbers: position, focal point and up"
            )
        scale, angle = numbers[9:]
        position, focal_point, up = points
        return cls(position, focal_point, up, kind == "parallel", scale, angle)  # type: ignore[arg-type]

    def to_text(self) -> str:
        """Return all attributes as one text without spaces."""
        numbers = (*self.position, *self.focal_point, *self.up)
        words = map(repr, (*numbers, self.parallel_scale, self.view_angle))
        return ",".join(["parallel" if self.parallel else "perspective", *words])

    def to_dict(self) -> CameraValues:
        """Return the attributes by name, for JSON."""
        return {k: list(v) if isinstance(v, tuple) else v for k, v in asdict(self).items()}

    @property
    def axes(self) -> Floats:
        """Unit vectors to the right, up and into the picture, one per row, (3, 3)."""
        ahead = np.subtract(self.focal_point, self.position)
        ahead /= np.linalg.norm(ahead)
        right = np.cross(ahead, self.up)
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(right, ahead), ahead])

    @property
    def distance(self) -> float:
        """Distance from the eye to the focal point."""
        return math.dist(self.position, self.focal_point)

    @property
    def height(self) -> float:
        """Half the height of the view at the focal point, in the mesh's units."""
        if self.parallel:
            return self.parallel_scale
        return self.distance * math.tan(math.radians(self.view_angle) / 2)

    @property
    def eye(self) -> Floats:
        """Position of the eye and 1; in a parallel projection the direction to it and 0, (4,)."""
        if self.parallel:
            return np.array([*-self.axes[2], 0.0])
        return np.array([*self.position, 1.0])

    def matrix(self, aspect: float, origin: ArrayLike = (0.0, 0.0, 0.0)) -> Floats:
        """Return the matrix that takes (x, y, z, 1) to clip space (x, y, z, w), (4, 4).

        x / w and y / w run from -1 to 1 across the picture, to the right and up, as in VTK. The
        matrix has no near or far plane: w is the distance in perspective and 1 otherwise, and z / w
        increases with the distance without limit.

        Parameters
        ----------
        aspect
            Width of the picture over its height.
        origin
            Point to which (x, y, z) is relative, (3,). A point in the middle of the surface keeps
            the precision of a mesh far from the origin.
        """
        axes = self.axes
        if self.parallel:
            half = self.parallel_scale
        else:
            half = float(np.tan(np.radians(self.view_angle / 2)))
        view = np.zeros((3, 4))
        view[:, :3] = axes
        view[:, 3] = axes @ np.subtract(origin, self.position, dtype=float)
        result = np.zeros((4, 4))
        result[0] = view[0] / (half * aspect)
        result[1] = view[1] / half
        if self.parallel:
            result[2] = view[2]
            result[3, 3] = 1.0
        else:
            result[2, 3] = -1.0
            result[3] = view[2]
        return result

    def project(self, points: ArrayLike, aspect: float) -> Floats:
        """Return positions in the view, (..., 2), of points (..., 3); NaN behind the camera."""
        # Relative to the focal point the digits are those of the view.
        offset = np.asarray(points, dtype=float) - np.asarray(self.focal_point)
        right, up, depth = (offset @ axis for axis in self.axes)
        positions = np.asarray(np.stack([right / aspect, up], axis=-1) / self.height)
        if self.parallel:
            return positions
        # At the distance of the focal point the projection is as without perspective.
        scale: Floats = np.asarray(1.0 + depth / self.distance)[..., None]
        return np.where(scale > 0, positions / np.where(scale > 0, scale, 1.0), np.nan)

    def ray(self, x: float, y: float, aspect: float) -> tuple[Floats, Floats]:
        """Return the origin and the unit direction of the ray through a point of the view."""
        right, up, ahead = self.axes
        target = np.asarray(self.focal_point) + (right * x * aspect + up * y) * self.height
        if self.parallel:
            start = target - ahead * self.distance
        else:
            start = np.asarray(self.position)
        return start, (target - start) / np.linalg.norm(target - start)

    def is_near(self, surface: Surface) -> bool:
        """Return whether double precision resolves the surface from this camera."""
        eye = np.asarray(self.position)
        focus = np.asarray(self.focal_point)
        offsets = np.abs([eye - surface.center, focus - surface.center])
        sizes = (float(np.abs(eye - focus).max()), self.parallel_scale)
        return bool(offsets.max() <= FARTHEST_REACH * surface.extent) and all(
            NEAREST_REACH <= size / surface.extent <= FARTHEST_REACH for size in sizes
        )


def can_share_camera(first: Surface, second: Surface) -> bool:
    """Return whether a camera that shows one surface shows the other one as well."""
    smaller, larger = sorted((first.extent, second.extent))
    distance = float(np.linalg.norm(first.center - second.center))
    near = distance <= MOST_APART * larger <= MOST_APART * MOST_LARGER * smaller
    return near and face_alike(first, second)


def face_alike(first: Surface, second: Surface) -> bool:
    """Return whether two surfaces are curved, or planes that face in nearly the same direction."""
    if first.frame is None or second.frame is None:
        return first.frame is None and second.frame is None
    cosine = float(np.cross(*first.frame) @ np.cross(*second.frame))
    return cosine > LEAST_PARALLEL


def _distance_to_all(offsets: Floats, axes: Floats, aspect: float, share: float) -> float:
    """Return the distance from which points (N, 3) around the middle fit into a picture."""
    half = np.tan(np.radians(CAMERA_LIMITS.view_angle / 2))
    x, y, z = axes @ offsets.T
    # Near points are seen larger.
    beside = np.maximum(np.abs(x) / aspect, np.abs(y)) / (half * share)
    return float(np.max(z + beside))


def _side(center: Floats) -> tuple[Point, Point]:
    if float(np.linalg.norm(center)) < LEAST_ASIDE * EARTH_RADIUS:
        return WHOLE_GLOBE, UP
    ahead = center / np.linalg.norm(center)
    if math.hypot(ahead[0], ahead[1]) < LEAST_ASIDE:  # at a pole, with longitude 0 below it
        return _point(ahead), (-math.copysign(1.0, ahead[2]), 0.0, 0.0)
    return _point(ahead), UP


def _is_point(value: Any, coordinates: int = 3) -> bool:
    try:
        numbers = np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        return False
    return numbers.shape == (coordinates,) and bool(np.isfinite(numbers).all())


def _point(values: ArrayLike) -> Point:
    x, y, z = (float(v) for v in np.asarray(values))
    return x, y, z


def read_camera(vtk_camera: Any) -> Camera:
    """Return a camera like a VTK camera, such as ``plotter.camera``.

    Raises
    ------
    CameraError
        When the VTK camera sees nothing, as its position is its focal point; a FieldError.
    """
    up = np.array(vtk_camera.GetViewUp())
    matrix = vtk_camera.GetModelViewTransformMatrix()
    up_on_screen = [matrix.GetElement(1, column) for column in range(3)]
    # Elevation over a pole turns the view and leaves ViewUp as it was.
    if np.dot(up, up_on_screen) < 0:
        up = -up
    return Camera(
        position=vtk_camera.GetPosition(),
        focal_point=vtk_camera.GetFocalPoint(),
        up=tuple(up.tolist()),
        parallel=bool(vtk_camera.GetParallelProjection()),
        parallel_scale=vtk_camera.GetParallelScale(),
        view_angle=vtk_camera.GetViewAngle(),
    )


def apply_camera(camera: Camera, vtk_camera: Any) -> None:
    """Give a VTK camera the attributes of another camera."""
    vtk_camera.SetPosition(*camera.position)
    vtk_camera.SetFocalPoint(*camera.focal_point)
    vtk_camera.SetViewUp(*camera.up)
    vtk_camera.SetParallelProjection(camera.parallel)
    if hasattr(vtk_camera, "parallel_projection"):  # PyVista's camera has its own flag
        vtk_camera.parallel_projection = camera.parallel
    vtk_camera.SetParallelScale(camera.parallel_scale)
    vtk_camera.SetViewAngle(camera.view_angle)
