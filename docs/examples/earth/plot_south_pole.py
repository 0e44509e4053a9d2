"""
Around a pole
=============

On a stereographic map around the South Pole the westerlies of the southern hemisphere are rings
with waves in them. Angles are true on such a map, so the streaks have the right direction
against every coast.
"""

import flowtex

winds = flowtex.examples.weather()
winds = winds.sel(latitude=slice(-20, -90)).isel(longitude=slice(None, None, 2))
flowtex.show(winds, level=850, projection="south", cmap="YlGnBu_r", zoom=1.3)
