"""
What the level of detail is for
===============================

A texture of one size is too fine from afar, where it flickers, and too coarse from near. Left,
the grain fits the pixels at every distance; right, ``lod=False``, there is one texture for all.
Zoom both in, and out again.
"""

import flowtex

mesh = flowtex.examples.airfoil()
look = {"cmap": "viridis", "clim": (0.4, 1.6), "zoom": 1.1}
flowtex.show(mesh, **look, resolution=4096, beside={"lod": False})
