"""What the client gets of the Earth, read back as it reads it."""

from __future__ import annotations

import json
from datetime import datetime
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex._util.array_types import AnyArray, Floats
from flowtex.field.earth.projection import Projection
from flowtex.host.view import WebView, web_views
from flowtex.rendering.map_overlay import map_lines
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.rendering.webgl.earth import LINE_STEPS, dates_of
from flowtex.scene.options import Options


def earth(name: str, *, hole: bool = False, **options: Any) -> FlowField:
    """A flow to the east around the Atlantic, with land in the middle if asked for."""
    if name != "globe":
        pytest.importorskip("pyproj")
    projection = Projection(name, **options)
    center, _ = projection.center
    lon, lat = np.meshgrid(np.linspace(-40, 30, 29) + center, np.linspace(20, 70, 21))
    east = np.ones(lon.shape)
    if hole:
        east[8:12, 10:15] = np.nan
    velocity = projection.vectors(lon, lat, east, 0 * lon)
    points = projection.positions(lon, lat)
    return FlowField.from_arrays(
        points, velocity, length_unit="m", time_unit="s", projection=projection
    )


def view_of(field: FlowField, **options: Any) -> tuple[WebView, ClientData]:
    view = web_views(field, Options.split(**options))[0]
    return view, view.data()


def header_of(field: FlowField, **options: Any) -> Any:
    view, data = view_of(field, **options)
    return json.loads(json.dumps(data.header(view.scene.settings), allow_nan=False))


def read_lines(part: AnyArray, header: Any) -> tuple[Floats, AnyArray]:
    """Points in the surface's frame, and where lines begin."""
    places = np.cumsum(part[:, :3].astype(np.int64), axis=0) % (LINE_STEPS + 1)
    points = np.array(header["low"]) + places / LINE_STEPS * np.array(header["size"])
    return points, np.flatnonzero(part[:, 3])


@pytest.mark.parametrize("name", ["globe", "platecarree", "lambert"])
def test_lines_are_handed_over_to_a_step_of_their_box(name: str) -> None:
    field = earth(name)
    _, data = view_of(field)
    header, parts = header_of(field)["earth"], data.surface()
    geometry = data.textures.geometry
    for option, lines in map_lines(field, has_globe=name == "globe").items():
        points, starts = read_lines(parts[option], header)
        expected = (lines.points - geometry.center) @ geometry.frame.T
        step = np.array(header["size"]) / LINE_STEPS
        assert (np.abs(points - expected) <= 0.51 * step + 1e-6).all()
        np.testing.assert_array_equal(starts, lines.starts[:-1])


def ground(parts: Any) -> AnyArray:
    """Cells without data, be they land or not."""
    return np.concatenate([parts[name] for name in ("land", "missing") if name in parts])


@pytest.mark.parametrize("name", ["globe", "platecarree"])
def test_land_and_sea_without_data_are_where_there_are_no_data(name: str) -> None:
    _, data = view_of(earth(name, hole=True))
    parts = data.surface()
    none = np.zeros_like(parts["cells"])
    both = parts.get("land", none) + parts.get("missing", none)
    np.testing.assert_array_equal(both, 1 - parts["cells"])
    assert not {"land", "missing"} & set(view_of(earth(name))[1].surface())


def cubic(values: Floats, at: Floats) -> Floats:
    """Values (M, C) along an axis at places between them, as the client interpolates."""
    first = np.clip(np.floor(at).astype(int) - 1, 0, len(values) - 4)
    t = at - first
    weights = [np.prod([(t - m) / (n - m) for m in range(4) if m != n], axis=0) for n in range(4)]
    return np.asarray(sum(w[:, None] * values[first + n] for n, w in enumerate(weights)))


@pytest.mark.parametrize(
    "name", ["platecarree", "mercator", "lambert", "north", "robinson", "equalearth"]
)
def test_longitude_and_latitude_between_places(name: str) -> None:
    center = (-20.0, 45.0) if name == "lambert" else (150.0, 0.0)
    field = earth(name, center=center)
    header, parts = header_of(field)["earth"], view_of(field)[1].surface()
    grid, (x0, y0, x1, y1) = parts["lonlat"].astype(float), header["map"]
    assert np.isfinite(grid).all()
    projection = field.projection
    assert projection is not None
    for point in field.points[::4, ::4].reshape(-1, 3):
        share = (point[:2] - [x0, y0]) / [x1 - x0, y1 - y0]
        at = share * (np.array(grid.shape[1::-1]) - 1)
        row = np.stack([cubic(line, at[:1])[0] for line in grid])
        x, y, z = cubic(row, at[1:])[0]
        lon, lat = np.degrees([np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))])
        expected = projection.lonlat(point)
        assert (lon - expected[0] + 180) % 360 - 180 == pytest.approx(0, abs=5e-3)
        assert lat == pytest.approx(float(expected[1]), abs=5e-3)


def test_dates_of_a_calendar_of_its_own_are_told_one_by_one() -> None:
    cftime = pytest.importorskip("cftime")
    points = np.stack(np.meshgrid(np.arange(9.0), np.arange(7.0)), axis=-1)

    def dated(*times: Any) -> FlowField:
        velocity = np.ones((len(times), 7, 9, 2))
        return FlowField.from_arrays(points, velocity, times=np.array(times))

    days = [cftime.Datetime360Day(2000, 2, n) for n in (28, 29, 30)]
    field = dated(*days)
    assert dates_of(field, field.times) == {
        "start": None,
        "dates": ["2000-02-28", "2000-02-29", "2000-02-30"],
        "step": 86400.0,
    }
    field = dated(datetime(2000, 2, 28, 6), datetime(2000, 2, 28, 12))
    assert dates_of(field, field.times) == {
        "start": "2000-02-28T06:00:00",
        "dates": [],
        "step": 21600.0,
    }
    assert dates_of(earth("globe"), np.zeros(1))["start"] is None


@pytest.mark.parametrize("name", ["globe", "platecarree"])
def test_triangles_have_land_and_lines(name: str) -> None:
    grid = earth(name, hole=True)
    # Each cell of the grid, cut in two.
    at = np.arange(grid.valid.size).reshape(grid.shape)
    a, b, c, d = (n.ravel() for n in (at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
    velocity = np.where(grid.valid[..., None], grid.velocity[0], np.nan).reshape(-1, 3)
    field = FlowField.from_triangles(
        grid.points.reshape(-1, 3), triangles, velocity, projection=grid.projection
    )
    ours, theirs = (view_of(each)[1] for each in (field, grid))
    assert ours.constants()["earth"]["below"] == theirs.constants()["earth"]["below"]
    parts, other = ours.surface(), theirs.surface()
    # Where the surface ends lines end within half a cell.
    assert len(parts["graticule"]) == pytest.approx(len(other["graticule"]), rel=0.05)
    assert len(parts["coastlines"]) == pytest.approx(len(other["coastlines"]), rel=0.05)
    faces = ground(parts)
    assert faces.dtype == np.uint32
    assert len(faces) == pytest.approx(2 * int(ground(other).sum()), abs=2)
    assert not field.valid[0, faces].all(axis=1).any()
