"""
Vortex shedding
===============

Behind a cylinder at a Reynolds number of 100 vortices leave on either side in turn. The grid goes
around the cylinder and closes on itself in the wake, where no seam is seen. Colours of the
vorticity have zero in their middle, since the map diverges.
"""

import flowtex

mesh = flowtex.examples.cylinder()
look = {"cmap": "coolwarm", "clim": (-2.5, 2.5)}
flowtex.show(mesh, scalars="vorticity", **look, zoom=5.2, focus=(4.2, 0.0))
