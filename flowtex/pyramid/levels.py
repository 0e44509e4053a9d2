"""What is read from a store: nodes of its levels, and tiles that were made of them."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Coroutine
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Floats32, Indices
from flowtex._util.extras import import_extra
from flowtex._util.progress import Stopped, check
from flowtex.field.steps import LazySteps
from flowtex.pyramid.checks import check_about, check_header, identity_of
from flowtex.pyramid.layout import TRACES, create_level, read_header
from flowtex.pyramid.places import PyramidError, ReadFault, place_text, store_at
from flowtex.tiles import TileKey
from flowtex.tiles.pyramid import Nodes, level_lines

__all__ = ["Levels", "StoredTile"]

#: What of an array's metadata decides on the meaning of its bytes.
FORMAT_NAMES = ("shape", "data_type", "chunk_grid", "chunk_key_encoding", "fill_value", "codecs")
#: How often is looked whether what is read is still wanted.
LOOK_INTERVAL_S = 0.1
#: Characters of an error of others that are repeated.
MOST_LETTERS = 300


class StoredTile:
    """A tile at one destination time: what is told of it, and its layers (L, H, W, 4)."""

    def __init__(self, about: dict[str, Any], texels: AnyArray) -> None:
        self.about = about
        height, width = about.get("size", (0, 0))
        count = about.get("count", 0)
        self.layers: Floats32 = texels[1 : 1 + count, :height, :width].astype(np.float32)


class Levels:
    """The levels of a pyramid in a store.

    Parameters
    ----------
    place
        A folder or a URL.

    Attributes
    ----------
    about
        What is told of the field and its pyramid.

    Raises
    ------
    PyramidError
        When there is no pyramid, or one of another version.
    """

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
                f"{self.place} holds no pyramid that can be read ({_words(error)}); make one with "
                "flowtex.pyramid.build"
            )
            raise PyramidError(msg) from None
        #: What is told of the field and its pyramid.
        self.about = check_about(about, self.place)
        self._arrays: dict[str, Any] = {}
        self._expected: dict[int, Any] = {}
        self._lock = threading.Lock()

    def array(self, name: str) -> Any:
        """Return an array of Zarr's by its path, to be awaited.

        Raises
        ------
        PyramidError
            When it cannot be read, or is none that is written here: shape, type and packing decide
            what its bytes mean.
        """
        if name not in self._arrays:
            open_array = import_extra("zarr.api.asynchronous", "store").open_array
            try:
                array = _wait(open_array(store=self._objects, path=name, zarr_format=3, mode="r"))
                same = _format_of(array) == self._format(name)
            except Stopped:
                raise
            except Exception as error:
                raise self._error(name, error) from None
            if not same:
                msg = f"{name} of {self.place} is not as it was written; build the store anew"
                raise PyramidError(msg)
            self._arrays[name] = array
        return self._arrays[name]

    def _format(self, name: str) -> dict[str, Any]:
        """Return what an array has to be like: as one that is made for the same pyramid."""
        zarr, level = import_extra("zarr", "store"), int(name.partition("/")[0])
        with self._lock:
            if level not in self._expected:
                group = zarr.group(store=zarr.storage.MemoryStore())
                rows, columns = (len(level_lines(n, level)) for n in self.about["nodes"])
                create_level(group, level, (rows, columns), self.about)
                self._expected[level] = group
            return _format_of(self._expected[level][name])

    def positions(self, level: int, rows: Indices, columns: Indices) -> tuple[Floats, Bools]:
        """Return where nodes are, (J, I, 3), and which of them are valid, (J, I)."""
        height = self.about["height"]
        if self.about["axes"]:
            x, y = (self._read(f"{level}/{name}") for name in "xy")
            grid = np.broadcast_arrays(x[columns], y[rows][:, None], height)
            points = np.stack(grid, axis=-1)
        else:
            points = _in_space(self._lines(f"{level}/points", rows, columns), height)
        return points, self._lines(f"{level}/valid", rows, columns).astype(bool)

    def nodes(
        self, level: int, rows: Indices, columns: Indices, *, velocities: bool = True
    ) -> Nodes:
        """Return what some lines of a level have, with or without velocities."""
        points, valid = self.positions(level, rows, columns)
        known = None
        if self.about["has_position"]:
            known = self._lines(f"{level}/has_position", rows, columns).astype(bool)
        scalars = {
            name: self._steps(f"{level}/scalars/{name}", count, rows, columns)
            for name, count in self.about["scalars"].items()
        }
        velocity: Any = None
        if velocities:
            velocity = self._steps(
                f"{level}/velocity", len(self.about["times"]), rows, columns, vectors=True
            )
        return Nodes(points, valid, velocity, known, scalars)

    def velocity(self, level: int, step: int, rows: Indices, columns: Indices) -> Floats:
        """Return the velocity of some lines of a level at a time step, (J, I, C)."""
        return self._lines(f"{level}/velocity", rows, columns, step)

    def tile(self, key: TileKey, step: int) -> StoredTile:
        """Return a tile at a destination time.

        Raises
        ------
        PyramidError
            When it is not there, or broken.
        """
        name = f"{key.level}/{TRACES}"
        array = self.array(name)
        name = f"tile {tuple(key)} at step {step}"
        try:
            texels = _wait(array.getitem((step, key.row, key.column)))
            header = read_header(texels[0])
            if header is None:
                msg = f"{name} is missing in {self.place}; build it again"
                raise PyramidError(msg)
            about = check_header(header, identity_of(self.about, key, step))
        except (Stopped, PyramidError):
            raise
        except Exception as error:
            raise self._error(name, error) from None
        return StoredTile(about, texels)

    def _steps(
        self, name: str, count: int, rows: Indices, columns: Indices, *, vectors: bool = False
    ) -> Any:
        def read(step: int) -> Floats:
            values = self._lines(name, rows, columns, step)
            return _in_space(values) if vectors else values

        if self.about["late"] and count > 1:
            return LazySteps(count, read)
        return np.stack([read(step) for step in range(count)])

    def _lines(
        self, name: str, rows: Indices, columns: Indices, step: int | None = None
    ) -> AnyArray:
        """Read some rows and columns of an array over the nodes."""
        array = self.array(name)
        before = () if step is None else (step,)
        both = [_slice(lines) for lines in (rows, columns)]
        if None not in both:
            return self._values(name, array.getitem((*before, *both)))
        return self._values(name, array.oindex.getitem((*before, rows, columns)))

    def _read(self, name: str) -> AnyArray:
        return self._values(name, self.array(name).getitem(slice(None)))

    def _values(self, name: str, reading: Coroutine[Any, Any, Any]) -> AnyArray:
        try:
            return np.asarray(_wait(reading))
        except Stopped:
            raise
        except Exception as error:
            raise self._error(name, error) from None

    def _error(self, name: str, error: Exception) -> PyramidError:
        return PyramidError(f"{name} of {self.place} cannot be read: {_words(error)}")


def _slice(lines: Indices) -> slice | None:
    """Return lines that follow each other as a slice."""
    first, last = int(lines[0]), int(lines[-1])
    if last - first + 1 == len(lines) and (np.diff(lines) == 1).all():
        return slice(first, last + 1)
    return None


def _in_space(values: Floats, height: float = 0.0) -> Floats:
    """Give vectors or points (..., 2) their third component."""
    if values.shape[-1] == 3:
        return values
    third = np.full((*values.shape[:-1], 1), height)
    return np.concatenate([values, third], axis=-1)


def _words(error: Exception) -> str:
    known = isinstance(error, (ReadFault, PyramidError))
    return str(error) if known else f"{type(error).__name__}: {error}"[:MOST_LETTERS]


def _format_of(array: Any) -> dict[str, Any]:
    told = array.metadata.to_dict()
    return {name: told[name] for name in FORMAT_NAMES}


def _wait(reading: Coroutine[Any, Any, Any]) -> Any:
    """Return what is read; it is given up where the work around it was cancelled."""
    sync = import_extra("zarr.core.sync", "store").sync

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
