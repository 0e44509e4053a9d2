"""Flow textures in PyVista: ``plotter.flowtex.add(mesh)``.

PyVista finds :class:`FlowtexComponent` through its entry point and makes one for each plotter
that asks for ``plotter.flowtex``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Literal, TypeAlias
from weakref import WeakKeyDictionary, WeakSet

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike
from vtkmodules.vtkRenderingCore import vtkDataSetMapper, vtkProperty

from flowtex._util.array_types import Bytes, Indices
from flowtex.errors import FieldError, notify
from flowtex.field import FlowField, Surface
from flowtex.field.options import FieldOptions, accepts_options
from flowtex.plotting.handle import FlowHandle
from flowtex.rendering.camera import CAMERA_LIMITS, Camera, apply_camera, read_camera
from flowtex.rendering.vtk.frame import FrameSteps, Step
from flowtex.rendering.webgl.bodies import MOST_LABELS, MOST_VERTICES, Bodies, Body, Label, Light
from flowtex.scene.annotations import difference_text
from flowtex.scene.array_arguments import joins_arrays
from flowtex.scene.options import Appearance, Options, ViewOptions
from flowtex.scene.scene import Scene, make_scenes
from flowtex.textures.images import as_image

COLOURS = "flowtex colours"  #: Name of the colours among the arrays of a mesh.
WHOLE = ViewOptions()  #: A view of the whole surface.
#: Which scenes have a bar of colours: the usual ones, those for which users ask, or none.
Bars: TypeAlias = Literal["usual", "asked", "none"]
#: Bounds of the objects of renderers, by which their cameras clip.
_bounds: WeakKeyDictionary[pv.Renderer, Any] = WeakKeyDictionary()


@pv.register_plotter_component("flowtex")
class FlowtexComponent:
    """The flow textures of one plotter.

    Examples
    --------
    >>> import flowtex
    >>> import pyvista as pv
    >>> plotter = pv.Plotter(off_screen=True)
    >>> handle = plotter.flowtex.add(flowtex.examples.airfoil(), cmap="viridis", samples=25)
    >>> len(plotter.flowtex)
    1
    >>> plotter.close()
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter: Any = plotter
        self._handles: list[FlowHandle] = []
        #: The camera of a renderer as it was pointed at flows.
        self._pointed: WeakKeyDictionary[Any, Camera] = WeakKeyDictionary()
        #: Renderers whose camera sees planes of several directions from aside.
        self._turned: WeakSet[Any] = WeakSet()

    @joins_arrays(1)
    @accepts_options(FieldOptions, Appearance)
    def add(
        self,
        mesh: Any,
        vectors: Any = None,
        scalars: Any = None,
        cmap: Any = None,
        *,
        scalar_bar_args: Mapping[str, Any] | None = None,
        reset_camera: bool | None = None,
        name: str | None = None,
        label: str | None = None,
        pickable: bool | None = None,
        show_edges: bool | None = None,
        edge_color: Any = None,
        line_width: float | None = None,
        **options: Any,
    ) -> FlowHandle:
        """Draw the flow on a mesh as a texture.

        Parameters
        ----------
        mesh
            PyVista mesh, list of meshes in time, xarray dataset, :class:`~flowtex.FlowField`, path
            of a file, or plain arrays by position: ``x, y, u, v`` as in ``plt.streamplot``.
        scalar_bar_args
            As for ``plotter.add_mesh``, without arguments for the colours. Sizes, places and fonts
            that are not given follow from the size of the view, those of horizontal bars too.
        reset_camera
            Whether to move the camera so that it shows everything; by default for the first mesh,
            and for a plane that the camera would see edge-on, unless it has been moved.
        name, label, pickable, show_edges, edge_color, line_width
            As for ``plotter.add_mesh``: a flow or mesh of the same name is replaced, and
            ``plotter.add_legend()`` shows the label. Edges are those of the drawn triangles.
        {options}

        Returns
        -------
        FlowHandle

        Raises
        ------
        FieldError
            When the mesh does not contain a flow, or an argument of the bar is unknown.
        SettingsError
            When a setting is unknown or out of range.
        ImageError
            When the image cannot be read or used; a subclass of SettingsError.

        Examples
        --------
        >>> import flowtex
        >>> import pyvista as pv
        >>> plotter = pv.Plotter(off_screen=True)
        >>> handle = plotter.flowtex.add(flowtex.examples.delta_wing(), scalars="height")
        >>> plotter.close()
        """
        options |= {"vectors": vectors, "scalars": scalars, "cmap": cmap}
        chosen = Options.split("field", "appearance", **options)
        (scene,) = make_scenes(mesh, chosen)
        of_actor: Any = dict(name=name, label=label, pickable=pickable, show_edges=show_edges)
        of_actor |= dict(edge_color=edge_color, line_width=line_width)
        for argument in list(of_actor):
            if of_actor[argument] is None:
                del of_actor[argument]
        handle = self.add_scene(
            scene, scalar_bar_args=scalar_bar_args, reset_camera=reset_camera, **of_actor
        )
        handle.follow_mesh(mesh, chosen.field)
        return handle

    def add_scene(
        self,
        scene: Scene,
        *,
        scalar_bar_args: Mapping[str, Any] | None = None,
        may_have_bar: bool = True,
        reset_camera: bool | None = None,
        **actor_options: Any,
    ) -> FlowHandle:
        """Draw a scene, by default with its bar; other parameters are as for :meth:`add`."""
        first = not self._plotter.renderer.actors
        handle = FlowHandle(
            self._plotter,
            scene,
            self._handles.remove,
            scalar_bar_args,
            may_have_bar=may_have_bar,
            **actor_options,
        )
        self._handles.append(handle)
        if reset_camera or (reset_camera is None and first):
            point_camera(self._plotter, scene.whole.surface)
            self._pointed[self._plotter.renderer] = read_camera(self._plotter.camera)
        elif reset_camera is None:
            self._turn_to(scene.whole.surface)
        return handle

    def _turn_to(self, surface: Surface) -> None:
        """Show all flows from aside if one is seen edge-on from where the camera was pointed."""
        plotter = self._plotter
        renderer = self._plotter.renderer
        present = read_camera(plotter.camera)
        if present != self._pointed.get(renderer):
            return
        if renderer not in self._turned and not present.sees_edge_on(surface):
            return
        points = []
        for handle in self._handles:
            if handle.renderer is renderer:
                drawn = handle.scene.whole.surface
                points.append(drawn.points[drawn.valid])
        aside = Camera.aside(np.concatenate(points), aspect_of(plotter))
        apply_camera(aside, plotter.camera)
        self._pointed[renderer] = read_camera(plotter.camera)
        self._turned.add(renderer)

    def for_browser(self) -> tuple[FlowField, dict[str, Any], Bodies]:
        """Return the first flow, its arguments, and the other meshes of the plotter.

        A warning lists what the browser cannot draw.

        Raises
        ------
        FieldError
            When the plotter has no flow.
        """
        if not self._handles:
            raise FieldError(
                "this plotter has no flow texture; add one with plotter.flowtex.add(mesh), or "
                "choose another jupyter_backend"
            )
        shown = self._handles[0]
        shown.read_changes()
        bodies, left_out = read_bodies(self._plotter, shown)
        if not np.allclose(shown.actor.user_matrix, np.eye(4)) or any(shown.actor.position):
            left_out.append("the place of the flow")
        if left_out:
            notify(
                "the browser draws one flow with meshes and labels; it does not show: "
                f"{', '.join(left_out)}. Another jupyter_backend, such as 'trame', draws them",
                UserWarning,
            )
        return shown.field, self._look_of(shown), bodies

    def _look_of(self, handle: FlowHandle) -> dict[str, Any]:
        """Return the arguments that reproduce the appearance of a handle."""
        mapper = handle.actor.mapper
        prop = handle.actor.prop
        image = handle.scene.image
        name = handle.scene.scalar_name
        colours: dict[str, Any] = {"scalars": False, "color": prop.color}
        if name is not None:
            table = np.asarray(mapper.lookup_table.values)
            colours = {"scalars": name, "cmap": table, "clim": tuple(mapper.scalar_range)}
        if image is not None:
            image = as_image(image)
        return {
            **dict(handle.settings),
            **colours,
            "image": image,
            "lighting": bool(prop.lighting),
            "opacity": float(prop.opacity),
            "show_scalar_bar": bool(self._plotter.scalar_bars),
            "background": self._plotter.background_color,
            "camera": read_camera(self._plotter.camera),
        }

    def __iter__(self) -> Iterator[FlowHandle]:
        """Yield the handles that have not been removed."""
        return iter(tuple(self._handles))

    def __len__(self) -> int:
        """Count the handles that have not been removed."""
        return len(self._handles)

    def clear(self, *, render: bool = True) -> None:
        """Remove every flow texture."""
        for handle in tuple(self._handles):
            handle.remove(render=False)
        if render:
            self._plotter.render()

    def __plotter_close__(self) -> None:
        """Free the graphics card when the plotter closes."""
        self.clear(render=False)


def point_camera(
    plotter: Any, surface: Surface, view: ViewOptions = WHOLE, margin: float = CAMERA_LIMITS.margin
) -> None:
    """Point a plotter's camera at a surface as a view requests.

    PyVista does not change a camera that is set, even if it clips objects that are added later; so
    the clipping range follows the bounds of the objects, and otherwise stays. Raises a FieldError
    when the view's camera, zoom or focus, or the margin, is invalid.
    """
    renderer = plotter.renderer
    apply_camera(view.first_camera(surface, aspect_of(plotter), margin), plotter.camera)
    plotter.camera_set = True
    renderer.reset_camera_clipping_range()
    FrameSteps.of(renderer).add(Step.CLIPPING, _follow_bounds)
    _bounds[renderer] = renderer.ComputeVisiblePropBounds()


def _follow_bounds(renderer: pv.Renderer) -> None:
    """Set the clipping range again before a frame if the bounds of the objects have changed."""
    bounds = renderer.ComputeVisiblePropBounds()
    if bounds != _bounds[renderer]:
        renderer.ResetCameraClippingRange()
    _bounds[renderer] = bounds


def aspect_of(plotter: Any) -> float:
    """Return the width over the height of the part of the window that is being added to."""
    width, height = plotter.window_size
    left, bottom, right, top = plotter.renderer.GetViewport()
    return float(width * (right - left)) / max(float(height * (top - bottom)), 1.0)


def open_plotter(
    scenes: Sequence[Scene],
    view: ViewOptions,
    size: tuple[int, int],
    *,
    margin: float = CAMERA_LIMITS.margin,
    outline_samples: int = 0,
    labels: bool = True,
    bars: Bars = "usual",
    scalar_bar_args: Mapping[str, Any] | None = None,
    **options: Any,
) -> tuple[Any, list[FlowHandle]]:
    """Return a plotter with one scene or two side by side, and the handles of their textures.

    The ``options`` go to the PyVista plotter. Two scenes share a camera, and labels show how they
    differ. Scenes have their usual ``bars`` of colours, only those that users ask for, or none.

    Raises
    ------
    FieldError
        When the view has axes, which only browsers draw.
    """
    if view.axes is not None:
        raise FieldError(
            f"axes is {view.axes!r}, but only browsers draw axes; omit it, or draw a figure with "
            "flowtex.axes"
        )
    plotter: Any = pv.Plotter(
        window_size=list(size), shape=(1, len(scenes)), border=False, **options
    )
    try:
        plotter.set_background(view.ground)
        if outline_samples:
            plotter.enable_anti_aliasing("msaa", multi_samples=outline_samples)
        else:
            plotter.disable_anti_aliasing()
        handles = []
        for column, scene in enumerate(scenes):
            plotter.subplot(0, column)
            may_have_bar = bars == "usual"
            if bars == "asked":
                may_have_bar = scene.appearance.show_scalar_bar is True
            handle = plotter.flowtex.add_scene(
                scene, scalar_bar_args=scalar_bar_args, may_have_bar=may_have_bar
            )
            handles.append(handle)
            if labels and len(scenes) > 1:
                text = difference_text(scene, view.beside or {})
                label = plotter.add_text(text, font_size=9, color="black")
                label.prop.background_color = "white"
                label.prop.background_opacity = 0.8
        if len(scenes) > 1:
            plotter.link_views()
            plotter.subplot(0, 0)
        point_camera(plotter, scenes[0].whole.surface, view, margin)
    except BaseException:
        plotter.close()
        raise
    return plotter, handles


def read_bodies(plotter: pv.BasePlotter, shown: FlowHandle) -> tuple[Bodies, list[str]]:
    """Return the other objects of a scene, and those left out with the reasons.

    Meshes become triangles and pieces of lines with the colours of their mapper; volumes, images,
    and actors in window coordinates are left out and named.
    """
    meshes: list[Body] = []
    labels: list[Label] = []
    left_out: list[str] = []
    room = MOST_VERTICES
    renderer = shown.renderer
    for name, actor in _actors(plotter, shown):
        try:
            if actor not in renderer.actors.values():
                raise FieldError("in another part of the window")
            if isinstance(actor, pv.Actor) or actor.IsA("vtkActor"):
                bodies = [body for body in _bodies(actor) if len(body.points)]
                size = sum(len(body.points) for body in bodies)
                if size > room:
                    raise FieldError(
                        f"{size:,} vertices exceed the {room:,} that are left of "
                        f"{MOST_VERTICES:,} in all; decimate the mesh, or extract a part"
                    )
                room -= size
                meshes += bodies
            else:
                labels += _labels(actor)
        except FieldError as reason:
            left_out.append(f"{name!r} ({reason})")
    if len(labels) > MOST_LABELS:
        left_out.append(f"{len(labels) - MOST_LABELS:,} labels beyond the limit of {MOST_LABELS}")
    if meshes:
        lights = tuple(_lights(renderer))
    else:
        lights = ()
    return Bodies(tuple(meshes), tuple(labels[:MOST_LABELS]), lights), left_out


def _actors(plotter: pv.BasePlotter, shown: FlowHandle) -> Iterator[tuple[str, Any]]:
    """Yield the visible actors of a plotter, except the flow and its legend."""
    flows = {id(handle.actor) for handle in plotter.flowtex}
    bar = dict(plotter.scalar_bars.items()).get(shown.bar.key)
    for renderer in plotter.renderers:
        for name, actor in renderer.actors.items():
            if actor in (shown.actor, bar) or not actor.GetVisibility():
                continue
            if id(actor) in flows:
                name = f"{name}, another flow"
            yield name.partition("(Addr")[0], actor


def _bodies(actor: Any) -> Iterator[Body]:
    """Yield the faces, the lines and the points of an actor."""
    mapper = actor.GetMapper()
    prop = actor.GetProperty()
    data = None
    if mapper.GetInputAlgorithm() is not None:
        mapper.GetInputAlgorithm().Update()  # no frame may have been drawn yet
        data = mapper.GetInputDataObject(0, 0)
    if mapper.IsA("vtkCompositePolyDataMapper"):
        blocks = [block for block in pv.wrap(data).recursive_iterator() if block is not None]
    elif data is not None and data.IsA("vtkDataSet"):
        blocks = [pv.wrap(data)]
    else:
        raise FieldError(f"drawn by {mapper.GetClassName()}, which cannot be sent to a browser")
    if actor.GetTexture() is not None:
        raise FieldError("coloured by a texture")
    matrix = pv.array_from_vtkmatrix(actor.GetMatrix())
    for block in blocks:
        yield from _parts_of(_coloured(block, mapper, prop).transform(matrix, inplace=False), prop)


def _coloured(mesh: pv.DataSet, mapper: Any, prop: vtkProperty) -> pv.PolyData:
    """Return the surface of a mesh with no other arrays than colours and normals."""
    plain = vtkDataSetMapper()
    plain.ShallowCopy(mapper)
    plain.InterpolateScalarsBeforeMappingOff()  # else it maps to a texture
    mapped = plain.MapScalars(mesh, 1.0)  # at points or cells; none without scalars
    copy = mesh.copy(deep=False)
    if isinstance(mesh, pv.PolyData):
        normals = mesh.point_data.active_normals
    else:
        normals = None
    copy.clear_data()
    if mapped is None:
        colours = np.tile(_bytes((*prop.GetColor(), 1.0)), (mesh.n_points, 1))
    else:
        colours = np.array(pv.convert_array(mapped))
    opacity = prop.GetOpacity() * colours[:, 3]
    colours[:, 3] = np.where(opacity < 255, np.minimum(np.rint(opacity), 254), 255)
    on_points = len(colours) == mesh.n_points
    if on_points:
        copy.point_data[COLOURS] = colours
    else:
        copy.cell_data[COLOURS] = colours
    if normals is not None and prop.GetInterpolation():
        copy.point_data.active_normals = normals
    if isinstance(copy, pv.PolyData):
        return copy
    return copy.extract_surface(algorithm=None)


def _parts_of(surface: pv.PolyData, prop: vtkProperty) -> Iterator[Body]:
    """Yield the faces, lines and points of a surface, and the edges of its faces."""
    style = prop.GetRepresentationAsString()
    width = prop.GetLineWidth()
    if style == "Points":
        points = surface.cell_data_to_point_data()
        numbers = np.repeat(np.arange(points.n_points)[:, None], 2, axis=1)
        yield _body(points, numbers, 0, width=prop.GetPointSize())
        return
    plain = surface.triangulate(pass_verts=True, pass_lines=True)  # also parts polylines
    yield _body(plain, plain.verts.reshape(-1, 2)[:, [1, 1]], 0, width=prop.GetPointSize())
    yield _body(plain, plain.lines.reshape(-1, 3)[:, 1:], plain.n_verts, width=width)
    edges = surface.extract_all_edges()
    ends = edges.lines.reshape(-1, 3)[:, 1:]
    if style == "Wireframe":
        yield _body(edges, ends, 0, width=width)
        return
    light = {}
    if prop.GetLighting():
        light = {"ambient": prop.GetAmbient(), "diffuse": prop.GetDiffuse()}
    first = plain.n_verts + plain.n_lines
    yield _body(plain, plain.regular_faces.reshape(-1, 3), first, **light)
    if prop.GetEdgeVisibility():
        yield _body(edges, ends, 0, width=width, colour=prop.GetEdgeColor())


def _body(mesh: pv.PolyData, cells: Indices, first: int, colour: Any = None, **look: float) -> Body:
    """Return triangles or pieces of lines from a first cell on, apart if cells have colours."""
    count = cells.shape[1]
    if COLOURS in mesh.cell_data:
        own = np.asarray(mesh.cell_data[COLOURS])[first : first + len(cells)]
        colours = np.repeat(own, count, axis=0)
        used = cells.ravel()
        cells = np.arange(cells.size).reshape(cells.shape)
    else:
        used, numbers = np.unique(cells, return_inverse=True)
        cells = numbers.reshape(cells.shape)
        colours = mesh.point_data[COLOURS][used]
    if colour is not None:
        colours = np.concatenate([np.tile(_bytes(colour), (len(used), 1)), colours[:, 3:]], axis=1)
    if count == 3:
        faces = cells
    else:
        faces = np.zeros((0, 3), np.intp)
    if count == 2:
        pieces = cells
    else:
        pieces = np.zeros((0, 2), np.intp)
    normals: Any = mesh.point_data.active_normals
    if normals is not None:
        normals = np.asarray(normals, dtype=float)[used]
    points = np.asarray(mesh.points, dtype=float)[used]
    return Body(points, np.asarray(colours), faces, pieces, normals=normals, **look)


def _plain(values: Iterable[float]) -> tuple[float, ...]:
    return tuple(map(float, values))


def _bytes(colour: ArrayLike) -> Bytes:
    return np.rint(255 * np.asarray(colour)).astype(np.uint8)


def _labels(actor: Any) -> Iterator[Label]:
    """Yield the labels of an actor."""
    if actor.IsA("vtkActor2D"):
        mapper = actor.GetMapper()
    else:
        mapper = None
    if mapper is None or not mapper.IsA("vtkLabelPlacementMapper"):
        raise FieldError(f"{actor.GetClassName()}, neither a mesh nor a point label")
    hierarchy = source = mapper.GetInputAlgorithm()
    name = hierarchy.GetLabelArrayName()
    look = hierarchy.GetTextProperty()
    while source.IsA("vtkPointSetToLabelHierarchy") or source.IsA("vtkSelectVisiblePoints"):
        source = source.GetInputAlgorithm()  # before what hides labels from the present camera
    source.Update()
    points = pv.wrap(source.GetOutputDataObject(0))
    texts = points.GetPointData().GetAbstractArray(name)
    has_plate = mapper.GetShape() != mapper.NONE
    if has_plate:
        opacity = mapper.GetBackgroundOpacity()
    else:
        opacity = 0.0
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
            if light.is_headlight:
                toward = np.array([0.0, 0.0, 1.0])
            color = light.intensity * np.asarray(light.diffuse_color.float_rgb)
            yield Light(
                _plain(toward / np.linalg.norm(toward)),
                _plain(color),
                turns=not light.is_scene_light,
            )
