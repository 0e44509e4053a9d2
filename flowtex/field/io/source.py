"""A file or a mesh that stays open, and gives one field after another.

A person who looks for the right plane asks for many of them. The file is read once then, and each
plane is taken out of what is in memory; only a series too large for that is read again.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from flowtex.errors import FieldError
from flowtex.field.field import FlowField
from flowtex.field.io.files import open_file, reading
from flowtex.field.io.from_pyvista import from_pyvista
from flowtex.field.io.mesh_arrays import candidates
from flowtex.field.io.meshes import Step, is_structured, leaves, steps

__all__ = ["FlowSource", "field_bytes"]

#: Bytes of a series that are kept in memory.
KEEP = 2_000_000_000


class FlowSource:
    """What fields can be made from.

    Parameters
    ----------
    mesh
        What :meth:`FlowField.from_pyvista` takes, or a field.
    name
        A word for captions.
    velocity
        Name of the velocity where the format of a file fixes it.

    Attributes
    ----------
    name
        A word for captions.
    vectors
        Names of the arrays that may be the velocity; empty where there is no choice.
    dimensions
        Number of nodes (I, J, K); ``None`` for a field that is made already.
    blocks
        Names of the structured grids, where there are several that are no time steps.
    nbytes
        Bytes that are in memory for it.

    Raises
    ------
    FieldError
        When nothing in it can be drawn.
    """

    def __init__(self, mesh: Any, *, name: str = "", velocity: str | None = None) -> None:
        self.name = name
        self.vectors: tuple[str, ...] = ()
        self.dimensions: tuple[int, int, int] | None = None
        self.blocks: tuple[str, ...] = ()
        self.nbytes = 0
        self._grids: dict[str, Any] = {}
        self._parts: dict[str, FlowSource] = {}
        self._mesh = mesh
        self._velocity = velocity
        if isinstance(mesh, FlowField):
            self.name, self.nbytes = name or mesh.name, field_bytes(mesh)
            return
        found = self._series(mesh)
        if found is None:
            self.blocks = tuple(self._grids)
            found = [Step(next(iter(self._grids.values())), None, "the mesh")]
        self._describe(found[0].grid)

    @classmethod
    def from_file(cls, path: str | Path) -> FlowSource:
        """Open a file; :func:`flowtex.field.io.files.from_file` says which.

        Raises
        ------
        FieldError
            When it cannot be read; the text starts with the path.
        """
        file, mesh, velocity = open_file(path)
        with reading(file):
            return cls(mesh, name=file.stem, velocity=velocity)

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
            One of :attr:`blocks`, or its number; the first by default.
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
        return from_pyvista(self._mesh, vectors=chosen, plane=plane, name=self.name, **options)

    def part(self, block: str | None = None) -> FlowSource:
        """Return the source of one of the :attr:`blocks`; this one itself where there are none.

        Parameters
        ----------
        block
            Its name or its number; the first by default.

        Raises
        ------
        FieldError
            When there is no such block.
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
        """Note what one grid offers."""
        dimensions = tuple(int(n) for n in grid.dimensions)
        self.dimensions = (dimensions[0], dimensions[1], dimensions[2])
        found = [array.name for array in candidates(grid)]
        if self._velocity is not None:
            found = [self._velocity, *(name for name in found if name != self._velocity)]
        elif grid.active_vectors_name in found:
            found.sort(key=lambda name: name != grid.active_vectors_name)
        self.vectors = tuple(dict.fromkeys(found))

    def _series(self, mesh: Any) -> list[Step] | None:
        """Time steps in a mesh, kept where they fit; ``None`` where it has unlike grids."""
        several = [(name, grid) for name, grid in leaves(mesh) if is_structured(grid)]
        if len({tuple(grid.dimensions) for _, grid in several}) > 1:
            self._grids = dict(several)
            self.nbytes = sum(int(grid.actual_memory_size) * 1024 for _, grid in several)
            return None
        kept, size = [], 0
        for step in steps(mesh):
            kept.append(step)
            size += int(step.grid.actual_memory_size) * 1024
            self.nbytes = size
            if size > KEEP:
                return kept[:1]
        if len(kept) == 1:
            self._mesh = kept[0].grid
        elif all(step.time is not None for step in kept) or not isinstance(mesh, (list, tuple)):
            self._mesh = _Kept(kept)
        return kept


def field_bytes(field: FlowField) -> int:
    """Return the bytes of a field's arrays."""
    arrays = (field.points, field.velocity, field.valid, *field.scalars.values())
    return sum(array.nbytes for array in arrays)


class _Kept:
    """Steps of a series in memory, read as PyVista's readers are."""

    def __init__(self, kept: list[Step]) -> None:
        self._kept = kept
        self._at = 0
        known = all(step.time is not None for step in kept)
        self.time_values = [
            float(n if step.time is None or not known else step.time) for n, step in enumerate(kept)
        ]

    @property
    def active_time_value(self) -> float:
        return self.time_values[self._at]

    def set_active_time_value(self, time: float) -> None:
        self._at = self.time_values.index(time)

    def read(self) -> Any:
        return self._kept[self._at].grid
