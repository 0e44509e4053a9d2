"""Paths on surfaces of triangles: exact flows, the structured tracer, and meshes of all kinds."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull, Delaunay, cKDTree
from strategies import property_test

from flowtex import FlowField, TraceSlices, trace
from flowtex._util.array_types import Floats, Indices
from flowtex.errors import FieldError
from flowtex.trace.slices import choose_lags, small_cell
from flowtex.trace.store import SliceStore
from flowtex.trace.trace import paths


def square(count: int, seed: int = 0) -> tuple[Floats, Indices]:
    """Random nodes in a square from -1 to 1, in triangles that face either way."""
    rng = np.random.default_rng(seed)
    side = np.linspace(-1, 1, max(int(np.sqrt(count)), 2))
    edge = np.concatenate([[(s, e), (e, s)] for s in side for e in (-1, 1)])
    points = np.unique(np.concatenate([edge, rng.uniform(-1, 1, (count, 2))]), axis=0)
    return points, either_way(Delaunay(points).simplices, rng)


def either_way(triangles: Any, rng: np.random.Generator) -> Indices:
    """Turn half of the triangles over."""
    turned_over = rng.random(len(triangles))[:, None] < 0.5
    return np.asarray(np.where(turned_over, triangles, triangles[:, ::-1]), np.intp)


def sphere(count: int, seed: int = 0) -> tuple[Floats, Indices]:
    """Nodes of a spiral over the unit sphere, which lie evenly, and their triangles."""
    k = np.arange(count) + 0.5
    z, turn = 1 - 2 * k / count, np.pi * (1 + np.sqrt(5)) * k
    r = np.sqrt(1 - z * z)
    points = np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=-1)
    triangles = ConvexHull(points).simplices.astype(np.intp)
    return points, either_way(triangles, np.random.default_rng(seed))


def turned(points: Floats, angle: Any) -> Floats:
    """Turn points about the z axis."""
    c, s = np.cos(angle), np.sin(angle)
    result = points.copy()
    result[..., 0] = c * points[..., 0] - s * points[..., 1]
    result[..., 1] = s * points[..., 0] + c * points[..., 1]
    return result


def spin(points: Floats) -> Floats:
    """Velocity of one turn about the z axis in 2 pi."""
    result = np.zeros_like(points)
    result[..., 0], result[..., 1] = -points[..., 1], points[..., 0]
    return result


def found(field: FlowField, slices: TraceSlices, m: int = -1, *, forward: bool = False) -> Floats:
    """Positions in space at one lag."""
    data = slices.forward if forward else slices.displacement
    assert data is not None
    return np.asarray(field.points[0] + data[0, m, 0])


@pytest.mark.parametrize("parameter", ["time", "arclength"])
def test_a_rotation_of_a_sphere_is_followed_to_second_order(parameter: str) -> None:
    errors = []
    lags = np.linspace(0.3, 1.5, 9)
    for count in (500, 2000):
        points, triangles = sphere(count)
        field = FlowField.from_triangles(points, triangles, spin(points))
        slices = trace(field, lags=lags, unit=1.0, parameter=parameter, tolerance=1e-5)
        p = field.points[0]
        away = np.linalg.norm(p[:, :2], axis=1)
        some = away > 0.3
        angle = lags[:, None] / (away if parameter == "arclength" else 1.0)
        assert np.isinf(slices.reach[0, 0, some]).all()
        off = np.stack([found(field, slices, m) - turned(p, -angle[m]) for m in range(9)])[:, some]
        errors.append(float(np.sqrt(np.mean(off**2))))
    assert errors[1] < 1e-3
    # Four times as many nodes are half as far apart.
    assert 1.75 < np.log2(errors[0] / errors[1]) < 2.5


def test_a_uniform_flow_is_exact_however_the_nodes_lie() -> None:
    rng = np.random.default_rng(3)
    points = np.concatenate(
        [rng.uniform(-1, 1, (400, 2)), 1e-3 * rng.uniform(-1, 1, (400, 2)), [[-1, -1], [1, 1]]]
    )
    points = np.concatenate([points, [[-1, 1], [1, -1]]])
    field = FlowField.from_triangles(
        points, either_way(Delaunay(points).simplices, rng), np.broadcast_to([0.6, 0.8], (804, 2))
    )
    lags = np.array([1e-4, 0.01, 0.5, 3.0])
    slices = trace(field, lags=lags, unit=1.0)
    for m, lag in enumerate(lags):
        moved = np.broadcast_to([-0.6 * lag, -0.8 * lag, 0.0], field.points[0].shape)
        np.testing.assert_allclose(slices.displacement[0, m, 0], moved, rtol=1e-6, atol=1e-9)
    x, y = field.points[0, :, 0], field.points[0, :, 1]
    inner = np.abs(field.points[0, :, :2]).max(axis=1) < 0.8
    # The square of random nodes has its own border, so only its corners are known.
    assert (slices.reach[0, 0] <= np.minimum((x + 1) / 0.6, (y + 1) / 0.8) + 1e-6).all()
    assert (slices.reach[0, 0, inner] > 0.1).all()
    assert slices.rate[0, 0] == pytest.approx(
        np.einsum("dnc,c->nd", field.surface.tangents[:, 0], [0.6, 0.8, 0.0])
    )


def test_paths_are_those_of_the_structured_tracer() -> None:
    i, j = np.meshgrid(np.linspace(-1, 1, 61), np.linspace(-1, 1, 51))
    points = np.stack([i, j, 0.2 * i * j], axis=-1)
    velocity = np.stack([1 + 0.3 * j, np.sin(2 * i), 0.2 * (j + i * np.sin(2 * i))], axis=-1)
    grid = FlowField.from_arrays(points, velocity)
    n = np.arange(i.size).reshape(i.shape)
    a, b, c, d = (part.ravel() for part in (n[:-1, :-1], n[:-1, 1:], n[1:, 1:], n[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
    field = FlowField.from_triangles(points.reshape(-1, 3), triangles, velocity.reshape(-1, 3))
    np.testing.assert_allclose(field.points[0], points.reshape(-1, 3))
    one = trace(grid, lags=[0.3, 0.6], unit=1.0, compose=False, tolerance=1e-5)
    two = trace(field, lags=[0.3, 0.6], unit=1.0)
    start = np.stack(np.meshgrid(np.arange(61), np.arange(51)), -1).reshape(-1, 2)
    for m in range(2):
        there = start + one.displacement[0, m].reshape(-1, 2)
        inside = np.isinf(one.reach.ravel()) & np.isinf(two.reach.ravel())
        at = grid.surface.at(there[inside])
        off = np.linalg.norm(at - found(field, two, m)[inside], axis=1)
        assert inside.sum() > 1500
        assert off.max() < 2e-3
        assert np.median(off) < 3e-4
    late = np.isfinite(one.reach.ravel()) & np.isfinite(two.reach.ravel())
    np.testing.assert_allclose(two.reach.ravel()[late], one.reach.ravel()[late], atol=0.01)


def box(per_side: int, rows: int) -> tuple[Floats, Indices, Floats]:
    """Four sides of a box one wide, around the z axis, and the place of each node along them."""
    count = 4 * per_side
    along = np.arange(count) / per_side
    corner = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]], dtype=float)
    side, share = np.divmod(along, 1)
    side = side.astype(int)
    around = corner[side] + share[:, None] * (corner[side + 1] - corner[side])
    z = np.linspace(0, 4, rows)
    points = np.concatenate([np.column_stack([around, np.full(count, h)]) for h in z])
    a = np.arange(count * (rows - 1))
    b = np.where(a % count == count - 1, a - count + 1, a + 1)
    rng = np.random.default_rng(1)
    cut = rng.random(len(a))[:, None] < 0.5
    one = np.where(cut, np.stack([a, b, b + count], -1), np.stack([a, b, a + count], -1))
    two = np.where(
        cut, np.stack([a, b + count, a + count], -1), np.stack([b, b + count, a + count], -1)
    )
    return points, either_way(np.concatenate([one, two]), rng), np.tile(along, rows)


def test_paths_go_on_across_the_edges_of_a_box() -> None:
    """Unrolled, a flow that climbs around a box is uniform, and its paths are straight."""
    nodes, triangles, places = box(6, 25)
    side = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]], dtype=float)
    outward = np.array([[0, -1], [1, 0], [0, 1], [-1, 0]], dtype=float)
    middle = nodes[triangles].mean(axis=1)[:, :2] - 0.5
    face = np.argmax(middle @ outward.T, axis=1)
    # Each triangle has its own nodes.
    velocity = np.column_stack([0.8 * side[face], np.full(len(face), 0.6)]).repeat(3, axis=0)
    own = np.arange(triangles.size).reshape(-1, 3)
    field = FlowField.from_triangles(nodes[triangles].reshape(-1, 3), own, velocity)
    points = field.points[0]
    assert len(points) == len(nodes) + 4 * 25
    along = places[cKDTree(nodes).query(points)[1]]
    lags = np.array([0.3, 1.0, 2.5])
    slices = trace(field, lags=lags, unit=1.0)
    for m, lag in enumerate(lags):
        where = (along - 0.8 * lag) % 4
        number = np.floor(where).astype(int)
        corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
        exact = corners[number] + (where - number)[:, None] * side[number]
        z = points[:, 2] - 0.6 * lag
        known = z > 0
        off = found(field, slices, m)[known] - np.column_stack([exact, z])[known]
        assert np.abs(off).max() < 1e-5
    np.testing.assert_allclose(
        np.minimum(slices.reach[0, 0], 2.5), np.minimum(points[:, 2] / 0.6, 2.5), atol=1e-5
    )


@pytest.mark.parametrize("parameter", ["arclength", "time"])
def test_paths_come_to_rest_in_a_sink(parameter: str) -> None:
    points, triangles = square(2000)
    for swirl in (0.0, 1.0):
        field = FlowField.from_triangles(points, triangles, -points + swirl * spin(points))
        slices = trace(field, lags=[0.1, 50.0], unit=1.0, parameter=parameter)
        assert slices.forward is not None and slices.forward_reach is not None
        inside = np.linalg.norm(field.points[0], axis=1) < 0.95
        assert np.abs(found(field, slices, forward=True))[inside].max() < 0.01
        length = np.linalg.norm(field.points[0], axis=1) * np.hypot(1, swirl)
        if parameter == "arclength":
            reach = slices.forward_reach[0, 0, inside]
            np.testing.assert_allclose(reach, length[inside], atol=0.01)


def test_a_saddle_parts_and_a_centre_holds() -> None:
    points, triangles = square(400)
    saddle = FlowField.from_triangles(points, triangles, points * [1, -1])
    slices = trace(saddle, lags=[0.5, 1.0], parameter="time")
    p = saddle.points[0]
    back = np.abs(p[:, 1]) < np.exp(-1.0) * 0.99
    exact = p * [np.exp(-1), np.exp(1), 1]
    assert np.abs(found(saddle, slices) - exact)[back].max() < 0.01
    centre = FlowField.from_triangles(points, triangles, spin(points))
    slices = trace(centre, lags=[1.0, 20.0], unit=1.0, tolerance=1e-5)
    r = np.linalg.norm(centre.points[0], axis=1)
    inside = (r < 0.95) & (r > 0.3)
    last = np.linalg.norm(found(centre, slices), axis=1)
    assert np.isinf(slices.reach[0, 0, inside]).all()
    assert np.abs(last / r - 1)[inside].max() < 0.05
    nodes_at_rest = FlowField.from_triangles(
        points, triangles, np.where(points[:, :1] < 0, 0.0, [[1.0, 0.0]])
    )
    slices = trace(nodes_at_rest, lags=[1.0])
    still = nodes_at_rest.points[0, :, 0] < 0
    for data in (slices.rate[0], slices.displacement[0, 0], slices.reach[0, ..., None]):
        assert not data[0, still].any()


def test_pathlines_of_a_rotation_that_changes() -> None:
    """The rate goes 0, 1, 3 at the times 0, 1, 2: linear between, and constant before and after."""
    points, triangles = square(500)
    velocity = np.stack([rate * spin(points) for rate in (0.0, 1.0, 3.0)])
    field = FlowField.from_triangles(points, triangles, velocity, times=[0.0, 1.0, 2.0])
    lags = [0.25, 1.0, 1.5, 2.5]
    slices = trace(field, lags=lags, tolerance=1e-5)
    p = field.points[0]
    inside = np.linalg.norm(p, axis=1) < 0.95

    def angle(time: float) -> float:
        moments = np.linspace(-3, 5, 80001)
        rate = np.interp(moments, field.times, [0.0, 1.0, 3.0])
        return float(np.interp(time, moments, np.cumsum(rate) * 1e-4))

    assert slices.forward is not None
    for step, destination in enumerate(field.times):
        for m, lag in enumerate(lags):
            for side, data in ((-1, slices.displacement), (1, slices.forward)):
                exact = turned(p, angle(destination + side * lag) - angle(destination))
                off = (p + data[step, m, 0] - exact)[inside]
                assert np.abs(off).max() < 0.01
    one = SliceStore(field).at(1)
    assert one.parameter == "time"
    assert one.displacement.shape[:1] + one.displacement.shape[2:] == (1, 1, len(p), 3)
    moment = SliceStore(field, lines="streamlines").at(1)
    assert moment.parameter == "arclength"
    assert np.isinf(moment.reach[0, 0, np.linalg.norm(p, axis=1) < 0.4]).mean() > 0.99


def test_only_chosen_nodes_are_followed_and_positions_are_held() -> None:
    points, triangles = square(300)
    field = FlowField.from_triangles(points, triangles, np.broadcast_to([1.0, 0.0], points.shape))
    chosen = np.zeros(field.shape, bool)
    chosen[0, ::7] = True
    whole = trace(field, lags=[0.2, 3.0], unit=1.0)
    some = trace(field, lags=[0.2, 3.0], unit=1.0, nodes=chosen)
    np.testing.assert_array_equal(some.displacement[:, :, chosen], whole.displacement[:, :, chosen])
    assert not some.displacement[:, :, ~chosen].any()
    assert not some.reach[:, ~chosen].any()
    held = whole.positions(3.0)[0, :, 0]
    np.testing.assert_allclose(held, -1, atol=1e-5)
    np.testing.assert_allclose(
        whole.positions(0.1)[0, :, 0], points[:, 0] - np.minimum(0.1, points[:, 0] + 1), atol=1e-5
    )


def test_paths_from_anywhere_are_told_on_the_surface() -> None:
    points, triangles = square(500)
    field = FlowField.from_triangles(points, triangles, np.broadcast_to([1.0, 0.0], points.shape))
    start = np.stack([np.full(len(triangles), 0.3), np.arange(len(triangles)) + 0.2], axis=-1)
    ways = paths(field, start, [0.1, 0.4, 5.0], forward=True)
    here = field.surface.at(start)
    np.testing.assert_allclose(ways.reach, np.where(1 - here[:, 0] < 5, 1 - here[:, 0], np.inf))
    for m, lag in enumerate((0.1, 0.4, 5.0)):
        exact = here + [[1.0, 0.0, 0.0]] * np.minimum(lag, 1 - here[:, :1])
        np.testing.assert_allclose(field.surface.at(ways.positions[m]), exact, atol=1e-6)


def check(slices: TraceSlices) -> None:
    """What holds of all slices by arc length, however bad the mesh is."""
    for data in (slices.rate, slices.displacement, slices.forward):
        assert data is not None
        assert np.isfinite(data).all()
    assert (slices.reach >= 0).all()
    if slices.parameter == "arclength":
        length = np.linalg.norm(slices.displacement[0], axis=-1)
        assert (length <= slices.lags[:, None, None] * slices.unit * (1 + 1e-3)).all()


def doubled(field: FlowField, count: int) -> Floats:
    """Lags that double from a quarter of a small cell, in units of length."""
    return np.asarray(0.25 * small_cell(field) * 2.0 ** np.arange(count))


@pytest.mark.parametrize("parameter", ["time", "arclength"])
def test_composed_paths_are_those_that_are_integrated(parameter: str) -> None:
    """On a plane with borders, a hole, a centre, a saddle and nodes at rest."""
    points, triangles = square(6000)
    x, y = points.T
    velocity = np.stack([np.sin(3 * y) + 0.2, np.sin(2 * x + y)], axis=-1)
    if parameter == "arclength":
        # By time a path into rest gets slower and slower, and where it ends is due to rounding.
        velocity[x < -0.8] = 0.0
    valid = np.hypot(x - 0.5, y + 0.4) > 0.15
    field = FlowField.from_triangles(points, triangles, velocity, valid=valid)
    options: dict[str, Any] = {"lags": doubled(field, 9), "unit": 1.0, "parameter": parameter}
    one, two = (trace(field, compose=compose, **options) for compose in (True, False))
    cell, lags = field.surface.cell_size[0], one.lags
    assert one.forward is not None and two.forward is not None
    assert one.forward_reach is not None and two.forward_reach is not None
    for a, b, p, q in (
        (one.displacement, two.displacement, one.reach, two.reach),
        (one.forward, two.forward, one.forward_reach, two.forward_reach),
    ):
        apart = np.linalg.norm(a - b, axis=-1)[0, :, 0] / cell
        going = (p[0, 0] > lags[:, None]) & (q[0, 0] > lags[:, None])
        # The first are integrated in both ways.
        assert not apart[:4].any() and apart[-1].any()
        assert np.median(apart[-1][going[-1]]) < 0.1
        assert np.quantile(apart[-1][going[-1]], 0.95) < 0.3
        same = np.abs(np.minimum(p, lags[-1]) - np.minimum(q, lags[-1]))[0, 0] < cell
        assert 0.2 < (q < lags[-1]).mean() < 0.9
        assert same.mean() > 0.95


def graded_ring(growth: float, layers: int, width: float) -> tuple[Floats, Indices]:
    """Rings of nodes around a hole, of which each is wider than the one before, as an ellipse."""
    radius = 0.5 + np.concatenate([[0.0], np.cumsum(1e-3 * growth ** np.arange(layers))])
    angle = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    points = np.stack([np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle))], axis=-1)
    node = np.arange(80 * len(radius)).reshape(len(radius), 80)
    beside = np.roll(node, -1, axis=1)
    first = np.stack([node[:-1], beside[:-1], beside[1:]], axis=-1)
    second = np.stack([node[:-1], beside[1:], node[1:]], axis=-1)
    triangles = np.concatenate([first.reshape(-1, 3), second.reshape(-1, 3)])
    return points.reshape(-1, 2) * [1, width], triangles


def scattered_ring(count: int) -> tuple[Floats, Indices]:
    """Random nodes, ever farther apart from the middle on."""
    rng = np.random.default_rng(0)
    angle = rng.uniform(0, 2 * np.pi, count)
    radius = 0.5 * np.exp(rng.uniform(0, 3, count))
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
    return points, Delaunay(points).simplices.astype(np.intp)


@pytest.mark.parametrize(
    ("points", "triangles"),
    [graded_ring(1.1, 70, 1.0), graded_ring(1.1, 70, 0.2), scattered_ring(3000)],
    ids=["circle", "ellipse", "scattered"],
)
def test_composed_paths_of_a_uniform_flow_are_straight_between_cells_of_all_sizes(
    points: Floats, triangles: Indices
) -> None:
    field = FlowField.from_triangles(points, triangles, np.broadcast_to([0.6, 0.8], points.shape))
    slices = SliceStore(field).at(0)
    assert slices.forward is not None and slices.forward_reach is not None
    unit = slices.unit[0, 0]
    for moved, reach, side in (
        (slices.displacement, slices.reach, -1),
        (slices.forward, slices.forward_reach, 1),
    ):
        assert (reach < slices.lags[-1]).any()
        for m, lag in enumerate(slices.lags):
            going = reach[0, 0] > lag
            straight = side * lag * unit * np.array([0.6, 0.8, 0.0])
            error = np.linalg.norm(moved[0, m, 0][going] - straight, axis=-1)
            assert error.max(initial=0.0) < 0.01 * lag * unit


@property_test(25)
@given(
    st.integers(3, 30),
    st.integers(1, 60),
    st.integers(0, 2**32 - 1),
    st.sampled_from([0, 3, 20]),
    st.sampled_from([None, 1, 3]),
    st.booleans(),
    st.sampled_from([1e-6, 1.0, 1e6]),
)
def test_any_triangles(
    count: int, faces: int, seed: int, spread: int, steps: int | None, flat: bool, size: float
) -> None:
    rng = np.random.default_rng(seed)
    points = size * rng.normal(size=(count, 3)) * [1, 1, 0.0 if flat else 1.0]
    shape = (count, 3) if steps is None else (steps, count, 3)
    velocity = rng.normal(size=shape) * 10.0 ** rng.uniform(-spread, spread, (*shape[:-1], 1))
    velocity[rng.random(shape[:-1]) < 0.1] = 0.0
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            triangles = rng.integers(0, count, (faces, 3))
            field = FlowField.from_triangles(points, triangles, velocity)
    except FieldError:
        return
    # Along pathlines there is no other lag than time.
    for parameter in ("arclength", "time") if field.steady else ("time",):
        store = SliceStore(field, parameter=parameter)
        for step in range(store.steps):
            check(store.at(step))


@pytest.mark.parametrize("height", [0.701, 0.70001, 0.7000001])
def test_slices_close_to_a_layer_of_nodes_have_lags_of_cells(height: float) -> None:
    # A third of the triangles are slivers around the nodes of the layer at 0.7.
    grid = pv.ImageData(dimensions=(31, 21, 13), spacing=(0.1,) * 3, origin=(-1.5, -1, 0))
    x, y, _ = grid.points.T
    grid["U"] = np.stack([np.sin(2 * x) * np.cos(3 * y), np.cos(3 * x) * np.sin(2 * y), 0 * x], -1)
    tetrahedra = grid.triangulate()
    fields = [FlowField.from_pyvista(tetrahedra, slice=f"z={z}") for z in (0.75, height)]
    far, close = (choose_lags(field, "time")[0] for field in fields)
    assert close > 0.2 * far
