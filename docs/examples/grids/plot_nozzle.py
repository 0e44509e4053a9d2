"""
A curved grid
=============

On a curvilinear grid positions are (J, I, 2) as well. The walls of this channel narrow and widen
again, and the flow between them is potential flow, to first order. Cells are sheared and differ in
size, but streaks follow the velocity and not the grid.
"""

import numpy as np

import flowtex

s, t = np.meshgrid(np.linspace(-3, 3, 161), np.linspace(-1, 1, 61))
half = 1 - 0.55 * np.exp(-(s**2))  # half the width of the channel
slope = 1.1 * s * np.exp(-(s**2))
points = np.stack([s, half * t], axis=-1)
velocity = np.stack([1 / half, slope * t / half], axis=-1)

field = flowtex.FlowField.from_arrays(points, velocity)
flowtex.show(field, cmap="viridis")
