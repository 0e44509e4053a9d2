"""
Lines of stress around a hole
=============================

A plate with a hole is pulled to the right. The principal directions of its stress are axes without
a sense of direction, so v and -v mean the same: ``sign_free=True``. At the top of the hole the
stress is three times that far away (Kirsch, 1898).
"""

import numpy as np

import flowtex

angle, out = np.meshgrid(np.linspace(0, 2 * np.pi, 161), np.linspace(0, 1, 61))
r = np.exp(1.5 * out)
s, t = 1 / r**2, 1 / r**4
radial = ((1 - s) + (1 - 4 * s + 3 * t) * np.cos(2 * angle)) / 2
hoop = ((1 + s) - (1 + 3 * t) * np.cos(2 * angle)) / 2
shear = -(1 + 2 * s - 3 * t) * np.sin(2 * angle) / 2

turn = angle + 0.5 * np.arctan2(2 * shear, radial - hoop)
points = r[..., None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
largest = (radial + hoop) / 2 + np.hypot((radial - hoop) / 2, shear)
stress = {"greatest stress": largest}
axes = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
field = flowtex.FlowField.from_arrays(points, axes, sign_free=True, scalars=stress)
flowtex.show(field, scalars="greatest stress", cmap="inferno", zoom=1.9)
