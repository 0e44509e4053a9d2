"""Lifting flow around a Joukowski airfoil, exact, on an O-grid of its conformal map.

The circle of radius R around ``center`` passes through 1, and ``z = s + 1 / s`` maps it to an
airfoil with a cusped trailing edge. The flow around the circle has the one circulation that
makes the flow leave that edge smoothly (the Kutta condition).

    circle's plane                      airfoil's plane, chord 1
    s = center + R exp(eta + i phi)     eta constant: rings, phi constant: lines outwards

Rings crowd at the wall, and the map itself crowds the nodes at the trailing edge, where the first
and last column meet: the flow crosses this seam below the edge and follows it behind.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Floats

Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Joukowski:
    """An airfoil of unit chord in a stream of unit speed.

    The real part of the circle's ``center``, negative, gives thickness, its imaginary part camber.
    ``incidence`` is the angle of the stream to the x axis, in degrees.
    """

    center: complex = -0.1 + 0.08j
    incidence: float = 8.0

    @property
    def radius(self) -> float:
        """Radius of the circle."""
        return abs(1.0 - self.center)

    @property
    def edge(self) -> float:
        """Angle on the circle of the trailing edge, in radians."""
        return float(np.angle(1.0 - self.center))

    @property
    def circulation(self) -> float:
        """Circulation around the circle, clockwise."""
        return 4.0 * np.pi * self.radius * float(np.sin(np.radians(self.incidence) - self.edge))

    @property
    def chord(self) -> float:
        """Extent of the mapped airfoil along x."""
        angles = self.edge + np.linspace(0.0, 2.0 * np.pi, 4001)
        circle = self.center + self.radius * np.exp(1j * angles)
        return float(np.ptp((circle + 1.0 / circle).real))

    def grid(self, rows: int, columns: int, extent: float) -> Complex:
        """Return nodes (rows, columns) in the plane of the circle, outwards and around.

        They begin at the trailing edge and go clockwise, along the lower side first; the last
        column repeats the first. The outer ring is ``extent`` chords from the airfoil, roughly.
        """
        angles = self.edge - np.linspace(0.0, 2.0 * np.pi, columns)
        angles[-1] = angles[0]
        s = np.linspace(0.0, 1.0, rows)
        # A sixth of the even spacing at the wall; growth from cell to cell stays below a tenth.
        rings = np.log(extent * self.chord / self.radius) * (s / 6.0 + 5.0 / 6.0 * s**2)
        return self.center + self.radius * np.exp(rings[:, None] + 1j * angles)

    def place(self, nodes: Complex) -> Floats:
        """Return positions (..., 2) in the airfoil's plane, from x = 0 to the edge at (1, 0)."""
        z = (nodes + 1.0 / nodes - 2.0) / self.chord + 1.0
        return np.stack([z.real, z.imag], axis=-1)

    def velocity(self, nodes: Complex) -> Floats:
        """Return the velocity (..., 2) in the airfoil's plane at nodes in that of the circle."""
        turn = np.exp(1j * np.radians(self.incidence))
        s = nodes - self.center
        swirl = 1j * self.circulation / (2.0 * np.pi)
        flow = 1.0 / turn - self.radius**2 * turn / s**2 + swirl / s
        stretch = 1.0 - nodes**-2.0
        # Both vanish at the trailing edge: there the quotient is that of their derivatives.
        at_edge = np.abs(stretch) < 1e-9
        limit = (2.0 * self.radius**2 * turn / s**3 - swirl / s**2) * nodes**3 / 2.0
        w = np.where(at_edge, limit, flow / np.where(at_edge, 1.0, stretch))
        return np.stack([w.real, -w.imag], axis=-1)
