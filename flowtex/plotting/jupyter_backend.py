"""PyVista's Jupyter backend ``"flowtex"``: the flow of a plotter, drawn by the browser.

PyVista finds :func:`show_plotter` through its entry point. A backend that is found so may be
taken for the default where no other is installed; this one then stands back.
"""

from __future__ import annotations

import sys
import warnings
from typing import Any

import numpy as np

from flowtex.errors import FieldError
from flowtex.plotting.handle import FlowHandle
from flowtex.plotting.vtk_camera import read_camera
from flowtex.textures.images import as_image

NAME = "flowtex"


def show_plotter(plotter: Any, *, screenshot: Any = None, **options: Any) -> Any:
    """Show the flow texture of a plotter in the notebook, from the plotter's own camera.

    Called by ``plotter.show``; the options, its ``jupyter_kwargs``, are further arguments of the
    :class:`flowtex.FlowWidget` that is returned. What the browser does not draw is warned of.
    """
    if not _asked_for():
        return _instead(plotter, screenshot, options)
    handles = list(plotter.flowtex)
    if not handles:
        msg = (
            "there is no flow texture on this plotter; add one with plotter.flowtex.add(mesh), or "
            "choose another jupyter_backend"
        )
        raise FieldError(msg)
    shown = handles[0]
    if left_out := _left_out(plotter, shown):
        warnings.warn(
            f"The backend 'flowtex' draws one flow texture, and leaves out: {', '.join(left_out)}; "
            "another jupyter_backend, such as 'trame', draws them.",
            stacklevel=2,
        )
    if screenshot:
        plotter.screenshot(screenshot)
    from flowtex.widget import FlowWidget

    return FlowWidget(shown.field, **{**_look_of(plotter, shown), **options})


def _look_of(plotter: Any, handle: FlowHandle) -> dict[str, Any]:
    """Return the arguments of a widget that looks the same."""
    mapper = handle.actor.mapper
    width, height = plotter.window_size
    name = handle.scene.scalar_name
    colours: dict[str, Any] = {"scalars": False, "color": handle.actor.prop.color}
    if name is not None:
        table = np.asarray(mapper.lookup_table.values)
        colours = {"scalars": name, "cmap": table, "clim": tuple(mapper.scalar_range)}
    image = handle.scene.image
    return {
        **dict(handle.settings),
        **colours,
        "image": None if image is None else as_image(image),
        "lighting": bool(handle.actor.prop.lighting),
        "opacity": float(handle.actor.prop.opacity),
        "show_scalar_bar": bool(plotter.scalar_bars),
        "background": plotter.background_color,
        "size": (int(width), int(height)),
        "camera": read_camera(plotter.camera),
    }


def _left_out(plotter: Any, shown: FlowHandle) -> list[str]:
    """Name what the browser does not draw: all but one texture where its mesh lies, and bars."""
    own = {id(bar) for bar in plotter.scalar_bars.values()}
    names = [
        f"{name!r}"
        for renderer in plotter.renderers
        for name, actor in renderer.actors.items()
        if actor is not shown.actor and id(actor) not in own and actor.GetVisibility()
    ]
    if not np.allclose(shown.actor.user_matrix, np.eye(4)) or any(shown.actor.position):
        names.append("the actor's own place")
    return names


def _asked_for() -> bool:
    """Tell whether the user has named this backend.

    PyVista does not tell a backend whether it was named or is merely the first that was found,
    so the caller's own argument is looked at; where that has another form, being called counts.
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
