"""
A steady flow that streams
==========================

``motion="speed"`` lets the texture of a steady flow move as fast as the flow, ``speed`` pixels a
second where it has its typical speed. After ``period`` seconds the first picture comes again,
bit for bit, so :func:`flowtex.movie` writes a loop without a seam.
"""

import flowtex

mesh = flowtex.examples.airfoil()
flowtex.show(
    mesh, motion="speed", speed=50, cmap="magma", clim=(0.3, 1.7), zoom=6, focus=(0.5, 0.0)
)
