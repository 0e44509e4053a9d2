"""PyVista's Jupyter backend ``"flowtex"``: a plotter with its flow, drawn by the browser.

PyVista finds :func:`show_plotter` through its entry point. A backend that is found so may be
taken for the default where no other is installed; this one then stands back.
"""

from __future__ import annotations

import sys
from typing import Any

NAME = "flowtex"


def show_plotter(plotter: Any, *, screenshot: Any = None, **options: Any) -> Any:
    """Show a plotter with a flow texture in the notebook, from the plotter's own camera.

    Called by ``plotter.show``; the options, its ``jupyter_kwargs``, are further arguments of the
    :class:`flowtex.FlowWidget` that is returned. What the browser does not draw is warned of.
    """
    if not _asked_for():
        return _instead(plotter, screenshot, options)
    if screenshot:
        plotter.screenshot(screenshot)
    from flowtex.widget import FlowWidget

    width, height = plotter.window_size
    return FlowWidget(plotter, **{"size": (int(width), int(height)), **options})


def _asked_for() -> bool:
    """Return whether the user has named this backend.

    PyVista does not say whether a backend was named or is merely the first that was found, so the
    caller's argument is inspected; where that has another form, being called counts.
    """
    frame = sys._getframe(1)
    while (caller := frame.f_back) is not None:
        frame = caller
        if frame.f_code.co_name == "show" and "jupyter_backend" in frame.f_locals:
            named = frame.f_locals["jupyter_backend"]
            return named is not None and str(named).lower() == NAME
    return True


def _instead(plotter: Any, screenshot: Any, options: dict[str, Any]) -> Any:
    """Do what PyVista would do if this backend were not installed."""
    import pyvista as pv
    from pyvista.jupyter.notebook import show_static_image

    for backend in pv.registered_jupyter_backends():
        if backend.name != NAME:
            return backend.handler(plotter, screenshot=screenshot, **options)
    return show_static_image(plotter, screenshot)
