"""
The hairy ball
==============

Every tangential flow on a sphere is zero somewhere (Poincaré, 1885). This one is zero at a single
point, where it looks like the field of a dipole. It is a uniform stream in the plane, mapped to the
sphere by a stereographic projection. Turn the ball to find the point.
"""

import numpy as np

import flowtex

a, b = np.meshgrid(np.linspace(0, 2 * np.pi, 121), np.linspace(-np.pi / 2, np.pi / 2, 61))
x, y, z = np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)
# The plane touches the sphere at x = -1; the stream in it goes along y.
points = np.stack([x, y, z], axis=-1)
wind = np.stack([y * (1 - x), (1 - x) - y**2, -y * z], axis=-1)

field = flowtex.FlowField.from_arrays(points, wind)
camera = [(3.7, 1.6, 1.3), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
flowtex.show(field, cmap="plasma_r", camera=camera)
