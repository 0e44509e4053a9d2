"""Trace slices as textures, and the step texture of images."""

from __future__ import annotations

import numpy as np
import pytest

from flowtex import FlowField
from flowtex._util.array_types import Floats32
from flowtex.examples import airfoil_field, cylinder_field, double_gyre_field
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.textures.geometry import NodeDisplacements
from flowtex.textures.images import ImageTextures
from flowtex.textures.texture_set import TextureSet
from flowtex.trace.slices import TraceSlices
from flowtex.trace.store import SliceStore
from flowtex.trace.trace import trace


def textures(
    field: FlowField, slices: TraceSlices | None = None, parameter: str = "arclength"
) -> TextureSet:
    return TextureSet.build(SliceStore(field, parameter=parameter, slices=slices))


def nodal(made: TextureSet, layer: Floats32) -> Floats32:
    """Texels that lie on the nodes, (J, I, ...)."""
    rows, columns = made.grid.rows, made.grid.columns
    return layer[
        rows.before : rows.before + rows.nodes, columns.before : columns.before + columns.nodes
    ]


def stretched(count: int = 41, power: float = 2.5) -> FlowField:
    x = np.sinh(np.linspace(0, power, count))
    points = np.stack(np.meshgrid(x, np.linspace(0, 1, count)), axis=-1)
    return FlowField.from_arrays(points, np.broadcast_to([1.0, 0.1], points.shape), periodic="")


# --- layers ---------------------------------------------------------------------------------


@pytest.mark.parametrize("parameter", ["arclength", "time"])
@pytest.mark.parametrize(
    "make", [lambda: double_gyre_field(shape=(21, 41)), lambda: airfoil_field((33, 97))]
)
def test_slopes_tend_to_the_tangent(make: object, parameter: str) -> None:
    field: FlowField = make()  # type: ignore[operator]
    slices = trace(field, lags=[1e-3, 0.5], parameter=parameter)
    made = textures(field, slices)
    layers = made.layers(dtype=np.float32)
    tangent = nodal(made, layers[0])[..., :3]
    size = np.linalg.norm(tangent, axis=-1)
    inside = (slices.reach[0] > 1e-3) & (size > 0.1 * np.median(size))
    for layer in (1, 3):
        slope = nodal(made, layers[layer])[..., :3]
        away = np.linalg.norm(slope - tangent, axis=-1) / np.maximum(size, 1e-9)
        assert np.median(away[inside]) < 5e-3
        assert np.quantile(away[inside], 0.99) < 0.03


def test_arc_length_slopes_are_of_unit_length() -> None:
    made = textures(double_gyre_field(shape=(41, 81)))
    size = np.linalg.norm(nodal(made, made.layers(dtype=np.float32)[0])[..., :3], axis=-1)
    np.testing.assert_allclose(size[1:-1, 1:-1].max(), 1, atol=1e-5)
    assert np.median(size) == pytest.approx(1, abs=1e-5)


def test_slope_times_lag_is_the_way_in_space() -> None:
    field = airfoil_field((33, 97))
    made = textures(field)
    slices = made.store.at(0)
    layers = made.layers(dtype=np.float32)
    for m in (0, 3):
        expected = field.surface.at(slices.nodes + slices.displacement[0, m]) - field.points
        lag = slices.lags[m] * slices.unit[..., None]
        found = -nodal(made, layers[1 + m])[..., :3] * lag
        expected = expected @ made.geometry.frame.T
        # The closing column repeats the first.
        np.testing.assert_allclose(found[:, :-1], expected[:, :-1], atol=2e-6)


def test_fourth_channel_holds_unit_reach_and_speed() -> None:
    field = stretched()
    made = textures(field)
    slices = made.store.at(0)
    layers = made.layers(dtype=np.float32)
    np.testing.assert_allclose(nodal(made, layers[0])[..., 3] * made.unit, slices.unit, rtol=1e-5)
    last = 2 * slices.lags[-1]
    count = len(slices.lags)
    assert layers.shape[0] == made.count == 2 + 2 * count
    np.testing.assert_allclose(nodal(made, layers[1])[..., 3], np.minimum(slices.reach[0], last))
    assert slices.forward_reach is not None
    np.testing.assert_allclose(
        nodal(made, layers[count + 1])[..., 3], np.minimum(slices.forward_reach[0], last)
    )
    np.testing.assert_allclose(
        nodal(made, layers[2])[..., 3] * made.typical_speed, field.speed[0], rtol=1e-5
    )
    assert not layers[3 : count + 1, ..., 3].any()
    assert np.isfinite(layers).all()


def test_the_last_layer_is_the_velocity_in_cells() -> None:
    field = stretched()
    made = textures(field)
    layers = made.layers(dtype=np.float32)
    rate, first = nodal(made, layers[-1]), nodal(made, layers[0])
    in_cells = rate[..., :2] * rate[..., 3:] / first[..., 3:] / made.cell
    flow = field.index_velocity.components[0] / made.typical_speed
    np.testing.assert_allclose(in_cells, flow, rtol=1e-5, atol=1e-6)


def test_by_time_slopes_are_speeds_over_a_typical_speed() -> None:
    field = double_gyre_field(shape=(21, 41))
    made = textures(field, parameter="time")
    tangent = nodal(made, made.layers(dtype=np.float32)[0])[..., :3]
    np.testing.assert_allclose(
        np.linalg.norm(tangent, axis=-1) * made.pace, field.speed[0], atol=1e-6
    )
    assert np.sqrt(np.mean(np.sum(tangent**2, axis=-1))) == pytest.approx(1, rel=1e-4)


def test_periodic_axis_goes_on_by_its_own_period() -> None:
    made = textures(cylinder_field().at_step(0))
    columns, rows = made.grid.columns, made.grid.rows
    assert columns.periodic and not rows.periodic
    period = columns.nodes - 1
    layers = made.layers(dtype=np.float32)
    np.testing.assert_array_equal(layers[:, :, :-period], layers[:, :, period:])
    # Beyond the border of an open axis the last line is repeated.
    beyond = layers[:, rows.nodes :]
    assert beyond.shape[1] > 0
    last = layers[:, rows.nodes - 1 : rows.nodes]
    np.testing.assert_array_equal(beyond, np.repeat(last, beyond.shape[1], axis=1))


def test_paths_go_on_across_the_seam() -> None:
    """A rotation on a ring is the same everywhere but for the turn, at the seam as elsewhere."""
    angle = np.linspace(0, 2 * np.pi, 65)
    r, a = np.meshgrid(np.linspace(1, 2, 17), angle, indexing="ij")
    points = np.stack([r * np.cos(a), r * np.sin(a)], axis=-1)
    points[:, -1] = points[:, 0]
    field = FlowField.from_arrays(points, points[..., ::-1] * [-1, 1])
    assert field.periodic == (False, True)
    made = textures(field)
    layers = made.layers(dtype=np.float32)
    for layer in (0, 2, made.count // 2, made.count - 1):
        size = np.linalg.norm(nodal(made, layers[layer])[..., :2], axis=-1)
        np.testing.assert_allclose(size, np.broadcast_to(size[:, 30:31], size.shape), atol=2e-3)


def test_flat_surfaces_lie_in_their_own_plane(rng: np.random.Generator) -> None:
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    flat = double_gyre_field(shape=(21, 41))
    field = FlowField.from_arrays(flat.points @ turn.T, flat.velocity[0] @ turn.T, periodic="")
    made = textures(field)
    assert made.geometry.planar
    assert np.abs(made.geometry.position[..., 2]).max() < 1e-6
    assert np.abs(made.layers(dtype=np.float32)[..., 2]).max() < 1e-5
    one = np.linalg.norm(nodal(made, made.layers(dtype=np.float32)[5])[..., :3], axis=-1)
    plain = textures(flat)
    two = np.linalg.norm(nodal(plain, plain.layers()[5])[..., :3], axis=-1)
    np.testing.assert_allclose(one, two, atol=1e-3)


def test_blanked_nodes_take_what_is_beside_them() -> None:
    field = double_gyre_field(shape=(21, 41))
    valid = np.ones(field.shape, bool)
    valid[5:9, 10:14] = False
    masked = FlowField.from_arrays(field.points, field.velocity[0], valid=valid, periodic="")
    made = textures(masked)
    layers = made.layers(dtype=np.float32)
    assert np.isfinite(layers).all()
    for layer in layers[:4]:
        values = nodal(made, layer)
        np.testing.assert_array_equal(values[6, 10], values[6, 9])
        np.testing.assert_array_equal(values[5, 12], values[4, 12])


def test_layers_for_an_image_hold_ways_across_it() -> None:
    made = TextureSet.build(SliceStore(airfoil_field((17, 49))), np.ones((1, 1, 4), np.float32))
    assert made.image is not None
    slices = made.store.at(0)
    layers = made.layers(dtype=np.float32)
    inner = (slice(None), slice(0, -1))  # The closing column repeats the first.
    expected = slices.rate[0] * made.image.by_cell()
    np.testing.assert_allclose(nodal(made, layers[0])[inner][..., :2], expected[inner], rtol=1e-5)
    there = made.image.at(slices.nodes + slices.displacement[0, 2])
    expected = (made.image.coordinate - there) / slices.lags[2]
    np.testing.assert_allclose(nodal(made, layers[3])[inner][..., :2], expected[inner], atol=1e-6)
    assert not layers[..., 2].any()


def test_moves_are_those_of_the_surface(rng: np.random.Generator) -> None:
    for field in (double_gyre_field(shape=(11, 21)), stretched(15), airfoil_field((17, 49))):
        rows, columns = field.shape
        displacement = rng.standard_normal((rows, columns, 2)) * [columns / 2, rows / 2]
        i, j = np.meshgrid(np.arange(columns), np.arange(rows))
        start = np.stack([i, j], axis=-1)
        expected = field.surface.at(start + displacement) - field.points
        assert isinstance(field.surface, GridSurface)
        found = NodeDisplacements(field.surface, np.eye(3))(displacement)
        np.testing.assert_allclose(
            np.moveaxis(found, 0, -1), expected, rtol=0, atol=1e-6 * field.surface.extent
        )


@pytest.mark.parametrize("parameter", ["arclength", "time"])
def test_a_step_moves_one_texel(parameter: str) -> None:
    """Equation 3."""
    field = stretched()
    store = SliceStore(field, parameter=parameter)
    made = ImageTextures.build(store, np.ones((1, 1, 4), np.float32), 128)
    x = field.points[0, :, 0]
    np.testing.assert_allclose(made.coordinate[0, :, 0], x / x[-1], atol=5e-3)
    height, width = made.step.shape
    texels = np.abs(store.at(0).rate[0] * made.by_cell() * [width, height]).max(axis=-1)
    u, v = np.moveaxis(made.coordinate[2:-2, 2:-2] * [width, height], -1, 0).astype(int)
    moved = made.step[v, u] * texels[2:-2, 2:-2]
    assert np.median(moved) == pytest.approx(1, abs=0.03)
    np.testing.assert_allclose(moved, 1, atol=0.2)
