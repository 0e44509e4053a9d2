"""A user's image as texels that a shader can average: colour times opacity, and opacity.

Averages of colours that were multiplied by their opacity keep the colour of a transparent pixel out
of its neighbours, so dye has clean edges at every level of detail. Files are PNG, JPEG and all
others that Pillow, which comes with PyVista, can read.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import AnyArray, Bytes, Floats32
from flowtex.settings import SettingsError

if TYPE_CHECKING:
    from PIL.Image import Image

#: Most texels along a side; a larger image is averaged to fit.
LARGEST = 4096
#: Rounding by which a float may lie outside 0 to 1.
SLACK = 1e-3

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
    """Check an image and return its texels.

    It is grey (H, W), colours (H, W, 3) or colours and opacity (H, W, 4), row 0 at the top: whole
    numbers without sign from 0 to their greatest, floats from 0 to 1, or booleans. Raises an
    ImageError for another array, an empty one, NaN, and values out of range.

    Texels are (h, w, 4) in single precision: red, green and blue times opacity, and opacity, from 0
    to 1. Row 0 is the bottom, as j grows upward. There are no more than :data:`LARGEST` on a side.
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
    picture[..., :3] = values[..., :3] if channels > 1 else values
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
    low, high = float(array.min()), float(array.max())
    if low < -SLACK or high > 1 + SLACK:
        raise ImageError(
            f"the image's floats range from {low:g} to {high:g}; expected 0 to 1: divide by the "
            "maximum, or pass uint8"
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
    """Read an image (H, W, 1 to 4) when it is a path, row 0 at the top; anything else stays."""
    if not isinstance(image, (str, Path)):
        return image
    path = Path(image).expanduser()
    if not path.is_file():
        problem = "is a folder" if path.is_dir() else "the file does not exist"
        raise ImageError(f"{image}: {problem}; expected a picture, such as a PNG or a JPEG")
    from PIL import Image, ImageOps, UnidentifiedImageError

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
    except UnidentifiedImageError as error:
        raise ImageError(
            f"{path}: the picture cannot be read; expected a format such as PNG or JPEG"
        ) from error
    except (OSError, SyntaxError) as error:  # Pillow raises either for a file cut short
        raise ImageError(
            f"{path}: cannot be read ({error}); pass another picture, or an array"
        ) from error


def pixels_of(picture: Image) -> AnyArray:
    """Return pixels, with opacity where the picture has any; grey keeps its 16 bits."""
    if picture.mode.startswith("I"):  # 16 bits, which some versions of Pillow hold in 32
        return np.asarray(picture).astype(np.uint16)
    if picture.mode == "F":
        return np.asarray(picture)
    see_through = "A" in picture.getbands() or "transparency" in picture.info
    return np.asarray(picture.convert("RGBA" if see_through else "RGB"))
