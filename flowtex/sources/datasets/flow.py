"""The velocity of a dataset: which variables, how their values are read, and where they lie.

==========================================  =============================================
the data say                                the components are
==========================================  =============================================
``components=``                             as given
speed and direction                         eastward and northward
along a radius and an angle                 along x and y, by the angle
``GRIB_uvRelativeToGrid``                   along the grid if 1, else eastward and northward
standard or long names with *eastward*      eastward and northward
standard names ``x_wind``, ``grid_...``     along the grid
values on the sides of cells (Arakawa C)    along the grid
positions in a plane                        along x and y
unknown, rows and columns of the Earth      eastward and northward
unknown, meshes and points of the Earth     eastward and northward
unknown, a curvilinear grid of the Earth    along the grid, as WRF, ROMS, NEMO and POP have it
==========================================  =============================================
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex._util.arrays import is_nonzero
from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.field.options import FieldOptions
from flowtex.field.steps import typical_steps
from flowtex.remedies import Remedy
from flowtex.sources.datasets import directions, labels, select
from flowtex.sources.datasets.align import align
from flowtex.sources.datasets.axes import (
    LEVEL,
    NODES,
    TIME,
    Choice,
    Drawn,
    axis_direction,
    axis_kind,
    choose,
    coordinate_of,
    horizontal_dims,
)
from flowtex.sources.datasets.coordinates import LATITUDE, LONGITUDE, Beside, Places, ordered
from flowtex.sources.datasets.curved import with_lonlat
from flowtex.sources.datasets.masks import DRAW_ALL, Mask, find_masks, is_constant, moves_over_land
from flowtex.sources.datasets.select import Pair
from flowtex.sources.datasets.staggered import find_grid, lies_in, unrepeated
from flowtex.sources.datasets.values import (
    Component,
    FillWords,
    Values,
    checked_component,
    examined,
    read_step,
    record_fills,
    steps_to_examine,
)
from flowtex.sources.datasets.vertical import is_vertical
from flowtex.sources.models.conventions import find_mesh
from flowtex.sources.models.globe_faces import join_faces
from flowtex.sources.models.model_mesh import POINTS, Mesh
from flowtex.sources.notices import Record
from flowtex.sources.opening.dataset_files import Datasets, as_datasets
from flowtex.sources.reader_errors import values_in

if TYPE_CHECKING:
    import xarray as xr

#: Values of ``components=``, in words.
DIRECTIONS = {"earth": "eastward and northward", "grid": "along the grid", "plane": "along x and y"}
#: Values of ``components=`` for components that are turned to those of the plane or the Earth.
CURVED = {
    "polar": "along a radius and an angle",
    "cylindrical": "along a radius and an angle",
    "spherical": "along colatitude and longitude, southward and eastward",
}

#: Coordinates of models whose components are along the grid: WRF, NEMO, ROMS, POP, MITgcm, MOM.
MODELS = re.compile(r"XLONG|nav_lon|lon_(rho|u|v|psi)\b|glam|[TU]_?LONG?|XC|XG|geolon")
#: The other directions of components that are taken along the grid.
EASTWARD = Remedy("components", "earth", "if they are eastward and northward,")
ALONG = Remedy("components", "grid", "if they are along the grid,")
#: Grids of GRIB whose rows are turned against parallels.
OF_MAPS = re.compile(r"lambert|polar_stereographic|rotated|albers|transverse")
#: The reason where neither names nor positions tell.
UNKNOWN = "a curvilinear grid, and no name that tells"
#: Sine of the angle between rows and parallels from which on the directions matter.
NOTABLE_TURN = 0.02
#: Share of nodes at rest from which on resting nodes of a staggered grid count as land.
LAND_SHARE = 0.01
#: Share of the moving nodes up to which a mask leaves none.
MOST_LEFT = 0.02


class Orientation(NamedTuple):
    """Directions of the components: a key of :data:`DIRECTIONS`, and the reason."""

    along: str
    why: str

    def __str__(self) -> str:
        return f"{DIRECTIONS[self.along]} ({self.why})"


def component_units(pair: Pair, record: Record) -> tuple[str, tuple[float, float]]:
    """Return the unit of a velocity, and the factors of its variables to it.

    The unit is empty where neither has one. A direction has the factor to radians.

    Raises
    ------
    FieldError
        When the units of the components cannot be converted to each other, or are no units of
        velocity.
    """
    given = _unit_of(pair, pair.u)
    number, one = units.without_number(given)
    if number != 1.0:
        record("units", f"{pair.u.name} converted from {given} to {one}")
    if pair.kind in directions.ANGULAR:
        return one, (number, _angle_factor(pair, record))
    other = _unit_of(pair, pair.v)
    if not one or not other:
        if one != other:
            if one:
                named = pair.u
                bare = pair.v
            else:
                named = pair.v
                bare = pair.u
            text = f"{bare.name} has no unit, and that of {named.name}, {one or other}, is assumed"
            record("units", text, units.unit_remedy("velocity_unit", one or other), notable=True)
        if not one:
            number, other = units.without_number(other)
        return one or other, (number, number)
    factor = units.factor(other, one)
    if factor is None:
        text = f"the units of {pair.u.name!r} and {pair.v.name!r} are {one!r} and {other!r}, which"
        raise FieldError(f"{text} cannot be converted to each other")
    if factor != 1.0:
        record("units", f"{pair.v.name} converted from {other} to {one}")
    return one, (number, factor)


def _unit_of(pair: Pair, array: xr.DataArray) -> str:
    """Return the unit of a component; that of a pair which the user names may be any."""
    try:
        return select.velocity_unit(array, any_kind=pair.named)
    except FieldError as error:
        u, v = pair.parts
        unit = str(array.attrs["units"])
        raise FieldError(
            f'{error}. Otherwise u="{u}", v="{v}" draws them as they are, in {unit}'
        ) from None


def _angle_factor(pair: Pair, record: Record) -> float:
    """Return the factor of angles to radians; without a unit, those within a turn are radians."""
    name = str(pair.v.attrs.get("units", ""))
    factor = units.factor(name, "radian")
    if factor is None:
        array = pair.v
        first = array.isel({d: 0 for d in array.dims if d not in horizontal_dims(array)})
        greatest = float(np.nanmax(np.abs(values_in(first)), initial=0.0))
        name = "degree"
        if greatest <= directions.MOST_RADIANS:
            name = "radian"
        factor = units.factor(name, "radian") or 1.0
    meaning = {
        directions.ANGLE: "counterclockwise from x",
        directions.FROM: "clockwise from north, where the flow comes from",
        directions.TOWARDS: "clockwise from north, where the flow goes to",
    }
    record("units", f"{pair.v.name} is in {name}, {meaning[pair.kind]}")
    return factor


def orientation(flow: Flow, wanted: str | None) -> Orientation:
    """Return the directions of components by the rules of this module.

    Raises
    ------
    FieldError
        When ``wanted`` is no known direction, or does not fit the positions.
    """
    known = {**DIRECTIONS, **CURVED, **directions.MEANINGS}
    if wanted is not None and wanted not in known:
        expected = ", ".join(f"{key!r} ({words})" for key, words in known.items())
        raise FieldError(f"components is {wanted!r}; expected {expected}")
    _check_curved(flow, wanted)
    if wanted is None or wanted in directions.BY_WORD:
        found = _orientation(flow)
    elif wanted in CURVED:
        along = "earth"
        if flow.pair.kind == directions.POLAR:
            along = "plane"
        found = Orientation(along, f"components={wanted!r}: {CURVED[wanted]}")
    else:
        found = Orientation(wanted, f"components={wanted!r}")
    if not flow.places.is_earth and found.along == "earth":
        found = Orientation("plane", "positions in a plane")
    if flow.places.is_earth and found.along == "plane":
        text = "components is 'plane', but the positions are longitude and latitude"
        raise FieldError(f"{text}; expected 'earth' or 'grid'")
    flow.record("components", str(found))
    return found


def _check_curved(flow: Flow, wanted: str | None) -> None:
    """Raise a FieldError for polar components on the Earth, and for spherical ones in a plane."""
    is_earth = flow.places.is_earth
    where = flow.places.why
    names = " and ".join(flow.pair.parts)
    reason = flow.pair.why
    if wanted is not None:
        reason = f"components is {wanted!r}"
    if flow.pair.kind == directions.POLAR and is_earth:
        raise FieldError(
            f"{names} are along a radius and an angle ({reason}), but the positions are {where}; "
            "expected positions in a plane, or components='earth', 'grid' or 'spherical'"
        )
    if flow.pair.kind == directions.SPHERICAL and not is_earth:
        raise FieldError(
            f"{names} are along colatitude and longitude ({reason}), but the positions are "
            f"{where}; expected the axes theta and phi, or longitude and latitude"
        )


def _orientation(flow: Flow) -> Orientation:
    pair = flow.pair
    places = flow.places
    if pair.kind != directions.CARTESIAN:
        return Orientation("plane" if pair.kind == directions.POLAR else "earth", pair.why)
    if len(places.a) == 1 and places.is_earth:
        return Orientation("earth", "nodes without rows and columns")
    # Components on the sides of cells are across these, whatever a long name says.
    by_words = "standard_name" not in pair.u.attrs
    if flow.staggered and (by_words or pair.along != "earth"):
        return Orientation("grid", "values on the sides of cells")
    if not places.is_earth:
        named = "grid" in str(pair.u.attrs.get("standard_name", pair.u.name)).split("_")
        return Orientation("grid" if named else "plane", "positions in a plane")
    if pair.along:
        return Orientation(pair.along, "by the names of the variables")
    if places.is_line:
        return Orientation("earth", "rows and columns of the Earth")
    if MODELS.match(places.why):
        return Orientation("grid", "as models with these coordinates have it")
    return Orientation("grid", UNKNOWN)


@dataclass(frozen=True, eq=False)
class Flow:
    """A velocity of a dataset: how its values are read, and where they lie."""

    pair: Pair  #: The two variables, with the axes that are drawn: ([time], ...).
    drawn: Drawn
    grid: str  #: The kind of grid, as text.
    places: Places  #: Nodes in the middle of cells.
    values: Values
    cells: tuple[str, ...]  #: Dimensions of the nodes.
    datasets: Datasets
    record: Record
    unit: str = ""  #: Unit of the components; empty where unknown.
    orientation: Orientation = Orientation("earth", "")  # noqa: RUF009
    ahead: tuple[int, int] = (1, 1)  #: Directions of rows and columns, 1 or -1.
    trimmed: tuple[slice, ...] = ()  #: Rows and columns that repeat no others.
    mesh: Mesh | None = None
    staggered: bool = False
    mean: Callable[[int], Floats] | None = None  #: Of the members of an ensemble.
    members: tuple[Flow, ...] = ()  #: The members of an ensemble, if this is their mean.
    member_dim: str = ""  #: Dimension of the members.

    @property
    def name(self) -> str:
        """Name of the vectors: both components, or what these have in common."""
        names = self.pair.parts
        shared = os.path.commonprefix(names).rstrip("_")  # noqa: RUF071
        if self.is_velocity or not shared:
            return ", ".join(names)
        return shared

    @property
    def is_velocity(self) -> bool:
        """Whether the unit is one of velocity, or unknown; other vectors are drawn if named."""
        return not self.unit or units.measures(self.unit, units.VELOCITIES)

    def components(self, step: int) -> Floats:
        """Return the components eastward and northward, or along x and y, (2, ...)."""
        if self.mean is not None:
            return self.mean(step)
        u, v = self.values.read(step)
        self.datasets.close()
        if self.mesh is not None:
            return np.stack(self.mesh.vectors_at_nodes(u, v, self.cells[0]))
        u = u[self.trimmed]
        v = v[self.trimmed]
        if self.orientation.along == "grid" and not self.places.is_line:
            u, v = self.places.turned(self.ahead, u, v)
        return np.stack([u, v])

    def at_nodes(self, values: Floats) -> Floats:
        """Return values of another variable, in the middle of all cells, at the nodes.

        Those at the nodes or in the faces of a mesh stay there.
        """
        if self.mesh is not None:
            return values
        return np.asarray(self.values.at_cells(values)[self.trimmed])

    def beside(self, array: xr.DataArray) -> xr.DataArray | None:
        """Return the drawn part of another variable at the nodes; ``None`` where it lies elsewhere.

        Its labels decide; a variable without coordinates must have the dimensions of the nodes.
        """
        try:
            part = self.drawn.of(array)
        except FieldError:
            return None
        series = part.ndim > len(surface := horizontal_dims(part))
        if series and part.shape[0] != self.drawn.steps:
            return None
        if self.mesh is not None:
            if {NODES, *self.cells} & set(surface):
                return part
            return None
        if len(surface) < 2:
            return None
        at: list[Any] = []
        if self.places.is_earth:
            period = 360.0
        else:
            period = None
        for n, (dim, cell) in enumerate(zip(surface, self.cells, strict=True)):
            line = coordinate_of(part, dim)
            is_line = line is not None and line.dtype.kind in "fiu" and self.places.is_line
            if line is not None and is_line and not self.staggered:
                own = np.asarray(line.values, dtype=float)
                wanted = self.places.lines[1 - n]
                found = labels.match(wanted, own, period if n else None)
                if len(found.one) < len(wanted):
                    return None
                at.append(found.other)
            elif dim != cell and not self._lies_in_cells(part):
                return None
        if at:
            part = part.isel(dict(zip(surface, at, strict=False)))
        if part.shape[-2:] == self.shape:
            return part
        return None

    def _lies_in_cells(self, part: xr.DataArray) -> bool:
        """Return whether a variable lies in the middle of all cells of a staggered grid."""
        if not self.staggered or part.shape[-2:] != self.shape:
            return False
        rows = np.arange(self.shape[0])
        columns = np.arange(self.shape[1])
        if self.values.rows is not None:
            rows = self.values.rows.cells
        if self.values.columns is not None:
            columns = self.values.columns.cells
        beside = Beside(self.datasets, self.drawn, self.record)
        return lies_in(part, self.places, (np.ix_(rows, columns), self.trimmed), beside)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of all cells (J, I), before those without all sides are left out."""
        u = self.pair.u
        v = self.pair.v
        return u.sizes[horizontal_dims(u)[0]], v.sizes[horizontal_dims(v)[-1]]


def read_flow(data: Any, options: FieldOptions, record: Record) -> Flow:
    """Find the velocity of a dataset, its grid and its positions.

    Parameters
    ----------
    data
        A dataset, a list of datasets, or what :func:`as_datasets` makes into them.
    options
        Options of the field.
    record
        Record of what was chosen automatically.

    Raises
    ------
    FieldError
        When the data have no velocity or several, no positions, components that do not fit
        together, or lack what the options select.
    """
    choice = Choice.of(options)
    datasets = as_datasets(data, record, choice)
    choice.used |= datasets.used
    datasets, pair = _chosen(datasets, choice, options, record)
    _record_pair(pair, datasets, options, record)
    unit, factors = component_units(pair, record)
    one = pair.u
    two = pair.v
    mesh = _mesh_of(datasets, one, options.max_edge)
    if mesh is None:
        one = ordered(one, record, "coordinates")
        two = ordered(two, record, "align")
    else:
        _check_places_on_mesh(one, two)
    one, two = align(one, two, choice, record)
    drawn = choose(one, choice, record)
    one = drawn.of(one)
    two = drawn.of(two)
    if drawn.level:
        record("select", f"level: {drawn.level}", caption=drawn.level)
    pair = replace(pair, u=one, v=two)
    _check_surface(pair)
    if mesh is None:
        flow = _on_rows(pair, datasets, drawn, record)
    else:
        flow = _on_faces(mesh, pair, datasets, drawn, record)
    flow = _in_length_unit(flow, options.length_unit)
    found = orientation(flow, options.components)
    is_curved = flow.places.is_earth and not flow.places.is_line and mesh is None
    if found.along == "grid" and is_curved:
        flow = _right_handed(flow)
    if found.along == "earth" and _hides_flags(pair.u):
        text = (
            f"{pair.u.name} and {pair.v.name} are taken as eastward and northward, as cfgrib names "
        )
        record("components", f"{text}them, though GRIB's flags are not read", ALONG, notable=True)
    if found.why == UNKNOWN and _is_turned(flow):
        text = f"{pair.u.name} and {pair.v.name} are taken along the grid, which is turned against "
        record("components", f"{text}north", EASTWARD, notable=True)
    return _masked(replace(flow, unit=unit, orientation=found), factors, options.mask)


def _check_places_on_mesh(u: xr.DataArray, v: xr.DataArray) -> None:
    """Raise a FieldError for a component at nodes beside one in faces."""
    if horizontal_dims(u) != horizontal_dims(v):
        raise FieldError(
            f"{u.name!r} has {', '.join(map(str, u.dims))} and {v.name!r} "
            f"{', '.join(map(str, v.dims))}; expected both at nodes, or both in faces"
        )


def _note_directions(flow: Flow, found: Orientation) -> None:
    """Record directions that the data do not tell."""
    names = f"{flow.pair.u.name} and {flow.pair.v.name}"
    if found.along == "earth" and _hides_flags(flow.pair.u):
        text = (
            f"{names} are taken as eastward and northward, as cfgrib names them, though the flags "
        )
        flow.record("components", f"{text}of GRIB are unknown", ALONG, notable=True)
    if found.why == UNKNOWN and _is_turned(flow):
        text = f"{names} are taken along the grid, which is turned against north"
        flow.record("components", text, EASTWARD, notable=True)


def _hides_flags(array: xr.DataArray) -> bool:
    """Return whether a dataset of cfgrib has a grid of a map, and not whether vectors follow it."""
    kind = str(array.attrs.get("GRIB_gridType", ""))
    return OF_MAPS.search(kind) is not None and select.relative_to_grid(array) is None


def _in_length_unit(flow: Flow, unit: str | None) -> Flow:
    """Return a flow whose positions in a plane have the unit that the user names."""
    if unit is None or flow.places.is_earth:
        return flow
    return replace(flow, places=replace(flow.places, unit=unit))


def _record_pair(pair: Pair, datasets: Datasets, options: FieldOptions, record: Record) -> None:
    """Record the pair of components, and what else it may be."""
    if pair.guessed:
        record("select", f"velocity: {pair}", select.other_angle(pair), notable=True)
        return
    others: list[str] = []
    if options.vectors is None and options.direction is None:
        others = select.likely_others(datasets, pair)
    if not others:
        record("select", f"velocity: {pair}")
        return
    text = f"velocity: {pair}; other pairs: {'; '.join(others)}"
    record("select", text, Remedy("vectors", others[0]), notable=True)


def _chosen(
    datasets: Datasets, choice: Choice, options: FieldOptions, record: Record
) -> tuple[Datasets, Pair]:
    """Return the velocity, and the datasets in the form that its kind requires."""
    first, second = select.two_names(options.vectors)
    direction = options.direction
    if not isinstance(direction, str):
        direction = None
    pair = select.choose_pair(datasets, first, second, direction)
    chosen = {*choice.sel, *choice.isel}
    joined = join_faces(datasets, pair, chosen, options.components, record)
    if joined is not None:
        datasets = Datasets(joined, datasets.closers)
    pair = select.with_directions(pair, options.components)
    if pair.kind == directions.SPHERICAL:
        datasets = Datasets(map(with_lonlat, datasets), datasets.closers, recognised=True)
    one = select.variable(datasets, str(pair.u.name))
    two = select.variable(datasets, str(pair.v.name))
    pair = replace(pair, u=one, v=two)
    if options.velocity_unit is not None:
        pair = _in_unit(pair, options.velocity_unit)
    return datasets, pair


def _in_unit(pair: Pair, unit: str) -> Pair:
    """Return a pair whose components, or whose speed, have the unit that the user names."""
    if units.parsed(unit) is None:
        raise FieldError(f"velocity_unit is {unit!r}; expected a unit such as m/s, cm/s or knots")
    one = pair.u.assign_attrs(units=unit)
    if pair.kind in directions.ANGULAR:
        return replace(pair, u=one)
    return replace(pair, u=one, v=pair.v.assign_attrs(units=unit))


def _mesh_of(datasets: Datasets, one: xr.DataArray, max_edge: float | str | None) -> Mesh | None:
    """Return the mesh of a variable, of points with edges that are no longer; ``None`` for rows."""
    mesh = find_mesh(datasets)
    if mesh is not None and len(horizontal_dims(one)) > 1:
        mesh = None
    if max_edge is None:
        return mesh
    if mesh is not None and mesh.kind == POINTS:
        return replace(mesh, max_edge=max_edge)
    kind = "rows and columns of a grid"
    if mesh is not None:
        kind = f"a mesh ({mesh.kind})"
    raise FieldError(f"max_edge applies to scattered points, but these are {kind}; omit it")


def _check_surface(pair: Pair) -> None:
    """Raise for components that are not along the axes of their surface."""
    u = pair.u
    v = pair.v
    kinds = {dim: axis_kind(u, dim) for dim in horizontal_dims(u)}
    if LEVEL not in kinds.values() or len(kinds) < 2 or is_vertical(v):
        return
    level, other = sorted(kinds, key=lambda dim: kinds[dim] != LEVEL)
    if kinds[other] == TIME:
        return
    on_earth = LONGITUDE.match(other) or LATITUDE.match(other)
    if on_earth or (pair.along == "earth" and coordinate_of(u, other) is not None):
        if LONGITUDE.match(other):
            along = u.name
        else:
            along = v.name
        raise FieldError(
            f"{u.name} and {v.name} are horizontal, but the data are a vertical section along "
            f"{level} and {other}, where nothing is known of the vertical flow; name a vertical "
            f'component as well, as in u="{along}", v="w", or draw data of a level'
        )


def _right_handed(flow: Flow) -> Flow:
    """Return a flow whose axes are those of its components, where the grid was turned over."""
    ones = np.ones_like(flow.places.a)
    zeros = np.zeros_like(flow.places.a)
    across = flow.places.turned(flow.ahead, ones, zeros)
    upward = flow.places.turned(flow.ahead, zeros, ones)
    names = f"{flow.pair.u.name} and {flow.pair.v.name}"
    if np.nanmedian(across[0] * upward[1] - across[1] * upward[0]) > 0:
        if np.nanmax(across[0]) < 0 and np.nanmax(upward[1]) < 0:
            text = f"rows of the grid run southward and columns westward, and {names} along these"
            flow.record("components", text, EASTWARD)
        return flow
    rows, columns = flow.ahead
    turned = "rows"
    if np.nanmean(across[0]) < np.nanmean(upward[1]):
        turned = "columns"
        columns = -columns
    else:
        rows = -rows
    text = f"the {turned} of the grid run backwards, as after [::-1]; {names} are taken along the "
    flow.record("components", f"{text}grid before that", EASTWARD, notable=True)
    return replace(flow, ahead=(rows, columns))


def _ahead(array: xr.DataArray, rows: str, columns: str) -> tuple[int, int]:
    """Return the directions of rows and columns, by their coordinates, or as GRIB scans them."""
    ahead = [axis_direction(array, dim) for dim in (rows, columns)]
    if coordinate_of(array, rows) is None and array.attrs.get("GRIB_jScansPositively") == 0:
        ahead[0] = -1
    if coordinate_of(array, columns) is None and array.attrs.get("GRIB_iScansNegatively") == 1:
        ahead[1] = -1
    return ahead[0], ahead[1]


def _is_turned(flow: Flow) -> bool:
    ones = np.ones_like(flow.places.a)
    _, north = flow.places.turned(flow.ahead, ones, 0 * ones)
    return bool(np.nanmax(np.abs(north), initial=0.0) > NOTABLE_TURN)


def _on_rows(pair: Pair, datasets: Datasets, drawn: Drawn, record: Record) -> Flow:
    beside = Beside(datasets, drawn, record)
    grid = find_grid(pair.u, pair.v, beside, along_earth=pair.along == "earth")
    rows = horizontal_dims(grid.u)[0]
    columns = horizontal_dims(grid.v)[-1]
    places = grid.places
    trimmed = unrepeated(places)
    places = places.part(trimmed)
    staggered = grid.rows is not None or grid.columns is not None
    if staggered:
        kind = "Arakawa C"
    else:
        kind = "both components at the same position"
    kind += ", rows and columns" if places.is_line else ", curvilinear"
    record("coordinates", places.why)
    angle = None
    if pair.kind == directions.POLAR:
        angle = places.angles
    bare = Component(grid.u.variable, 1.0), Component(grid.v.variable, 1.0)
    values = Values(
        bare, pair.kind, angle=angle, swapped=pair.swapped, rows=grid.rows, columns=grid.columns
    )
    return Flow(
        replace(pair, u=grid.u, v=grid.v),
        drawn,
        kind,
        places,
        values,
        (rows, columns),
        datasets,
        record,
        ahead=_ahead(pair.u, rows, columns),
        trimmed=trimmed,
        staggered=staggered,
    )


def _on_faces(mesh: Mesh, pair: Pair, datasets: Datasets, drawn: Drawn, record: Record) -> Flow:
    (dim,) = horizontal_dims(pair.u)
    is_earth = mesh.is_earth
    why = mesh.coordinates
    if is_earth:
        unit = ""
    else:
        unit = mesh.unit
    places = Places(mesh.a[None], mesh.b[None], is_earth, is_line=False, why=why, unit=unit)
    record("coordinates", why)
    if mesh.kind == POINTS:
        record("surface", mesh.words, mesh.other_edge, notable=mesh.max_edge is None)
    else:
        record("surface", mesh.words)
    bare = Component(pair.u.variable, 1.0), Component(pair.v.variable, 1.0)
    angle = None
    if pair.kind == directions.POLAR and dim == NODES:
        angle = np.arctan2(mesh.b, mesh.a)
    elif pair.kind == directions.POLAR:
        across, upward = mesh.middles
        angle = np.arctan2(upward, across)
    values = Values(bare, pair.kind, axes=1, angle=angle)
    grid = f"{mesh.words}; velocity {'at nodes' if dim == NODES else 'in faces'}"
    return Flow(pair, drawn, grid, places, values, (dim,), datasets, record, mesh=mesh)


def _masked(flow: Flow, factors: tuple[float, float], wanted: Any) -> Flow:
    record = flow.record
    axes = flow.values.axes
    turn = 2 * np.pi / factors[1] * (1 + 1e-6)
    is_direction = flow.pair.kind in (directions.FROM, directions.TOWARDS)
    if is_direction and wanted is not False:
        limits = (-turn, turn)
    else:
        limits = None
    found: FillWords = {}
    one = checked_component(flow.pair.u, factors[0], axes, wanted, record, found)
    two = checked_component(flow.pair.v, factors[1], axes, wanted, record, found, limits=limits)
    record_fills(found, record)
    flow = replace(flow, values=replace(flow.values, components=(one, two)))
    masks = []
    hidden: list[str] = []
    for mask in find_masks((flow.pair.u, flow.pair.v), flow.datasets, wanted):
        part_of = flow.beside(mask.array)
        if part_of is None:
            if wanted is not None:
                raise FieldError(f"mask is {wanted!r}, which lies elsewhere than the velocity")
            text = f"{mask.array.name} lies at other positions or times, and is not used as a mask"
            record("mask", text, notable=mask.array.ndim > 1)
        elif flow.mesh is None or flow.cells[0] in part_of.dims:
            used = _applied(flow, mask, part_of, wanted, hidden)
            if used is not None:
                masks.append((part_of.variable, used))
    if hidden:
        # The flags of both components are one choice.
        record("mask", "; ".join(hidden), DRAW_ALL, notable=True)
    values = replace(flow.values, masks=tuple(masks))
    if flow.staggered:  # those at rest may be land
        u, v = values.read(_first_moving(flow))
        still: Bools = (u == 0) & (v == 0)
        if LAND_SHARE < still.mean() < 1:
            record("mask", f"{still.mean():.0%} masked: at rest, as on land")
            values = replace(values, land=still)
    return replace(flow, values=values)


def _applied(
    flow: Flow, mask: Mask, part: xr.DataArray, wanted: Any, hidden: list[str]
) -> Mask | None:
    """Return a mask that hides what it means, turned if need be; ``None`` for one without use.

    ``hidden`` receives the words for what flags of quality hide.
    """
    axes = flow.values.axes
    variable = part.variable
    marks = []
    values = []
    moving = _first_moving(flow)
    for at in examined(part, axes):
        bad = ~mask.is_data(read_step(variable, moving, at, axes=axes))
        if not flow.staggered:
            u = flow.values.components[0].read(moving, at, axes=axes)
        elif at is None:
            bad = flow.values.at_cells(bad.astype(float)) > 0
            u = flow.values.read(moving)[0]
        else:
            u = np.full(bad.shape, np.nan)
        marks.append(bad.ravel())
        values.append(u.ravel())
    is_bad = np.concatenate(marks)
    u = np.concatenate(values)
    moves = np.nan_to_num(u) != 0
    if wanted is None and not mask.is_flag and _hides_the_flow(is_bad, moves):
        share = float(np.mean(~is_bad))
        text = f"{mask.text} holds for all that moves, so its opposite is taken: {share:.0%} masked"
        flow.record("mask", text, DRAW_ALL, notable=True)
        return replace(mask, reverse=not mask.reverse)
    is_wind = mask.is_land and wanted is None and moves_over_land(flow.pair.u)
    if is_wind and (flow.staggered or not is_constant(u[is_bad])):
        masked = Remedy("mask", str(part.name), "to mask it,")
        flow.record("mask", f"{mask.text}: not masked, as air moves over land too", masked)
        return None
    share = float(np.mean(is_bad))
    if share == 1.0 and wanted is None and not _has_data(mask, part, axes):
        flow.record("mask", f"{mask.text} everywhere, so {part.name} is not used")
        return None
    text = f"{share:.0%} masked: {mask.text}"
    if share and mask.is_flag:
        hidden.append(text)
    elif share:
        flow.record("mask", text, DRAW_ALL)
    return mask


def _has_data(mask: Mask, part: xr.DataArray, axes: int) -> bool:
    """Return whether a mask leaves data at one of some steps."""
    count = 1
    if part.ndim > axes:
        count = part.shape[0]
    for step in typical_steps(count):
        if mask.is_data(read_step(part.variable, step, axes=axes)).any():
            return True
    return False


def _first_moving(flow: Flow) -> int:
    """Return the first examined step in which a component is not zero everywhere, else 0."""
    part = flow.values.components[0]
    axes = flow.values.axes
    for step in steps_to_examine(part.variable, axes):
        if is_nonzero(part.sample(step, axes)):
            return step
    return 0


def _hides_the_flow(is_bad: Bools, moves: Bools) -> bool:
    """Return whether a mask hides (nearly) all that moves, and its opposite only what rests."""
    if is_bad.all() or not moves.any():
        return False
    left = float(np.mean(~is_bad[moves]))
    opposite = float(np.mean(moves[~is_bad]))
    return left < MOST_LEFT and opposite < MOST_LEFT
