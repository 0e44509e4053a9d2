"""Checks of values that a page sends: numbers, names and pictures.

A page may send anything instead of a number or a name. Invalid values are dropped or clipped here,
so that no handler has to check again; the size of pictures is limited.
"""

from __future__ import annotations

import io
import math
import threading
import warnings
from collections.abc import Container, Mapping
from contextlib import suppress
from typing import Any, TypeGuard

from flowtex._util.array_types import AnyArray
from flowtex.settings import SettingsError
from flowtex.textures.images import pixels_of

#: Characters of a message to a page, at most.
MESSAGE_LENGTH = 400
#: Bytes of a picture that is sent, and pixels in it, at most.
PICTURE_BYTES, PICTURE_PIXELS = 8_000_000, 50_000_000
#: Most pixels along a side of an image on the surface; a larger picture is averaged.
PICTURE_SIDE = 2048
#: Formats that are read: some others of Pillow start programs, or are rarely tested.
PICTURE_FORMATS = ("PNG", "JPEG", "WEBP")

#: Held while a picture is decoded, so that the pixels of many are not in memory at once.
_decoding = threading.Lock()


def number(value: object, low: float = -math.inf, high: float = math.inf) -> float | None:
    """Return a finite number within limits; ``None`` for anything else, a boolean too."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    with suppress(OverflowError):  # a whole number may have any size
        if math.isfinite(value) and low <= value <= high:
            return float(value)
    return None


def clipped(value: object, default: float, low: float, high: float) -> float:
    """Return a number clipped to limits; the default if the value is not a number."""
    checked = number(value)
    return default if checked is None else min(max(checked, low), high)


def name_among(value: object, names: Container[str]) -> TypeGuard[str]:
    """Return whether a value is one of some names."""
    return isinstance(value, str) and value in names


def mapping(value: object) -> Mapping[str, Any]:
    """Return a mapping, an empty one for anything else."""
    return value if isinstance(value, Mapping) else {}


def shortened(text: str, most: int = MESSAGE_LENGTH) -> str:
    """Return a text, cut at its end if it is long."""
    return text if len(text) <= most else f"{text[: most - 1]}…"


def sent_picture(sent: object) -> tuple[bytes, str]:
    """Return the bytes and the name of a picture that a page has sent.

    It is a mapping with ``content``, bytes or a list of them, and ``name``. Raises a SettingsError
    when it is too large or missing.
    """
    content = sent.get("content") if isinstance(sent, Mapping) else None
    if isinstance(content, list):
        content = b"".join(part for part in content if isinstance(part, bytes))
    name = str(sent.get("name", "the picture")) if isinstance(sent, Mapping) else "the picture"
    name = shortened(name, 80)
    if not isinstance(content, bytes) or not content:
        msg = f"{name}: the upload is empty; expected a PNG or a JPEG"
        raise SettingsError(msg)
    if len(content) > PICTURE_BYTES:
        msg = f"{name}: has {len(content) / 1e6:.1f} MB; expected {PICTURE_BYTES / 1e6:g} at most"
        raise SettingsError(msg)
    return content, name


def decode_picture(content: bytes, name: str) -> AnyArray:
    """Read a picture, averaged to :data:`PICTURE_SIDE` on a side at most; one at a time.

    Raises a SettingsError when it has too many pixels, or is not a picture.
    """
    with _decoding:
        return _read(content, name)


def _read(content: bytes, name: str) -> AnyArray:
    from PIL import Image, ImageOps

    try:
        with warnings.catch_warnings():
            # The size is checked below, before any pixel is decoded.
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            picture = Image.open(io.BytesIO(content), formats=PICTURE_FORMATS)
        with picture:
            width, height = picture.size
            if width * height > PICTURE_PIXELS:
                msg = f"{name}: has {width} x {height} pixels; expected {PICTURE_PIXELS:,} at most"
                raise SettingsError(msg)
            # A JPEG is read at a fraction of its size.
            picture.draft(None, (PICTURE_SIDE, PICTURE_SIDE))
            times = -(-max(picture.size) // PICTURE_SIDE)
            if times == 1:
                return pixels_of(ImageOps.exif_transpose(picture))
            # Pixels of a palette become colours before they are averaged.
            has_colours = picture.mode in ("L", "RGB", "RGBA")
            averaged = (picture if has_colours else picture.convert("RGBA")).reduce(times)
            return pixels_of(ImageOps.exif_transpose(averaged))
    except Image.DecompressionBombError as error:
        msg = f"{name}: has far too many pixels; expected {PICTURE_PIXELS:,} at most"
        raise SettingsError(msg) from error
    except (OSError, SyntaxError, ValueError) as error:
        if isinstance(error, SettingsError):
            raise
        msg = f"{name}: the picture cannot be read; expected a PNG, a JPEG or a WebP"
        raise SettingsError(msg) from error
