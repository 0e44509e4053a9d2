"""Reading of a store: nodes of its levels, and checks of the files of tiles."""

from __future__ import annotations

import asyncio
import itertools
import json
import math
from collections.abc import Callable, Coroutine, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex._util.forks import ProcessLock
from flowtex._util.memory import available_bytes
from flowtex._util.progress import check
from flowtex.errors import FieldError, import_extra
from flowtex.field import FlowField
from flowtex.field.steps import LazySteps, Nodes
from flowtex.pyramid.layout import (
    DIGESTS,
    FILE_CHUNK,
    FLOW,
    SURFACE,
    VALUES,
    Part,
    check_about,
    described,
    empty_field,
    part_digest,
    value_names,
)
from flowtex.pyramid.places import (
    DOCUMENT,
    DamageError,
    PyramidError,
    ReadFault,
    place_text,
    store_at,
    sync,
)
from flowtex.rendering.webgl.protocol import file_infos
from flowtex.sources.datasets.axes import as_slice
from flowtex.textures.tiles.grid_levels import level_shape
from flowtex.textures.tiles.pyramid import TileKey

if TYPE_CHECKING:
    from zarr import AsyncArray

    from flowtex._util.zarr_internals import ArrayV3Metadata

T = TypeVar("T")
Index = tuple[int | slice, ...]
LOOK_INTERVAL_S = 0.1  #: Seconds between checks whether the surrounding work was cancelled.
MOST_LETTERS = 300  #: Most characters of an error of another library that a message repeats.
SCALARS = "scalars/"  #: Folder of the scalars of a level.
NUMBER_BYTES = 8  #: Most bytes of a number.
NODE_BYTES = 24  #: Bytes of a velocity.
KEPT_BYTES = 64_000_000  #: Most bytes of steps in memory; a longer series is read step by step.


class _Piece(NamedTuple):
    """A piece of an array: an index, and rows and columns within its result."""

    array: str
    selection: Index
    name: str  #: Its name in errors.
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
        except FieldError as error:  # of a document that is refused
            raise PyramidError(f"{self.place}: {error}") from None
        except Exception as error:
            raise PyramidError(
                f"{self.place} contains no readable pyramid ({_error_text(error)}); build one"
            ) from None
        #: The description of the field and its pyramid.
        self.about = check_about(about, self.place)
        self._arrays: dict[str, dict[str, AsyncArray[ArrayV3Metadata]]] = {}
        self._lock = ProcessLock()

    def _array(self, name: str) -> AsyncArray[ArrayV3Metadata]:
        """Return a Zarr array with the metadata that a build gives it, not those in the store."""
        from flowtex._util.zarr_codecs import bounded

        top = name.partition("/")[0]
        with self._lock:
            if top not in self._arrays:
                members: Any = described(self.about, [int(top)]).members(max_depth=None)
                arrays = {}
                for path, array in members:
                    if hasattr(array, "dtype"):
                        arrays[path] = bounded(array.metadata, self._objects, path)
                self._arrays[top] = arrays
            return self._arrays[top][name]

    def shape(self, level: int) -> tuple[int, int]:
        """Return the number of nodes (J, I) of a level."""
        return level_shape((self.about["nodes"][0], self.about["nodes"][1]), level)

    @property
    def template(self) -> FlowField:
        """A field without nodes, with all that describes it."""
        return empty_field(self.about)

    def whole(self, name: str, at: tuple[int, ...] = ()) -> AnyArray:
        """Return an array, or its part at some indices of the first axes."""
        (values,) = self._read(_Piece(name, at, name))
        return values

    def valid(self, level: int, rows: Indices, columns: Indices) -> Bools:
        """Return which nodes are valid, (J, I); positions may not be written yet."""
        (valid,) = self._read(self._nodal(level, "valid", rows, columns))
        return valid.astype(bool)

    def check_part(self, part: Part) -> None:
        """Check that a part of a level is complete and as it was written.

        Raises
        ------
        DamageError
            When objects are missing, or differ from what was written.
        """
        level, step, *at = part
        row_slice, column_slice = part.lines(self.shape(level))
        rows = np.arange(row_slice.start, row_slice.stop)
        columns = np.arange(column_slice.start, column_slice.stop)
        scalars = [name for name, count in self.about["scalars"].items() if step < count]
        pieces = {
            DIGESTS: _Piece(f"{level}/{DIGESTS}", (step, *at), DIGESTS),
            "velocity": self._nodal(level, "velocity", rows, columns, step),
        }
        for name in scalars:
            pieces[SCALARS + name] = self._nodal(level, SCALARS + name, rows, columns, step)
        if step == 0:
            for name in self._ground():
                pieces[name] = self._nodal(level, name, rows, columns)
        words = f"of level {level} at step {step}, part {tuple(at)},"
        for key, piece in pieces.items():
            pieces[key] = piece._replace(name=f"{piece.name} {words}")
        values = dict(zip(pieces, self._read(*pieces.values()), strict=True))
        velocity = values["velocity"]
        has_position = None
        if "has_position" in values:
            has_position = values["has_position"].astype(bool)
        # The digests of later steps do not contain positions.
        positions = velocity
        if step == 0:
            positions = self._points(values, rows, columns)
        nodes = Nodes(
            positions,
            values.get("valid", velocity).astype(bool),
            velocity,
            {name: values[SCALARS + name] for name in scalars},
            has_position,
        )
        stored_digest = values[DIGESTS]
        if part_digest(nodes, self.about, step) != stored_digest.tobytes():
            raise DamageError(f"velocity {words} of {self.place} differs from what was written")

    def check_document(self, node: Any) -> None:
        """Check that the metadata of a group or array are as they were written.

        flowtex itself reads only the metadata of the pyramid, but other programs need them all.

        Parameters
        ----------
        node
            A group or an array of :func:`described`.

        Raises
        ------
        DamageError
            When the metadata are missing, cannot be read or differ.
        """
        zarr = import_extra("zarr", "store")
        from zarr.buffer import default_buffer_prototype

        name = f"{node.path}/{DOCUMENT}"
        kind = default_buffer_prototype()
        try:
            stored = sync(self._objects.get(name, kind))
        except FieldError as error:  # a document that is refused
            raise self._error(name, error) from None
        if stored is None:
            raise DamageError(f"{name} of {self.place} is missing; build it again")
        try:
            document = json.loads(stored.to_bytes())
            if isinstance(node, zarr.Group):
                is_same = document["node_type"] == "group"
            else:
                written = type(node.metadata).from_dict(document)
                is_same = _layout_of(written) == _layout_of(node.metadata)
        except (ValueError, LookupError, TypeError, AttributeError) as error:
            raise self._error(name, error) from None
        if not is_same:
            raise DamageError(
                f"{name} of {self.place} differs from what was written; build it again"
            )

    def check_tile(self, key: TileKey, step: int) -> None:
        """Raise a DamageError where a part of a tile is missing or corrupt."""
        label = f"of tile {tuple(key)} at step {step}"
        (level, *at) = key
        parts = self._check_file(FLOW, level, (step, *at), f"{FLOW} {label}")
        if parts:  # something is drawn
            # Browsers compute the speed of a flow that they trace.
            is_traced = any("/flow/" in part for part in parts)
            counts = self.about["scalars"]
            if not is_traced:
                counts = {"speed": step + 1, **counts}
            for number, scalar in enumerate(value_names(self.about)):
                if step < counts.get(scalar, 0):
                    self._check_file(VALUES, level, (step, *at, number), f"{scalar} {label}")
        if step == 0 and level < self.about["depth"]:
            self._check_file(SURFACE, level, tuple(at), f"{SURFACE} {label}")

    def _check_file(self, kind: str, level: int, at: tuple[int, ...], name: str) -> list[str]:
        """Return the names of the parts of a file; a DamageError says what is wrong."""
        array = f"{level}/{kind}"
        (file,) = self._read(_Piece(array, (*at, slice(FILE_CHUNK)), name))
        try:
            infos, start = file_infos(file.tobytes())
            size = start + sum(info["bytes"] for info in infos)
            owner = file[start : start + infos[0]["bytes"]].tobytes().decode()
            names = [info["name"] for info in infos[1:]]
        except (ValueError, LookupError, TypeError) as error:
            raise self._error(name, error) from None
        if kind != SURFACE:
            tile = [level, *at[1:3]]
        else:
            tile = [level, *at]
        prefix = "tile/" + "/".join(map(str, tile)) + "/"
        is_ours = owner == self.about["fingerprint"]
        for part_name in names:
            is_ours &= part_name.startswith(prefix)
        if not is_ours:
            raise DamageError(f"{name} of {self.place} belongs to another tile; build it again")
        for first in range(FILE_CHUNK, size, FILE_CHUNK):
            self._read(_Piece(array, (*at, slice(first, first + FILE_CHUNK)), name))
        return names

    def positions(self, level: int, rows: Indices, columns: Indices) -> tuple[Floats, Bools]:
        """Return where nodes are, (J, I, 3), and which of them are valid, (J, I)."""
        names = [*self._places(), "valid"]
        pieces = self._nodal_pieces(level, names, rows, columns)
        arrays = dict(zip(names, self._read(*pieces), strict=True))
        return self._points(arrays, rows, columns), arrays["valid"].astype(bool)

    def nodes(
        self, level: int, rows: Indices, columns: Indices, *, velocities: bool = True
    ) -> Nodes:
        """Return the data at some lines of a level, with or without velocities."""
        about = self.about
        names = self._ground()
        series = {}
        for name, count in about["scalars"].items():
            series[SCALARS + name] = count
        if velocities:
            series["velocity"] = len(about["times"])
        nbytes = len(rows) * len(columns) * NODE_BYTES
        pieces = self._nodal_pieces(level, names, rows, columns)
        late = set()
        for name, count in series.items():
            if count > 1 and (about["late"] or count * nbytes > KEPT_BYTES):
                late.add(name)
                continue
            for step in range(count):
                pieces.append(self._nodal(level, name, rows, columns, step))
        values = iter(self._read(*pieces))
        arrays = dict(zip(names, values, strict=False))
        steps: dict[str, Any] = {}
        for name, count in series.items():
            if name in late:
                later = self._later(level, name, rows, columns)
                steps[name] = LazySteps(count, later, kept=KEPT_BYTES)
            else:
                steps[name] = np.stack(list(itertools.islice(values, count)))
        velocity = steps.pop("velocity", None)
        if velocities and "velocity" not in late:
            velocity = _in_space(velocity)
        has_position = None
        if about["has_position"]:
            has_position = arrays["has_position"].astype(bool)
        return Nodes(
            self._points(arrays, rows, columns),
            arrays["valid"].astype(bool),
            velocity,
            {name.removeprefix(SCALARS): values for name, values in steps.items()},
            has_position,
        )

    def _later(
        self, level: int, name: str, rows: Indices, columns: Indices
    ) -> Callable[[int], AnyArray]:
        """Return a function that reads a step of an array."""

        def read(step: int) -> AnyArray:
            (values,) = self._read(self._nodal(level, name, rows, columns, step))
            if name == "velocity":
                return _in_space(values)
            return values

        return read

    def velocity(self, level: int, step: int, rows: Indices, columns: Indices) -> Floats:
        """Return the velocity of some lines of a level at a time step, (J, I, C)."""
        (values,) = self._read(self._nodal(level, "velocity", rows, columns, step))
        return values

    def _places(self) -> list[str]:
        if self.about["axes"]:
            return ["x", "y"]
        return ["points"]

    def _ground(self) -> list[str]:
        """Return the names of the arrays without time: positions, and which nodes have data."""
        names = [*self._places(), "valid"]
        if self.about["has_position"]:
            names.append("has_position")
        return names

    def _points(self, arrays: Mapping[str, AnyArray], rows: Indices, columns: Indices) -> Floats:
        """Return positions (J, I, 3) of nodes from the arrays by name of :meth:`_places`."""
        if not self.about["axes"]:
            return _in_space(arrays["points"], self.about["height"])
        x = arrays["x"][columns]
        y = arrays["y"][rows][:, None]
        return np.stack(np.broadcast_arrays(x, y, self.about["height"]), axis=-1)

    def _nodal_pieces(
        self, level: int, names: list[str], rows: Indices, columns: Indices
    ) -> list[_Piece]:
        """Return the pieces of arrays without time at some rows and columns."""
        return [self._nodal(level, name, rows, columns) for name in names]

    def _nodal(
        self, level: int, name: str, rows: Indices, columns: Indices, step: int | None = None
    ) -> _Piece:
        """Return the piece of an array over the nodes at some rows and columns."""
        leading: tuple[int, ...] = ()
        if step is not None:
            leading = (step,)
        array = f"{level}/{name}"
        if name in ("x", "y"):
            return _Piece(array, (slice(None),), array)
        return _Piece(array, leading, array, (rows, columns))

    def _read(self, *pieces: _Piece) -> list[AnyArray]:
        """Read parts of arrays, all at once."""
        arrays = [self._array(piece.array) for piece in pieces]
        need = sum(map(_size, pieces, arrays))
        free = available_bytes()
        if need > free:
            raise PyramidError(
                f"{pieces[0].name} of {self.place} takes {need:,} bytes, but only {free:,} bytes "
                "of memory are available"
            )

        async def together() -> list[AnyArray]:
            return await asyncio.gather(*map(self._values, pieces, arrays))

        values: list[AnyArray] = _wait(together())
        return values

    async def _values(self, piece: _Piece, array: AsyncArray[ArrayV3Metadata]) -> AnyArray:
        """Return the values of a piece, floats in double precision."""
        try:
            if piece.lines is None:
                return np.asarray(await array.getitem(piece.selection))
            lines = map(as_slice, piece.lines)
            values = np.asarray(await array.oindex.getitem((*piece.selection, *lines)))
            # Fields are float64, as all values computed from them.
            if values.dtype == np.float32:
                return values.astype(float)
            return values
        except PyramidError:
            raise
        except Exception as error:
            raise self._error(piece.name, error) from None

    def _error(self, name: str, error: Exception) -> PyramidError:
        """Return the error of an array that cannot be read."""
        unread = isinstance(error, MemoryError) or (
            isinstance(error, ReadFault) and not error.missing
        )
        if unread:
            kind = PyramidError
        else:
            kind = DamageError
        return kind(f"{name} of {self.place} cannot be read: {_error_text(error)}")


def _size(piece: _Piece, array: AsyncArray[ArrayV3Metadata]) -> int:
    """Return the number of bytes of a piece in memory, at most."""
    shape = array.shape
    selection = piece.selection
    if piece.lines is not None:
        shape = (*map(len, piece.lines), *shape[len(selection) + 2 :])
    else:
        spans = []
        for index, count in zip(selection, shape, strict=False):
            if isinstance(index, slice):
                spans.append(len(range(count)[index]))
        shape = (*spans, *shape[len(selection) :])
    return int(math.prod(shape)) * NUMBER_BYTES


def _layout_of(metadata: ArrayV3Metadata) -> tuple[Any, ...]:
    """Return the entries of an array's metadata that decide how its values are read."""
    grid = metadata.chunk_grid
    key = metadata.chunk_key_encoding
    codecs = tuple(metadata.codecs)
    return metadata.shape, metadata.data_type, grid, key, metadata.fill_value, codecs


def _in_space(values: Floats, height: float = 0.0) -> Floats:
    """Return vectors or points (..., 2) with a third component."""
    third = np.full((*values.shape[:-1], 3 - values.shape[-1]), height)
    return np.concatenate([values, third], axis=-1)


def _error_text(error: Exception) -> str:
    """Return the text of an error of reading, as users can act on it."""
    text = str(error)
    if "checksum" in text:
        return "checksum mismatch: the object is corrupt"
    is_plain = isinstance(error, (ReadFault, PyramidError))
    if is_plain:
        return text
    return f"{type(error).__name__}: {text}"[:MOST_LETTERS]


def _wait(reading: Coroutine[Any, Any, T]) -> T:
    """Return the result of reading, which ends if the surrounding work is cancelled."""

    async def watched() -> T:
        task = asyncio.ensure_future(reading)
        try:
            while not task.done():
                await asyncio.wait([task], timeout=LOOK_INTERVAL_S)
                if not task.done():
                    check()  # the coroutine has the context of the caller
            return task.result()
        finally:
            task.cancel()

    return sync(watched())
