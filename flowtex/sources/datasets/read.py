"""From xarray's datasets to fields: the pair, its axes, its places, and the steps of time.

Only coordinates and one step are read here; other steps are read when they are drawn.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flowtex._util.arguments import near_names
from flowtex._util.array_types import AnyArray, Bools, Floats
from flowtex.errors import FieldError
from flowtex.field.arrays import GridArrays, TriangleArrays
from flowtex.field.dates import as_seconds
from flowtex.field.earth import GLOBE
from flowtex.field.steps import LazySteps
from flowtex.field.uncertainty import spread_name
from flowtex.sources.datasets.axes import (
    FACES,
    LEVEL,
    NODES,
    TIME,
    WET,
    Choice,
    Section,
    axis_direction,
    axis_kind,
    axis_values,
    drawn_steps,
    horizontal_dims,
    sections,
    wet_at,
)
from flowtex.sources.datasets.coordinates import LATITUDE, LONGITUDE, Places
from flowtex.sources.datasets.ensembles import mean_and_spread
from flowtex.sources.datasets.regions import Regions, Words, numbers_in, region_lines
from flowtex.sources.datasets.select import (
    Pair,
    choose_pair,
    find_pairs,
    other_velocities,
    to_metres_per_second,
    variable,
)
from flowtex.sources.datasets.staggered import centred, find_grid, sea_mask, unrepeated
from flowtex.sources.datasets.vertical import is_vertical, read_section
from flowtex.sources.maps.grid_map import Nodes, PlaneNodes, on_map
from flowtex.sources.maps.mesh_map import mesh_on_map
from flowtex.sources.models.conventions import find_mesh
from flowtex.sources.models.mesh import Mesh
from flowtex.sources.models.scattered import check_faces
from flowtex.sources.notices import notify
from flowtex.sources.opening.series import Datasets, as_datasets

if TYPE_CHECKING:
    import xarray as xr

#: Longest name that fits into a legend, and most values of an axis that are listed.
LONGEST_NAME, MOST_VALUES = 40, 8
#: Directions of the components of a pair, in words.
DIRECTIONS = {"earth": "eastward and northward", "grid": "along the grid", "plane": "along x and y"}

#: Variables that belong to the grid itself: places, sizes of cells, masks.
OF_GRIDS = re.compile(
    rf"{LONGITUDE.pattern}|{LATITUDE.pattern}|^(e[12][tuvf]|d[xy][tuvcg]?|[tuvf]?mask\w*|[xy]c?)$",
    re.I,
)

#: Steps whose components are kept, as velocity and speed use the same.
MOST_READ = 4

#: Share of nodes at rest from which on those of a staggered grid count as land.
LAND_SHARE = 0.01


@dataclass(frozen=True, eq=False)
class Recognised:
    """The velocity that was recognised in a dataset, and the reasons."""

    pair: Pair  #: The two variables of the velocity.
    along: str  #: ``"earth"``, or ``"grid"`` for the directions of rows and columns.
    grid: str  #: The kind of grid, as text.
    coordinates: str  #: Names of the coordinates, as text.
    places: Places  #: Nodes in the middle of cells.
    notes: tuple[str, ...]  #: Texts about automatic choices.
    u: Section
    v: Section
    steps: Callable[[int], tuple[Floats, Floats]]
    cells: tuple[str, ...]
    factor: float  #: Unit of the components in m/s.
    ahead: tuple[int, int] = (1, 1)  #: Directions of rows and columns, 1 or -1.
    staggered: bool = False  #: Whether components lie on the sides of cells.
    mask: xr.DataArray | None = None  #: A variable that is positive where there are data.
    kept: tuple[slice, ...] = ()
    trimmed: tuple[slice, ...] = ()
    mesh: Mesh | None = None

    def turned(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return components eastward and northward, or along x and y."""
        if self.along != "grid" or self.places.is_line:
            return u, v
        return self.places.turned(self.ahead, u, v)


def read_datasets(
    data: Any,
    u: str | None = None,
    v: str | None = None,
    *,
    projection: str | None = None,
    globe: bool = False,
    name: str = "",
    sel: Mapping[str, Any] | None = None,
    isel: Mapping[str, Any] | None = None,
    regions: bool = False,
    uncertainty: Any = None,
    **selection: Any,
) -> GridArrays | TriangleArrays | Regions:
    """Read the arrays of a field; with ``regions`` no nodes, if any part can be read by itself.

    If the uncertainty is a dimension, the mean over it is read, and the spread as a scalar.
    """
    if globe and projection not in (None, GLOBE):
        msg = f"globe=True and projection={projection!r} are given; omit one of them"
        raise FieldError(msg)
    projection = GLOBE if globe else projection
    sel = {**(sel or {}), **selection}
    datasets = as_datasets(data)
    if u is not None and v is not None and is_vertical(variable(datasets, v)):
        return read_section(datasets, u, v, name=name, sel=sel, isel=isel or {})
    flow, spread = recognise(datasets, u, v, sel=sel, isel=isel), None
    if isinstance(uncertainty, str) and any(uncertainty in ds.dims for ds in datasets):
        flow, spread, datasets = _averaged(flow, datasets, uncertainty, sel, isel)
        name = ", ".join(filter(None, (name, f"mean over {uncertainty}")))
    for note in (*flow.notes, *(other_velocities(datasets, flow.pair) if u is None else ())):
        notify(note)
    places = flow.places
    if not places.is_earth and projection is not None:
        msg = (
            f"projection is {projection!r}, but the positions are {flow.coordinates}, not "
            "longitude and latitude; omit projection"
        )
        raise FieldError(msg)
    times, numbers = drawn_steps(flow.u, flow.pair.u)
    scalars = _scalars(flow, datasets, Choice(dict(sel), dict(isel or {})))
    words: dict[str, Any] = {
        "name": ", ".join(filter(None, (name, flow.u.level))),
        **_scalar_texts(scalars),
    }
    if regions and flow.mesh is None and spread is None:
        parts = _regions(flow, scalars, times, numbers, projection, words)
        if parts is not None:
            return parts
    nodes, arguments = (
        _on_grid(flow, projection)
        if flow.mesh is None
        else _on_mesh_nodes(flow, flow.mesh, projection)
    )

    def later(read: Callable[[int], Floats]) -> LazySteps:
        return LazySteps(len(numbers), lambda step: read(numbers[step]))

    def value(read: Callable[[int], Floats], number: int) -> Floats:
        return nodes.at(read(number))

    def vectors(number: int) -> Floats:
        return nodes.vectors(*map(nodes.at, flow.turned(*flow.steps(number))))

    extra = {key: later(partial(value, scalar.read)) for key, scalar in scalars.items()}
    if nodes.projection is not None and not nodes.projection.is_globe:
        extra["speed"] = later(lambda number: np.hypot(*map(nodes.at, flow.steps(number))))
        words["units"]["speed"] = "m/s"
    if spread is not None:
        extra[spread_name(uncertainty)] = later(partial(value, spread))
    velocity = later(vectors)
    make: Any = GridArrays if flow.mesh is None else TriangleArrays
    arrays: GridArrays | TriangleArrays = make(
        points=nodes.points,
        velocity=velocity if len(numbers) > 1 else velocity[0],
        times=times,
        scalars=extra,
        time_unit="s",
        projection=nodes.projection,
        **arguments,
        **words,
    )
    return arrays


def _averaged(
    flow: Recognised,
    datasets: Datasets,
    dim: str,
    sel: Mapping[str, Any],
    isel: Mapping[str, Any] | None,
) -> tuple[Recognised, Callable[[int], Floats], Datasets]:
    """Return the mean over a dimension, a reader of the spread, and the datasets without it."""
    pair, chosen = flow.pair, {**sel, **(isel or {})}
    if dim in horizontal_dims(pair.u) or dim not in {*pair.u.dims} & {*pair.v.dims}:
        names = [str(d) for d in pair.u.dims if d not in horizontal_dims(pair.u)]
        msg = f"uncertainty is {dim!r}, which is not a further axis of the data; "
        raise FieldError(msg + near_names(dim, names))
    if dim in chosen:
        msg = (
            f"{dim} is {chosen[dim]!r}, but uncertainty is the spread over {dim}; omit one of them"
        )
        raise FieldError(msg)
    count = pair.u.sizes[dim]
    members = [
        recognise(
            datasets,
            str(pair.u.name),
            str(pair.v.name),
            sel=sel,
            isel={**(isel or {}), dim: number},
        )
        for number in range(count)
    ]
    mean, spread = mean_and_spread([member.steps for member in members])
    first = members[0]
    if axis_kind(pair.u, dim) == TIME:
        first = replace(first, u=replace(first.u, times=None), v=replace(first.v, times=None))
    # Other variables of the members are not averaged.
    others = [
        ds.drop_vars([n for n, a in ds.data_vars.items() if dim in a.dims]) for ds in datasets
    ]
    return replace(first, steps=mean), spread, Datasets(others)


def _on_grid(flow: Recognised, projection: str | None) -> tuple[Nodes, dict[str, Any]]:
    """Return drawn nodes of rows and columns, and further arguments of a field."""
    places = flow.places
    if places.is_earth:
        nodes = on_map(places, projection)
        return nodes, {"length_unit": "m", "periodic": nodes.periodic}
    return PlaneNodes(np.stack([places.a, places.b], axis=-1)), {"length_unit": places.unit}


def _on_mesh_nodes(
    flow: Recognised, mesh: Mesh, projection: str | None
) -> tuple[Nodes, dict[str, Any]]:
    """Return drawn nodes of a mesh, and further arguments of a field."""
    if not mesh.is_earth:
        arguments = {"length_unit": flow.places.unit or "m", "triangles": mesh.triangles}
        return PlaneNodes(mesh.positions), arguments
    nodes = mesh_on_map(mesh, flow.places, projection)
    if nodes.lost:
        notify(
            f"{nodes.lost:,} triangles are left out, because the map cuts them, as at a pole; "
            "draw a globe to see all of them: globe=True"
        )
    return nodes, {"length_unit": "m", "triangles": nodes.triangles}


def _regions(
    flow: Recognised,
    scalars: Mapping[str, _Scalar],
    times: AnyArray | None,
    numbers: list[int],
    projection: str | None,
    words: dict[str, Any],
) -> Regions | None:
    """Return a dataset for reading by regions; ``None`` where it must be read as a whole."""
    lines = None if flow.staggered else region_lines(flow.places, projection)
    if lines is None or min(lines.shape) < 2:
        return None
    on_earth = lines.projection is not None
    seconds, _, start = as_seconds(times, "s" if times is None else "")
    others = {key: scalar.section.array.variable for key, scalar in scalars.items()}
    if lines.projection is not None and not lines.projection.is_globe:
        others.pop("speed", None)
        words["units"]["speed"] = "m/s"
    return Regions(
        Words(
            length_unit="m" if on_earth else flow.places.unit,
            times=np.zeros(1) if seconds is None else np.asarray(seconds, dtype=float),
            start=start,
            **words,
        ),
        lines,
        (flow.u.array.variable, flow.v.array.variable),
        flow.factor,
        None if flow.mask is None else flow.mask.variable,
        others,
        tuple(numbers),
    )


def _scalar_texts(scalars: Mapping[str, _Scalar]) -> dict[str, Any]:
    """Return units, and long names that are short enough, of variables."""
    attributes = {key: scalar.attributes for key, scalar in scalars.items()}
    words = {
        ours: {key: str(a[theirs]) for key, a in attributes.items() if a.get(theirs)}
        for ours, theirs in (("units", "units"), ("long_names", "long_name"))
    }
    long_names = words["long_names"].items()
    words["long_names"] = {key: text for key, text in long_names if len(text) <= LONGEST_NAME}
    return words


def recognise(
    data: xr.Dataset | xr.DataTree | Sequence[xr.Dataset],
    u: str | None = None,
    v: str | None = None,
    *,
    sel: Mapping[str, Any] | None = None,
    isel: Mapping[str, Any] | None = None,
) -> Recognised:
    """Find the velocity of a dataset, its grid and its places; a FieldError has the remedy."""
    datasets = as_datasets(data)
    pair = choose_pair(datasets, u, v)
    factors = [to_metres_per_second(array) for array in (pair.u, pair.v)]
    if len(set(factors)) > 1:
        units = " and ".join(repr(str(a.attrs.get("units", ""))) for a in (pair.u, pair.v))
        msg = (
            f"the units of {pair.u.name!r} and {pair.v.name!r} are {units}; expected the same unit"
        )
        raise FieldError(msg)
    factor = factors[0] if factors[0] is not None else 1.0
    choice = Choice(dict(sel or {}), dict(isel or {}))
    check_faces(pair.u, pair.v, {**choice.sel, **choice.isel})
    one, two = sections([pair.u, pair.v], choice)
    surface = horizontal_dims(pair.u), horizontal_dims(pair.v)
    notes = list(one.notes)
    if factors[0] is None:
        notes.append(f"{pair.u.name} and {pair.v.name} have no unit; m/s is assumed")
    mesh = find_mesh(datasets)
    if mesh is not None and len(surface[0]) == 1:
        return _on_mesh(mesh, pair, (one, two), factor, notes, datasets, choice)
    rows, columns = zip(*surface, strict=True)
    sides, places, words = find_grid(pair, (rows[0], columns[1]), (rows, columns), datasets)
    kept = (
        sides[0].known if sides[0] else slice(None),
        sides[1].known if sides[1] else slice(None),
    )
    mask = sea_mask(places.a.shape, datasets)
    places = replace(places, a=places.a[kept], b=places.b[kept])
    mask = None if mask is None else mask[kept]

    @cache
    def wet() -> Bools:
        return np.asarray(np.asarray(mask) > 0)

    trimmed = unrepeated(places)
    places = replace(places, a=places.a[trimmed], b=places.b[trimmed])
    staggered = sides[0] is not None or sides[1] is not None
    # Components on the sides of cells are across these, whatever a long name says.
    by_words = "standard_name" not in pair.u.attrs
    land: list[Bools] = []

    def steps(number: int) -> tuple[Floats, Floats]:
        parts = []
        for section, side, axis in ((one, sides[1], 1), (two, sides[0], 0)):
            values = numbers_in(section.step(number)) * factor
            other = sides[0] if axis == 1 else sides[1]
            if side is not None:
                values = centred(values, axis, side)
            if other is not None:
                values = values[
                    (other.known, slice(None)) if axis == 1 else (slice(None), other.known)
                ]
            parts.append(values)
        a, b = parts
        if staggered:  # near a wall only one of them may be known
            missing = np.isnan(a) & np.isnan(b)
            a, b = (np.where(missing, np.nan, np.nan_to_num(p)) for p in (a, b))
            if not land:
                still = (a == 0) & (b == 0)
                land.append(still if still.mean() > LAND_SHARE else np.zeros_like(still))
            a, b = (np.where(land[0], np.nan, p) for p in (a, b))
        if mask is not None:
            a, b = (np.where(wet(), p, np.nan) for p in (a, b))
        return a[trimmed], b[trimmed]

    return Recognised(
        pair=pair,
        along="earth" if pair.along == "earth" and not (staggered and by_words) else "grid",
        ahead=(axis_direction(pair.u, rows[0]), axis_direction(pair.v, columns[1])),
        staggered=staggered,
        grid=f"{words}, {'rows and columns' if places.is_line else 'curvilinear'}",
        coordinates=places.why,
        places=places,
        notes=tuple(notes),
        u=one,
        v=two,
        steps=lru_cache(MOST_READ)(steps),
        cells=(rows[0], columns[1]),
        factor=factor,
        mask=mask,
        kept=kept,
        trimmed=trimmed,
    )


def _on_mesh(
    mesh: Mesh,
    pair: Pair,
    sections: tuple[Section, Section],
    factor: float,
    notes: list[str],
    datasets: Sequence[xr.Dataset],
    choice: Choice,
) -> Recognised:
    """Recognise a velocity at the nodes or in the faces of a mesh."""
    dims = {horizontal_dims(array) for array in (pair.u, pair.v)}
    if len(dims) > 1:
        msg = (
            f"{pair.u.name!r} has {', '.join(map(str, pair.u.dims))} and {pair.v.name!r} "
            f"{', '.join(map(str, pair.v.dims))}; expected both at nodes, or both in faces"
        )
        raise FieldError(msg)
    one, two = sections
    ((dim,),) = dims
    wet = wet_at(one, dim, datasets, choice)

    def steps(number: int) -> tuple[Floats, Floats]:
        u, v = (numbers_in(section.step(number)) * factor for section in sections)
        present = np.isfinite(u) & np.isfinite(v)
        if wet is not None:
            present &= wet(number)
        u, v = (np.where(present, part, np.nan) for part in (u, v))
        return mesh.vectors_at_nodes(u, v, dim)

    places = Places(
        mesh.a[None],
        mesh.b[None],
        is_earth=mesh.is_earth,
        is_line=False,
        why=mesh.coordinates,
        unit=mesh.unit,
    )
    return Recognised(
        pair=pair,
        along="earth" if mesh.is_earth else "plane",
        grid=f"{mesh.words}; velocity {'at nodes' if dim == NODES else 'in faces'}",
        coordinates=mesh.coordinates,
        places=places,
        notes=tuple(notes),
        u=one,
        v=two,
        steps=lru_cache(MOST_READ)(steps),
        cells=(dim,),
        factor=factor,
        mesh=mesh,
    )


class _Scalar(NamedTuple):
    """A variable that lies at the nodes, the reader of its steps, and its attributes."""

    section: Section
    read: Callable[[int], Floats]
    attributes: Mapping[str, Any]


def _scalars(
    flow: Recognised, datasets: Sequence[xr.Dataset], choice: Choice
) -> dict[str, _Scalar]:
    """Return the other variables that lie at the nodes, by name."""
    scalars: dict[str, _Scalar] = {}
    used = (flow.pair.u.name, flow.pair.v.name)
    steps = flow.u.array.shape[0] if flow.u.is_series else 1
    # Dimensions of the same name do not distinguish the sides of cells from their centres.
    on_sides = flow.staggered and set(flow.pair.u.dims) & set(flow.pair.v.dims) >= {*flow.cells}
    # Variables without the chosen level may still have values.
    choice.used.update(choice.sel, choice.isel)
    for ds in datasets:
        has_velocity = any(name in ds for name in used)
        if on_sides and has_velocity:
            continue
        is_mesh_file = flow.mesh is not None and flow.mesh.names[0] in ds and not has_velocity
        for name, array in ds.data_vars.items():
            surface = _surface(flow, array)
            numbers = array.dtype.kind in "fiu" and not OF_GRIDS.match(str(name))
            of_mesh = is_mesh_file and array.ndim == 1  # such as areas
            if name not in (*used, *scalars) and surface and numbers and not of_mesh:
                scalar = _scalar(flow, array.transpose(..., *surface), steps, choice)
                if scalar is not None:
                    scalars[str(name)] = scalar
    return scalars


def _surface(flow: Recognised, array: xr.DataArray) -> tuple[str, ...]:
    """Return the dimensions in which a variable lies at the nodes; empty where it does not."""
    if flow.mesh is None:
        at_nodes = {*flow.cells} <= set(array.dims) and array.ndim <= flow.pair.u.ndim
        return flow.cells if at_nodes else ()
    dims = horizontal_dims(array) if {NODES, FACES} & set(array.dims) else ()
    others = {str(d) for d in array.dims} - set(dims)
    plain = all(d in flow.pair.u.dims or axis_kind(array, d) in (TIME, LEVEL) for d in others)
    return dims if plain and str(array.name) not in (*flow.mesh.names, *WET) else ()


def _scalar(flow: Recognised, array: xr.DataArray, steps: int, choice: Choice) -> _Scalar | None:
    """Return a variable for reading; ``None`` where it lacks the steps or the choice."""
    try:
        (section,) = sections([array], choice)
    except FieldError:
        return None
    if section.is_series and section.array.shape[0] != steps:
        return None

    def at_nodes(number: int) -> Floats:
        values = numbers_in(section.step(number))
        if flow.mesh is None:
            return np.asarray(values[flow.kept][flow.trimmed])
        return flow.mesh.at_nodes(values, horizontal_dims(array)[0])

    return _Scalar(section, at_nodes, array.attrs)


def recognised(data: Any) -> dict[str, str]:
    """Return the velocity, grid and coordinates that are recognised, with reasons, and the axes."""
    datasets = as_datasets(data)
    pairs = find_pairs(datasets)
    flow = recognise(datasets, *((pairs[0].u.name, pairs[0].v.name) if pairs else ()))
    rows = {"velocity": str(flow.pair)}
    if others := [pair for pair in pairs if pair.u.name != flow.pair.u.name]:
        rows["also"] = "; ".join(map(str, others))
    rows |= {"directions": DIRECTIONS[flow.along], "grid": flow.grid}
    rows["coordinates"] = flow.coordinates
    for name, words in axis_values(flow.pair.u).items():
        listed = ", ".join(words[:MOST_VALUES]) + (", ..." if len(words) > MOST_VALUES else "")
        rows[name] = f"{len(words)}: {listed}"
    return rows
