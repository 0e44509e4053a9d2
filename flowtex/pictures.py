"""One picture, or one window, from a mesh: :func:`render` and :func:`show`."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from flowtex.camera import look
from flowtex.doctor import has_display, prefer_headless, require_opengl
from flowtex.field import FlowField
from flowtex.handle import FlowHandle
from flowtex.plotter import FIELD_ARGUMENTS, FlowtexComponent, as_field

if TYPE_CHECKING:
    from flowtex.widget import FlowWidget

__all__ = ["in_notebook", "render", "show"]

#: Width and height of a window.
WINDOW = (1024, 768)

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
    size: tuple[int, int] | None = None,
    zoom: float = 1.0,
    focus: tuple[float, ...] | None = None,
    beside: Changes | None = None,
    **options: Any,
) -> FlowWidget | None:
    """Show a flow: in a notebook as a widget, else in a window or on a page in the browser.

    A notebook's kernel draws nothing, the browser does. Elsewhere a window is opened, and where
    there is no display a page is served.

    Parameters
    ----------
    mesh
        What ``plotter.flowtex.add`` takes.
    size
        Width and height of the window in pixels; 1024 x 768, and in a notebook as wide as the
        cell.
    zoom, focus
        How far in, and on what point of the mesh, the window begins.
    beside
        What is different in a second view to the right of the first one, such as
        ``{"lod": False}``; both views move together. It needs a window.
    **options
        Further arguments and settings of ``plotter.flowtex.add``, such as ``image``.

    Returns
    -------
    FlowWidget or None
        In a notebook the widget, which is displayed already; else nothing.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
    OpenGLMissingError
        When nothing can draw; the text names the command that installs what is missing.
    ModuleNotFoundError
        When a notebook lacks what widgets need; the text names the command that installs it.
    ValueError
        When two views are asked for and there is no window.
    """
    if in_notebook():
        return _show_widget(mesh, size=size, zoom=zoom, focus=focus, beside=beside, **options)
    size = size or WINDOW
    prefer_headless()
    require_opengl()
    field = as_field(mesh, **{k: options.pop(k, None) for k in FIELD_ARGUMENTS})
    if not has_display():
        if beside is not None:
            msg = "two views need a window and there is no display; flowtex.render draws both"
            raise ValueError(msg)
        from flowtex.app import serve

        serve(field, zoom=zoom, focus=focus, **options)
        return None
    plotter = _plotter(size, beside)
    plotter.disable_anti_aliasing()
    plotter.set_background("white")
    _put(plotter, field, options, beside)
    look(plotter, field, zoom=zoom, focus=focus)
    plotter.show()
    return None


def in_notebook() -> bool:
    """Tell whether a notebook's kernel runs this; IPython is not loaded to find out."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return getattr(shell, "kernel", None) is not None


def _show_widget(
    mesh: Any, *, size: tuple[int, int] | None, beside: Changes | None, **options: Any
) -> FlowWidget:
    if beside is not None:
        msg = "two views need a window; flowtex.render draws both as one picture"
        raise ValueError(msg)
    from flowtex.widget import FlowWidget

    if size is not None:
        options["size"] = size
    return FlowWidget(mesh, **options).show()


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
