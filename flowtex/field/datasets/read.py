"""From xarray's datasets to fields: the pair, its axes, its places, and the steps of time.

Nothing but coordinates and one step is read here; other steps are read when they are drawn.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flowtex._util.arguments import near_names
from flowtex._util.array_types import Bools, Floats
from flowtex.errors import FieldError
from flowtex.field.datasets.axes import (
    FACES,
    LEVEL,
    NODES,
    TIME,
    WET,
    Choice,
    Section,
    axis_kind,
    axis_values,
    drawn_steps,
    horizontal_dims,
    sections,
    way_ahead,
    wet_at,
)
from flowtex.field.datasets.ensembles import mean_and_spread, spread_name
from flowtex.field.datasets.grids import centred, find_grid, sea_mask, unrepeated
from flowtex.field.datasets.maps import Nodes, PlaneNodes, on_map
from flowtex.field.datasets.meshes.conventions import find_mesh
from flowtex.field.datasets.meshes.maps import mesh_on_map
from flowtex.field.datasets.meshes.mesh import Mesh
from flowtex.field.datasets.notices import notify
from flowtex.field.datasets.pairs import (
    Pair,
    choose_pair,
    find_pairs,
    to_metres_per_second,
    variable,
)
from flowtex.field.datasets.places import LATITUDE, LONGITUDE, Places
from flowtex.field.datasets.regions import Regions, Words, numbers_in, region_lines
from flowtex.field.datasets.series import Datasets, as_datasets
from flowtex.field.datasets.vertical import is_vertical, read_section
from flowtex.field.dates import as_seconds
from flowtex.field.earth import GLOBE
from flowtex.field.io.arrays import GridArrays, TriangleArrays
from flowtex.field.steps import LazySteps

if TYPE_CHECKING:
    import xarray as xr

#: Longest name that a legend has room for, and values of an axis that are listed at most.
LONGEST_NAME, MOST_VALUES = 40, 8
#: What the components of a pair go along, in words.
DIRECTIONS = {"earth": "eastward and northward", "grid": "along the grid", "plane": "along x and y"}

#: Variables that belong to the grid itself: places, sizes of cells, masks.
OF_GRIDS = re.compile(
    rf"{LONGITUDE.pattern}|{LATITUDE.pattern}|^(e[12][tuvf]|d[xy][tuvcg]?|[tuvf]?mask\w*|[xy]c?)$",
    re.I,
)

#: Steps whose components are kept, for velocity and speed are made of the same.
MOST_READ = 4

#: Share of the nodes of a staggered grid at rest from which on they count as land.
LAND_SHARE = 0.01


@dataclass(frozen=True, eq=False)
class Recognised:
    """What was recognised in a dataset, and why."""

    pair: Pair  #: The two variables of the velocity.
    along: str  #: ``"earth"``, or ``"grid"`` for the directions of rows and columns.
    grid: str  #: The kind of grid, as text.
    coordinates: str  #: Names of the coordinates, as text.
    places: Places  #: Nodes in the middle of cells.
    notes: tuple[str, ...]  #: What was chosen automatically.
    u: Section
    v: Section
    steps: Callable[[int], tuple[Floats, Floats]]
    cells: tuple[str, ...]
    factor: float  #: Makes components m/s.
    ahead: tuple[int, int] = (1, 1)  #: Directions of rows and columns, 1 or -1.
    staggered: bool = False  #: Whether components lie on the sides of cells.
    mask: Any = None  #: A variable that is positive where there is data.
    kept: tuple[slice, ...] = ()
    trimmed: tuple[slice, ...] = ()
    mesh: Mesh | None = None

    def turned(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return components eastward and northward, or along x and y."""
        if self.along != "grid" or self.places.is_line:
            return u, v
        return self.places.turned(self.ahead, u, v)


def read_datasets(
    data: xr.Dataset | xr.DataTree | Sequence[xr.Dataset],
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
    """Read what a field needs; with ``regions`` no nodes, if any part can be read by itself.

    Where the uncertainty is a dimension, the mean over it is read, and the spread as a scalar.
    """
    if globe and projection not in (None, GLOBE):
        msg = f"globe=True and projection={projection!r} are given; omit one of them"
        raise FieldError(msg)
    projection = GLOBE if globe else projection
    sel = {**(sel or {}), **selection}
    datasets = as_datasets(data)
    if u is not None and v is not None and is_vertical(variable(datasets, v)):
        return read_section(datasets, u, v, name=name, sel=sel, isel=isel or {})
    known, spread = recognise(datasets, u, v, sel=sel, isel=isel), None
    if isinstance(uncertainty, str) and any(uncertainty in ds.dims for ds in datasets):
        known, spread, datasets = _averaged(known, datasets, uncertainty, sel, isel)
        name = ", ".join(filter(None, (name, f"mean over {uncertainty}")))
    for note in known.notes:
        notify(note)
    places = known.places
    if not places.is_earth and projection is not None:
        msg = (
            f"projection is {projection!r}, but the positions are {known.coordinates}, not "
            "longitude and latitude; omit projection"
        )
        raise FieldError(msg)
    times, numbers = drawn_steps(known.u, known.pair.u)
    scalars = _scalars(known, datasets, Choice(dict(sel), dict(isel or {})))
    words: dict[str, Any] = {
        "name": ", ".join(filter(None, (name, known.u.level))),
        **_words(scalars),
    }
    if regions and known.mesh is None and spread is None:
        found = _regions(known, scalars, times, numbers, projection, words)
        if found is not None:
            return found
    nodes, more = (
        _on_grid(known, projection)
        if known.mesh is None
        else _on_mesh_nodes(known, known.mesh, projection)
    )

    def later(read: Callable[[int], Floats]) -> LazySteps:
        return LazySteps(len(numbers), lambda step: read(numbers[step]))

    def value(read: Callable[[int], Floats], number: int) -> Floats:
        return nodes.at(read(number))

    def vectors(number: int) -> Floats:
        return nodes.vectors(*map(nodes.at, known.turned(*known.steps(number))))

    extra = {key: later(partial(value, scalar.read)) for key, scalar in scalars.items()}
    if nodes.projection is not None and not nodes.projection.is_globe:
        extra["speed"] = later(lambda number: np.hypot(*map(nodes.at, known.steps(number))))
        words["units"]["speed"] = "m/s"
    if spread is not None:
        extra[spread_name(uncertainty)] = later(partial(value, spread))
    moving = later(vectors)
    make: Any = GridArrays if known.mesh is None else TriangleArrays
    arrays: GridArrays | TriangleArrays = make(
        points=nodes.points,
        velocity=moving if len(numbers) > 1 else moving[0],
        times=times,
        scalars=extra,
        time_unit="s",
        projection=nodes.projection,
        **more,
        **words,
    )
    return arrays


def _averaged(
    known: Recognised,
    datasets: Datasets,
    dim: str,
    sel: Mapping[str, Any],
    isel: Mapping[str, Any] | None,
) -> tuple[Recognised, Callable[[int], Floats], Datasets]:
    """Return the mean over a dimension, what reads the spread, and the datasets without it."""
    pair, chosen = known.pair, {**sel, **(isel or {})}
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
    # What else the members have is not averaged.
    others = [
        ds.drop_vars([n for n, a in ds.data_vars.items() if dim in a.dims]) for ds in datasets
    ]
    return replace(first, steps=mean), spread, Datasets(others)


def _on_grid(known: Recognised, projection: str | None) -> tuple[Nodes, dict[str, Any]]:
    """Return where the nodes of rows and columns are drawn, and further arguments of a field."""
    places = known.places
    if places.is_earth:
        nodes = on_map(places, projection)
        return nodes, {"length_unit": "m", "periodic": nodes.periodic}
    return PlaneNodes(np.stack([places.a, places.b], axis=-1)), {"length_unit": places.unit}


def _on_mesh_nodes(
    known: Recognised, mesh: Mesh, projection: str | None
) -> tuple[Nodes, dict[str, Any]]:
    """Return the same of a mesh."""
    if not mesh.is_earth:
        more = {"length_unit": known.places.unit or "m", "triangles": mesh.triangles}
        return PlaneNodes(mesh.positions), more
    nodes = mesh_on_map(mesh, known.places, projection)
    if nodes.lost:
        notify(
            f"{nodes.lost:,} triangles are left out, because the map cuts them, as at a pole; "
            "draw a globe to see all of them: globe=True"
        )
    return nodes, {"length_unit": "m", "triangles": nodes.triangles}


def _regions(
    known: Recognised,
    scalars: Mapping[str, _Scalar],
    times: Any,
    numbers: list[int],
    projection: str | None,
    words: dict[str, Any],
) -> Regions | None:
    """Return what reads a dataset by regions; ``None`` where it has to be read as a whole."""
    lines = None if known.staggered else region_lines(known.places, projection)
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
            length_unit="m" if on_earth else known.places.unit,
            times=np.zeros(1) if seconds is None else np.asarray(seconds, dtype=float),
            start=start,
            **words,
        ),
        lines,
        (known.u.array.variable, known.v.array.variable),
        known.factor,
        None if known.mask is None else known.mask.variable,
        others,
        tuple(numbers),
    )


def _words(scalars: Mapping[str, _Scalar]) -> dict[str, Any]:
    """Return units, and long names for which there is room, of variables."""
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
    # Sides of cells have components across them, whatever a long name calls these.
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
        if staggered:  # near a wall one of them may be known alone
            nowhere = np.isnan(a) & np.isnan(b)
            a, b = (np.where(nowhere, np.nan, np.nan_to_num(p)) for p in (a, b))
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
        ahead=(way_ahead(pair.u, rows[0]), way_ahead(pair.v, columns[1])),
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
    datasets: Sequence[Any],
    choice: Choice,
) -> Recognised:
    """Return what is known of a velocity at the nodes or in the faces of a mesh."""
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
        there = np.isfinite(u) & np.isfinite(v)
        if wet is not None:
            there &= wet(number)
        u, v = (np.where(there, part, np.nan) for part in (u, v))
        return mesh.vectors_at_nodes(u, v, dim)

    places = Places(
        mesh.a[None],
        mesh.b[None],
        is_earth=mesh.is_earth,
        is_line=False,
        why=mesh.coordinates,
        unit="" if mesh.is_earth else "m",
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
    """A variable that lies at the nodes, what reads a step of it, and its attributes."""

    section: Section
    read: Callable[[int], Floats]
    attributes: Mapping[str, Any]


def _scalars(known: Recognised, datasets: Sequence[Any], choice: Choice) -> dict[str, _Scalar]:
    """Return the other variables that lie at the nodes, by name."""
    found: dict[str, _Scalar] = {}
    used = (known.pair.u.name, known.pair.v.name)
    steps = known.u.array.shape[0] if known.u.is_series else 1
    # Dimensions of the same name do not distinguish the sides of cells from their centres.
    aside = known.staggered and set(known.pair.u.dims) & set(known.pair.v.dims) >= {*known.cells}
    # What a velocity has no level for may still have a value.
    choice.used.update(choice.sel, choice.isel)
    for ds in datasets:
        has_velocity = any(name in ds for name in used)
        if aside and has_velocity:
            continue
        alone = known.mesh is not None and known.mesh.names[0] in ds and not has_velocity
        for name, array in ds.data_vars.items():
            surface = _surface(known, array)
            numbers = array.dtype.kind in "fiu" and not OF_GRIDS.match(str(name))
            of_mesh = alone and array.ndim == 1  # such as areas
            if name not in (*used, *found) and surface and numbers and not of_mesh:
                scalar = _scalar(known, array.transpose(..., *surface), steps, choice)
                if scalar is not None:
                    found[str(name)] = scalar
    return found


def _surface(known: Recognised, array: Any) -> tuple[str, ...]:
    """Return the dimensions in which a variable lies at the nodes, or nothing where it does not."""
    if known.mesh is None:
        at_nodes = {*known.cells} <= set(array.dims) and array.ndim <= known.pair.u.ndim
        return known.cells if at_nodes else ()
    dims = horizontal_dims(array) if {NODES, FACES} & set(array.dims) else ()
    others = {str(d) for d in array.dims} - set(dims)
    plain = all(d in known.pair.u.dims or axis_kind(array, d) in (TIME, LEVEL) for d in others)
    return dims if plain and str(array.name) not in (*known.mesh.names, *WET) else ()


def _scalar(known: Recognised, array: Any, steps: int, choice: Choice) -> _Scalar | None:
    """Return a variable as it is read; ``None`` where it has no such steps or choice."""
    try:
        (section,) = sections([array], choice)
    except FieldError:
        return None
    if section.is_series and section.array.shape[0] != steps:
        return None

    def at_nodes(number: int) -> Floats:
        values = numbers_in(section.step(number))
        if known.mesh is None:
            return np.asarray(values[known.kept][known.trimmed])
        return known.mesh.at_nodes(values, horizontal_dims(array)[0])

    return _Scalar(section, at_nodes, array.attrs)


def recognised(data: Any) -> dict[str, str]:
    """Return the velocity, grid and coordinates that are recognised, with reasons, and the axes."""
    datasets = as_datasets(data)
    pairs = find_pairs(datasets)
    known = recognise(datasets, *((pairs[0].u.name, pairs[0].v.name) if pairs else ()))
    rows = {"velocity": str(known.pair)}
    if others := [pair for pair in pairs if pair.u.name != known.pair.u.name]:
        rows["also"] = "; ".join(map(str, others))
    rows |= {"directions": DIRECTIONS[known.along], "grid": known.grid}
    rows["coordinates"] = known.coordinates
    for name, words in axis_values(known.pair.u).items():
        few = ", ".join(words[:MOST_VALUES]) + (", ..." if len(words) > MOST_VALUES else "")
        rows[name] = f"{len(words)}: {few}"
    return rows
