"""
A plane of a 3D grid
====================

Of a three-dimensional structured grid one index plane is drawn, here ``plane="k=12"``, in its
position in space and with the velocity along the plane. This is the flow of Arnold, Beltrami and
Childress, whose streamlines are chaotic.
"""

import numpy as np
import pyvista as pv

import flowtex

box = pv.ImageData(dimensions=(121, 61, 25), spacing=(0.11, 0.11, 0.26))
x, y, z = box.points.T
box["velocity"] = np.stack(
    [np.sin(z) + 0.8 * np.cos(y), 0.9 * np.sin(x) + np.cos(z), 0.8 * np.sin(y) + 0.9 * np.cos(x)],
    axis=-1,
)
box["upward"] = box["velocity"][:, 2]
flowtex.show(box, plane="k=12", scalars="upward", cmap="PuOr")
