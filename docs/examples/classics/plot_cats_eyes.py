"""
Kelvin's cat's eyes
===================

The shear layer between two streams rolls up into a row of vortices. This steady flow of that kind
(Stuart, 1967) solves Euler's equations exactly. Colours show the vorticity.
"""

import numpy as np

import flowtex

x, y = np.linspace(0, 6 * np.pi, 181), np.linspace(-4, 4, 77)
X, Y = np.meshgrid(x, y)
eyes = 0.45  # 0 is a layer of shear, 1 a row of point vortices
depth = np.cosh(Y) - eyes * np.cos(X)
velocity = np.stack([np.sinh(Y), -eyes * np.sin(X)], axis=-1) / depth[..., None]
vorticity = (1 - eyes**2) / depth**2

field = flowtex.FlowField.from_arrays((x, y), velocity, scalars={"vorticity": vorticity})
flowtex.show(field, scalars="vorticity", cmap="plasma")
