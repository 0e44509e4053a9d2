"""
Colours of another quantity
===========================

Colours can show any quantity at the nodes, here the pressure of Taylor-Green vortices. The texture
lightens and darkens every colour by the same amount in the colour space Oklab, so the mean colour
of a patch is still that of the colour map.
"""

import numpy as np

import flowtex

x = np.linspace(0, 4 * np.pi, 161)
y = np.linspace(0, 2 * np.pi, 81)
X, Y = np.meshgrid(x, y)
velocity = np.stack([np.cos(X) * np.sin(Y), -np.sin(X) * np.cos(Y)], axis=-1)
pressure = -(np.cos(2 * X) + np.cos(2 * Y)) / 4

field = flowtex.FlowField.from_arrays(
    (x, y), velocity, scalars={"pressure": pressure}, units={"pressure": "Pa"}
)
flowtex.show(field, scalars="pressure", cmap="Spectral_r")
