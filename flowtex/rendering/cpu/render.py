"""Textures, settings and a camera to a picture, by the same method as the shaders."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import AnyArray, Bools, Bytes, Floats, Indices
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.even import local_mean
from flowtex.rendering.cpu.fragments import Fragments, level_colour, slice_level
from flowtex.rendering.cpu.mipmaps import Mips
from flowtex.rendering.cpu.noise import ImageLookup, ImageMips, SpaceNoise
from flowtex.rendering.cpu.noise_texture import NoiseImages
from flowtex.rendering.cpu.path import AxisSlices, Slices, TriangleSlices
from flowtex.rendering.cpu.raster import cover
from flowtex.rendering.cpu.shade import paint, shade
from flowtex.rendering.cpu.texture import LookupMaker, Summing
from flowtex.rendering.uniforms import Values, ViewState, uniforms
from flowtex.settings import Settings
from flowtex.textures.noise_textures import NoiseTextures
from flowtex.textures.texture_set import TextureSet

PART = 1 << 14  #: Fragments that are drawn together, so few that their arrays stay in the cache.


@dataclass(frozen=True, eq=False)
class Picture:
    """A flow texture as numbers, row 0 at the top; NaN where there is no surface."""

    #: The texture before it is laid over a colour, (H, W), of mean zero and of deviation one. For
    #: an image instead of noise, its mean colours times opacity, and opacity, (H, W, 4).
    value: Floats
    covered: Bools  #: Pixels that show the surface, (H, W).
    #: Texture coordinates (u, v) in the slices, (H, W, 2); of triangles the shares of the second
    #: and the third corner.
    coordinate: Floats
    nearest: Indices  #: Number of the node that has the greatest share, (H, W).
    cell: Indices  #: Place of the cell in scalars of cells, (H, W).
    position: Floats  #: Points of the mesh, in its own coordinates, (H, W, 3).
    slice_level: Floats  #: Mip level of the slices, and level of detail of the noise, (H, W).
    noise_level: Floats
    settings: Settings  #: Settings of the picture.

    def rgb(
        self, colour: ArrayLike = (0.627, 0.627, 0.627), background: ArrayLike = (1.0, 1.0, 1.0)
    ) -> Bytes:
        """Colour the picture, without lights; the surface by one colour or (H, W, 3), 0 to 1."""
        shape = (*self.covered.shape, 3)
        below = np.broadcast_to(np.asarray(colour, dtype=float), shape)[self.covered]
        if self.settings.show_level:
            below = level_colour(self.noise_level[self.covered])
        lay: Callable[..., Floats] = paint
        if self.value.ndim == 2:
            lay = shade
        result = np.full(shape, background, dtype=float)
        result[self.covered] = lay(below, self.value[self.covered], self.settings)
        return np.rint(result * 255.0).astype(np.uint8)


def render(
    textures: TextureSet,
    settings: Settings,
    camera: Camera,
    size: tuple[int, int],
    *,
    view: ViewState | None = None,
    steps: tuple[int, int] = (0, 0),
    lookup: LookupMaker | None = None,
) -> Picture:
    """Draw a flow texture with NumPy: slowly, in double precision, for any camera.

    It uses the formula, uniforms and half-precision textures of the shaders, so it is the reference
    for other renderers. The size is in pixels. ``view.between`` interpolates between the two
    destination ``steps``. ``lookup`` replaces the noise.
    """
    values = uniforms(textures, settings, view_state(textures, camera, view or ViewState(), steps))
    # The local mean of other values than the noise belongs to them.
    values["u_even"] &= lookup is None
    coverage = cover(textures.geometry.field.surface, camera, size)
    fragments = Fragments.of(textures, coverage)
    level = slice_level(fragments.coordinate, values)
    slices = slices_at(textures, steps, values)
    make = lookup or lookup_maker(textures)
    value = [np.zeros((0,))]
    noise_level = [np.zeros(0)]
    share = [np.zeros(0)]
    for selection, part in fragments.parts(PART):
        part_lookup = make(part, values)
        summing = Summing(slices, values, part_lookup, by_lag=textures.image is not None)
        texture, factor = summing.shares(part.place, level[selection], part.by)
        value.append(texture)
        if textures.image is None:
            factor = factor * part.rim(np.asarray(values["u_eye"]))
        share.append(factor)
        noise_level.append(part_lookup.level)
    image = partial(_image, pixel=coverage.pixel, size=size)
    texture = image(np.concatenate(value[1:] or value))
    if values["u_even"]:
        texture -= local_mean(texture, values["u_grain"])
    if texture.ndim == 2:  # an image keeps its colours
        texture *= image(np.concatenate(share))
    geometry = textures.geometry
    points = (geometry.field.surface.points - geometry.center).reshape(-1, 3)
    return Picture(
        value=texture,
        covered=np.isfinite(image(level)),
        coordinate=image(fragments.coordinate.value),
        nearest=np.nan_to_num(image(coverage.nearest)).astype(np.intp),
        cell=np.nan_to_num(image(coverage.cell)).astype(np.intp),
        position=image(coverage.mix(points)[0] + geometry.center),
        slice_level=image(level),
        noise_level=image(np.concatenate(noise_level)),
        settings=settings.copy(),
    )


def view_state(
    textures: TextureSet, camera: Camera, view: ViewState, steps: tuple[int, int]
) -> ViewState:
    """Return the state of the view with the focus, eye and time of a camera and steps."""
    first, last = textures.store.field.times[list(steps)]
    time = float(first + view.between * (last - first))
    focus = np.asarray(camera.focal_point, dtype=float)
    return replace(view, focus=focus, eye=camera.eye, time=time)


def slices_at(
    textures: TextureSet,
    steps: tuple[int, int],
    values: Values,
    mips: Callable[[TextureSet, int], Mips] = lambda textures, step: Mips(
        textures.layers(step), levels=textures.geometry.levels
    ),
) -> Slices:
    """Return the slice texture between two destination times; ``mips`` may cache them."""
    before = mips(textures, steps[0])
    uncertain = bool(textures.geometry.field.uncertainty)
    if textures.geometry.field.sign_free:
        size = values["u_slicesSize"]
        lags = values["u_lagCount"]
        return AxisSlices(before, uncertain=uncertain, size=size, lags=lags)
    if textures.geometry.field.triangles is None:
        kind = Slices
    else:
        kind = TriangleSlices
    if steps[0] == steps[1]:
        after = None
    else:
        after = mips(textures, steps[1])
    return kind(before, after, values["u_between"], uncertain=uncertain)


def lookup_maker(textures: TextureSet) -> LookupMaker:
    """Return the look-up of the noise, or of the textures' image."""
    image = textures.image
    planar = textures.geometry.planar
    if image is None:
        return lambda fragments, values: SpaceNoise(fragments, values, planar=planar)
    if isinstance(image, NoiseTextures):
        return NoiseImages(image).lookup
    mips = ImageMips(image)
    return lambda fragments, values: ImageLookup(fragments, values, mips)


def _image(data: AnyArray, pixel: Indices, size: tuple[int, int]) -> Floats:
    """Lay data (N, ...) of pixels (N,) into an image (H, W, ...), NaN elsewhere."""
    width, height = size
    result = np.full((height * width, *data.shape[1:]), np.nan)
    result[pixel] = data
    return result.reshape(height, width, *data.shape[1:])
