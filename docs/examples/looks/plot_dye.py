"""
Dye in a flow
=============

An image replaces the noise, and the flow smears it in its own colours. This image has drops of dye
and is transparent elsewhere. The ramp kernel looks only backward, so the dye is carried forward.
"""

import numpy as np

import flowtex

rows, columns = np.mgrid[0:240, 0:480]
dye = np.zeros((240, 480, 4))
colours = [(0.83, 0.15, 0.24), (0.13, 0.43, 0.85), (0.97, 0.67, 0.13), (0.1, 0.6, 0.45)]
for n in range(32):
    row, column = 30 + 60 * (n // 8), 30 + 60 * (n % 8)
    drop = np.hypot(rows - row, columns - column) < 17
    dye[drop] = (*colours[(n + n // 8) % 4], 1.0)

field = flowtex.examples.double_gyre_field(shape=(51, 101))
flowtex.show(field, image=dye, kernel="ramp", samples=180, scalars=False, color="#f4f4f4")
