"""
Particle image velocimetry
==========================

Velocities that were measured with noise, on a coarse grid with gaps. Where neighbours differ
much, the direction is uncertain: ``uncertainty`` makes the streaks shorter and fainter there.
"""

import numpy as np

import flowtex

rng = np.random.default_rng(1)
x, y = np.linspace(0, 4, 65), np.linspace(0, 2, 33)
X, Y = np.meshgrid(x, y)
vortex = np.exp(-3 * ((X - 1.5) ** 2 + (Y - 1) ** 2))
velocity = np.stack([1 - 8 * (Y - 1) * vortex, 8 * (X - 1.5) * vortex], axis=-1)
noise = 0.6 * np.exp(-4 * (X - 3.2) ** 2)  # as behind a bad window
velocity += noise[..., None] * rng.normal(size=velocity.shape)
velocity[rng.random(X.shape) < 0.01] = np.nan
spread = noise * np.sqrt(2) / np.maximum(np.linalg.norm(velocity, axis=-1), 0.1)

measured = flowtex.FlowField.from_arrays((x, y), velocity, length_unit="mm", time_unit="s")
flowtex.show(measured, uncertainty=np.nan_to_num(spread, nan=1.0))
