"""Examples that are read from files which come with the package.

The flows were computed by the scripts in ``tools/example_data``. Values were rounded to
16 bits, and the differences from node to node stored: smooth fields have small differences, which
compress well, and whole numbers add up again without error; so do those from time to time.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import scipy
from numpy.typing import NDArray

from flowtex._util.array_types import AnyArray, Floats
from flowtex.errors import import_extra
from flowtex.field.earth.projection import DEGREE

if TYPE_CHECKING:
    import xarray as xr

DATA = Path(__file__).parent / "data"  #: Folder of the shipped files.
CYLINDER = "cylinder.npz"  #: Vortex shedding behind a cylinder.
VORTEX = "vortex.npz"  #: Two-dimensional turbulence.
DELTA_WING = "delta_wing.npz"  #: Flow along a winged body.
OCEAN = "ocean.nc.gz"  #: Ocean currents.
WEATHER = "weather.nc.gz"  #: Global winds.
TURNING = 7.2921e-5  #: Angular velocity of the Earth in radians per second.
GRAVITY = 9.81  #: Gravitational acceleration in m/s².


def cylinder_arrays() -> tuple[Floats, Floats, Floats, Floats]:
    """Return points (65, 161, 2), velocity (31, 65, 161, 2), vorticity and times (31,)."""
    file = load(CYLINDER)
    velocity = unpack(file["velocity"], float(file["step"]), axis=(0, 1, 2))
    vorticity = unpack(file["vorticity"], float(file["vorticity_step"]), axis=(0, 1, 2))
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
    velocity = velocity[:, wrapped][:, :, wrapped]
    vorticity = vorticity[:, wrapped][:, :, wrapped]
    return points, velocity, vorticity, file["times"]


def periodic_velocity(vorticity: NDArray[np.complex128]) -> Floats:
    """Return the velocity (N, N, 2) along x and y in a periodic box, in boxes per unit of time.

    It follows from the vorticity, whose Fourier coefficients come from ``scipy.fft.rfft2``,
    (N, N // 2 + 1) with y along the first axis. Its mean is zero.
    """
    size = len(vorticity)
    ky = 2.0 * np.pi * scipy.fft.fftfreq(size, 1.0 / size)[:, None]
    kx = 2.0 * np.pi * scipy.fft.rfftfreq(size, 1.0 / size)[None, :]
    square = np.asarray(kx**2 + ky**2)
    psi = vorticity / np.where(square == 0.0, np.inf, square)
    components = scipy.fft.irfft2(np.stack([1j * ky * psi, -1j * kx * psi]), (size, size))
    return np.moveaxis(components, 0, -1)


def load(name: str) -> dict[str, AnyArray]:
    """Return the arrays of a shipped file by name."""
    with np.load(DATA / name, allow_pickle=False) as file:
        return dict(file)


def unpack(differences: NDArray[np.int16], step: float, axis: int | tuple[int, ...]) -> Floats:
    """Return numbers whose whole-numbered differences along axes, modulo 2^16, were stored."""
    # Unsigned numbers wrap around by definition.
    whole = differences.view(np.uint16)
    for each in np.atleast_1d(axis):
        whole = np.cumsum(whole, axis=each, dtype=np.uint16)
    return whole.view(np.int16).astype(np.float64) * step


def ocean() -> xr.Dataset:
    """Return eight days of synthetic currents in the Northwest Atlantic.

    A meandering Gulf Stream leaves the coast at Cape Hatteras; rings and smaller eddies move west,
    like Rossby waves, by about 4 km a day.

    Returns
    -------
    xarray.Dataset
        ``uo`` and ``vo`` in m/s, eastward and northward, and ``zos``, the sea surface height in m,
        with which they are in geostrophic balance; (time, latitude, longitude) = (8, 109, 217), NaN
        on land.

    Raises
    ------
    ModuleNotFoundError
        When xarray is missing.

    Examples
    --------
    >>> flowtex.render(flowtex.examples.ocean(), cmap="viridis")  # doctest: +SKIP
    """
    ds = _read(OCEAN)
    lat = np.radians(ds.latitude)
    turning = 2 * TURNING * np.sin(lat) * DEGREE / GRAVITY
    # The file has attributes of the currents, and the height on land too.
    u = -ds.zos.differentiate("latitude")
    v = ds.zos.differentiate("longitude") / np.cos(lat)
    for name, current in (("uo", u), ("vo", v)):
        ds[name] = ds.zos.dims, (current / turning).values, ds[name].attrs
    sea: xr.Dataset = ds[["uo", "vo", "zos"]].where(ds.land == 0)
    return sea


def weather() -> xr.Dataset:
    """Return synthetic global winds at three levels: jets, planetary waves, lows and highs.

    Returns
    -------
    xarray.Dataset
        ``u`` and ``v`` in m/s, eastward and northward, (level, latitude, longitude) =
        (3, 91, 180), at 850, 500 and 250 hPa. They are free of divergence, and smooth across the
        date line and the poles.

    Raises
    ------
    ModuleNotFoundError
        When xarray is missing.

    Examples
    --------
    >>> flowtex.render(flowtex.examples.weather(), level=250, globe=True)  # doctest: +SKIP
    """
    return _read(WEATHER)


def _read(name: str) -> xr.Dataset:
    xarray = import_extra("xarray", "xarray")
    # Plain numbers, so that a copy that a user writes is as exact.
    ds: xr.Dataset = xarray.load_dataset(DATA / name, engine="scipy").drop_encoding()
    return ds
