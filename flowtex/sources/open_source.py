"""A file or a mesh that stays open, from which one field after another is made.

The file is read once, and each plane is made from memory. Only a series that is too large for that
is read again.
"""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.forks import ProcessLock
from flowtex.errors import FieldError, Notice
from flowtex.field.earth.projection import GLOBE, NAMES
from flowtex.field.field import FlowField
from flowtex.field.options import FieldOptions
from flowtex.sources.datasets.axes import TIME, axis_values
from flowtex.sources.datasets.flow import read_flow
from flowtex.sources.datasets.select import find_pairs, two_names, variable
from flowtex.sources.maps import projection_of
from flowtex.sources.meshes import parts
from flowtex.sources.meshes.series import limited, wall_stress
from flowtex.sources.meshes.vectors import candidates
from flowtex.sources.models.drifters import moments_of
from flowtex.sources.notices import DatasetNotice, Record
from flowtex.sources.opening.dataset_files import (
    as_datasets,
    common_name,
    dataset_paths,
    of_tree,
    open_datasets,
)
from flowtex.sources.opening.tables import as_dataset
from flowtex.sources.read_files import Identity, one_path, open_file
from flowtex.sources.reader_errors import errors_of_file

#: Size of a series that is held in memory; a larger one is read again for each field.
MAX_SERIES_BYTES = 2_000_000_000
#: Places of a plane that cuts a volume, evenly spaced along an axis; one of them in the middle.
CUTS = 101
#: A cut across an axis, through the middle or a place.
_ACROSS = re.compile(r"\s*([xyz])\s*(?:=\s*([-+.\w]+)\s*)?")
#: The surface around a volume, among its planes.
OUTER = "outer"


class FlowSource:
    """The choices of a file, a mesh or a field, from which one field after another is made.

    ``identity`` is the state of its files when they were opened.
    """

    def __init__(self, name: str = "") -> None:
        self.name = name
        #: Names of the arrays that may be the velocity; empty where there is no choice.
        self.vectors: tuple[str, ...] = ()
        #: Number of nodes (I, J, K) of a structured mesh; ``None`` for others, and for a field.
        self.dimensions: tuple[int, int, int] | None = None
        #: Names of several meshes that are not time steps, of the arrays that may be the velocity
        #: in each, and a word for one of them.
        self.blocks: tuple[str, ...] = ()
        self.block_vectors: dict[str, tuple[str, ...]] = {}
        self.block_word = "Grid"
        #: The plane that is drawn where none is chosen; empty for a surface.
        self.default_plane = ""
        #: Ends of a volume along the axes across which it can be cut.
        self.ends: dict[str, tuple[float, float]] = {}
        #: Other axes with a choice, and a text for each entry.
        self.axes: dict[str, tuple[str, ...]] = {}
        #: Whether a part of the file is read when a field is requested.
        self.reads_late = False
        self.nbytes = 0
        self.identity: Identity = ()

    @property
    def planes(self) -> dict[str, int]:
        """Axes of planes, those of the index first, and how many; empty for a surface."""
        named = {name: len(words) for name, words in self.axes.items()}
        if not self.ends:
            return named
        outer = {OUTER: 1}
        if self.dimensions is not None:
            outer = dict(zip("ijk", self.dimensions, strict=True))
        return {**named, **outer, **dict.fromkeys(self.ends, CUTS)}

    @property
    def alive(self) -> bool:
        """Whether it can still make fields."""
        return True

    def plane_at(self, axis: str, number: int) -> str:
        """Return the plane of an axis by its number from 0, such as ``"k=20"`` or ``"x=0.25"``."""
        if axis not in self.ends:
            return f"{axis}={number}"
        low, high = self.ends[axis]
        # Enough digits to distinguish neighbouring positions.
        digits = 3 - math.floor(math.log10(high - low))
        return f"{axis}={round(low + (high - low) * (number + 0.5) / CUTS, digits):.12g}"

    def plane_of(self, cut: str) -> str | None:
        """Return the plane of a cut across an axis, such as ``"z=1"`` or ``"z"``, if it is one."""
        found = _ACROSS.fullmatch(cut)
        if found is None or found[1] not in self.ends:
            return None
        axis = found[1]
        value = found[2]
        if value is None:
            return self.plane_at(axis, CUTS // 2)
        return f"{axis}={value}"

    def plane_number(self, plane: str) -> int | None:
        """Return the number of a plane, or of the nearest; ``None`` if it does not exist."""
        axis, _, text = plane.partition("=")
        try:
            value = float(text)
            if axis in self.ends:
                low, high = self.ends[axis]
                value = min(max((value - low) / (high - low) * CUTS - 0.5, 0), CUTS - 1)
            number = round(value)
        except (ValueError, OverflowError):
            return None
        if 0 <= number < self.planes.get(axis, 0):
            return number
        return None

    def plane_text(self, plane: str) -> str:
        """Return the text for a plane, such as ``"k = 20"`` or ``"500 hPa"``."""
        axis, _, number = plane.partition("=")
        words = self.axes.get(axis, ())
        if number.isdecimal() and int(number) < len(words):
            return words[int(number)]
        if axis == OUTER:
            return "outer surface"
        return plane.replace("=", " = ")

    def field(
        self, vectors: str | None = None, plane: str = "", block: str | None = None, **options: Any
    ) -> FlowField:
        """Make a field of one of :attr:`vectors`, the first by default, and of one plane.

        The plane is such as ``"k=20"``, ``"x=0.25"`` or ``"outer=0"``, by default
        :attr:`default_plane`, and the block as for :meth:`part`. Options are further arguments of
        the function that makes the field, such as :meth:`FlowField.from_pyvista`.

        Raises
        ------
        NotImplementedError
            In this class; each kind of source has its own method.
        """
        raise NotImplementedError

    def part(self, block: str | None = None) -> FlowSource:
        """Return the source of one of the :attr:`blocks`, named or numbered, or this one itself.

        Raises
        ------
        NotImplementedError
            In this class; each kind of source has its own method.
        """
        raise NotImplementedError


class MeshSource(FlowSource):
    """A mesh, a series or a field, from which one field after another is made.

    The ``mesh`` is as for :meth:`FlowField.from_pyvista`, or a field. ``velocity`` is the name of
    the velocity where the format of a file fixes it, ``path`` the file, for errors, and ``block``
    the path of the block if there are several.
    """

    def __init__(
        self,
        mesh: Any,
        *,
        name: str = "",
        velocity: str | None = None,
        path: Path | None = None,
        block: str | None = None,
    ) -> None:
        super().__init__(name)
        self._parts: dict[str, MeshSource] = {}
        self._lock = ProcessLock()
        self._mesh = mesh
        self._velocity = velocity
        self._path = path
        self._block = block
        #: Names of possible velocities that the first time lacks, and of the stress on a wall.
        self._later: list[str] = []
        self._stress: list[str] = []
        if isinstance(mesh, FlowField):
            self.name = name or mesh.name
            self.nbytes = mesh.nbytes
        else:
            self._describe(self._first(mesh))
            self.reads_late = parts.is_reader(self._mesh)

    @classmethod
    def from_file(cls, path: str | Path) -> MeshSource:
        """Open a file, as for :meth:`FlowField.from_file`.

        Raises
        ------
        FieldError
            When the file cannot be read; the error starts with the path.
        """
        with errors_of_file(path):
            file = open_file(path)
            if file.problem:
                raise FieldError(file.problem)
            return cls(file.source, name=file.path.stem, velocity=file.velocity, path=file.path)

    def field(
        self, vectors: str | None = None, plane: str = "", block: str | None = None, **options: Any
    ) -> FlowField:
        """Make a field, as :meth:`FlowSource.field` does."""
        if isinstance(self._mesh, FlowField):
            return self._mesh
        if self.blocks:
            return self.part(block).field(vectors, plane, **options)
        if not {"slice", "contour"} & set(options):
            plane = plane or self.default_plane
            axis = plane.partition("=")[0].strip().lower()
            if axis not in ("", OUTER):
                options["slice" if axis in "xyz" else "plane"] = plane
        chosen = vectors or (self.vectors[0] if self.vectors else None)
        if self._block is not None:
            options = {**options, "block": self._block}
        with warnings.catch_warnings(), self._errors():
            # The page shows the choices.
            warnings.simplefilter("ignore", Notice)
            return FlowField.from_pyvista(self._mesh, vectors=chosen, name=self.name, **options)

    def part(self, block: str | None = None) -> MeshSource:
        """Return the source of one of the blocks, as :meth:`FlowSource.part` does.

        Raises
        ------
        FieldError
            When the block does not exist.
        """
        if not self.blocks:
            return self
        if block is not None and block not in self.blocks and block.isdecimal():
            number = int(block)
            if number < len(self.blocks):
                block = self.blocks[number]
        block = block or self.blocks[0]
        if block not in self.blocks:
            raise FieldError(f"block is {block!r}; expected one of {', '.join(self.blocks)}")
        # Pages share a source, and there is one reader.
        with self._lock, self._errors():
            if block not in self._parts:
                options: dict[str, Any] = {"name": self.name, "velocity": self._velocity}
                part = MeshSource(self._mesh, **options, path=self._path, block=block)
                self.nbytes += part.nbytes if parts.is_reader(self._mesh) else 0
                self._parts[block] = part
        return self._parts[block]

    def _errors(self) -> AbstractContextManager[None]:
        """Name the file, where there is one and it is read again."""
        if parts.is_reader(self._mesh) and self._path:
            return errors_of_file(self._path)
        return nullcontext()

    def _describe(self, mesh: Any) -> None:
        self.vectors = tuple(dict.fromkeys([*self._stress, *self._names(mesh), *self._later]))
        if parts.is_structured(mesh):
            i, j, k = map(int, mesh.dimensions)
            self.dimensions = i, j, k
        if mesh.max_cell_dimensionality < 3:
            return
        ends = zip("xyz", np.reshape(mesh.bounds, (3, 2)).tolist(), strict=True)
        self.ends = {axis: (low, high) for axis, (low, high) in ends if low < high}
        if self.dimensions is not None:
            self.default_plane = f"k={self.dimensions[2] // 2}"
            return
        # The inside shows more than walls, where nothing flows.
        self.default_plane = f"{OUTER}=0"
        shortest = min(self.ends, key=lambda axis: np.ptp(self.ends[axis]), default="")
        if shortest and mesh.slice(normal=shortest).n_cells:
            self.default_plane = self.plane_at(shortest, CUTS // 2)

    def _names(self, grid: Any) -> tuple[str, ...]:
        """Return the names of vectors that can be the velocity, the likely one first."""
        names = [array.name for array in candidates(grid)]
        if self._velocity is None:
            first = grid.active_vectors_name
        else:
            first = self._velocity
        if self._velocity is not None or first in names:
            preferred = [first]
        else:
            preferred = []
        return tuple(dict.fromkeys([*preferred, *names]))

    def _first(self, mesh: Any) -> Any:
        """Return the mesh of the first step or block; series that fit stay in memory."""
        series = len(parts.times_of(mesh)) > 1
        if parts.is_reader(mesh):
            first = parts.read_checked(mesh)
        else:
            first = mesh
        one = self._block is not None or isinstance(first, (list, tuple))
        if blocks := {} if one else _choices(first, series=series):
            self.blocks = tuple(blocks)
            self.block_vectors = {name: self._names(grid) for name, grid in blocks.items()}
            if series:
                self._add_last(mesh)
            else:
                self._mesh = first
                self.nbytes = sum(map(_bytes, blocks.values()))
            return next(iter(blocks.values()))
        steps: list[parts.TimeStep] = []
        for step in parts.time_steps(mesh if series else first, self._block):
            steps.append(step)
            self._later += self._names(step.grid)
            self.nbytes += _bytes(step.grid)
            if self.nbytes > MAX_SERIES_BYTES:
                return steps[0].grid
        stress = wall_stress(iter(steps), Record())
        if stress is not None:
            self._stress = [stress]
        if len(steps) == 1:
            self._mesh = steps[0].grid
        else:
            self._mesh = steps
        self._block = None
        return steps[0].grid

    def _add_last(self, reader: Any) -> None:
        """Add the vectors that only the last time of blocks has."""
        last = parts.parts_of(limited(reader, parts.times_of(reader)[-1:]).read())
        for name, vectors in self.block_vectors.items():
            if name in last:
                every = dict.fromkeys([*vectors, *self._names(last[name])])
                self.block_vectors[name] = tuple(every)


def _choices(mesh: Any, *, series: bool) -> parts.Parts:
    """Return the blocks that may be chosen, the default ones first; none for a single one."""
    drawn, combination = parts.drawn_parts(mesh, series=series)
    if combination in ("together", "steps"):
        return {}
    others = {}
    for name, part in parts.parts_of(mesh).items():
        if candidates(part):
            others[name] = part
    choices = {**drawn, **others}
    if len(choices) > 1:
        return choices
    return {}


def _bytes(grid: Any) -> int:
    return int(grid.actual_memory_size) * 1024


class DatasetSource(FlowSource):
    """Datasets of xarray's that belong together; blocks are the maps they can be drawn on."""

    def __init__(self, datasets: Any, *, name: str = "") -> None:
        super().__init__(name)
        self._datasets = as_datasets(datasets)
        #: Trajectories before they become points at one time, and the times to choose from.
        self._tracks = datasets
        self._moments, fullest = _moments_of(datasets)
        pairs = find_pairs(self._datasets)
        likely = [pair for pair in pairs if pair.rank == pairs[0].rank]
        if pairs:
            pair = likely[0]
        else:
            pair = None
        flow = read_flow(
            self._datasets, FieldOptions(vectors=pair.names if pair else None), Record()
        )
        first = variable(self._datasets, str(flow.pair.u.name))
        self.vectors = tuple(dict.fromkeys(pair.names for pair in (flow.pair, *pairs)))
        if flow.places.is_earth:
            flat = projection_of(flow.places, None).name
            self.blocks = tuple(dict.fromkeys((flat, GLOBE, *NAMES)))
            self.block_vectors = dict.fromkeys(self.blocks, self.vectors)
        self.block_word = "Map"
        self.reads_late = True
        self.axes = axis_values(first)
        if name := next(iter(self.axes), ""):
            self.default_plane = f"{name}={flow.drawn.numbers.get(name, 0)}"
        if len(self._moments) > 1:
            self.axes = {TIME: tuple(map(_moment_text, self._moments))}
            self.default_plane = f"{TIME}={fullest}"
        self._datasets.close()

    def part(self, block: str | None = None) -> FlowSource:
        """Return this source, which draws on any of the maps.

        Raises
        ------
        FieldError
            When the map does not exist.
        """
        if block is not None and block not in self.blocks:
            raise FieldError(f"block is {block!r}; expected one of {', '.join(self.blocks)}")
        return self

    def field(
        self, vectors: str | None = None, plane: str = "", block: str | None = None, **options: Any
    ) -> FlowField:
        """Make a field, as :meth:`FlowSource.field` does."""
        vectors = vectors or self.vectors[0]
        u, _ = two_names(vectors)
        axis, _, number = (plane or self.default_plane).partition("=")
        array = next((ds[u] for ds in self._datasets if u in ds), None)
        data = self._datasets
        if axis == TIME and len(self._moments) > 1:
            options["sel"] = {**(options.get("sel") or {}), axis: self._moments[int(number)]}
            data = self._tracks
        elif array is not None and axis in axis_values(array):
            options["isel"] = {**(options.get("isel") or {}), axis: int(number)}
        options |= {"vectors": vectors, "projection": block or None, "name": self.name}
        with warnings.catch_warnings():
            # The page shows the choices.
            warnings.simplefilter("ignore", DatasetNotice)
            return FlowField.from_xarray(data, **options)


def _moments_of(datasets: Any) -> tuple[list[Any], int]:
    """Return the times of trajectories among datasets, and the number of the fullest one."""
    several = isinstance(datasets, (list, tuple))
    for item in datasets if several else [datasets]:
        if hasattr(item, "subtree"):
            groups = of_tree(item)
        else:
            groups = [as_dataset(item, several=several)]
        for found in map(moments_of, groups):
            if found[0]:
                return found
    return [], 0


def _moment_text(moment: Any) -> str:
    """Return a time of trajectories as a page shows it."""
    if isinstance(moment, str):
        return moment.replace("T", " ")
    return f"{moment:g}"


def open_source(path: str | Path | Sequence[str | Path]) -> FlowSource:
    """Open a file, or several of data of the Earth; errors start with the path."""
    paths = dataset_paths(path)
    if not paths:
        return MeshSource.from_file(one_path(path))
    with errors_of_file(paths[0]):
        return DatasetSource(open_datasets(paths), name=common_name(paths))
