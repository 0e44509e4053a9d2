"""
Paint on the surface
====================

By default a grain is as large on the screen at every zoom. ``fixed_grain=True`` fixes it on the
surface, as if it were painted there: it grows as the view comes closer, on the right. Zoom out to
see them agree.
"""

import flowtex

mesh = flowtex.examples.double_gyre()
look = {"resolution": 512, "cmap": "magma", "zoom": 6, "focus": (0.62, 0.4)}
flowtex.show(mesh, **look, beside={"fixed_grain": True})
