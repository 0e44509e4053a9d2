"""
An airfoil
==========

Potential flow around an airfoil, from a PyVista mesh.
"""

import flowtex

mesh = flowtex.examples.airfoil()
flowtex.show(mesh, zoom=4)
