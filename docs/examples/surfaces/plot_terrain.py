"""
A wind over hills
=================

In stable air the wind flows around hills rather than over them. The terrain is a grid in space, and
the wind is turned along its contours. Colours show the height of the ground.
"""

import numpy as np

import flowtex

x, y = np.meshgrid(np.linspace(-4, 4, 121), np.linspace(-2.6, 2.6, 81))
height = np.zeros_like(x)
for a, b, tall, wide in ((-1.9, 0.6, 1.0, 0.5), (0.1, -0.7, 1.2, 0.6), (1.6, 0.8, 0.9, 0.5),
                         (2.6, -1.2, 0.5, 0.3), (-2.6, -1.3, 0.5, 0.4)):  # fmt: skip
    height += tall * np.exp(-((x - a) ** 2 + (y - b) ** 2) / wide)

dy, dx = np.gradient(height, y[:, 0], x[0])
steep = np.hypot(dx, dy) + 1e-9
push = dx / steep * np.tanh(1.6 * steep)  # what of the wind blows against the slope
u, v = 1 - push * dx / steep, -push * dy / steep
wind = np.stack([u, v, u * dx + v * dy], axis=-1)

field = flowtex.FlowField.from_arrays((x, y, height), wind, scalars={"height": height})
camera = [(-2.2, -7.5, 5.2), (0.0, -0.15, 0.0), (0.0, 0.0, 1.0)]
flowtex.show(field, scalars="height", cmap="gist_earth", clim=(-0.5, 1.6), camera=camera)
