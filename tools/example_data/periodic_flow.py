"""Two-dimensional viscous flow in a periodic unit box, solved by Fourier modes.

The vorticity w obeys ``w_t + u . grad w = nu lap w``; the velocity follows from it mode by
mode. Products are taken on the nodes and modes above two thirds of the highest are dropped, so
none is aliased. The viscous part is integrated exactly (an integrating factor), the rest by the
classical fourth-order Runge-Kutta scheme.

Nodes are (j, i) with y = j / N and x = i / N; coefficients come from ``scipy.fft.rfft2``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from flowtex.examples._shipped import periodic_velocity

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class PeriodicFlow:
    """The equations on N x N nodes of the unit box.

    Attributes
    ----------
    size : int
        N, nodes along each axis, the closing line not counted.
    viscosity : float
        Kinematic viscosity, in boxes squared per unit of time.
    """

    size: int
    viscosity: float

    @cached_property
    def wavenumbers(self) -> tuple[Real, Real]:
        """2 pi times the wave counts along y, (N, 1), and x, (1, N // 2 + 1)."""
        ky = 2.0 * np.pi * fft.fftfreq(self.size, 1.0 / self.size)[:, None]
        kx = 2.0 * np.pi * fft.rfftfreq(self.size, 1.0 / self.size)[None, :]
        return ky, kx

    @cached_property
    def square(self) -> Real:
        """Squared wavenumber of each mode, (N, N // 2 + 1)."""
        ky, kx = self.wavenumbers
        return np.asarray(kx**2 + ky**2)

    @cached_property
    def resolved(self) -> NDArray[np.bool_]:
        """Modes that the two-thirds rule keeps, (N, N // 2 + 1)."""
        ky, kx = self.wavenumbers
        limit = 2.0 * np.pi * self.size / 3.0
        return np.asarray((np.abs(ky) < limit) & (np.abs(kx) < limit))

    def velocity(self, vorticity: Complex) -> Real:
        """Velocity (N, N, 2) at the nodes from the coefficients of the vorticity."""
        return periodic_velocity(vorticity)

    def _change(self, vorticity: Complex) -> Complex:
        """Coefficients of - u . grad w."""
        ky, kx = self.wavenumbers
        slopes = fft.irfft2(
            np.stack([1j * kx * vorticity, 1j * ky * vorticity]), (self.size, self.size)
        )
        velocity = self.velocity(vorticity)
        product = velocity[..., 0] * slopes[0] + velocity[..., 1] * slopes[1]
        return np.where(self.resolved, -fft.rfft2(product), 0.0)

    def advance(self, vorticity: Complex, step: float, count: int = 1) -> Complex:
        """Advance the coefficients of the vorticity by `count` time steps.

        Parameters
        ----------
        vorticity : ndarray, shape (N, N // 2 + 1)
            Coefficients at the start; left unchanged.
        step : float
            Length of a time step.
        count : int, default: 1
            How many steps.

        Returns
        -------
        ndarray, shape (N, N // 2 + 1)
            Coefficients at the end, without the modes that the two-thirds rule drops.
        """
        half = np.exp(-self.viscosity * self.square * step / 2.0)
        now = np.where(self.resolved, vorticity, 0.0)
        for _ in range(count):
            first = self._change(now)
            second = self._change(half * (now + step / 2.0 * first))
            third = self._change(half * now + step / 2.0 * second)
            fourth = self._change(half * (half * now + step * third))
            middle = half * (second + third)
            now = half**2 * (now + step / 6.0 * first) + step / 6.0 * (2.0 * middle + fourth)
        return now

    def energy(self, vorticity: Complex) -> float:
        """Mean of u . u / 2 over the box."""
        return float(np.mean(np.sum(self.velocity(vorticity) ** 2, axis=-1)) / 2.0)

    def enstrophy(self, vorticity: Complex) -> float:
        """Mean of w^2 / 2 over the box."""
        return float(np.mean(fft.irfft2(vorticity, (self.size, self.size)) ** 2) / 2.0)


def decaying_turbulence(size: int, seed: int, waves: float = 6.0) -> Complex:
    """Random vorticity around one wave count, of unit root-mean-square speed.

    Parameters
    ----------
    size : int
        N, nodes along each axis.
    seed : int
        Seed of the random phases; they do not depend on `size`.
    waves : float, default: 6.0
        Waves per box that carry most of the energy.

    Returns
    -------
    ndarray, shape (N, N // 2 + 1)
        Coefficients of the vorticity.
    """
    coarse = 64
    noise = fft.rfft2(np.random.default_rng(seed).standard_normal((coarse, coarse)))
    flow = PeriodicFlow(coarse, 0.0)
    count = np.sqrt(flow.square) / (2.0 * np.pi)
    shaped = np.where(flow.resolved, noise * count * (count / waves) ** 2, 0.0)
    shaped *= np.exp(-((count / waves) ** 2))
    shaped /= np.sqrt(2.0 * flow.energy(shaped))
    return resample(shaped, size)


def resample(vorticity: Complex, size: int) -> Complex:
    """Coefficients of the same function for another number of nodes, waves cut or added.

    Parameters
    ----------
    vorticity : ndarray, shape (M, M // 2 + 1)
        Coefficients on M x M nodes.
    size : int
        N, nodes wanted along each axis.

    Returns
    -------
    ndarray, shape (N, N // 2 + 1)
        Coefficients on N x N nodes; the highest wave of an even count is dropped.
    """
    old = vorticity.shape[0]
    top = (min(old, size) - 1) // 2
    result = np.zeros((size, size // 2 + 1), dtype=np.complex128)
    result[: top + 1, : top + 1] = vorticity[: top + 1, : top + 1]
    result[-top:, : top + 1] = vorticity[-top:, : top + 1]
    return np.asarray(result * (size / old) ** 2)
