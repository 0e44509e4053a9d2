"""
Vortex shedding
===============

At a Reynolds number of 100, vortices leave a cylinder alternately on both sides. The grid goes
around the cylinder and closes in the wake, without a visible seam. Colours show the vorticity, with
zero in the middle of the diverging colour map.
"""

import flowtex

mesh = flowtex.examples.cylinder()
look = {"cmap": "coolwarm", "clim": (-2.5, 2.5)}
flowtex.show(mesh, scalars="vorticity", **look, zoom=5.2, focus=(4.2, 0.0))
