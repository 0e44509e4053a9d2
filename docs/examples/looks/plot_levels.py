"""
One hue for each level
======================

Seen at a grazing angle a pixel covers more of a surface the farther it is away. ``show_level``
colours each pixel by the level of detail that it is drawn with: one hue for each doubling of
the grain, and the hues blend as the levels do.
"""

import flowtex

mesh = flowtex.examples.double_gyre()
camera = [(1.0, -0.28, 0.2), (1.0, 0.2, 0.0), (0.0, 0.0, 1.0)]
flowtex.show(mesh, camera=camera, show_level=True)
