"""
Lorenz's butterfly
==================

Lorenz's three equations of convection describe a flow in space. The plane x = y contains both
unstable points of the butterfly; in it the flow circles around each of them, which gives the two
wings. Colours show the velocity through the plane.
"""

import numpy as np
import pyvista as pv

import flowtex

box = pv.ImageData(dimensions=(49, 49, 33), spacing=(1, 1, 1), origin=(-24, -24, 9))
x, y, z = box.points.T
box["flow"] = np.stack([10 * (y - x), x * (28 - z) - y, x * y - 8 / 3 * z], axis=-1)
box["through"] = box["flow"] @ [0.7, -0.7, 0]
flowtex.show(box, slice="1,-1,0 through 0,0,25", scalars="through", cmap="RdBu_r")
