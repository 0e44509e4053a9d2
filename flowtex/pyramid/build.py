"""Building a pyramid: levels one after the other, then tiles, in threads or on a Dask cluster."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.cache import digest
from flowtex._util.progress import track
from flowtex.errors import FieldError, import_extra
from flowtex.pyramid.layout import (
    DIGESTS,
    FLOW,
    MOST_HELD,
    VALUES,
    Part,
    about_source,
    check_about,
    described,
    is_scalar_name,
    parts_of,
    sealed,
    tiles_of,
)
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.places import (
    DOCUMENT,
    ChangedError,
    DamageError,
    PyramidError,
    building,
    check_room,
    is_store,
    listed,
    place_text,
    plain_faults,
    store_at,
    sync,
)
from flowtex.pyramid.source import NodeSource, source_of
from flowtex.pyramid.tasks import (
    PART_BYTES,
    TILE_BYTES,
    Cluster,
    Threads,
    TileTask,
    checks_of,
    compare_finest,
    make_finest,
    make_part,
    make_tile,
    mend,
)
from flowtex.settings import TABLE
from flowtex.textures.tiles.grid_levels import level_lines, level_shape
from flowtex.textures.tiles.pyramid import TileKey

if TYPE_CHECKING:
    from zarr import Group
    from zarr.abc.store import Store

MOST_FAILURES = 20  #: Failures in a row that end a build: the store may be full or write-protected.
#: Entries that identify a field and how it is drawn.
IDENTITY = (
    *("format", "times", "nodes", "parameter", "lines", "depth", "tile_cells", "components"),
    *("axes", "height", "has_position", "periodic", "projection", "scalars", "uncertainty"),
    *("units", "time_unit", "length_unit", "velocity_unit", "start"),
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

    The data of the source are read again and compared with the checksums of all parts in the store.

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
    lines = TABLE["lines"].check(lines)
    parameter = TABLE["parameter"].check(parameter)
    place = place_text(store)
    with plain_faults():
        check_room(place, listed(store_at(place, read_only=False).list_dir))
    data = source_of(source, **options)
    about = about_source(data, parameter, data.chosen_lines(lines))
    for name in about["scalars"]:
        if not is_scalar_name(name):
            raise FieldError(
                f"scalar {name!r} cannot be stored; expected a name without '/': rename it"
            )
    threads = Threads(memory)
    if scheduler is None:
        workers = threads
    else:
        workers = Cluster(scheduler)
    with plain_faults(), closing(workers), building(place):
        group, about, new = _prepared(place, about, data, fresh=fresh)
        run = _Run(place, group, about, progress)
        depth = about["depth"]
        if not new:
            # Corrupt and incomplete objects are removed.
            units = sorted({*_existing_units(run)}, key=repr)
            run.work(workers, mend, units, "Checking existing objects", TILE_BYTES, new=False)
        if data.travels:
            _write_finest(run, data, workers)
        else:
            _write_finest(run, data, threads)
        for level in range(1, depth + 1):
            parts = _missing_parts(run, level, level_shape(data.shape, level))
            run.work(workers, make_part, parts, f"Level {level} of {depth}", PART_BYTES)
        run.update(levels_done=True)
        tasks: list[TileTask] = []
        for level in range(depth, -1, -1):
            tasks += _missing_tiles(run, level)
        run.work(workers, make_tile, tasks, "Tiles", TILE_BYTES)
        run.update(complete=True)
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
        A sentence for each part, tile or document of metadata that is missing or corrupt. A build
        from the same source restores them.

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
    levels = Levels(store)
    faults: list[str] = []
    about = levels.about
    for _, node in described(about).members(max_depth=None):
        try:
            levels.check_document(node)
        except DamageError as fault:
            faults.append(str(fault))

    def inspect(unit: Part | TileTask) -> None:
        for _, check in checks_of(levels, unit):
            try:
                check()
            except DamageError as error:
                faults.append(str(error))

    units: list[tuple[Part | TileTask]] = []
    for level in range(about["depth"] + 1):
        parts = parts_of(level, levels.shape(level), len(about["times"]))
        units += [(part,) for part in parts]
        steps = tuple(range(len(about["times"])))
        for row, column in np.ndindex(tiles_of(level, levels.shape(level), about)):
            units.append((TileTask(TileKey(level, row, column), steps),))
    with closing(Threads().run(inspect, units, TILE_BYTES)) as results:
        for error in track(results, len(units), "Verifying", show=progress):
            if error is not None:
                raise error
    return sorted(faults)


def _prepared(
    place: str, about: dict[str, Any], source: NodeSource, *, fresh: bool
) -> tuple[Group, dict[str, Any], bool]:
    """Return the group of a store, its description, and whether it is new."""
    zarr = import_extra("zarr", "store")
    from zarr.buffer import default_buffer_prototype

    store = store_at(place, read_only=False)
    if fresh:
        _remove(store)
    if is_store(place):
        stored = zarr.open_group(store, mode="r").attrs["flowtex"]
    else:
        stored = None
    if stored is None:
        about = {**about, "ranges": source.ranges()}
    else:
        stored = check_about(stored, place)
        entries = {"uncertainty": "", "velocity_unit": "", **stored}  # earlier versions wrote none
        differing = [name for name in IDENTITY if entries.get(name) != about[name]]
        if differing:
            raise PyramidError(
                f"{place} contains the pyramid of another field ({', '.join(differing)} differ); "
                "build with fresh=True, or in another place"
            )
        about = {**stored, "complete": False}
    metadata = described(about).store
    kind = default_buffer_prototype()
    # Those of the group come first: they show that the place is taken.
    for name in sorted(listed(metadata.list_prefix), key=lambda name: name.count("/")):
        document: Any = sync(metadata.get(name, kind))
        sync(store.set(name, document))
    return zarr.open_group(store, mode="r+"), about, stored is None


def _remove(store: Store) -> None:
    """Remove a pyramid, coarse levels first; the metadata that identify it are the last to go."""
    levels = sorted(filter(str.isdecimal, listed(store.list_dir)), key=int, reverse=True)
    for name in levels:
        sync(store.delete_dir(name))
    sync(store.delete(DOCUMENT))


@dataclass
class _Run:
    """One call of :func:`build`: its store, and numbers of shards."""

    place: str
    group: Any
    about: dict[str, Any]
    progress: bool
    name: str = field(default_factory=lambda: uuid.uuid4().hex)
    made: int = 0
    kept: int = 0

    def update(self, **entries: Any) -> None:
        """Add to the description of the pyramid; under the new name, workers open it again."""
        self.about = {**self.about, **entries}
        self.group.attrs["flowtex"] = sealed(self.about)
        self.name = uuid.uuid4().hex

    def shards(self, name: str) -> set[tuple[int, ...]]:
        """Return the numbers of the shards of an array that are in the store."""
        array = self.group[name]
        prefix = f"{array.path}/c/"
        # A file that is being written is not a shard yet.
        keys = listed(array.store.list_prefix, prefix)
        found = set()
        for key in keys:
            numbers = key.removeprefix(prefix).split("/")
            if all(map(str.isdecimal, numbers)):
                found.add(tuple(map(int, numbers)))
        return found

    def work(
        self,
        workers: Threads,
        function: Callable[..., None],
        tasks: Sequence[Part | TileTask],
        text: str,
        need: int,
        *arguments: Any,
        new: bool = True,
    ) -> None:
        """Run tasks that need ``need`` bytes each, and raise when some have failed."""
        if new:
            for task in tasks:
                if isinstance(task, TileTask):
                    self.made += len(task.steps)
                else:
                    self.made += 1
        named = [(self.place, self.name, task) for task in tasks]
        first = None
        failed = 0
        in_a_row = 0
        # An error holds its frames: the workers would end whenever these are collected.
        with closing(workers.run(function, named, need, *arguments)) as results:
            for error in track(results, len(tasks), text, show=self.progress):
                if isinstance(error, ChangedError):
                    raise error
                if error is None:
                    in_a_row = 0
                    continue
                first = first or error
                failed = failed + 1
                in_a_row = in_a_row + 1
                if in_a_row == MOST_FAILURES:
                    break
        if first is not None:
            if in_a_row < MOST_FAILURES:
                count = f"{failed} of {len(tasks)}"
            else:
                count = f"{failed} in a row"
            raise PyramidError(
                f"{count} shards could not be built in {self.place}; the first error is "
                f"{type(first).__name__}: {first}. Build again to build the missing ones"
            ) from first


def _write_finest(run: _Run, source: NodeSource, workers: Threads) -> None:
    """Write level 0; the first step comes first, as it determines the valid nodes."""
    existing = _existing_parts(run, 0)
    parts = _missing_parts(run, 0, source.shape)
    if parts and run.about.get("levels_done"):
        run.update(levels_done=False)
    at_start = [p for p in parts if p.step == 0]
    later = [p for p in parts if p.step > 0]
    run.work(workers, make_finest, at_start, "Level 0", PART_BYTES, source)
    text = "Comparing with the source"
    run.work(workers, compare_finest, existing, text, PART_BYTES, source, new=False)
    run.work(workers, make_finest, later, "Level 0", PART_BYTES, source)
    if run.about["axes"]:
        first = np.array([0])
        for level in range(run.about["depth"] + 1):
            rows = level_lines(source.shape[0], level)
            columns = level_lines(source.shape[1], level)
            run.group[f"{level}/x"][:] = source.points(first, columns)[0, :, 0]
            run.group[f"{level}/y"][:] = source.points(rows, first)[:, 0, 1]
    digests = Levels(run.place).whole(f"0/{DIGESTS}")
    fingerprint = digest(digests, words=run.about["times"]).hex()
    if run.about["fingerprint"] not in ("", fingerprint):
        raise ChangedError(
            f"{run.place} was built from an earlier version of the field; build with fresh=True"
        )
    run.update(fingerprint=fingerprint)


def _existing_units(run: _Run) -> Iterator[Part | TileTask]:
    """Yield what an earlier run has written: parts of nodes, and tiles at one time step each.

    A name of an array is that of its level and its kind, such as ``"0/velocity"``.
    """
    for _, array in described(run.about).members(max_depth=None):
        axes: Any = getattr(array.metadata, "dimension_names", None) or ()
        level, _, kind = array.path.partition("/")
        if kind in (FLOW, VALUES):
            for step, row, column, *_ in run.shards(array.path):
                yield TileTask(TileKey(int(level), row, column), (step,))
        elif {"j", "i"} <= {*axes}:
            for numbers in run.shards(array.path):
                if axes[0] == "time":
                    step, row, column = numbers[:3]
                else:
                    step = 0
                    row, column = numbers[:2]
                yield Part(int(level), step, row, column)


def _existing_parts(run: _Run, level: int) -> list[Part]:
    return sorted(Part(level, *numbers[:3]) for numbers in run.shards(f"{level}/velocity"))


def _missing_parts(run: _Run, level: int, shape: tuple[int, int]) -> list[Part]:
    existing = {*_existing_parts(run, level)}
    parts = parts_of(level, shape, len(run.about["times"]))
    missing = []
    for part in parts:
        if part not in existing:
            missing.append(part)
    run.kept += len(parts) - len(missing)
    return missing


def _missing_tiles(run: _Run, level: int) -> Iterator[TileTask]:
    """Yield the missing tiles of a level, a few steps at a time."""
    existing = run.shards(f"{level}/{FLOW}")
    steps, rows, columns, _ = run.group[f"{level}/{FLOW}"].shape
    for row in range(rows):
        for column in range(columns):
            for first in range(0, steps, MOST_HELD):
                group = range(first, min(first + MOST_HELD, steps))
                missing = []
                for t in group:
                    if (t, row, column, 0) not in existing:
                        missing.append(t)
                run.kept += len(group) - len(missing)
                if missing:
                    yield TileTask(TileKey(level, row, column), tuple(missing))
