"""Pictures that a page sends, read so that they take no more room than they may."""

from __future__ import annotations

import io
import warnings
from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray

from flowtex.app.server.untrusted import shortened
from flowtex.settings import SettingsError
from flowtex.textures.images import pixels_of

__all__ = ["decoded"]

#: Bytes of a picture that is sent, and pixels in it, at most.
LARGEST, MOST_PIXELS = 8_000_000, 50_000_000
#: Pixels along a side of what is laid on the surface, at most; a larger picture is averaged.
SIDE = 2048
#: What is read: some other formats of Pillow's start programs, or are seldom tried.
FORMATS = ("PNG", "JPEG", "WEBP")


def decoded(sent: Any) -> NDArray[Any]:
    """Read a picture that a page has sent.

    Parameters
    ----------
    sent
        A mapping with ``content``, bytes or a list of them, and ``name``.

    Returns
    -------
    numpy.ndarray
        (H, W), (H, W, 3) or (H, W, 4), not more than :data:`SIDE` on a side.

    Raises
    ------
    SettingsError
        When it is too large, or no picture.
    """
    content = sent.get("content") if isinstance(sent, Mapping) else None
    if isinstance(content, list):
        content = b"".join(part for part in content if isinstance(part, bytes))
    name = str(sent.get("name", "the picture")) if isinstance(sent, Mapping) else "the picture"
    name = shortened(name, 80)
    if not isinstance(content, bytes) or not content:
        msg = f"{name}: did not arrive; expected a PNG or a JPEG"
        raise SettingsError(msg)
    if len(content) > LARGEST:
        msg = f"{name}: has {len(content) / 1e6:.1f} MB; expected {LARGEST / 1e6:g} at most"
        raise SettingsError(msg)
    return _read(content, name)


def _read(content: bytes, name: str) -> NDArray[Any]:
    from PIL import Image, ImageOps

    try:
        with warnings.catch_warnings():
            # Its size is looked at below, before there is a pixel of it.
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            picture = Image.open(io.BytesIO(content), formats=FORMATS)
        with picture:
            width, height = picture.size
            if width * height > MOST_PIXELS:
                msg = f"{name}: has {width} x {height} pixels; expected {MOST_PIXELS:,} at most"
                raise SettingsError(msg)
            picture.draft(None, (SIDE, SIDE))  # a JPEG is read at a fraction of its size
            times = -(-max(picture.size) // SIDE)
            small = picture if times == 1 else _averaged(picture, times)
            return pixels_of(ImageOps.exif_transpose(small))
    except Image.DecompressionBombError as error:
        msg = f"{name}: has far too many pixels; expected {MOST_PIXELS:,} at most"
        raise SettingsError(msg) from error
    except (OSError, SyntaxError, ValueError) as error:
        if isinstance(error, SettingsError):
            raise
        msg = f"{name}: is no picture that can be read; expected a PNG, a JPEG or a WebP"
        raise SettingsError(msg) from error


def _averaged(picture: Any, times: int) -> Any:
    """Average blocks of pixels; those of a palette are no colours yet."""
    plain = picture if picture.mode in ("L", "RGB", "RGBA") else picture.convert("RGBA")
    return plain.reduce(times)
