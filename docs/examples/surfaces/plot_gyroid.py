"""
A contour in a volume
=====================

``contour="f=0"`` draws the surface where an array has a value, here the gyroid, which divides space
into two mazes. A stream all in one direction is projected onto it, and shows how it has to go
around. Surfaces in space are lit; drag to turn them.
"""

import numpy as np
import pyvista as pv

import flowtex

n = 41
mesh = pv.ImageData(dimensions=(n, n, n), spacing=[2.5 * np.pi / (n - 1)] * 3)
x, y, z = mesh.points.T
mesh["f"] = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
mesh["stream"] = np.tile([1.0, 0.4, 0.3], (mesh.n_points, 1))
mesh["height"] = z
flowtex.show(mesh, contour="f=0", vectors="stream", scalars="height", cmap="plasma")
