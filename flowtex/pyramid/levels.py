"""What is read from a store: nodes of its levels, and whether files of tiles are whole."""

from __future__ import annotations

import asyncio
import math
import threading
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex._util.blocks import even_runs
from flowtex._util.extras import import_extra
from flowtex._util.memory import available_bytes
from flowtex._util.progress import check
from flowtex.field import FlowField
from flowtex.field.steps import LazySteps, Nodes
from flowtex.pyramid.checks import check_about, part_digest
from flowtex.pyramid.layout import (
    DIGESTS,
    FILE_CHUNK,
    FLOW,
    SURFACE,
    VALUES,
    Part,
    described,
    empty_field,
    value_names,
)
from flowtex.pyramid.places import DamageError, PyramidError, ReadFault, place_text, store_at, sync
from flowtex.pyramid.samples import SAMPLES, create_samples
from flowtex.rendering.webgl.protocol import file_infos
from flowtex.textures.tiles import TileKey
from flowtex.textures.tiles.pyramid import level_shape

#: What of an array's metadata decides on the meaning of its bytes.
FORMAT_NAMES = ("shape", "data_type", "chunk_grid", "chunk_key_encoding", "fill_value", "codecs")
#: How often is looked whether what is read is still wanted.
LOOK_INTERVAL_S = 0.1
#: Characters of an error of others that are repeated.
MOST_LETTERS = 300

#: Blocks that are read one after the other; more of them are read as single lines.
MOST_RUNS = 9
#: Bytes of a number at most, of a velocity, and of steps that are held; those of a longer series
#: are read late.
NUMBER_BYTES, NODE_BYTES, KEPT_BYTES = 8, 24, 64_000_000


class _Piece(NamedTuple):
    """A piece of an array: what an index takes, and of that some rows and columns."""

    array: str
    selection: Any
    #: What an error calls it.
    name: str
    lines: tuple[Indices, Indices] | None = None


class Levels:
    """The levels of a pyramid in a store; ``about`` is its description."""

    def __init__(self, place: str | Path) -> None:
        self.place = place_text(place)
        zarr = import_extra("zarr", "store")
        from flowtex.pyramid.objects import Objects

        try:
            self._objects = Objects(store_at(self.place))
            group = zarr.open_group(self._objects, mode="r", zarr_format=3, use_consolidated=False)
            about = group.attrs["flowtex"]
        except PyramidError:
            raise
        except Exception as error:
            msg = (
                f"{self.place} contains no readable pyramid ({_words(error)}); build one with "
                "flowtex.pyramid.build"
            )
            raise PyramidError(msg) from None
        #: The description of the field and its pyramid.
        self.about = check_about(about, self.place)
        self._arrays: dict[str, Any] = {}
        self._expected: dict[str, dict[str, dict[str, Any]]] = {}
        self._lock = threading.Lock()

    def _format(self, name: str) -> dict[str, Any]:
        """Return what an array has to be like: as one that is made for the same pyramid."""
        top = name.partition("/")[0]
        with self._lock:
            if top not in self._expected:
                group = described(self.about, [] if top == SAMPLES else [int(top)])
                if top == SAMPLES:
                    create_samples(group, self.about)
                members = group.members(max_depth=None)
                self._expected[top] = {n: _format_of(a) for n, a in members if hasattr(a, "dtype")}
            if name not in self._expected[top]:
                msg = f"{self.place} has no {name}; build it again"
                raise PyramidError(msg)
            return self._expected[top][name]

    def shape(self, level: int) -> tuple[int, int]:
        """Return the number of nodes (J, I) of a level."""
        return level_shape((self.about["nodes"][0], self.about["nodes"][1]), level)

    @property
    def template(self) -> FlowField:
        """A field that has all but its nodes."""
        return empty_field(self.about)

    def whole(self, name: str, at: tuple[int, ...] = ()) -> AnyArray:
        """Return an array, or what it has at some numbers of its first axes."""
        (values,) = self._read(_Piece(name, at, name))
        return values

    def valid(self, level: int, rows: Indices, columns: Indices) -> Bools:
        """Return which nodes are valid, (J, I); positions may not be written yet."""
        (valid,) = self._read(self._nodal(level, "valid", rows, columns))
        return valid.astype(bool)

    def check_part(self, part: Part) -> None:
        """Raise a DamageError where some of a part is missing, or is not what was written."""
        level, step, *at = part
        rows, columns = (np.arange(s.start, s.stop) for s in part.lines(self.shape(level)))
        scalars = [name for name, count in self.about["scalars"].items() if step < count]
        series = ["velocity", *(f"scalars/{name}" for name in scalars)]
        ground = [*self._places(), "valid", *["has_position"] * self.about["has_position"]]
        pieces = [_Piece(f"{level}/{DIGESTS}", (step, *at), DIGESTS)]
        pieces += [self._nodal(level, name, rows, columns, step) for name in series]
        if step == 0:
            pieces += [self._nodal(level, name, rows, columns) for name in ground]
        words = f"of level {level} at step {step}, part {tuple(at)},"
        told, velocity, *rest = self._read(
            *(piece._replace(name=f"{piece.name} {words}") for piece in pieces)
        )
        known = dict(zip(ground, rest[len(scalars) :], strict=step == 0))
        nodes = Nodes(
            self._points([known[k] for k in self._places()], rows, columns) if known else velocity,
            known.get("valid", velocity).astype(bool),
            velocity,
            dict(zip(scalars, rest[: len(scalars)], strict=True)),
            known["has_position"].astype(bool) if "has_position" in known else None,
        )
        if part_digest(nodes, self.about, step) != told.tobytes():
            msg = f"velocity {words} of {self.place} differs from what was written"
            raise DamageError(msg)

    def check_tile(self, key: TileKey, step: int) -> None:
        """Raise a DamageError where some of a tile is missing or corrupt."""
        where, (level, *at) = f"of tile {tuple(key)} at step {step}", key
        parts = self._check_file(FLOW, level, (step, *at), f"{FLOW} {where}")
        if parts:  # something is drawn
            # A flow that browsers trace tells its speed.
            is_traced = any("/flow/" in part for part in parts)
            counts = dict.fromkeys([] if is_traced else ["speed"], step + 1) | self.about["scalars"]
            for number, scalar in enumerate(value_names(self.about)):
                if step < counts.get(scalar, 0):
                    self._check_file(VALUES, level, (step, *at, number), f"{scalar} {where}")
        if step == 0 and level < self.about["depth"]:
            self._check_file(SURFACE, level, tuple(at), f"{SURFACE} {where}")

    def _check_file(self, kind: str, level: int, at: tuple[int, ...], name: str) -> list[str]:
        """Return the names of the parts of a file; a DamageError says what is wrong."""
        array = f"{level}/{kind}"
        (file,) = self._read(_Piece(array, (*at, slice(FILE_CHUNK)), name))
        try:
            infos, start = file_infos(file.tobytes())
            size = start + sum(info["bytes"] for info in infos)
            of = file[start : start + infos[0]["bytes"]].tobytes().decode()
            names = [info["name"] for info in infos[1:]]
        except (ValueError, LookupError, TypeError) as error:
            raise self._error(name, error) from None
        tile = [level, *at[1:3]] if kind != SURFACE else [level, *at]
        prefix = "tile/" + "/".join(map(str, tile)) + "/"
        if of != self.about["fingerprint"] or not all(one.startswith(prefix) for one in names):
            msg = f"{name} of {self.place} belongs to another tile; build it again"
            raise DamageError(msg)
        for first in range(FILE_CHUNK, size, FILE_CHUNK):
            self._read(_Piece(array, (*at, slice(first, first + FILE_CHUNK)), name))
        return names

    def positions(self, level: int, rows: Indices, columns: Indices) -> tuple[Floats, Bools]:
        """Return where nodes are, (J, I, 3), and which of them are valid, (J, I)."""
        names = [*self._places(), "valid"]
        *places, valid = self._read(*(self._nodal(level, n, rows, columns) for n in names))
        return self._points(places, rows, columns), valid.astype(bool)

    def nodes(
        self, level: int, rows: Indices, columns: Indices, *, velocities: bool = True
    ) -> Nodes:
        """Return what some lines of a level have, with or without velocities."""
        about = self.about
        names = [*self._places(), "valid", *["has_position"] * about["has_position"]]
        series = {f"scalars/{name}": count for name, count in about["scalars"].items()}
        if velocities:
            series["velocity"] = len(about["times"])
        nbytes = len(rows) * len(columns) * NODE_BYTES
        late = {
            name
            for name, count in series.items()
            if count > 1 and (about["late"] or count * nbytes > KEPT_BYTES)
        }
        parts = [self._nodal(level, name, rows, columns) for name in names]
        for name, count in series.items():
            if name not in late:
                parts += [self._nodal(level, name, rows, columns, step) for step in range(count)]
        values = iter(self._read(*parts))
        known = {name: next(values) for name in names}
        steps: dict[str, Any] = {}
        for name, count in series.items():
            if name in late:
                later = self._later(level, name, rows, columns)
                steps[name] = LazySteps(count, later, kept=KEPT_BYTES)
            else:
                steps[name] = np.stack([next(values) for _ in range(count)])
        velocity = steps.pop("velocity", None)
        if velocities and "velocity" not in late:
            velocity = _in_space(velocity)
        return Nodes(
            self._points([known[name] for name in self._places()], rows, columns),
            known["valid"].astype(bool),
            velocity,
            {name.removeprefix("scalars/"): values for name, values in steps.items()},
            known["has_position"].astype(bool) if about["has_position"] else None,
        )

    def _later(
        self, level: int, name: str, rows: Indices, columns: Indices
    ) -> Callable[[int], AnyArray]:
        """Return what reads a step of an array when it is requested."""

        def read(step: int) -> AnyArray:
            (values,) = self._read(self._nodal(level, name, rows, columns, step))
            return _in_space(values) if name == "velocity" else values

        return read

    def velocity(self, level: int, step: int, rows: Indices, columns: Indices) -> Floats:
        """Return the velocity of some lines of a level at a time step, (J, I, C)."""
        (values,) = self._read(self._nodal(level, "velocity", rows, columns, step))
        return values

    def _places(self) -> list[str]:
        return ["x", "y"] if self.about["axes"] else ["points"]

    def _points(self, places: list[AnyArray], rows: Indices, columns: Indices) -> Floats:
        if not self.about["axes"]:
            return _in_space(places[0], self.about["height"])
        x, y = places
        grid = np.broadcast_arrays(x[columns], y[rows][:, None], self.about["height"])
        return np.stack(grid, axis=-1)

    def _nodal(
        self, level: int, name: str, rows: Indices, columns: Indices, step: int | None = None
    ) -> _Piece:
        """Return which part of an array over the nodes some rows and columns are."""
        before = () if step is None else (step,)
        whole = f"{level}/{name}"
        if name in ("x", "y"):
            return _Piece(whole, slice(None), whole)
        return _Piece(whole, before, whole, (rows, columns))

    def _read(self, *parts: _Piece) -> list[AnyArray]:
        """Read parts of arrays, all at once."""
        formats = [self._format(part.array) for part in parts]
        need, free = sum(map(_size, parts, formats)), available_bytes()
        if need > free:
            msg = (
                f"{parts[0].name} of {self.place} takes {need:,} bytes, but only {free:,} bytes "
                "of memory are available"
            )
            raise PyramidError(msg)

        async def together() -> list[AnyArray]:
            return await asyncio.gather(*map(self._values, parts, formats))

        values: list[AnyArray] = _wait(together())
        return values

    async def _values(self, part: _Piece, expected: dict[str, Any]) -> AnyArray:
        try:
            array = await self._opened(part.array, expected)
            if part.lines is None:
                return np.asarray(await array.getitem(part.selection))
            values = await _lines(array, part.selection, *part.lines)
            # Fields are float64, as all is that is computed of them.
            return values.astype(float) if values.dtype == np.float32 else values
        except PyramidError:
            raise
        except Exception as error:
            raise self._error(part.name, error) from None

    async def _opened(self, name: str, expected: dict[str, Any]) -> Any:
        """Return an array of Zarr's, to be awaited.

        It has to be what is written here: shape, type and packing decide what its bytes mean.
        """
        if name not in self._arrays:
            open_array = import_extra("zarr.api.asynchronous", "store").open_array
            array = await open_array(store=self._objects, path=name, zarr_format=3, mode="r")
            if _format_of(array) != expected:
                msg = (
                    f"{name} of {self.place} has changed since it was written; build the store "
                    "again"
                )
                raise DamageError(msg)
            from flowtex.pyramid.objects import bounded

            self._arrays[name] = bounded(array)
        return self._arrays[name]

    def _error(self, name: str, error: Exception) -> PyramidError:
        unread = isinstance(error, MemoryError) or (
            isinstance(error, ReadFault) and not error.missing
        )
        kind = PyramidError if unread else DamageError
        return kind(f"{name} of {self.place} cannot be read: {_words(error)}")


def _size(part: _Piece, expected: dict[str, Any]) -> int:
    """Return the bytes that a piece of an array takes in memory."""
    shape, chosen = expected["shape"], part.selection
    if part.lines is not None:
        shape = (*map(len, part.lines), *shape[len(chosen) + 2 :])
    elif isinstance(chosen, tuple):
        pairs = zip(chosen, shape, strict=False)
        spans = (len(range(n)[some]) for some, n in pairs if isinstance(some, slice))
        shape = (*spans, *shape[len(chosen) :])
    return int(math.prod(shape)) * NUMBER_BYTES


async def _lines(array: Any, before: tuple[int, ...], rows: Indices, columns: Indices) -> AnyArray:
    """Read some rows and columns of an array over the nodes, as few blocks where they are that."""
    runs = [list(even_runs(lines)) for lines in (rows, columns)]
    if len(runs[0]) * len(runs[1]) > MOST_RUNS:
        return np.asarray(await array.oindex.getitem((*before, rows, columns)))
    blocks = [array.getitem((*before, j, i)) for j in runs[0] for i in runs[1]]
    read = iter(map(np.asarray, await asyncio.gather(*blocks)))
    bands = [[next(read) for _ in runs[1]] for _ in runs[0]]
    return np.concatenate([np.concatenate(band, axis=1) for band in bands])


def _in_space(values: Floats, height: float = 0.0) -> Floats:
    """Give vectors or points (..., 2) their third component."""
    if values.shape[-1] == 3:
        return values
    third = np.full((*values.shape[:-1], 1), height)
    return np.concatenate([values, third], axis=-1)


def _words(error: Exception) -> str:
    text = str(error)
    if "checksum" in text:
        return "checksum mismatch: the object is corrupt"
    known = isinstance(error, (ReadFault, PyramidError))
    return text if known else f"{type(error).__name__}: {text}"[:MOST_LETTERS]


def _format_of(array: Any) -> dict[str, Any]:
    told = array.metadata.to_dict()
    return {name: told[name] for name in FORMAT_NAMES}


def _wait(reading: Coroutine[Any, Any, Any]) -> Any:
    """Return what is read; it is dropped if the surrounding work was cancelled."""

    async def watched() -> Any:
        task = asyncio.ensure_future(reading)
        try:
            while not task.done():
                await asyncio.wait([task], timeout=LOOK_INTERVAL_S)
                if not task.done():
                    check()  # the caller's: what is started for it has its context
            return task.result()
        finally:
            task.cancel()

    return sync(watched())
