"""
The pendulum, on a cylinder
===========================

An angle comes back after a turn, so the phase portrait of a pendulum lies on a cylinder: around it
the angle, along it the angular velocity. Orbits around the bottom swing; those beyond the
saddle's loop go over the top, and on a cylinder they close.
"""

import numpy as np

import flowtex

angle, rate = np.meshgrid(np.linspace(0, 2 * np.pi, 121), np.linspace(-3, 3, 91))
around = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=-1)
ahead = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=-1)
up = np.array([0.0, 0.0, 1.0])
points = 1.6 * around + 0.6 * rate[..., None] * up
flow = (1.6 * rate)[..., None] * ahead - 0.6 * np.sin(angle)[..., None] * up
energy = rate**2 / 2 - np.cos(angle)

field = flowtex.FlowField.from_arrays(points, flow, scalars={"energy": energy})
camera = [(8.4, 2.6, 2.7), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
flowtex.show(field, scalars="energy", cmap="plasma", clim=(-1, 4), camera=camera)
