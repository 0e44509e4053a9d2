from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay

import flowtex
from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.field.earth.projection import EARTH_RADIUS, Projection

#: Gradients of linear flows by their kinds.
LINEAR = {
    "saddle": ((1.0, 0.3), (0.2, -1.0)),
    "source": ((1.0, 0.3), (0.2, 0.5)),
    "sink": ((-1.0, 0.3), (0.2, -0.5)),
    "centre": ((0.0, 2.0), (-1.0, 0.0)),
    "spiral source": ((0.2, 2.0), (-1.0, 0.2)),
    "spiral sink": ((-0.2, 2.0), (-1.0, -0.2)),
}


def points_of(nodes: int) -> Floats:
    x, y = np.meshgrid(np.linspace(-1, 1, nodes), np.linspace(-1.2, 1, nodes))
    return np.stack([x + 0.1 * np.sin(2 * y), y + 0.1 * np.sin(2 * x)], axis=-1)


def on_mesh(kind: str, points: Floats, velocity: Floats) -> FlowField:
    if kind == "grid":
        return FlowField.from_arrays(points, velocity)
    flat = points.reshape(-1, 2)
    return FlowField.from_triangles(flat, Delaunay(flat).simplices, velocity.reshape(-1, 2))


@pytest.mark.parametrize("mesh", ["grid", "triangles"])
@pytest.mark.parametrize("kind", LINEAR)
@pytest.mark.parametrize("place", [(0.137, -0.211), (0.0, 0.0)])
def test_a_critical_point_is_found_once_with_its_kind(
    kind: str, place: tuple[float, float], mesh: str
) -> None:
    matrix = np.array(LINEAR[kind])
    p = points_of(21) if any(place) else np.stack(
        np.meshgrid(np.linspace(-1, 1, 21), np.linspace(-1, 1, 21)), axis=-1
    )  # fmt: skip
    field = on_mesh(mesh, p, (p - place) @ matrix.T)
    (point,) = flowtex.critical_points(field)
    assert point.kind == kind
    assert point.position[:2] == pytest.approx(place, abs=2e-3)
    assert sorted(point.eigenvalues.real) == pytest.approx(
        sorted(np.linalg.eigvals(matrix).real), abs=0.05
    )
    for value, vector in zip(point.eigenvalues, point.eigenvectors, strict=True):
        assert np.abs(matrix @ vector[:2] - value * vector[:2]).max() < 0.08
    assert field.surface.at(np.array(point.index[::-1])) == pytest.approx(point.position, abs=1e-6)


@pytest.mark.parametrize("mesh", ["grid", "triangles"])
def test_a_centre_on_a_mesh_has_no_growth_but_by_interpolation(mesh: str) -> None:
    line = np.linspace(-1, 1, 41)
    p = np.stack(np.meshgrid(line + 0.013, line + 0.021), axis=-1)
    x, y = np.moveaxis(p, -1, 0)

    def kind(growth: float, bend: float) -> str:
        flow = [growth * x - y * (1 + bend * x), x + growth * y + bend * x * x]
        (point,) = flowtex.critical_points(on_mesh(mesh, p, np.stack(flow, axis=-1)))
        return point.kind

    assert kind(0.01, 0) == "spiral source" and kind(-1e-4, 0) == "spiral sink"
    assert kind(0, 0) == "centre" and kind(0, 0.3) == "centre"
    assert kind(0.2, 0.3) == "spiral source"


@pytest.mark.parametrize(
    ("u", "v", "index"),
    [
        ("x*x - y*y", "2*x*y", 2),
        ("x*x - y*y", "-2*x*y", -2),
        ("x**3 - 3*x*y*y", "3*x*x*y - y**3", 3),
        ("x*x", "-y", 0),
        ("-x**3", "-y", 1),
    ],
)
@pytest.mark.parametrize("place", [(0.0, 0.0), (0.0131, 0.0217)])
def test_a_degenerate_point_on_a_grid_has_its_index(
    u: str, v: str, index: int, place: tuple[float, float]
) -> None:
    line = np.linspace(-1, 1, 41)
    x, y = np.meshgrid(line - place[0], line - place[1])
    velocity = np.stack([eval(rate, {"x": x, "y": y}) for rate in (u, v)], axis=-1)
    points = flowtex.critical_points(FlowField.from_arrays((line, line), velocity))
    assert sum(point.poincare_index for point in points) == index
    if abs(index) > 1 or not any(place):
        assert [point.kind for point in points] in (["degenerate"], ["sink"])
        assert points[0].kind == "degenerate" or index == 1


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("mesh", ["grid", "triangles"])
def test_indices_on_a_sphere_sum_to_two(mesh: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    globe, matrix, shift = Projection("globe"), rng.normal(size=(3, 3)), rng.normal(size=3) / 2
    if mesh == "grid":
        p = globe.positions(*np.meshgrid(np.linspace(-180, 180, 73), np.linspace(-90, 90, 37)))
    else:
        p = rng.normal(size=(1500, 3))
        p *= EARTH_RADIUS / np.linalg.norm(p, axis=1, keepdims=True)
    n = p / EARTH_RADIUS
    velocity = n @ matrix.T + shift
    velocity -= np.sum(velocity * n, axis=-1, keepdims=True) * n
    if mesh == "grid":
        field = FlowField.from_arrays(p, velocity, projection=globe)
    else:
        hull = ConvexHull(p).simplices
        field = FlowField.from_triangles(p, hull, velocity, projection=globe)
    points = flowtex.critical_points(field)
    assert sum(point.poincare_index for point in points) == 2
    for point in points:
        away = point.position / np.linalg.norm(point.position)
        left = matrix @ away + shift
        assert np.linalg.norm(left - (left @ away) * away) < 0.1
        assert point.lonlat == pytest.approx([float(x) for x in globe.lonlat(point.position)])
    assert [row["lon"] for row in points.records()] == [p.lonlat and p.lonlat[0] for p in points]


def test_the_double_gyre_has_saddles_on_its_border_and_lines_between_them() -> None:
    field = flowtex.examples.double_gyre_field(shape=(41, 81))
    points = flowtex.critical_points(field)
    assert repr(points) == "CriticalPoints(6 x saddle, 2 x centre)"
    places = {tuple(np.round(p.position[:2], 3)) for p in points.of_kind("saddle")}
    assert places == {(x, y) for x in (0.0, 1.0, 2.0) for y in (0.0, 1.0)}
    assert points.to_pyvista().n_points == len(points.records()) == 8
    lines = flowtex.separatrices(field)
    middle = [line for line in lines if np.abs(line.points[:, 0] - 1).max() < 0.01]
    assert len(middle) == 2  # from below, as it leaves one saddle and comes to the other
    assert {line.forward for line in middle} == {True, False}
    for line in middle:
        assert np.ptp(line.points[:, 1]) == pytest.approx(1.0, abs=1e-6)
    mesh = lines.to_pyvista()
    assert mesh.n_cells == len(lines) == len(lines.records())
    assert mesh.n_points == sum(len(line.points) for line in lines)


def test_a_line_ends_where_it_joins_a_closed_orbit() -> None:
    x, y = np.meshgrid(np.linspace(-2.2, 2.2, 161), np.linspace(-1.6, 1.6, 121))
    velocity = np.stack([y, x - x**3 + y * (0.85 - x**2)], axis=-1)
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), velocity)
    closed = [line for line in flowtex.separatrices(field) if line.closed]
    assert len(closed) == 2
    for line in closed:
        # The flow comes from an orbit around a sink to either side.
        assert not line.forward
        assert np.linalg.norm(line.points[:-8] - line.points[-1], axis=1).min() < 0.02


def test_walls_rest_and_gaps_have_no_critical_points() -> None:
    p = points_of(21)
    channel = np.stack([1 - p[..., 1] ** 2 + 0.5, 0 * p[..., 0]], axis=-1)
    channel[[0, -1]] = 0.0
    assert len(flowtex.critical_points(FlowField.from_arrays(p, channel))) == 0
    flow = p @ np.array(LINEAR["saddle"]).T
    valid = np.hypot(*np.moveaxis(p, -1, 0)) > 0.3
    assert len(flowtex.critical_points(FlowField.from_arrays(p, flow, valid=valid))) == 0
    still = np.where(valid[..., None], flow, 0.0)
    assert len(flowtex.critical_points(FlowField.from_arrays(p, still))) == 0


@pytest.mark.parametrize("seam", [0.2, 2.0, 6.0])
def test_a_line_that_crosses_the_seam_ends_in_a_focus(seam: float) -> None:
    # A damped pendulum on the cylinder of its states.
    angle, rate = np.meshgrid(np.linspace(0, 2 * np.pi, 65) + seam, np.linspace(-3, 3.1, 41))
    points = np.stack([np.cos(angle), np.sin(angle), rate], axis=-1)
    around = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=-1)
    velocity = rate[..., None] * around
    velocity[..., 2] -= np.sin(angle) + 0.3 * rate
    lines = flowtex.separatrices(FlowField.from_arrays(points, velocity))
    assert not any(line.closed for line in lines)
    ahead = [line.points[-1] for line in lines if line.forward]
    assert len(ahead) == 2
    assert np.array(ahead) == pytest.approx(np.array([[1.0, 0, 0]] * 2), abs=0.01)
