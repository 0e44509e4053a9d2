"""Put a field of the Earth, with the nodes and vectors of its own map, on another map."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, TypeAlias

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.earth.projection import Projection
from flowtex.field.locate import EARTH as GLOBE
from flowtex.field.locate import POLE_LATITUDE, turned
from flowtex.field.steps import Steps, map_steps
from flowtex.sources.datasets.coordinates import Places
from flowtex.sources.maps import MapNodes, on_map
from flowtex.sources.mesh_maps import MeshMap, mesh_on_map, torn_grid

Placed: TypeAlias = MapNodes | MeshMap
#: Share of the spacing within which nodes lie on one meridian or parallel.
SAME_LINE = 1e-3
TEAR_METRES = 100.0  #: Nodes on both sides of a tear are closer than this, unless all nodes are.
TEAR_SHARE = 0.01  #: The same as a share of a typical edge.


def reprojected(field: FlowField, name: str) -> FlowField:
    """Return a field of the Earth on another map.

    Parameters
    ----------
    field
        The flow, whose projection is known.
    name
        The map, as :class:`flowtex.field.earth.Projection` takes it.

    Returns
    -------
    FlowField
        Speeds and the eastward and northward components are the same.

    Raises
    ------
    FieldError
        When the field is not of the Earth, or PROJ does not know the map.
    """
    if field.projection is None:
        raise FieldError(f"{field!r} is not of the Earth; expected a field with a projection")
    if field.triangles is None:
        return _of_grid(field, name)
    return _of_triangles(field, name)


def _of_grid(field: FlowField, name: str) -> FlowField:
    lon, lat = _lonlat(field)
    lon = _with_meridians(lon, lat)
    lines = _meridians_and_parallels(lon, lat)
    columns = np.arange(lon.shape[1])
    rows = np.arange(lon.shape[0])
    if lines is None:
        places = Places(lon, lat, is_earth=True, is_line=False, why="")
    else:
        rows = np.flatnonzero(np.isfinite(lines[1]))
        columns = np.flatnonzero(np.isfinite(lines[0]))
        a, b = np.broadcast_arrays(lines[0][columns], lines[1][rows][:, None])
        places = Places(a, b, is_earth=True, is_line=True, why="")
        lon = np.where(np.isfinite(lines[0]), lines[0], lon)
    chosen = np.ix_(rows, columns)
    torn = torn_grid(places, name)
    projection = _map_of(field)
    own = partial(_components, projection, lon, lat)
    if torn is not None:
        cells = np.unravel_index(torn.members, (field.shape[0] - 1, field.shape[1] - 1))
        at_cells = {key: _cell_values(field, key, *cells) for key in field.on_cells}
        on_mesh = partial(FlowField.from_triangles, torn.points, torn.triangles)
        return _made(field, torn, own, chosen, partial(on_mesh, cell_scalars=at_cells))
    nodes = on_map(places, name)
    j, i = np.indices(field.shape, dtype=float)
    rows, columns = (
        np.floor(np.nan_to_num(nodes.at(at[chosen]))).astype(int)[:-1, :-1] for at in (j, i)
    )
    make = partial(FlowField.from_arrays, nodes.points, periodic=nodes.periodic)
    at_cells = {key: _cell_values(field, key, rows, columns) for key in field.on_cells}
    return _made(field, nodes, own, chosen, partial(make, cell_scalars=at_cells))


def _of_triangles(field: FlowField, name: str) -> FlowField:
    assert field.triangles is not None
    own_places = _lonlat(field)
    lon, lat = _joined(field, *own_places)
    places = Places(lon, lat, is_earth=True, is_line=False, why="")
    nodes = mesh_on_map(lon[0], lat[0], field.triangles, places, name)
    members = nodes.members
    at_cells = {
        name: map_steps(field.scalars[name], lambda step: step[0][members])
        for name in field.on_cells
    }
    make = partial(FlowField.from_triangles, nodes.points, nodes.triangles)
    own = partial(_turned_components, _map_of(field), own_places, (lon, lat), _pole_sources(field))
    return _made(field, nodes, own, 0, partial(make, cell_scalars=at_cells))


def _map_of(field: FlowField) -> Projection:
    assert field.projection is not None
    return field.projection


def _components(projection: Projection, lon: Floats, lat: Floats, velocity: Floats) -> Floats:
    """Return eastward and northward components, (2, J, I), of vectors on a map."""
    return np.stack(projection.components(lon, lat, velocity))


def _turned_components(
    projection: Projection,
    own: tuple[Floats, Floats],
    joined: tuple[Floats, Floats],
    poles: list[tuple[int, Indices]],
    velocity: Floats,
) -> Floats:
    """Return components, (2, 1, N), at places to which nodes have been moved.

    Nodes at a pole, where a map has no directions, have the mean of the nodes around them.
    """
    vectors = GLOBE.vectors(*own, *projection.components(*own, velocity))
    for node, around in poles:
        vectors[0, node] = vectors[0, around].mean(axis=0)
    return np.stack(GLOBE.components(*joined, vectors))


def _pole_sources(field: FlowField) -> list[tuple[int, Indices]]:
    """Return the nodes at poles where the map has no directions, and the nodes around each."""
    projection = _map_of(field)
    triangles = field.triangles
    lon, lat = _lonlat(field)
    turned_by = projection.positions(lon + 90.0, lat) - projection.positions(lon, lat)
    is_point = (np.abs(lat) > POLE_LATITUDE) & (np.linalg.norm(turned_by, axis=-1) < TEAR_METRES)
    if projection.is_globe or triangles is None:
        return []
    found = []
    for node in np.flatnonzero(is_point[0]):
        around = np.unique(triangles[(triangles == node).any(axis=1)])
        around = around[~is_point[0, around] & field.valid[0, around]]
        if len(around):
            found.append((int(node), around))
    return found


def _made(
    field: FlowField,
    nodes: Placed,
    own: Callable[[Floats], Floats],
    chosen: Any,
    make: Callable[..., FlowField],
) -> FlowField:
    """Make the field on the nodes of a map, from some of the nodes of a field.

    ``own`` takes the velocity to its components at all nodes of the field.
    """

    def components(velocity: Floats) -> Floats:
        both = own(velocity)
        both[:, ~field.valid] = np.nan
        return nodes.components(np.stack([part[chosen] for part in both]))

    def vectors(velocity: Floats) -> Floats:
        return nodes.vectors(*components(velocity))

    def speed(velocity: Floats) -> Floats:
        return np.asarray(np.hypot(*components(velocity)) * field.speed_scale)

    scalars = _nodal_scalars(field, nodes, chosen)
    velocity_unit = field.velocity_unit
    units = dict(field.units)
    if not nodes.projection.is_globe:
        units["speed"] = field.speed_unit
        velocity_unit = ""
        scalars["speed"] = map_steps(field.velocity, speed)
    made = make(
        map_steps(field.velocity, vectors),
        times=_changing_times(field),
        scalars=scalars,
        projection=nodes.projection,
        length_unit=field.length_unit,
        time_unit=field.time_unit,
        name=field.name,
        vectors=field.vectors,
        long_names=field.long_names,
    )
    return made.same_flow(
        times=field.times,
        units=units,
        velocity_unit=velocity_unit,
        start=field.start,
        reading=field.reading,
        uncertainty=field.uncertainty,
        volume_values=field.volume_values,
    )


def _changing_times(field: FlowField) -> Floats | None:
    """Return the times of a field, or ``None`` for a single one."""
    if len(field.times) == 1:
        return None
    return field.times


def _nodal_scalars(field: FlowField, nodes: Placed, chosen: Any) -> dict[str, Steps]:
    """Return the scalars of a field on the nodes of a map, without the speed and those on cells."""

    def nodal(step: Floats) -> Floats:
        return nodes.at(step[chosen])

    scalars = {}
    for name, steps in field.scalars.items():
        if name not in field.on_cells and name != "speed":
            scalars[name] = map_steps(steps, nodal)
    return scalars


def _lonlat(field: FlowField) -> tuple[Floats, Floats]:
    """Return longitudes and latitudes (J, I) of nodes; NaN where they are unknown."""
    points = field.points
    if field.has_position is not None:
        points = np.where(field.has_position[..., None], points, np.nan)
    return _map_of(field).lonlat(points)


def _with_meridians(lon: Floats, lat: Floats) -> Floats:
    """Return longitudes (J, I) where nodes at a pole have those of the nodes beside them.

    A map on which a pole is one point does not tell them.
    """
    at_pole = np.abs(lat) > POLE_LATITUDE
    result = lon.copy()
    for step, border in ((1, 0), (-1, -1)):
        beside = np.roll(lon, step, axis=0)
        is_known = ~np.roll(at_pole, step, axis=0) & np.isfinite(beside)
        is_known[border] = False
        result = np.where(at_pole & is_known, beside, result)
    return result


def _meridians_and_parallels(lon: Floats, lat: Floats) -> tuple[Floats, Floats] | None:
    """Return the longitude of each column and the latitude of each row of positions, (J, I) each.

    A grid with such lines is projected line by line. ``None`` if longitudes differ within a column,
    or latitudes within a row.
    """
    has_meridian: Bools = np.isfinite(lon) & (np.abs(lat) < POLE_LATITUDE)
    columns = np.full(lon.shape[1], np.nan)
    rows = np.full(lon.shape[0], np.nan)
    for column in range(lon.shape[1]):
        known = lon[has_meridian[:, column], column]
        if len(known):
            columns[column] = known[len(known) // 2]
    for row in range(lon.shape[0]):
        known = lat[row][np.isfinite(lat[row])]
        if len(known):
            rows[row] = known[len(known) // 2]
    lon_errors = np.abs(turned(lon - columns))[has_meridian]
    lat_errors = np.abs(lat - rows[:, None])[np.isfinite(lat)]
    for errors, line in ((lon_errors, columns), (lat_errors, rows)):
        steps = np.abs(turned(np.diff(line[np.isfinite(line)])))
        if errors.max(initial=0.0) > SAME_LINE * np.median(steps):
            return None
    return columns, rows


def _cell_values(field: FlowField, name: str, rows: Indices, columns: Indices) -> Any:
    """Return values of some cells, by their rows and columns in a field."""
    return map_steps(field.scalars[name], lambda step: step[rows, columns])


def _joined(field: FlowField, lon: Floats, lat: Floats) -> tuple[Floats, Floats]:
    """Move nodes on both sides of a tear of the field's map to one place."""
    assert field.triangles is not None
    if _map_of(field).is_globe:
        return lon, lat
    places = GLOBE.positions(lon[0], lat[0])
    corners = places[field.triangles]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1)
    near = min(TEAR_METRES, TEAR_SHARE * float(np.nanmedian(edges)))
    known = np.flatnonzero(np.isfinite(places[:, 0]))
    pairs = scipy.spatial.cKDTree(places[known]).query_pairs(near, output_type="ndarray")
    one, other = known[pairs].T
    lon = lon.copy()
    lat = lat.copy()
    lon[0, other], lat[0, other] = lon[0, one], lat[0, one]
    return lon, lat
