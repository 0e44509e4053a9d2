from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from earth_data import AXIS, RATE, on_sphere, winds
from mesh_data import globe, ugrid
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, Delaunay

import flowtex
from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.errors import Notice
from flowtex.field.derived.kinds import DERIVED
from flowtex.field.earth.projection import EARTH_RADIUS, Projection
from flowtex.field.steps import LazySteps

Made = tuple[FlowField, dict[str, Floats]]


def plane_flow(p: Floats) -> tuple[Floats, dict[str, Floats]]:
    """Return a velocity (..., 2) at positions, and what is derived from it by hand."""
    x, y = p[..., 0], p[..., 1]
    velocity = np.stack([np.sin(2 * x) * np.cos(y) + y * y, np.cos(x + 2 * y)], axis=-1)
    ux, uy = 2 * np.cos(2 * x) * np.cos(y), -np.sin(2 * x) * np.sin(y) + 2 * y
    vx, vy = -np.sin(x + 2 * y), -2 * np.sin(x + 2 * y)
    exact = {
        "vorticity": vx - uy,
        "divergence": ux + vy,
        "shear": np.hypot(ux - vy, vx + uy),
        "okubo_weiss": (ux - vy) ** 2 + (vx + uy) ** 2 - (vx - uy) ** 2,
    }
    return velocity, exact


def lattice(n: int) -> Floats:
    return np.stack(np.meshgrid(np.linspace(0, 2, 2 * n + 1), np.linspace(0, 1, n + 1)), axis=-1)


def crooked(n: int) -> Made:
    x, y = np.moveaxis(lattice(n), -1, 0)
    p = np.stack([x + 0.08 * np.sin(6 * y + x), y + 0.07 * np.sin(3 * x + 1)], axis=-1)
    velocity, exact = plane_flow(p)
    return FlowField.from_arrays(p, velocity), exact


def triangles(n: int) -> Made:
    p = lattice(n).reshape(-1, 2)
    inner = ((p > 0) & (p < (2, 1))).all(axis=1)
    p[inner] += np.random.default_rng(0).uniform(-0.3, 0.3, (inner.sum(), 2)) / n
    field = FlowField.from_triangles(p, Delaunay(p).simplices, plane_flow(p)[0])
    return field, {k: v for k, v in plane_flow(field.points[..., :2])[1].items()}


def rossby_wave(lon: Floats, lat: Floats) -> tuple[Floats, Floats, Floats]:
    """Return a flow without divergence on the unit sphere, and its vorticity (Haurwitz 1940)."""
    a, b, k = np.radians(lon), np.radians(lat), 3
    east = -(np.cos(b) ** (k - 1)) * (np.cos(b) ** 2 - k * np.sin(b) ** 2) * np.cos(k * a)
    north = -k * np.cos(b) ** (k - 1) * np.sin(b) * np.sin(k * a)
    return east, north, -(k + 1) * (k + 2) * np.cos(b) ** k * np.sin(b) * np.cos(k * a)


def on_map(name: str) -> Callable[[int], Made]:
    def make(n: int) -> Made:
        east_end = 170
        north_end = 80
        if name == "globe":
            east_end = 180
            north_end = 90
        longitudes = np.linspace(-east_end, east_end, 4 * n + 1)
        latitudes = np.linspace(-north_end, north_end, 2 * n + 1)
        lon, lat = np.meshgrid(longitudes, latitudes)
        east, north, vorticity = rossby_wave(lon, lat)
        there = Projection(name)
        velocity = there.vectors(lon, lat, EARTH_RADIUS * east, EARTH_RADIUS * north)
        field = FlowField.from_arrays(there.positions(lon, lat), velocity, projection=there)
        return field, {"vorticity": vorticity, "divergence": np.zeros_like(vorticity)}

    return make


def sphere_of_triangles(n: int) -> Made:
    k = np.arange(8 * n * n) + 0.5
    height, turn = 1 - 2 * k / len(k), np.pi * (1 + 5**0.5) * k
    ring = np.sqrt(1 - height**2)
    p = np.stack([ring * np.cos(turn), ring * np.sin(turn), height], axis=-1)
    globe = Projection("globe")
    lon, lat = globe.lonlat(p)
    east, north, vorticity = rossby_wave(lon, lat)
    velocity = globe.vectors(lon, lat, east, north)
    field = FlowField.from_triangles(p, ConvexHull(p).simplices, velocity)
    return field, {"vorticity": vorticity[None], "divergence": np.zeros((1, len(p)))}


MESHES = {
    "crooked": crooked,
    "triangles": triangles,
    "globe": on_map("globe"),
    "robinson": on_map("robinson"),
    "sphere of triangles": sphere_of_triangles,
}


@pytest.mark.parametrize("make", MESHES.values(), ids=MESHES.keys())
def test_errors_fall_with_the_square_of_cells(make: Callable[[int], Made]) -> None:
    def errors(n: int) -> dict[str, float]:
        field, exact = make(n)
        return {k: float(np.abs(field.derive(k)[0] - v).max()) for k, v in exact.items()}

    coarse, fine = errors(16), errors(32)
    for name, error in fine.items():
        assert error < max(0.36 * coarse[name], 0.01), name
        assert error < 0.15, name


def boundary_layer() -> Any:
    """A flow around a cylinder whose vorticity ``w`` is greatest at the wall, on crooked lines."""
    import pyvista as pv

    radius = 0.5 + np.concatenate([[0.0], np.cumsum(2e-3 * 1.1 ** np.arange(40))])
    turn, r = np.meshgrid(np.linspace(0, 2 * np.pi, 161), radius, indexing="ij")
    angle = turn + 0.3 * (r - 0.5) * np.sin(3 * turn)
    places = (r * np.cos(angle), r * np.sin(angle), np.zeros_like(r))
    mesh: Any = pv.StructuredGrid(*(place[..., None] for place in places))
    x, y, _ = np.asarray(mesh.points).T
    r = np.hypot(x, y)
    decay = np.exp(-(r - 0.5) / 0.05)
    share = 1 + 0.5 * x / r
    mesh["U"] = ((1 - decay) * share / r)[:, None] * np.stack([-y, x, 0 * x], axis=-1)
    mesh["w"] = ((1 - decay) / r + decay / 0.05) * share
    return mesh


@pytest.mark.parametrize("kind", ["grid", "triangles"])
def test_peak_of_vorticity_at_a_wall_is_closer_than_that_of_vtk(kind: str) -> None:
    mesh = boundary_layer()
    if kind == "triangles":
        mesh = mesh.extract_surface(algorithm=None).clean(tolerance=1e-9, absolute=True)
        mesh = mesh.triangulate()
    exact = float(np.asarray(mesh["w"]).max())
    assert exact == pytest.approx(30.0)
    peak = float(FlowField.from_pyvista(mesh).derive("vorticity").max())
    assert peak == pytest.approx(exact, rel=5e-3)
    theirs = mesh.compute_derivative(scalars="U", vorticity=True)["vorticity"][:, 2].max()
    # VTK's differences to one side are of first order.
    assert theirs < 0.985 * exact


def test_peak_of_the_wake_is_that_of_its_solver() -> None:
    mesh = flowtex.examples.cylinder()
    solved = np.asarray(mesh["vorticity"])
    derived = FlowField.from_pyvista(mesh).derive("vorticity")
    assert derived.max() == pytest.approx(solved.max(), rel=0.015)
    assert derived.min() == pytest.approx(solved.min(), rel=0.015)


def test_numbering_and_gaps_change_nothing_elsewhere() -> None:
    field, _ = crooked(24)
    p, v = field.points, field.velocity[0]
    valid = np.ones(field.shape, dtype=bool)
    valid[10:14, 20:23] = False
    for name in DERIVED:
        whole = field.derive(name)[0]
        turned = FlowField.from_arrays(p[:, ::-1], v[:, ::-1]).derive(name)[0]
        assert turned[:, ::-1] == pytest.approx(whole, abs=1e-10)
        holed = FlowField.from_arrays(p, v, valid=valid).derive(name)[0]
        assert np.isnan(holed[~valid]).all()
        # Beside the gap differences are of second order to one side.
        assert np.nanmax(np.abs(holed - whole)) < 0.3
        assert holed[:9] == pytest.approx(whole[:9], abs=1e-12)


def test_ftle_of_a_saddle_and_of_the_double_gyre() -> None:
    p = lattice(20) - (1.0, 0.5)
    field = FlowField.from_arrays(p, 0.5 * p * (1, -1))
    rate = field.derive("ftle", horizon=-0.5)[0]
    assert rate[5:-5, 10:-10] == pytest.approx(0.5, abs=1e-3)
    # Backward paths leave upward and downward.
    assert np.isnan(rate[0]).all()

    x, y = np.moveaxis(lattice(40), -1, 0)
    times = np.linspace(0, 6, 61)
    flow = [gyre(lattice(40), t) for t in times]
    field = FlowField.from_arrays((x, y), np.stack(flow), times=times)
    with pytest.warns(Notice, match="the longest valid horizon is 6 at time 0, and 0 at time 6"):
        rates = field.derive("ftle", horizon=5.0)
    assert isinstance(rates, LazySteps)
    assert np.abs(rates[0] - gyre_ftle(x, y, 5.0)).mean() < 2e-3


@pytest.mark.parametrize("horizon", [-2.0, 2.0, 7.0])
@pytest.mark.parametrize("kind", ["grid", "triangles"])
def test_ftle_is_masked_beyond_the_series(kind: str, horizon: float) -> None:
    # A saddle whose strength grows in time: the exponent is its integral over the horizon.
    p, times = lattice(10) - (1.0, 0.5), np.linspace(1, 7, 13)
    flow = np.stack([0.05 * t * p * (1, -1) for t in times])
    if kind == "grid":
        field = FlowField.from_arrays(p, flow, times=times)
    else:
        p = p.reshape(-1, 2)
        field = FlowField.from_triangles(
            p, Delaunay(p).simplices, flow.reshape(13, -1, 2), times=times
        )
    longest = np.copysign(6, horizon)
    with pytest.warns(Notice, match=f"longest valid horizon is {longest:g} at time"):
        rates = field.derive("ftle", horizon=horizon)
    inside = (np.abs(field.points) < 0.22).all(axis=-1)
    for step, time in enumerate(times):
        if 1 <= time + horizon <= 7:
            expected = 0.025 * abs((time + horizon) ** 2 - time**2) / abs(horizon)
            assert rates[step][inside] == pytest.approx(expected, abs=5e-3)
        else:
            assert np.isnan(rates[step]).all()


@pytest.mark.parametrize("kind", ["grid", "triangles"])
def test_ftle_holds_where_particles_rest(kind: str) -> None:
    # At the centre of a sink, at a saddle whose velocity is rounding, and on a wall.
    p = lattice(10)
    sink = p - (1.0, 0.5)
    x, y = np.moveaxis(np.pi * p, -1, 0)
    cells = np.stack([-np.sin(x) * np.cos(y), np.cos(x) * np.sin(y)], axis=-1)
    wall = np.stack([p[..., 1], 0 * x], axis=-1) * (1 - p[..., :1] / 4)
    for flow, horizon, expected in ((-sink, 1.0, -1.0), (cells, 0.2, None), (wall, 0.1, None)):
        if kind == "grid":
            field = FlowField.from_arrays(p, flow)
        else:
            corners = Delaunay(p.reshape(-1, 2)).simplices
            field = FlowField.from_triangles(p.reshape(-1, 2), corners, flow.reshape(-1, 2))
        rate = field.derive("ftle", horizon=horizon)[0].reshape(p.shape[:2])
        assert np.isfinite(rate[:, :-3]).all()
        if expected is not None:
            assert rate[2:-2, 2:-2] == pytest.approx(expected, abs=0.01)


def gyre(p: Floats, t: float) -> Floats:
    """Velocity of the double gyre of Shadden, Lekien and Marsden (2005)."""
    x, y = p[..., 0], p[..., 1]
    a = 0.25 * np.sin(2 * np.pi * t / 10)
    f, slope = a * x * x + (1 - 2 * a) * x, 2 * a * x + 1 - 2 * a
    u = -0.1 * np.pi * np.sin(np.pi * f) * np.cos(np.pi * y)
    return np.stack([u, 0.1 * np.pi * np.cos(np.pi * f) * np.sin(np.pi * y) * slope], axis=-1)


def gyre_ftle(x: Floats, y: Floats, horizon: float, count: int = 200) -> Floats:
    """Return the same exponent by Runge-Kutta's method and differences of NumPy."""
    p, h = np.stack([x, y], axis=-1), horizon / count
    for n in range(count):
        t = n * h
        a = gyre(p, t)
        b = gyre(p + h / 2 * a, t + h / 2)
        c = gyre(p + h / 2 * b, t + h / 2)
        d = gyre(p + h * c, t + h)
        p = p + h / 6 * (a + 2 * b + 2 * c + d)
    by_x = np.gradient(p, x[0, 1] - x[0, 0], axis=1, edge_order=2)
    by_y = np.gradient(p, y[1, 0] - y[0, 0], axis=0, edge_order=2)
    matrix = np.stack([by_x, by_y], axis=-1)
    return np.asarray(np.log(np.linalg.norm(matrix, 2, axis=(-2, -1))) / horizon)


@pytest.mark.parametrize("kind", ["grid", "triangles"])
def test_steps_without_data_are_not_differentiated(kind: str) -> None:
    p = lattice(20)
    field, hole = one_gap(kind, p)
    for name in DERIVED:
        values = np.asarray(field.derive(name)).reshape(3, *p.shape[:2])
        exact = plane_flow(p)[1][name]
        np.testing.assert_array_equal(np.isnan(values), hole)
        error = np.abs(values - [exact * f ** (1 + (name == "okubo_weiss")) for f in (1, 2, 3)])
        assert np.nanmax(error[1]) < 3 * max(np.nanmax(error[2]), 0.02)
    with pytest.warns(Notice, match="longest valid horizon is 2 at time 0"):
        rate = np.asarray(field.derive("ftle", horizon=1.0)).reshape(3, *p.shape[:2])
    assert np.isnan(rate[:2][:, hole[1]]).all()


def one_gap(kind: str, p: Floats) -> tuple[FlowField, NDArray[np.bool_]]:
    """Return three steps of a flow that grows, of which the second one has a hole, and the hole."""
    flow = plane_flow(p)[0] * np.array([1, 2, 3])[:, None, None, None]
    hole = np.zeros(flow.shape[:3], bool)
    hole[1, 6:9, 10:20] = True
    flow[hole] = np.nan
    if kind == "grid":
        return FlowField.from_arrays(p, flow), hole
    corners = Delaunay(p.reshape(-1, 2)).simplices
    return FlowField.from_triangles(p.reshape(-1, 2), corners, flow.reshape(3, -1, 2)), hole


def test_two_lines_of_triangles_have_a_linear_fit() -> None:
    x, y = np.meshgrid(np.linspace(0, 2, 41), [0, 0.05])
    p = np.stack([x, y], axis=-1).reshape(-1, 2)
    flow = p @ [[0.5, 2.0], [-3.0, 0.25]]  # columns are u and v
    field = FlowField.from_triangles(p, Delaunay(p).simplices, flow)
    assert field.derive("vorticity") == pytest.approx(5.0)
    assert field.derive("divergence") == pytest.approx(0.75)


def test_a_picture_is_coloured_by_what_is_derived() -> None:
    field, _ = crooked(12)
    named = field.with_derived("vorticity")
    assert flowtex.render(field, scalars="vorticity", size=(60, 40)) == pytest.approx(
        flowtex.render(named, scalars="vorticity", size=(60, 40))
    )
    assert (named.unit_of("vorticity"), named.label_of("okubo_weiss")) == ("", "okubo_weiss")
    timed = FlowField.from_arrays(field.points, field.velocity, time_unit="s")
    for name, unit in {"vorticity": "1/s", "okubo_weiss": "1/s²"}.items():
        assert timed.with_derived(name).unit_of(name) == unit


@pytest.mark.parametrize("projection", ["equalearth", "+proj=eck4"])
@pytest.mark.parametrize("is_mesh", [False, True])
def test_vorticity_is_right_up_to_poles_that_are_lines(projection: str, is_mesh: bool) -> None:
    flow = winds(np.arange(-180.0, 180.0, 6.0), np.arange(80.0, 89.6, 0.5))
    if is_mesh:
        flow = ugrid(globe(800), at="node")[0]
    field = FlowField.from_xarray(flow, projection=projection).with_derived("vorticity")
    assert field.projection is not None
    lon, lat = field.projection.lonlat(field.surface.points)
    exact = 2 * RATE / EARTH_RADIUS * (on_sphere(lon, lat) @ AXIS)
    found = np.asarray(field.scalars["vorticity"])[0]
    near = field.valid & (np.abs(lat) > 88)
    assert near.sum() > 50
    np.testing.assert_allclose(found[near], exact[near], rtol=0, atol=0.05 * np.abs(exact).max())
