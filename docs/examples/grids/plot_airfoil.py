"""
Flow around an airfoil
======================

A PyVista mesh can be passed to :func:`flowtex.show` unchanged: its only array of vectors is the
velocity. The areas of the cells of this O-grid differ by a factor of 100,000, but the grain of the
texture is the same everywhere; zoom in at the nose until one cell fills the view.
"""

import flowtex

mesh = flowtex.examples.airfoil()
flowtex.show(
    mesh, scalars="pressure", cmap="coolwarm", clim=(-1.5, 1.5), zoom=5.2, focus=(0.45, 0.0)
)
