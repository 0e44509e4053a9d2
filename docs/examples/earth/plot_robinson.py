"""
World map (Robinson)
====================

``projection`` accepts names such as ``robinson``, ``mercator`` and ``lambert``, and PROJ strings.
The velocity is projected as well, so a streak on the map is the projected path on the Earth.
"""

import flowtex

winds = flowtex.examples.weather().isel(longitude=slice(None, None, 2))
flowtex.show(winds, level=500, projection="robinson", cmap="viridis")
