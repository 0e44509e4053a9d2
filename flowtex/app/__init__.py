"""The page: flows drawn on this machine and looked at in a browser.

::

    browser    drags, wheel, controls                       pictures (JPEG)
                  |                                             ^
    trame      state of the controls               remote controlled area
                  |                                             |
    FlowApp    its parts: data, look, time, ... -> FlowArea -> FrameStream   when to draw
                                                      |         |
                                                      |      Composer, Painters   how well
                                                      v         v
                                                    Scene: panes, colours, Canvas (VTK)

:class:`FlowApp` is a whole page, :class:`FlowArea` the view alone, for other trame applications.
:func:`serve` runs pages on one port of this machine, each with a state of its own, behind a
secret; :class:`Library` is what they may open.
"""

from __future__ import annotations

from flowtex.app.controllers.library import Choice, Library
from flowtex.app.flow_app import FlowApp
from flowtex.app.server.serving import ServeError, serve
from flowtex.app.streaming.area import FlowArea

__all__ = ["Choice", "FlowApp", "FlowArea", "Library", "ServeError", "serve"]
