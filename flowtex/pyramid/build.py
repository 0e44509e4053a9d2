"""Building a pyramid: levels one after the other, then tiles, in threads or by a Dask cluster."""

from __future__ import annotations

import math
import uuid
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.extras import import_extra
from flowtex._util.progress import track
from flowtex.errors import FieldError
from flowtex.pyramid.checks import check_about, is_scalar_name, sealed
from flowtex.pyramid.layout import (
    HALOS,
    MOST_HELD,
    TRACES,
    Part,
    about_source,
    attributes_of,
    create_level,
    has_halos,
    parts_of,
)
from flowtex.pyramid.places import PyramidError, place_text, plain_faults, store_at
from flowtex.pyramid.samples import create_samples, ranges_of
from flowtex.pyramid.source import Source, source_of
from flowtex.pyramid.tasks import TileTask, make_finest, make_part, make_tile
from flowtex.pyramid.workers import PART_BYTES, TILE_BYTES, Cluster, Threads
from flowtex.tiles import TileKey
from flowtex.tiles.pyramid import level_lines, level_shape

__all__ = ["Built", "build"]

#: So many failures one after the other end a build: the store is full, or nobody may write there.
MOST_FAILURES = 20
#: What a field is known again by, and how it is drawn.
IDENTITY = (
    *("format", "fingerprint", "nodes", "parameter", "lines", "depth", "tile_cells"),
    *("periodic", "projection", "scalars", "units", "time_unit", "length_unit", "start"),
)


@dataclass(frozen=True)
class Built:
    """What was built.

    Attributes
    ----------
    place
        The store.
    depth
        Its coarsest level.
    made, kept
        Shards of nodes and tiles that were made, and that were there already.

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
    levels: str = "coarse",
    parameter: str = "arclength",
    lines: str = "auto",
    scheduler: Any = None,
    memory: int | str | None = None,
    progress: bool = True,
    **options: Any,
) -> Built:
    """Build the pyramid of a field in a store, from which any part of it is drawn at once.

    Parameters
    ----------
    source
        A field, a dataset of xarray's, or a file as for :meth:`flowtex.FlowField.from_file`.
    store
        A local folder such as ``"flow.zarr"``, or a URL such as ``"s3://bucket/flow.zarr"``;
        endpoint and credentials come from the environment.
    levels
        Which tiles are traced: ``"coarse"`` leaves those of the finest level to be traced when they
        are looked at, ``"all"`` is for places where nothing can be computed.
    parameter, lines
        As in :class:`~flowtex.Settings`.
    scheduler
        A client of Dask's, or the address of a scheduler such as ``"tcp://host:8786"``; threads
        of this process by default. Its workers must reach the store, and the data.
    memory
        What threads may take of the memory, in bytes or such as ``"2GB"``; fewer of them run where
        it is little. By default there is one for each core.
    progress
        Whether a bar is shown.
    **options
        How a dataset or a file becomes a field: as for :meth:`flowtex.FlowField.from_xarray` or
        :meth:`flowtex.FlowField.from_file`, such as ``u``, ``v``, ``globe`` or ``level``.

    Returns
    -------
    Built

    Raises
    ------
    FieldError
        When the source makes no field, is one of triangles or without a sign, has a scalar whose
        name is none of an array, or the store holds another one.
        When ``levels`` is none of its words.
    PyramidError
        When tasks have failed; a second call makes what is missing.

    Notes
    -----
    What is there already is not made again, so a build that was ended at any moment goes on where
    it was.

    Of a dataset on lines of longitude and latitude, or of x and y, each task reads a region, if it
    is drawn on a globe, plate carree or Mercator's map. Neither this process nor a worker then
    holds more of it than that, and lines of coordinates. Chunks of the data should not be much
    larger than a region, 512 by 1,024 nodes of a time step. Of anything else a time step has to fit
    into the memory of this process. A task takes 1.5 GB at most; a worker of a cluster needs
    that for each of its threads, and 0.5 GB for itself. Dask pauses one that has taken four fifths
    of its memory, so it should be given 2.5 GB for one thread.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(21, 41))
    >>> built = flowtex.pyramid.build(field, "gyre.zarr", progress=False)
    >>> flowtex.pyramid.build(field, "gyre.zarr", progress=False).made  # all is there
    0
    """
    if levels not in ("coarse", "all"):
        msg = f"levels is {levels!r}; expected 'coarse' or 'all'"
        raise FieldError(msg)
    if lines not in ("auto", "pathlines", "streamlines"):
        msg = f"lines is {lines!r}; expected 'auto', 'pathlines' or 'streamlines'"
        raise FieldError(msg)
    given = source_of(source, **options)
    place = place_text(store)
    about = about_source(given, parameter, given.chosen_lines(lines), levels)
    threads = Threads(memory)
    workers = threads if scheduler is None else Cluster(scheduler)
    with plain_faults(), closing(workers):
        group, about = _prepared(place, about, given)
        run, depth = _Run(place, group, about, progress), about["depth"]
        _write_finest(run, given, workers if given.travels else threads)
        for level in range(1, depth + 1):
            parts = _missing_parts(run, level, level_shape(given.shape, level))
            run.work(workers, make_part, parts, f"Level {level} of {depth}", PART_BYTES)
        run.tell(levels_done=True)
        tiles = [task for level in reversed(about["traced"]) for task in _tiles(run, level)]
        run.work(workers, make_tile, tiles, "Tiles", TILE_BYTES)
        run.work(workers, make_tile, _uneven(run), "Tiles with wide halos", TILE_BYTES, new=False)
        run.tell(complete=True)
    return Built(place, depth, run.made, run.kept)


def _prepared(place: str, about: dict[str, Any], source: Source) -> tuple[Any, dict[str, Any]]:
    """Return the group at a place and what it tells, making both where there is none."""
    wrong = [name for name in about["scalars"] if not is_scalar_name(name)]
    if wrong:
        msg = f"scalar {wrong[0]!r} cannot be stored; expected a name without '/', so rename it"
        raise FieldError(msg)
    zarr = import_extra("zarr", "store")
    group = zarr.open_group(store_at(place, read_only=False), mode="a")
    there = group.attrs.get("flowtex")
    if there is None:
        if any(True for _ in group.members()):
            msg = f"{place} holds other data; give a place where there is nothing yet"
            raise PyramidError(msg)
        about = {**about, "ranges": source.ranges or {}}
        group.attrs.update(attributes_of(about))
    else:
        there = check_about(there, place)
        other = [name for name in IDENTITY if there.get(name) != about[name]]
        if other:
            msg = (
                f"{place} holds the pyramid of another field ({', '.join(other)} differ); remove "
                "it, or give another place"
            )
            raise PyramidError(msg)
        traced = sorted({*there["traced"], *about["traced"]})
        about = {**there, "traced": traced, "complete": False}
        group.attrs["flowtex"] = sealed(about)
    for level in range(about["depth"] + 1):
        create_level(group, level, level_shape(source.shape, level), about)
    if not about["ranges"]:
        create_samples(group, about)
    return group, about


class _Run:
    """One call of :func:`build`, and what it has made."""

    def __init__(self, place: str, group: Any, about: dict[str, Any], progress: bool) -> None:  # noqa: FBT001
        self.place, self.group, self.about, self.progress = place, group, about, progress
        self.name = uuid.uuid4().hex
        self.made = self.kept = 0

    def tell(self, **words: Any) -> None:
        """Write more of what is told of the pyramid; what workers have opened does not know it.

        Another builder may have begun meanwhile, with more tiles to be traced.
        """
        self.about = {**self.about, **words}
        zarr = import_extra("zarr", "store")
        there = zarr.open_group(self.group.store, mode="r").attrs["flowtex"]
        traced = sorted({*there["traced"], *self.about["traced"]})
        told = {**there, **self.about, "traced": traced}
        if traced != self.about["traced"]:
            told["complete"] = there["complete"]
        self.group.attrs["flowtex"] = sealed(told)
        self.name = uuid.uuid4().hex

    def there(self, name: str) -> set[tuple[int, ...]]:
        """Return the numbers of the shards of an array that are in the store."""
        from zarr.core.sync import sync

        array = self.group[name]
        prefix = f"{array.path}/c/"

        async def keys() -> list[str]:
            return [key async for key in array.store.list_prefix(prefix)]

        # A file that is being written is no shard yet.
        numbers = (key.removeprefix(prefix).split("/") for key in sync(keys()))
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

        Each needs so many bytes. Shards that are not ``new`` were counted when they were made.
        """
        if new:
            self.made += sum(len(t.steps) if isinstance(t, TileTask) else 1 for t in tasks)
        results = workers.run(
            function, [(self.place, self.name, task) for task in tasks], need, *given
        )
        first, failed, in_a_row = None, 0, 0
        for error in track(results, len(tasks), text, show=self.progress):
            if error is None:
                in_a_row = 0
                continue
            first, failed, in_a_row = first or error, failed + 1, in_a_row + 1
            if in_a_row == MOST_FAILURES:
                break
        if first is not None:
            what = f"{failed} of {len(tasks)}" if in_a_row < MOST_FAILURES else f"{failed} in a row"
            msg = (
                f"{what} shards could not be made in {self.place}; the first: "
                f"{type(first).__name__}: {first}. Build again to make what is missing"
            )
            raise PyramidError(msg) from first


def _write_finest(run: _Run, source: Source, workers: Threads) -> None:
    """Write level 0; nodes of the first step come first, for they tell which are valid."""
    if run.about["axes"]:
        _write_axes(run, source)
    parts = _missing_parts(run, 0, source.shape)
    for some in ([p for p in parts if p.step == 0], [p for p in parts if p.step > 0]):
        run.work(workers, make_finest, some, "Level 0", PART_BYTES, source)
    if not run.about["ranges"]:
        ranges = ranges_of(run.group, run.about)
        if not ranges:
            msg = (
                f"none of the {math.prod(source.shape):,} nodes has data; check the variables that "
                "were chosen"
            )
            raise FieldError(msg)
        run.tell(ranges=ranges)


def _write_axes(run: _Run, source: Source) -> None:
    first = np.array([0])
    for level in range(run.about["depth"] + 1):
        rows, columns = (level_lines(n, level) for n in source.shape)
        run.group[f"{level}/x"][:] = source.points(first, columns)[0, :, 0]
        run.group[f"{level}/y"][:] = source.points(rows, first)[:, 0, 1]


def _missing_parts(run: _Run, level: int, shape: tuple[int, int]) -> list[Part]:
    there = run.there(f"{level}/velocity")
    parts = parts_of(level, shape, len(run.about["times"]))
    missing = [part for part in parts if (part.step, part.row, part.column, 0) not in there]
    run.kept += len(parts) - len(missing)
    return missing


def _tiles(run: _Run, level: int) -> Iterator[TileTask]:
    """Give the tiles of a level that are missing, a few steps at a time."""
    name = f"{level}/{TRACES}"
    there = run.there(name)
    steps, rows, columns = run.group[name].shape[:3]
    told = None
    if has_halos(run.about, level):
        halos = run.group[f"{level}/{HALOS}"]
        # There may be millions of them, of which none is asked for where there is none.
        told = np.asarray(halos) if run.there(f"{level}/{HALOS}") else np.zeros(halos.shape)
    for row in range(rows):
        for column in range(columns):
            for first in range(0, steps, MOST_HELD):
                every = range(first, min(first + MOST_HELD, steps))
                missing = [
                    t
                    for t in every
                    if (t, row, column, 0, 0, 0, 0) not in there
                    or (told is not None and not told[t, row, column].all())
                ]
                run.kept += len(every) - len(missing)
                if missing:
                    yield TileTask(TileKey(level, row, column), tuple(missing))


def _uneven(run: _Run) -> list[TileTask]:
    """Return the tiles of which some steps were made with another halo than the tile needs."""
    tasks = []
    for level in run.about["traced"]:
        if not has_halos(run.about, level):
            continue
        halos = np.asarray(run.group[f"{level}/{HALOS}"])
        widest = halos[..., 0].max(axis=0)
        for row, column in np.argwhere((halos[..., 1] != widest).any(axis=0)).tolist():
            other = np.flatnonzero(halos[:, row, column, 1] != widest[row, column])
            for some in np.split(other, np.flatnonzero(np.diff(other // MOST_HELD)) + 1):
                key, spare = TileKey(level, row, column), int(widest[row, column])
                tasks.append(TileTask(key, tuple(some.tolist()), spare))
    return tasks
