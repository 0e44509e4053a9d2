"""One picture, or one window, from a mesh: :func:`render` and :func:`show`."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from flowtex.diagnostics import has_display, prefer_headless, require_opengl
from flowtex.offscreen.studio import Changes, Studio, new_plotter, put
from flowtex.plotting.component import FIELD_ARGUMENTS, as_field
from flowtex.plotting.vtk_camera import look

if TYPE_CHECKING:
    from flowtex.widget import FlowWidget

__all__ = ["in_notebook", "render", "show"]

#: Width and height of a window.
WINDOW = (1024, 768)
#: Arguments of ``plotter.flowtex.add`` that say something to VTK alone.
WINDOWED = ("scalar_bar_args", "reset_camera")


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
    supersampling: int = 1,
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
    supersampling
        Times that the picture is drawn larger along each side and averaged, 1 to 8: 2 takes four
        times as long and smooths what is finer than a pixel. Grains keep their size.
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
    ValueError
        When the picture would be too large to draw.
    """
    with Studio(
        mesh,
        size=size,
        zoom=zoom,
        focus=focus,
        background=background,
        camera_position=camera_position,
        beside=beside,
        supersampling=supersampling,
        **options,
    ) as studio:
        return studio.picture(time=time, clock=clock)


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
        ``{"lod": False}``; both views move together. It needs a window or a notebook.
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
        When two views are asked for and there is neither a window nor a notebook.
    TypeError
        When a notebook is given what only a window has.
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
    plotter = new_plotter(size, beside)
    plotter.disable_anti_aliasing()
    plotter.set_background("white")
    put(plotter, field, options, beside)
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
    for name in WINDOWED:
        if name in options:
            msg = (
                f"{name} is for windows, and the browser draws this; leave it out, or draw with "
                "flowtex.render, or with plotter.flowtex.add and plotter.show"
            )
            raise TypeError(msg)
    from flowtex.widget import FlowWidget

    if size is not None:
        options["size"] = size
    return FlowWidget(mesh, beside=beside, **options).show()
