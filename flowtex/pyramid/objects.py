"""The objects of a store as they are read: what does not come is an error in plain words.

Zarr takes an object that is missing for one of zeros. That would draw land, or still water, where
data are lost, so here it is an error. Parts of shards that many tiles need, those of arrays over
the nodes, are kept as they came.
"""

from __future__ import annotations

import asyncio
import re
import weakref
from dataclasses import dataclass
from typing import Any

from zarr.storage import WrapperStore

from flowtex._util.cache import ByteCache
from flowtex.pyramid.places import MOST_REPEATS, SILENCE_S, ReadFault

__all__ = ["Objects", "fault_words"]

#: Objects, or parts of them, that are on their way at once from one store.
MOST_READS = 16
#: Memory of what is kept of them, packed as it came.
CACHE_BYTES = 200_000_000
#: Traces of a tile are read once: whoever draws keeps them.
_TRACES = re.compile(r"^\d+/traces/c/")
_CHUNK = re.compile(r"/c(/\d+)+$")
_CREDENTIALS = (
    "credentials come from the environment, such as AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, "
    "or AWS_SKIP_SIGNATURE=true for a public bucket"
)


@dataclass(frozen=True)
class _Piece:
    buffer: Any

    @property
    def nbytes(self) -> int:
        return len(self.buffer) if self.buffer is not None else 0


class Objects(WrapperStore[Any]):
    """A store of Zarr's to read a pyramid from; errors are each a :class:`ReadFault`."""

    def __init__(self, store: Any) -> None:
        super().__init__(store)
        self._kept: ByteCache[Any, _Piece] = ByteCache(CACHE_BYTES)
        self._gates: weakref.WeakValueDictionary[Any, asyncio.Lock] = weakref.WeakValueDictionary()
        self._reads = asyncio.Semaphore(MOST_READS)

    async def get(self, key: str, prototype: Any, byte_range: Any = None) -> Any:
        """Return an object or a part of it, ``None`` for a missing one that is no chunk."""
        if _TRACES.match(key):
            return await self._read(key, prototype, byte_range)
        name = (key, repr(byte_range))
        gate = self._gates.setdefault(name, asyncio.Lock())
        async with gate:
            piece = self._kept.peek(name)
            if piece is None:
                piece = _Piece(await self._read(key, prototype, byte_range))
                self._kept.put(name, piece)
            return piece.buffer

    async def _read(self, key: str, prototype: Any, byte_range: Any) -> Any:
        async with self._reads:
            for trial in range(MOST_REPEATS + 1):
                try:
                    result = await self._store.get(key, prototype, byte_range)
                    break
                except Exception as error:
                    # An answer that was begun is not asked for again by obstore.
                    if "Interrupted" in str(error) and trial < MOST_REPEATS:
                        continue
                    refused = type(error).__name__ in (
                        "PermissionDeniedError",
                        "UnauthenticatedError",
                    )
                    if refused and key != "zarr.json" and not _CHUNK.search(key):
                        return None
                    msg = f"{key} {fault_words(error)}"
                    raise ReadFault(msg) from None
        if result is None and _CHUNK.search(key):
            msg = f"{key} is missing"
            raise ReadFault(msg)
        return result


def fault_words(error: Exception) -> str:
    """Tell what became of a request, without what the server said: that may hold secrets."""
    text, kind = str(error), type(error).__name__
    status = re.search(r"status code: (\d{3})", text)
    if kind in ("PermissionDeniedError", "UnauthenticatedError"):
        code = status[1] if status else "403"
        return f"is missing or not open to us ({code}); {_CREDENTIALS}"
    if isinstance(error, FileNotFoundError):
        return "is missing"
    if kind == "NotSupportedError":
        return "was asked for in part, which this server cannot do; expected one with ranges"
    if "169.254.169.254" in text:
        return f"cannot be asked for without credentials; {_CREDENTIALS}"
    if status:
        again = "try again later" if status[1] in ("429", "500", "502", "503", "504") else ""
        return f"was answered with status {status[1]}" + (f"; {again}" if again else "")
    if "kind: Timeout" in text or isinstance(error, TimeoutError):
        return (
            f"did not come: no answer within {SILENCE_S:g} s, asked {MOST_REPEATS + 1} times; "
            "look whether the server runs"
        )
    if "kind: Connect" in text:
        return "did not come: nobody answers at this address; look whether it is right"
    if "kind: Interrupted" in text or "kind: Body" in text:
        return "was cut off on its way; try again"
    if isinstance(error, OSError):
        return f"cannot be read ({error.strerror or kind})"
    return f"did not come ({kind})"
