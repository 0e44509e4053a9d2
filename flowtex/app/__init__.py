"""The page: flows drawn on this machine and looked at in a browser.

::

    browser    <flowtex-view>: drags, wheel, controls       pictures (JPEG), without a card
                  |                ^                            ^
    trame      triggers         scenes, changes        remote controlled area
                  v                |                            |
    FlowApp    Controllers -> FlowArea: Element, PointReader -> FrameStream      when to draw
                                          |                     |
                                          |                  ViewPainter         how well
                                          v                     v
                                       Viewport: panes, colours, camera, window (VTK)

:class:`FlowApp` is a whole page, :class:`FlowArea` the view alone, for other trame applications.
:func:`serve` runs pages on one port of this machine, each with a state of its own, behind a
secret; :class:`Library` is what they may open. Imports run one way: ``server`` < ``streaming`` <
``controllers`` < ``ui`` < ``flow_app``.
"""

from __future__ import annotations

from flowtex.app.controllers.library import Choice, Library
from flowtex.app.flow_app import FlowApp, serve
from flowtex.app.server.site import ServeError
from flowtex.app.streaming.area import FlowArea

__all__ = ["Choice", "FlowApp", "FlowArea", "Library", "ServeError", "serve"]
