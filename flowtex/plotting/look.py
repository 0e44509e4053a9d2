"""Puts a PyVista plotter's camera where a flow is seen well."""

from __future__ import annotations

from typing import Any

from flowtex.field import FlowField
from flowtex.first_look import first_look

__all__ = ["look"]


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
    found = first_look(field, _aspect(plotter), zoom=zoom, focus=focus)
    camera = plotter.camera
    camera.focal_point = found.focal_point
    camera.position = found.position
    camera.up = found.up
    if found.parallel:
        camera.parallel_projection = True
        camera.parallel_scale = found.parallel_scale
    else:
        camera.view_angle = found.view_angle
    plotter.camera_set = True
    plotter.renderer.reset_camera_clipping_range()


def _aspect(plotter: Any) -> float:
    """Width over height of the part of the window that the present subplot fills."""
    width, height = plotter.window_size
    left, bottom, right, top = plotter.renderer.GetViewport()
    return float(width * (right - left)) / max(float(height * (top - bottom)), 1.0)
