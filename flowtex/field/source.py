"""A file or a mesh that stays open, and gives one field after another.

Who looks for the right plane asks for many of them: the file is read once, and each plane is taken
from memory. Only a series too large for that is read again.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from flowtex.errors import FieldError
from flowtex.field.field import FlowField
from flowtex.field.io.files import errors_of_file, open_file
from flowtex.field.io.meshes import TimeStep, is_structured, leaves, time_steps
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

    Raises
    ------
    FieldError
        When nothing in it can be drawn.
    """

    def __init__(self, mesh: Any, *, name: str = "", velocity: str | None = None) -> None:
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
        self._mesh = mesh
        self._velocity = velocity
        if isinstance(mesh, FlowField):
            self.name, self.nbytes = name or mesh.name, mesh.nbytes
            return
        steps = self._series(mesh)
        if steps is None:
            self.blocks = tuple(self._grids)
            steps = [TimeStep(next(iter(self._grids.values())), None, "the mesh")]
        self._describe(steps[0].grid)

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
            return cls(file.source, name=file.path.stem, velocity=file.velocity)

    @property
    def planes(self) -> dict[str, int]:
        """Axes across which planes can be chosen, and how many there are; empty for a surface."""
        if self.dimensions is None or min(self.dimensions) == 1:
            return {}
        return dict(zip("ijk", self.dimensions, strict=True))

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
        if plane is None and self.planes:
            plane = f"k={self.planes['k'] // 2}"
        chosen = vectors or (self.vectors[0] if self.vectors else None)
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
            block = self.blocks[int(block)] if block not in self._grids else block
        block = block or self.blocks[0]
        if block not in self._grids:
            msg = f"block is {block!r}; there are {', '.join(self.blocks)}"
            raise FieldError(msg)
        if block not in self._parts:
            self._parts[block] = FlowSource(
                self._grids[block], name=self.name, velocity=self._velocity
            )
        return self._parts[block]

    def _describe(self, grid: Any) -> None:
        """Set the dimensions and the names of the vectors."""
        dimensions = tuple(int(n) for n in grid.dimensions)
        self.dimensions = (dimensions[0], dimensions[1], dimensions[2])
        names = [array.name for array in candidates(grid)]
        first = grid.active_vectors_name if self._velocity is None else self._velocity
        if self._velocity is not None or first in names:
            names = [first, *names]
        self.vectors = tuple(dict.fromkeys(names))

    def _series(self, mesh: Any) -> list[TimeStep] | None:
        """Return the time steps of a mesh, in memory where they fit; ``None`` for unlike grids."""
        several = [(name, grid) for name, grid in leaves(mesh) if is_structured(grid)]
        if len({tuple(grid.dimensions) for _, grid in several}) > 1:
            self._grids = dict(several)
            self.nbytes = sum(int(grid.actual_memory_size) * 1024 for _, grid in several)
            return None
        steps: list[TimeStep] = []
        for step in time_steps(mesh):
            steps.append(step)
            self.nbytes += int(step.grid.actual_memory_size) * 1024
            if self.nbytes > MAX_SERIES_BYTES:
                return steps[:1]
        self._mesh = steps[0].grid if len(steps) == 1 else steps
        return steps
