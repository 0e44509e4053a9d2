"""
Lagrange's points
=================

In a frame that rotates with two bodies, the force is zero at five points: three on the line through
both bodies, and two that form equilateral triangles with them. Streaks follow the sum of gravity
and the centrifugal force; colours show its potential.
"""

import numpy as np

import flowtex

x, y = np.linspace(-2.4, 2.4, 161), np.linspace(-1.2, 1.2, 81)
X, Y = np.meshgrid(x, y)
light = 0.2  # share of the lighter body
potential = -(X**2 + Y**2) / 2
force = np.stack([X, Y], axis=-1)
for place, mass in ((-light, 1 - light), (1 - light, light)):
    away = np.stack([X - place, Y], axis=-1)
    distance = np.maximum(np.linalg.norm(away, axis=-1), 0.06)
    potential -= mass / distance
    force -= mass * away / distance[..., None] ** 3

field = flowtex.FlowField.from_arrays((x, y), force, scalars={"potential": potential})
flowtex.show(field, scalars="potential", cmap="magma", clim=(-2.8, -1.4))
