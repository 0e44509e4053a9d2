"""Overlays above and below a flow, as VTK actors that follow the actor of the flow.

They have its visibility and its place, cannot be picked, and do not affect the bounds. Lines and
dots have the same width in pixels everywhere.
"""

from __future__ import annotations

import weakref
from typing import Any, NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkRenderingCore import vtkCamera

from flowtex._util.array_types import Floats
from flowtex.rendering.map_overlay import SPACING_PX, USUAL_HEIGHT_PX, WIDTH_RANGE
from flowtex.rendering.shaders import shader_text
from flowtex.rendering.vtk import FlowSurface
from flowtex.rendering.vtk.layer import weak_callback
from flowtex.rendering.vtk.mesh import FlowMapper


class Part(NamedTuple):
    """One actor, its share of nearness, its width in pixels, and forms of its mesh."""

    actor: pv.Actor
    nearer: float
    width: float = 0.0
    forms: tuple[tuple[float, pv.PolyData], ...] = ()


#: How much nearer than the surface lines are, as a share of the distance: more than an inclined
#: surface comes nearer over the width of a line.
LINES_NEARER = 1e-2
#: Additional nearness of a line for each line below it, as a share of that.
ABOVE_SHARE = 0.2
#: Observers of a frame run by falling priority: this one after those that set the clipping range.
LAST = -1.0
OWNER = "flowtex overlay"
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


class Overlay:
    """Actors that follow the actor of a flow.

    The ``surface`` has the number of pixels for one of the settings.
    """

    def __init__(self, actor: pv.Actor, renderer: pv.Renderer, surface: FlowSurface) -> None:
        self._actor, self._renderer = actor, weakref.ref(renderer)
        self._surface = surface
        self._parts: list[Part] = []
        callback: Any = weak_callback(self._before_frame)
        self._observed = renderer.AddObserver("StartEvent", callback, LAST)

    def close(self) -> None:
        """Remove everything from the renderer."""
        self._clear()
        if (renderer := self._renderer()) is not None:
            renderer.RemoveObserver(self._observed)

    def _add_lines(
        self,
        forms: tuple[tuple[float, pv.PolyData], ...],
        width: float,
        color: Any,
        opacity: float,
        *,
        above: int | None = None,
    ) -> None:
        """Add lines of a width in pixels, as meshes by the distances of their points.

        Lines ``above`` this many others hide them; without a number they are translucent.
        """
        nearer = LINES_NEARER * (1 + ABOVE_SHARE * (above or 0))
        variant = frozenset() if above is None else frozenset({"FLOWTEX_OPAQUE"})
        actor = self._add(forms[-1][1], nearer, LINE_REPLACEMENTS, variant)
        self._parts[-1] = Part(actor, nearer, width, forms)
        for name in (OTHER, SIDE):
            actor.mapper.MapDataArrayToVertexAttribute(name, name, POINTS, -1)
        if above is None:
            actor.ForceTranslucentOn()  # after the flow and its tiles
        else:
            actor.ForceOpaqueOn()  # VTK mixes translucent actors regardless of the order
        actor.prop.color, actor.prop.opacity = color, opacity
        actor.prop.lighting = False

    def _add(
        self,
        mesh: pv.PolyData,
        nearer: float,
        replacements: Replacements = REPLACEMENTS,
        variant: frozenset[str] = frozenset(),
    ) -> pv.Actor:
        mapper = FlowMapper(mesh)
        mapper.scalar_visibility = False
        mapper.SetVBOShiftScaleMethod(0)  # which would not apply to the other ends
        actor = pv.Actor(mapper=mapper)
        actor.PickableOff()
        actor.UseBoundsOff()
        actor.SetUserMatrix(self._actor.GetMatrix())
        for shader, mark, names in replacements:
            text = "\n".join((mark, *(shader_text(name, variant) for name in names)))
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
        self._parts = []

    def _look(self, camera: vtkCamera) -> None:
        """Follow a camera that sees the flow."""

    def _before_frame(self) -> None:
        """Follow the flow's actor, the camera, and the size of the picture's pixels."""
        renderer = self._renderer()
        if renderer is None or not self._parts:
            return
        is_visible = bool(self._actor.GetVisibility())
        if is_visible:
            self._look(renderer.GetActiveCamera())
        nearer = _depth_of_share(renderer.GetActiveCamera())
        viewport = [*map(float, renderer.GetOrigin()), *map(float, renderer.GetSize())]
        height, density = renderer.GetSize()[1], self._surface.view.density
        full_height = self._surface.full_height or height
        whole_height = self._surface.whole_height or full_height
        # Lines of a large picture are wider, not by as much as it is larger.
        width = np.clip(np.sqrt(whole_height / density / USUAL_HEIGHT_PX), *WIDTH_RANGE)
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


def _depth_of_share(camera: vtkCamera) -> float:
    """Return the change of the depth in clip space that brings a point nearer by its distance."""
    near, far = camera.GetClippingRange()
    if camera.GetParallelProjection():
        return float(2 * camera.GetDistance() / (far - near))
    return float(2 * near * far / (far - near))


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
