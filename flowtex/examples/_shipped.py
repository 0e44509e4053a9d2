"""Examples that are read from files which come with the package.

The flows were computed by the scripts in ``tools/example_data``. Values were rounded to
16 bits, and the differences from node to node stored: smooth fields have small differences, which
compress well, and whole numbers add up again without error; so do those from time to time.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy
from numpy.typing import NDArray

from flowtex._util.array_types import AnyArray, Floats

#: Folder of the shipped files, and their names.
DATA = Path(__file__).parent / "data"
CYLINDER, VORTEX, DELTA_WING = "cylinder.npz", "vortex.npz", "delta_wing.npz"
OCEAN, WEATHER = "ocean.nc.gz", "weather.nc.gz"


def cylinder_arrays() -> tuple[Floats, Floats, Floats, Floats]:
    """Return points (65, 161, 2), velocity (31, 65, 161, 2), vorticity and times (31,)."""
    file = load(CYLINDER)
    velocity, vorticity = (
        unpack(file[name], float(file[step]), axis=(0, 1, 2))
        for name, step in (("velocity", "step"), ("vorticity", "vorticity_step"))
    )
    columns = np.arange(velocity.shape[2] + 1) % velocity.shape[2]
    theta = 2.0 * np.pi * columns / velocity.shape[2]
    points = file["radii"][:, None, None] * np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    return points, velocity[:, :, columns], vorticity[:, :, columns], file["times"]


def vortex_arrays() -> tuple[Floats, Floats, Floats, Floats]:
    """Return points (100, 100, 2), velocity, vorticity (31, 100, 100) and times.

    The last row and column repeat the first, one box further on.
    """
    file = load(VORTEX)
    vorticity = unpack(file["vorticity"], float(file["step"]), axis=(1, 2))
    velocity = np.array([periodic_velocity(scipy.fft.rfft2(w)) for w in vorticity])
    size = vorticity.shape[-1]
    axis = np.linspace(0.0, 1.0, size + 1)
    points = np.stack(np.meshgrid(axis, axis), axis=-1)
    wrapped = np.arange(size + 1) % size
    velocity, vorticity = (values[:, wrapped][:, :, wrapped] for values in (velocity, vorticity))
    return points, velocity, vorticity, file["times"]


def periodic_velocity(vorticity: NDArray[np.complex128]) -> Floats:
    """Return the velocity (N, N, 2) in a periodic box, in boxes per unit of time, by vorticity.

    The vorticity comes as Fourier coefficients from ``scipy.fft.rfft2``, (N, N // 2 + 1).
    """
    size = len(vorticity)
    ky = 2.0 * np.pi * scipy.fft.fftfreq(size, 1.0 / size)[:, None]
    kx = 2.0 * np.pi * scipy.fft.rfftfreq(size, 1.0 / size)[None, :]
    square = np.asarray(kx**2 + ky**2)
    psi = vorticity / np.where(square == 0.0, np.inf, square)
    parts = scipy.fft.irfft2(np.stack([1j * ky * psi, -1j * kx * psi]), (size, size))
    return np.moveaxis(parts, 0, -1)


def shipped(name: str) -> Path:
    """Return the path of a shipped file.

    Raises a FileNotFoundError when the installation lacks the file.
    """
    path = DATA / name
    if not path.is_file():
        message = (
            f"the example file {name!r} is missing from {path.parent}, although it comes with "
            "flowtex: reinstall flowtex, or compute the file in a clone: python "
            "tools/example_data/build.py"
        )
        raise FileNotFoundError(message)
    return path


def load(name: str) -> dict[str, AnyArray]:
    """Return the arrays of a shipped file by name."""
    with np.load(shipped(name), allow_pickle=False) as file:
        return dict(file)


def unpack(differences: NDArray[np.int16], step: float, axis: int | tuple[int, ...]) -> Floats:
    """Return numbers whose whole-numbered differences along axes, modulo 2^16, were stored."""
    # Unsigned numbers wrap around by definition.
    whole = differences.view(np.uint16)
    for each in np.atleast_1d(axis):
        whole = np.cumsum(whole, axis=each, dtype=np.uint16)
    return whole.view(np.int16).astype(np.float64) * step
