"""
Field lines on a torus
======================

In a tokamak the magnetic field winds around a torus. The number of turns differs between surfaces
of constant pressure, and where it is a fraction, small disturbances grow: here a ripple with three
periods one way and two the other. The grid closes on itself both ways.
"""

import numpy as np

import flowtex

turn, around = np.meshgrid(np.linspace(0, 2 * np.pi, 121), np.linspace(0, 2 * np.pi, 61))
out = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=-1)
up = np.array([0.0, 0.0, 1.0])
radius = 1 + 0.42 * np.cos(around)[..., None]
points = radius * out + 0.42 * np.sin(around)[..., None] * up

toroidal = np.stack([-np.sin(turn), np.cos(turn), 0 * turn], axis=-1) / radius
poloidal = np.cos(around)[..., None] * up - np.sin(around)[..., None] * out
ripple = 0.35 + 0.5 * np.cos(3 * around - 2 * turn)[..., None]
field = flowtex.FlowField.from_arrays(points, toroidal + ripple * poloidal)
flowtex.show(field, cmap="plasma")
