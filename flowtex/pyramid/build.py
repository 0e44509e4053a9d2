"""Building a pyramid: levels one after the other, then tiles, in threads or by a Dask cluster."""

from __future__ import annotations

import os
import uuid
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.extras import import_extra
from flowtex._util.progress import track
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.datasets.detect import is_dataset
from flowtex.pyramid.layout import TRACES, about_field, attributes_of, create_level, parts_of
from flowtex.pyramid.places import PyramidError, place_text, store_at
from flowtex.pyramid.tasks import TileTask, make_part, make_tile, write_part
from flowtex.tiles import Pyramid, TileKey, drawn_speeds, ends_of
from flowtex.tiles.pyramid import Nodes
from flowtex.trace import chosen_lines

__all__ = ["Built", "build"]

#: Times that a task is tried.
MOST_TRIALS = 3


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
    progress: bool = True,
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
        of this process by default. Its workers must reach the store.
    progress
        Whether a bar is shown.

    Returns
    -------
    Built

    Raises
    ------
    FieldError
        When the source makes no field, is one of triangles or without a sign, or the store holds
        another one.
    PyramidError
        When tasks have failed; a second call makes what is missing.
    ValueError
        When ``levels`` is none of its words.

    Notes
    -----
    What is there already is not made again, so a build that was ended at any moment goes on where
    it was. A time step of the source has to fit into the memory of this process; workers hold a
    region of a level each.

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
        raise ValueError(msg)
    field = _field_of(source)
    pyramid = Pyramid(field, parameter, chosen_lines(field, lines))
    place = place_text(store)
    group, about = _prepared(place, about_field(pyramid, levels), pyramid)
    run = _Run(place, group, about, progress)
    with closing(_workers(scheduler)) as workers:
        _write_finest(run, field)
        for level in range(1, pyramid.depth + 1):
            parts = _missing_parts(run, level, pyramid.shape(level))
            run.work(workers, make_part, parts, f"Level {level} of {pyramid.depth}")
        run.tell(levels_done=True)
        tiles = [task for level in reversed(about["traced"]) for task in _tiles(run, level)]
        run.work(workers, make_tile, tiles, "Tiles")
        run.tell(complete=True)
    return Built(place, pyramid.depth, run.made, run.kept)


def _field_of(source: Any) -> FlowField:
    if is_dataset(source):
        field = FlowField.from_xarray(source)
    elif isinstance(source, FlowField):
        field = source
    else:
        field = FlowField.from_file(source)
    if field.triangles is not None or field.sign_free:
        what = "on triangles" if field.triangles is not None else "without a sign"
        msg = f"the field is one {what}; expected one on a structured surface, with a direction"
        raise FieldError(msg)
    return field


def _prepared(place: str, about: dict[str, Any], pyramid: Pyramid) -> tuple[Any, dict[str, Any]]:
    """Return the group at a place and what it tells, making both where there is none."""
    zarr = import_extra("zarr", "store")
    group = zarr.open_group(store_at(place, read_only=False), mode="a")
    there = group.attrs.get("flowtex")
    if there is None:
        if any(True for _ in group.members()):
            msg = f"{place} holds other data; give a place where there is nothing yet"
            raise PyramidError(msg)
        about = {**about, "ranges": _ranges(pyramid)}
        group.attrs.update(attributes_of(about))
    else:
        told = ("format", "fingerprint", "nodes", "parameter", "lines", "depth", "tile_cells")
        other = [name for name in told if there.get(name) != about[name]]
        if other:
            msg = (
                f"{place} holds the pyramid of another field ({', '.join(other)} differ); remove "
                "it, or give another place"
            )
            raise PyramidError(msg)
        traced = sorted({*there["traced"], *about["traced"]})
        about = {**there, "traced": traced, "complete": False}
        group.attrs["flowtex"] = about
    for level in range(about["depth"] + 1):
        create_level(group, level, pyramid.shape(level), about)
    return group, about


class _Run:
    """One call of :func:`build`, and what it has made."""

    def __init__(self, place: str, group: Any, about: dict[str, Any], progress: bool) -> None:  # noqa: FBT001
        self.place, self.group, self.about, self.progress = place, group, about, progress
        self.name = uuid.uuid4().hex
        self.made = self.kept = 0

    def tell(self, **words: Any) -> None:
        """Write more of what is told of the pyramid."""
        self.about = {**self.about, **words}
        self.group.attrs["flowtex"] = self.about

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
        self, workers: _Workers, function: Callable[..., None], tasks: Sequence[Any], text: str
    ) -> None:
        """Run tasks, and raise when some have failed though they were tried again."""
        self.made += len(tasks)
        results = workers.run(function, self.place, self.name, tasks)
        errors = [
            error
            for error in track(results, len(tasks), text, show=self.progress)
            if error is not None
        ]
        if errors:
            msg = (
                f"{len(errors)} of {len(tasks)} shards could not be made in {self.place}; the "
                f"first: {type(errors[0]).__name__}: {errors[0]}. Build again to make what is "
                "missing"
            )
            raise PyramidError(msg) from errors[0]


def _write_finest(run: _Run, field: FlowField) -> None:
    """Write level 0, one step after the other, as they are read."""
    if run.about["axes"]:
        _write_axes(run, field)
    parts = _missing_parts(run, 0, field.shape)
    run.made += len(parts)
    step, velocity = -1, np.empty(0)
    for part in track(parts, len(parts), "Level 0", show=run.progress):
        if part.step != step:
            step, velocity = part.step, np.asarray(field.velocity[part.step])
        at = part.lines(field.shape)
        scalars = {k: s[step][at] for k, s in field.scalars.items() if step < len(s)}
        known = None if field.has_position is None else field.has_position[at]
        nodes = Nodes(field.points[at], field.valid[at], velocity[at], known, scalars)
        write_part(run.group, run.about, part, at, nodes)


def _write_axes(run: _Run, field: FlowField) -> None:
    pyramid = Pyramid(field)
    for level in range(pyramid.depth + 1):
        rows, columns = pyramid.line_numbers(level)
        run.group[f"{level}/x"][:] = field.points[0, columns, 0]
        run.group[f"{level}/y"][:] = field.points[rows, 0, 1]


def _missing_parts(run: _Run, level: int, shape: tuple[int, int]) -> list[Any]:
    there = run.there(f"{level}/velocity")
    parts = parts_of(level, shape, len(run.about["times"]))
    missing = [part for part in parts if (part.step, part.row, part.column, 0) not in there]
    run.kept += len(parts) - len(missing)
    return missing


def _tiles(run: _Run, level: int) -> Iterator[TileTask]:
    name = f"{level}/{TRACES}"
    there = run.there(name)
    steps, rows, columns = run.group[name].shape[:3]
    for row in range(rows):
        for column in range(columns):
            missing = [t for t in range(steps) if (t, row, column, 0, 0, 0, 0) not in there]
            if missing:
                yield TileTask(TileKey(level, row, column), tuple(missing))
            else:
                run.kept += 1


def _ranges(pyramid: Pyramid) -> dict[str, list[tuple[float, float] | None]]:
    """Return the ends of scalars and of the speed, the whole range and the robust one."""
    field, some = pyramid.field, pyramid.field.typical
    values = {k: np.asarray(s)[:, field.valid] for k, s in some.scalars.items()}
    values.setdefault("speed", drawn_speeds(some, pyramid.root))
    both = {k: [ends_of(v, robust=robust) for robust in (False, True)] for k, v in values.items()}
    return {name: ends for name, ends in both.items() if None not in ends}


class _Workers:
    """Threads of this process."""

    def run(
        self, function: Callable[..., None], place: str, run: str, tasks: Sequence[Any]
    ) -> Iterator[Exception | None]:
        """Yield what became of each task, in the order in which they end."""
        if not tasks:
            return

        def tried(task: Any) -> Exception | None:
            result: Exception | None = None
            for _ in range(MOST_TRIALS):
                try:
                    function(place, run, task)
                except Exception as error:
                    result = error
                else:
                    return None
            return result

        with ThreadPoolExecutor(os.cpu_count(), thread_name_prefix="flowtex-pyramid") as pool:
            futures = [pool.submit(tried, task) for task in tasks]
            try:
                for future in as_completed(futures):
                    yield future.result()
            finally:
                pool.shutdown(wait=True, cancel_futures=True)

    def close(self) -> None:
        """Nothing is kept open."""


class _Dask(_Workers):
    """Workers of a Dask cluster, which open the store themselves."""

    def __init__(self, scheduler: Any) -> None:
        distributed = import_extra("distributed", "store")
        self._own = isinstance(scheduler, str)
        self._client = distributed.Client(scheduler) if self._own else scheduler
        self._as_completed = distributed.as_completed

    def run(
        self, function: Callable[..., None], place: str, run: str, tasks: Sequence[Any]
    ) -> Iterator[Exception | None]:
        """Yield what became of each task, in the order in which they end."""
        if not tasks:
            return
        futures = self._client.map(
            lambda task: function(place, run, task), tasks, pure=False, retries=MOST_TRIALS - 1
        )
        try:
            for future in self._as_completed(futures):
                yield future.exception()
                future.release()
        finally:
            self._client.cancel(futures)

    def close(self) -> None:
        """Leave the cluster, where it was given by its address."""
        if self._own:
            self._client.close()


def _workers(scheduler: Any) -> _Workers:
    return _Workers() if scheduler is None else _Dask(scheduler)
