"""Between :class:`~flowtex.rendering.camera.Camera` and the camera of a VTK renderer."""

from __future__ import annotations

from typing import Any

from vtkmodules.vtkRenderingCore import vtkCamera, vtkRenderer

from flowtex.field import FlowField
from flowtex.rendering.camera import CAMERA_LIMITS, Camera, read_camera

__all__ = ["apply_camera", "look", "read_camera", "subplot_aspect"]


def apply_camera(camera: Camera, vtk_camera: vtkCamera) -> None:
    """Give a VTK camera the attributes of another camera."""
    vtk_camera.SetPosition(*camera.position)
    vtk_camera.SetFocalPoint(*camera.focal_point)
    vtk_camera.SetViewUp(*camera.up)
    vtk_camera.SetParallelProjection(camera.parallel)
    if hasattr(vtk_camera, "parallel_projection"):  # PyVista's camera has its own flag
        vtk_camera.parallel_projection = camera.parallel
    vtk_camera.SetParallelScale(camera.parallel_scale)
    vtk_camera.SetViewAngle(camera.view_angle)


def look(
    plotter: Any,
    field: FlowField,
    *,
    zoom: float = 1.0,
    focus: tuple[float, ...] | None = None,
    margin: float = CAMERA_LIMITS.margin,
) -> None:
    """Point a plotter's camera at a field; :meth:`Camera.fit` has the parameters.

    PyVista does not change a camera that is set, even if it clips objects that are added later; so
    the clipping range follows the bounds of the objects, and otherwise stays.
    """
    aspect = subplot_aspect(plotter)
    camera = Camera.fit(field.surface, aspect, zoom=zoom, focus=focus, margin=margin)
    apply_camera(camera, plotter.camera)
    plotter.camera_set = True
    renderer = plotter.renderer
    bounds = renderer.ComputeVisiblePropBounds()

    def follow_bounds(caller: vtkRenderer, _: str) -> None:
        nonlocal bounds
        new_bounds = caller.ComputeVisiblePropBounds()
        if new_bounds != bounds:
            caller.ResetCameraClippingRange()
        bounds = new_bounds

    renderer.reset_camera_clipping_range()
    renderer.AddObserver("StartEvent", follow_bounds)


def subplot_aspect(plotter: Any) -> float:
    """Return width over height of the part of the window that the present subplot fills."""
    width, height = plotter.window_size
    left, bottom, right, top = plotter.renderer.GetViewport()
    return float(width * (right - left)) / max(float(height * (top - bottom)), 1.0)
