"""
Spots and squares
=================

``noise="spots"`` is Spot Noise, discs that the flow stretches; ``"checkerboard"`` shows how far it
shears squares. Both are even on the surface, whatever the cells of the grid.
"""

import flowtex

gyre = flowtex.examples.double_gyre_field(shape=(61, 121))
look = {"cmap": "YlGnBu_r", "zoom": 1.9, "focus": (0.55, 0.5)}
flowtex.show(
    gyre, noise="spots", resolution=512, **look, beside={"noise": "checkerboard", "tiles": 3}
)
