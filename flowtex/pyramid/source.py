"""Sources of a pyramid: a field, or a dataset from which each task reads a region."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from flowtex._util.arguments import are_paths
from flowtex._util.array_types import Bools, Floats
from flowtex._util.arrays import norm
from flowtex.errors import FieldError, import_extra
from flowtex.field import FlowField
from flowtex.field.field_arrays import SourceArrays
from flowtex.field.folds import ROWS_OF_FOLDS
from flowtex.field.options import FieldOptions
from flowtex.field.scalars import Scalars
from flowtex.field.steps import LazySteps, Nodes, Steps, typical_steps
from flowtex.field.uncertainty import with_uncertainty
from flowtex.field.units import speed_unit
from flowtex.pyramid.places import (
    PyramidError,
    ReadFault,
    fault_words,
    is_remote,
    is_store,
    place_text,
    store_at,
)
from flowtex.sources.datasets import is_dataset
from flowtex.sources.datasets.read_datasets import read_datasets
from flowtex.sources.datasets.select import find_pairs, two_names
from flowtex.sources.datasets.values import Regions
from flowtex.sources.inspection.inspect_file import inspect_file
from flowtex.sources.maps import Lines
from flowtex.sources.opening.dataset_files import dataset_paths, is_dataset_file
from flowtex.sources.read_files import errors_of, read_files
from flowtex.textures.tiles.grid_pyramid import GridPyramid
from flowtex.textures.value_ranges import drawn_speeds, ends_of
from flowtex.trace.store import chosen_lines, judged_lines

WHOLE_NODES = 2_000_000  #: Nodes up to which a dataset is opened as a whole.
MOST_SAMPLES = 1 << 20  #: Nodes of a sample of one time for ranges of colours.


class FieldSource:
    """A field in the memory of the process that builds, with nodes (J, I) of a ``shape``.

    ``scalars`` are numbers of steps. ``flat`` is whether it lies in a plane of even height,
    ``rectilinear`` whether two lines give all positions, ``late`` whether steps are read when they
    are needed, ``travels`` whether a remote worker can read it, ``has_position`` ``None`` if all
    have.
    """

    travels = False

    def __init__(self, field: FlowField) -> None:
        if field.triangles is not None or field.sign_free:
            if field.triangles is not None:
                kind = "on triangles"
            else:
                kind = "sign-free"
            raise FieldError(
                f"the field is {kind}; expected one with signs on a structured surface. "
                f"{ROWS_OF_FOLDS}"
            )
        self.field = field
        self.shape = field.shape
        self.scalars = {name: len(steps) for name, steps in field.scalars.items()}
        x, y, z = np.moveaxis(field.points, -1, 0)
        on_map = field.projection is not None and not field.projection.is_globe
        self.late = isinstance(field.velocity, LazySteps)
        if self.late:
            level = on_map
        else:
            level = not np.any(field.velocity[..., 2])
        self.flat = bool((z == z[0, 0]).all()) and level
        self.rectilinear = self.flat and bool((x == x[:1]).all() and (y == y[:, :1]).all())
        has_position = field.has_position
        if has_position is None or has_position.all():
            self.has_position = None
        else:
            self.has_position = has_position

    def points(self, rows: Lines, columns: Lines) -> Floats:
        """Return positions (J, I, 3) of some rows and columns, by slices or numbers."""
        return np.asarray(self.field.points[rows][:, columns])

    def nodes(self, step: int, rows: slice, columns: slice, valid: Bools | None = None) -> Nodes:
        """Return the data of some nodes at a time step; ``valid`` where it is known already."""
        del valid
        field = self.field
        at = (rows, columns)
        scalars = {}
        for k, s in field.scalars.items():
            if step < len(s):
                scalars[k] = np.asarray(s[step])[at]
        velocity = np.asarray(field.velocity[step])[at]
        if self.has_position is None:
            has_position = None
        else:
            has_position = self.has_position[at]
        return Nodes(field.points[at], field.valid[at], velocity, scalars, has_position)

    def chosen_lines(self, lines: str) -> str:
        """Return the kind of lines to draw, as :func:`flowtex.trace.chosen_lines` does."""
        return chosen_lines(self.field, lines)

    def with_uncertainty(self, value: Any) -> FieldSource:
        """Return the source with an uncertainty of its direction, see :func:`with_uncertainty`."""
        return FieldSource(with_uncertainty(self.field, value))

    def ranges(self) -> dict[str, list[tuple[float, float] | None]]:
        """Return ends of scalars and of the speed, whole and robust."""
        field = self.field
        typical = self.field.typical
        values = {}
        for name, steps in typical.scalars.items():
            values[name] = np.asarray(steps)[:, field.valid]
        values.setdefault("speed", drawn_speeds(typical, GridPyramid(field).root))
        return _whole_and_robust(values)


class RegionSource:
    """A dataset from which each task reads a region; its ``field`` has no nodes."""

    travels = True
    has_position = None

    def __init__(self, regions: Regions) -> None:
        lines = regions.lines
        steps = len(regions.words["times"])
        self.regions = regions
        self.shape = lines.shape
        self.scalars = dict.fromkeys(regions.names, steps)
        self.flat = lines.projection is None or not lines.projection.is_globe
        self.rectilinear = self.flat
        self.late = steps > 1
        self.field = FlowField(
            points=np.zeros((1, 1, 3)),
            velocity=np.zeros((steps, 1, 1, 3)),
            valid=np.zeros((1, 1), dtype=bool),
            periodic=(False, lines.periodic == "i"),
            projection=lines.projection,
            **regions.words,
        )

    def points(self, rows: Lines, columns: Lines) -> Floats:
        """Return positions of nodes."""
        return self.regions.lines.points(rows, columns)

    def nodes(self, step: int, rows: Lines, columns: Lines, valid: Bools | None = None) -> Nodes:
        """Read the data of some nodes."""
        return self.regions.nodes(step, rows, columns, valid)

    def with_regions(self, regions: Regions) -> RegionSource:
        """Return the same flow at other nodes."""
        source = RegionSource(regions)
        source.field = self.field
        return source

    def late_nodes(self, rows: Lines, columns: Lines) -> Nodes:
        """Return the data of some nodes at all steps; those of a series are read when needed."""
        first = self.nodes(0, rows, columns)
        count = len(self.field.times)
        if count == 1:
            scalars = {name: values[None] for name, values in first.scalars.items()}
            return first._replace(velocity=first.velocity[None], scalars=scalars)

        def velocity(step: int) -> Floats:
            return np.asarray(self.nodes(step, rows, columns, first.valid).velocity)

        def scalar(name: str) -> Callable[[int], Floats]:
            return lambda step: self.regions.scalar(name, step, rows, columns)

        late: dict[str, Steps] = {"speed": LazySteps(count, partial(self._speed, rows, columns))}
        for name in self.regions.scalars:
            late[name] = LazySteps(count, scalar(name))
        return first._replace(velocity=LazySteps(count, velocity), scalars=late)

    def _speed(self, rows: Lines, columns: Lines, step: int) -> Floats:
        """Return the speed of some nodes, NaN where there are no data."""
        u, v = self.regions.components(step, rows, columns)
        speed = np.hypot(u, v)
        if "speed" in self.scalars:  # on a map, in the unit of the data
            return speed
        return speed * self.regions.factor * self.field.speed_scale

    def part(self, rows: Lines, columns: Lines, periodic: tuple[bool, bool]) -> FlowField:
        """Return some rows and columns as a field, whose steps are read when needed."""
        nodes = self.late_nodes(rows, columns)
        field = self.field
        units = dict(field.units)
        if "speed" in nodes.scalars:
            own_unit = field.velocity_unit or speed_unit(field.length_unit, field.time_unit)
            units.setdefault("speed", own_unit)
        return replace(
            field,
            points=nodes.points,
            velocity=nodes.velocity,
            valid=nodes.valid,
            periodic=periodic,
            scalars=Scalars(nodes.scalars),
            units=units,
        )

    def chosen_lines(self, lines: str) -> str:
        """Return the kind of lines to draw, judged at some of the nodes."""
        if lines != "auto" or not self.late:
            return chosen_lines(self.field, lines)
        rows, columns = judged_lines(self.shape)
        first = self.regions.nodes(0, rows, columns)

        def velocity(step: int) -> Floats:
            return np.asarray(self.regions.nodes(step, rows, columns, first.valid).velocity)

        sample = FlowField(
            points=first.points,
            velocity=LazySteps(len(self.field.times), velocity),
            times=self.field.times,
            valid=first.valid,
            periodic=(False, False),
        )
        return chosen_lines(sample, lines)

    def with_uncertainty(self, value: Any) -> RegionSource:
        """Set the uncertainty: the name of a scalar, which is read by region."""
        unread = dict.fromkeys(self.scalars, np.zeros((1, 1, 1)))
        field = with_uncertainty(self.field.same_flow(scalars=unread), value)
        self.field = field.same_flow(scalars={})
        return self

    def ranges(self) -> dict[str, list[tuple[float, float] | None]]:
        """Return the ranges of the scalars and of the speed, from a sample of nodes and steps.

        Returns
        -------
        dict
            For each name the whole and the robust range, each from low to high.

        Raises
        ------
        FieldError
            When no sampled node has data.
        """
        every = math.ceil(math.sqrt(math.prod(self.shape) / MOST_SAMPLES))
        rows = np.arange(0, self.shape[0], every)
        columns = np.arange(0, self.shape[1], every)
        found: dict[str, list[Floats]] = {}
        for step in typical_steps(len(self.field.times)):
            nodes = self.nodes(step, rows, columns)
            speed = norm(nodes.velocity) * self.field.speed_scale
            for name, values in {"speed": speed, **nodes.scalars}.items():
                found.setdefault(name, []).append(np.where(nodes.valid, values, np.nan))
        ranges = _whole_and_robust({name: np.stack(steps) for name, steps in found.items()})
        if not ranges:
            raise FieldError("no node has data; check the selected variables")
        return ranges


NodeSource: TypeAlias = FieldSource | RegionSource  #: Sources of a pyramid.


def periods_of(source: NodeSource) -> tuple[Floats, Floats]:
    """Return vectors from the first line of an axis to the last, (3,), for both axes."""
    ends = np.array([0, -1])
    every = slice(None)
    down = source.points(ends, every)
    across = source.points(every, ends)
    return np.mean(down[1] - down[0], axis=0), np.mean(across[:, 1] - across[:, 0], axis=0)


def source_of(data: Any, **options: Any) -> NodeSource:
    """Return what a pyramid is built from: a field, a mesh, a dataset, or files, with options."""
    source = _source_of(data, **options)
    uncertainty = options.get("uncertainty")
    if uncertainty is None:
        return source
    return source.with_uncertainty(uncertainty)


def _whole_and_robust(
    values: Mapping[str, Floats],
) -> dict[str, list[tuple[float, float] | None]]:
    """Return the whole and the robust range of each scalar that has values."""
    ranges = {}
    for name, numbers in values.items():
        ends = [ends_of(numbers, robust=False), ends_of(numbers, robust=True)]
        if None not in ends:
            ranges[name] = ends
    return ranges


def _source_of(data: Any, *, name: str = "", **given: Any) -> NodeSource:
    """Return the nodes of data, of a large dataset region by region."""
    if isinstance(data, (FlowField, NodeSource)):
        refused = []
        for key, value in {**given, "name": name or None}.items():
            if value is not None and key != "uncertainty":
                refused.append(key)
        if refused:
            raise FieldError(f"{', '.join(refused)} applies to the data of a field; omit it")
        if isinstance(data, NodeSource):
            return data
        return FieldSource(data)
    if is_store(data):
        raise FieldError(f"{data} is already a pyramid; give the data from which one is built")
    options = FieldOptions.of_dataset(given)
    # An array has a value for each node; a name may be a dimension to average over.
    regions = options.uncertainty is None or isinstance(options.uncertainty, str)
    if is_dataset(data):
        return _source_from(read_datasets(data, options, name=name, regions=regions))
    if isinstance(data, (list, tuple)):
        items = data
    else:
        items = [data]
    if not are_paths(items):
        given.pop("uncertainty", None)
        return FieldSource(FlowField.from_pyvista(data, name=name, **given))
    files: str | Path | Sequence[str | Path] = data
    if isinstance(files, (str, Path)) and has_parts(files):
        place = place_text(files)
        finest, *_ = datasets_at(place, options)
        arrays = read_datasets(finest, options, name=Path(place).stem, regions=regions)
        return _source_from(arrays)
    with errors_of(files):
        time = None
        if not dataset_paths(files):
            time = given.pop("time", None)
            options = FieldOptions.of(**given)
        return _source_from(read_files(files, options, time=time, regions=regions))


def _source_from(arrays: SourceArrays | Regions) -> NodeSource:
    if isinstance(arrays, Regions):
        return RegionSource(arrays)
    return FieldSource(FlowField.of(arrays))


def has_parts(place: object) -> bool:
    """Return whether a place is a store of any program that is read in parts, as all URLs are."""
    if not isinstance(place, (str, Path)) or is_store(place):
        return isinstance(place, (str, Path))
    if is_remote(place):
        return True
    folder = Path(place_text(place))
    if not (folder.is_dir() and is_dataset_file(folder)):
        return False
    zarr = import_extra("zarr", "xarray")
    from flowtex._util.zarr_stores import checked_folder

    try:
        group = zarr.open_group(checked_folder(folder), mode="r")
        shapes = [array.shape for _, array in group.arrays()]
    except (OSError, ValueError, KeyError, TypeError):  # the reader reports the fault
        return False
    for shape in shapes:
        if len(shape) > 1 and math.prod(shape[-2:]) > WHOLE_NODES:
            return True
    return "multiscales" in group.attrs


def datasets_at(place: str, options: FieldOptions) -> list[Any]:
    """Return the datasets with a velocity in a Zarr store of another program, the finest first.

    Parameters
    ----------
    place
        Folder or URL of the store.
    options
        Options of the field; ``vectors`` names the components.

    Raises
    ------
    PyramidError
        When xarray cannot open the store, or no group has a velocity.
    FieldError
        When an array is damaged or does not fit into memory.
    ModuleNotFoundError
        When xarray or Zarr is not installed.
    """
    xarray = import_extra("xarray", "xarray")
    import_extra("zarr", "xarray")
    from flowtex._util.zarr_stores import check_arrays
    from flowtex.pyramid.objects import Objects
    from flowtex.pyramid.unlisted import UnlistedStore

    components = set(filter(None, two_names(options.vectors)))
    unlisted: UnlistedStore | None = None
    if not is_remote(place):
        with errors_of(place):
            inspect_file(Path(place))
    try:
        files = store_at(place)
        if is_remote(place):
            files = unlisted = UnlistedStore(files, sorted(components))
        store = Objects(files, sparse=True)
        if is_remote(place):
            check_arrays(store)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # of metadata that lie apart
            groups = xarray.open_groups(store, engine="zarr", decode_timedelta=False)
    except (PyramidError, ModuleNotFoundError):
        raise
    except FieldError as error:  # of the checks
        raise FieldError(f"{place}: {error}") from None
    except Exception as error:
        if isinstance(error, ReadFault):
            words = str(error)
        else:
            words = fault_words(error)
        raise PyramidError(
            f"{place} contains no readable pyramid ({words}); build one, or give a Zarr group that "
            "xarray can open (on the web see zarr.consolidate_metadata)"
        ) from None
    levels = []
    for d in groups.values():
        if (components and components <= {*d}) or find_pairs([d]):
            levels.append(d)
    if not levels and unlisted is not None and not unlisted.was_listed:
        raise PyramidError(
            f"no velocity was found in {place}: its server lists no files, and the store has no "
            "consolidated metadata. Name the components, such as --u uo --v vo or u='uo', v='vo'; "
            "or consolidate the metadata with zarr.consolidate_metadata"
        )
    if not levels:
        raise PyramidError(
            f"{place} contains no pyramid, and no velocity; expected two variables such as u and "
            "v, or their names (on the web see zarr.consolidate_metadata)"
        )
    return sorted(levels, key=_largest_array, reverse=True)


def _largest_array(dataset: Any) -> int:
    """Return the number of values of the largest variable."""
    sizes = [int(array.size) for array in dataset.values()]
    return max(sizes)
