"""
Lift on a spinning cylinder
===========================

A spinning ball swerves. In potential flow around a cylinder, circulation moves the two stagnation
points downward and makes the flow faster above than below. By Bernoulli's law the pressure is lower
above, which gives a lift: the Magnus effect.
"""

import numpy as np

import flowtex

angle, out = np.meshgrid(np.linspace(0, 2 * np.pi, 161), np.linspace(0, 1, 71))
r = np.exp(1.6 * out)  # finer near the cylinder
z = r * np.exp(1j * angle)
w = 1 - 1 / z**2 + 1j * 1.3 / z  # u - iv: a stream, a doublet, a vortex
velocity = np.stack([w.real, -w.imag], axis=-1)
pressure = 0.5 * (1 - abs(w) ** 2)

points = np.stack([z.real, z.imag], axis=-1)
field = flowtex.FlowField.from_arrays(points, velocity, scalars={"pressure": pressure})
flowtex.show(
    field, scalars="pressure", cmap="coolwarm", clim=(-2.5, 2.5), zoom=2.2, focus=(0.0, 0.0)
)
