"""
Which way it goes
=================

A streak has two ends, and a still picture does not tell which is the head. With ``kernel="ramp"``
each grain is bright at the head and fades behind, on the right; a larger ``grain`` helps. On
the left is the smooth kernel that is used otherwise.
"""

import flowtex

mesh = flowtex.examples.double_gyre(time=2.5)
ramp = {"kernel": "ramp", "grain": 3.5, "contrast": 1.4}
flowtex.show(mesh, cmap="viridis", zoom=1.9, focus=(1.05, 0.5), beside=ramp)
