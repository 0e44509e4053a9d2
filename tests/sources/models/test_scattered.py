"""Scattered points and faces of a cube: triangles between neighbours, exact values."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from earth_data import components, on_sphere
from scipy.spatial import Delaunay

from flowtex import FlowField
from flowtex._util.array_types import Floats, Indices
from flowtex.errors import FieldError
from flowtex.field.earth.projection import EARTH_RADIUS, GLOBE, Projection
from flowtex.field.options import FieldOptions
from flowtex.field.units import factor
from flowtex.scene.fields import read_field
from flowtex.sources.models.scattered import join_points

pytestmark = pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")

EAST, NORTH = ({"units": "m s-1", "standard_name": f"{w}ward_wind"} for w in ("east", "north"))
RANDOM = np.random.default_rng(0)


def area(p: Floats, triangles: Indices) -> float:
    a, b, c = (p[triangles[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def flat(points: Any) -> Floats:
    return np.column_stack([points, np.zeros(len(points))])


def lattice(columns: int, rows: int) -> Floats:
    x, y = np.meshgrid(np.arange(float(columns)), np.arange(float(rows)))
    return np.stack([x.ravel(), y.ravel()], axis=-1)


def along(lon: Floats, lat: Floats, dim: str = "values") -> xr.Dataset:
    """The turning Earth at points along one dimension."""
    u, v = components(lon, lat)
    return xr.Dataset(
        {"u": (dim, u, EAST), "v": (dim, v, NORTH)},
        {"longitude": (dim, lon), "latitude": (dim, lat)},
    )


def faults(field: FlowField) -> float:
    """The greatest error on the globe in m/s, of components at the positions of the nodes."""
    globe = Projection(GLOBE)
    lon, lat = globe.lonlat(field.points)
    drawn = globe.components(lon, lat, np.asarray(field.velocity[0]))
    errors = [np.abs(a - b).max() for a, b in zip(drawn, components(lon, lat), strict=True)]
    return float(max(errors))


def reduced(n: int = 16) -> tuple[Floats, Floats]:
    """An octahedral reduced Gaussian grid."""
    rows = np.arange(2 * n)
    lat = np.degrees(np.arcsin(np.polynomial.legendre.leggauss(2 * n)[0]))[::-1]
    counts = 20 + 4 * np.minimum(rows, rows[::-1])
    lon = np.concatenate([np.arange(count) * 360 / count for count in counts])
    return lon, np.repeat(lat, counts)


def cube(n: int = 8) -> xr.Dataset:
    """Faces of a cube, with coordinates along its axes that only count."""
    a = np.linspace(-np.pi / 4, np.pi / 4, 2 * n + 1)[1::2]
    p, q = np.meshgrid(np.tan(a), np.tan(a))
    one = np.ones_like(p)
    faces = ((one, p, q), (-p, one, q), (-one, -p, q), (p, -one, q), (-q, p, one), (q, p, -one))
    x, y, z = np.moveaxis(np.array(faces), 1, 0)
    lon, lat = np.degrees(np.arctan2(y, x)) % 360, np.degrees(np.arctan2(z, np.hypot(x, y)))
    u, v = components(lon, lat)
    dims = ("nf", "Ydim", "Xdim")
    counts = np.linspace(-5, 5, n)
    return xr.Dataset(
        {"U": (dims, u, EAST), "V": (dims, v, NORTH)},
        {
            "lons": (dims, lon),
            "lats": (dims, lat),
            "Xdim": ("Xdim", counts, {"units": "degrees_east"}),
            "Ydim": ("Ydim", counts, {"units": "degrees_north"}),
        },
    )


def test_components_along_rows_of_faces_raise() -> None:
    ds = cube()
    for name in "UV":
        del ds[name].attrs["standard_name"]
    with pytest.raises(FieldError, match=r"U and V lie along the rows.*6 faces.*isel={'nf': 0}"):
        FlowField.from_xarray(ds, globe=True)
    assert faults(FlowField.from_xarray(ds, components="earth", globe=True)) < 1e-6


def test_the_advice_for_components_along_rows_of_faces_works() -> None:
    """As of LLC grids, whose files have the cosine and the sine of the angle of rows."""
    ds = cube()
    angle = xr.DataArray(RANDOM.uniform(0, 6, ds.U.shape), dims=ds.U.dims)
    cos, sin = np.cos(angle), np.sin(angle)
    rows = ds.assign(U=ds.U * cos + ds.V * sin, V=ds.V * cos - ds.U * sin, CS=cos, SN=sin)
    with pytest.raises(FieldError, match=r"east = U \* CS - V \* SN, north = U \* SN") as error:
        FlowField.from_xarray(rows, globe=True)
    east, north = (
        eval(formula, {name: rows[name] for name in ("U", "V", "CS", "SN")})
        for formula in ("U * CS - V * SN", "U * SN + V * CS")
    )
    assert "components='earth'" in str(error.value)
    named = {"u": "east", "v": "north", "components": "earth"}
    turned = rows.assign(east=east, north=north)
    assert faults(FlowField.from_xarray(turned, **named, globe=True)) < 1e-6


def test_no_triangle_spans_the_notch() -> None:
    p = RANDOM.uniform(-1, 1, (3000, 2))
    p = flat(p[~((p > 0).all(axis=1))])
    triangles = join_points(p, on_sphere=False)
    middles = p[triangles].mean(axis=1)
    assert (middles[:, :2].min(axis=1) < 0.1).all()
    assert 2.85 < area(p, triangles) < 3.02
    assert len(np.unique(triangles)) == len(p)


@pytest.mark.parametrize("stretched", [1.0, 3.0])
def test_strips_beside_a_gap_stay_apart(stretched: float) -> None:
    strip = lattice(30, 20)
    p = flat(np.concatenate([strip, strip + np.array([42, 0])])) * [1.0, stretched, 1.0]
    assert np.isclose(area(p, join_points(p, on_sphere=False)), 2 * 29 * 19 * stretched)


def test_a_missing_point_is_bridged() -> None:
    p = flat(np.delete(lattice(30, 20), 310, axis=0))
    assert np.isclose(area(p, join_points(p, on_sphere=False)), 29 * 19)


@pytest.mark.parametrize("degrees", [40.0, 1e-3])
def test_regions_on_the_sphere_are_not_closed(degrees: float) -> None:
    p = lattice(30, 20) / 30 * degrees
    p = on_sphere(170 + p[:, 0], -10 + p[:, 1])
    triangles = join_points(p, on_sphere=True)
    assert len(triangles) == 2 * 29 * 19
    a, b, c = (p[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    assert ((normals * p[triangles[:, 0]]).sum(axis=1) > 0).all()


def test_random_globe_has_holes_only_where_points_are_missing() -> None:
    p = RANDOM.normal(size=(4000, 3))
    p /= np.linalg.norm(p, axis=1, keepdims=True)
    assert len(join_points(p, on_sphere=True)) > 2 * 4000 - 4 - 20
    sea = p[p @ [0.6, 0, 0.8] < 0.8]  # a cap of a tenth of the sphere is missing
    assert 0.88 < area(sea, join_points(sea, on_sphere=True)) / (4 * np.pi) < 0.91


T = np.linspace(0, 6, 200)


@pytest.mark.parametrize(
    "p",
    [
        np.stack([T, T], axis=-1),
        np.stack([T, np.sin(T)], axis=-1),
        np.stack([np.cos(T), np.sin(T)], axis=-1),
        np.stack([T, T + RANDOM.normal(0, 0.002, 200)], axis=-1),
    ],
    ids=["straight", "wave", "circle", "noise"],
)
def test_points_along_lines_raise(p: Floats) -> None:
    with pytest.raises(FieldError, match=r"200 points lie along lines.*interpolate"):
        join_points(flat(p), on_sphere=False)
    with pytest.raises(FieldError, match=r"200 points lie along lines.*interpolate"):
        FlowField.from_xarray(along(10 + p[:, 0], 40 + p[:, 1], "obs"))


def test_few_stations_raise() -> None:
    with pytest.raises(FieldError, match=r"there are 12 points.*expected at least 30"):
        FlowField.from_xarray(along(RANDOM.uniform(0, 9, 12), RANDOM.uniform(0, 9, 12), "station"))


def test_positions_along_time_raise() -> None:
    dates = np.arange("2024-01-01", "2024-07-19", dtype="M8[D]").astype("M8[ns]")
    ds = along(T, np.sin(T), "time").assign_coords(time=dates)
    with pytest.raises(FieldError, match="positions along time: a trajectory"):
        FlowField.from_xarray(ds)


def test_moving_points_at_a_time() -> None:
    lon, lat = RANDOM.uniform(0, 9, (2, 5, 40))
    dates = np.arange("2024-01-01", "2024-01-06", dtype="M8[D]").astype("M8[ns]")
    dims = ("time", "drifter")
    ds = xr.Dataset(
        {"u": (dims, lon, EAST), "v": (dims, lat, NORTH)},
        {"lon": (dims, lon), "lat": (dims, lat), "time": dates},
    )
    assert FlowField.from_xarray(ds, isel={"time": 2}, globe=True).shape == (1, 40)
    assert FlowField.from_xarray(ds.isel(time=2), globe=True).shape == (1, 40)


def test_feature_type_of_trajectories_raises() -> None:
    ds = along(RANDOM.uniform(0, 9, 100), RANDOM.uniform(0, 9, 100), "obs")
    ds.attrs["featureType"] = "trajectory"
    with pytest.raises(FieldError, match="of the type 'trajectory'"):
        FlowField.from_xarray(ds)


def test_sections_along_stations_stay() -> None:
    along_line, depth = ("depth", "station"), np.arange(0.0, 50, 5)
    values = np.ones((10, 40))
    ds = xr.Dataset(
        {
            "u": (along_line, values, {"units": "m/s"}),
            "v": (along_line, values, {"units": "m/s"}),
            "w": (along_line, 0.01 * values, {"units": "m/s"}),
        },
        {
            "depth": ("depth", depth, {"units": "m", "positive": "down"}),
            "lon": ("station", np.linspace(0, 5, 40)),
            "lat": ("station", np.linspace(40, 42, 40)),
            "station": ("station", np.arange(40.0) * 10, {"units": "km"}),
        },
    )
    assert FlowField.from_xarray(ds, "u", "w").shape == (10, 40)


def test_levels_and_times_of_points() -> None:
    lon, lat = reduced()
    ds = along(lon, lat, "ncol")
    steps = xr.DataArray([1.0, 2, 3], dims="time").assign_coords(
        time=np.arange("2024-01-01", "2024-01-04", dtype="M8[D]").astype("M8[ns]")
    )
    levels = xr.DataArray([1.0, 5], dims="lev").assign_coords(lev=[1000.0, 500.0])
    levels.lev.attrs["units"] = "hPa"
    attrs = {name: ds[name].attrs for name in "uv"}
    ds = (ds * steps * levels).transpose("time", "lev", "ncol")
    for name in "uv":
        ds[name].attrs = attrs[name]
    field = FlowField.from_xarray(ds, level=500, globe=True)
    speed = np.linalg.norm(np.stack(components(lon, lat)), axis=0)
    for step in range(3):
        drawn = np.linalg.norm(np.asarray(field.velocity[step])[0], axis=-1)
        assert np.allclose(drawn, 5 * (step + 1) * speed)
    assert np.allclose(np.linalg.norm(field.points, axis=-1), EARTH_RADIUS)


@pytest.mark.parametrize(("unit", "metres"), [("mm", 1e-3), ("km", 1e3), ("inch", 0.0254)])
def test_points_keep_the_unit_of_x(unit: str, metres: float) -> None:
    x, y = RANDOM.uniform(0, 9, (2, 200))
    ds = xr.Dataset(
        {name: ("p", x, {"units": "m/s"}) for name in "uv"},
        {"x": ("p", x, {"units": unit}), "y": ("p", y * metres, {"units": "m"})},
    )
    field = FlowField.from_xarray(ds)
    assert np.allclose(field.points[0, :, :2], np.stack([x, y], axis=-1))
    assert factor(field.length_unit, "m") == pytest.approx(metres)


def longest_edges(field: FlowField) -> Floats:
    """The longest edge of each triangle, along the Earth on it."""
    p = field.points[0][field.triangles]
    chords = np.linalg.norm(p - np.roll(p, 1, axis=1), axis=-1).max(axis=1)
    if field.projection is None:
        return np.asarray(chords)
    return np.asarray(2 * EARTH_RADIUS * np.arcsin(chords / 2 / EARTH_RADIUS))


def around_a_hole() -> tuple[Floats, Floats]:
    x, y = RANDOM.uniform(0, 10, (2, 700))
    outside = (x < 3) | (x > 7) | (y < 2) | (y > 8)
    return x[outside], y[outside]


@pytest.mark.parametrize("form", ["arrays", "table", "dictionary", "dataset"])
def test_longest_edge_between_points_in_a_plane(form: str) -> None:
    """All triangles of Delaunay with short edges are drawn, and no others."""
    x, y = around_a_hole()
    columns = {"x": x, "y": y, "u": 1 + 0 * x, "v": x}
    data: Any = tuple(columns.values())
    if form == "table":
        data = pd.DataFrame(columns)
    elif form == "dictionary":
        data = columns
    elif form == "dataset":
        data = xr.Dataset({name: ("point", values) for name, values in columns.items()})
        data = data.set_coords(["x", "y"])
    field = read_field(data, FieldOptions(max_edge=0.9))
    places = np.stack([x, y], axis=-1)
    every = Delaunay(places).simplices
    sides = np.linalg.norm(places[every] - places[np.roll(every, 1, axis=1)], axis=-1)
    assert field.triangles is not None
    assert len(field.triangles) == (sides.max(axis=1) <= 0.9).sum()
    assert longest_edges(field).max() <= 0.9
    assert np.allclose(field.velocity[0][field.valid][:, 1], field.points[field.valid][:, 0])


@pytest.mark.parametrize("length", [90, "90 km", "90000 m", "48.6 nautical_mile"])
@pytest.mark.parametrize("globe", [True, False])
def test_longest_edge_on_the_earth(length: Any, globe: bool) -> None:
    lon, lat = RANDOM.uniform(0, 10, (2, 600))
    data = along(lon, lat)
    field = FlowField.from_xarray(data, max_edge=length, globe=True)
    assert 85e3 < longest_edges(field).max() <= 90.1e3
    assert "edges of up to" in field.reading.of("surface")[0]
    assert faults(field) < 1e-6
    if not globe:
        flat_map = FlowField.from_xarray(data, max_edge=length)
        assert flat_map.triangles is not None and field.triangles is not None
        assert len(flat_map.triangles) == len(field.triangles)


@pytest.mark.parametrize("length", [0, -3, "x", "50 s", True, np.nan])
def test_lengths_that_are_none(length: Any) -> None:
    with pytest.raises(FieldError, match=r"max_edge is .*; expected the length .* in km, or with"):
        FlowField.from_xarray(along(*RANDOM.uniform(0, 10, (2, 50))), max_edge=length)


def test_longest_edge_that_leaves_nothing() -> None:
    data = along(*RANDOM.uniform(0, 10, (2, 50)))
    with pytest.raises(FieldError, match=r"max_edge is 1 m, and every .* it is up to .* m\. Incr"):
        FlowField.from_xarray(data, max_edge="1 m")


def test_longest_edge_of_a_grid() -> None:
    x = np.arange(5.0)
    u = np.ones((5, 5))
    grid = xr.Dataset({"u": (("y", "x"), u), "v": (("y", "x"), u)}, {"x": x, "y": x})
    for data in (grid, grid.to_dataframe().reset_index(), (x, x, u, u)):
        with pytest.raises(FieldError, match=r"scattered points, but .* grid; omit it"):
            read_field(data, FieldOptions(max_edge=2))
