"""
One hue for each level
======================

In an oblique view a pixel covers more of the surface the farther away it is. ``show_level`` colours
each pixel by its level of detail: one hue for each doubling of the grain. The hues blend as the
levels do.
"""

import flowtex

mesh = flowtex.examples.double_gyre()
camera = [(1.0, -0.28, 0.2), (1.0, 0.2, 0.0), (0.0, 0.0, 1.0)]
flowtex.show(mesh, camera=camera, show_level=True)
