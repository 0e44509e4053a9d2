"""
Two wires
=========

The magnetic field around two wires with currents in the same direction: near each the lines are
circles around it, far away around both. Between the wires the field vanishes.
"""

import numpy as np

import flowtex

x, y = np.linspace(-3, 3, 181), np.linspace(-2, 2, 121)
X, Y = np.meshgrid(x, y)
field = np.zeros((*X.shape, 2))
for place in (-1, 1):
    square = np.maximum((X - place) ** 2 + Y**2, 0.01)
    field += np.stack([-Y, X - place], axis=-1) / square[..., None]

magnetic = flowtex.FlowField.from_arrays((x, y), field, vectors="B")
flowtex.show(magnetic, cmap="inferno", log_scale=True, clim=(0.1, 8), arrows=40)
