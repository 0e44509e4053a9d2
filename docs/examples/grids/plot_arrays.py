"""
Arrays of your own
==================

A flow needs only the positions of the nodes and the velocity there. Positions may be the two
coordinate axes of a rectilinear grid; velocities are (J, I, 2): rows, columns, components. Other
arrays on the nodes can set the colours.
"""

import numpy as np

import flowtex

x, y = np.linspace(-3, 3, 145), np.linspace(-1.5, 1.5, 73)
X, Y = np.meshgrid(x, y)

stream = np.zeros_like(X)
for a, b, turn in ((-1.6, 0.4, 1.0), (-0.2, -0.5, -0.8), (1.3, 0.35, 1.1), (2.3, -0.7, -0.7)):
    stream += turn * np.exp(-((X - a) ** 2 + (Y - b) ** 2) / 0.5)

dy, dx = np.gradient(stream, y, x)
velocity = np.stack([dy, -dx], axis=-1)

field = flowtex.FlowField.from_arrays((x, y), velocity, scalars={"stream function": stream})
flowtex.show(field, scalars="stream function", cmap="coolwarm", zoom=1.15)
