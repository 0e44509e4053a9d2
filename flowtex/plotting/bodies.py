"""Other objects of a PyVista plotter with a flow, as a browser draws them.

Meshes become triangles and pieces of lines with the colours of their mapper; volumes, images, and
actors in window coordinates are left out and named.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkRenderingCore import vtkAbstractMapper, vtkProperty

from flowtex._util.array_types import Bytes, Indices
from flowtex.plotting.handle import FlowHandle
from flowtex.rendering.webgl.bodies import MOST_LABELS, MOST_VERTICES, Bodies, Body, Label, Light

#: Name of the colours among the arrays of a mesh.
COLOURS = "flowtex colours"
#: VTK's shape of labels without a plate.
NO_PLATE = 0


class _NotDrawnError(Exception):
    """An actor is left out; the text is the reason."""


def read_bodies(plotter: pv.BasePlotter, shown: FlowHandle) -> tuple[Bodies, list[str]]:
    """Return the other objects of a scene, and those left out with the reasons."""
    meshes: list[Body] = []
    labels: list[Label] = []
    left_out: list[str] = []
    room = MOST_VERTICES
    renderer = shown._plotter.renderers[shown._place]
    for name, actor in _actors(plotter, shown):
        try:
            if actor not in renderer.actors.values():
                msg = "in another part of the window"
                raise _NotDrawnError(msg)
            if isinstance(actor, pv.Actor) or actor.IsA("vtkActor"):
                bodies = [body for body in _bodies(actor) if len(body.points)]
                size = sum(len(body.points) for body in bodies)
                if size > room:
                    msg = (
                        f"{size:,} vertices exceed the {room:,} that are left of "
                        f"{MOST_VERTICES:,} in all; decimate the mesh, or extract a part"
                    )
                    raise _NotDrawnError(msg)
                room -= size
                meshes += bodies
            else:
                labels += _labels(actor)
        except _NotDrawnError as reason:
            left_out.append(f"{name!r} ({reason})")
    if len(labels) > MOST_LABELS:
        left_out.append(f"{len(labels) - MOST_LABELS:,} labels beyond the limit of {MOST_LABELS}")
    lights = tuple(_lights(renderer)) if meshes else ()
    return Bodies(tuple(meshes), tuple(labels[:MOST_LABELS]), lights), left_out


def _actors(plotter: pv.BasePlotter, shown: FlowHandle) -> Iterator[tuple[str, Any]]:
    """Yield the visible actors of a plotter, except the flow and its legend."""
    flows = {id(handle.actor) for handle in plotter.flowtex}
    bars, title = dict(plotter.scalar_bars.items()), shown._bar_title
    bar = None if title is None else bars.get(title)
    for renderer in plotter.renderers:
        for name, actor in renderer.actors.items():
            if actor in (shown.actor, bar) or not actor.GetVisibility():
                continue
            if id(actor) in flows:
                name = f"{name}, another flow"
            yield name.partition("(Addr")[0], actor


def _bodies(actor: Any) -> Iterator[Body]:
    """Yield the faces, the lines and the points of an actor."""
    mapper, prop = actor.GetMapper(), actor.GetProperty()
    data = None
    if mapper.GetInputAlgorithm() is not None:
        mapper.GetInputAlgorithm().Update()  # no frame may have been drawn yet
        data = mapper.GetInputDataObject(0, 0)
    if mapper.IsA("vtkCompositePolyDataMapper"):
        blocks = [block for block in pv.wrap(data).recursive_iterator() if block is not None]
    elif data is not None and data.IsA("vtkDataSet"):
        blocks = [pv.wrap(data)]
    else:
        msg = f"drawn by {mapper.GetClassName()}, which cannot be sent to a browser"
        raise _NotDrawnError(msg)
    if actor.GetTexture() is not None:
        msg = "coloured by a texture"
        raise _NotDrawnError(msg)
    matrix = pv.array_from_vtkmatrix(actor.GetMatrix())
    for block in blocks:
        surface = _coloured(block, mapper, prop)
        if not np.array_equal(matrix, np.eye(4)):
            surface = surface.transform(matrix, inplace=False)
        yield from _parts_of(surface, prop)


def _coloured(mesh: pv.DataSet, mapper: Any, prop: vtkProperty) -> pv.PolyData:
    """Return the surface of a mesh with no other arrays than colours and normals."""
    colours = _colours(mesh, mapper)
    copy = mesh.copy(deep=False)
    normals = mesh.point_data.active_normals if isinstance(mesh, pv.PolyData) else None
    copy.clear_data()
    if colours is None:
        colours = np.tile(_bytes((*prop.GetColor(), 1.0)), (mesh.n_points, 1))
    else:
        colours = colours.copy()
    opacity = prop.GetOpacity() * colours[:, 3]
    colours[:, 3] = np.where(opacity < 255, np.minimum(np.rint(opacity), 254), 255)
    on_points = len(colours) == mesh.n_points
    (copy.point_data if on_points else copy.cell_data)[COLOURS] = colours
    if normals is not None and prop.GetInterpolation():
        copy.point_data.active_normals = normals
    return copy if isinstance(copy, pv.PolyData) else copy.extract_surface(algorithm=None)


def _colours(mesh: pv.DataSet, mapper: Any) -> Bytes | None:
    """Return the colours (N, 4) of scalars at points or cells; ``None`` without scalars."""
    if not mapper.GetScalarVisibility():
        return None
    of_cells = reference(0)
    scalars = vtkAbstractMapper.GetAbstractScalars(
        mesh,
        mapper.GetScalarMode(),
        mapper.GetArrayAccessMode(),
        mapper.GetArrayId(),
        mapper.GetArrayName(),
        of_cells,  # type: ignore[arg-type]
    )
    if scalars is None:
        return None
    table = mapper.GetLookupTable()
    if not mapper.GetUseLookupTableScalarRange():
        table.SetRange(mapper.GetScalarRange())
    mapped = table.MapScalars(scalars, mapper.GetColorMode(), mapper.GetArrayComponent())
    return pv.convert_array(mapped)


def _parts_of(surface: pv.PolyData, prop: vtkProperty) -> Iterator[Body]:
    """Yield the faces, lines and points of a surface, and the edges of its faces."""
    style, width = prop.GetRepresentationAsString(), prop.GetLineWidth()
    faces = surface.triangulate() if surface.GetNumberOfStrips() else surface
    verts, lines, polys = (_cells(faces, kind) for kind in ("Verts", "Lines", "Polys"))
    if style == "Points":
        points = np.arange(faces.n_points)
        yield _body(faces, (points, points, 0 * points), width=prop.GetPointSize())
        return
    yield _body(faces, (verts[0], verts[0], verts[2]), width=prop.GetPointSize())
    yield _body(faces, _pieces(lines), width=width)
    if style == "Wireframe":
        yield _body(faces, _edges(polys), width=width)
        return
    if not len(polys[0]):
        return
    triangles = faces.triangulate()
    ids, _, owners = _cells(triangles, "Polys")
    light = {"ambient": prop.GetAmbient(), "diffuse": prop.GetDiffuse()}
    corners = (*ids.reshape(-1, 3).T, owners[::3])
    yield _body(triangles, corners, **(light if prop.GetLighting() else {}))
    if prop.GetEdgeVisibility():
        yield _body(faces, _edges(polys), width=width, colour=prop.GetEdgeColor())


#: Points of all cells in a row, the first of each cell, and the cell of each point.
Cells = tuple[Indices, Indices, Indices]


def _cells(mesh: pv.PolyData, kind: str) -> Cells:
    """Return the cells of a kind, numbered as in arrays of cell data."""
    before = {"Verts": 0, "Lines": mesh.n_verts, "Polys": mesh.n_verts + mesh.n_lines}[kind]
    cells = getattr(mesh, f"Get{kind}")()
    ids, starts = (
        np.asarray(pv.convert_array(array), dtype=np.int64)
        for array in (cells.GetConnectivityArray(), cells.GetOffsetsArray())
    )
    return ids, starts, np.repeat(np.arange(len(starts) - 1) + before, np.diff(starts))


def _pieces(lines: Cells) -> Cells:
    """Return both ends of the pieces of lines, and their cells."""
    ids, _, owners = lines
    is_joined = owners[:-1] == owners[1:]
    return ids[:-1][is_joined], ids[1:][is_joined], owners[:-1][is_joined]


def _edges(polygons: Cells) -> Cells:
    """Return both ends of the edges of polygons, each once, and one of its cells."""
    ids, starts, owners = polygons
    after = np.arange(1, len(ids) + 1)
    after[starts[1:] - 1] = starts[:-1]
    ends = np.sort(np.stack([ids, ids[after]], axis=1), axis=1)
    ends, first = np.unique(ends, axis=0, return_index=True)
    return ends[:, 0], ends[:, 1], owners[first]


def _body(
    mesh: pv.PolyData, corners: tuple[Indices, ...], colour: Any = None, **look: float
) -> Body:
    """Return triangles or pieces of lines, given by their corners and their cells.

    With colours of cells, each has its own vertices.
    """
    ends, owners = corners[:-1], corners[-1]
    cells, points = np.stack(ends, axis=1), np.asarray(mesh.points, dtype=float)
    normals = mesh.point_data.active_normals
    if COLOURS in mesh.cell_data:
        colours = np.repeat(np.asarray(mesh.cell_data[COLOURS])[owners], cells.shape[1], axis=0)
        used = cells.ravel()
        cells = np.arange(cells.size).reshape(cells.shape)
    else:
        used, numbers = np.unique(cells, return_inverse=True)
        cells, colours = numbers.reshape(cells.shape), mesh.point_data[COLOURS][used]
    if colour is not None:
        colours = np.concatenate([np.tile(_bytes(colour), (len(used), 1)), colours[:, 3:]], axis=1)
    is_face = len(ends) == 3
    faces, pieces = (np.zeros((0, k), np.intp) for k in (3, 2))
    return Body(
        points[used],
        np.asarray(colours),
        cells if is_face else faces,
        pieces if is_face else cells,
        normals=None if normals is None else np.asarray(normals, dtype=float)[used],
        **look,
    )


def _plain(values: Iterable[float]) -> tuple[float, ...]:
    """Return plain Python numbers."""
    return tuple(map(float, values))


def _bytes(colour: ArrayLike) -> Bytes:
    return np.rint(255 * np.asarray(colour)).astype(np.uint8)


def _labels(actor: Any) -> Iterator[Label]:
    mapper = actor.GetMapper() if actor.IsA("vtkActor2D") else None
    if mapper is None or not mapper.IsA("vtkLabelPlacementMapper"):
        msg = f"{actor.GetClassName()}, neither a mesh nor a point label"
        raise _NotDrawnError(msg)
    hierarchy = source = mapper.GetInputAlgorithm()
    name, look = hierarchy.GetLabelArrayName(), hierarchy.GetTextProperty()
    while source.IsA("vtkPointSetToLabelHierarchy") or source.IsA("vtkSelectVisiblePoints"):
        source = source.GetInputAlgorithm()  # before what hides labels from the present camera
    source.Update()
    points = pv.wrap(source.GetOutputDataObject(0))
    texts = points.GetPointData().GetAbstractArray(name)
    opacity = 0.0 if mapper.GetShape() == NO_PLATE else mapper.GetBackgroundOpacity()
    for n, position in enumerate(points.points):
        yield Label(
            str(texts.GetVariantValue(n).ToString()),
            _plain(position),
            float(look.GetFontSize()),
            _plain(look.GetColor()),
            _plain((*mapper.GetBackgroundColor(), opacity)),
        )


def _lights(renderer: pv.Renderer) -> Iterator[Light]:
    """Yield the lights of a renderer, all as distant ones."""
    for light in renderer.lights:
        if light.on:
            toward = np.subtract(light.position, light.focal_point)
            toward = np.array([0.0, 0.0, 1.0]) if light.is_headlight else toward
            color = light.intensity * np.asarray(light.diffuse_color.float_rgb)
            yield Light(
                _plain(toward / np.linalg.norm(toward)),
                _plain(color),
                turns=not light.is_scene_light,
            )
