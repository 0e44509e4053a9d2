"""
A limit cycle
=============

The van der Pol oscillator, made from its two equations only. All paths end on one closed orbit. The
slider changes the damping, and the page computes the flow itself, so it stays exact at every zoom.
"""

import flowtex

field = flowtex.formula("y", "mu*(1 - x^2)*y - x", x=(-5, 5), y=(-4, 4), mu=(1, 0, 4))
flowtex.show(field, clim="robust")
