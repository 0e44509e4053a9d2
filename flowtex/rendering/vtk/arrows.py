"""Arrows that follow the flow, as actors beside those of the surface and of its tiles.

Seeds are those of the whole surface, or of the coarsest level. Where a tile is drawn it draws the
arrows there, along its own paths.
"""

from __future__ import annotations

import weakref
from collections.abc import Mapping
from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkRenderingOpenGL2 import vtkShaderProgram

from flowtex._util.array_types import Floats
from flowtex.rendering.arrow_seeds import ArrowSeeds, Seeds, in_tile, vertex_data
from flowtex.rendering.shaders import shader_text
from flowtex.rendering.tile_choice import TileView
from flowtex.rendering.uniforms import ARROW_PIECES, arrow_distance, has_arrows, is_near, variants
from flowtex.rendering.vtk.layer import FlowLayer, observe_draws, write_uniform
from flowtex.rendering.vtk.mesh import FlowMapper
from flowtex.settings import Settings
from flowtex.textures import SurfaceGeometry
from flowtex.textures.tiles import Pyramid, TileKey

OWNER = "flowtex arrows"
#: Shader, the mark of VTK after which our text is inserted, and our file.
REPLACEMENTS = (
    ("vertex", "//VTK::PositionVC::Dec", "vtk/arrow_vertex_dec.glsl"),
    ("vertex", "//VTK::PositionVC::Impl", "vtk/arrow_vertex_impl.glsl"),
    ("fragment", "//VTK::PositionVC::Dec", "vtk/arrow_fragment_dec.glsl"),
    ("fragment", "//VTK::Light::Impl", "vtk/arrow_fragment_impl.glsl"),
)
#: Attribute of the vertices of a ribbon: piece and side.
RIBBON = "flowtexRibbon"


class SurfaceArrows:
    """The arrows of one surface, in its renderer while the settings ask for them."""

    def __init__(self, renderer: pv.Renderer, settings: Settings) -> None:
        self._renderer, self._settings = weakref.ref(renderer), settings
        self._seeds: ArrowSeeds | None = None
        self._drawn: tuple[Any, ...] = ()
        self._parts: dict[TileKey | None, _Arrows] = {}

    def look(
        self,
        layers: Mapping[TileKey | None, FlowLayer],
        pyramid: Pyramid | None,
        view: TileView,
        place: Floats,
    ) -> None:
        """Show the arrows of a view on the layers of a surface at a place (4, 4)."""
        renderer, base = self._renderer(), layers[None]
        if renderer is None or not has_arrows(base.textures, self._settings):
            self.close()
            return
        self._seeds = self._seeds or ArrowSeeds(base.textures.geometry)
        seeds = self._seeds.seen(view, arrow_distance(self._settings))
        drawn = (seeds, *layers.items())
        if drawn != self._drawn:
            self._drawn = drawn
            shared = self._shared(seeds, layers, pyramid)
            for key, part in list(self._parts.items()):
                if key not in shared or part.layer is not layers[key]:
                    renderer.RemoveActor(self._parts.pop(key).actor)
            for key, data in shared.items():
                if key not in self._parts:
                    self._parts[key] = _Arrows(layers[key], renderer, self._settings)
                    renderer.AddActor(self._parts[key].actor)
                self._parts[key].set_data(data)
        for part in self._parts.values():
            part.look(place)

    def close(self) -> None:
        """Remove the arrows from the renderer."""
        for part in self._parts.values():
            if (renderer := self._renderer()) is not None:
                renderer.RemoveActor(part.actor)
        self._parts, self._seeds, self._drawn = {}, None, ()

    def _shared(
        self, seeds: Seeds, layers: Mapping[TileKey | None, FlowLayer], pyramid: Pyramid | None
    ) -> dict[TileKey | None, dict[str, Floats]]:
        """Share seeds among the layers: the finest one that is ready draws them."""
        assert self._seeds is not None
        result: dict[TileKey | None, dict[str, Floats]] = {}
        keys = sorted((key for key in layers if key is not None), key=lambda key: key.level)
        for key in keys:
            geometry = layers[key].textures.geometry
            if pyramid is None or not isinstance(geometry, SurfaceGeometry):
                continue  # triangles of a level are not those of another
            row, column = np.divmod(
                self._seeds.corners[seeds.cell, 0], pyramid.shape(pyramid.depth)[1]
            )
            root_place = np.stack([column, row], axis=-1) + seeds.place
            inside, corners, place = in_tile(pyramid, key, geometry, root_place)
            result[key] = vertex_data(geometry, corners, place, seeds.radius[inside])
            seeds = seeds[~inside]
        result[None] = self._seeds.vertex_data(seeds)
        return {key: data for key, data in result.items() if len(data["flowtexRadius"])}


class _Arrows:
    """The arrows of one layer, as an actor."""

    def __init__(self, layer: FlowLayer, renderer: pv.Renderer, settings: Settings) -> None:
        self.layer, self._renderer, self._settings = layer, weakref.ref(renderer), settings
        self._data: dict[str, Floats] = {}
        self._anchor: Floats | None = None
        self._variant: frozenset[str] | None = None
        self.actor = pv.Actor(mapper=FlowMapper(pv.PolyData()))
        self.actor.mapper.scalar_visibility = False
        self.actor.mapper.SetVBOShiftScaleMethod(0)  # the shader takes positions as they are
        self.actor.prop.lighting = False
        self.actor.PickableOff()
        self.actor.UseBoundsOff()
        self.actor.ForceTranslucentOn()  # after the flow
        observe_draws(self.actor.mapper, self._before_draw)

    def set_data(self, data: dict[str, Floats]) -> None:
        """Draw other seeds, given by their vertex attributes."""
        self._data, self._anchor = data, None

    def look(self, place: Floats) -> None:
        """Follow the layer, on a surface at a place (4, 4)."""
        geometry, anchor = self.layer.textures.geometry, self.layer.view.anchor
        matrix = np.eye(4)
        matrix[:3, :3] = geometry.frame.T
        matrix[:3, 3] = geometry.center + geometry.frame.T @ anchor
        self.actor.user_matrix = place @ matrix
        if self._anchor is None or (anchor != self._anchor).any():
            self._anchor = anchor.copy()
            self.actor.mapper.dataset = self._mesh(anchor)
        self._write_text()

    def _mesh(self, anchor: Floats) -> pv.PolyData:
        """Return the ribbons of the seeds: two vertices at each end of a piece."""
        position, count = self._data["flowtexPosition"], 2 * (ARROW_PIECES + 1)
        number = np.arange(count)
        ribbon = np.stack([number // 2, 2 * (number % 2) - 1], axis=-1)
        strip = 2 * np.arange(ARROW_PIECES)[:, None] + [0, 1, 3, 2]
        faces: Any = (np.arange(len(position))[:, None, None] * count + strip).reshape(-1, 4)
        mesh = pv.PolyData.from_regular_faces(np.repeat(position - anchor, count, axis=0), faces)
        mapper, points = self.actor.mapper, vtkDataObject.FIELD_ASSOCIATION_POINTS
        repeated = {name: np.repeat(self._data[name], count, axis=0) for name in self._read}
        for name, values in {**repeated, RIBBON: np.tile(ribbon, (len(position), 1))}.items():
            mesh.point_data[name] = values.astype(np.float32)
            mapper.MapDataArrayToVertexAttribute(name, name, points, -1)
        return mesh

    @property
    def _read(self) -> list[str]:
        """Names of the attributes that the shader reads beside positions."""
        unread = {"flowtexPosition"}
        if self.layer.textures.geometry.planar:
            unread.add("flowtexNormal")
        return [name for name in self._data if name not in unread]

    def _write_text(self) -> None:
        textures = self.layer.textures
        near = is_near(textures, self._settings, self.layer.view)
        # In triangles only fragments have the data to follow the velocity in a cell.
        near = near and textures.geometry.corners is None
        variant = variants(textures, unsteady=textures.store.steps > 1, near=near)
        if variant == self._variant:
            return
        self._variant = variant
        self.actor.clear_shader_replacements(_feature_name=OWNER)
        for shader, mark, name in REPLACEMENTS:
            text = f"{mark}\n{shader_text(name, variant)}"
            self.actor.add_shader_replacement(shader, mark, text, _feature_name=OWNER)

    def _before_draw(self, program: vtkShaderProgram) -> None:
        self.layer.before_draw(program)
        if (renderer := self._renderer()) is not None and program.IsUniformUsed("u_picture"):
            write_uniform(program, "u_picture", tuple(map(float, renderer.GetSize())))
