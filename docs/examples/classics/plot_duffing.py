"""
Duffing's oscillator
====================

A steel strip between two magnets bends towards one of them. Its phase portrait has two wells; with
a little friction, the bands of initial states that lead to either of them wind around each other. A
phase portrait is a flow, with the position along x and the velocity along y.
"""

import numpy as np

import flowtex

x, v = np.linspace(-2, 2, 161), np.linspace(-1, 1, 81)
X, V = np.meshgrid(x, v)
force = X - X**3 - 0.12 * V
energy = V**2 / 2 - X**2 / 2 + X**4 / 4

field = flowtex.FlowField.from_arrays(
    (x, v), np.stack([V, force], axis=-1), scalars={"energy": energy}
)
flowtex.show(field, scalars="energy", cmap="viridis", clim=(-0.25, 0.8), separatrices=True)
