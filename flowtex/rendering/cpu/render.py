"""From textures, settings and a camera to a picture, by the same method as the shaders."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex.rendering.cpu.camera import Camera
from flowtex.rendering.cpu.cover import cover
from flowtex.rendering.cpu.fragments import Fragments
from flowtex.rendering.cpu.levels import slice_level
from flowtex.rendering.cpu.lookup import Mips
from flowtex.rendering.cpu.lookup_paper import PaperImages, PaperNoise, PaperPicture
from flowtex.rendering.cpu.lookup_space import SpaceNoise
from flowtex.rendering.cpu.path import SignFreeSlices, Slices
from flowtex.rendering.cpu.picture import Picture
from flowtex.rendering.cpu.raster import Coverage
from flowtex.rendering.cpu.texture import Lookup, LookupMaker, Summing
from flowtex.rendering.uniforms import ViewState, uniforms
from flowtex.settings import Settings
from flowtex.textures import TextureSet

__all__ = ["maker_of", "mips_of", "render", "slices_at", "view_state"]


#: Fragments that are followed together: what a sample needs of them stays in the cache.
PART = 1 << 14


def render(
    textures: TextureSet,
    settings: Settings,
    camera: Camera,
    *,
    view: ViewState | None = None,
    steps: tuple[int, int] = (0, 0),
    lookup: LookupMaker | None = None,
) -> Picture:
    """Draw a flow texture with NumPy: slowly, in double precision, for any camera.

    It is the same formula as the shaders in ``shaders/common``, with the same uniforms and the
    same half-precision textures, so a picture of another renderer can be judged by it.

    Parameters
    ----------
    textures
        What to draw.
    settings
        How to draw it.
    camera
        From where. The digits of the noise are counted from its focal point.
    view
        How far the time is from one of the steps to the other, and the clock. The focus and the
        eye are those of the camera, and the time follows from the steps.
    steps
        The two destination times of the slices that ``view.between`` lies between.
    lookup
        What is summed along the paths instead of the noise, such as :func:`smooth` makes.

    Returns
    -------
    Picture
    """
    values = uniforms(textures, settings, view_state(textures, camera, view or ViewState(), steps))
    coverage = cover(textures.geometry.field.surface, camera)
    fragments = Fragments.of(textures, coverage)
    level = slice_level(fragments.coordinate, values)
    slices = slices_at(textures, steps, values)
    make = lookup or maker_of(textures)
    value, noise_level = [np.zeros((0,))], [np.zeros(0)]
    for some, part in fragments.parts(PART):
        found = make(part, values)
        summing = Summing(slices, values, found, paper=textures.paper is not None)
        value.append(summing.texture(part.coordinate.value, level[some]))
        noise_level.append(found.level)
    image = _Image(camera.size, coverage)
    geometry = textures.geometry
    points = (geometry.field.surface.points - geometry.center).reshape(-1, 3)
    return Picture(
        value=image(np.concatenate(value[1:] or value)),
        covered=image.covered,
        coordinate=image(fragments.coordinate.value),
        position=image(coverage.mix(points)[0] + geometry.center),
        slice_level=image(level),
        noise_level=image(np.concatenate(noise_level)),
        settings=settings.copy(),
    )


def view_state(
    textures: TextureSet, camera: Camera, view: ViewState, steps: tuple[int, int]
) -> ViewState:
    """State of the view, with what the camera and the steps decide."""
    first, last = textures.store.field.times[list(steps)]
    time = float(first + view.between * (last - first))
    focus = np.asarray(camera.focal_point, dtype=float)
    return replace(view, focus=focus, eye=camera.eye, time=time)


def mips_of(textures: TextureSet, step: int) -> Mips:
    """Slice texture of one destination time, with its mip levels."""
    return Mips(textures.layers(step), levels=textures.geometry.levels)


def slices_at(
    textures: TextureSet,
    steps: tuple[int, int],
    values: Mapping[str, Any],
    mips: Callable[[TextureSet, int], Mips] = mips_of,
) -> Slices:
    """Slice texture between two destination times; ``mips`` may keep what it returns."""
    before = mips(textures, steps[0])
    if textures.geometry.field.sign_free:
        return SignFreeSlices(before, size=values["u_slicesSize"], lags=values["u_lagCount"])
    if steps[0] == steps[1]:
        return Slices(before)
    return Slices(before, mips(textures, steps[1]), values["u_between"])


def maker_of(textures: TextureSet) -> LookupMaker:
    """Look-up of the noise, or of the picture, that the textures were made for."""
    paper, planar = textures.paper, textures.geometry.planar
    if paper is None:
        return lambda fragments, values: SpaceNoise(fragments, values, planar=planar)
    images = PaperImages(paper)
    kind = PaperPicture if paper.picture else PaperNoise

    def make(fragments: Fragments, values: Mapping[str, Any]) -> Lookup:
        if fragments.noise is None:
            msg = "the fragments have no noise coordinates; expected those of a noise texture"
            raise ValueError(msg)
        return kind(fragments.noise, images, values)

    return make


class _Image:
    """Lays what the fragments have into an image."""

    def __init__(self, size: tuple[int, int], coverage: Coverage) -> None:
        self._width, self._height = size
        self._pixel = coverage.pixel

    @property
    def covered(self) -> Bools:
        """Pixels that have a fragment, (H, W)."""
        return ~np.isnan(self(np.zeros(len(self._pixel))))

    def __call__(self, data: Floats) -> Floats:
        """Image (H, W, ...) of data (N, ...), NaN elsewhere."""
        result = np.full((self._height * self._width, *data.shape[1:]), np.nan)
        result[self._pixel] = data
        return result.reshape(self._height, self._width, *data.shape[1:])
