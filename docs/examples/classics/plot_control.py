"""
A pendulum held upright
=======================

A motor turns a pendulum back to the top, with a torque in proportion to the angle and to its
speed. ``k`` and ``d`` are sliders: below ``k=1`` the upper point is a saddle, and without ``d`` it
is a centre.
"""

import flowtex

held = flowtex.formula(
    "y", "sin(x) - k*x - d*y", x=(-4, 4), y=(-3, 3), k=(1.6, 0, 3), d=(0.4, 0, 2)
)
flowtex.show(held, critical_points=True, separatrices=True, nullclines=True)
