"""
A contour in a volume
=====================

``contour="f=0"`` draws the isosurface of an array, here the gyroid, which divides space into two
labyrinths. The velocity is projected onto it. Curved surfaces are lit; drag to turn them.
"""

import numpy as np
import pyvista as pv

import flowtex

n = 41
mesh = pv.ImageData(dimensions=(n, n, n), spacing=[2.5 * np.pi / (n - 1)] * 3)
x, y, z = mesh.points.T
mesh["f"] = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
gradient = np.stack(
    [
        np.cos(a) * np.cos(b) - np.sin(a) * np.sin(c)
        for a, b, c in ((x, y, z), (y, z, x), (z, x, y))
    ],
    axis=-1,
)
mesh["stream"] = np.array([0.5, 0.2, 0.3]) + np.cross(gradient, [0.2, -0.5, 0.8])
mesh["height"] = z
flowtex.show(mesh, contour="f=0", vectors="stream", scalars="height", cmap="plasma")
