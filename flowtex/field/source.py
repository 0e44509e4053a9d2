"""A file or a mesh that stays open, and gives one field after another.

Who looks for the right plane asks for many of them: the file is read once, and each plane is taken
from memory. Only a series too large for that is read again.
"""

from __future__ import annotations

import threading
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

from flowtex.errors import FieldError
from flowtex.field.field import FlowField
from flowtex.field.io.files import open_file
from flowtex.field.io.meshes import (
    TimeStep,
    is_reader,
    several_grids,
    time_steps,
    times_of,
)
from flowtex.field.io.reader_errors import errors_of_file
from flowtex.field.io.vectors import candidates

__all__ = ["FlowSource"]

#: Size of a series that is held in memory; a larger one is read again for each field.
MAX_SERIES_BYTES = 2_000_000_000


class FlowSource:
    """A mesh, a series or a field, from which one field after another is made.

    Parameters
    ----------
    mesh
        What :meth:`FlowField.from_pyvista` takes, or a field.
    name
        A word for captions.
    velocity
        Name of the velocity where the format of a file fixes it.
    path
        The file that it comes from, which errors then name.
    block
        Path of the block to take of a reader that has several at each time.

    Raises
    ------
    FieldError
        When nothing in it can be drawn.
    """

    #: What a person calls one of the blocks.
    block_word = "Grid"

    def __init__(
        self,
        mesh: Any,
        *,
        name: str = "",
        velocity: str | None = None,
        path: Path | None = None,
        block: str | None = None,
    ) -> None:
        self.name = name
        #: Names of the arrays that may be the velocity; empty where there is no choice.
        self.vectors: tuple[str, ...] = ()
        #: Number of nodes (I, J, K); ``None`` for a field.
        self.dimensions: tuple[int, int, int] | None = None
        #: Names of the structured grids, where there are several that are no time steps.
        self.blocks: tuple[str, ...] = ()
        #: Size in memory.
        self.nbytes = 0
        self._grids: dict[str, Any] = {}
        self._parts: dict[str, FlowSource] = {}
        self._lock = threading.Lock()
        #: Names of the arrays that may be the velocity in each of the blocks.
        self.block_vectors: dict[str, tuple[str, ...]] = {}
        self._mesh = mesh
        self._velocity, self._path, self._block = velocity, path, block
        if isinstance(mesh, FlowField):
            self.name, self.nbytes = name or mesh.name, mesh.nbytes
            return
        if mesh is not None:
            self._describe(self._series(mesh)[0].grid)

    @classmethod
    def from_file(cls, path: str | Path) -> FlowSource:
        """Open a file, as for :meth:`FlowField.from_file`.

        Raises
        ------
        FieldError
            When it cannot be read; the text starts with the path.
        """
        with errors_of_file(path):
            file = open_file(path)
            return cls(file.source, name=file.path.stem, velocity=file.velocity, path=file.path)

    @property
    def planes(self) -> dict[str, int]:
        """Axes across which planes can be chosen, and how many there are; empty for a surface."""
        if self.dimensions is None or min(self.dimensions) == 1:
            return {}
        return dict(zip("ijk", self.dimensions, strict=True))

    @property
    def default_plane(self) -> str:
        """The plane that is drawn where none is chosen; empty for a surface."""
        return f"k={self.planes['k'] // 2}" if self.planes else ""

    def plane_text(self, plane: str) -> str:
        """Return words for a plane, such as ``"k = 20"``."""
        return plane.replace("=", " = ")

    def field(
        self,
        *,
        vectors: str | None = None,
        plane: str | None = None,
        block: str | None = None,
        **options: Any,
    ) -> FlowField:
        """Make a field.

        Parameters
        ----------
        vectors
            Name of the velocity; the first of :attr:`vectors` by default.
        plane
            Such as ``"k=20"``; the middle of the last axis by default, where there is a choice.
        block
            As for :meth:`part`.
        **options
            Further arguments of :meth:`FlowField.from_pyvista`.

        Raises
        ------
        FieldError
            When what is asked for is not there, or makes no field.
        """
        if isinstance(self._mesh, FlowField):
            return self._mesh
        if self.blocks:
            return self.part(block).field(vectors=vectors, plane=plane, **options)
        plane = plane or self.default_plane or None
        chosen = vectors or (self.vectors[0] if self.vectors else None)
        if self._block is not None:
            options = {**options, "block": self._block}
        with self._errors():
            return FlowField.from_pyvista(
                self._mesh, vectors=chosen, plane=plane, name=self.name, **options
            )

    def part(self, block: str | None = None) -> FlowSource:
        """Return the source of one of the :attr:`blocks`; this one itself where there are none.

        The block is named, or numbered; it is the first by default. Raises a FieldError when there
        is no such block.
        """
        if not self.blocks:
            return self
        if block is not None and block.isdecimal() and int(block) < len(self.blocks):
            block = self.blocks[int(block)] if block not in self.blocks else block
        block = block or self.blocks[0]
        if block not in self.blocks:
            msg = f"block is {block!r}; there are {', '.join(self.blocks)}"
            raise FieldError(msg)
        # Pages share a source, and there is one reader.
        with self._lock:
            if block not in self._parts:
                self._parts[block] = self._open_part(block)
        return self._parts[block]

    def _open_part(self, block: str) -> FlowSource:
        options: dict[str, Any] = {"name": self.name, "velocity": self._velocity}
        if block in self._grids:
            return FlowSource(self._grids[block], **options)
        with self._errors():
            part = FlowSource(self._mesh, **options, path=self._path, block=block)
        self.nbytes += part.nbytes
        return part

    def _errors(self) -> AbstractContextManager[None]:
        """Name the file, where there is one and it is read again."""
        return errors_of_file(self._path) if is_reader(self._mesh) and self._path else nullcontext()

    def _describe(self, grid: Any) -> None:
        """Set the dimensions and the names of the vectors."""
        dimensions = tuple(int(n) for n in grid.dimensions)
        self.dimensions = (dimensions[0], dimensions[1], dimensions[2])
        self.vectors = self._names(grid)

    def _names(self, grid: Any) -> tuple[str, ...]:
        """Return the names of what may be the velocity of a grid, the preferred one first."""
        names = [array.name for array in candidates(grid)]
        first = grid.active_vectors_name if self._velocity is None else self._velocity
        if self._velocity is not None or first in names:
            names = [first, *names]
        return tuple(dict.fromkeys(names))

    def _series(self, mesh: Any) -> list[TimeStep]:
        """Return the time steps of a mesh, in memory where they fit; of several blocks the first.

        Of a reader with times and several blocks each block is a series, read when it is asked for.
        """
        series = len(times_of(mesh)) > 1
        first = mesh.read() if is_reader(mesh) else mesh
        several = {} if self._block is not None else several_grids(first, series=series)
        if several:
            self.blocks = tuple(several)
            self.block_vectors = {name: self._names(grid) for name, grid in several.items()}
            if not series:
                self._grids = several
                self.nbytes = sum(_bytes(grid) for grid in several.values())
            return [TimeStep(next(iter(several.values())), None, "the mesh")]
        steps: list[TimeStep] = []
        for step in time_steps(mesh if series else first, self._block):
            steps.append(step)
            self.nbytes += _bytes(step.grid)
            if self.nbytes > MAX_SERIES_BYTES:
                return steps[:1]
        self._mesh = steps[0].grid if len(steps) == 1 else steps
        self._block = None
        return steps


def _bytes(grid: Any) -> int:
    return int(grid.actual_memory_size) * 1024
