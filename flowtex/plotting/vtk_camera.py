"""Between :class:`~flowtex.rendering.camera.Camera` and the camera of a VTK renderer."""

from __future__ import annotations

from typing import Any

from vtkmodules.vtkRenderingCore import vtkCamera, vtkRenderer

from flowtex.field import Surface
from flowtex.rendering.camera import CAMERA_LIMITS, Camera
from flowtex.scene.options import ViewOptions

#: A view of the whole surface.
WHOLE = ViewOptions()


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


def point_camera(
    plotter: Any, surface: Surface, view: ViewOptions = WHOLE, margin: float = CAMERA_LIMITS.margin
) -> None:
    """Point a plotter's camera at a surface as a view requests.

    PyVista does not change a camera that is set, even if it clips objects that are added later; so
    the clipping range follows the bounds of the objects, and otherwise stays. Raises a FieldError
    when the view's camera, zoom or focus, or the margin, is invalid.
    """
    (width, height), renderer = plotter.window_size, plotter.renderer
    left, bottom, right, top = renderer.GetViewport()
    aspect = float(width * (right - left)) / max(float(height * (top - bottom)), 1.0)
    apply_camera(view.first_camera(surface, aspect, margin), plotter.camera)
    plotter.camera_set = True
    bounds = renderer.ComputeVisiblePropBounds()

    def follow_bounds(caller: vtkRenderer, _: str) -> None:
        nonlocal bounds
        new_bounds = caller.ComputeVisiblePropBounds()
        if new_bounds != bounds:
            caller.ResetCameraClippingRange()
        bounds = new_bounds

    renderer.reset_camera_clipping_range()
    renderer.AddObserver("StartEvent", follow_bounds)
