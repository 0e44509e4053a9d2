"""
What the level of detail is for
===============================

A texture of one size is too fine in a distant view, where it flickers, and too coarse in a close
one. On the left the grain fits the pixels at every distance; on the right, with ``lod=False``, its
size on the surface is fixed. Zoom in and out: both views move together.
"""

import flowtex

mesh = flowtex.examples.airfoil()
look = {"cmap": "viridis", "clim": (0.4, 1.6), "zoom": 1.1}
flowtex.show(mesh, **look, resolution=4096, beside={"lod": False})
