"""
Paint on the surface
====================

By default the grain has the same size on the screen at every zoom. ``fixed_grain=True`` (right)
fixes its size on the surface, as if it were painted there, so it grows in a closer view. Zoom out
to see both agree.
"""

import flowtex

mesh = flowtex.examples.double_gyre()
look = {"resolution": 512, "cmap": "magma", "zoom": 6, "focus": (0.62, 0.4)}
flowtex.show(mesh, **look, beside={"fixed_grain": True})
