"""What is read from a store: nodes of its levels, and tiles that were made of them."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Floats32, Indices
from flowtex._util.blocks import even_runs
from flowtex._util.extras import import_extra
from flowtex.field.steps import LazySteps
from flowtex.pyramid.layout import TRACES, read_header
from flowtex.pyramid.places import FORMAT, PyramidError, place_text, store_at
from flowtex.tiles import TileKey
from flowtex.tiles.pyramid import Nodes

__all__ = ["Levels", "StoredTile"]

#: Blocks that are read one after the other; more of them are read as single lines.
MOST_RUNS = 9
#: Bytes of a velocity, and those of steps that are held; of a longer series each is read late.
NODE_BYTES, KEPT_BYTES = 24, 64_000_000


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
        try:
            self.group = zarr.open_group(store_at(place), mode="r")
            self.about: dict[str, Any] = dict(self.group.attrs["flowtex"])
        except Exception as error:
            msg = (
                f"{self.place} holds no pyramid that can be read ({_words(error)}); make one with "
                "flowtex.pyramid.build"
            )
            raise PyramidError(msg) from error
        if self.about.get("format") != FORMAT:
            msg = (
                f"{self.place} has the format {self.about.get('format')!r}; expected {FORMAT!r}. "
                "Build it anew, or read it with the flowtex that wrote it"
            )
            raise PyramidError(msg)
        self._arrays: dict[str, Any] = {}
        self._lock = threading.Lock()

    def array(self, name: str) -> Any:
        """Return an array of Zarr's by its path."""
        with self._lock:
            if name not in self._arrays:
                try:
                    self._arrays[name] = self.group[name]
                except Exception as error:
                    raise self._error(name, error) from error
            return self._arrays[name]

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
        try:
            texels = array[step, key.row, key.column]
            about = read_header(texels[0])
        except Exception as error:
            name = f"{name}, tile {tuple(key)}"
            raise self._error(name, error) from error
        if about is None:
            msg = f"tile {tuple(key)} at step {step} is missing in {self.place}; build it again"
            raise PyramidError(msg)
        return StoredTile(about, texels)

    def _steps(
        self, name: str, count: int, rows: Indices, columns: Indices, *, vectors: bool = False
    ) -> Any:
        def read(step: int) -> Floats:
            values = self._lines(name, rows, columns, step)
            return _in_space(values) if vectors else values

        late = self.about["late"] or count * len(rows) * len(columns) * NODE_BYTES > KEPT_BYTES
        if late and count > 1:
            return LazySteps(count, read, kept=KEPT_BYTES)
        return np.stack([read(step) for step in range(count)])

    def _lines(
        self, name: str, rows: Indices, columns: Indices, step: int | None = None
    ) -> AnyArray:
        """Read some rows and columns of an array over the nodes."""
        array = self.array(name)
        before = () if step is None else (step,)
        runs = [list(even_runs(lines)) for lines in (rows, columns)]
        try:
            if len(runs[0]) * len(runs[1]) > MOST_RUNS:
                values = np.asarray(array.oindex[(*before, rows, columns)])
            else:
                bands = [[np.asarray(array[(*before, j, i)]) for i in runs[1]] for j in runs[0]]
                values = np.concatenate([np.concatenate(band, axis=1) for band in bands])
        except Exception as error:
            raise self._error(name, error) from error
        # Fields are float64, as all is that is computed of them.
        return values.astype(float) if values.dtype == np.float32 else values

    def _read(self, name: str) -> AnyArray:
        array = self.array(name)
        try:
            return np.asarray(array[:])
        except Exception as error:
            raise self._error(name, error) from error

    def _error(self, name: str, error: Exception) -> PyramidError:
        return PyramidError(f"{name} of {self.place} cannot be read: {_words(error)}")


def _in_space(values: Floats, height: float = 0.0) -> Floats:
    """Give vectors or points (..., 2) their third component."""
    if values.shape[-1] == 3:
        return values
    third = np.full((*values.shape[:-1], 1), height)
    return np.concatenate([values, third], axis=-1)


def _words(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"
