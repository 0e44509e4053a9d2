"""The page: a flow drawn on this machine and looked at in a browser.

::

    browser   drags, wheel, controls                pictures (JPEG)
                 |                                      ^
    trame     state of the controls          remote controlled area
                 |                                      |
    FlowApp   change handlers  ----------------->  FrameStream   when, and how well, to draw
                 |                                      |
                 +------------> Scene, Navigator <------+        VTK, off screen; the camera

:func:`serve` runs it on one port of this machine, behind a secret of its own.
"""

from __future__ import annotations

from flowtex.app.flow_app import FlowApp
from flowtex.app.serving import ServeError, serve

__all__ = ["FlowApp", "ServeError", "serve"]
