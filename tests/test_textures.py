"""Trace slices as textures, and the paper's own noise and step textures."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from flowtex import FlowField
from flowtex.examples import airfoil_field, cylinder_field, double_gyre_field
from flowtex.settings import Settings
from flowtex.textures import Geometry, PaperTextures, TextureSet
from flowtex.textures.moves import Moves
from flowtex.trace import SliceStore, TraceSlices, trace

Floats = NDArray[np.float64]


def textures(field: FlowField, slices: TraceSlices | None = None, **settings: object) -> TextureSet:
    options = Settings(**settings)  # type: ignore[arg-type]
    parameter = str(settings.get("parameter", "arclength"))
    return TextureSet.build(SliceStore(field, parameter=parameter, slices=slices), options)


def nodal(made: TextureSet, layer: NDArray[np.float32]) -> NDArray[np.float32]:
    """Texels that lie on the nodes, (J, I, ...)."""
    rows, columns = made.geometry.rows, made.geometry.columns
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
    layers = made.layers()
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
    size = np.linalg.norm(nodal(made, made.layers()[0])[..., :3], axis=-1)
    np.testing.assert_allclose(size[1:-1, 1:-1].max(), 1, atol=1e-5)
    assert np.median(size) == pytest.approx(1, abs=1e-5)


def test_slope_times_lag_is_the_way_in_space() -> None:
    field = airfoil_field((33, 97))
    made = textures(field)
    slices = made.store.at(0)
    layers = made.layers()
    for m in (0, 3):
        expected = field.surface.at(slices.nodes + slices.displacement[0, m]) - field.points
        lag = slices.lags[m] * slices.unit[..., None]
        found = -nodal(made, layers[1 + m])[..., :3] * lag
        np.testing.assert_allclose(found, expected @ made.geometry.frame.T, atol=2e-6)


def test_fourth_channel_holds_unit_and_reach() -> None:
    field = stretched()
    made = textures(field)
    slices = made.store.at(0)
    layers = made.layers()
    np.testing.assert_allclose(nodal(made, layers[0])[..., 3] * made.unit, slices.unit, rtol=1e-5)
    last = 2 * slices.lags[-1]
    count = len(slices.lags)
    assert layers.shape[0] == made.count == 1 + 2 * count
    np.testing.assert_allclose(nodal(made, layers[1])[..., 3], np.minimum(slices.reach[0], last))
    assert slices.forward_reach is not None
    np.testing.assert_allclose(
        nodal(made, layers[count + 1])[..., 3], np.minimum(slices.forward_reach[0], last)
    )
    assert not layers[2 : count + 1, ..., 3].any()
    assert np.isfinite(layers).all()


def test_by_time_slopes_are_speeds_over_a_typical_speed() -> None:
    field = double_gyre_field(shape=(21, 41))
    made = textures(field, parameter="time")
    tangent = nodal(made, made.layers()[0])[..., :3]
    np.testing.assert_allclose(
        np.linalg.norm(tangent, axis=-1) * made.pace, field.speed[0], atol=1e-6
    )
    assert np.sqrt(np.mean(np.sum(tangent**2, axis=-1))) == pytest.approx(1, rel=1e-4)


def test_periodic_axis_goes_on_by_its_own_period() -> None:
    made = textures(cylinder_field().at_step(0))
    columns, rows = made.geometry.columns, made.geometry.rows
    assert columns.periodic and not rows.periodic
    period = columns.nodes - 1
    layers = made.layers()
    np.testing.assert_array_equal(layers[:, :, :-period], layers[:, :, period:])
    # Beyond the border of an open axis the last line is repeated.
    np.testing.assert_array_equal(
        layers[:, rows.nodes :],
        layers[:, rows.nodes - 1 : rows.nodes] + 0 * layers[:, rows.nodes :],
    )


def test_paths_go_on_across_the_seam() -> None:
    made = textures(cylinder_field().at_step(0))
    layers = made.layers()
    slope = nodal(made, layers[4])[..., :3]
    across = np.linalg.norm(slope[:, 1] - slope[:, -2], axis=-1)
    elsewhere = np.linalg.norm(slope[:, 42] - slope[:, 40], axis=-1)
    assert np.median(across) < 5 * np.median(elsewhere)


def test_layers_fill_whole_blocks_of_the_coarsest_level() -> None:
    made = textures(double_gyre_field(shape=(21, 41)))
    block = 2**made.geometry.levels
    height, width = made.layers().shape[1:3]
    assert height % block == width % block == 0
    texel = made.geometry.coordinate * [width, height]
    i, j = np.meshgrid(np.arange(41), np.arange(21))
    np.testing.assert_allclose(texel, np.stack([i, j], axis=-1) + 0.5, atol=1e-3)


def test_flat_surfaces_lie_in_their_own_plane(rng: np.random.Generator) -> None:
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    flat = double_gyre_field(shape=(21, 41))
    field = FlowField.from_arrays(flat.points @ turn.T, flat.velocity[0] @ turn.T, periodic="")
    made = textures(field)
    assert made.geometry.planar
    assert np.abs(made.geometry.position[..., 2]).max() < 1e-6
    assert not made.layers()[..., :, 2].any() or np.abs(made.layers()[..., 2]).max() < 1e-5
    one = np.linalg.norm(nodal(made, made.layers()[5])[..., :3], axis=-1)
    plain = textures(flat)
    two = np.linalg.norm(nodal(plain, plain.layers()[5])[..., :3], axis=-1)
    np.testing.assert_allclose(one, two, atol=1e-3)


def test_curved_surfaces_keep_three_dimensions() -> None:
    a, z = np.meshgrid(np.linspace(0, 3, 31), np.linspace(0, 1, 21))
    points = np.stack([np.cos(a), np.sin(a), z], axis=-1)
    velocity = np.stack([-np.sin(a), np.cos(a), 0 * z + 0.2], axis=-1)
    made = textures(FlowField.from_arrays(points, velocity, periodic=""))
    assert not made.geometry.planar
    tangent = nodal(made, made.layers()[0])[..., :3]
    expected = velocity / np.linalg.norm(velocity, axis=-1, keepdims=True)
    np.testing.assert_allclose(tangent[1:-1, 1:-1], expected[1:-1, 1:-1], atol=2e-3)


def test_blanked_nodes_take_what_is_beside_them() -> None:
    field = double_gyre_field(shape=(21, 41))
    valid = np.ones(field.shape, bool)
    valid[5:9, 10:14] = False
    masked = FlowField.from_arrays(field.points, field.velocity[0], valid=valid, periodic="")
    made = textures(masked)
    layers = made.layers()
    assert np.isfinite(layers).all()
    for layer in layers[:4]:
        values = nodal(made, layer)
        np.testing.assert_array_equal(values[6, 10], values[6, 9])
        np.testing.assert_array_equal(values[5, 12], values[4, 12])


def test_index_space_layers_hold_the_displacements() -> None:
    field = airfoil_field((17, 49))
    made = textures(field, noise="texture")
    slices = made.store.at(0)
    layers = made.layers()
    np.testing.assert_allclose(nodal(made, layers[0])[..., :2], slices.rate[0], rtol=1e-5)
    np.testing.assert_allclose(
        nodal(made, layers[3])[..., :2], -slices.displacement[0, 2] / slices.lags[2], rtol=1e-4
    )
    assert not layers[..., 2].any()


def test_moves_are_those_of_the_surface(rng: np.random.Generator) -> None:
    for field in (double_gyre_field(shape=(11, 21)), stretched(15), airfoil_field((17, 49))):
        rows, columns = field.shape
        displacement = rng.standard_normal((rows, columns, 2)) * [columns / 2, rows / 2]
        i, j = np.meshgrid(np.arange(columns), np.arange(rows))
        start = np.stack([i, j], axis=-1)
        expected = field.surface.at(start + displacement) - field.points
        found = Moves(field.surface, np.eye(3))(displacement)
        np.testing.assert_allclose(
            np.moveaxis(found, 0, -1), expected, atol=1e-10 * field.surface.extent
        )


def test_slices_of_another_field_are_refused() -> None:
    slices = trace(double_gyre_field(shape=(6, 11)))
    with pytest.raises(
        ValueError, match=r"^the slices have \(6, 11\) nodes and the field \(7, 11\)"
    ):
        textures(double_gyre_field(shape=(7, 11)), slices)


@pytest.mark.parametrize("count", [1, 33])
def test_slices_that_a_shader_cannot_use_are_refused(count: int) -> None:
    field = double_gyre_field(shape=(6, 11))
    slices = trace(field, lags=np.linspace(0.1, 1, count))
    with pytest.raises(ValueError, match=rf"^{count} lags were traced; expected 2 to 32 to draw"):
        textures(field, slices)


# --- the paper's textures -------------------------------------------------------------------


def paper(field: FlowField, *, correction: bool, parameter: str = "arclength") -> PaperTextures:
    store = SliceStore(field, parameter=parameter)
    return PaperTextures.build(store, resolution=128, correction=correction)


@pytest.mark.parametrize("parameter", ["arclength", "time"])
def test_a_step_of_the_uncorrected_noise_moves_one_texel(parameter: str) -> None:
    field = stretched()
    made = paper(field, correction=False, parameter=parameter)
    step = made.step[0, ..., 0] if made.step.ndim == 4 else made.step[..., 0]
    if made.step.ndim == 2:
        step = made.step
    height, width = made.noise.shape
    rows, columns = field.shape
    store = SliceStore(field, parameter=parameter)
    rate = np.abs(store.at(0).rate[0])
    texels = (rate / [(columns - 1) / width, (rows - 1) / height]).max(axis=-1)
    j = (np.arange(1, 40, 7) / (rows - 1) * height).astype(int)
    i = (np.arange(1, 40, 7) / (columns - 1) * width).astype(int)
    moved = step[np.ix_(j, i)] * texels[np.ix_(np.arange(1, 40, 7), np.arange(1, 40, 7))]
    np.testing.assert_allclose(moved, 1, atol=0.1)


@pytest.mark.parametrize("correction", [True, False])
def test_noise_has_zero_mean_and_unit_variance(correction: bool) -> None:
    noise = paper(stretched(), correction=correction).noise
    assert noise.mean() == pytest.approx(0, abs=1e-5)
    assert noise.std() == pytest.approx(1, abs=1e-4)


def test_correction_makes_the_grain_even_on_the_surface() -> None:
    """Figure 6: along a row, runs of one value lengthen in the texels that are narrow in space."""

    def grain(noise: NDArray[np.float32], part: slice) -> float:
        """Correlation of neighbouring texels along i."""
        cut = noise[:, part]
        return float(np.mean(cut[:, 1:] * cut[:, :-1]) / np.mean(cut**2))

    field = stretched()
    plain, even = (paper(field, correction=c).noise for c in (False, True))
    width = plain.shape[1]
    narrow, wide = slice(0, width // 4), slice(3 * width // 4, width)
    assert abs(grain(plain, narrow)) < 0.1
    assert abs(grain(plain, wide)) < 0.1
    assert grain(even, narrow) > grain(even, wide) + 0.1


def test_noise_is_the_same_for_the_same_seed() -> None:
    store = SliceStore(stretched(21))
    one, two, other = (
        PaperTextures.build(store, resolution=64, correction=True, seed=s).noise for s in (1, 1, 2)
    )
    np.testing.assert_array_equal(one, two)
    assert np.corrcoef(one.ravel(), other.ravel())[0, 1] < 0.2


def test_noise_is_repeated_where_the_axis_is() -> None:
    assert paper(cylinder_field().at_step(0), correction=True).repeat == (False, True)
    assert Geometry.of(stretched()).columns.before == 0
