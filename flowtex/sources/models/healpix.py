"""Centres of the cells of HEALPix grids."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats, Indices


def healpix_centres(cells: Indices, nside: int, *, nested: bool) -> tuple[Floats, Floats]:
    """Return longitudes and latitudes in degrees of cells, by their numbers in a full grid."""
    return _nested(cells, nside) if nested else _ring(cells, nside)


def _ring(cells: Indices, nside: int) -> tuple[Floats, Floats]:
    count, cap = 12 * nside**2, 2 * nside * (nside - 1)
    south = cells >= count - cap
    north = np.where(south, count - 1 - cells, cells)  # of a cap, counted from its pole
    in_cap = south | (cells < cap)
    ring = ((1 + np.sqrt(1 + 2 * np.where(in_cap, north, 0))) / 2).astype(np.int64)
    place = north - 2 * ring * (ring - 1)
    belt = np.where(in_cap, 0, cells - cap)
    row, column = belt // (4 * nside) + nside, belt % (4 * nside)
    z = np.where(in_cap, 1 - ring**2 / (3 * nside**2), 4 / 3 - 2 * row / (3 * nside))
    shift = ((row - nside) % 2 == 0) / 2
    lon = np.where(in_cap, (place + 0.5) * 90 / ring, (column + shift) * 90 / nside)
    lon = np.where(south, 360 - lon, lon)
    return lon, np.degrees(np.arcsin(np.where(south, -z, z)))


def _nested(cells: Indices, nside: int) -> tuple[Floats, Floats]:
    face, bits = cells // nside**2, cells % nside**2
    x, y = np.zeros_like(bits), np.zeros_like(bits)
    for k in range(nside.bit_length()):
        x |= (bits >> 2 * k & 1) << k
        y |= (bits >> 2 * k + 1 & 1) << k
    ring = (face // 4 + 2) * nside - x - y - 1  # from 1 at the north pole
    size = np.minimum(np.minimum(ring, 4 * nside - ring), nside)
    middle = np.where(face // 4 == 1, 2 * (face % 4), 2 * (face % 4) + 1)
    lon = (middle + (x - y) / size) * 45
    near = 1 - size**2 / (3 * nside**2)
    z = np.where(size < nside, np.where(ring < nside, near, -near), 4 / 3 - 2 * ring / (3 * nside))
    return lon % 360, np.degrees(np.arcsin(z))
