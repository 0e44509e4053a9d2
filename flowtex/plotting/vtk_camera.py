"""Between :class:`~flowtex.rendering.camera.Camera` and the camera of a VTK renderer."""

from __future__ import annotations

from typing import Any

from flowtex.field import FlowField
from flowtex.rendering.camera import CAMERA_LIMITS, Camera


def read_camera(vtk_camera: Any) -> Camera:
    """Return what a VTK camera has, such as ``plotter.camera``; it must see something."""
    return Camera(
        position=vtk_camera.GetPosition(),
        focal_point=vtk_camera.GetFocalPoint(),
        up=vtk_camera.GetViewUp(),
        parallel=bool(vtk_camera.GetParallelProjection()),
        parallel_scale=vtk_camera.GetParallelScale(),
        view_angle=vtk_camera.GetViewAngle(),
    )


def apply_camera(camera: Camera, vtk_camera: Any) -> None:
    """Put a VTK camera where another one stands."""
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

    PyVista leaves a camera that is set as it is, also where it cuts off what is added later; so
    the clipping range follows the bounds of what is there, and is otherwise left alone.
    """
    aspect = subplot_aspect(plotter)
    camera = Camera.fit(field.surface, aspect, zoom=zoom, focus=focus, margin=margin)
    apply_camera(camera, plotter.camera)
    plotter.camera_set = True
    renderer = plotter.renderer
    bounds = renderer.ComputeVisiblePropBounds()

    def follow_bounds(caller: Any, _: str) -> None:
        nonlocal bounds
        now = caller.ComputeVisiblePropBounds()
        if now != bounds:
            caller.ResetCameraClippingRange()
        bounds = now

    renderer.reset_camera_clipping_range()
    renderer.AddObserver("StartEvent", follow_bounds)


def subplot_aspect(plotter: Any) -> float:
    """Width over height of the part of the window that the present subplot fills."""
    width, height = plotter.window_size
    left, bottom, right, top = plotter.renderer.GetViewport()
    return float(width * (right - left)) / max(float(height * (top - bottom)), 1.0)
