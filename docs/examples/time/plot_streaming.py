"""
A steady flow that streams
==========================

``motion="speed"`` moves the texture of a steady flow along its streamlines: at ``speed`` pixels per
second where the flow has its typical speed, faster where it is faster. After ``period`` seconds the
first picture repeats exactly, so :func:`flowtex.movie` writes a seamless loop.
"""

import flowtex

mesh = flowtex.examples.airfoil()
flowtex.show(
    mesh, motion="speed", speed=50, cmap="magma", clim=(0.3, 1.7), zoom=6, focus=(0.5, 0.0)
)
