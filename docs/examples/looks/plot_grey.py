"""
Grey, for print
===============

``scalars=False`` leaves out the colours. A little more ``contrast`` and a larger ``grain`` make a
figure that survives a photocopier. ``flowtex.render(mesh, size=(2400, 1200))`` gives the pixels,
and :func:`flowtex.axes` draws on matplotlib's axes, sharp in every file that is saved.
"""

import flowtex

mesh = flowtex.examples.double_gyre()
flowtex.show(mesh, scalars=False, color="#8c8c8c", contrast=1.3, grain=1.8)
