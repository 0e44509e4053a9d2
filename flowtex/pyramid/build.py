"""Building a pyramid: levels one after the other, then tiles, in threads or on a Dask cluster."""

from __future__ import annotations

import math
import uuid
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.cache import digest
from flowtex._util.extras import import_extra
from flowtex._util.progress import track
from flowtex.errors import FieldError
from flowtex.pyramid.checks import check_about, is_scalar_name, sealed
from flowtex.pyramid.layout import (
    DIGESTS,
    FLOW,
    MOST_HELD,
    VALUES,
    Part,
    about_source,
    described,
    parts_of,
    tiles_of,
)
from flowtex.pyramid.lease import Lease
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.places import (
    DOCUMENT,
    ChangedError,
    DamageError,
    PyramidError,
    check_room,
    is_store,
    listed,
    place_text,
    plain_faults,
    store_at,
    sync,
)
from flowtex.pyramid.samples import SAMPLES, create_samples, ranges_of
from flowtex.pyramid.source import Source, source_of
from flowtex.pyramid.tasks import (
    TileTask,
    checks_of,
    compare_finest,
    make_finest,
    make_part,
    make_tile,
    mend,
)
from flowtex.pyramid.workers import PART_BYTES, TILE_BYTES, Cluster, Threads
from flowtex.textures.tiles import TileKey
from flowtex.textures.tiles.pyramid import level_lines, level_shape

#: So many failures one after the other end a build: the store is full, or write-protected.
MOST_FAILURES = 20
#: What a field is known again by, and how it is drawn.
IDENTITY = (
    *("format", "times", "nodes", "parameter", "lines", "depth", "tile_cells", "components"),
    *("axes", "height", "has_position", "periodic", "projection", "scalars", "uncertainty"),
    *("units", "time_unit", "length_unit", "start"),
)


@dataclass(frozen=True)
class Built:
    """The result of a build.

    Attributes
    ----------
    place
        The store.
    depth
        Its coarsest level.
    made, kept
        Numbers of shards that were built, and that already existed.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(21, 41))
    >>> flowtex.pyramid.build(field, "gyre.zarr", progress=False).depth
    0
    """

    place: str
    depth: int
    made: int
    kept: int


def build(
    source: Any,
    store: str | Path,
    *,
    parameter: str = "arclength",
    lines: str = "auto",
    scheduler: Any = None,
    memory: int | str | None = None,
    fresh: bool = False,
    progress: bool = True,
    **options: Any,
) -> Built:
    """Build the pyramid of a field in a store, from which any part can be drawn quickly.

    Parameters
    ----------
    source
        A field, a PyVista mesh, an xarray dataset, or a file as for
        :meth:`flowtex.FlowField.from_file`.
    store
        A local folder such as ``"flow.zarr"``, or a URL such as ``"s3://bucket/flow.zarr"``;
        endpoint and credentials come from the environment.
    parameter, lines
        As in :class:`~flowtex.Settings`.
    scheduler
        A Dask client, or the address of a scheduler such as ``"tcp://host:8786"``; threads of this
        process by default. The workers must have access to the store and the data.
    memory
        Memory limit of the threads, in bytes or such as ``"2GB"``; a low limit reduces their
        number. By default one thread runs for each core.
    fresh
        Whether an existing pyramid is removed first.
    progress
        Whether to show a progress bar.
    **options
        Arguments of :meth:`flowtex.FlowField.from_xarray`, ``from_pyvista`` or ``from_file``, such
        as ``u``, ``v``, ``globe`` or ``level``, and ``uncertainty`` for any source.

    Returns
    -------
    Built

    Raises
    ------
    FieldError
        When the source does not contain a field, is on triangles or sign-free, or has a scalar
        whose name is not valid for a Zarr array.
    PyramidError
        When the store contains other data, the pyramid of another field or of an earlier version of
        this one, or another build is writing it; or when tasks have failed. A second call then
        builds the missing parts.

    Notes
    -----
    A build continues where an interrupted one stopped: it checks the existing parts, and builds
    only those that are missing or corrupt.

    A store identifies its source by the paths, sizes and modification times of the files. If these
    differ, or if the source is a dataset or a field in memory, the data are read again and compared
    with the checksums of all parts in the store.

    Each task reads one region, of 512 by 1,024 nodes of a time step, if the source is a dataset on
    one-dimensional coordinates that is drawn on a globe, a plate carree or a Mercator map. Neither
    this process nor a worker then has more of it in memory, and the chunks of the data should not
    be much larger than a region. From any other source, a time step must fit into the memory of
    this process. A task needs up to 1.5 GB; a worker of a cluster needs this for each of its
    threads, and 0.5 GB more. Dask pauses a worker that uses 80 % of its memory, so give a worker
    with one thread 2.5 GB.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(21, 41))
    >>> built = flowtex.pyramid.build(field, "gyre.zarr", progress=False)
    >>> flowtex.pyramid.build(field, "gyre.zarr", progress=False).made  # all is there
    0
    """
    if lines not in ("auto", "pathlines", "streamlines"):
        msg = f"lines is {lines!r}; expected 'auto', 'pathlines' or 'streamlines'"
        raise FieldError(msg)
    place = place_text(store)
    with plain_faults():
        check_room(place, listed(store_at(place, read_only=False).list_dir))
    given = source_of(source, **options)
    about = about_source(given, parameter, given.chosen_lines(lines))
    wrong = [name for name in about["scalars"] if not is_scalar_name(name)]
    if wrong:
        msg = f"scalar {wrong[0]!r} cannot be stored; expected a name without '/': rename it"
        raise FieldError(msg)
    known, threads = about["source"], Threads(memory)
    workers = threads if scheduler is None else Cluster(scheduler)
    with plain_faults(), closing(workers), Lease(place) as lease:
        group, arrays, about, new = _prepared(place, about, given, fresh=fresh)
        run, depth = _Run(group, arrays, about, lease, known, progress), about["depth"]
        if not new:
            # Corrupt and incomplete objects are removed.
            begun = sorted({unit for name in run.arrays for unit in _begun(run, name)}, key=repr)
            run.work(workers, mend, begun, "Checking existing objects", TILE_BYTES, new=False)
        _write_finest(run, given, workers if given.travels else threads)
        for level in range(1, depth + 1):
            parts = _missing_parts(run, level, level_shape(given.shape, level))
            run.work(workers, make_part, parts, f"Level {level} of {depth}", PART_BYTES)
        run.tell(levels_done=True)
        tiles = [task for level in range(depth, -1, -1) for task in _tiles(run, level)]
        run.work(workers, make_tile, tiles, "Tiles", TILE_BYTES)
        run.tell(complete=True)
    return Built(place, depth, run.made, run.kept)


def verify(store: str | Path, *, progress: bool = True) -> list[str]:
    """Read the whole pyramid, and return its missing and corrupt parts.

    Every object is decompressed and compared with its checksum, its size and its position; parts of
    levels also with the checksum of their values.

    Parameters
    ----------
    store
        A folder or a URL, as for :func:`flowtex.pyramid.open_store`.
    progress
        Whether to show a progress bar.

    Returns
    -------
    list of str
        A sentence for each part or tile that is missing or corrupt. A build from the same source
        restores them.

    Raises
    ------
    PyramidError
        When the store contains no pyramid, or cannot be read.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(21, 41))
    >>> built = flowtex.pyramid.build(field, "gyre.zarr", progress=False)
    >>> flowtex.pyramid.verify("gyre.zarr", progress=False)
    []
    """
    levels, found = Levels(store), []
    about = levels.about

    def look(unit: Part | TileTask) -> None:
        for _, check in checks_of(levels, unit):
            try:
                check()
            except DamageError as error:
                found.append(str(error))

    units: list[tuple[Part | TileTask]] = []
    for level in range(about["depth"] + 1):
        parts = parts_of(level, levels.shape(level), len(about["times"]))
        units += [(part,) for part in parts]
        rows, columns = tiles_of(level, levels.shape(level), about)
        keys = (TileKey(level, row, column) for row in range(rows) for column in range(columns))
        units += [(TileTask(key, tuple(range(len(about["times"])))),) for key in keys]
    with closing(Threads().run(look, units, TILE_BYTES)) as results:
        for error in track(results, len(units), "Verifying", show=progress):
            if error is not None:
                raise error
    return sorted(found)


def _prepared(
    place: str, about: dict[str, Any], source: Source, *, fresh: bool
) -> tuple[Any, dict[str, Sequence[str]], dict[str, Any], bool]:
    """Return the group of a store, its arrays, its description, and whether it is new."""
    zarr = import_extra("zarr", "store")
    store = store_at(place, read_only=False)
    if fresh:
        _remove(store)
    there = zarr.open_group(store, mode="r").attrs["flowtex"] if is_store(place) else None
    if there is None:
        about = {**about, "ranges": source.ranges()}
    else:
        there = check_about(there, place)
        known = {"uncertainty": "", **there}  # earlier versions wrote none
        other = [name for name in IDENTITY if known.get(name) != about[name]]
        if other:
            msg = (
                f"{place} contains the pyramid of another field ({', '.join(other)} differ); "
                "build with fresh=True to replace it, or choose another place"
            )
            raise PyramidError(msg)
        about = {**there, "complete": False}
    arrays = _describe(store, about)
    return zarr.open_group(store, mode="r+"), arrays, about, there is None


def _describe(store: Any, about: dict[str, Any]) -> dict[str, Sequence[str]]:
    """Write what follows from ``about``, and return the axes of the arrays by name."""
    zarr = import_extra("zarr", "store")
    group = described(about)
    if not about["ranges"]:
        create_samples(group, about)

    async def copy() -> None:
        kind = zarr.core.buffer.default_buffer_prototype()
        # That of the group comes first: by it others know that the place is taken.
        for name in sorted([name async for name in group.store.list()], key=lambda n: n.count("/")):
            await store.set(name, await group.store.get(name, kind))

    sync(copy())
    arrays = (array for _, array in group.members(max_depth=None) if isinstance(array, zarr.Array))
    return {array.path: array.metadata.dimension_names for array in arrays}


def _remove(store: Any) -> None:
    """Remove a pyramid, what was made of a level before that; others know it to the end."""
    levels = sorted(filter(str.isdecimal, listed(store.list_dir)), key=int, reverse=True)
    for name in (*levels, SAMPLES):
        sync(store.delete_dir(name))
    sync(store.delete(DOCUMENT))


class _Run:
    """One call of :func:`build`, and what it has made."""

    def __init__(
        self,
        group: Any,
        arrays: Mapping[str, Sequence[str]],
        about: dict[str, Any],
        lease: Lease,
        source: str,
        progress: bool,  # noqa: FBT001
    ) -> None:
        self.place, self.group, self.arrays, self.about = lease.place, group, arrays, about
        self.lease, self.source, self.progress = lease, source, progress
        self.name = uuid.uuid4().hex
        self.made = self.kept = 0

    def tell(self, **words: Any) -> None:
        """Add to the description of the pyramid; what workers have opened does not know it."""
        self.lease.check()
        self.about = {**self.about, **words}
        self.group.attrs["flowtex"] = sealed(self.about)
        self.name = uuid.uuid4().hex

    def there(self, name: str) -> set[tuple[int, ...]]:
        """Return the numbers of the shards of an array that are in the store."""
        array = self.group[name]
        prefix = f"{array.path}/c/"
        # A file that is being written is not a shard yet.
        keys = listed(array.store.list_prefix, prefix)
        numbers = (key.removeprefix(prefix).split("/") for key in keys)
        return {tuple(map(int, some)) for some in numbers if all(map(str.isdecimal, some))}

    def work(
        self,
        workers: Threads,
        function: Callable[..., None],
        tasks: Sequence[Any],
        text: str,
        need: int,
        *given: Any,
        new: bool = True,
    ) -> None:
        """Run tasks, and raise when some have failed though they were tried again.

        Each needs this many bytes. Shards that are not ``new`` were counted when they were made.
        """
        if new:
            self.made += sum(len(t.steps) if isinstance(t, TileTask) else 1 for t in tasks)
        named = [(self.place, self.name, task) for task in tasks]
        first, failed, in_a_row = None, 0, 0
        # An error holds what it came through: the workers would end whenever that is collected.
        with closing(workers.run(function, named, need, *given)) as results:
            for error in track(results, len(tasks), text, show=self.progress):
                self.lease.check()
                if isinstance(error, ChangedError):
                    raise error
                if error is None:
                    in_a_row = 0
                    continue
                first, failed, in_a_row = first or error, failed + 1, in_a_row + 1
                if in_a_row == MOST_FAILURES:
                    break
        if first is not None:
            what = f"{failed} of {len(tasks)}" if in_a_row < MOST_FAILURES else f"{failed} in a row"
            msg = (
                f"{what} shards could not be built in {self.place}; the first error is "
                f"{type(first).__name__}: {first}. Build again to build the missing ones"
            )
            raise PyramidError(msg) from first


def _begun(run: _Run, name: str) -> Iterator[Part | TileTask]:
    """Give the parts, or the tiles at a step, of which an array has an object."""
    axes, (top, _, kind) = run.arrays[name], name.partition("/")
    if kind in (FLOW, VALUES):
        for step, row, column, *_ in run.there(name):
            yield TileTask(TileKey(int(top), row, column), (step,))
    elif {"j", "i"} <= {*axes}:
        for numbers in run.there(name):
            step, row, column = (numbers if axes[0] == "time" else (0, *numbers))[:3]
            yield Part(int(top), step, row, column)


def _write_finest(run: _Run, source: Source, workers: Threads) -> None:
    """Write level 0; nodes of the first step come first, for they tell which are valid."""
    there, parts = _parts_there(run, 0), _missing_parts(run, 0, source.shape)
    if parts and run.about.get("levels_done"):
        run.tell(levels_done=False)
    begin, later = [p for p in parts if p.step == 0], [p for p in parts if p.step > 0]
    run.work(workers, make_finest, begin, "Level 0", PART_BYTES, source)
    if not run.source or run.source != run.about["source"]:
        text = "Comparing with the source"
        run.work(workers, compare_finest, there, text, PART_BYTES, source, new=False)
        run.tell(source=run.source)
    run.work(workers, make_finest, later, "Level 0", PART_BYTES, source)
    if run.about["axes"]:
        first = np.array([0])
        for level in range(run.about["depth"] + 1):
            rows, columns = (level_lines(n, level) for n in source.shape)
            run.group[f"{level}/x"][:] = source.points(first, columns)[0, :, 0]
            run.group[f"{level}/y"][:] = source.points(rows, first)[:, 0, 1]
    if source.identity() != run.source:
        run.tell(source="")
        msg = f"the source of {run.place} changed while it was read; build again"
        raise ChangedError(msg)
    levels = Levels(run.place)
    if not run.about["ranges"]:
        ranges = ranges_of(levels.whole(SAMPLES), run.about)
        if not ranges:
            msg = (
                f"none of the {math.prod(source.shape):,} nodes has data; check the selected "
                "variables"
            )
            raise FieldError(msg)
        run.tell(ranges=ranges)
    fingerprint = digest(levels.whole(f"0/{DIGESTS}"), words=run.about["times"]).hex()
    if run.about["fingerprint"] not in ("", fingerprint):
        msg = (
            f"{run.place} was built from an earlier version of the field; build with fresh=True "
            "to replace it"
        )
        raise ChangedError(msg)
    run.tell(fingerprint=fingerprint)


def _parts_there(run: _Run, level: int) -> list[Part]:
    return sorted(Part(level, *numbers[:3]) for numbers in run.there(f"{level}/velocity"))


def _missing_parts(run: _Run, level: int, shape: tuple[int, int]) -> list[Part]:
    there = {*_parts_there(run, level)}
    parts = parts_of(level, shape, len(run.about["times"]))
    missing = [part for part in parts if part not in there]
    run.kept += len(parts) - len(missing)
    return missing


def _tiles(run: _Run, level: int) -> Iterator[TileTask]:
    """Give the tiles of a level that are missing, a few steps at a time."""
    there = run.there(f"{level}/{FLOW}")
    steps, rows, columns, _ = run.group[f"{level}/{FLOW}"].shape
    for row in range(rows):
        for column in range(columns):
            for first in range(0, steps, MOST_HELD):
                every = range(first, min(first + MOST_HELD, steps))
                missing = [t for t in every if (t, row, column, 0) not in there]
                run.kept += len(every) - len(missing)
                if missing:
                    yield TileTask(TileKey(level, row, column), tuple(missing))
