"""Single pixels, drawn one after the other, with all the samples that make them."""

from __future__ import annotations

import numpy as np

from flowtex._util.arguments import brief
from flowtex._util.array_types import AnyArray, Floats, Indices
from flowtex._util.cache import WeakCache
from flowtex.errors import FieldError
from flowtex.field import Surface
from flowtex.field.locate import SurfacePoint
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.mipmaps import Mips
from flowtex.rendering.cpu.raster import Coverage
from flowtex.rendering.cpu.render import lookup_maker
from flowtex.rendering.cpu.texture import Lookup, LookupMaker, Sums
from flowtex.textures.texture_set import TextureSet


def cover_place(
    surface: Surface, place: SurfacePoint, camera: Camera, size: tuple[int, int]
) -> Coverage:
    """Return the coverage of one place, also where it is hidden.

    The pixel is one of a picture of some width and height in pixels. Raises a FieldError when the
    place is behind the camera, or its triangle is seen edge on.
    """
    points = surface.points.reshape(-1, 3)[place.nodes] - surface.center
    matrix = camera.matrix(size[0] / size[1], surface.center)
    clip = points @ matrix[:, :3].T + matrix[:, 3]
    x, y, _, w = place.weights @ clip
    if not w > 0:
        msg = f"(j, i) = {place.index} is behind the camera at {camera.position}; expected a "
        raise FieldError(msg + "camera that sees this point")
    # Derivatives of pixels to the right and down by the shares of the corners.
    pixels = np.array(size) * [0.5, -0.5]
    by_share = (clip[:, :2] - clip[:, 3:] * [x / w, y / w]) * pixels / w
    # The shares sum to one, so two of them are free.
    free = by_share[1:] - by_share[0]
    if not abs(np.linalg.det(free)) > 1e-12 * np.abs(free).max() ** 2:
        msg = f"the triangle at (j, i) = {place.index} is seen edge-on; expected a visible triangle"
        raise FieldError(msg)
    inverse = np.linalg.inv(free)
    shares = np.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)
    first = np.zeros(1, dtype=np.intp)
    nodes, weights, cell = place.nodes[None], place.weights[None], np.array([place.cell])
    return Coverage(first, nodes, weights, shares[:1], shares[1:], cell)


def camera_facing(surface: Surface, place: SurfacePoint, pixel: float) -> Camera:
    """Return the camera that looks straight at a place, for a picture of one pixel.

    Raises a FieldError when the width of the pixel, in the mesh's units, is not positive, or the
    triangle has no area.
    """
    if not 0 < pixel < np.inf:
        msg = (
            f"pixel is {brief(pixel)}; expected a positive length in the mesh's units, or a Camera"
        )
        raise FieldError(msg)
    a, b, c = surface.points.reshape(-1, 3)[place.nodes]
    normal = np.cross(b - a, c - a)
    length = float(np.linalg.norm(normal))
    if not length > 0:
        msg = (
            f"the triangle at (j, i) = {place.index} has no area; expected a point in another "
            "triangle"
        )
        raise FieldError(msg)
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
        self.inner, self.spacing, self.level = inner, inner.spacing, inner.level
        #: Arguments of the look-up, sample by sample, (1, 3) and (1,).
        self.displacement: list[Floats] = []
        self.length: list[Floats] = []
        self._values: list[Floats] = []
        self._rows = np.eye(most_samples)

    def move(self, slope: Floats, speed: Floats) -> None:
        """Pass on to the inner look-up."""
        self.inner.move(slope, speed)

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Record the arguments and the value, and return the number of the sample as a row."""
        self.displacement.append(displacement)
        self.length.append(length)
        self._values.append(self.inner.lookup(displacement, length))
        return np.asarray(self._rows[[len(self._values) - 1]])

    def blend(self, sums: Sums) -> Floats:
        """Blend the values, summed with the weights."""
        blend, values = self.inner.blend, np.concatenate(self._values)
        count, weights = len(values), sums.values[:, : len(values)]
        total = float(weights.sum())
        self.weights = weights[0] / total
        # A single sample is a sum of one; a sum of ones has the factor of the mean.
        self.noise = blend(Sums(values, np.ones(count), np.zeros(count)))
        ones = np.ones_like(values[:1])
        mean = blend(Sums(total * ones, sums.squares, sums.neighbours))
        self.gain = float(mean.flat[0] / blend(Sums(ones, np.ones(1), np.zeros(1))).flat[0])
        return np.asarray(blend(Sums(weights @ values, sums.squares, sums.neighbours)))


class Window(Mips):
    """A slice texture (layers, H, W, C) of which only the part around one place is filtered.

    H and W are multiples of the coarsest level's block.
    """

    def __init__(self, texels: AnyArray, levels: int) -> None:
        self._texture, self._last, self._block = texels, levels, 2**levels
        self._window: tuple[int, ...] = ()

    @property
    def levels(self) -> int:
        """Mip levels besides the finest."""
        return self._last

    def at(self, coordinate: Floats, level: Floats, layer: int | Indices = 0) -> Floats:
        """Look up texels less than a block from each other, as :meth:`Mips.at` does."""
        size = np.array(self._texture.shape[2:0:-1])
        # Filtering reaches one block of the coarsest level far.
        block = np.floor(coordinate[0] * size / self._block).astype(int)
        low = np.clip(block - 1, 0, size // self._block - 1) * self._block
        high = np.clip(block + 2, 1, size // self._block) * self._block
        if self._window != (*low, *high):
            part = self._texture[:, low[1] : high[1], low[0] : high[0]]
            super().__init__(part, levels=self._last)
            self._window = (*low, *high)
        return super().at((coordinate * size - low) / (high - low), level, layer)


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
            levels, layers = textures.geometry.levels, textures.layers(step)
            mips = Window(layers, levels) if levels else Mips(layers, levels=0)
            self._mips[step] = mips
        return self._mips[step]


_loaded: WeakCache[LoadedTextures] = WeakCache()
