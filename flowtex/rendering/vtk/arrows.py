"""Arrows that follow the flow, as an actor beside the surface's own one."""

from __future__ import annotations

import weakref
from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.util.vtkConstants import VTK_OBJECT
from vtkmodules.vtkCommonDataModel import vtkDataObject

from flowtex.rendering.arrow_seeds import ArrowSeeds, Seeds
from flowtex.rendering.shaders import shader_text
from flowtex.rendering.tile_choice import TileView
from flowtex.rendering.uniforms import ARROW_PIECES, arrow_distance, has_arrows, is_near, variants
from flowtex.rendering.vtk.layer import FlowLayer, write_uniform
from flowtex.rendering.vtk.mesh import FlowMapper
from flowtex.settings import Settings

OWNER = "flowtex arrows"
#: Shader, the mark of VTK after which our text is inserted, and our file.
REPLACEMENTS = (
    ("vertex", "//VTK::PositionVC::Dec", "vtk/arrow_vertex_dec.glsl"),
    ("vertex", "//VTK::PositionVC::Impl", "vtk/arrow_vertex_impl.glsl"),
    ("fragment", "//VTK::PositionVC::Dec", "vtk/arrow_fragment_dec.glsl"),
    ("fragment", "//VTK::Light::Impl", "vtk/arrow_fragment_impl.glsl"),
)
#: Point arrays by the names of the shader's attributes.
ATTRIBUTES = (
    "flowtexCoordinate",
    "flowtexRibbon",
    "flowtexRadius",
    "flowtexNormal",
    "flowtexCorners",
)


class FlowArrows:
    """The arrows of one layer, in its renderer while the settings ask for them."""

    def __init__(self, layer: FlowLayer, renderer: Any, settings: Settings) -> None:
        self._layer, self._renderer, self._settings = layer, weakref.ref(renderer), settings
        self._seeds = ArrowSeeds(layer.textures.geometry)
        self._drawn: tuple[Seeds, bytes] | None = None
        self._variant: frozenset[str] | None = None
        self.actor = pv.Actor(mapper=FlowMapper(pv.PolyData()))
        self.actor.mapper.scalar_visibility = False
        self.actor.mapper.SetVBOShiftScaleMethod(0)  # the shader takes positions as they are
        self.actor.prop.lighting = False
        self.actor.PickableOff()
        self.actor.UseBoundsOff()
        self.actor.ForceTranslucentOn()  # after the flow
        this = weakref.WeakMethod(self._before_draw)

        def write(caller: Any, event: str, program: Any = None) -> None:
            del caller, event
            if (method := this()) is not None and program is not None:
                method(program)

        write.CallDataType = VTK_OBJECT  # type: ignore[attr-defined]
        self.actor.mapper.AddObserver("UpdateShaderEvent", write)

    def look(self, view: TileView, place: Any) -> None:
        """Have the arrows of a view, on a surface at a place (4, 4)."""
        layer, renderer = self._layer, self._renderer()
        if renderer is None:
            return
        shown = has_arrows(layer.textures, self._settings)
        if shown != bool(renderer.HasViewProp(self.actor)):
            (renderer.AddActor if shown else renderer.RemoveActor)(self.actor)
        if not shown:
            return
        geometry, anchor = layer.textures.geometry, layer.view.anchor
        matrix = np.eye(4)
        matrix[:3, :3] = geometry.frame.T
        matrix[:3, 3] = geometry.center + geometry.frame.T @ anchor
        self.actor.user_matrix = place @ matrix
        seeds = self._seeds.seen(view, arrow_distance(self._settings))
        if self._drawn != (drawn := (seeds, anchor.tobytes())):
            self._drawn = drawn
            self.actor.mapper.dataset = self._mesh(seeds)
        self._write_text()

    def close(self) -> None:
        """Take the arrows out of the renderer."""
        if (renderer := self._renderer()) is not None:
            renderer.RemoveActor(self.actor)

    def _mesh(self, seeds: Seeds) -> pv.PolyData:
        """Ribbons of the seeds: two vertices at each end of a piece."""
        geometry, count = self._layer.textures.geometry, 2 * (ARROW_PIECES + 1)
        number = np.arange(count)
        ribbon = np.stack([number // 2, 2 * (number % 2) - 1], axis=-1)
        strip = 2 * np.arange(ARROW_PIECES)[:, None] + [0, 1, 3, 2]
        faces: Any = (np.arange(len(seeds.cell))[:, None, None] * count + strip).reshape(-1, 4)
        position = np.repeat(seeds.position - self._layer.view.anchor, count, axis=0)
        mesh = pv.PolyData.from_regular_faces(position, faces)
        coordinate = self._seeds.between(geometry.coordinate.reshape(-1, 2), seeds)
        arrays = {"Coordinate": coordinate, "Radius": seeds.radius}
        if not geometry.planar:
            arrays["Normal"] = self._seeds.normals(seeds)
        if geometry.corners is not None:
            arrays["Corners"] = geometry.corners[self._seeds.corners[seeds.cell, 0]]
        for name, values in arrays.items():
            mesh.point_data[f"flowtex{name}"] = np.repeat(values, count, axis=0).astype(np.float32)
        mesh.point_data["flowtexRibbon"] = np.tile(ribbon, (len(seeds.cell), 1)).astype(np.float32)
        mapper = self.actor.mapper
        for name in ATTRIBUTES:
            mapper.RemoveVertexAttributeMapping(name)
            if name in mesh.point_data:
                points = vtkDataObject.FIELD_ASSOCIATION_POINTS
                mapper.MapDataArrayToVertexAttribute(name, name, points, -1)
        return mesh

    def _write_text(self) -> None:
        textures = self._layer.textures
        near = is_near(textures, self._settings, self._layer.view)
        # In triangles the shader needs what only fragments have, to follow the velocity in a cell.
        near = near and textures.geometry.corners is None
        variant = variants(textures, unsteady=textures.store.steps > 1, near=near)
        if variant == self._variant:
            return
        self._variant = variant
        self.actor.clear_shader_replacements(_feature_name=OWNER)
        for shader, mark, name in REPLACEMENTS:
            text = f"{mark}\n{shader_text(name, variant)}"
            self.actor.add_shader_replacement(shader, mark, text, _feature_name=OWNER)

    def _before_draw(self, program: Any) -> None:
        self._layer.before_draw(program)
        if (renderer := self._renderer()) is not None and program.IsUniformUsed("u_picture"):
            write_uniform(program, "u_picture", tuple(map(float, renderer.GetSize())))
