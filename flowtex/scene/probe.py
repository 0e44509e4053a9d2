"""The method at one point of the surface: its path, its samples, and their sum.

Everything comes from the NumPy renderer. It draws the one pixel as it draws all, with a look-up
that records its samples, so that they are those of the picture.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import brief
from flowtex._util.array_types import Floats, Indices
from flowtex._util.cache import WeakCache
from flowtex.errors import FieldError
from flowtex.field import Surface
from flowtex.field.interpolation import bracket
from flowtex.field.locate import SurfacePoint, locate, locator, surface_point
from flowtex.field.quantities import PointValues, values_at
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.fragments import Fragments, slice_level
from flowtex.rendering.cpu.mipmaps import Mips
from flowtex.rendering.cpu.raster import Coverage
from flowtex.rendering.cpu.render import lookup_maker, slices_at, view_state
from flowtex.rendering.cpu.shade import tone
from flowtex.rendering.cpu.texture import Lookup, LookupMaker, Side, Summing, Sums
from flowtex.rendering.even import DrawnGrains
from flowtex.rendering.shaders import const
from flowtex.rendering.uniforms import Values, ViewState, uniforms
from flowtex.scene.scene import Scene
from flowtex.textures.texture_set import TextureSet

__all__ = ["PointValues", "Probe", "locate", "probe", "values_at"]


POINTS_BETWEEN_SLICES = 12  #: Points of a path between two slices, where it is a parabola.


@dataclass(frozen=True, eq=False)
class Probe:
    """How the texture at one point of the surface is computed.

    The K samples are in the order of the flow: from the farthest upstream of the point to the
    farthest downstream. Samples beyond the end of the path are left out. Lags are lengths in the
    mesh's units for paths by arc length, otherwise times in the field's unit; they are positive
    upstream, where the particle comes from, and negative downstream.

    Attributes
    ----------
    field_values
        Position, velocity and speed at the point, with units.
    lags
        Lags of the samples, (K,), decreasing.
    points
        Positions of the samples in space, (K, 3), in the mesh's units. Beyond the seam of a flat
        map of one period they continue straight.
    slices
        Numbers of the two trace slices around each sample, (K, 2): the one of smaller lag first, 0
        for the point itself.
    shares
        Position of each sample between these slices, (K,), 0 to 1; more for a last sample that
        fades out beyond the last slice.
    weights
        Weight of each sample in the mean, (K,); their sum is 1.
    noise
        Noise at each sample, (K,), with mean 0 and standard deviation 1; for an image instead of
        noise, red, green and blue times opacity, and opacity, (K, 4).
    level
        Level of detail; each level is twice as coarse as the previous one. For an image, its mip
        level.
    step
        Lag from the point to the next sample; NaN where the velocity is zero.
    gain
        Factor of the mean of the noise, which makes the contrast the same everywhere.
    value
        The texture: ``gain * (weights @ noise)``, with mean 0 and standard deviation 1 over a
        picture; (4,) for an image instead of noise.
    path, path_lags
        The whole path, as far as the slices lead, in the order of the samples: points (N, 3) and
        their lags (N,). If the path ends, the last sample may lie up to a step beyond. In a close
        view of a critical point it is as long as the samples.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.scene.probe import locate, probe
    >>> from flowtex.scene.scene import Scene
    >>> field = flowtex.examples.double_gyre_field()
    >>> found = probe(Scene.of(field, samples=9), locate(field, (0.5, 0.25)), pixel=0.01)
    >>> len(found.lags), round(float(found.weights.sum()), 6)
    (9, 1.0)
    """

    field_values: PointValues
    lags: Floats
    points: Floats
    slices: Indices
    shares: Floats
    weights: Floats
    noise: Floats
    level: float
    step: float
    gain: float
    value: float | Floats
    path: Floats
    path_lags: Floats

    @property
    def greys(self) -> Floats:
        """The noise of the samples as grey values, (K,), from 0, black, to 1, white."""
        if self.noise.ndim == 1:
            return 0.5 + 0.5 * tone(self.noise, 1.0)
        return np.asarray(self.noise[:, :3].mean(axis=-1) + 1.0 - self.noise[:, 3])


def probe(
    view: Scene,
    at: ArrayLike,
    *,
    pixel: float | Camera,
    size: tuple[int, int] | None = None,
    clock: float = 0.0,
) -> Probe:
    """Return how the texture at a point of the surface is computed.

    The first call for new textures loads them, which takes as long as in a renderer; further calls
    take milliseconds.

    Parameters
    ----------
    view
        The flow, its settings and the time shown.
    at
        The point as (j, i), in cells; :func:`locate` returns it for a point in space.
    pixel
        Width of a pixel on the surface at the point, in the mesh's units, in a perpendicular view;
        or the camera of a picture, for the pixel that shows the point.
    size
        Width and height of the picture in pixels, for a camera.
    clock
        Clock of the streaming of a steady flow, in seconds.

    Raises
    ------
    FieldError
        When the point is not on the surface, ``pixel`` is not a length, or the camera does not see
        the point.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.scene.probe import locate, probe
    >>> from flowtex.scene.scene import Scene
    >>> field = flowtex.examples.double_gyre_field()
    >>> probe(Scene.of(field, samples=9), locate(field, (0.5, 0.25)), pixel=0.01).points.shape
    (9, 3)
    """
    surface = view.field.surface
    place = surface_point(surface, at)
    if not isinstance(pixel, Camera):
        camera = camera_facing(surface, place, pixel)
        size = (1, 1)
    elif size is None:
        raise FieldError(
            "size is None; expected the width and height of the camera's picture, in pixels"
        )
    else:
        camera = pixel
    before, after, between = view.moment
    state = ViewState(between=between, still=True, clock=clock)
    state = view_state(view.textures, camera, state, (before, after))
    values = uniforms(view.textures, view.settings, state)
    # The local mean of a picture is unknown at a point: the sum alone, as documented.
    values["u_even"] = False
    field_values = values_at(view.field, place.index, view.time)
    textures = view.textures
    if (drawn := textures.geometry.field) is not view.field:
        # A large field is drawn in a coarser form, on which the point has another place.
        nearest, _ = locator(drawn).nearest(field_values.position[None])
        surface = drawn.surface
        place = surface_point(drawn.surface, nearest[0])
    fragments = Fragments.of(textures, cover_place(surface, place, camera, size))
    return _Pixel(textures, (before, after), fragments, values, field_values).probe()


class _Pixel:
    """One fragment, drawn by the NumPy renderer."""

    def __init__(
        self,
        textures: TextureSet,
        steps: tuple[int, int],
        fragments: Fragments,
        values: Values,
        field_values: PointValues,
    ) -> None:
        loaded = LoadedTextures.of(textures)
        self._field_values = field_values
        self._textures = textures
        self._values = values
        self._fragments = fragments
        self._level = slice_level(fragments.coordinate, values)
        self._slices = slices_at(textures, steps, values, loaded.mips)
        most_samples = int(const.MOST_STRETCH * values["u_samples"]) + 2
        self._lookup = Recorder(loaded.make_lookup(fragments, values), most_samples)
        by_lag = textures.image is not None
        self._summing = Summing(self._slices, values, self._lookup, by_lag=by_lag)
        self._base = self._slices.layer(fragments.place, 0, self._level)
        #: One unit of lag at the fragment.
        self._unit = float(self._base[0, 3]) * textures.unit / textures.pace

    def probe(self) -> Probe:
        values = self._values
        recorder = self._lookup
        value = self._summing.texture(self._fragments.place, self._level, self._fragments.by)[0]
        sides = list(self._sides(1))
        lags = -np.concatenate(recorder.length) / float(sides[0].scale[0])
        order = np.argsort(-lags)
        lags = lags[order] + 0.0
        points = self._points(np.concatenate(recorder.displacement)[order])
        knots = np.concatenate([[0.0], values["u_lags"]])
        first_slice, shares = bracket(knots, np.abs(lags), side="left")
        certainty = self._summing.certainty(self._fragments.place, self._level)
        faded = self._summing.faded(self._fragments.place, self._level, certainty)
        count = self._summing.count(recorder.face(self._base[:, :3]), certainty)
        cell = self._summing.cell(self._fragments.place, count)
        in_cell = cell is not None and cell.share[0] > 0
        if in_cell:
            path_lags = lags
            path = points
        else:
            path_lags, path = self._path(sides, knots, lags)
        step = np.nan
        if np.isfinite(sides[0].reach[0]):  # it moves
            step = float(sides[0].step(np.zeros(1))[0]) * self._unit
        shown, share = _shown(value, faded)
        return Probe(
            field_values=self._field_values,
            lags=lags * self._unit,
            points=points,
            slices=np.stack([first_slice, first_slice + 1], axis=-1),
            shares=shares,
            weights=recorder.weights[order],
            noise=recorder.noise[order],
            level=float(recorder.level[0]),
            step=step,
            gain=recorder.gain * share,
            value=shown,
            path=path,
            path_lags=path_lags * self._unit,
        )

    def _sides(self, count: int) -> Iterator[Side]:
        """Return the sides of ``count`` copies of the path, which are followed at once."""
        repeated = np.zeros(count, dtype=np.intp)
        place = self._fragments.place[repeated]
        level = self._level[repeated]
        return self._summing.sides(place, level, self._base[repeated])

    def _path(self, sides: list[Side], knots: Floats, samples: Floats) -> tuple[Floats, Floats]:
        """Return lags in multiples of the unit, and points, of the whole path with its samples."""
        number = np.arange((len(knots) - 1) * POINTS_BETWEEN_SLICES + 1)
        fine = np.interp(number / POINTS_BETWEEN_SLICES, range(len(knots)), knots)
        lags = [np.zeros(1)]
        displacements = [np.zeros((1, 3))]
        for side, copies in zip(sides, self._sides(len(fine) + 1), strict=True):
            end = max(float(np.clip(side.reach[0], 0.0, knots[-1])), *(-side.sign * samples))
            lag = np.unique([*fine[fine < end], end])[1:]
            padded_lag = np.zeros(len(fine) + 1)
            padded_lag[: len(lag)] = lag
            moved = copies.path.follow(padded_lag)[: len(lag)] * (side.sign * side.scale[0])
            lags.append(-side.sign * lag)
            displacements.append(moved)
        lag = np.concatenate(lags)
        order = np.argsort(-lag)
        return lag[order], self._points(np.concatenate(displacements)[order])

    def _points(self, displacement: Floats) -> Floats:
        """Return points in space of displacements (N, 3)."""
        geometry = self._textures.geometry
        image = self._textures.image
        place = self._fragments.image
        # Relative to the place in double precision, as renderers have the nodes in single.
        start = self._field_values.position
        surface = geometry.field.surface
        if image is None or place is None:
            return np.asarray(start + displacement @ geometry.frame)
        first, index = map(image.index, (place.value, place.value + displacement[:, :2]))
        return start + surface.at(index) - surface.at(first)


def cover_place(
    surface: Surface, place: SurfacePoint, camera: Camera, size: tuple[int, int]
) -> Coverage:
    """Return the coverage of one place, also where it is hidden.

    The pixel is one of a picture of some width and height in pixels.

    Raises
    ------
    FieldError
        When the place is behind the camera, or its triangle is seen edge-on.
    """
    points = surface.points.reshape(-1, 3)[place.nodes] - surface.center
    matrix = camera.matrix(size[0] / size[1], surface.center)
    clip = points @ matrix[:, :3].T + matrix[:, 3]
    x, y, _, w = place.weights @ clip
    # Derivatives of pixels to the right and down by the shares of the corners.
    pixels = np.array(size) * [0.5, -0.5]
    by_share = (clip[:, :2] - clip[:, 3:] * [x / w, y / w]) * pixels / w
    # The shares sum to one, so two of them are free.
    free = by_share[1:] - by_share[0]
    if not (w > 0 and abs(np.linalg.det(free)) > 1e-12 * np.abs(free).max() ** 2):
        raise FieldError(
            f"(j, i) = {place.index} is behind the camera or in a triangle that is seen edge-on; "
            "expected a camera that sees this point"
        )
    inverse = np.linalg.inv(free)
    shares = np.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)
    first = np.zeros(1, dtype=np.intp)
    nodes = place.nodes[None]
    weights = place.weights[None]
    cell = np.array([place.cell])
    return Coverage(first, nodes, weights, shares[:1], shares[1:], cell)


def camera_facing(surface: Surface, place: SurfacePoint, pixel: float) -> Camera:
    """Return the camera that looks straight at a place, for a picture of one pixel.

    Raises
    ------
    FieldError
        When the width of the pixel, in the mesh's units, is not positive, or the triangle has no
        area.
    """
    if not 0 < pixel < np.inf:
        raise FieldError(
            f"pixel is {brief(pixel)}; expected a positive length in the mesh's units, or a Camera"
        )
    a, b, c = surface.points.reshape(-1, 3)[place.nodes]
    normal = np.cross(b - a, c - a)
    length = float(np.linalg.norm(normal))
    if not length > 0:
        msg = f"the triangle at (j, i) = {place.index} has no area; expected a point in another "
        raise FieldError(msg + "triangle")
    focus = place.weights @ np.stack([a, b, c])
    up = max((b - a, c - a), key=lambda side: float(np.linalg.norm(side)))
    return Camera(
        position=tuple(focus + normal / length * surface.extent),
        focal_point=tuple(focus),
        up=tuple(up),
        parallel=True,
        parallel_scale=0.5 * float(pixel),
    )


class Recorder(Lookup):
    """Records the arguments and the values of another look-up, for one fragment.

    In place of the values it returns rows of zeros with a one at the number of the sample, of at
    most so many, so that their weighted sums are the weights: shares of the samples in the mean,
    (K,), once all are summed. The noise is the texture from each sample alone, (K,) or (K, 4), and
    the gain a factor of its mean.
    """

    def __init__(self, inner: Lookup, most_samples: int) -> None:
        self.inner = inner
        self.spacing = inner.spacing
        self.level = inner.level
        #: Arguments of the look-up, sample by sample, (1, 3) and (1,).
        self.displacement: list[Floats] = []
        self.length: list[Floats] = []
        self._values: list[Floats] = []
        self._rows = np.eye(most_samples)

    def move(self, slope: Floats, speed: Floats) -> None:
        """Pass on to the inner look-up."""
        self.inner.move(slope, speed)

    def face(self, tangent: Floats) -> DrawnGrains:
        """Pass on to the inner look-up."""
        grains = self.inner.face(tangent)
        self.spacing = self.inner.spacing
        self.level = self.inner.level
        return grains

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Record the arguments and the value, and return the number of the sample as a row."""
        self.displacement.append(displacement)
        self.length.append(length)
        self._values.append(self.inner.lookup(displacement, length))
        return np.asarray(self._rows[[len(self._values) - 1]])

    def blend(self, sums: Sums) -> Floats:
        """Blend the values, summed with the weights."""
        blend = self.inner.blend
        values = np.concatenate(self._values)
        count = len(values)
        weights = sums.values[:, : len(values)]
        total = float(weights.sum())
        self.weights = weights[0] / total
        # A single sample is a sum of one; a sum of ones has the factor of the mean.
        self.noise = blend(Sums(values, np.ones(count), np.zeros(count)))
        ones = np.ones_like(values[:1])
        mean = blend(Sums(total * ones, sums.squares, sums.neighbours))
        self.gain = float(mean.flat[0] / blend(Sums(ones, np.ones(1), np.zeros(1))).flat[0])
        return np.asarray(blend(Sums(weights @ values, sums.squares, sums.neighbours)))


class LoadedTextures:
    """A texture set as the renderer reads it, for pixels that are drawn one after the other."""

    def __init__(self, make_lookup: LookupMaker) -> None:
        self.make_lookup = make_lookup
        self._mips: dict[int, Mips] = {}

    @classmethod
    def of(cls, textures: TextureSet) -> LoadedTextures:
        """Return the loaded form of a texture set, which lives as long as the set."""
        return _loaded.get("loaded", lambda: cls(lookup_maker(textures)), owner=textures)

    def mips(self, textures: TextureSet, step: int) -> Mips:
        """Slice texture of one destination time; those of the last two times are cached."""
        if step not in self._mips:
            while len(self._mips) > 1:
                del self._mips[next(iter(self._mips))]
            self._mips[step] = Mips(textures.layers(step), levels=textures.geometry.levels)
        return self._mips[step]


_loaded: WeakCache[LoadedTextures] = WeakCache()


def _shown(value: Any, faded: Floats) -> tuple[float | Floats, float]:
    """Return a value of the texture, and its share of the contrast; colours have all of it."""
    if np.ndim(value) == 0:
        return float(value), float(faded[0])
    return np.asarray(value), 1.0
