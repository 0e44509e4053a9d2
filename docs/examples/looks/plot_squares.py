"""
Squares
=======

The flow smears an image of your own: a checkerboard shows how far it shears squares.
"""

import numpy as np

import flowtex

gyre = flowtex.examples.double_gyre_field(shape=(61, 121))
board = 255 * (np.indices((8, 16)).sum(axis=0) % 2).astype(np.uint8)
flowtex.show(gyre, image=board, tiles=3, zoom=1.9, focus=(0.55, 0.5))
