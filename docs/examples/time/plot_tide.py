"""
A tide in a bay
===============

A series can be short: eight times of one tide are enough, because the flow is interpolated between
them. The tidal ellipse turns in opposite directions on the two sides of the bay, around a point
where the water level stays constant.
"""

import numpy as np

import flowtex

x, y = np.linspace(-2, 2, 81), np.linspace(-1, 1, 41)
X, Y = np.meshgrid(x, y)
phase = np.linspace(0, 2 * np.pi, 9)
kelvin = [np.exp(s * 1.2 * Y) for s in (1, -1)]  # waves along either coast
u = np.stack([kelvin[1] * np.cos(1.6 * X - p) - kelvin[0] * np.cos(1.6 * X + p) for p in phase])
height = np.stack(
    [kelvin[1] * np.cos(1.6 * X - p) + kelvin[0] * np.cos(1.6 * X + p) for p in phase]
)
v = 0.5 * np.sin(np.pi * (Y + 1) / 2) * np.gradient(height, phase, axis=0)

field = flowtex.FlowField.from_arrays(
    (x, y), np.stack([u, v], axis=-1), times=phase, scalars={"height": height}
)
flowtex.show(field, scalars="height", cmap="RdBu_r")
