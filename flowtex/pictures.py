"""One picture, or one window, from a mesh: :func:`render` and :func:`show`."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from flowtex.camera import look
from flowtex.doctor import has_display, prefer_headless, require_opengl
from flowtex.plotter import FIELD_ARGUMENTS, FlowtexComponent, as_field

__all__ = ["render", "show"]


def render(
    mesh: Any,
    *,
    size: tuple[int, int] = (1024, 768),
    zoom: float = 1.0,
    focus: tuple[float, ...] | None = None,
    time: float | None = None,
    background: Any = "white",
    camera_position: Any | None = None,
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
    background
        Colour behind the surface.
    camera_position
        Another view, as PyVista takes it.
    **options
        Further arguments and settings of ``plotter.flowtex.add``.

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
    plotter = pv.Plotter(off_screen=True, window_size=list(size), lighting="light kit")
    try:
        plotter.enable_anti_aliasing("msaa", multi_samples=4)  # smooths the outline
        plotter.set_background(background)
        handle = FlowtexComponent(plotter).add(field, **{"show_scalar_bar": False, **options})
        if time is not None:
            handle.time = time
        if camera_position is not None:
            plotter.camera_position = camera_position
        else:
            look(plotter, field, zoom=zoom, focus=focus)
        picture: Any = plotter.screenshot(return_img=True)
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
    **options
        Further arguments and settings of ``plotter.flowtex.add``.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
    OpenGLMissingError
        When nothing can draw; the text names the command that installs what is missing.
    """
    prefer_headless()
    require_opengl()
    field = as_field(mesh, **{k: options.pop(k, None) for k in FIELD_ARGUMENTS})
    if not has_display():
        from flowtex.app import serve

        serve(field, zoom=zoom, focus=focus, **options)
        return
    plotter: Any = pv.Plotter(window_size=list(size))
    plotter.disable_anti_aliasing()
    plotter.set_background("white")
    FlowtexComponent(plotter).add(field, **options)
    look(plotter, field, zoom=zoom, focus=focus)
    plotter.show()
