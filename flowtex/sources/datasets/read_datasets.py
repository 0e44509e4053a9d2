"""From labelled arrays to a field, step by step.

``select variables -> align by labels -> attach coordinates -> mask -> convert units -> orient
components -> build the surface``. Each step records what it did. Only coordinates and the first
step of a series are read here; other steps are read when they are drawn.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from operator import itemgetter
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from flowtex._util.arguments import brief, near_names
from flowtex._util.array_types import Floats
from flowtex._util.arrays import is_nonzero
from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.field.dates import as_seconds
from flowtex.field.earth.projection import GLOBE, map_name
from flowtex.field.field_arrays import GridArrays, SourceArrays, TriangleArrays
from flowtex.field.options import OF_MESHES, FieldOptions
from flowtex.field.steps import LazySteps, examined_steps
from flowtex.field.uncertainty import spread_name
from flowtex.field.validation import NO_DATA, lacking
from flowtex.field.vector_names import magnitude_label
from flowtex.remedies import Remedy
from flowtex.sources import tripolar
from flowtex.sources.datasets import labels, select
from flowtex.sources.datasets.axes import (
    NODES,
    TIME,
    Choice,
    axis_kind,
    axis_values,
    horizontal_dims,
    typed_value,
    value_unit,
)
from flowtex.sources.datasets.coordinates import LATITUDE, LONGITUDE
from flowtex.sources.datasets.flow import Flow, read_flow
from flowtex.sources.datasets.masks import WET
from flowtex.sources.datasets.named_places import placed_on
from flowtex.sources.datasets.space_planes import SpacePlane, plane_of
from flowtex.sources.datasets.values import (
    NOTABLE_GAPS,
    LateGaps,
    Regions,
    gap_text,
    read_step,
    region_lines,
)
from flowtex.sources.datasets.vertical import LONGEST_NAME, is_section, read_section
from flowtex.sources.maps import MapNodes, PlaneNodes, on_map
from flowtex.sources.mesh_maps import MeshMap, mesh_on_map, torn_grid
from flowtex.sources.notices import Record
from flowtex.sources.opening.dataset_files import Datasets, as_datasets

if TYPE_CHECKING:
    import xarray as xr

#: Nodes on a map or in a plane.
Placed: TypeAlias = MapNodes | MeshMap | PlaneNodes
#: Most values of an axis that are listed.
MOST_VALUES = 8

#: Variables that belong to the grid itself: places, sizes of cells, masks.
OF_GRIDS = re.compile(
    rf"{LONGITUDE.pattern}|{LATITUDE.pattern}|^(e[12][tuvf]|d[xy][tuvcg]?|[tuvf]?mask\w*|[xy]c?)$",
    re.I,
)

#: Steps of a series among which the first one that moves is searched.
MOST_SEARCHED = 200


def read_datasets(
    data: Any, options: FieldOptions, *, name: str = "", regions: bool = False
) -> SourceArrays | Regions:
    """Read the arrays of a field from datasets.

    Parameters
    ----------
    data
        A dataset, a list of datasets, or what :func:`as_datasets` makes into them.
    options
        Options of the field.
    name
        Name of the field.
    regions
        Whether no nodes are read if any part can be read by itself.

    Raises
    ------
    FieldError
        When the options are for meshes or contradict each other, or the data have no velocity that
        can be drawn.
    """
    options.refuse(OF_MESHES, "meshes, but this is a dataset")
    _check_direction(options)
    projection = _projection(options)
    uncertainty = options.uncertainty
    record = Record()
    u, v = select.two_names(options.vectors)
    datasets = as_datasets(data, record, Choice.of(options))
    if options.dims is not None:
        datasets = _on_named(datasets, options.dims)
    with record.explain():
        if u is not None and v is not None and is_section(datasets, u, v):
            section = read_section(datasets, options, record, datasets.close, name=name)
            record.notify()
            datasets.close()
            return section
        spread: Callable[[int], Floats] | None = None
        if isinstance(uncertainty, str) and any(uncertainty in ds.dims for ds in datasets):
            flow, spread = _averaged(datasets, uncertainty, record, options)
        else:
            flow = read_flow(datasets, options, record)
        for note, names in select.other_velocities(datasets, flow.pair) if u is None else ():
            record("select", note, Remedy("vectors", names, "to draw these,"), notable=True)
        if not flow.places.is_earth and projection is not None:
            raise FieldError(
                f"projection is {projection!r}, but the positions are {flow.places.why}, not "
                "longitude and latitude; omit projection"
            )
        scalars = _scalars(flow)
        words = _words(flow, scalars, name)
        arrays: SourceArrays | Regions | None = None
        if regions and flow.mesh is None and spread is None:
            arrays = _regions(flow, scalars, projection, words)
        if arrays is None:
            placed = _placed(flow, projection, regions=regions)
            arrays = _whole(flow, scalars, placed, words, spread, uncertainty)
    record.notify()
    datasets.close()
    return arrays


def _check_direction(options: FieldOptions) -> None:
    """Raise a FieldError for an array of angles, which has no place in a dataset."""
    if not isinstance(options.direction, str | None):
        raise FieldError(
            f"direction is {brief(options.direction)}; expected the name of a variable of the "
            "dataset. Add the angles to it, as in ds['angle'] = (ds.speed.dims, angle)"
        )


def _projection(options: FieldOptions) -> str | None:
    """Return the name of the map, or of the globe; ``None`` if none is named."""
    name = None
    if options.projection is not None:
        name = map_name(options.projection)
    if not options.globe:
        return name
    if name not in (None, GLOBE):
        raise FieldError(
            f"globe=True and projection={brief(options.projection)} are given; omit one of them"
        )
    return GLOBE


def _on_named(datasets: Datasets, dims: str) -> Datasets:
    """Return datasets whose positions are two coordinates that the user names."""
    x, y = select.two_names(dims, "dims", "lon,lat")
    placed = []
    for ds in datasets:
        if {x, y} <= {*ds.variables} or len(datasets) == 1:
            placed.append(placed_on(ds, x, y, as_dims=True))
        else:
            placed.append(ds)
    changed = Datasets(placed, datasets.closers, recognised=True)
    changed.used = datasets.used
    return changed


def _words(flow: Flow, scalars: Mapping[str, _Scalar], name: str) -> dict[str, Any]:
    """Return the caption of a field, and units and long names of its scalars and its speed."""
    caption = ", ".join(filter(None, (name, flow.record.reading.caption)))
    units_of, names = (
        {key: str(s.array.attrs[word]) for key, s in scalars.items() if s.array.attrs.get(word)}
        for word in ("units", "long_name")
    )
    names = {key: text for key, text in names.items() if len(text) <= LONGEST_NAME}
    if not flow.is_velocity:
        names["speed"] = magnitude_label(flow.name, flow.unit)
    return {"name": caption, "units": units_of, "long_names": names}


def _whole(
    flow: Flow,
    scalars: Mapping[str, _Scalar],
    placed: tuple[Placed, dict[str, Any]],
    words: dict[str, Any],
    spread: Callable[[int], Floats] | None,
    uncertainty: Any,
) -> SourceArrays:
    count = flow.drawn.steps
    nodes, arguments = placed
    # Velocity and speed use the same components.
    read = _steps_of(flow)
    own = {key: LazySteps(count, s.read) for key, s in scalars.items()}
    extra = {key: steps.map(nodes.at) for key, steps in own.items() if not scalars[key].on_faces}
    on_cells: dict[str, LazySteps] = {}
    if flow.mesh is not None:
        faces = itemgetter(flow.mesh.triangles[1][getattr(nodes, "members", slice(None))])
        on_cells = {key: own[key].map(faces) for key, s in scalars.items() if s.on_faces}
    flat = nodes.projection is not None and not nodes.projection.is_globe
    if flat:
        extra["speed"] = read.map(partial(_speed, nodes))
        words["units"]["speed"] = units.symbol(flow.unit) or "m/s"
    elif flow.unit:
        arguments["velocity_unit"] = units.symbol(flow.unit)
    if nodes.projection is None:
        arguments["vectors"] = flow.name
    scale = 1.0
    if flat and flow.unit:
        scale = units.factor(flow.unit, "m/s") or 1.0
    if spread is not None:
        extra[spread_name(uncertainty)] = LazySteps(count, spread).map(nodes.at)
    velocity = read.map(partial(_vectors, nodes, scale))
    if count > 1:
        _note_steps(read, flow)
    if count > 1 and "speed" in extra and not (flat or velocity.quick):
        # It may have other gaps than the velocity.
        extra[NO_DATA] = velocity.map(lacking)
    arguments |= {"points": nodes.points, "velocity": velocity if count > 1 else velocity[0]}
    arguments |= {"times": flow.drawn.times, "scalars": extra, "cell_scalars": on_cells}
    arguments |= {"projection": nodes.projection, "reading": flow.record.reading, **words}
    return TriangleArrays(**arguments) if "triangles" in arguments else GridArrays(**arguments)


def _steps_of(flow: Flow) -> LazySteps:
    """Return the components at all steps, of task graphs with a notice when one has gaps."""
    count = flow.drawn.steps
    if flow.pair.u.chunks is None:
        return LazySteps(count, flow.components, quick=True)
    return LazySteps(count, LateGaps(flow.components))


def _speed(nodes: Placed, components: Floats) -> Floats:
    return np.asarray(np.hypot(*nodes.components(components)))


def _vectors(nodes: Placed, scale: float, components: Floats) -> Floats:
    return nodes.vectors(*nodes.components(components)) * scale


def _note_steps(read: LazySteps, flow: Flow) -> None:
    _note_rest(read, flow)
    _note_gaps(read, flow)


def _note_rest(read: LazySteps, flow: Flow) -> None:
    searched = read[:MOST_SEARCHED]
    first = next((n for n, step in enumerate(searched) if is_nonzero(step)), 0)
    if first:
        times = np.asarray(flow.drawn.times)[first : first + 1]
        time = f"{labels.text(times)} {flow.drawn.time_unit}".strip()
        text = f"the velocity is zero everywhere in the first step; it is not from step {first} on"
        flow.record("select", f"{text} ({time})", *_of_step(flow, first), notable=True)


def _of_step(flow: Flow, step: int) -> list[Remedy]:
    """Return the argument that selects a step of a series, if its times have labels."""
    axis = next((axis for axis in flow.drawn.axes if axis.kind == TIME), None)
    if axis is None or axis.line is None:
        return []
    label = axis.line[np.atleast_1d(axis.drawn)[step]]
    if isinstance(label, np.datetime64):
        label = np.datetime_as_string(label, unit="auto")
    value = typed_value(label, value_unit(flow.pair.u, axis.dim))
    return [Remedy("sel", {axis.dim: value}, "to draw this step alone,")]


def _note_gaps(read: LazySteps, flow: Flow) -> None:
    """Record nodes that have data at some of the examined steps only."""
    if read.quick:
        steps = examined_steps(len(read), read[0].size)
    else:
        steps = []
    known = [np.isfinite(read[n]).all(axis=0) for n in steps]
    if not known:
        return
    always = np.logical_and.reduce(known)
    ever = np.logical_or.reduce(known)
    lacking = ever & ~always
    if lacking.any():
        first = next(n for n, here in zip(steps, known, strict=True) if (ever & ~here).any())
        notable = lacking.mean() >= NOTABLE_GAPS
        text = gap_text(int(lacking.sum()), lacking.size, first)
        flow.record("mask", text, notable=notable)


def _averaged(
    datasets: Datasets, dim: str, record: Record, options: FieldOptions
) -> tuple[Flow, Callable[[int], Floats]]:
    """Return the mean over a dimension, and a reader of the spread."""
    pair = select.choose_pair(datasets, *select.two_names(options.vectors))
    choice = Choice.of(options)
    u = pair.u
    v = pair.v
    chosen = {**choice.sel, **choice.isel}
    if dim in horizontal_dims(u) or dim not in {*u.dims} & {*v.dims}:
        names = []
        for d in u.dims:
            if d not in horizontal_dims(u):
                names.append(str(d))
        msg = f"uncertainty is {dim!r}, which is not a further axis of the data; "
        raise FieldError(msg + near_names(dim, names))
    if dim in chosen:
        raise FieldError(
            f"{dim} is {chosen[dim]!r}, but uncertainty is the spread over {dim}; omit one of them"
        )
    members = []
    for number in range(u.sizes[dim]):
        members.append(
            read_flow(datasets, replace(options, isel={**choice.isel, dim: number}), record)
        )
    sums = LazySteps(
        members[0].drawn.steps, partial(_sums, [member.components for member in members])
    )
    record("select", f"mean over {dim}", caption=f"mean over {dim}")
    drawn = members[0].drawn
    if axis_kind(u, dim) == TIME:
        drawn = replace(drawn, times=None)
    changes: dict[str, Any] = {
        "mean": sums.map(itemgetter(slice(2))).step,
        "drawn": drawn,
        "members": tuple(members),
        "member_dim": dim,
    }
    return replace(members[0], **changes), partial(_spread, sums)


def _placed(flow: Flow, projection: str | None, *, regions: bool) -> tuple[Placed, dict[str, Any]]:
    """Return the nodes of a flow on a map or in a plane, and arguments of its field.

    Those that are read by ``regions`` remain a grid.
    """
    places = flow.places
    mesh = flow.mesh
    if mesh is None:
        if not places.is_earth:
            positions = np.stack([places.a, places.b], axis=-1)
            return PlaneNodes(positions, _space_plane(flow)), _units(flow)
        torn = None
        if not regions:
            torn = torn_grid(places, projection)
        if torn is not None:
            return torn, {"triangles": torn.triangles, **_units(flow)}
        _note_fold(flow)
        on_grid = on_map(places, projection)
        return on_grid, {"periodic": on_grid.periodic, **_units(flow)}
    if not mesh.is_earth:
        nodes_in_plane = PlaneNodes(mesh.positions, _space_plane(flow))
        return nodes_in_plane, {"triangles": mesh.triangles[0], **_units(flow)}
    nodes = mesh_on_map(mesh.a, mesh.b, mesh.triangles[0], places, projection)
    if nodes.lost:
        text = f"{nodes.lost:,} triangles are left out, because the map cuts them, as at a pole"
        whole = Remedy("globe", value=True, aim="to see all of them,")
        flow.record("surface", text, whole, notable=True)
    return nodes, {"triangles": nodes.triangles, **_units(flow)}


def _space_plane(flow: Flow) -> SpacePlane | None:
    """Return the plane across x or y of a flow in space; ``None`` for the plane of x and y."""
    if flow.mesh is not None:
        plane = plane_of(flow.mesh.x, flow.mesh.y)
    else:
        plane = plane_of(*flow.pair.u.coords.values())
    if plane is not None:
        flow.record("coordinates", f"the flow lies in space, in the plane {plane}")
    return plane


def _note_fold(flow: Flow) -> None:
    """Record that a grid is too large for its fold to be joined."""
    places = flow.places
    if tripolar.is_joined(places) or tripolar.folded_columns(places) is None:
        return
    most = tripolar.MOST_FOLDED
    dim = horizontal_dims(flow.pair.u)[0]
    flow.record(
        "surface",
        f"the fold along the last row is not joined, as the grid has {places.a.size:,} nodes: "
        f"streaks and derivatives end there. To join it, select up to {most:,}, as in "
        f"ds.isel({dim}=slice({-(most // places.a.shape[1])}, None))",
        notable=True,
    )


def _units(flow: Flow) -> dict[str, str]:
    """Return the units of length and time of a flow, as arguments of its field."""
    record = flow.record
    unit = flow.unit
    names = f"{flow.pair.u.name} and {flow.pair.v.name}"
    times = flow.drawn.times
    is_date = times is not None and np.asarray(times).dtype.kind in "mMO"
    if is_date:
        time = "s"
    else:
        time = flow.drawn.time_unit
    if not flow.is_velocity:
        if flow.places.is_earth:
            length = "m"
        else:
            length = flow.places.unit
        return {"length_unit": length, "time_unit": time}
    if not flow.places.is_earth:
        length = flow.places.unit
        if not length and unit and units.factor(unit, "m/s") not in (None, 1.0):
            length = "m"
            text = f"{flow.places.why} have no unit, and m is assumed"
            record("units", text, units.unit_remedy("length_unit", length), notable=True)
        if not unit and length and time:
            assumed = f"{length}/{time}"
            text = f"{names} have no unit, and {assumed} is assumed"
            record("units", text, units.unit_remedy("velocity_unit", assumed), notable=True)
        return {"length_unit": length, "time_unit": time}
    if unit and units.factor(unit, "m/s") is None:
        raise FieldError(f"the unit of {names} is {unit!r}; expected one such as m/s on the Earth")
    if not unit:
        text = f"{names} have no unit, and m/s is assumed"
        record("units", text, units.unit_remedy("velocity_unit", "m/s"), notable=True)
    if not time and flow.drawn.steps > 1:
        text = "times have no unit, and s is assumed"
        record("units", text, units.unit_remedy("time_unit", "s"), notable=True)
    return {"length_unit": "m", "time_unit": time or "s"}


def _regions(
    flow: Flow, scalars: Mapping[str, _Scalar], projection: str | None, words: dict[str, Any]
) -> Regions | None:
    """Return a dataset for reading by regions; ``None`` where it must be read as a whole."""
    if flow.staggered:
        lines = None
    else:
        lines = region_lines(flow.places, projection)
    if lines is None or min(lines.shape) < 2 or flow.values.angle is not None:
        return None
    times = flow.drawn.times
    seconds, _, start = as_seconds(times, "s" if times is None else "")
    words |= _units(flow)
    others = {key: scalar.array.variable for key, scalar in scalars.items()}
    flat = lines.projection is not None and not lines.projection.is_globe
    if flat:
        others.pop("speed", None)
        words["units"]["speed"] = units.symbol(flow.unit) or "m/s"
    if lines.projection is None:
        words["vectors"] = f"{flow.pair.u.name}, {flow.pair.v.name}"
    length = words["length_unit"]
    time = words["time_unit"]
    factor, words["time_unit"], own = units.velocity_units(length, time, flow.unit)
    words |= {"start": start, "velocity_unit": "" if flat else own}
    words["times"] = np.zeros(1) if seconds is None else np.asarray(seconds, dtype=float)
    return Regions(words, lines, flow.values, factor, others)


class _Scalar(NamedTuple):
    """A variable that lies at the nodes or in faces, not read yet, and the reader of its steps."""

    array: xr.DataArray
    read: Callable[[int], Floats]
    on_faces: bool


def _scalars(flow: Flow) -> dict[str, _Scalar]:
    """Return the variables at the positions and times of the velocity, by name."""
    scalars: dict[str, _Scalar] = {}
    used = (flow.pair.u.name, flow.pair.v.name)
    # Dimensions of the same name do not distinguish the sides of cells from their centres.
    on_sides = flow.staggered and set(flow.pair.u.dims) & set(flow.pair.v.dims) >= {*flow.cells}
    for ds in flow.datasets:
        has_velocity = any(name in ds for name in used)
        if on_sides and has_velocity:
            continue
        is_mesh_file = flow.mesh is not None and flow.mesh.names[0] in ds and not has_velocity
        for name, array in ds.data_vars.items():
            numbers = array.dtype.kind in "fiu" and not OF_GRIDS.match(str(name))
            of_mesh = flow.mesh is not None and (
                str(name) in (*flow.mesh.names, *WET) or (is_mesh_file and array.ndim == 1)
            )
            if name in (*used, *scalars) or not numbers or of_mesh or array.ndim < flow.values.axes:
                continue
            part = _member(flow).beside(array)
            if part is None:
                flow.record("align", f"{name} lies at other positions or times, and is left out")
            else:
                on_faces = flow.mesh is not None and horizontal_dims(part)[0] != NODES
                scalars[str(name)] = _Scalar(part, _reader(flow, array, part), on_faces)
    return scalars


def _member(flow: Flow) -> Flow:
    """Return the first member of an ensemble, or a single flow."""
    if flow.members:
        return flow.members[0]
    return flow


def _reader(flow: Flow, array: xr.DataArray, part: xr.DataArray) -> Callable[[int], Floats]:
    """Return the reader of the steps of a variable, or of the means of an ensemble."""
    if flow.member_dim not in array.dims:
        return partial(_scalar_step, flow, part)
    parts = [member.beside(array) for member in flow.members]
    return partial(_mean_step, flow, [other for other in parts if other is not None])


def _mean_step(flow: Flow, parts: Sequence[xr.DataArray], step: int) -> Floats:
    total = np.zeros(())
    for part in parts:
        total = total + _scalar_step(flow, part, step)
    return np.asarray(total / len(parts))


def _scalar_step(flow: Flow, part: xr.DataArray, step: int) -> Floats:
    values = read_step(part.variable, step, axes=flow.values.axes)
    flow.datasets.close()
    return flow.at_nodes(values)


def recognised(data: Any) -> dict[str, str]:
    """Return the velocity, grid and coordinates that are recognised, with reasons, and the axes."""
    record = Record()
    datasets = as_datasets(data, record)
    pairs = select.find_pairs(datasets)
    flow = read_flow(datasets, FieldOptions(vectors=pairs[0].names if pairs else None), record)
    rows = {"velocity": str(flow.pair)}
    if others := [pair for pair in pairs if pair.u.name != flow.pair.u.name]:
        rows["also"] = "; ".join(map(str, others))
    rows |= {"directions": str(flow.orientation), "grid": flow.grid}
    rows["coordinates"] = flow.places.why
    for step, title in (("align", "aligned"), ("mask", "masked"), ("units", "units")):
        if sentences := record.reading.of(step):
            rows[title] = "; ".join(sentences)
    for name, words in axis_values(select.variable(datasets, str(flow.pair.u.name))).items():
        listed = ", ".join(words[:MOST_VALUES]) + (", ..." if len(words) > MOST_VALUES else "")
        rows[name] = f"{len(words)}: {listed}"
    return rows


def _sums(members: Sequence[Callable[[int], Floats]], step: int) -> Floats:
    """Return the means of u, v and u² + v² of the members of an ensemble, (3, ...)."""
    total = np.zeros(())
    for read in members:
        u, v = read(step)
        total = total + np.stack([u, v, u * u + v * v])
    return total / len(members)


def _spread(sums: LazySteps, step: int) -> Floats:
    """Return the spread of an ensemble from 0 to 1.

    It is the standard deviation of the velocity, of both components together, over the length of
    its mean; 1 where that is more.
    """
    u, v, square = sums.step(step)
    with np.errstate(invalid="ignore", divide="ignore"):
        # Nodes at rest in all members have no spread.
        share = np.where(square > 0, np.sqrt(np.maximum(square / (u * u + v * v) - 1, 0)), 0.0)
    return np.where(np.isnan(square), np.nan, np.minimum(share, 1.0))
