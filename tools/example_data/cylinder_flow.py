"""Viscous flow past a circular cylinder, solved in vorticity and streamfunction.

With r = exp(xi) / 2 (the diameter is 1, the free stream is 1 along x) the
incompressible Navier-Stokes equations become, h being r::

    h^2 w_t + psi_theta w_xi - psi_xi w_theta = nu (w_xixi + w_thetatheta)
    psi_xixi + psi_thetatheta = -h^2 w

    around (theta)   Fourier modes, products on a grid with a third more of them
    outwards (xi)    uniform in the logarithm of the radius; the fourth-order
                     compact (Numerov) form, one tridiagonal system for each mode
    time             second-order backward differences; the advection extrapolated

The wall sets two conditions on psi and none on the vorticity; both are met by influence: a
solution with no vorticity at the wall, plus as much of the solution with unit
vorticity there as makes the wall velocity vanish. For the mean over the angle the
second condition is that pressure is single-valued: w_xi has no mean at the wall.
A damping layer swallows the wake before the outer boundary.

All modes share one tridiagonal matrix with zero couplings between the blocks, so
LAPACK factors it once and one call solves every mode.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft, sparse
from scipy.linalg import lapack

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

RADIUS = 0.5


@dataclass(frozen=True)
class CylinderSetup:
    """Size and accuracy of a cylinder run; lengths in diameters, speeds in the free stream's.

    Attributes
    ----------
    reynolds : float
        Reynolds number of the diameter and the free stream.
    outer : float
        Radius of the outer boundary.
    sponge : float
        Radius at which the damping of the vorticity begins.
    modes : int
        Fourier modes kept around the cylinder, the mean included.
    intervals : int
        Intervals from the wall to the outer boundary.
    step : float
        Time step.
    """

    reynolds: float = 100.0
    outer: float = 60.0
    sponge: float = 28.0
    modes: int = 96
    intervals: int = 288
    step: float = 0.005

    @property
    def spacing(self) -> float:
        """Interval in xi."""
        return float(np.log(self.outer / RADIUS)) / self.intervals

    @property
    def angles(self) -> int:
        """Points around on which products are taken, three for every two modes of either sign."""
        return 3 * self.modes

    @property
    def xi(self) -> Real:
        """Logarithm of r over the cylinder's radius, shape (intervals + 1,)."""
        return np.linspace(0.0, self.spacing * self.intervals, self.intervals + 1)

    @property
    def radii(self) -> Real:
        """Radii of the nodes, shape (intervals + 1,)."""
        return np.asarray(RADIUS * np.exp(self.xi))


class _Tridiagonal:
    """Compact second-order systems w'' - c w = s for all modes, with w given at both ends.

    Parameters
    ----------
    coefficient : ndarray, shape (modes, intervals + 1)
        c, at least zero.
    spacing : float
        Interval between nodes.
    """

    def __init__(self, coefficient: Real, spacing: float) -> None:
        inverse = 1.0 / spacing**2
        self._lower = inverse - coefficient[:, :-2] / 12.0
        self._upper = inverse - coefficient[:, 2:] / 12.0
        diagonal = -2.0 * inverse - coefficient[:, 1:-1] * (10.0 / 12.0)
        below, above = self._lower.copy(), self._upper.copy()
        below[:, 0] = 0.0
        above[:, -1] = 0.0
        self._below, self._diagonal, self._above, self._second_above, self._pivots, info = (
            lapack.dgttrf(below.ravel()[1:], diagonal.ravel(), above.ravel()[:-1])
        )
        if info != 0:
            message = f"the tridiagonal system is singular at row {info}; use a smaller spacing"
            raise ArithmeticError(message)

    def solve(self, source: Complex, first: Complex | complex, last: Complex | complex) -> Complex:
        """Solution, shape (modes, intervals + 1), for a source of that shape and end values."""
        result = np.empty_like(source)
        result[:, 0] = first
        result[:, -1] = last
        right = (source[:, :-2] + 10.0 * source[:, 1:-1] + source[:, 2:]) / 12.0
        right[:, 0] -= self._lower[:, 0] * result[:, 0]
        right[:, -1] -= self._upper[:, -1] * result[:, -1]
        both = np.stack([right.real.ravel(), right.imag.ravel()], axis=1)
        solved, _ = lapack.dgttrs(
            self._below, self._diagonal, self._above, self._second_above, self._pivots, both
        )
        result[:, 1:-1] = (solved[:, 0] + 1j * solved[:, 1]).reshape(right.shape)
        return result


def _first_derivative(count: int, spacing: float) -> sparse.csr_array:
    """Fourth-order first derivative, shape (count, count), one-sided at the ends."""
    matrix = sparse.lil_array((count, count))
    central = np.array([1.0, -8.0, 0.0, 8.0, -1.0])
    ends = np.array([[-25.0, 48.0, -36.0, 16.0, -3.0], [-3.0, -10.0, 18.0, -6.0, 1.0]])
    for row in range(2, count - 2):
        matrix[row, row - 2 : row + 3] = central
    for row in range(2):
        matrix[row, :5] = ends[row]
        matrix[count - 1 - row, count - 5 :] = -ends[row, ::-1]
    return sparse.csr_array(matrix / (12.0 * spacing))


def _running_integral(values: Complex, spacing: float) -> Complex:
    """Fourth-order integral of `values` (count,) from the first node to each."""
    cell = np.empty(values.size - 1, dtype=values.dtype)
    cell[1:-1] = (13.0 * (values[1:-2] + values[2:-1]) - values[:-3] - values[3:]) / 24.0
    weights = np.array([9.0, 19.0, -5.0, 1.0]) / 24.0
    cell[0] = weights @ values[:4]
    cell[-1] = weights @ values[:-5:-1]
    result: Complex = np.concatenate([np.zeros(1, values.dtype), np.cumsum(cell)])
    return result * spacing


class CylinderFlow:
    """The flow at one instant, and its advance in time.

    Parameters
    ----------
    setup : CylinderSetup
        Grid, Reynolds number, and time step.
    vorticity : ndarray, shape (modes, intervals + 1), optional
        Fourier coefficients of the vorticity, from which to start; the default is an
        impulsive start, with a weak lone vortex beside the wake to break the symmetry.
    time : float, default: 0.0
        Time of the start.

    Attributes
    ----------
    setup, vorticity, time
        As given, and after each step as they then are.

    Raises
    ------
    ValueError
        When the vorticity has another shape than the setup asks for.
    """

    def __init__(
        self, setup: CylinderSetup, vorticity: Complex | None = None, time: float = 0.0
    ) -> None:
        self.setup, self.time = setup, time
        shape = (setup.modes, setup.intervals + 1)
        if vorticity is not None and vorticity.shape != shape:
            message = (
                f"vorticity has shape {vorticity.shape}, expected {shape} as (modes, "
                "intervals + 1); give the setup that it was computed with, or refine it to this one"
            )
            raise ValueError(message)
        self._m = np.arange(setup.modes, dtype=np.float64)[:, None]
        self._square = setup.radii**2
        self._derivative = _first_derivative(setup.intervals + 1, setup.spacing)
        self._poisson = _Tridiagonal(np.broadcast_to(self._m**2, shape), setup.spacing)
        self._far = np.zeros(setup.modes, dtype=np.complex128)
        self._far[1] = -0.5j * (setup.outer - RADIUS**2 / setup.outer)
        ramp = np.clip((setup.radii - setup.sponge) / (setup.outer - setup.sponge), 0.0, 1.0)
        self._damping = ramp**2
        self._schemes = {rate: self._scheme(rate) for rate in (1.0, 1.5)}
        self._last: tuple[Complex, Complex] | None = None
        self.vorticity: Complex = self._kick() if vorticity is None else vorticity
        self._psi = self._streamfunction(self.vorticity)

    def _kick(self) -> Complex:
        """Gaussian vortex of circulation about 0.1 above the wake's axis."""
        setup = self.setup
        theta = 2.0 * np.pi * np.arange(setup.angles)[:, None] / setup.angles
        x, y = setup.radii * np.cos(theta), setup.radii * np.sin(theta)
        blob = 0.5 * np.exp(-((x - 1.2) ** 2 + (y - 0.4) ** 2) / 0.25**2)
        return np.asarray(fft.rfft(blob, axis=0, norm="forward")[: setup.modes])

    def _scheme(self, rate: float) -> tuple[_Tridiagonal, Complex, Complex]:
        """Implicit operator for a backward difference rate/step, and its influence solution."""
        setup = self.setup
        scale = setup.reynolds * self._square
        coefficient = self._m**2 + scale * (rate / setup.step + self._damping)
        operator = _Tridiagonal(coefficient, setup.spacing)
        unit = operator.solve(np.zeros(coefficient.shape, dtype=np.complex128), 1.0, 0.0)
        psi = self._poisson.solve(-self._square * unit, 0.0, 0.0)
        return operator, unit, self._wall_residual(unit, psi)

    def _wall_residual(self, vorticity: Complex, psi: Complex) -> Complex:
        """Return what must vanish at the wall, (modes,): psi_xi, and for the mean w_xi."""
        stencil = self._derivative[[0], :5].toarray()[0]
        residual = psi[:, :5] @ stencil
        residual[0] = vorticity[0, :5] @ stencil
        return np.asarray(residual)

    def _streamfunction(self, vorticity: Complex) -> Complex:
        """Streamfunction for a vorticity; its mean over the angle is left out."""
        return self._poisson.solve(-self._square * vorticity, 0.0, self._far)

    def _slopes(self) -> tuple[Complex, Complex]:
        """psi_theta and psi_xi as Fourier coefficients, each (modes, intervals + 1)."""
        outwards = np.ascontiguousarray(np.asarray(self._derivative @ self._psi.T).T)
        outwards[0] = -_running_integral(self._square * self.vorticity[0], self.setup.spacing)
        outwards[:, 0] = 0.0
        return 1j * self._m * self._psi, outwards

    def _advection(self) -> Complex:
        """psi_theta w_xi - psi_xi w_theta as Fourier coefficients."""
        around, outwards = self._slopes()
        slope = np.ascontiguousarray((self._derivative @ self.vorticity.T).T)
        count = self.setup.angles
        psi_theta, psi_xi, w_xi, w_theta = (
            fft.irfft(part, count, axis=0, norm="forward")
            for part in (around, outwards, slope, 1j * self._m * self.vorticity)
        )
        product = fft.rfft(psi_theta * w_xi - psi_xi * w_theta, axis=0, norm="forward")
        return np.asarray(product[: self.setup.modes])

    def advance(self) -> None:
        """Advance by one time step; the first after a start is of first order."""
        now, advection = self.vorticity, self._advection()
        if self._last is None:
            rate, history, forcing = 1.0, now, advection
        else:
            rate, history = 1.5, 2.0 * now - 0.5 * self._last[0]
            forcing = 2.0 * advection - self._last[1]
        source = self.setup.reynolds * (forcing - self._square * history / self.setup.step)
        operator, unit, response = self._schemes[rate]
        trial = operator.solve(source, 0.0, 0.0)
        residual = self._wall_residual(trial, self._streamfunction(trial))
        trial -= (residual / response)[:, None] * unit
        self._last = (now, advection)
        self.vorticity = trial
        self._psi = self._streamfunction(trial)
        self.time += self.setup.step

    def forces(self) -> tuple[float, float]:
        """Drag and lift coefficient, from pressure and shear at the wall."""
        slope = (self._derivative[[0]] @ self.vorticity[1])[0]
        wall = 2.0 * np.pi * RADIUS / self.setup.reynolds * (slope - self.vorticity[1, 0])
        return float(-2.0 * wall.imag), float(-2.0 * wall.real)

    def polar_velocity(self) -> tuple[Complex, Complex]:
        """Fourier coefficients of the outward and the anticlockwise velocity."""
        around, outwards = self._slopes()
        return around / self.setup.radii, -outwards / self.setup.radii
