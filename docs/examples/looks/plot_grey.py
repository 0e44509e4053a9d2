"""
Grey, for print
===============

``scalars=False`` leaves out the colours. A higher ``contrast`` and a larger ``grain`` make a figure
that prints well. ``flowtex.render(mesh, size=(2400, 1200))`` returns the pixels, and
:func:`flowtex.axes` draws on matplotlib axes, sharp in every file that is saved.
"""

import flowtex

mesh = flowtex.examples.double_gyre()
flowtex.show(mesh, scalars=False, color="#8c8c8c", contrast=1.3, grain=1.8)
