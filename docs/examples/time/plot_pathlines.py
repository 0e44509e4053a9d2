"""
Pathlines and streamlines
=========================

In a time-varying flow a pathline is the path of a particle, and a streamline follows the velocity
at one time. The texture shows pathlines on the left and streamlines on the right; they differ most
where the border between the two gyres oscillates.
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
