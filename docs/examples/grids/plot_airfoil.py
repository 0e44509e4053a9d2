"""
Flow around an airfoil
======================

A mesh of PyVista's goes to :func:`flowtex.show` as it is: its only array of vectors is the
velocity. The cells of this O-grid differ by five orders of magnitude in area, and the grain of the
texture by none; zoom in at the nose until one cell fills the view.
"""

import flowtex

mesh = flowtex.examples.airfoil()
flowtex.show(
    mesh, scalars="pressure", cmap="coolwarm", clim=(-1.5, 1.5), zoom=5.2, focus=(0.45, 0.0)
)
