"""Where a store is: a local folder, ``s3://`` and other object storage, or ``http(s)://``."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from flowtex._util.extras import import_extra
from flowtex.errors import FieldError

__all__ = ["FORMAT", "PyramidError", "is_store", "place_text", "store_at"]

#: Written into every store; a reader refuses what it does not know.
FORMAT = "flowtex-pyramid-1"
#: A URL, or one of which ``pathlib`` has made a path, on Windows with its slashes turned. One
#: letter is a drive.
_URL = re.compile(r"^([A-Za-z][A-Za-z0-9+.-]+):[/\\]{1,2}(?=[^/\\])")


class PyramidError(FieldError):
    """A store of a pyramid that cannot be read, or written.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.pyramid.open_store("missing.zarr")
    Traceback (most recent call last):
    flowtex.pyramid.places.PyramidError: ...
    """


def place_text(place: str | Path) -> str:
    """Return the URL of a store, or the whole path of a local one."""
    text = str(place)
    if _URL.match(text):
        return _URL.sub(r"\1://", text).replace("\\", "/")
    return str(Path(text).expanduser().resolve())


def store_at(place: str | Path, *, read_only: bool = True) -> Any:
    """Return the store of Zarr's at a place.

    Object storage takes endpoint and credentials from the environment. A file of a local folder is
    written beside its place and renamed, an object is put in one piece: both are whole or absent.
    """
    text = place_text(place)
    storage = import_extra("zarr.storage", "store")
    if not _URL.match(text):
        return storage.LocalStore(text, read_only=read_only)
    objects = import_extra("obstore.store", "store")
    return storage.ObjectStore(objects.from_url(text), read_only=read_only)


def is_store(place: Any) -> bool:
    """Whether there is a pyramid at a place; without Zarr for a local one.

    Examples
    --------
    >>> from flowtex.pyramid import is_store
    >>> is_store("flow.vts")
    False
    """
    if not isinstance(place, (str, Path)):
        return False
    text = place_text(place)
    if not _URL.match(text):
        try:
            about = json.loads((Path(text) / "zarr.json").read_text(encoding="utf-8"))
            return "flowtex" in about["attributes"]
        except (OSError, ValueError, KeyError, TypeError):
            return False
    return text.rstrip("/").endswith(".zarr")
