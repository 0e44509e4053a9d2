"""PyVista's Jupyter backend ``"flowtex"``: a plotter with its flow, drawn by the browser.

PyVista finds :func:`show_plotter` through its entry point. It may use a backend found this way as
the default if no other is installed; this one then falls back to what PyVista does without it.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from typing import Any

from flowtex.rendering.diagnostics import OpenGLMissingError, begin_trial, require_opengl

NAME = "flowtex"


def show_plotter(plotter: Any, *, screenshot: Any = None, **options: Any) -> Any:
    """Show a plotter with a flow texture in the notebook, from the plotter's own camera.

    Called by ``plotter.show``; the options, its ``jupyter_kwargs``, are further arguments of the
    :class:`flowtex.FlowWidget` that is returned. A warning lists what the browser does not draw.
    """
    if not _is_requested():
        import pyvista as pv
        from pyvista.jupyter.notebook import show_static_image

        for backend in pv.registered_jupyter_backends():
            if backend.name != NAME:
                return backend.handler(plotter, screenshot=screenshot, **options)
        return show_static_image(plotter, screenshot)
    if screenshot:
        plotter.screenshot(screenshot)
    begin_trial()
    from flowtex.widget import FlowWidget

    width, height = plotter.window_size
    widget = FlowWidget(plotter, **{"size": (int(width), int(height)), **options})
    with suppress(OpenGLMissingError):
        require_opengl()
        plotter.render()
        widget.set_still(plotter.screenshot(return_img=True))
    return widget


def _is_requested() -> bool:
    """Return whether the user has named this backend, which only frames of the caller tell."""
    frame = sys._getframe(1)
    while (caller := frame.f_back) is not None:
        frame = caller
        if frame.f_code.co_name == "show" and "jupyter_backend" in frame.f_locals:
            named = frame.f_locals["jupyter_backend"]
            return named is not None and str(named).lower() == NAME
    return True
