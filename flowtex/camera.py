"""Cameras that show a flow well: straight on where it is flat, from above and aside where not."""

from __future__ import annotations

from typing import Any

import numpy as np

from flowtex.field import FlowField

__all__ = ["look"]

#: Share of the window that is left empty around a flat surface.
MARGIN = 0.04
#: How many times closer the camera comes; nearer, what is close would be cut off with what is far.
CLOSEST = 16.0
#: View angle from above and aside at zoom 1, in degrees.
VIEW_ANGLE = 30.0


def look(
    plotter: Any,
    field: FlowField,
    *,
    zoom: float = 1.0,
    focus: tuple[float, ...] | None = None,
) -> None:
    """Point a plotter's camera at a field.

    Parameters
    ----------
    plotter
        A PyVista plotter.
    field
        What to look at.
    zoom
        1 shows the whole surface, 8 an eighth of its width.
    focus
        Point of the mesh to look at, two or three coordinates; the middle by default.

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
        _look_at_curved(plotter, field, centre, zoom, come_closer=focus is not None)
    else:
        _look_at_flat(plotter, field, centre, zoom)
    plotter.renderer.reset_camera_clipping_range()


def _look_at_flat(plotter: Any, field: FlowField, centre: Any, zoom: float) -> None:
    """Straight on, without perspective, the surface's own axes to the right and up."""
    surface = field.surface
    frame = surface.frame
    right, up = frame if frame is not None else np.eye(3)[:2]
    toward = np.cross(right, up)
    local = (surface.points[surface.valid] - surface.center) @ np.stack([right, up]).T
    width, height = np.ptp(local, axis=0)
    aspect = _aspect(plotter)
    camera = plotter.camera
    camera.focal_point = tuple(centre)
    camera.position = tuple(centre + toward * surface.extent)
    camera.up = tuple(up)
    camera.parallel_projection = True
    camera.parallel_scale = 0.5 * max(height, width / aspect) / (1 - 2 * MARGIN) / zoom
    plotter.camera_set = True


def _aspect(plotter: Any) -> float:
    """Width over height of the part of the window that the present subplot fills."""
    width, height = plotter.window_size
    left, bottom, right, top = plotter.renderer.GetViewport()
    return float(width * (right - left)) / max(float(height * (top - bottom)), 1.0)


def _look_at_curved(
    plotter: Any, field: FlowField, centre: Any, zoom: float, *, come_closer: bool
) -> None:
    """From above and aside, so far away that the whole surface just fits.

    With a point on the surface to look at, the camera comes closer to it, and then the view grows
    narrower. The middle of a sphere is not on it, so without a point the view only grows narrower.
    """
    plotter.view_isometric(render=False)
    camera = plotter.camera
    toward = np.asarray(camera.position) - np.asarray(camera.focal_point)
    toward /= np.linalg.norm(toward)
    right = np.cross(camera.up, toward)
    right /= np.linalg.norm(right)
    up = np.cross(toward, right)
    camera.view_angle = VIEW_ANGLE
    half = np.tan(np.radians(VIEW_ANGLE / 2))
    surface = field.surface
    x, y, z = np.stack([right, up, toward]) @ (surface.points[surface.valid] - surface.center).T
    wide, high = np.abs(x) / _aspect(plotter), np.abs(y)
    distance = float(np.max(z + np.maximum(wide, high) / half / (1 - 2 * MARGIN)))
    camera.focal_point = tuple(centre)
    closer = min(zoom, CLOSEST) if come_closer else 1.0
    camera.position = tuple(centre + toward * (distance / closer))
    camera.view_angle = 2 * np.degrees(np.arctan(half * closer / zoom))
    plotter.camera_set = True
