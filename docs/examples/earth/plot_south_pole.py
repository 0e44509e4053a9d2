"""
Around a pole
=============

On a stereographic map of the South Pole the westerlies of the southern hemisphere are rings with
waves. The map preserves angles, so streaks cross every coast at the correct angle.
"""

import flowtex

winds = flowtex.examples.weather()
winds = winds.sel(latitude=slice(-20, -90)).isel(longitude=slice(None, None, 2))
flowtex.show(winds, level=850, projection="south", cmap="YlGnBu_r", zoom=1.3)
