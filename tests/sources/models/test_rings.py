"""Rings of latitude are joined without a search, and cover the globe once."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.spatial

from flowtex._util.array_types import Floats, Indices
from flowtex.sources.models.healpix import healpix_centres
from flowtex.sources.models.rings import whole_rings
from flowtex.sources.models.scattered import join_points


def unit_vectors(lon: Floats, lat: Floats) -> Floats:
    a, b = np.radians(lon), np.radians(lat)
    return np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], axis=-1)


def healpix(nside: int, *, nested: bool) -> Floats:
    lon, lat = healpix_centres(np.arange(12 * nside**2), nside, nested=nested)
    return unit_vectors(lon, lat)


def octahedral(count: int) -> Floats:
    """Points of a reduced Gaussian grid with 20 points beside the poles, and 4 more in each row."""
    lines = np.degrees(np.arcsin(np.polynomial.legendre.leggauss(2 * count)[0]))
    lon, lat = [], []
    for row, latitude in enumerate(lines):
        points = 20 + 4 * min(row, 2 * count - 1 - row)
        lon.append(np.arange(points) * 360 / points)
        lat.append(np.full(points, latitude))
    return unit_vectors(np.concatenate(lon), np.concatenate(lat))


def solid_angles(p: Floats, triangles: Indices) -> Floats:
    a, b, c = (p[triangles[:, corner]] for corner in range(3))
    volume = (a * np.cross(b, c)).sum(axis=1)
    cosines = (a * b).sum(axis=1) + (b * c).sum(axis=1) + (c * a).sum(axis=1)
    return np.asarray(2 * np.arctan2(volume, 1 + cosines))


GRIDS = {
    "octahedral": octahedral(8),
    **{f"ring {nside}": healpix(nside, nested=False) for nside in (2, 3, 7, 64)},
    **{f"nested {nside}": healpix(nside, nested=True) for nside in (2, 4, 64)},
}


@pytest.mark.parametrize("name", GRIDS)
def test_rings_cover_the_globe_once(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(scipy.spatial, "ConvexHull")  # nothing is searched
    p = GRIDS[name]
    triangles = join_points(p * 6.371e6, on_sphere=True)
    assert len(triangles) == 2 * len(p) - 4
    angles = solid_angles(p, triangles)
    assert angles.min() > 0
    assert angles.sum() / (4 * np.pi) == pytest.approx(1, abs=1e-12)
    sides = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, ::2]]))
    assert (np.unique(sides, axis=0, return_counts=True)[1] == 2).all()


@pytest.mark.parametrize("name", ["octahedral", "nested 4"])
def test_triangles_are_as_compact_as_those_of_the_sphere(name: str) -> None:
    p = GRIDS[name]
    triangles = join_points(p, on_sphere=True)
    delaunay = scipy.spatial.ConvexHull(p).simplices
    lengths = [
        np.linalg.norm(p[t] - p[np.roll(t, 1, axis=1)], axis=-1).sum()
        for t in (triangles, delaunay)
    ]
    assert lengths[0] < 1.03 * lengths[1]


def test_parts_of_a_grid_are_no_rings() -> None:
    p = healpix(4, nested=False)
    assert whole_rings(p) is not None
    assert whole_rings(p[:-1]) is None
    assert whole_rings(p[p[:, 0] > 0]) is None
    assert whole_rings(np.random.default_rng(0).normal(size=(300, 3))) is None
