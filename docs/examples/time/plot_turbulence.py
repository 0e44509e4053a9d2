"""
Decaying turbulence
===================

Arrays (T, J, I, 2) with their times describe a time-varying flow, and so does a list of meshes. In
two dimensions small vortices merge into larger ones. Press play: between two steps the flow is
interpolated, and carries its streaks along.
"""

import flowtex

field = flowtex.examples.vortex_field()
field = flowtex.FlowField.from_arrays(  # every second row and column, for a smaller page
    field.points[::2, ::2],
    field.velocity[:, ::2, ::2],
    times=field.times,
    scalars={"vorticity": field.scalars["vorticity"][:, ::2, ::2]},
)
flowtex.show(field, scalars="vorticity", cmap="RdBu_r", clim="robust", zoom=2)
