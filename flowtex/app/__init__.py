"""The page: flows drawn on this machine and looked at in a browser.

:class:`FlowApp` is a whole page, :class:`FlowArea` the view alone, for other trame applications.
:func:`serve` runs pages on one port of this machine, each with its own state, behind a secret;
:class:`Library` is what they may open. Imports run one way: ``server`` < ``streaming`` <
``controllers`` < ``ui`` < ``flow_app``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flowtex.errors import import_extra, require_pyvista

if TYPE_CHECKING:
    from flowtex.app.controllers.library import Choice, Library
    from flowtex.app.flow_app import FlowApp, serve
    from flowtex.app.server.site import ServeError
    from flowtex.app.streaming.area import FlowArea

__all__ = ["Choice", "FlowApp", "FlowArea", "Library", "ServeError", "serve"]

#: Names are imported when they are first used: a server whose sessions are processes draws nothing.
_HOMES = {
    "Choice": "controllers.library",
    "FlowApp": "flow_app",
    "FlowArea": "streaming.area",
    "Library": "controllers.library",
    "ServeError": "server.site",
    "serve": "flow_app",
}


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        if name in ("FlowApp", "FlowArea", "serve"):
            require_pyvista(f"flowtex.app.{name}")
        return getattr(import_extra(f"{__name__}.{_HOMES[name]}", "app"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
