"""Display of a flow or a plotter in a notebook, in a window or on a page."""

from __future__ import annotations

import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from flowtex._util.arguments import checked_size
from flowtex._util.pyvista_internals import named_backend
from flowtex.errors import FieldError, require_pyvista
from flowtex.field.options import FieldOptions, accepts_options, option_names
from flowtex.scene.array_arguments import takes_arrays
from flowtex.scene.fields import read_field
from flowtex.scene.options import Appearance, Options, ViewOptions

if TYPE_CHECKING:
    from flowtex.host.flow_widget import FlowWidget

#: Width and height of a window, in pixels.
WINDOW_SIZE = (1024, 768)
#: Name of PyVista's Jupyter backend that draws in the browser.
BACKEND = "flowtex"


@takes_arrays()
@accepts_options(FieldOptions, Appearance, ViewOptions)
def show(mesh: Any, *, size: tuple[int, int] | None = None, **options: Any) -> FlowWidget | None:
    """Show a flow as a widget in a notebook, otherwise in a window or on a page in the browser.

    In a notebook the browser draws, not the Jupyter kernel. Elsewhere a window opens; without a
    display, a page is served.

    Parameters
    ----------
    mesh
        PyVista mesh, list of meshes in time, xarray dataset, :class:`~flowtex.FlowField`, path of a
        file, or plain arrays by position: ``x, y, u, v`` as in ``plt.streamplot``.
    size
        Width and height of the window in pixels; 1024 x 768 by default, and in a notebook the width
        of the cell. A page has the size of the browser's window.
    {options}

    Returns
    -------
    FlowWidget or None
        In a notebook the widget, which is already displayed; otherwise None.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting is invalid, when two views or a size are requested and neither a
        window nor a notebook is available, or when an argument for windows is used in a browser.
    OpenGLMissingError
        When OpenGL is missing; the text names the command that installs it.
    ModuleNotFoundError
        When a package that widgets need is missing; the text names the command that installs it.

    Examples
    --------
    >>> import flowtex
    >>> mesh = flowtex.examples.cylinder()
    >>> flowtex.show(mesh, scalars="vorticity", cmap="RdBu_r", zoom=3)  # doctest: +SKIP
    """
    if in_notebook():
        from flowtex.host.flow_widget import FlowWidget

        if size is not None:
            options["size"] = size
        return FlowWidget(mesh, **options).show()
    from flowtex.rendering.diagnostics import has_display, prefer_headless, require_opengl

    require_pyvista("a window or a page with a server")
    prefer_headless()
    require_opengl()
    if has_display():
        _show_window(mesh, size or WINDOW_SIZE, options)
    else:
        _show_page(mesh, size, options)
    return None


def in_notebook() -> bool:
    """Return whether a notebook runs this; neither IPython nor marimo is loaded to find out."""
    if (marimo := sys.modules.get("marimo")) is not None and marimo.running_in_notebook():
        return True
    ipython = sys.modules.get("IPython")
    if ipython is not None:
        shell = ipython.get_ipython()
    else:
        shell = None
    return getattr(shell, "kernel", None) is not None


def _show_window(mesh: Any, size: tuple[int, int], options: dict[str, Any]) -> None:
    """Open a window with a flow, until it is closed."""
    from flowtex.plotting.component import open_plotter
    from flowtex.scene.scene import make_scenes

    bar_options = options.pop("scalar_bar_args", None)
    arguments = Options.split(**options)
    size = checked_size(size)
    scenes = make_scenes(mesh, arguments)
    plotter, _ = open_plotter(scenes, arguments.view, size, scalar_bar_args=bar_options)
    plotter.show()


def _show_page(mesh: Any, size: tuple[int, int] | None, options: dict[str, Any]) -> None:
    """Serve a page with a flow, until it ends."""
    for name, value in (("size", size), ("beside", options.pop("beside", None))):
        if value is not None:
            raise FieldError(
                f"{name} is {value!r}, but without a display there is a page, which has none; "
                f"omit {name}, or draw with flowtex.render"
            )
    field = read_field(mesh, Options.split(**options).field)
    from flowtex.app import serve

    for name in option_names(FieldOptions):
        options.pop(name, None)
    serve(field, **options)


def show_plotter(plotter: Any, *, screenshot: Any = None, **options: Any) -> Any:
    """Show a plotter with a flow texture in the notebook, from the plotter's own camera.

    PyVista finds this function through its entry point, and calls it in ``plotter.show``; the
    options, its ``jupyter_kwargs``, are further arguments of the :class:`flowtex.FlowWidget` that
    is returned. A warning lists what the browser does not draw. PyVista may use a backend found
    this way as the default if no other is installed: then it does what PyVista does without it.
    PyVista also calls it in place of a missing backend; then the error names its package.

    Raises
    ------
    ModuleNotFoundError
        When the chosen ``jupyter_backend`` is another one whose package is missing.
    """
    named = named_backend(BACKEND)
    if named is None:
        return _show_as_pyvista(plotter, screenshot, options)
    if named != BACKEND:
        raise ModuleNotFoundError(
            f"jupyter_backend is {named!r}, which needs trame-pyvista, but that is missing; "
            'install it with python -m pip install "pyvista[jupyter]", or choose '
            f'jupyter_backend="{BACKEND}" or "static"',
            name="trame_pyvista",
        )
    return _show_widget(plotter, screenshot, options)


def _show_as_pyvista(plotter: Any, screenshot: Any, options: dict[str, Any]) -> Any:
    """Show a plotter with another backend, or as a still picture without one."""
    import pyvista as pv
    from pyvista.jupyter.notebook import show_static_image

    for backend in pv.registered_jupyter_backends():
        if backend.name != BACKEND:
            return backend.handler(plotter, screenshot=screenshot, **options)
    return show_static_image(plotter, screenshot)


def _show_widget(plotter: Any, screenshot: Any, options: dict[str, Any]) -> FlowWidget:
    """Return the widget of a plotter, with a still where the kernel can draw one."""
    from flowtex.rendering.diagnostics import OpenGLMissingError, begin_trial, require_opengl

    if screenshot:
        plotter.screenshot(screenshot)
    begin_trial()
    from flowtex.host.flow_widget import FlowWidget

    width, height = plotter.window_size
    widget = FlowWidget(plotter, **{"size": (int(width), int(height)), **options})
    with suppress(OpenGLMissingError):
        require_opengl()
        plotter.render()
        widget.set_still(plotter.screenshot(return_img=True))
    return widget
