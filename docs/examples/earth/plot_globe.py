"""
Jets on the globe
=================

A dataset of xarray's needs no preparation: the winds, their levels and the grid are recognised.
``globe=True`` puts it on a sphere, where neither the date line nor the poles are seams. Drag it
around; north stays up.
"""

import flowtex

winds = flowtex.examples.weather()  # an xarray.Dataset, as xr.open_dataset gives one
winds = winds.isel(longitude=slice(None, None, 2))  # every second one, for a smaller page
flowtex.show(winds, level=250, globe=True, cmap="turbo")
