"""A store as it is handed on: its objects by their names, and nothing else."""

from __future__ import annotations

import asyncio
import re
import secrets
from pathlib import Path
from typing import Any, NamedTuple

from flowtex._util.extras import import_extra
from flowtex.pyramid.layout import create_level
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.places import DOCUMENT, ReadFault, fault_words, is_refused, objects_at

__all__ = ["Piece", "ServedStore"]

#: Objects of the store that are read at once.
MOST_READS = 32
#: Numbers of objects as Zarr writes them.
_NUMBER = re.compile(r"0|[1-9][0-9]{0,8}")


class Piece(NamedTuple):
    """A part of an object: its bytes, where they begin, and how many the whole object has."""

    body: bytes
    first: int
    size: int


class ServedStore:
    """The objects of a pyramid by their names.

    Parameters
    ----------
    place
        The store.

    Attributes
    ----------
    run
        A word that no other run has.

    Raises
    ------
    PyramidError
        When there is no pyramid, or it cannot be read.
    """

    def __init__(self, place: str | Path) -> None:
        levels = Levels(place)
        self.run = secrets.token_hex(4)
        self._origin = objects_at(levels.place)
        self._reads = asyncio.Semaphore(MOST_READS)
        zarr = import_extra("zarr", "store")
        group = zarr.group(store=zarr.storage.MemoryStore())
        for level in range(levels.about["depth"] + 1):
            create_level(group, level, levels.shape(level), levels.about)
        #: How many objects each array has along its axes.
        self._counts: dict[str, tuple[int, ...]] = {
            name: tuple(map(_quotient, array.shape, array.shards or array.chunks))
            for name, array in group.members(max_depth=None)
            if isinstance(array, zarr.Array)
        }
        names = [f"{name}/{DOCUMENT}" for name, _ in group.members(max_depth=None)]
        self._metadata = frozenset((DOCUMENT, *names))

    async def get(self, name: str, asked: slice = slice(None)) -> Piece:
        """Return an object, or a part of it; a negative start counts from its end.

        Raises
        ------
        LookupError
            When there is no such object.
        IndexError
            When the part begins behind its end; the first argument is its size.
        ReadFault
            When it cannot be read.
        """
        if name not in self._metadata:
            self._check(name)
        try:
            return await self._read(name, asked)
        except FileNotFoundError:
            raise LookupError(name) from None

    def _check(self, name: str) -> None:
        """Raise a LookupError for what is no object of an array; names lead nowhere else."""
        array, _, rest = name.partition("/c/")
        words, counts = rest.split("/"), self._counts.get(array, ())
        if len(words) != len(counts) or not all(map(_NUMBER.fullmatch, words)):
            raise LookupError(name)
        if not all(int(word) < count for word, count in zip(words, counts, strict=True)):
            raise LookupError(name)

    async def _read(self, name: str, asked: slice) -> Piece:
        """Read an object of the store; ``FileNotFoundError`` is for one that is missing."""
        obstore = import_extra("obstore", "store")

        async def fetch(span: Any) -> Piece:
            result = await obstore.get_async(self._origin, name, options=span)
            return Piece(bytes(await result.bytes_async()), result.range[0], result.meta["size"])

        async with self._reads:
            try:
                return await fetch(_span(asked))
            except FileNotFoundError:
                raise
            except Exception as error:
                if is_refused(error):
                    raise FileNotFoundError(name) from None
                fault = ReadFault(f"{name} {fault_words(error)}")
            if asked == slice(None):
                raise fault
            # Not every store counts from the end, and none says how long an object is then.
            try:
                size = (await obstore.head_async(self._origin, name))["size"]
                return await fetch({"range": _bounds(asked, size)})
            except IndexError:
                raise
            except Exception:
                raise fault from None


def _quotient(size: int, part: int) -> int:
    """Return how many parts of some size a whole has."""
    return -(-size // part)


def _bounds(asked: slice, size: int) -> tuple[int, int]:
    """Return where a part begins and ends in so many bytes."""
    first = asked.start or 0
    first = max(size + first, 0) if first < 0 else first
    last = size if asked.stop is None else min(asked.stop, size)
    if first >= last and asked != slice(None):
        raise IndexError(size)
    return first, last


def _span(asked: slice) -> Any:
    """Return a part as obstore takes it."""
    if asked == slice(None):
        return None
    if asked.stop is not None:
        return {"range": (asked.start, asked.stop)}
    return {"range": {"suffix": -asked.start} if asked.start < 0 else {"offset": asked.start}}
