"""flowtex draws the flow on a surface as a texture that stays sharp at every zoom.

Three calls are enough to begin: :func:`show` and :func:`render` draw a mesh or a
:class:`FlowField`, and ``plotter.flowtex.add(mesh)`` adds one to a PyVista plotter. Beneath
them lie :meth:`FlowField.from_arrays`, :func:`trace` and :class:`TraceSlices`, which need
NumPy and SciPy alone: what draws is imported when it is first asked for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flowtex._version import __version__ as __version__
from flowtex.field import FlowField
from flowtex.settings import Settings
from flowtex.trace import TraceSlices, trace

if TYPE_CHECKING:
    from flowtex import examples
    from flowtex.offscreen.movie import movie
    from flowtex.offscreen.render import render, show
    from flowtex.widget import FlowWidget as FlowWidget

__all__ = [
    "FlowField",
    "Settings",
    "TraceSlices",
    "examples",
    "movie",
    "render",
    "show",
    "trace",
]


def __getattr__(name: str) -> Any:
    """Import what draws (PyVista, VTK) only when it is used."""
    if name == "examples":
        import importlib

        return importlib.import_module("flowtex.examples")
    if name in {"render", "show"}:
        from flowtex.offscreen import render as pictures

        return getattr(pictures, name)
    if name == "movie":
        from flowtex.offscreen import movie as movies

        return movies.movie
    if name == "FlowWidget":
        from flowtex import widget

        return widget.FlowWidget
    msg = f"module 'flowtex' has no attribute {name!r}"
    raise AttributeError(msg)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, "FlowWidget"})
