"""A store as it is handed on: its objects, and tiles that it has not, made when they are asked for.

What is made is kept in a temporary folder, up to a size. The store itself is only read.
"""

from __future__ import annotations

import asyncio
import os
import re
import secrets
import threading
from collections import OrderedDict
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from flowtex._util.cache import ByteCache
from flowtex._util.extras import import_extra
from flowtex._util.progress import Stopped, stoppable
from flowtex._util.temporary import TemporaryFolder
from flowtex.pyramid.checks import sealed
from flowtex.pyramid.layout import SURFACE, TRACES, VALUES, attributes_of, create_level
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.places import ReadFault, fault_words, is_refused, objects_at
from flowtex.pyramid.stored import StoredPyramid, root_of
from flowtex.pyramid.tasks import trace_tile, write_tile
from flowtex.textures import TextureSet
from flowtex.tiles import TileKey

__all__ = ["Piece", "ServedStore"]

#: Bytes of the tiles that were made and are kept, and of nodes of tiles whose other times follow.
MADE_BYTES, NODE_BYTES, MOST_TILES = 1_000_000_000, 200_000_000, 16
#: Tiles that are made at once, and objects of the store that are read.
MOST_THREADS, MOST_READS = 4, 32
METADATA = "zarr.json"
#: Numbers of objects as Zarr writes them.
_NUMBER = re.compile(r"0|[1-9][0-9]{0,8}")


class Piece(NamedTuple):
    """A part of an object: its bytes, where they begin, and how many the whole object has."""

    body: bytes
    first: int
    size: int


@dataclass(eq=False)
class _Job:
    """A tile that is being made, and how many wait for it."""

    future: asyncio.Future[None] | None = None
    waiting: int = 0


class _Traced(NamedTuple):
    spare: int
    textures: TextureSet | None

    @property
    def nbytes(self) -> int:
        return 0 if self.textures is None else self.textures.geometry.field.nbytes


class ServedStore:
    """The objects of a pyramid by their names, those of all tiles among them.

    Parameters
    ----------
    place
        The store.

    Attributes
    ----------
    about
        What is told of the pyramid, with all of its levels traced.
    run
        A word that no other run has.

    Raises
    ------
    PyramidError
        When there is no pyramid, or it cannot be read.
    """

    def __init__(self, place: str | Path) -> None:
        levels = self._levels = Levels(place)
        self._pyramid = StoredPyramid(levels, root_of(levels))
        self._traced = frozenset(levels.about["traced"])
        depth = levels.about["depth"]
        self.about = sealed({**levels.about, "traced": list(range(depth + 1)), "complete": True})
        self.run = secrets.token_hex(4)
        self._origin = objects_at(levels.place)
        self._reads = asyncio.Semaphore(MOST_READS)
        self._temporary = TemporaryFolder()
        self._folder = self._temporary.new_folder()  # Zarr makes it anew, without its lock
        zarr = import_extra("zarr", "store")
        self._group = zarr.open_group(
            self._folder, mode="w", zarr_format=3, attributes=attributes_of(self.about)
        )
        for level in range(depth + 1):
            create_level(self._group, level, self._pyramid.shape(level), self.about)
        #: How many objects each array has along its axes.
        self._counts: dict[str, tuple[int, ...]] = {
            name: tuple(map(_quotient, array.shape, array.shards or array.chunks))
            for name, array in self._group.members(max_depth=None)
            if isinstance(array, zarr.Array)
        }
        self._metadata = {
            path.relative_to(self._folder).as_posix(): path.read_bytes()
            for path in self._folder.rglob(METADATA)
        }
        self._sizes: OrderedDict[str, int] = OrderedDict()
        self._tiles: ByteCache[TileKey, _Traced] = ByteCache(NODE_BYTES, max_count=MOST_TILES)
        self._spares: dict[TileKey, int] = {}
        self._jobs: dict[tuple[TileKey, int], _Job] = {}
        self._lock = threading.Lock()
        threads = min(os.cpu_count() or 1, MOST_THREADS)
        self._pool = ThreadPoolExecutor(threads, thread_name_prefix="flowtex-serve")

    def close(self) -> None:
        """End, without waiting for what is being made, and remove what was."""
        for job in self._jobs.values():
            job.waiting = 0
        self._pool.shutdown(wait=False, cancel_futures=True)
        self._temporary.close()

    async def get(self, name: str, asked: slice = slice(None)) -> Piece:
        """Return an object, or a part of it; a negative start counts from its end.

        Raises
        ------
        LookupError
            When there is no such object.
        IndexError
            When the part begins behind its end; the first argument is its size.
        PyramidError, ReadFault
            When it cannot be read.
        """
        if name in self._metadata:
            return _part(self._metadata[name], asked)
        array, numbers = self._find(name)
        level, _, kind = array.partition("/")
        of_tile = kind in (TRACES, VALUES, SURFACE)
        if not of_tile or int(level) in self._traced:
            try:
                return await self._read(name, asked)
            except FileNotFoundError:
                if not of_tile:
                    raise LookupError(name) from None
            # A tile that was lost is made again.
        step, row, column = (0, *numbers[:2]) if kind == SURFACE else numbers[:3]
        key, path = TileKey(int(level), row, column), self._folder / name
        # It may be dropped again before it is read.
        for _ in range(3):
            if not path.is_file():
                await self._made(key, step, any_step=kind == SURFACE)
            with self._lock:
                if name in self._sizes:
                    self._sizes.move_to_end(name)
            try:
                return await asyncio.to_thread(_part_of_file, path, asked)
            except FileNotFoundError:
                continue
        raise LookupError(name)

    def _find(self, name: str) -> tuple[str, list[int]]:
        """Return the array and the numbers of an object that it has; names lead nowhere else."""
        array, _, rest = name.partition("/c/")
        words, counts = rest.split("/"), self._counts.get(array, ())
        if len(words) != len(counts) or not all(map(_NUMBER.fullmatch, words)):
            raise LookupError(name)
        numbers = [int(word) for word in words]
        if not all(number < count for number, count in zip(numbers, counts, strict=True)):
            raise LookupError(name)
        return array, numbers

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

    async def _made(self, key: TileKey, step: int, *, any_step: bool) -> None:
        """Wait until a tile is made; where nobody waits any more, it is given up."""
        names = [name for name in self._jobs if name[0] == key and (any_step or name[1] == step)]
        name = names[0] if names else (key, step)
        job = self._jobs.setdefault(name, _Job())
        job.waiting += 1
        if job.future is None:
            job.future = asyncio.wrap_future(self._pool.submit(self._make, *name, job))
            job.future.add_done_callback(lambda _: self._end(name, job))
        try:
            await asyncio.shield(job.future)
        except Stopped:  # for those who waited before
            pass
        finally:
            job.waiting -= 1
            if not job.waiting:
                job.future.cancel()
                self._end(name, job)

    def _end(self, name: tuple[TileKey, int], job: _Job) -> None:
        if self._jobs.get(name) is job:
            del self._jobs[name]
        if job.future is not None and job.future.done() and not job.future.cancelled():
            job.future.exception()  # which those who wait are told

    def _make(self, key: TileKey, step: int, job: _Job) -> None:
        """Make a tile at a destination time, in a thread."""
        with stoppable(lambda: not job.waiting):
            tile = self._tiles.get(key, lambda: self._trace(key, step))
            write_tile(self._group[str(key.level)], self._pyramid, key, step, *tile)
            if tile.textures is not None:
                tile.textures.forget()
        self._note(key, step)

    def _trace(self, key: TileKey, step: int) -> _Traced:
        # All times have one halo, by which paths are measured: that of the store, or of the first.
        spare = self._spares.get(key) or self._levels.spare(key)
        if spare:
            tile = _Traced(spare, self._pyramid.textures(key, spare))
        else:
            tile = _Traced(*trace_tile(self._pyramid, key, (step,)))
        self._spares[key] = tile.spare
        if tile.textures is not None and key.level < self._pyramid.depth:
            self._pyramid.check_nodes(key, tile.textures, (step,))
        return tile

    def _note(self, key: TileKey, step: int) -> None:
        """Note what was made, and remove what was used longest ago where all is too much."""
        level = self._folder / str(key.level)
        at = f"c/{step}/{key.row}/{key.column}"
        folders = [level / TRACES / at, level / VALUES / at]
        folders.append(level / SURFACE / f"c/{key.row}/{key.column}")
        made = [file for folder in folders for file in folder.rglob("*") if file.is_file()]
        with self._lock:
            for file in made:
                name = file.relative_to(self._folder).as_posix()
                self._sizes[name] = file.stat().st_size
                self._sizes.move_to_end(name)
            while sum(self._sizes.values()) > MADE_BYTES and len(self._sizes) > len(made):
                name, _ = self._sizes.popitem(last=False)
                (self._folder / name).unlink(missing_ok=True)


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


def _part(body: bytes, asked: slice) -> Piece:
    first, last = _bounds(asked, len(body))
    return Piece(body[first:last], first, len(body))


def _part_of_file(path: Path, asked: slice) -> Piece:
    with path.open("rb") as file:
        size = os.fstat(file.fileno()).st_size
        first, last = _bounds(asked, size)
        file.seek(first)
        return Piece(file.read(last - first), first, size)
