"""
The Gulf Stream
===============

Currents like those of an ocean model. Nodes with NaN are land, which is drawn with its coast. Warm
rings north of the stream turn clockwise, cold rings south of it anticlockwise; the sea surface
height shows this as well.
"""

import flowtex

ocean = flowtex.examples.ocean().isel(time=-1)
ocean = ocean.sel(latitude=slice(31, 44), longitude=slice(-78, -52))
flowtex.show(ocean, scalars="zos", cmap="RdBu_r", land="#b9b0a0", zoom=1.4)
