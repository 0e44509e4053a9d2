"""
Pathlines and streamlines
=========================

In a flow that varies in time a pathline is where a particle went, and a streamline is what the flow
is along at one moment. Left the texture is along the former, right along the latter; where the
border between the two gyres swings, they differ most.
"""

import flowtex

gyres = flowtex.examples.double_gyre_field(time_varying=True, shape=(41, 81))
last = 31  # where the border is farthest to the right
gyres = flowtex.FlowField.from_arrays(gyres.points, gyres.velocity[:last], times=gyres.times[:last])
flowtex.show(
    gyres,
    zoom=1.9,
    focus=(1.0, 0.5),
    lines="pathlines",
    beside={"lines": "streamlines"},
    cmap="magma",
)
