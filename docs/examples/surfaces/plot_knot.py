"""
Triangles
=========

flowtex draws any surface of triangles, quadrilaterals or polygons: a ``PolyData`` with vectors on
its points or cells. This tube follows a trefoil knot, and the flow winds around it. The component
of the velocity normal to the surface is left out.
"""

import numpy as np
import pyvista as pv

import flowtex

t = np.linspace(0, 2 * np.pi, 181)
wide = 2 + np.cos(3 * t)
knot = np.stack([wide * np.cos(2 * t), wide * np.sin(2 * t), 1.4 * np.sin(3 * t)], axis=-1)
tube = pv.Spline(knot, 181).tube(radius=0.55, n_sides=24, capping=False).triangulate()

ahead = np.gradient(knot, axis=0)
nearest = np.argmin(np.linalg.norm(tube.points[:, None] - knot, axis=-1), axis=1)
along = ahead[nearest] / np.linalg.norm(ahead[nearest], axis=-1, keepdims=True)
tube["flow"] = along + 0.7 * np.cross(along, tube.point_normals)
tube["height"] = tube.points[:, 2]
flowtex.show(tube, vectors="flow", scalars="height", cmap="viridis")
