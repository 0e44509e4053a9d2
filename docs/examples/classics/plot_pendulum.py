"""
The pendulum, on a cylinder
===========================

The angle of a pendulum is periodic, so its phase portrait lies on a cylinder: the angle around it,
the angular velocity along it. Orbits near the bottom are oscillations; those beyond the separatrix
of the saddle are rotations, which close on the cylinder.
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
