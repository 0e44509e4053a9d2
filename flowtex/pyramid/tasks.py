"""The tasks of building a pyramid: each makes one shard, or a tile at some time steps.

They are plain functions of a place and of numbers, so that any process on any machine can run
them. Each opens the store itself, and reads no more than what it needs.
"""

from __future__ import annotations

import ctypes
import json
import os
import pickle
import traceback
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from contextlib import suppress
from functools import cache, lru_cache, partial
from itertools import islice
from typing import Any, NamedTuple

import numpy as np

from flowtex._util.array_types import Floats, Floats32, Indices
from flowtex._util.progress import pool
from flowtex.errors import FieldError, import_extra
from flowtex.field.derived.quantities import steps_of
from flowtex.field.steps import Nodes, typical_steps
from flowtex.pyramid.layout import (
    DIGESTS,
    FILE_BYTES,
    FILE_CHUNK,
    FLOW,
    SURFACE,
    VALUES,
    About,
    Arrays,
    Part,
    part_digest,
    rounded,
    to_write,
    value_names,
)
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.places import (
    ChangedError,
    DamageError,
    PyramidError,
    plain_faults,
    store_at,
    sync,
)
from flowtex.pyramid.source import NodeSource
from flowtex.pyramid.stored import StoredPyramid, root_of
from flowtex.rendering.webgl.client_data import ClientData, single, tile_parts
from flowtex.rendering.webgl.protocol import Parts, parts_file
from flowtex.rendering.webgl.velocity import can_trace
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.grid_levels import averaged, beside, level_lines
from flowtex.textures.tiles.pyramid import TileKey
from flowtex.trace.store import SliceStore

#: Entries of the slices that are the same in all tiles, and in the header of the page.
OF_ALL_TILES = ("steps", "times", "timeUnit", "dates", "pace")
VALUE_SHARE = 2.0**-17  #: Error of a value as a share of the range that most of them have.
PART_BYTES = 500_000_000  #: Most memory of a task that makes a part of a level.
TILE_BYTES = 1_500_000_000  #: Most memory of a task that traces a tile or the root.
OWN_BYTES = 500_000_000  #: Memory of a process for its imports.
MOST_TRIALS = 3  #: Times that a task is tried.
TRIM = (-1, 64 << 20)  #: Parameter of ``mallopt`` for the free heap that it keeps, in bytes.
MMAP = (-3, 1 << 20)  #: The same for the size of arrays with pages of their own.
MOST_SENT = 64_000_000  #: Most bytes sent to workers; a larger source contains its data.


class TileTask(NamedTuple):
    """A tile, and the destination times of it that are to be written."""

    key: TileKey
    steps: tuple[int, ...]


def make_finest(source: NodeSource, place: str, run: str, part: Part) -> None:
    """Make a part of level 0 from the source; the first step determines the valid nodes."""
    levels = _levels(place, run)
    array = _writable(place, run)
    nodes = _source_nodes(levels, source, part)
    write_part(array, levels.about, part, part.lines(source.shape), _as_written(nodes))


def compare_finest(source: NodeSource, place: str, run: str, part: Part) -> None:
    """Check that a source still has the values from which a part of a pyramid was made.

    Parameters
    ----------
    source
        The field that is built.
    place
        Address of the store.
    run
        Identity of the build.
    part
        The part, on the finest level.

    Raises
    ------
    ChangedError
        When values differ.
    """
    levels = _levels(place, run)
    nodes = _as_written(_source_nodes(levels, source, part))
    stored_digest = levels.whole(f"0/{DIGESTS}", part[1:]).tobytes()
    if part_digest(nodes, levels.about, part.step) != stored_digest:
        rows, columns = part.lines(source.shape)
        raise ChangedError(
            f"{place} contains the pyramid of another field, or of earlier values: rows "
            f"{rows.start}-{rows.stop - 1}, columns {columns.start}-{columns.stop - 1} differ at "
            f"step {part.step}. Build with fresh=True to replace it"
        )


def mend(place: str, run: str, unit: Part | TileTask) -> None:
    """Remove a part, or a tile at its steps, that is incomplete or corrupt."""
    levels = _levels(place, run)
    store = store_at(place, read_only=False)
    for step_unit, check in checks_of(levels, unit):
        try:
            check()
        except DamageError:
            for name in _objects(levels.about, step_unit):
                sync(store.delete(name))


def checks_of(
    levels: Levels, unit: Part | TileTask
) -> Iterator[tuple[Part | TileTask, Callable[[], None]]]:
    """Yield functions that raise a DamageError for a part, or for each step of a tile."""
    if isinstance(unit, Part):
        yield unit, partial(levels.check_part, unit)
    else:
        for step in unit.steps:
            yield TileTask(unit.key, (step,)), partial(levels.check_tile, unit.key, step)


def _objects(about: About, unit: Part | TileTask) -> Iterator[str]:
    """Yield the names of the objects of a part or a tile."""
    if isinstance(unit, Part):
        level, step, row, column = unit
        yield f"{level}/velocity/c/{step}/{row}/{column}/0"
        for name, count in about["scalars"].items():
            if step < count:
                yield f"{level}/scalars/{name}/c/{step}/{row}/{column}"
        if step == 0:
            yield f"{level}/valid/c/{row}/{column}"
            yield f"{level}/has_position/c/{row}/{column}"
            yield f"{level}/points/c/{row}/{column}/0"
        return
    (level, row, column) = unit.key
    (step,) = unit.steps
    yield f"{level}/{FLOW}/c/{step}/{row}/{column}/0"
    for number in range(len(value_names(about))):
        yield f"{level}/{VALUES}/c/{step}/{row}/{column}/{number}/0"
    if step == 0:
        yield f"{level}/{SURFACE}/c/{row}/{column}/0"


def _source_nodes(levels: Levels, source: NodeSource, part: Part) -> Nodes:
    """Return the nodes of a part, read from the source."""
    lines = part.lines(source.shape)
    valid = None
    if part.step and source.travels:  # others have it in memory
        rows = np.arange(lines[0].start, lines[0].stop)
        columns = np.arange(lines[1].start, lines[1].stop)
        valid = levels.valid(0, rows, columns)
    return source.nodes(part.step, *lines, valid)


def _as_written(nodes: Nodes) -> Nodes:
    return nodes._replace(velocity=rounded(np.asarray(nodes.velocity)))


def make_part(place: str, run: str, part: Part) -> None:
    """Make a part of a level from the level before it."""
    levels = _levels(place, run)
    about = levels.about
    finer = part.level - 1
    chosen = part.lines(levels.shape(part.level))
    # As lines of the finer level: these, and those from which they are averaged.
    picks = []
    around = []
    needed = []
    for count, span, closed in zip(about["nodes"], chosen, about["periodic"], strict=True):
        fine = level_lines(count, finer)
        lines = np.searchsorted(fine, level_lines(count, part.level)[span])
        three = beside(lines, len(fine), closed=closed)
        read = np.unique(three)
        picks.append(lines)
        around.append(np.searchsorted(read, three))
        needed.append(read)
    velocity = levels.velocity(finer, part.step, needed[0], needed[1])
    _, valid = levels.positions(finer, needed[0], needed[1])
    nodes = _at_step(levels, finer, part.step, picks[0], picks[1])
    mean = averaged(velocity, valid, around[0], around[1])
    write_part(
        _writable(place, run), about, part, chosen, _as_written(nodes._replace(velocity=mean))
    )


def write_part(
    array: Arrays, about: About, part: Part, lines: tuple[slice, slice], nodes: Nodes
) -> None:
    """Write a part of a level, with the velocity (J, I, C) and scalars (J, I) of its step."""
    level = part.level
    components = about["components"]
    for name, values in nodes.scalars.items():
        if part.step < about["scalars"][name]:
            array(f"{level}/scalars/{name}")[(part.step, *lines)] = values
    if part.step == 0:
        array(f"{level}/valid")[lines] = nodes.valid
        if nodes.has_position is not None:
            array(f"{level}/has_position")[lines] = nodes.has_position
        if not about["axes"]:
            array(f"{level}/points")[lines] = nodes.points[..., :components]
    digest = np.frombuffer(part_digest(nodes, about, part.step), np.uint8)
    array(f"{level}/{DIGESTS}")[part.step, part.row, part.column] = digest
    # The last array: its presence shows that a part is complete.
    array(f"{level}/velocity")[(part.step, *lines)] = nodes.velocity[..., :components]


def make_tile(place: str, run: str, task: TileTask) -> None:
    """Write the data of a tile for browsers."""
    write_tile(_writable(place, run), _pyramid(place, run), task.key, task.steps)


def _at_step(levels: Levels, level: int, step: int, rows: Indices, columns: Indices) -> Nodes:
    """Return nodes with the scalars of a step, without velocities."""
    nodes = levels.nodes(level, rows, columns, velocities=False)
    counts = levels.about["scalars"]
    scalars = {}
    for name, steps in nodes.scalars.items():
        if step < counts[name]:
            scalars[name] = np.asarray(steps[step])
    return nodes._replace(scalars=scalars)


# An opened store is kept for one run: the next one may find another pyramid at the same place. Only
# one is kept, because the one of the run before would hold its data.
@lru_cache(maxsize=1)
def _levels(place: str, run: str) -> Levels:
    del run
    return Levels(place)


@lru_cache(maxsize=1)
def _pyramid(place: str, run: str) -> StoredPyramid:
    levels = _levels(place, run)
    return StoredPyramid(levels, root_of(levels))


@lru_cache(maxsize=1)
def _writable(place: str, run: str) -> Arrays:
    del run
    return to_write(store_at(place, read_only=False))


def write_tile(array: Arrays, pyramid: StoredPyramid, key: TileKey, steps: Sequence[int]) -> None:
    """Write the data of a tile for browsers at some steps; with step 0 also its surface."""
    fingerprint = pyramid.about["fingerprint"]
    textures = _textures(pyramid, key)
    data = None
    at = key[1:]
    if textures is not None:
        # A page of a store may have some of its steps, which pathlines lead through.
        is_steady = textures.store.streamlines
        data = ClientData(textures, depth=pyramid.depth, traces=is_steady)
    if 0 in steps and key.level < pyramid.depth:  # a page has the surface of the root
        _write(array, f"{key.level}/{SURFACE}", at, fingerprint, _surface(pyramid, key, data))
    prefix = f"tile/{key.level}/{key.row}/{key.column}"
    for step in steps:
        parts: Parts = {}
        if data is not None:
            for number, values in _values(pyramid, data, step).items():
                file = {f"{prefix}/scalars/{step}/{number}": values}
                _write(array, f"{key.level}/{VALUES}", (step, *at, number), fingerprint, file)
            for name, part in data.step(step).items():
                parts[f"{prefix}/{name}"] = part
            data.textures.forget()
        # The last file: its presence shows that a tile is complete.
        _write(array, f"{key.level}/{FLOW}", (step, *at), fingerprint, parts)


def _textures(pyramid: StoredPyramid, key: TileKey) -> TextureSet | None:
    """Return the textures of a tile; textures that a browser traces are not traced here."""
    if key.level == pyramid.depth:
        store = SliceStore(pyramid.root, parameter=pyramid.parameter, lines=pyramid.lines)
        return pyramid.root_textures(store)
    textures = pyramid.textures(key)
    if textures is None or (textures.store.streamlines and can_trace(textures)):
        return textures
    return pyramid.tile(key, typical_steps(len(pyramid.root.times)))


def _write(array: Arrays, name: str, at: Sequence[int], fingerprint: str, parts: Parts) -> None:
    """Write parts as a file of a tile, which names the pyramid that it belongs to."""
    owner = np.frombuffer(fingerprint.encode(), np.uint8)
    file = np.frombuffer(parts_file({"of": owner, **parts}, planes=True), np.uint8)
    size = -(-len(file) // FILE_CHUNK) * FILE_CHUNK
    if size > FILE_BYTES:
        raise PyramidError(
            f"{name} of tile {tuple(at)} takes {size:,} bytes; expected {FILE_BYTES:,} at most"
        )
    array(name)[(*at, slice(0, size))] = np.pad(file, (0, size - len(file)))


def _surface(pyramid: StoredPyramid, key: TileKey, data: ClientData | None) -> Parts:
    """Return the parts of the surface of a tile, with its own entries of the header."""
    parts = tile_parts(key, data)
    if data is not None:
        header = data.tile_header
        slices = dict(header["slices"])
        for name in OF_ALL_TILES:
            slices.pop(name, None)
        shared = {"geometry": header["geometry"], "slices": slices}
        parts[next(iter(parts))] = np.frombuffer(json.dumps(shared).encode(), np.uint8)
    return parts


def _values(pyramid: StoredPyramid, data: ClientData, step: int) -> dict[int, Floats32]:
    """Return the values that colour a tile at a step, rounded by less than colours show."""
    result: dict[int, Floats32] = {}
    rows, columns = data.textures.grid.drawn
    for number, name in enumerate(value_names(pyramid.about)):
        steps = steps_of(data.field, name)
        # The speed follows from the flow.
        is_derived = data.traced and name not in data.field.scalars
        if is_derived or step >= len(steps):
            continue
        values: Floats = np.asarray(steps[step])[rows, columns]
        low, high = pyramid.ranges.get((name, True), (0.0, 0.0))
        if 0 < (unit := 2 * VALUE_SHARE * (high - low)) < np.inf:
            unit = 2.0 ** np.floor(np.log2(unit))
            values = np.rint(values / unit) * unit
        result[number] = single(values)
    return result


class Threads:
    """Threads of this process: one for each core, or as many as some memory has room for."""

    def __init__(self, memory: int | str | None = None) -> None:
        self._memory: int | None = None
        if memory is not None:
            try:
                self._memory = int(import_extra("dask.utils", "store").parse_bytes(memory))
            except (ValueError, TypeError, AttributeError) as error:
                raise FieldError(
                    f"memory is {memory!r}; expected a number of bytes, or a text such as '2GB'"
                ) from error

    def count(self, need: int) -> int:
        """Return how many tasks run at once that need this many bytes each."""
        cores = os.cpu_count() or 1
        if self._memory is None:
            return cores
        return max(min(cores, (self._memory - OWN_BYTES) // need), 1)

    def run(
        self,
        function: Callable[..., None],
        tasks: Sequence[tuple[Any, ...]],
        need: int,
        *arguments: Any,
    ) -> Generator[Exception | None]:
        """Call a function with ``arguments`` and each task; yield the error of each or ``None``."""
        if not tasks:
            return

        def tried(task: tuple[Any, ...]) -> Exception | None:
            result: Exception | None = None
            for _ in range(MOST_TRIALS):
                try:
                    with plain_faults():
                        function(*arguments, *task)
                except Exception as error:
                    # The frames of the error hold all that the task had in memory.
                    for cause in (error, error.__cause__, error.__context__):
                        if cause is not None:
                            traceback.clear_frames(cause.__traceback__)
                    result = error
                else:
                    return None
            return result

        count = self.count(need)
        left = iter(tasks)
        with pool(count, "flowtex-pyramid") as threads:
            # No more tasks wait than keep all workers busy: the caller may stop after a failure.
            running = {threads.submit(tried, task) for task in islice(left, 2 * count)}
            try:
                while running:
                    done, running = wait(running, return_when=FIRST_COMPLETED)
                    for task in islice(left, len(done)):
                        running.add(threads.submit(tried, task))
                    for future in done:
                        yield future.result()
            finally:
                threads.shutdown(wait=True, cancel_futures=True)

    def close(self) -> None:
        """Do nothing: threads leave nothing open."""


class Cluster(Threads):
    """Workers of a Dask cluster, which open the store themselves."""

    def __init__(self, scheduler: Any) -> None:
        super().__init__()
        distributed = import_extra("distributed", "store")
        self._owns_client = isinstance(scheduler, str)
        if self._owns_client:
            self._client = distributed.Client(scheduler)
        else:
            self._client = scheduler
        self._as_completed = distributed.as_completed

    def run(
        self,
        function: Callable[..., None],
        tasks: Sequence[tuple[Any, ...]],
        need: int,
        *arguments: Any,
    ) -> Generator[Exception | None]:
        """Yield the error of each task, or ``None``, in the order in which they end."""
        if not tasks:
            return
        packed = list(map(_packed, arguments))
        if None in packed:
            # The source contains its data, which would go to each worker.
            yield from super().run(function, tasks, need, *arguments)
            return
        # Results of tasks outlive the worker that has them.
        sent = [self._client.submit(pickle.loads, data, pure=False) for data in packed]
        futures = self._client.map(
            _run_task, tasks, function=function, inputs=sent, pure=False, retries=MOST_TRIALS - 1
        )
        try:
            for future in self._as_completed(futures):
                yield future.exception()
                future.release()
        finally:
            self._client.cancel(futures)

    def close(self) -> None:
        """Disconnect from a cluster that was connected by its address."""
        if self._owns_client:
            self._client.close()


def _run_task(task: tuple[Any, ...], *, function: Callable[..., None], inputs: list[Any]) -> None:
    _set_allocator()
    with plain_faults():
        function(*inputs, *task)


@cache
def _set_allocator() -> None:
    """Let a worker return freed memory, or Dask pauses it; its own setting is slower."""
    with suppress(OSError, AttributeError):  # of another C library
        libc = ctypes.CDLL("libc.so.6")
        for parameter, value in (TRIM, MMAP):
            libc.mallopt(parameter, value)


def _packed(value: object) -> bytes | None:
    """Return a pickled value for workers, ``None`` if it is too large to be sent."""
    try:
        data: bytes = import_extra("cloudpickle", "store").dumps(value)
    except Exception as error:
        raise PyramidError(
            f"the dataset cannot be sent to workers ({error}); build without a scheduler"
        ) from error
    if len(data) <= MOST_SENT:
        return data
    return None
