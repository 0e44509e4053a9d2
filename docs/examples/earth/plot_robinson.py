"""
All of the Earth on a map
=========================

``projection`` takes names such as ``robinson``, ``mercator`` and ``lambert``, and whatever PROJ
knows. The velocity is mapped as well, so a streak on the map is the map of the path on the Earth.
"""

import flowtex

winds = flowtex.examples.weather().isel(longitude=slice(None, None, 2))
flowtex.show(winds, level=500, projection="robinson", cmap="viridis")
