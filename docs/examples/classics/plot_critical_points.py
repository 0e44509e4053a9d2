"""
Critical points
===============

A critical point, where the velocity is zero, is a saddle, a node, a focus or a centre, depending on
the eigenvalues of the velocity gradient. The critical points of this field are the zeros of a
polynomial, between the nodes of the grid; separatrices start and end at the saddles. Zoom into a
point: the texture is sharp at a thousand times the size.
"""

import numpy as np

import flowtex

x, y = np.linspace(-2.4, 2.4, 145), np.linspace(-1.2, 1.2, 73)
X, Y = np.meshgrid(x, y)
z = X + 1j * Y
w = (z - 1.5 - 0.2j) * np.conj(z - 0.35 + 0.5j) * (z + 0.7 - 0.45j) * np.conj(z + 1.7 + 0.3j)
w = w * np.exp(0.9j)
w = w / np.sqrt(1 + abs(w) ** 2)

field = flowtex.FlowField.from_arrays((x, y), np.stack([w.real, w.imag], axis=-1))
flowtex.show(field, cmap="viridis_r", critical_points=True, separatrices=True)
