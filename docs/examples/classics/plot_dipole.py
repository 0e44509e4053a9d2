"""
An electric dipole
==================

Field lines connect two charges. The field is unbounded near a charge, so the colours are
logarithmic, ``log_scale=True``; the texture does not depend on the strength of the field.
"""

import numpy as np

import flowtex

x, y = np.linspace(-3, 3, 161), np.linspace(-1.5, 1.5, 81)
X, Y = np.meshgrid(x, y)
field = np.zeros((*X.shape, 2))
for place, charge in ((-0.8, 1), (0.8, -1)):
    away = np.stack([X - place, Y], axis=-1)
    distance = np.linalg.norm(away, axis=-1, keepdims=True)
    field += charge * away / np.maximum(distance, 0.05) ** 3

electric = flowtex.FlowField.from_arrays((x, y), field, vectors="E")
flowtex.show(electric, cmap="inferno", log_scale=True, clim=(0.08, 30))
