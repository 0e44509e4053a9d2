"""
Streaks on a wing
=================

Oil on a model in a wind tunnel shows the flow along its surface. This is the upper side of a winged
body. Light shows its shape, and the texture turns and shrinks with the surface.
"""

import flowtex

wing = flowtex.examples.delta_wing()
camera = [(-0.55, -0.75, 1.15), (0.5, 0.02, 0.0), (0.0, 0.0, 1.0)]
flowtex.show(wing, scalars="height", cmap="YlGnBu_r", camera=camera)
