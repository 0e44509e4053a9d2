"""A user's image in place of the noise, and the step size of the paths through it.

Texels are colours times opacity, and opacity, so that dye has clean edges at every level of detail.
The image lies on the parameters of the surface; its coordinates grow with the mean length of the
grid lines. The step texture holds, for every texel, the lag in which the flow crosses it. Level n
of it counts 2^n times as much, because its texels are twice as wide at every level.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import AnyArray, Bytes, Floats, Floats32
from flowtex.field import FlowField
from flowtex.field.interpolation import along_line, between_nodes, fill_blanked, inverse_along_line
from flowtex.settings import SettingsError
from flowtex.trace.store import SliceStore

if TYPE_CHECKING:
    from PIL.Image import Image

LARGEST = 4096  #: Most texels along a side; a larger image is averaged to fit.
SLACK = 1e-3  #: Rounding by which a float may lie outside 0 to 1.

LONGEST_STEP = 6e4  #: Longest step in units of lag: half precision ends soon after.
STEP_TEXELS = 1024  #: Texels of the step texture along the longer side of the surface.

SHAPES = "(H, W) for grey, (H, W, 3) for colours, or (H, W, 4) with opacity"


class ImageError(SettingsError):
    """An image cannot be used instead of the noise; the text says what was expected.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.render(flowtex.examples.airfoil_field(), image="missing.png")
    Traceback (most recent call last):
    flowtex.textures.images.ImageError: ...
    """


def as_picture(image: Any) -> Floats32:
    """Check an image and return its texels, (h, w, 4): colours times opacity, and opacity.

    The image is grey (H, W), colours (H, W, 3) or colours and opacity (H, W, 4), row 0 at the top:
    whole numbers without sign, floats from 0 to 1, or booleans. Row 0 of the texels is the bottom.
    There are no more than :data:`LARGEST` on a side.

    Raises
    ------
    ImageError
        When the image has another shape or type, is empty, or has values outside of 0 to 1.
    """
    try:
        array = np.asarray(image)
    except ValueError as error:
        raise ImageError(f"the image is not an array ({error}); expected {SHAPES}") from error
    if array.ndim not in (2, 3) or (array.ndim == 3 and array.shape[-1] not in (3, 4)):
        raise ImageError(f"the image has shape {array.shape}; expected {SHAPES}")
    if array.size == 0:
        raise ImageError(f"the image is empty, of shape {array.shape}; expected at least one pixel")
    values = _fractions(array).reshape(*array.shape[:2], -1)
    channels = values.shape[-1]
    picture = np.ones((*values.shape[:2], 4), np.float32)
    picture[..., :3] = values[..., :3]  # one channel is grey
    if channels == 4:
        picture[..., 3] = values[..., 3]
        picture[..., :3] *= picture[..., 3:]
    return np.ascontiguousarray(_shrunk(picture)[::-1])


def as_image(picture: Floats32) -> Floats32:
    """Return the image (h, w, 4), row 0 at the top, that :func:`as_picture` made into texels."""
    image = np.array(picture[::-1])
    opaque = image[..., 3:] > 0
    np.divide(image[..., :3], image[..., 3:], out=image[..., :3], where=opaque)
    return np.asarray(np.clip(image, 0, 1), np.float32)


def _fractions(array: AnyArray) -> Floats32:
    """Return values from 0 to 1."""
    if array.dtype.kind == "b":
        return array.astype(np.float32)
    if array.dtype.kind == "u":
        return array.astype(np.float32) / np.float32(np.iinfo(array.dtype).max)
    if array.dtype.kind != "f":
        raise ImageError(f"the image holds {array.dtype}; expected uint8, or floats from 0 to 1")
    bad = int((~np.isfinite(array)).sum())
    if bad:
        raise ImageError(
            f"the image has {bad} values that are NaN or infinite; replace them, for example by 0"
        )
    low = float(array.min())
    high = float(array.max())
    if low < -SLACK or high > 1 + SLACK:
        raise ImageError(
            f"the image's floats range from {low:g} to {high:g}; expected 0 to 1, or uint8"
        )
    return np.asarray(np.clip(array, 0, 1), np.float32)


def _shrunk(values: Floats32) -> Floats32:
    """Average blocks of texels so that the image fits."""
    block = -(-max(values.shape[:2]) // LARGEST)
    if block == 1:
        return values
    for axis in (0, 1):
        starts = np.arange(0, values.shape[axis], block)
        counts = np.diff(np.append(starts, values.shape[axis])).astype(np.float32)
        shape = [1, 1, 1]
        shape[axis] = -1
        sums = np.add.reduceat(values, starts, axis=axis)
        values = np.asarray(sums / counts.reshape(shape), np.float32)
    return values


def averaged(pixels: Bytes, times: int) -> Bytes:
    """Average every ``times`` x ``times`` pixels of a supersampled picture, (H, W, ...)."""
    if times == 1:
        return pixels
    from PIL import Image

    return np.asarray(Image.fromarray(pixels).reduce(times))


def load_image(image: Any) -> Any:
    """Read an image (H, W, 1 to 4) when it is a path, row 0 at the top; anything else stays.

    Raises
    ------
    ImageError
        When the path is no file or no readable image, or the image has too many pixels.
    """
    if not isinstance(image, (str, Path)):
        return image
    path = Path(image).expanduser()
    if not path.is_file():
        if path.is_dir():
            problem = "is a folder"
        else:
            problem = "the file does not exist"
        raise ImageError(f"{image}: {problem}; expected a picture, such as a PNG or a JPEG")
    from PIL import Image, ImageOps

    try:
        # Pillow warns of a picture so large that it may be an attack, and refuses twice as large.
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(path) as opened:
                return pixels_of(ImageOps.exif_transpose(opened))
    except (Image.DecompressionBombWarning, Image.DecompressionBombError) as error:
        raise ImageError(
            f"{path}: has more than {Image.MAX_IMAGE_PIXELS:,} pixels; make it smaller"
        ) from error
    except (OSError, SyntaxError) as error:  # Pillow raises either for a file cut short
        raise ImageError(
            f"{path}: the picture cannot be read ({error}); expected one such as a PNG or a JPEG"
        ) from error


def pixels_of(picture: Image) -> AnyArray:
    """Return pixels, with opacity where the picture has any; grey keeps its 16 bits."""
    if picture.mode.startswith("I"):  # 16 bits, which some versions of Pillow hold in 32
        return np.asarray(picture).astype(np.uint16)
    if picture.mode == "F":
        return np.asarray(picture)
    if "A" in picture.getbands() or "transparency" in picture.info:
        return np.asarray(picture.convert("RGBA"))
    return np.asarray(picture.convert("RGB"))


@dataclass(frozen=True, eq=False)
class ImageTextures:
    """An image over the parameters of a surface, and the step size with it."""

    texels: Floats32  #: Texels as from :func:`as_picture`, (H, W, 4); row 0 is at j = 0.
    step: Floats32  #: Lag in which the flow crosses a texel of this texture, in units.
    along_i: Floats  #: Image coordinates of the lines of nodes, (I,) and (J,), from 0 to 1.
    along_j: Floats
    repeat: tuple[bool, bool]  #: Whether the surface goes around along (v, u).

    @classmethod
    def build(cls, store: SliceStore, texels: Floats32, size: int = STEP_TEXELS) -> ImageTextures:
        """Lay an image on the surface of a flow, with a step texture of a size."""
        field = store.field
        along_i, along_j = lines = coordinates(field)
        step = steps_of(store, *texel_places(field, lines, size))
        return cls(texels, step, along_i, along_j, field.periodic)

    @property
    def repeated(self) -> tuple[bool, bool]:
        """Whether the texels are repeated along (v, u): an image always is."""
        return True, True

    @property
    def is_noise(self) -> bool:
        """Whether the texels are noise instead of colours."""
        return False

    @property
    def coordinate(self) -> Floats32:
        """Image coordinates of the nodes, (J, I, 2)."""
        return np.stack(np.meshgrid(self.along_i, self.along_j), axis=-1).astype(np.float32)

    def at(self, index: Floats) -> Floats:
        """Return image coordinates of positions in index space, (..., 2), linear beyond ends."""
        return self._by_axis(along_line, index)

    def index(self, coordinate: Floats) -> Floats:
        """Return positions in index space of image coordinates, (..., 2), inverse to :meth:`at`."""
        return self._by_axis(inverse_along_line, coordinate)

    def _by_axis(self, function: Callable[..., Floats], places: Floats) -> Floats:
        i = function(self.along_i, places[..., 0], periodic=self.repeat[1])
        j = function(self.along_j, places[..., 1], periodic=self.repeat[0])
        return np.stack([i, j], axis=-1)

    def by_cell(self) -> Floats:
        """Return derivatives of the image coordinates by index at the nodes, (J, I, 2)."""
        slopes = np.meshgrid(np.gradient(self.along_i), np.gradient(self.along_j))
        return np.stack(slopes, axis=-1)


def coordinates(field: FlowField, *, even: bool = True) -> tuple[Floats, Floats]:
    """Return the image coordinates of the lines of nodes, by mean length if ``even``."""
    p_i, p_j = np.linalg.norm(field.surface.tangents, axis=-1)
    lines = []
    for lengths in (p_i.mean(axis=0), p_j.mean(axis=1)):
        steps = (lengths[1:] + lengths[:-1]) / 2
        if not (even and steps.any()):
            steps = np.ones(len(steps))
        ends = np.concatenate([[0.0], np.cumsum(np.maximum(steps, 1e-9 * steps.max()))])
        lines.append(ends / ends[-1])
    return lines[0], lines[1]


def texel_places(
    field: FlowField, lines: tuple[Floats, Floats], size: int
) -> tuple[Floats, Floats]:
    """Return positions in index space and sizes in cells, (H, W, 2), of texels."""
    cell_lengths = np.linalg.norm(field.surface.tangents, axis=-1)[:, field.valid].mean(axis=1)
    lengths = cell_lengths * np.subtract(field.shape[::-1], 1)
    shares = np.maximum(lengths / np.max(lengths), 1 / 8) * size
    counts = (2 ** np.ceil(np.log2(np.maximum(shares, 8)))).astype(int).tolist()
    middles = []
    for line, count in zip(lines, counts, strict=True):
        texels = (np.arange(count) + 0.5) / count
        middles.append(np.interp(texels, line, np.arange(len(line))))
    index = np.stack(np.meshgrid(*middles), axis=-1)
    cells = np.empty_like(index)
    for axis, (line, count) in enumerate(zip(lines, counts, strict=True)):
        cell = np.clip(index[..., axis].astype(np.intp), 0, len(line) - 2)
        cells[..., axis] = 1 / (np.diff(line)[cell] * count)
    return index, cells


def steps_of(store: SliceStore, index: Floats, texel: Floats) -> Floats32:
    """Return the lag in which the flow crosses texels of a size in cells (equation 3)."""
    field = store.field
    speed = np.abs(field.index_velocity.components).max(axis=0)
    if store.parameter == "arclength":
        # Cells crossed in a unit of length; nodes at rest take the value of the nearest node.
        pace = field.index_velocity.speed[0]
        moving = field.valid & (pace > 1e-7 * pace.max())
        by_length = speed / np.where(moving, pace, 1.0)[..., None]
        if moving.any():
            speed = fill_blanked(by_length, moving)
        else:
            speed = np.zeros_like(speed)
    speed = speed * store.unit[..., None]
    along_i = between_nodes(speed[..., 0], index)
    along_j = between_nodes(speed[..., 1], index)
    crossed = np.stack([along_i, along_j], axis=-1) / texel
    steps = 1 / np.maximum(crossed.max(axis=-1), 1 / float(store.lags[-1]))
    return np.asarray(np.minimum(steps, LONGEST_STEP), np.float32)
