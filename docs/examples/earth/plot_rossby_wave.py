"""
A Rossby-Haurwitz wave
======================

This wave with four crests travels around the Earth without changing its shape, an exact solution
that is a standard test of weather models. For arrays, a :class:`~flowtex.field.earth.Projection`
turns longitude and latitude into positions on the globe, and winds into vectors.
"""

import numpy as np

import flowtex
from flowtex.field.earth.projection import EARTH_RADIUS, Projection

lon, lat = np.meshgrid(np.linspace(-180, 180, 121), np.linspace(-90, 90, 61))
a, b = np.radians(lon), np.radians(lat)
k = 7.848e-6  # rotation and wave number 4, as of Williamson et al. (1992)
cos, sin = np.cos(b), np.sin(b)
u = np.cos(4 * a) * cos**3 * (4 * sin**2 - cos**2) * k * EARTH_RADIUS + EARTH_RADIUS * k * cos
v = -4 * EARTH_RADIUS * k * cos**3 * sin * np.sin(4 * a)

globe = Projection("globe")
points, wind = globe.positions(lon, lat), globe.vectors(lon, lat, u, v)
units = {"length_unit": "m", "time_unit": "s"}
wave = flowtex.FlowField.from_arrays(points, wind, projection=globe, **units)
flowtex.show(wave, cmap="viridis", coastlines=False)
