"""The method at one point: exact solutions, and the pixel that the NumPy renderer draws there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import cache
from typing import Any

import numpy as np
import pytest
from flows import gyre, swinging, torus

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.render import lookup_maker, render
from flowtex.rendering.uniforms import ViewState
from flowtex.scene.options import Appearance
from flowtex.scene.probe import Probe, locate, probe
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

# --- fields ---------------------------------------------------------------------------------


def grid(rows: int = 41, columns: int = 61) -> Floats:
    y, x = np.meshgrid(np.linspace(-1, 1, rows), np.linspace(-1.5, 1.5, columns), indexing="ij")
    return np.stack([x, y], axis=-1)


@cache
def wind() -> FlowField:
    """Everywhere (0.8, 0.6)."""
    return FlowField.from_arrays(grid(), np.broadcast_to([0.8, 0.6], (41, 61, 2)), periodic="")


@cache
def turn() -> FlowField:
    """Half a radian in a unit of time around the middle, which lies between the nodes."""
    p = grid(80, 120)
    return FlowField.from_arrays(p, 0.5 * np.stack([-p[..., 1], p[..., 0]], axis=-1), periodic="")


@cache
def fibres() -> FlowField:
    """A singularity of half a turn, without a sign."""
    p = grid(20, 30)
    half = 0.5 * np.arctan2(p[..., 1], p[..., 0])
    axes = np.stack([np.cos(half), np.sin(half)], axis=-1)
    return FlowField.from_arrays(p, axes, sign_free=True, periodic="")


def view_of(field: FlowField, **settings: Any) -> Scene:
    chosen = Settings()
    image = settings.pop("image", None)
    chosen.update(**settings)
    return Scene(field, chosen, Appearance.of(image=image))


SIZE = (36, 24)  #: Width and height of the pictures in pixels.


def camera(field: FlowField, *, aside: bool = False) -> Camera:
    """Straight on without perspective, or from aside with it."""
    c, away = field.surface.center, np.array([0.5, -0.8, 1.2] if aside else [0.0, 0.0, 1.0])
    at = c + 1.5 * field.surface.extent * away
    scale = 0.3 * field.surface.extent
    return Camera(tuple(at), tuple(c), (0.0, 1.0, 0.0), not aside, scale)


# --- the pixel ------------------------------------------------------------------------------

IMAGE = np.random.default_rng(5).integers(0, 256, (16, 32, 4), dtype=np.uint8)
LAID: dict[str, Any] = {"noise": "image", "image": IMAGE}
CASES: dict[str, tuple[Callable[[], FlowField], dict[str, Any]]] = {
    "two-sided": (gyre, {}),
    "one-sided": (gyre, {"two_sided": False, "kernel": "ramp"}),
    "streaklets": (gyre, {"texture": "streaklets"}),
    "lod off": (gyre, {"lod": False, "resolution": 200}),
    "fixed grain": (gyre, {"fixed_grain": True, "resolution": 30}),
    "even count": (gyre, {"samples": 10, "parameter": "time"}),
    "one sample": (gyre, {"samples": 1}),
    "streaming": (gyre, {"motion": "speed", "speed": 90.0}),
    "image": (gyre, LAID | {"tiles": 2}),
    "image, lod off": (gyre, LAID | {"lod": False, "two_sided": False, "kernel": "box"}),
    "noise texture": (gyre, {"noise": "texture", "resolution": 128}),
    "unsteady": (swinging, {}),
    "unsteady image": (swinging, LAID),
    "no sign": (fibres, {}),
    "curved": (torus, {}),
    "curved image": (torus, LAID),
}


@pytest.mark.parametrize(
    ("case", "aside"),
    [
        *((case, False) for case in CASES),
        *((case, True) for case in ("two-sided", "streaklets", "image", "unsteady", "curved")),
    ],
)
def test_the_value_is_what_is_drawn(case: str, aside: bool, rng: np.random.Generator) -> None:
    make, settings = CASES[case]
    field = make()
    view, shot, clock = view_of(field, **settings), camera(field, aside=aside), 1.3
    if not field.steady:
        view.time = 0.5
    before, after, between = view.moment
    state = ViewState(between=between, still=True, clock=clock)
    # With a noise that is given, the local mean stays in the picture: a point does not know it.
    noise = lookup_maker(view.textures)
    picture = render(
        view.textures,
        view.settings,
        shot,
        SIZE,
        view=state,
        steps=(before, after),
        lookup=noise,
    )
    for y, x in rng.permutation(np.argwhere(picture.covered))[:4]:
        at = locate(field, picture.position[y, x])
        assert at is not None
        got = probe(view, at, pixel=shot, size=SIZE, clock=clock)
        assert got.value == pytest.approx(picture.value[y, x], abs=1e-6)
        assert got.level == pytest.approx(picture.noise_level[y, x], abs=1e-6)
        assert got.field_values.position == pytest.approx(picture.position[y, x], abs=1e-6)
        # And it is the sum of what is told about it.
        assert got.gain * (got.weights @ got.noise) == pytest.approx(got.value, abs=1e-9)
        check_shapes(got)


def check_shapes(got: Probe) -> None:
    k = len(got.lags)
    assert k >= 1
    for name in ("points", "slices", "shares", "weights", "noise"):
        assert len(getattr(got, name)) == k, name
    assert got.points.shape == (k, 3)
    assert got.slices.shape == (k, 2)
    assert got.path.shape == (len(got.path_lags), 3)
    assert got.weights.sum() == pytest.approx(1)
    assert (got.weights >= 0).all()  # zero behind a source, for streaklets
    assert (np.diff(got.lags) < 0).all()
    assert (np.diff(got.path_lags) < 0).all()
    for field in fields(got):
        values = getattr(got, field.name)
        if isinstance(values, np.ndarray):
            assert np.isfinite(values).all(), field.name
    assert (got.shares >= 0).all()
    # The path passes through each.
    spread = float(np.ptp(got.points, axis=0).max())
    for axis in range(3):
        along = np.interp(-got.lags, -got.path_lags, got.path[:, axis])
        assert along == pytest.approx(got.points[:, axis], abs=0.01 * spread + 1e-9)


# --- exact solutions ------------------------------------------------------------------------


def test_an_even_wind_has_straight_paths_and_even_samples() -> None:
    view = view_of(wind(), samples=21, spacing=0.8, grain=2.0)
    got = probe(view, (20.3, 30.4), pixel=0.004)
    assert got.field_values.velocity == pytest.approx([0.8, 0.6, 0])
    assert len(got.lags) == 21
    assert got.step == pytest.approx(0.0064, rel=1e-3)
    assert np.diff(got.points, axis=0) == pytest.approx(
        np.tile([0.0064 * 0.8, 0.0064 * 0.6, 0], (20, 1)), abs=1e-5
    )
    assert got.points[10] == pytest.approx(got.field_values.position, abs=1e-6)
    # Paths go backward along the wind for positive lags; by arc length a lag is a length.
    away = (got.points - got.field_values.position) @ [0.8, 0.6, 0]
    assert away == pytest.approx(-got.lags, abs=1e-5)
    hann = 0.5 + 0.5 * np.cos(np.pi * np.arange(-10, 11) / 11)
    assert got.weights == pytest.approx(hann / hann.sum())
    # The path as a whole is a straight line as well, as far as the slices lead.
    bent = (got.path - got.field_values.position) @ [0.6, -0.8, 0]
    assert np.abs(bent).max() < 1e-3
    assert np.ptp(got.path_lags) > 10 * np.ptp(got.lags)


def test_a_rotation_has_round_paths() -> None:
    view = view_of(turn(), parameter="time", samples=41, grain=1.5)
    got = probe(view, (50.3, 70.8), pixel=0.01)
    centre, radius = got.points[:, :2], np.hypot(*got.field_values.position[:2])
    assert np.hypot(*centre.T) == pytest.approx(np.full(41, radius), rel=5e-3)
    angle = np.unwrap(np.arctan2(centre[:, 1], centre[:, 0]))
    assert angle - angle[20] == pytest.approx(-0.5 * got.lags, abs=2e-3)
    assert np.diff(angle) == pytest.approx(np.full(40, 0.7 * 1.5 * 0.01 / radius), rel=2e-2)
    assert np.ptp(angle) > 0.4
    # A lag is a time: a step takes as long as the flow needs for it.
    assert got.step == pytest.approx(0.7 * 1.5 * 0.01 / (0.5 * radius), rel=1e-2)


def test_a_large_field_is_read_in_its_coarser_form() -> None:
    x, y = np.meshgrid(np.linspace(0, 2, 801), np.linspace(0, 1, 401))
    velocity = np.stack([-(y - 0.5), x - 1], axis=-1)
    points = np.stack([x, y], axis=-1)
    whole = Scene(FlowField.from_arrays(points, velocity))
    small = Scene(FlowField.from_arrays(points[::5, ::5], velocity[::5, ::5]))
    assert whole.pyramid is not None
    one, other = (probe(s, at, pixel=2e-3) for s, at in ((whole, (120, 560)), (small, (24, 112))))
    np.testing.assert_allclose(one.field_values.position, [1.4, 0.3, 0], atol=1e-12)
    np.testing.assert_allclose(one.points, other.points, atol=2e-4)


# --- ends, seams and faults -------------------------------------------------------------------


def test_a_path_that_ends_has_fewer_samples() -> None:
    view = view_of(wind(), samples=61)
    got = probe(view, (20.0, 2.0), pixel=0.01)
    # The wind comes from the left border, a tenth away; half a step more or less.
    behind = got.lags[got.lags > 0]
    assert len(got.lags) == 31 + len(behind) < 61
    assert behind.max() == pytest.approx(0.1 / 0.8, abs=2 * got.step)
    assert got.points[:, 0].min() > -1.5 - got.step
    assert got.path[0, 0] == pytest.approx(-1.5, abs=1e-2)
    assert got.weights.sum() == pytest.approx(1)
    check_shapes(got)


def test_where_nothing_moves_there_is_one_sample() -> None:
    p = grid(21, 31)
    speed = np.where(p[..., 0] > 0, 1.0, 0.0)
    field = FlowField.from_arrays(p, np.stack([speed, 0 * speed], axis=-1), periodic="")
    got = probe(view_of(field), (10.5, 4.5), pixel=0.01)
    assert len(got.lags) == len(got.path) == 1
    assert np.isnan(got.step)
    assert got.value == 0


def test_a_seam_is_passed() -> None:
    x, y = np.meshgrid(np.arange(0.0, 361.0, 5.0), np.arange(-60.0, 61.0, 5.0))
    east = np.stack([np.ones_like(x), np.zeros_like(x)], axis=-1)
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), east, periodic="i")
    for look in ({}, LAID):
        got = probe(view_of(field, **look, samples=31), (12.0, 0.4), pixel=1.0)
        assert len(got.lags) == 31
        assert got.points[:, 0] == pytest.approx(2 - got.lags, abs=0.05)
        assert got.points[0, 0] < -5
    one, again = (probe(view_of(field), (12.0, i), pixel=1.0).value for i in (0.4, 72.4))
    assert again == pytest.approx(one)
