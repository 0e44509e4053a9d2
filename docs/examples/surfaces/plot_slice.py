"""
A slice through a volume
========================

A plane can cut any volume: ``slice="y=0"``, or a normal and a point. This vortex ring is on a mesh
of tetrahedra. In the plane, the ring is a pair of vortices that propel each other.
"""

import numpy as np
import pyvista as pv

import flowtex

mesh = pv.ImageData(dimensions=(65, 17, 33), spacing=(0.1, 0.2, 0.1), origin=(-3.2, -1.6, -1.6))
mesh = mesh.to_tetrahedra()
x, y, z = mesh.points.T
r = np.hypot(y, z)
swirl = np.exp(-((x**2 + (r - 0.8) ** 2) / 0.25))  # around the core of the ring
out = np.stack([0 * x, y, z], axis=-1) / np.maximum(r, 1e-9)[:, None]
mesh["velocity"] = (3 * swirl * x)[:, None] * out
mesh["velocity"][:, 0] += 0.5 - 3 * swirl * (r - 0.8)
flowtex.show(mesh, slice="y=0", cmap="magma")
