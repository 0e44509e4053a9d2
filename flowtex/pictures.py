"""One picture, or one window, from a mesh: :func:`render` and :func:`show`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from flowtex.camera import look
from flowtex.doctor import has_display, prefer_headless, require_opengl
from flowtex.field import FlowField
from flowtex.handle import FlowHandle
from flowtex.plotter import FIELD_ARGUMENTS, FlowtexComponent, as_field

__all__ = ["render", "show"]

Changes = Mapping[str, Any]


def render(
    mesh: Any,
    *,
    size: tuple[int, int] = (1024, 768),
    zoom: float = 1.0,
    focus: tuple[float, ...] | None = None,
    time: float | None = None,
    clock: float = 0.0,
    background: Any = "white",
    camera_position: Any | None = None,
    beside: Changes | None = None,
    **options: Any,
) -> NDArray[np.uint8]:
    """Draw a flow without a window.

    Parameters
    ----------
    mesh
        What ``plotter.flowtex.add`` takes.
    size
        Width and height in pixels.
    zoom, focus
        How far in, and on what point of the mesh; the whole surface by default.
    time
        Time to show of a field that varies in time; its last step by default.
    clock
        Moment of the streaming of a steady flow, in seconds (see the setting ``motion``).
    background
        Colour behind the surface.
    camera_position
        Another view, as PyVista takes it.
    beside
        What is different in a second view, which is drawn to the right of the first one, such
        as ``{"lod": False}``. Each view then has half the width.
    **options
        Further arguments and settings of ``plotter.flowtex.add``, such as ``image``.

    Returns
    -------
    numpy.ndarray
        The picture, (height, width, 3) uint8, row 0 at the top.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
    OpenGLMissingError
        When nothing can draw; the text names the command that installs what is missing.
    """
    require_opengl()
    field = as_field(mesh, **{k: options.pop(k, None) for k in FIELD_ARGUMENTS})
    plotter = _plotter(size, beside, off_screen=True, lighting="light kit")
    try:
        plotter.enable_anti_aliasing("msaa", multi_samples=4)  # smooths the outline
        plotter.set_background(background)
        handles = _put(plotter, field, {"show_scalar_bar": False, **options}, beside)
        for handle in handles:
            if time is not None:
                handle.time = time
            handle.clock = clock
        if camera_position is not None:
            plotter.camera.parallel_projection = False
            plotter.camera_position = camera_position
        else:
            look(plotter, field, zoom=zoom, focus=focus)
        picture: Any = plotter.screenshot(return_img=True)
        for handle in handles:
            handle.remove(render=False)
    finally:
        plotter.close()
    return np.asarray(picture[..., :3], dtype=np.uint8)


def show(
    mesh: Any,
    *,
    size: tuple[int, int] = (1024, 768),
    zoom: float = 1.0,
    focus: tuple[float, ...] | None = None,
    beside: Changes | None = None,
    **options: Any,
) -> None:
    """Show a flow: in a window, or where there is no display on a page in the browser.

    Parameters
    ----------
    mesh
        What ``plotter.flowtex.add`` takes.
    size
        Width and height of the window in pixels.
    zoom, focus
        How far in, and on what point of the mesh, the window begins.
    beside
        What is different in a second view to the right of the first one, such as
        ``{"lod": False}``; both views move together. It needs a window.
    **options
        Further arguments and settings of ``plotter.flowtex.add``, such as ``image``.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
    OpenGLMissingError
        When nothing can draw; the text names the command that installs what is missing.
    ValueError
        When two views are asked for and there is no display.
    """
    prefer_headless()
    require_opengl()
    field = as_field(mesh, **{k: options.pop(k, None) for k in FIELD_ARGUMENTS})
    if not has_display():
        if beside is not None:
            msg = "two views need a window and there is no display; flowtex.render draws both"
            raise ValueError(msg)
        from flowtex.app import serve

        serve(field, zoom=zoom, focus=focus, **options)
        return
    plotter = _plotter(size, beside)
    plotter.disable_anti_aliasing()
    plotter.set_background("white")
    _put(plotter, field, options, beside)
    look(plotter, field, zoom=zoom, focus=focus)
    plotter.show()


def _plotter(size: tuple[int, int], beside: Changes | None, **options: Any) -> Any:
    shape = (1, 1) if beside is None else (1, 2)
    return pv.Plotter(window_size=list(size), shape=shape, border=False, **options)


def _put(
    plotter: Any, field: FlowField, options: Changes, beside: Changes | None
) -> list[FlowHandle]:
    """Add the flow to one view, or to two that share a camera and say how they differ."""
    component = FlowtexComponent(plotter)
    if beside is None:
        return [component.add(field, **options)]
    handles = []
    for column, chosen in enumerate((options, {**options, **beside})):
        plotter.subplot(0, column)
        handles.append(component.add(field, **chosen))
        label = plotter.add_text(_difference(handles[-1], beside), font_size=9, color="black")
        label.prop.background_color, label.prop.background_opacity = "white", 0.8
    plotter.link_views()
    plotter.subplot(0, 0)
    return handles


def _difference(handle: FlowHandle, beside: Changes) -> str:
    """Tell the settings by which one of two views differs from the other."""
    settings = dict(handle.settings)
    return ", ".join(f"{name} = {settings[name]}" for name in beside if name in settings)
