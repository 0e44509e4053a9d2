"""Images in files: PNG, JPEG and whatever else Pillow, which PyVista brings, can read."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex.textures import ImageError

__all__ = ["load_image", "pixels_of", "read_image"]


def load_image(image: Any) -> Any:
    """Read an image when it is a path, and return anything else as it is.

    Parameters
    ----------
    image
        A path to a PNG, a JPEG or another picture, or an array.

    Returns
    -------
    numpy.ndarray
        (H, W), (H, W, 3) or (H, W, 4), row 0 at the top, as the file's own orientation says; or
        what came.

    Raises
    ------
    ImageError
        When there is no such file, or it is no picture that can be read.
    """
    if not isinstance(image, (str, Path)):
        return image
    path = Path(image).expanduser()
    if not path.is_file():
        what = "is a folder" if path.is_dir() else "there is no such file"
        msg = f"{image}: {what}; expected a picture, such as a PNG or a JPEG"
        raise ImageError(msg)
    return read_image(path, str(path))


def read_image(file: Path | BinaryIO, name: str) -> AnyArray:
    """Read an image from a file or from what holds the bytes of one.

    Parameters
    ----------
    file
        The path, or an open file.
    name
        What errors call it.

    Returns
    -------
    numpy.ndarray
        As :func:`load_image` returns it.

    Raises
    ------
    ImageError
        When it is no picture that can be read.
    """
    from PIL import Image, ImageOps, UnidentifiedImageError

    try:
        # Pillow warns of a picture so large that it may be an attack, and refuses twice as large.
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(file) as opened:
                return pixels_of(ImageOps.exif_transpose(opened))
    except (Image.DecompressionBombWarning, Image.DecompressionBombError) as error:
        msg = f"{name}: has more than {Image.MAX_IMAGE_PIXELS:,} pixels; make it smaller"
        raise ImageError(msg) from error
    except UnidentifiedImageError as error:
        msg = f"{name}: is no picture that can be read; expected a PNG, a JPEG or the like"
        raise ImageError(msg) from error
    except (OSError, SyntaxError) as error:  # Pillow raises either for a file cut short
        msg = f"{name}: cannot be read ({error}); give another picture, or its array"
        raise ImageError(msg) from error


def pixels_of(picture: Any) -> AnyArray:
    """Pixels, with opacity where the picture has any; deep grey keeps its depth."""
    if picture.mode.startswith("I"):  # 16 bits, which some versions of Pillow hold in 32
        return np.asarray(picture).astype(np.uint16)
    if picture.mode == "F":
        return np.asarray(picture)
    see_through = "A" in picture.getbands() or "transparency" in picture.info
    return np.asarray(picture.convert("RGBA" if see_through else "RGB"))
