"""Overlays above and below a flow, as VTK actors that follow the actor of the flow.

They have its visibility and its place, cannot be picked, and do not affect the bounds. Lines and
dots have the same width in pixels everywhere. Overlays of the Earth are coasts, meridians and
parallels, and land and the globe below. Overlays of the structure show the nearest time step.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkRenderingCore import vtkCamera

from flowtex._util.array_types import Bools, Floats
from flowtex._util.forks import renew_after_fork
from flowtex._util.progress import pool
from flowtex.field.earth.coast import Coast
from flowtex.field.earth.projection import EARTH_RADIUS
from flowtex.rendering.camera import read_camera
from flowtex.rendering.map_overlay import (
    SPACING_PX,
    SPACINGS,
    STROKES,
    USUAL_HEIGHT_PX,
    WIDTH_RANGE,
    globe_radius,
    ground_cells,
    map_lines,
    missing_colour,
)
from flowtex.rendering.shaders import const
from flowtex.rendering.structure import STRUCTURE
from flowtex.rendering.vtk import FlowSurface
from flowtex.rendering.vtk.frame import FrameSteps, Step
from flowtex.rendering.vtk.layer import insert_text, plain_actor
from flowtex.rendering.webgl.marks import RIM_COLOR, RIM_OPACITY, strokes
from flowtex.scene.options import coast_of, is_drawn
from flowtex.scene.scene import Scene

#: Distance of land behind a flat surface, as a share of the distance from the eye.
LAND_FARTHER = 2e-4
#: Pixels by which land on a globe is lower: coarse triangles sink by up to this many.
LAND_LOWER_PX = 0.5
GLOBE_LOWER_PX = 1.0  #: Pixels by which the globe is lower, which is below land as well.
#: Least distance at which the front of the globe is drawn, as a share of the farthest one.
NEAREST = 1e-3
GLOBE_CELLS = 180  #: Cells along a meridian of the globe below the surface.
#: Structures are found one after the other, in the background.
_pool = pool(1, "flowtex-structure")


class Part(NamedTuple):
    """One actor, its share of nearness, its width in pixels, and forms of its mesh."""

    actor: pv.Actor
    nearer: float
    width: float = 0.0
    forms: tuple[tuple[float, pv.PolyData], ...] = ()
    lower: float = 0.0  #: Pixels by which it lies closer to the centre of the globe.


#: How much nearer than the surface lines are, as a share of the distance: more than an inclined
#: surface comes nearer over the width of a line.
LINES_NEARER = 1e-2
ABOVE_SHARE = 0.2  #: Additional nearness of a line for each line below it, as a share of that.
POINTS = vtkDataObject.FIELD_ASSOCIATION_POINTS
#: Point array of a line mesh: the other end of each segment. The shader uses the same name.
OTHER = "flowtexOther"
SIDE = "flowtexSide"  #: Point array of a line mesh: the side of the line.


class Overlay:
    """Actors that follow the actor of a flow.

    The ``surface`` has the number of pixels for one of the settings.
    """

    def __init__(
        self, actor: pv.Actor, renderer: pv.Renderer, scene: Scene, surface: FlowSurface
    ) -> None:
        self._actor = actor
        self._renderer = weakref.ref(renderer)
        self._surface = surface
        self._parts: list[Part] = []
        FrameSteps.of(renderer).add(Step.OVERLAYS, self._before_frame)
        self.show(scene)

    def show(self, scene: Scene) -> None:
        """Follow the appearance, the settings and the time of a scene.

        Raises
        ------
        NotImplementedError
            In this class; each overlay has its own method.
        """
        raise NotImplementedError

    def close(self) -> None:
        """Remove everything from the renderer."""
        self._clear()
        if (renderer := self._renderer()) is not None:
            FrameSteps.of(renderer).remove(self._before_frame)

    def _add_lines(
        self,
        forms: tuple[tuple[float, pv.PolyData], ...],
        width: float,
        color: Any,
        opacity: float,
        *,
        above: int | None = None,
    ) -> None:
        """Add lines of a width in pixels; those with ``above`` hide the ones below it."""
        nearer = LINES_NEARER * (1 + ABOVE_SHARE * (above or 0))
        variant: frozenset[str] = frozenset()
        if above is not None:
            variant = frozenset({"FLOWTEX_OPAQUE"})
        mesh = forms[-1][1]
        actor = self._add(mesh, nearer, "line_", variant, width=width, forms=forms)
        for name in (OTHER, SIDE):
            actor.mapper.MapDataArrayToVertexAttribute(name, name, POINTS, -1)
        if above is None:
            actor.ForceTranslucentOn()  # after the flow and its tiles
        else:
            actor.ForceOpaqueOn()  # VTK mixes translucent actors regardless of the order
        actor.prop.color = color
        actor.prop.opacity = opacity
        actor.prop.lighting = False

    def _add(
        self,
        mesh: pv.PolyData,
        nearer: float,
        prefix: str = "map_",
        variant: frozenset[str] = frozenset(),
        **options: Any,
    ) -> pv.Actor:
        """Show a mesh that moves with the flow, and return its actor; options are of a part."""
        actor = plain_actor(mesh)
        actor.SetUserMatrix(self._actor.GetMatrix())
        insert_text(actor, "flowtex overlay", prefix, variant)
        self._parts.append(Part(actor, nearer, **options))
        if (renderer := self._renderer()) is not None:
            renderer.AddActor(actor)
        return actor

    def _clear(self) -> None:
        renderer = self._renderer()
        for part in self._parts:
            if renderer is not None:
                renderer.RemoveActor(part.actor)
        self._parts = []

    def _before_frame(self, renderer: pv.Renderer) -> None:
        """Follow the flow's actor, the camera, and the size of the picture's pixels."""
        if not self._parts:
            return
        is_visible = bool(self._actor.GetVisibility())
        camera = renderer.GetActiveCamera()
        near, far = camera.GetClippingRange()
        # The depth in clip space by which a point comes nearer by its distance.
        nearer = 2 * near * far / (far - near)
        if camera.GetParallelProjection():
            nearer = 2 * camera.GetDistance() / (far - near)
        viewport = [*map(float, renderer.GetOrigin()), *map(float, renderer.GetSize())]
        height = renderer.GetSize()[1]
        density = self._surface.view.density
        full_height = self._surface.full_height or height
        whole_height = self._surface.whole_height or full_height
        # Lines of a large picture are wider, not by as much as it is larger.
        width = np.clip(np.sqrt(whole_height / density / USUAL_HEIGHT_PX), *WIDTH_RANGE)
        pixel = float(width) * density * height / full_height
        pixel_share = self._pixel_share()
        finest = SPACING_PX * self._surface.view.pixel * self._surface.view.density
        for part in self._parts:
            part.actor.SetVisibility(is_visible)
            uniforms = part.actor.GetShaderProperty().GetVertexCustomUniforms()
            uniforms.SetUniformf("flowtexNearer", part.nearer * nearer)
            uniforms.SetUniformf("flowtexLower", part.lower * pixel_share)
            if part.forms:
                mesh = next(mesh for spacing, mesh in part.forms if spacing <= finest)
                if mesh is not part.actor.mapper.dataset:
                    part.actor.mapper.dataset = mesh
                uniforms.SetUniformf("flowtexRadius", 0.5 * part.width * pixel)
                uniforms.SetUniform4f("flowtexViewport", viewport)

    def _pixel_share(self) -> float:
        """Return the length of a pixel in radii of the Earth, in perspective at a distance of 1."""
        view = self._surface.view
        eye = view.eye
        if not eye[3]:
            return view.pixel / EARTH_RADIUS
        matrix = pv.array_from_vtkmatrix(self._actor.GetMatrix())
        scale = np.linalg.norm(matrix[:3, 0])
        distance = np.linalg.norm(eye[:3] - view.focus)
        return float(view.pixel / (distance * scale * EARTH_RADIUS))


def piece_mesh(start: Floats, end: Floats) -> pv.PolyData:
    """Return pieces of lines (N, 3) for the shader: four points for each.

    A piece whose ends are one is a dot.
    """
    points = np.stack([start, start, end, end], axis=1).reshape(-1, 3)
    other = np.stack([end, end, start, start], axis=1).reshape(-1, 3)
    faces: Any = np.arange(len(points)).reshape(-1, 4)
    mesh = pv.PolyData.from_regular_faces(points, faces)
    mesh.point_data[OTHER] = other.astype(np.float32)
    # Left and right change places at the other end.
    mesh.point_data[SIDE] = np.tile(np.array([1, -1, 2, -2], dtype=np.float32), len(start))
    return mesh


class MapOverlay(Overlay):
    """The Earth behind one flow whose field has a projection."""

    _field: Any = None  #: The whole field for which the lines were made.
    _radius: float | None = None

    def show(self, scene: Scene) -> None:
        """Follow the appearance, and the coarsest level of a large field."""
        if self._field is not scene.whole:
            self._field = scene.whole
            self._lines: dict[
                tuple[str, bool, Coast | None], tuple[tuple[float, pv.PolyData], ...]
            ] = {}
        self._clear()
        self._missing: list[pv.Actor] = []
        self._scene = scene
        self._radius = None
        appearance = scene.appearance
        if scene.field.projection is None:
            return
        if appearance.land is not None:
            self._add_land(appearance.land)
        for option, stroke in STROKES.items():
            if is_drawn(getattr(appearance, option)) and (forms := self._forms_of(option)):
                self._add_lines(forms, stroke.width, stroke.color, stroke.opacity)

    @property
    def has_missing(self) -> bool:
        """Whether places without data are drawn, which are no land."""
        return bool(self._missing)

    def _forms_of(self, option: str) -> tuple[tuple[float, pv.PolyData], ...]:
        """Return the lines of an option, coarse to fine, made once; none far from a coast."""
        has_globe = self._radius is not None
        coast = coast_of(self._scene.appearance)
        if (option, has_globe, coast) not in self._lines:
            found = map_lines(self._field, has_globe=has_globe, coast=coast)
            for name, whole in found.items():
                self._lines[name, has_globe, coast] = ()
                for spacing in SPACINGS:
                    if spacing:
                        lines = whole.thinned(spacing)
                    else:
                        lines = whole
                    if len(lines.points):
                        first = np.delete(np.arange(len(lines.points)), lines.starts[1:] - 1)
                        mesh = piece_mesh(lines.points[first], lines.points[first + 1])
                        self._lines[name, has_globe, coast] += ((spacing, mesh),)
        return self._lines[option, has_globe, coast]

    def _add_land(self, color: Any) -> None:
        """Draw land and cells without data, and the globe where the field does not cover it."""
        meshes: list[tuple[pv.PolyData, float, Any]] = []
        # Behind a transparent flow there is the background instead of land.
        tiled = self._scene.pyramid is not None and self._scene.appearance.opacity == 1
        coast = coast_of(self._scene.appearance)
        ground = ground_cells(self._field, tiled=tiled, coast=coast)
        if ground.land.any():
            meshes.append((self._mesh_of(ground.land), LAND_LOWER_PX, color))
        if ground.missing.any():
            meshes.append((self._mesh_of(ground.missing), LAND_LOWER_PX, None))
        self._radius = globe_radius(self._field)
        if self._radius is not None:
            around = 2 * GLOBE_CELLS
            along = GLOBE_CELLS
            globe = pv.Sphere(radius=self._radius, theta_resolution=around, phi_resolution=along)
            meshes.append((globe, GLOBE_LOWER_PX, None))
        for mesh, lower, own_color in meshes:
            if self._field.surface.on_globe:
                mesh.point_data.active_normals = mesh.points / np.linalg.norm(
                    mesh.points, axis=1, keepdims=True
                )
                actor = self._add(mesh, 0.0, lower=lower)
            else:
                actor = self._add(mesh, -LAND_FARTHER)
            self._colour_ground(actor, own_color)

    def _mesh_of(self, cells: Bools) -> pv.PolyData:
        faces = self._field.surface.nodes_of(cells)
        points, numbers = np.unique(faces, return_inverse=True)
        places: Any = self._field.surface.points.reshape(-1, 3)[points]
        return pv.PolyData.from_regular_faces(places, numbers.reshape(faces.shape))

    def _colour_ground(self, actor: pv.Actor, color: Any) -> None:
        """Give ground its colour and light; without a colour it follows the background."""
        is_lit = self._scene.is_lit
        actor.prop.lighting = is_lit
        if color is None:
            self._missing.append(actor)
        else:
            actor.prop.color = color
        if is_lit:
            actor.prop.ambient = const.AMBIENT_LIGHT
            actor.prop.diffuse = const.DIFFUSE_LIGHT

    def _before_frame(self, renderer: pv.Renderer) -> None:
        """Set the colour of places without data, and include the globe in what the camera sees."""
        for actor in self._missing:
            actor.prop.color = missing_colour(renderer.GetBackground())
        if self._radius is not None and self._actor.GetVisibility():
            self._include_globe(renderer.GetActiveCamera(), self._radius)
        super()._before_frame(renderer)

    def _include_globe(self, camera: vtkCamera, radius: float) -> None:
        """Extend the clipping range to the globe, which has no bounds in VTK."""
        near, far = camera.GetClippingRange()
        matrix = pv.array_from_vtkmatrix(self._actor.GetMatrix())
        view = read_camera(camera)
        depth = float(np.subtract(matrix[:3, 3], view.position) @ view.axes[2])
        radius *= float(np.linalg.norm(matrix[:3, 0]))
        far = max(far, depth + radius)
        near = min(near, max(depth - radius, NEAREST * far))
        camera.SetClippingRange(near, far)


class StructureOverlay(Overlay):
    """The structure of one flow, as the settings request it."""

    _shown: tuple[object, ...] = ()
    _request: tuple[object, ...] = ()
    _found: Future[None] | None = None
    #: Called in a thread at the end of a search; ``None`` if drawing waits for the search.
    notify: Callable[[], None] | None = None

    @property
    def busy(self) -> bool:
        """Whether a search still runs in the background."""
        return self._found is not None and not self._found.done()

    def renew(self) -> None:
        """Forget, in a forked process, a search by a thread of the process before."""
        if self.busy:
            self._request = ()
            self._found = None

    @property
    def _key(self) -> tuple[object, ...]:
        """All that determines which structure is drawn."""
        scene = self._scene
        settings = self._scene.settings
        counts = settings.critical_points, settings.separatrices, int(settings.nullclines)
        window = None
        if self._window is not None:
            window = self._window.tobytes()
        return id(scene.field), scene.step, *counts, window

    @property
    def _window(self) -> Floats | None:
        """The part of the plane in which nullclines are drawn, or ``None`` for all of it."""
        view = self._surface.view
        renderer = self._renderer()
        if not self._scene.settings.nullclines or renderer is None:
            return None
        return self._scene.structure.window(view.focus, view.pixel * max(renderer.GetSize()))

    def show(self, scene: Scene) -> None:
        """Follow the settings and the time of a scene."""
        self._scene = scene
        self._update()

    def _before_frame(self, renderer: pv.Renderer) -> None:
        self._update()
        super()._before_frame(renderer)

    def _update(self) -> None:
        """Draw the requested structure if it changes, or find it in the background first."""
        if self._shown == self._key:
            return
        self._clear()
        self._shown = ()
        scene = self._scene
        settings = self._scene.settings
        if not any(getattr(settings, name) for name in STRUCTURE):
            return
        request = (scene.step, settings.critical_points, settings.separatrices)
        if any(request[1:]) and self.notify is not None and not scene.structure.has(*request):
            if self._request != (scene.structure, request):
                self._request = (scene.structure, request)
                notify = self.notify
                self._found = _pool.submit(scene.structure.find, *request)
                renew_after_fork(self)
                self._found.add_done_callback(lambda _: notify())
            return
        self._shown = self._key
        drawn = strokes(scene.structure, settings, scene.step, self._window)
        for pieces, color, width, above in drawn:
            if not len(pieces):
                continue
            forms = ((0.0, piece_mesh(pieces[:, 0], pieces[:, 1])),)
            if color == RIM_COLOR:
                opacity = RIM_OPACITY
            else:
                opacity = 1.0
            self._add_lines(forms, width, color, opacity, above=above)
