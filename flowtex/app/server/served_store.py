"""A store as it is served: its objects by their names, and nothing else."""

from __future__ import annotations

import asyncio
import re
import secrets
from pathlib import Path

import numpy as np

from flowtex._util.extras import import_extra
from flowtex.pyramid.layout import described
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.places import DOCUMENT, ReadFault, fault_words, is_refused, objects_at

#: Objects of the store that are read at once.
MOST_READS = 32
#: Numbers of objects as Zarr writes them.
_NUMBER = re.compile(r"0|[1-9][0-9]{0,8}")


class ServedStore:
    """The objects of a pyramid by their names.

    Raises a PyramidError when there is no pyramid, or it cannot be read.
    """

    def __init__(self, place: str | Path) -> None:
        levels = Levels(place)
        self.run = secrets.token_hex(4)  #: A word that is unique to this run.
        self._origin = objects_at(levels.place)
        self._reads = asyncio.Semaphore(MOST_READS)
        zarr = import_extra("zarr", "store")
        group = described(levels.about)
        #: How many objects each array has along its axes.
        self._counts: dict[str, tuple[int, ...]] = {
            name: tuple(map(int, np.ceil(np.divide(array.shape, array.shards or array.chunks))))
            for name, array in group.members(max_depth=None)
            if isinstance(array, zarr.Array)
        }
        names = [f"{name}/{DOCUMENT}" for name, _ in group.members(max_depth=None)]
        self._metadata = frozenset((DOCUMENT, *names))

    async def get(self, name: str) -> bytes:
        """Return an object.

        Raises a LookupError when the object does not exist, and a ReadFault when reading fails.
        """
        if name not in self._metadata:
            self._check(name)
        return await self._read(name)

    def _check(self, name: str) -> None:
        """Raise a LookupError if a name is not that of an object of an array."""
        array, _, rest = name.partition("/c/")
        words, counts = rest.split("/"), self._counts.get(array, ())
        if len(words) != len(counts) or not all(map(_NUMBER.fullmatch, words)):
            raise LookupError(name)
        if not all(int(word) < count for word, count in zip(words, counts, strict=True)):
            raise LookupError(name)

    async def _read(self, name: str) -> bytes:
        obstore = import_extra("obstore", "store")
        async with self._reads:
            try:
                result = await obstore.get_async(self._origin, name)
                return bytes(await result.bytes_async())
            except Exception as error:
                if isinstance(error, FileNotFoundError) or is_refused(error):
                    raise LookupError(name) from None
                msg = f"{name} {fault_words(error)}"
                raise ReadFault(msg) from None
