"""
RNA velocity
============

Each cell of a sample lies at a point of a plane, and its velocity leads to the cells
that it becomes. The points are joined by triangles; the flow parts where a cell type decides.
"""

import numpy as np
import pyvista as pv

import flowtex

rng = np.random.default_rng(3)
age, side = rng.random(1500), rng.choice([-1, 1], 1500)
part = np.clip(age - 0.4, 0, 1)
points = np.stack([4 * age, 2 * side * part, 0 * age], axis=-1) + rng.normal(0, 0.12, (1500, 3))
points[:, 2] = 0
late = np.clip(points[:, 0] / 4 - 0.4, 0, 1)
cells = pv.PolyData(points).delaunay_2d(alpha=0.35)
cells["age"] = points[:, 0] / 4
aside = 2.5 * np.tanh(8 * points[:, 1]) * (late > 0)
cells["velocity"] = np.stack([1 + 0 * late, aside, 0 * late], axis=-1)
flowtex.show(cells, vectors="velocity", scalars="age", cmap="plasma", arrows=40)
