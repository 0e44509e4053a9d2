"""The NumPy renderer: by its own symmetries and exact solutions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy import ndimage

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu import raster
from flowtex.rendering.cpu.fragments import Fragments
from flowtex.rendering.cpu.mipmaps import Mips
from flowtex.rendering.cpu.noise import SpaceNoise
from flowtex.rendering.cpu.raster import Coverage, rasterise
from flowtex.rendering.cpu.render import render
from flowtex.rendering.cpu.shade import shade
from flowtex.rendering.cpu.texture import Lookup, LookupMaker, Sums
from flowtex.settings import Settings
from flowtex.textures.texture_set import TextureSet
from flowtex.trace.store import SliceStore

Shot = tuple[Camera, tuple[int, int]]  #: A camera, and width and height of its picture in pixels.

# --- fields ---------------------------------------------------------------------------------


def gyre_points(columns: int = 61, rows: int = 31) -> Floats:
    s, t = np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows))
    x = 2 * (s + 0.06 * np.sin(2 * np.pi * s)) + 0.12 * np.sin(np.pi * t)
    return np.stack([x, t**1.3], axis=-1)


def gyre_velocity(p: Floats) -> Floats:
    x, y = np.pi * p[..., 0], np.pi * p[..., 1]
    return np.stack([-np.sin(x) * np.cos(y), np.cos(x) * np.sin(y)], axis=-1)


@cache
def gyre(columns: int = 61, rows: int = 31) -> FlowField:
    points = gyre_points(columns, rows)
    return FlowField.from_arrays(points, gyre_velocity(points))


def planar(points: Floats, velocity: Floats) -> FlowField:
    return FlowField.from_arrays(points, velocity, periodic="")


def textures(field: FlowField, settings: Settings) -> TextureSet:
    return TextureSet.build(SliceStore(field, parameter=settings.parameter))


def straight(focus: tuple[float, float], pixel: float, size: tuple[int, int] = (90, 60)) -> Shot:
    """Straight view of the x-y plane with pixels of a given size."""
    x, y = focus
    scale = pixel * size[1] / 2
    return Camera((x, y, 5.0), (x, y, 0.0), (0, 1, 0), parallel=True, parallel_scale=scale), size


def value(field: FlowField, shot: Shot, function: Any = None, **options: Any) -> Floats:
    settings = Settings(**options)
    made = textures(field, settings)
    lookup = None if function is None else averaged_function(function, made)
    return render(made, settings, *shot, lookup=lookup).value


# --- a function of position in place of the noise ---------------------------------------------


class FunctionLookup(Lookup):
    """Weighted mean of a function along the paths of some fragments.

    The second value that is summed is one everywhere, so that the ratio of both sums is the
    mean, whatever the weights are.
    """

    def __init__(
        self,
        function: Callable[[Floats], Floats],
        textures: TextureSet,
        fragments: Fragments,
        values: Mapping[str, Any],
    ) -> None:
        geometry = textures.geometry
        self._function, self._frame, self._center = function, geometry.frame, geometry.center
        self._here = fragments.position.value
        noise = SpaceNoise(fragments, values, planar=geometry.planar)
        self.spacing, self.level = noise.spacing, noise.level

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Return the function and one, (N, 2)."""
        del length
        value = self._function((self._here + displacement) @ self._frame + self._center)
        return np.stack([value, np.ones_like(value)], axis=-1)

    def blend(self, sums: Sums) -> Floats:
        """Return the mean."""
        return np.asarray(sums.values[:, 0] / sums.values[:, 1])


def averaged_function(function: Callable[[Floats], Floats], made: TextureSet) -> LookupMaker:
    """Look-up that averages a function along the paths.

    A picture without noise is as smooth as the function, so two pictures can be compared where
    noise would only be as random in both.
    """
    return lambda fragments, values: FunctionLookup(function, made, fragments, values)


# --- the rasteriser -------------------------------------------------------------------------


def rays(camera: Camera, size: tuple[int, int]) -> tuple[Floats, Floats]:
    """Start and direction of the ray through the middle of each pixel, (H * W, 3)."""
    right, up, forward = camera.axes
    width, height = size
    x, y = np.meshgrid(np.arange(width) + 0.5 - width / 2, height / 2 - np.arange(height) - 0.5)
    half = np.tan(np.radians(camera.view_angle / 2))
    half = camera.parallel_scale if camera.parallel else half
    aside = (x[..., None] * right + y[..., None] * up).reshape(-1, 3) * (2 * half / height)
    start = np.broadcast_to(np.asarray(camera.position, dtype=float), aside.shape)
    if camera.parallel:
        return start + aside, np.broadcast_to(forward, aside.shape)
    return start, aside + forward


def hits(camera: Camera, size: tuple[int, int], corners: Floats) -> Floats:
    """Distance along each ray to each triangle (M, 3, 3), (H * W, M); inf where it is missed."""
    start, along = rays(camera, size)
    behind = -np.inf if camera.parallel else 0.0
    distances = np.full((len(start), len(corners)), np.inf)
    for m, (a, b, c) in enumerate(corners):
        columns = np.stack([np.broadcast_to(b - a, along.shape), c - a + 0 * along, -along], -1)
        u, v, t = np.linalg.solve(columns, (start - a)[..., None])[..., 0].T
        inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > behind)
        distances[inside, m] = t[inside]
    return distances


def project(camera: Camera, size: tuple[int, int], points: Floats) -> Floats:
    matrix = camera.matrix(size[0] / size[1])
    return np.asarray(np.c_[points, np.ones(len(points))] @ matrix.T)


@pytest.mark.parametrize("scale", [None, 1.5])
def test_triangles_are_drawn_where_rays_hit_them(
    scale: float | None, rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(raster, "CHUNK", 100)
    size, parallel = (37, 23), scale is not None
    camera = Camera((0.2, -0.1, 2.0), (0, 0.1, 0), (0.1, 1, 0), parallel, scale or 1.0, 50.0)
    # Some corners lie behind the camera, and some triangles quite outside the picture.
    points = np.repeat(rng.normal(size=(12, 3)) * [0.8, 0.8, 1.0], 3, axis=0)
    points += rng.normal(size=(36, 3)) * [0.6, 0.6, 1.2]
    triangles = np.arange(36).reshape(-1, 3)
    assert (project(camera, size, points)[:, 3] < 0).any() == (scale is None)
    found = rasterise(project(camera, size, points), triangles, size)
    distance = hits(camera, size, points[triangles])
    covered = np.isfinite(distance).any(axis=-1)
    assert 0.2 < covered.mean() < 1
    np.testing.assert_array_equal(found.pixel, np.flatnonzero(covered))
    nearest = distance.argmin(axis=-1)[found.pixel]
    np.testing.assert_array_equal(found.corners[:, 0] // 3, nearest)
    start, along = (a[found.pixel] for a in rays(camera, size))
    expected = start + distance[found.pixel, nearest][:, None] * along
    np.testing.assert_allclose(found.mix(points)[0], expected, atol=1e-9)


def test_derivatives_are_those_of_the_rays(rng: np.random.Generator) -> None:
    corners = np.array([[-5.0, -3, 0], [6, -4, 0.5], [0, 7, 2]])
    data = rng.normal(size=(3, 2))

    def at(shift: tuple[float, float]) -> tuple[Coverage, tuple[Floats, Floats, Floats]]:
        """The picture seen through a window that is moved by parts of a pixel."""
        size, camera = (20, 16), Camera((0, -4.0, 3.0), (0, 0, 0.3), (0, 0, 1))
        clip = project(camera, size, corners)
        clip[:, 0] -= 2 * shift[0] / 20 * clip[:, 3]
        clip[:, 1] += 2 * shift[1] / 16 * clip[:, 3]
        found = rasterise(clip, np.array([[0, 1, 2]]), size)
        return found, found.mix(data)

    h = 1e-4
    found, (_, dx, dy) = at((0, 0))
    assert len(found.pixel) == 320
    for derivative, shift in ((dx, (h, 0.0)), (dy, (0.0, h))):
        after, before = (at((sign * shift[0], sign * shift[1]))[1][0] for sign in (1, -1))
        np.testing.assert_allclose(derivative, (after - before) / (2 * h), atol=1e-8, rtol=1e-6)


@pytest.mark.parametrize("turned", [False, True])
def test_a_mesh_has_neither_holes_nor_seams(turned: bool, rng: np.random.Generator) -> None:
    # Nodes lie on the middles of pixels, so that these are on edges and corners throughout.
    j, i = np.mgrid[0:25, 0:33]
    nodes = np.stack([i, j], axis=-1) + 0.5
    nodes[1:-1, 1:-1] += rng.integers(-1, 2, size=(23, 31, 2)) * 0.25
    corner = (np.arange(24)[:, None] * 33 + np.arange(32)).reshape(-1, 1)
    halves = (corner + np.array([0, 1, 34, 0, 34, 33])).reshape(-1, 3)
    halves = halves[:, ::-1] if turned else halves
    w = rng.uniform(1, 3, size=(25, 33, 1)).reshape(-1, 1)
    ndc = (nodes / [33, 25] * 2 - 1).reshape(-1, 2) * [1, -1]
    clip = np.c_[ndc * w, -np.ones(len(w)), w]
    found = rasterise(clip, halves, (33, 25))
    # The outermost nodes are on the outline, where rounding may leave a pixel out.
    inside = np.zeros((25, 33), dtype=bool)
    inside[1:-1, 1:-1] = True
    assert np.isin(np.flatnonzero(inside), found.pixel).all()
    assert len(np.unique(found.pixel)) == len(found.pixel)
    assert (found.weights > -1e-9).all()
    np.testing.assert_allclose(found.weights.sum(axis=-1), 1, atol=1e-12)


def test_triangles_without_area_are_not_drawn() -> None:
    size, camera = (16, 16), Camera((0, 0, 3), (0, 0, 0), (0, 1, 0), parallel=True)
    points = np.array([[-1.0, -1, 0], [1, 1, 0], [0, 0, 0], [0, 0, 1], [0, 1, 0.5]])
    flat = np.array([[0, 1, 2], [2, 2, 1], [2, 3, 4]])
    found = rasterise(project(camera, size, points), flat, size)
    assert len(found.pixel) == 0


# --- textures -------------------------------------------------------------------------------


@pytest.mark.parametrize("repeat", [(False, False), (True, True), (False, True)])
def test_bilinear_lookup_is_that_of_scipy(
    repeat: tuple[bool, bool], rng: np.random.Generator
) -> None:
    texels = rng.normal(size=(3, 8, 16, 2)).astype(np.float16).astype(np.float32)
    mips = Mips(texels, levels=1, repeat=repeat)
    at = rng.uniform(-0.5, 1.5, size=(200, 2))
    layer = rng.integers(0, 3, size=200)
    found = mips.at(at, np.zeros(200), layer)
    x, y = at[:, 0] * 16 - 0.5, at[:, 1] * 8 - 0.5
    x = np.mod(x, 16) if repeat[1] else np.clip(x, 0, 15)
    y = np.mod(y, 8) if repeat[0] else np.clip(y, 0, 7)
    closed = np.pad(texels, ((0, 0), (0, 1), (0, 1), (0, 0)), mode="wrap")
    for channel in range(2):
        expected = ndimage.map_coordinates(closed[..., channel], [layer, y, x], order=1)
        np.testing.assert_allclose(found[:, channel], expected, atol=1e-6)


def test_a_level_holds_means_and_levels_are_blended(rng: np.random.Generator) -> None:
    texels = rng.integers(-64, 64, size=(1, 8, 4, 1)).astype(np.float32)
    mips = Mips(texels)
    assert mips.levels == 3
    middle = np.array([[0.125, 0.125]])  # middle of a texel of level 1 and of four of level 0
    mean = texels[0, :2, :1].mean() * 0.5 + texels[0, :2, 1:2].mean() * 0.5
    corner = np.array([[0.25, 0.125]])
    assert mips.at(corner, np.array([1.0]))[0, 0] == pytest.approx(mean, abs=1e-9)
    assert mips.at(middle, np.array([9.0]))[0, 0] == pytest.approx(texels.mean(), abs=0.02)
    fine, coarse = (mips.at(middle, np.array([float(n)]))[0, 0] for n in (0, 1))
    between = mips.at(middle, np.array([0.25]))[0, 0]
    assert between == pytest.approx(0.75 * fine + 0.25 * coarse)


def test_texels_are_in_half_precision() -> None:
    mips = Mips(np.full((1, 2, 2, 1), 1 + 2.0**-12, np.float32))
    assert mips.at(np.array([[0.5, 0.5]]), np.zeros(1))[0, 0] == 1.0


# --- exact solutions ------------------------------------------------------------------------


def wave(p: Floats) -> Floats:
    return np.asarray(np.sin(9 * p[:, 0] + 2) * np.cos(7 * p[:, 1]) + 0.4 * np.sin(15 * p[:, 1]))


def along(path: Callable[[float], Floats], settings: Settings, pixel: float) -> Floats:
    """Weighted mean of the wave along a path by length, from the definition of the kernel."""
    spacing = settings.spacing * settings.grain * pixel
    half = settings.samples // 2 if settings.two_sided else settings.samples - 1
    total, weights = np.zeros(1), 0.0
    for k in range(-half, half + 1 if settings.two_sided else 1):
        x = k / (half + 1)
        weight = {"hann": 0.5 + 0.5 * np.cos(np.pi * x), "box": 1.0}.get(
            settings.kernel, 0.5 * (1 - x) if settings.two_sided else 1 + x
        )
        total = total + weight * wave(path(k * spacing))
        weights += weight
    return total / weights


@pytest.mark.parametrize("kernel", ["hann", "box", "ramp"])
@pytest.mark.parametrize("two_sided", [True, False])
def test_straight_flow_averages_along_lines(kernel: str, two_sided: bool) -> None:
    y, x = np.mgrid[-2:2:31j, -2:2:41j]
    points = np.stack([x + 0.1 * np.sin(y), y], axis=-1)
    direction = np.array([0.8, 0.6])
    field = planar(points, np.broadcast_to(direction, points.shape))
    settings = Settings(kernel=kernel, two_sided=two_sided, samples=31)
    made = textures(field, settings)
    picture = render(
        made, settings, *straight((0.1, -0.2), 0.01, (60, 40)), lookup=averaged_function(wave, made)
    )
    at = picture.position.reshape(-1, 3)
    expected = along(lambda s: at + s * np.array([*direction, 0]), settings, 0.01)
    # Half precision of the slopes: 2^-11 of the length of the path.
    np.testing.assert_allclose(picture.value.ravel(), expected, atol=2e-3)


def test_rotating_flow_averages_along_circles() -> None:
    y, x = np.mgrid[-2:2:101j, -2:2:101j]
    field = planar(np.stack([x, y], axis=-1), np.stack([-y, x], axis=-1))
    settings = Settings()
    made = textures(field, settings)
    picture = render(
        made, settings, *straight((0.9, 0.3), 0.012), lookup=averaged_function(wave, made)
    )
    at = picture.position.reshape(-1, 3)
    radius, angle = np.hypot(at[:, 0], at[:, 1]), np.arctan2(at[:, 1], at[:, 0])
    far = radius > 0.4

    def circle(s: float) -> Floats:
        turned = angle + s / radius
        return np.stack([radius * np.cos(turned), radius * np.sin(turned), 0 * radius], axis=-1)

    away = np.abs(picture.value.ravel() - along(circle, settings, 0.012))[far]
    assert np.quantile(away, 0.99) < 4e-3
    assert away.max() < 2e-2


# --- symmetries -----------------------------------------------------------------------------

#: A view of the gyre, its pixel, and the same window seen after a turn or in a mirror.
FOCUS, PIXEL = (0.83, 0.44), 0.012


def turned(p: Floats) -> Floats:
    return np.stack([-p[..., 1], p[..., 0]], axis=-1)


def mirrored(p: Floats) -> Floats:
    return np.stack([-p[..., 0], p[..., 1]], axis=-1)


@cache
def reference() -> Floats:
    return value(planar(gyre_points(), gyre_velocity(gyre_points())), straight(FOCUS, PIXEL), wave)


def symmetries() -> dict[str, tuple[Floats, Floats, Shot, Any, Any]]:
    """Nodes, velocity, view, the wave in it, and how its picture is laid on that of the gyre."""
    p, v, (x, y) = gyre_points(), gyre_velocity(gyre_points()), FOCUS
    here, same = straight(FOCUS, PIXEL), np.asarray
    swapped = np.swapaxes(p, 0, 1)
    return {
        "turned": (
            *(turned(p), turned(v), straight((-y, x), PIXEL, (60, 90))),
            lambda q: wave(np.stack([q[:, 1], -q[:, 0]], axis=-1)),
            lambda picture: np.rot90(picture, -1),
        ),
        "mirrored": (
            *(mirrored(p), mirrored(v), straight((-x, y), PIXEL)),
            lambda q: wave(np.stack([-q[:, 0], q[:, 1]], axis=-1)),
            lambda picture: picture[:, ::-1],
        ),
        "order of the nodes": (swapped, gyre_velocity(swapped), here, wave, same),
        "unit": (
            *(1000 * p, 7 * v, straight((1000 * x, 1000 * y), 1000 * PIXEL)),
            *(lambda q: wave(q / 1000), same),
        ),
        "backward": (p, -v, here, wave, same),
    }


@pytest.mark.parametrize("name", symmetries())
def test_the_picture_has_the_symmetries_of_the_method(name: str) -> None:
    points, velocity, shot, function, back = symmetries()[name]
    found = value(planar(points, velocity), shot, function)
    np.testing.assert_allclose(back(found), reference(), atol=1e-3)


def test_turned_space_gives_the_same_picture(rng: np.random.Generator) -> None:
    # The surface and the camera, turned together in space.
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    eye, focal, up = np.array([1.9, -0.9, 1.1]), np.array([0.9, 0.45, 0.0]), np.array([0, 0, 1.0])
    p, v = (
        np.pad(a, ((0, 0), (0, 0), (0, 1))) for a in (gyre_points(), gyre_velocity(gyre_points()))
    )
    here = value(planar(p, v), (Camera(tuple(eye), tuple(focal), tuple(up)), (90, 60)), wave)
    camera = Camera(tuple(turn @ eye), tuple(turn @ focal), tuple(turn @ up))
    there = value(planar(p @ turn.T, v @ turn.T), (camera, (90, 60)), lambda q: wave(q @ turn))
    np.testing.assert_array_equal(np.isnan(there), np.isnan(here))
    # The axes of the slopes differ, and with them what half precision makes of them.
    away = np.abs(there - here)[~np.isnan(here)]
    assert np.quantile(away, 0.99) < 1e-3
    assert away.max() < 3e-2


def test_the_texture_does_not_depend_on_where_the_view_is() -> None:
    settings = Settings()
    made = textures(gyre(), settings)
    here = render(made, settings, *straight(FOCUS, PIXEL))
    there = render(made, settings, *straight((FOCUS[0] + 20 * PIXEL, FOCUS[1]), PIXEL))
    # Beside the edges of the picture, pixels beyond them are missing in the local mean.
    moved, still = there.value[:, 20:-40], here.value[:, 40:-20]
    np.testing.assert_allclose(moved, still, atol=1e-6)
    shown = here.value[here.covered]
    assert abs(shown.mean()) < 0.25
    assert 0.4 < shown.std() < 1.2


# --- pictures -------------------------------------------------------------------------------


def test_a_picture_says_what_it_shows() -> None:
    y, x = np.mgrid[0:1:21j, 0:1:21j]
    valid = np.hypot(x - 0.5, y - 0.5) > 0.2
    field = FlowField.from_arrays(
        np.stack([x, y], -1), np.where(valid[..., None], [1.0, 0.0], np.nan)
    )
    settings = Settings()
    picture = render(textures(field, settings), settings, *straight((0.5, 0.5), 0.02, (60, 60)))
    py, px = np.mgrid[0:60, 0:60]
    at = np.stack([(px - 29.5) * 0.02 + 0.5, (29.5 - py) * 0.02 + 0.5], axis=-1)
    seen = picture.covered
    np.testing.assert_allclose(picture.position[seen][:, :2], at[seen], atol=1e-12)
    away = np.hypot(*(at - 0.5).T).T
    assert not seen[away < 0.17].any()
    assert seen[(away > 0.25) & (np.abs(at - 0.5).max(axis=-1) < 0.5)].all()
    assert not seen[(np.abs(at - 0.5).max(axis=-1) > 0.5)].any()
    for data in (picture.value, picture.position[..., 0], picture.slice_level, picture.noise_level):
        np.testing.assert_array_equal(np.isfinite(data), seen)
    drawn = picture.rgb((0.5, 0.5, 0.5), background=(1, 0, 0))
    assert drawn.dtype == np.uint8
    assert (drawn[~seen] == [255, 0, 0]).all()
    assert (drawn[seen][:, 0] == drawn[seen][:, 1]).all()


def test_the_texture_fades_where_the_flow_is_slow() -> None:
    y, x = np.mgrid[0:1:21j, 0:1:21j]
    field = planar(np.stack([x, y], -1), np.stack([0 * x, x], -1))
    shot = straight((0.5, 0.5), 0.02, (60, 50))
    plain, faded = value(field, shot), value(field, shot, fade=0.8)
    seen = np.isfinite(plain)
    across = np.broadcast_to((np.arange(60) - 29.5) * 0.02 + 0.5, seen.shape)[seen]
    share = np.clip(across / (0.8 * np.sqrt(np.mean(x**2))), 0, 1)
    np.testing.assert_allclose(faded[seen], plain[seen] * share**2 * (3 - 2 * share), atol=0.01)
    assert (faded[seen] == plain[seen])[share == 1].all()
    least = value(field, shot, fade=1e-311)
    assert (least[seen] == plain[seen]).all(), "a fade near zero is none"


def test_an_empty_view_is_an_empty_picture() -> None:
    settings = Settings()
    picture = render(textures(gyre(), settings), settings, *straight((50, 50), 0.01, (8, 6)))
    assert not picture.covered.any()
    assert (picture.rgb(background=(0, 0, 1)) == [0, 0, 255]).all()


def test_colours_by_pixel_and_without_texture() -> None:
    settings = Settings(strength=0.0)
    shot = straight((1.0, 0.5), 0.01, (20, 16))
    picture = render(textures(gyre(), settings), settings, *shot)
    colours = np.random.default_rng(0).uniform(size=(16, 20, 3))
    np.testing.assert_array_equal(picture.rgb(colours), np.rint(colours * 255))


def test_shade_goes_up_and_down_by_the_same_lightness() -> None:
    grey = shade((0.5, 0.5, 0.5), np.linspace(-3, 3, 7), Settings())
    assert (np.diff(grey[:, 0]) > 0).all()
    np.testing.assert_allclose(grey, grey[:, :1] * np.ones(3), atol=1e-6)
    assert ((grey >= 0) & (grey <= 1)).all()
    for colour in ((1.0, 1.0, 1.0), (0.0, 0.0, 0.0)):
        plain = shade(colour, np.array([-1.0, 1.0]), Settings(strength=0.0))
        np.testing.assert_allclose(plain, [colour, colour], atol=1e-6)
