"""
Jets on the globe
=================

An xarray dataset needs no preparation: the winds, their levels and the grid are recognised.
``globe=True`` draws it on a sphere, without a seam at the date line or the poles. Drag to turn it;
north stays up.
"""

import flowtex

winds = flowtex.examples.weather()  # an xarray.Dataset, as xr.open_dataset gives one
winds = winds.isel(longitude=slice(None, None, 2))  # every second one, for a smaller page
flowtex.show(winds, level=250, globe=True, cmap="turbo")
