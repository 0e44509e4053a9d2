"""
Light on a surface
==================

Curved surfaces are lit and flat ones are not, unless ``lighting`` is given. Light shows the shape
(left); without it, colours are exactly those of the legend (right).
"""

import numpy as np

import flowtex

a, b = np.meshgrid(np.linspace(0, 2 * np.pi, 121), np.linspace(0.02, np.pi - 0.02, 61))
r = 1 + 0.13 * np.sin(5 * a) * np.sin(b) ** 5 + 0.06 * np.cos(6 * b)
ball = np.stack([np.sin(b) * np.cos(a), np.sin(b) * np.sin(a), np.cos(b)], axis=-1)
points = r[..., None] * ball
flow = np.cross([0.5, 0.2, 1.0], points) + 0.5 * np.cos(3 * b)[..., None] * np.cross(
    ball, [1, 0, 0]
)

field = flowtex.FlowField.from_arrays(points, flow)
flowtex.show(field, cmap="viridis", beside={"lighting": False})
