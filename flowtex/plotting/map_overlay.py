"""Coasts, meridians and parallels over a flow, and land and the globe under it, as VTK actors.

They stand beside the flow's own actor and follow it: its visibility and its place. Nothing of them
can be picked, and no camera is fitted to them.
"""

from __future__ import annotations

import weakref
from typing import Any, NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkDataObject

from flowtex._util.array_types import Bools
from flowtex.earth import MapLines
from flowtex.field import FlowField
from flowtex.plotting.vtk_camera import read_camera
from flowtex.rendering.constants import AMBIENT_LIGHT, DIFFUSE_LIGHT
from flowtex.rendering.map_overlay import (
    SPACING_PX,
    SPACINGS,
    STROKES,
    USUAL_HEIGHT_PX,
    WIDTH_RANGE,
    globe_radius,
    land_cells,
    map_lines,
)
from flowtex.rendering.shaders import shader_text
from flowtex.rendering.vtk import FlowSurface
from flowtex.rendering.vtk.mesh import FlowMapper
from flowtex.scene import Scene


class Part(NamedTuple):
    """One actor: how it is nearer than the surface, its width in pixels, and forms of its mesh."""

    actor: pv.Actor
    nearer: float
    width: float = 0.0
    forms: tuple[tuple[float, pv.PolyData], ...] = ()


#: How much nearer than the surface lines are, and how much farther land, as a share of the
#: distance: more than what a surface comes nearer over the width of a line when seen aslant.
LINES_NEARER, LAND_FARTHER = 1e-2, 2e-4
#: Pixels by which the globe is lower: coarse triangles sink by up to as many.
GLOBE_LOWER_PX = 0.5
#: Nearest that the front of the globe is drawn, as a share of the farthest.
NEAREST = 1e-3
#: Cells along a meridian of the globe below the surface.
GLOBE_CELLS = 180
#: Observers of a frame run by falling priority: this one after those that set the clipping range.
LAST = -1.0
OWNER = "flowtex map"
POINTS = vtkDataObject.FIELD_ASSOCIATION_POINTS
Replacements = tuple[tuple[str, str, tuple[str, ...]], ...]
#: Shader, the mark of VTK after which our text is inserted, and our files, of land and of lines.
REPLACEMENTS: Replacements = (("vertex", "//VTK::PositionVC::Impl", ("vtk/map_vertex_impl.glsl",)),)
LINE_REPLACEMENTS: Replacements = (
    ("vertex", "//VTK::PositionVC::Dec", ("vtk/line_vertex_dec.glsl",)),
    (
        "vertex",
        "//VTK::PositionVC::Impl",
        ("vtk/map_vertex_impl.glsl", "vtk/line_vertex_impl.glsl"),
    ),
    ("fragment", "//VTK::PositionVC::Dec", ("vtk/line_fragment_dec.glsl",)),
    ("fragment", "//VTK::Light::Impl", ("vtk/line_fragment_impl.glsl",)),
)
#: Point arrays of a line's mesh, by the names of the shader's attributes.
OTHER, SIDE = "flowtexOther", "flowtexSide"


class MapOverlay:
    """What is drawn of the Earth with one flow, whose field has a projection.

    The ``surface`` tells how many pixels there are for one of the settings'.
    """

    def __init__(self, actor: pv.Actor, renderer: Any, scene: Scene, surface: FlowSurface) -> None:
        self._actor, self._renderer = actor, weakref.ref(renderer)
        self._scene, self._surface = scene, surface
        self._field = scene.whole
        self._lines: dict[tuple[str, bool], tuple[tuple[float, pv.PolyData], ...]] = {}
        self._parts: list[Part] = []
        self._radius: float | None = None
        this = weakref.WeakMethod(self._before_frame)

        def follow(caller: Any, event: str) -> None:
            del caller, event
            if (method := this()) is not None:
                method()

        self._observed = renderer.AddObserver("StartEvent", follow, LAST)
        self.show()

    def show(self) -> None:
        """Follow the appearance, and the level that is the whole of a large field."""
        if self._field is not self._scene.whole:
            self._field, self._lines = self._scene.whole, {}
        self._clear()
        appearance = self._scene.appearance
        if appearance.land is not None:
            self._add_land(appearance.land)
        for option, stroke in STROKES.items():
            if getattr(appearance, option) is not False and (forms := self._forms_of(option)):
                actor = self._add_lines(forms, stroke.width)
                actor.prop.color, actor.prop.opacity = stroke.color, stroke.opacity
                actor.prop.lighting = False

    def close(self) -> None:
        """Take everything out of the renderer."""
        self._clear()
        if (renderer := self._renderer()) is not None:
            renderer.RemoveObserver(self._observed)

    def _forms_of(self, option: str) -> tuple[tuple[float, pv.PolyData], ...]:
        """Return the lines of an option, from coarse to fine; all are made together, once.

        Those of a small field are short, and there are none where no coast comes near it.
        """
        has_globe = self._radius is not None
        if (option, has_globe) not in self._lines:
            for name, lines in map_lines(self._field, has_globe=has_globe).items():
                forms = ((s, lines.thinned(s) if s else lines) for s in SPACINGS)
                self._lines[name, has_globe] = tuple(
                    (s, _line_mesh(form)) for s, form in forms if len(form.points)
                )
        return self._lines[option, has_globe]

    def _add_land(self, color: Any) -> None:
        """Draw cells without data, and the globe where the field does not cover it."""
        is_lit = self._scene.is_lit
        meshes = []
        # Through a flow that is not opaque the background is seen, and no land.
        tiled = self._scene.pyramid is not None and self._scene.appearance.opacity == 1
        if (land := land_cells(self._field, tiled=tiled)).any():
            meshes.append((_cell_mesh(self._field, land), -LAND_FARTHER))
        self._radius = globe_radius(self._field)
        if self._radius is not None:
            around, along = 2 * GLOBE_CELLS, GLOBE_CELLS
            globe = pv.Sphere(radius=self._radius, theta_resolution=around, phi_resolution=along)
            meshes.append((globe, 0.0))
        for mesh, nearer in meshes:
            if self._field.surface.on_globe:
                mesh.point_data.active_normals = mesh.points / np.linalg.norm(
                    mesh.points, axis=1, keepdims=True
                )
            actor = self._add(mesh, nearer)
            actor.prop.color, actor.prop.lighting = color, is_lit
            if is_lit:
                actor.prop.ambient, actor.prop.diffuse = AMBIENT_LIGHT, DIFFUSE_LIGHT

    def _add_lines(self, forms: tuple[tuple[float, pv.PolyData], ...], width: float) -> pv.Actor:
        actor = self._add(forms[-1][1], LINES_NEARER, LINE_REPLACEMENTS)
        self._parts[-1] = Part(actor, LINES_NEARER, width, forms)
        for name in (OTHER, SIDE):
            actor.mapper.MapDataArrayToVertexAttribute(name, name, POINTS, -1)
        actor.ForceTranslucentOn()  # after the flow and its tiles
        return actor

    def _add(
        self, mesh: pv.PolyData, nearer: float, replacements: Replacements = REPLACEMENTS
    ) -> pv.Actor:
        mapper = FlowMapper(mesh)
        mapper.scalar_visibility = False
        mapper.SetVBOShiftScaleMethod(0)  # which would not apply to the other ends
        actor = pv.Actor(mapper=mapper)
        actor.PickableOff()
        actor.UseBoundsOff()
        actor.SetUserMatrix(self._actor.GetMatrix())
        for shader, mark, names in replacements:
            text = "\n".join((mark, *map(shader_text, names)))
            actor.add_shader_replacement(shader, mark, text, _feature_name=OWNER)
        self._parts.append(Part(actor, nearer))
        if (renderer := self._renderer()) is not None:
            renderer.AddActor(actor)
        return actor

    def _clear(self) -> None:
        renderer = self._renderer()
        for part in self._parts:
            if renderer is not None:
                renderer.RemoveActor(part.actor)
        self._parts, self._radius = [], None

    def _before_frame(self) -> None:
        """Follow the flow's actor, the camera, and the size of the picture's pixels."""
        renderer = self._renderer()
        if renderer is None or not self._parts:
            return
        is_visible = bool(self._actor.GetVisibility())
        if is_visible:
            self._include_globe(renderer.GetActiveCamera())
        nearer = _depth_of_share(renderer.GetActiveCamera())
        viewport = [*map(float, renderer.GetOrigin()), *map(float, renderer.GetSize())]
        height, density = renderer.GetSize()[1], self._surface.view.density
        full_height = self._surface.full_height or height
        # Lines of a large picture are wider, not by as much as it is larger.
        width = np.clip(np.sqrt(full_height / density / USUAL_HEIGHT_PX), *WIDTH_RANGE)
        pixel = float(width) * density * height / full_height
        finest = SPACING_PX * self._surface.view.pixel * self._surface.view.density
        for part in self._parts:
            part.actor.SetVisibility(is_visible)
            uniforms = part.actor.GetShaderProperty().GetVertexCustomUniforms()
            uniforms.SetUniformf("flowtexNearer", part.nearer * nearer)
            if part.forms:
                mesh = next(mesh for spacing, mesh in part.forms if spacing <= finest)
                if mesh is not part.actor.mapper.dataset:
                    part.actor.mapper.dataset = mesh
                uniforms.SetUniformf("flowtexRadius", 0.5 * part.width * pixel)
                uniforms.SetUniform4f("flowtexViewport", viewport)
            elif not part.nearer and self._radius is not None:
                part.actor.SetScale(1 - GLOBE_LOWER_PX * self._horizon_pixel() / self._radius)

    def _horizon_pixel(self) -> float:
        """Length that a pixel covers on the horizon, the farthest that is seen of the globe."""
        view, eye = self._surface.view, self._surface.view.eye
        if not eye[3]:
            return view.pixel
        away = np.sqrt(max(float(eye[:3] @ eye[:3]) - (self._radius or 0.0) ** 2, 0.0))
        return view.pixel * float(away / np.linalg.norm(eye[:3] - view.focus))

    def _include_globe(self, camera: Any) -> None:
        """Let the camera see the globe, which is farther than the flow and has no bounds."""
        if self._radius is None:
            return
        near, far = camera.GetClippingRange()
        matrix = self._actor.GetMatrix()
        middle = np.array([matrix.GetElement(k, 3) for k in range(3)])
        view = read_camera(camera)
        depth = float((middle - view.position) @ view.axes[2])
        radius = self._radius * float(np.linalg.norm([matrix.GetElement(k, 0) for k in range(3)]))
        far = max(far, depth + radius)
        near = min(near, max(depth - radius, NEAREST * far))
        camera.SetClippingRange(near, far)


def _depth_of_share(camera: Any) -> float:
    """Change of the depth in clip space that brings a point nearer by its distance."""
    near, far = camera.GetClippingRange()
    if camera.GetParallelProjection():
        return float(2 * camera.GetDistance() / (far - near))
    return float(2 * near * far / (far - near))


def _line_mesh(lines: MapLines) -> pv.PolyData:
    """Return lines as the shader has them: four points for each piece."""
    joined = np.ones(len(lines.points), dtype=bool)
    joined[lines.starts[1:] - 1] = False
    first = np.flatnonzero(joined)
    points = lines.points[np.stack([first, first, first + 1, first + 1], axis=1).ravel()]
    other = lines.points[np.stack([first + 1, first + 1, first, first], axis=1).ravel()]
    faces: Any = np.arange(len(points)).reshape(-1, 4)
    mesh = pv.PolyData.from_regular_faces(points, faces)
    mesh.point_data[OTHER] = other.astype(np.float32)
    # What is to the left on the way there is to the right on the way back.
    mesh.point_data[SIDE] = np.tile(np.array([1, -1, 1, -1], dtype=np.float32), len(first))
    return mesh


def _cell_mesh(field: FlowField, cells: Bools) -> pv.PolyData:
    """Return some cells of a field's surface."""
    faces = field.surface.nodes_of(cells)
    used, numbers = np.unique(faces, return_inverse=True)
    shape: Any = numbers.reshape(faces.shape)
    return pv.PolyData.from_regular_faces(field.surface.points.reshape(-1, 3)[used], shape)
