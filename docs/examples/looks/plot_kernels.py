"""
Which way it goes
=================

A still picture of streaks does not show the sense of the flow. With ``kernel="ramp"`` (right) each
streak is bright at its head and fades behind it; a larger ``grain`` helps. The default kernel
(left) is smooth and symmetric.
"""

import flowtex

mesh = flowtex.examples.double_gyre(time=2.5)
ramp = {"kernel": "ramp", "grain": 3.5, "contrast": 1.4}
flowtex.show(mesh, cmap="viridis", zoom=1.9, focus=(1.05, 0.5), beside=ramp)
