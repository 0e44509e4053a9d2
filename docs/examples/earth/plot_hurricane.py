"""
A hurricane
===========

A dataset can be made in a few lines. In the model of Holland (1980) the wind of a hurricane follows
from a pressure that falls towards the eye; here it is turned inward by 20°, as by friction at the
ground. A storm with winds above 33 m/s is a hurricane.
"""

import numpy as np
import xarray as xr

import flowtex

lat, lon = np.arange(18, 34.1, 0.125), np.arange(-98, -77.9, 0.167)
x = 111 * np.cos(np.radians(26)) * (lon - -88)[None, :]  # km east of the eye
y = 111 * (lat - 26)[:, None]
r = np.hypot(x, y) + 1e-6
widest = (40 / r) ** 1.2
speed = 62 * np.sqrt(widest * np.exp(1 - widest))
turn = np.arctan2(y, x) + np.radians(90 + 20)
east, north = speed * np.cos(turn) - 4, speed * np.sin(turn) + 3  # and it moves northwest

units = {"units": "m/s"}
axes = ("latitude", "longitude")
storm = xr.Dataset(
    {"u10": (axes, east, units), "v10": (axes, north, units)},
    {"latitude": lat, "longitude": lon},
)
flowtex.show(storm, cmap="inferno", zoom=1.6)
