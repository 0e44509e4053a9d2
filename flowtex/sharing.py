"""What several views of one flow have in common is made once, and kept while one of them lives.

A notebook shows the same mesh many times over. Each time it becomes a field of its own, so fields
are told by their numbers, and all that is made of a field by the field.
"""

from __future__ import annotations

import hashlib
import threading
import weakref
from collections.abc import Callable, Hashable, Iterable
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from flowtex.field import FlowField
from flowtex.settings import Settings
from flowtex.textures import TextureSet
from flowtex.trace import SliceStore

__all__ = ["Shared", "digest", "shared_field", "shared_textures"]

V = TypeVar("V")


class Shared(Generic[V]):
    """Values by key: made by the first who asks, and kept for as long as somebody holds them."""

    def __init__(self) -> None:
        self._values: weakref.WeakValueDictionary[Hashable, V] = weakref.WeakValueDictionary()
        self._gates: dict[Hashable, threading.Lock] = {}
        self._lock = threading.Lock()

    def get(self, key: Hashable, make: Callable[[], V]) -> V:
        """Return the value of a key; who asks while it is made waits for it."""
        with self._lock:
            gate = self._gates.setdefault(key, threading.Lock())
        with gate:
            value = self._values.get(key)
            if value is None:
                value = self._values[key] = make()
        with self._lock:
            self._gates.pop(key, None)
        return value


def digest(*arrays: NDArray[Any], words: Iterable[object] = ()) -> bytes:
    """Return what tells arrays apart, 16 bytes: by their numbers, types and shapes.

    Parameters
    ----------
    *arrays
        Of any shape.
    words
        What else makes a difference, by its ``repr``.
    """
    found = hashlib.blake2b(repr(tuple(words)).encode(), digest_size=16)
    for array in arrays:
        found.update(f"{array.dtype.str}{array.shape}".encode())
        found.update(np.ascontiguousarray(array).reshape(-1).view(np.uint8).data)
    return found.digest()


_fields: Shared[FlowField] = Shared()
_textures: Shared[TextureSet] = Shared()


def shared_field(field: FlowField) -> FlowField:
    """Return the field of the same numbers and names that is in use, or this one."""
    words = (field.periodic, field.name, field.length_unit, field.time_unit, field.sign_free)
    placed = () if field.placed is None else (field.placed,)
    own = (field.points, field.velocity, field.times, field.valid, *placed)
    key = digest(*own, *field.scalars.values(), words=(words, len(placed), *field.scalars))
    return _fields.get(key, lambda: field)


def shared_textures(
    store: SliceStore, settings: Settings, image: NDArray[np.float32] | None
) -> TextureSet:
    """Return :meth:`TextureSet.build` of the same store and settings, one for all who ask."""
    # Textures keep their store alive, so its number is its own while they live.
    key: tuple[Any, ...] = (id(store),)
    if settings.noise != "procedural":
        key += (settings.noise, settings.resolution, settings.noise_correction)
        key += (settings.seed, settings.tiles)
        key += () if image is None or settings.noise != "image" else (digest(image),)
    return _textures.get(key, lambda: TextureSet.build(store, settings, image))
