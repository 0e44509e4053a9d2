"""Coasts and graticules: the file, known places, and that no line shoots across a map."""

from __future__ import annotations

import numpy as np
import pytest

from flowtex._util.array_types import Floats
from flowtex.field.earth.map_lines import COASTS, STEPS_PER_DEGREE, MapLines, coastlines, graticule
from flowtex.field.earth.projection import EARTH_RADIUS, Projection

NAMES = ("platecarree", "mercator", "north", "south", "lambert", "robinson", "equalearth")
CENTERS = ((0.0, 0.0), (150.0, 40.0), (-100.0, -35.0))
DEGREE = np.radians(EARTH_RADIUS)


def pieces(lines: MapLines) -> tuple[Floats, Floats]:
    """Return both ends of all pieces."""
    ends = [lines.points[a:b] for a, b in zip(lines.starts[:-1], lines.starts[1:], strict=True)]
    return np.concatenate([e[:-1] for e in ends]), np.concatenate([e[1:] for e in ends])


def test_the_file_is_small_and_has_closed_rings() -> None:
    assert COASTS.stat().st_size < 150_000
    with np.load(COASTS, allow_pickle=False) as file:
        steps, lengths = file["steps"], file["lengths"]
    points = np.cumsum(steps, axis=0, dtype=np.int16)
    ends = np.cumsum(lengths)
    assert ends[-1] == len(points)
    assert (points[ends - lengths] == points[ends - 1]).all()
    assert lengths.min() > 3
    assert (np.abs(points) <= np.array([180, 90]) * STEPS_PER_DEGREE).all()


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("center", CENTERS)
def test_no_line_shoots_across_a_map(name: str, center: tuple[float, float]) -> None:
    projection, globe = Projection(name, center), Projection("globe")
    for lines in (coastlines(projection), graticule(projection)):
        assert np.isfinite(lines.points).all()
        a, b = pieces(lines)
        # On the Earth, the middle of each piece lies between its ends, and they are near.
        start, middle, stop = (globe.positions(*projection.lonlat(p)) for p in (a, (a + b) / 2, b))
        reach = 1.2 * DEGREE
        for other in (start, stop):
            lengths = np.linalg.norm(middle - other, axis=1)
            known = np.isfinite(lengths)  # on the very edge of a map PROJ has no place
            assert known.mean() > 0.98
            assert lengths[known].max() < reach


@pytest.mark.parametrize("name", ["globe", "lambert"])
def test_a_box_leaves_out_what_is_outside(name: str) -> None:
    projection = Projection(name, (10.0, 45.0), 10.0)
    lon, lat = np.meshgrid(np.linspace(0, 20, 21), np.linspace(38, 52, 15))
    points = projection.positions(lon, lat).reshape(-1, 3)
    box = np.stack([points.min(axis=0), points.max(axis=0)])
    everything, near = coastlines(projection), coastlines(projection, box)
    assert 10 < len(near.points) < 0.2 * len(everything.points)
    margin = 1.1 * DEGREE
    for lines in (near, graticule(projection, box)):
        assert ((lines.points > box[0] - margin) & (lines.points < box[1] + margin)).all()
        assert lines.starts[0] == 0 and lines.starts[-1] == len(lines.points)
    assert len(graticule(projection, box).starts) > 4


@pytest.mark.parametrize(("width", "step"), [(60.0, 10.0), (30.0, 5.0), (4.0, 0.5), (0.5, 0.1)])
def test_a_graticule_has_round_steps(width: float, step: float) -> None:
    projection = Projection("platecarree")
    corners = projection.positions(np.array([0.0, width]), np.array([0.0, width / 2]))
    lines = graticule(projection, corners)
    assert 5 < len(lines.starts) < 30
    found = set()
    for a, b in zip(lines.starts[:-1], lines.starts[1:], strict=True):
        degrees = np.array(projection.lonlat(lines.points[a:b]))
        (fixed,) = np.flatnonzero(np.ptp(degrees, axis=1) < 1e-9)  # the longitude or the latitude
        found.add((int(fixed), round(float(degrees[fixed, 0]), 9)))
    for kind in (0, 1):
        values = np.array(sorted(value for which, value in found if which == kind))
        assert np.diff(values) == pytest.approx(np.full(len(values) - 1, step))
        assert values / step == pytest.approx(np.round(values / step), abs=1e-9)


def test_thinned_lines_keep_their_ends_and_lose_the_short_ones() -> None:
    lines = coastlines(Projection("globe"))
    thin = lines.thinned(50e3)
    assert len(thin.points) < 0.3 * len(lines.points)
    assert len(thin.starts) < len(lines.starts)
    kept = {tuple(p) for p in lines.points[lines.starts[:-1]]}
    assert {tuple(p) for p in thin.points[thin.starts[:-1]]} <= kept
    assert np.diff(thin.starts).min() >= 2
