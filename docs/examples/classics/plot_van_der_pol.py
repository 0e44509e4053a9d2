"""
A limit cycle
=============

The oscillator of van der Pol, from nothing but its two equations. All paths end on one closed
orbit. The slider says how strong the damping is, and the page computes the flow itself: zoom in as
far as you like.
"""

import flowtex

field = flowtex.formula("y", "mu*(1 - x^2)*y - x", x=(-5, 5), y=(-4, 4), mu=(1, 0, 4))
flowtex.show(field, clim="robust")
