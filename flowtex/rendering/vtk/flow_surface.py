"""One flow in a PyVista renderer: its surface, whole or in tiles, each an actor with a texture.

The actor that PyVista knows draws the whole surface, or of a large one the coarsest level. Where a
view asks for more, tiles are drawn in place of its triangles, with its properties, colours and
position; they come and go with the view.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkRenderingCore import vtkRenderWindowInteractor
from vtkmodules.vtkRenderingOpenGL2 import vtkShaderProgram

from flowtex._util.array_types import Floats, Ints
from flowtex.errors import notify
from flowtex.rendering.arrow_seeds import ArrowSeeds, Seeds, in_tile, vertex_data
from flowtex.rendering.drawn_flow import ColourValues, DrawnFlow
from flowtex.rendering.mesh_levels import MeshLevels, Region, join, mesh_levels_of
from flowtex.rendering.tile_choice import (
    TileView,
    cell_pixels,
    choose_tiles,
    cover,
    finer_part,
    wanted_tiles,
)
from flowtex.rendering.uniforms import (
    ARROW_PIECES,
    ViewState,
    arrow_distance,
    has_arrows,
    is_near,
    variants,
)
from flowtex.rendering.vtk.contexts import check_fork, note_thread
from flowtex.rendering.vtk.flow_mapper import FlowMapper, set_attributes, surface_mesh
from flowtex.rendering.vtk.frame import FrameSteps, Step, weak_callback
from flowtex.rendering.vtk.layer import (
    FlowLayer,
    insert_text,
    observe_draws,
    plain_actor,
    write_uniform,
)
from flowtex.rendering.vtk.passes import DeferredPasses
from flowtex.settings import Settings
from flowtex.textures.geometry import SurfaceGeometry
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.grid_pyramid import TILE_BLOCKS, GridPyramid
from flowtex.textures.tiles.loader import Tile, TileLoader
from flowtex.textures.tiles.pyramid import Pyramid, TileKey

LOOK_INTERVAL_MS = 250  #: Time after which a window is drawn again while tiles are on their way.
RIBBON = "flowtexRibbon"  #: Attribute of the vertices of a ribbon: piece and side.


def write_colours(values: ColourValues, textures: TextureSet, mesh: pv.PolyData) -> None:
    """Write the colour values of a texture set's field to its mesh, as a point array."""
    geometry = textures.geometry
    on_cells = values.on_cells
    drawn = geometry.drawn_values(values.of(geometry.field), on_cells=on_cells)
    mesh.point_data[values.name] = geometry.at_vertices(drawn, on_cells=on_cells)


class FlowSurface:
    """Draws a flow by an actor with a :func:`surface_mesh` and by tiles, as settings say."""

    def __init__(self, actor: pv.Actor, renderer: Any, flow: DrawnFlow, settings: Settings) -> None:
        check_fork()
        note_thread(renderer.GetRenderWindow())
        self._actor = actor
        self._renderer = weakref.ref(renderer)
        self._settings = settings
        self._flow = flow
        self._base = FlowLayer(actor, renderer, flow.textures, settings)
        self._triangles: tuple[Any, ...] = ()  #: Those that are drawn: levels of each region.
        self._arrows = SurfaceArrows(renderer, settings)
        self._tiles: dict[TileKey, FlowLayer] = {}
        self._loader = self._loader_of(flow.pyramid)
        self._base.set_moment(*flow.moment)
        self._write_colours(self._base)
        #: Height in pixels for which tiles are chosen, where a frame is a draft of fewer, and that
        #: of the picture that it is a part of.
        self.full_height: int | None = None
        self.whole_height: int | None = None
        self._notify: Callable[[], None] | None = None
        self._reported: set[TileKey] = set()
        self._passes = DeferredPasses.of(renderer)
        FrameSteps.of(renderer).add(Step.SURFACES, self._before_frame)
        self._end_observer = renderer.AddObserver("EndEvent", weak_callback(self._after_frame))

    @property
    def view(self) -> ViewState:
        """Clock, density and time of the next frame."""
        return self._base.view

    def load_in_background(self, notify: Callable[[], None]) -> None:
        """Draw frames with the tiles that are ready, and notify from a thread when more are."""
        self._notify = notify

    @property
    def meshes(self) -> list[pv.PolyData]:
        """Meshes that the last frame has drawn: the surface's own mesh, and those of tiles."""
        shown = []
        for tile in self._tiles.values():
            if tile.actor.GetNumberOfConsumers():
                shown.append(tile.mesh)
        return [self._actor.mapper.dataset, *shown]

    @property
    def busy(self) -> bool:
        """Whether tiles that the last frame has requested are on their way."""
        return self._loader is not None and self._loader.busy

    def show(self, flow: DrawnFlow) -> None:
        """Draw other textures, another moment or other colours of a flow, or another flow."""
        old = self._flow
        self._flow = flow
        if not flow.has_textures_of(old):
            self._show_textures(flow.textures)
        self._base.set_moment(*flow.moment)
        if flow.colours != old.colours:
            for layer in (self._base, *self._tiles.values()):
                self._write_colours(layer)

    def _show_textures(self, textures: TextureSet) -> None:
        """Draw a texture set, of the same flow or of another one, and its tiles."""
        self._drop(list(self._tiles))
        self._arrows.close()
        if self._loader is not None:
            self._loader.close()
        self._loader = self._loader_of(self._flow.pyramid)
        self._triangles = ()
        if textures.geometry.field is self._base.textures.geometry.field:
            set_attributes(self._actor.mapper.dataset, textures)
            self._base.set_textures(textures)
            return
        # Another surface, or another level of it as the whole, has other nodes.
        view = self._base.view
        self._base.close()
        self._actor.mapper.SetInputData(surface_mesh(textures))
        self._base = FlowLayer(self._actor, self._renderer(), textures, self._settings)
        self._base.view = replace(view, anchor=np.zeros(3))
        self._write_colours(self._base)

    def close(self) -> None:
        """Remove everything from the renderer, and free the graphics card's memory."""
        renderer = self._renderer()
        if renderer is not None:
            FrameSteps.of(renderer).remove(self._before_frame)
            renderer.RemoveObserver(self._end_observer)
        self._passes.remove(self)
        self._drop(list(self._tiles))
        self._arrows.close()
        if self._loader is not None:
            self._loader.close()
        self._base.close()

    def _write_colours(self, layer: FlowLayer, written: ColourValues | None = None) -> None:
        """Write the colour values to the mesh of a layer that has those that are ``written``."""
        colours = self._flow.colours
        layer.flat_array = None
        if colours is None:
            return
        if colours != written:
            write_colours(colours, layer.textures, layer.mesh)
        if colours.on_cells:
            layer.flat_array = colours.name

    def _before_frame(self, renderer: pv.Renderer) -> None:
        """Choose tiles, shaders and triangles for the camera of the frame."""
        if not self._actor.GetVisibility():
            self._show([])
            self._passes.hide(self)
            return
        note_thread(renderer.GetRenderWindow())
        self._base.look()
        view = self._tile_view(renderer)
        shown, is_covered = self._choose(view)
        layers: dict[TileKey | None, FlowLayer] = {None: self._base}
        layers |= {key: self._tiles[key] for key in shown if key in self._tiles}
        self._show(list(layers))
        for key, layer in layers.items():
            if key is None:
                continue
            layer.view = replace(self._base.view, anchor=layer.view.anchor)
            layer.set_moment(*self._flow.moment)
            layer.look()
        self._base.prepare(blank=is_covered)
        self._set_triangles(layers, shown, view)
        self._passes.show(self, list(layers.values()))
        if self._loader is None:
            pyramid = None
        else:
            pyramid = self._loader.pyramid
        self._arrows.look(layers, pyramid, view, self._base.place)

    def _after_frame(self) -> None:
        for layer in (self._base, *self._tiles.values()):
            layer.after_frame()

    def _choose(self, view: TileView) -> tuple[dict[TileKey | None, list[TileKey]], bool]:
        """Return the tiles to draw, those that cover parts of them, and whether they cover all."""
        loader = self._loader
        if loader is None:
            return {None: []}, False
        before, after, between = self._flow.moment
        steps = sorted({before, after if between else before})
        choices = choose_tiles(loader.pyramid, view)
        if self._base.deferred and any(not loader.get(k, steps) for k in wanted_tiles(choices)):
            visible = loader.pyramid.visible_blocks(self._passes.places(self._base))
            choices = choose_tiles(loader.pyramid, replace(view, visible=visible))
        loader.request(wanted_tiles(choices), steps)
        if not self._goes_on():
            loader.wait()
        self._report(loader.errors)
        self._drop([key for key in self._tiles if not loader.keeps(key)])
        shown = cover(choices, lambda key: self._ready(key, steps))
        return shown, not choices[None].needed and shown[None] == choices[None].finer

    def _report(self, errors: Mapping[TileKey, Exception]) -> None:
        """Warn, once each, of tiles that could not be made; coarser ones are in their place."""
        for key in errors.keys() - self._reported:
            self._reported.add(key)
            error = errors[key]
            notify(
                f"a part of the surface is shown coarse, because tile {tuple(key)} could not be "
                f"made: {type(error).__name__}: {error}",
                UserWarning,
            )

    def _goes_on(self) -> bool:
        """Return whether another frame follows by itself when tiles are ready."""
        if self._notify is not None:
            return True
        renderer = self._renderer()
        if renderer is not None:
            window = renderer.GetRenderWindow()
        else:
            window = None
        if window is None:
            return False
        interactor = window.GetInteractor()
        if window.GetOffScreenRendering() or interactor is None or not interactor.GetInitialized():
            return False
        if self.busy:
            # VTK draws in the window's thread, which checks at intervals.
            observers: list[int] = []

            def draw(caller: vtkRenderWindowInteractor, event: str) -> None:
                del event
                caller.RemoveObserver(observers[0])
                caller.Render()

            observers.append(interactor.AddObserver("TimerEvent", draw))
            interactor.CreateOneShotTimer(LOOK_INTERVAL_MS)
        return True

    def _tile_view(self, renderer: pv.Renderer) -> TileView:
        camera = renderer.GetActiveCamera()
        (width, height) = renderer.GetSize()
        planes = [0.0] * 24
        eye = None
        half = 0.5 * self._base.height
        if not camera.GetParallelProjection():
            eye = self.view.eye[:3]
            half = float(np.tan(np.radians(camera.GetViewAngle() / 2)))
        camera.GetFrustumPlanes(width / max(height, 1), planes)
        sides = np.reshape(planes, (6, 4))[:4] @ self._base.place  # without near and far
        pixels = (self.full_height or height) / self.view.density
        return TileView(eye, half, pixels, sides, cell_pixels(self._settings))

    def _ready(self, key: TileKey, steps: list[int]) -> bool:
        if self._loader is None:
            tile = None
        else:
            tile = self._loader.get(key, steps)
        if tile is None:
            return False
        if key not in self._tiles and tile.textures is not None:
            self._tiles[key] = self._layer_of(tile, tile.textures)
        return True

    def _loader_of(self, pyramid: Pyramid | None) -> TileLoader | None:
        """Return a loader of tiles, if there are any, that does not keep this surface alive."""
        if pyramid is None:
            return None
        reference = weakref.ref(self)

        def prepare(textures: TextureSet) -> tuple[Any, ...]:
            surface = reference()
            mesh = surface_mesh(textures)
            colours = None
            if surface is not None:
                colours = surface._flow.colours
            if colours is not None:
                write_colours(colours, textures, mesh)
            _ = textures.unit, textures.cell, textures.critical_cell  # which are cached
            return mesh, mesh_levels_of(textures), colours

        def notify() -> None:
            surface = reference()
            if surface is not None and surface._notify is not None:
                surface._notify()

        return TileLoader(pyramid, prepare=prepare, notify=notify)

    def _layer_of(self, tile: Tile, textures: TextureSet) -> FlowLayer:
        mesh, mesh_levels, written = tile.prepared
        actor = pv.Actor(mapper=FlowMapper(mesh))
        actor.SetProperty(self._actor.prop)
        actor.SetUserMatrix(self._actor.GetMatrix())
        settings = self._settings
        take = tile.take
        layer = FlowLayer(actor, self._renderer(), textures, settings, take, mesh_levels)
        self._write_colours(layer, written)
        if written != self._flow.colours:
            textures.geometry.field.forget()
        return layer

    def _show(self, keys: list[TileKey | None]) -> None:
        renderer = self._renderer()
        base = self._actor
        if renderer is None:
            return
        for key, layer in self._tiles.items():
            if key not in keys:
                renderer.RemoveActor(layer.actor)
                continue
            renderer.AddActor(layer.actor)
            layer.follow(base.mapper)
            layer.actor.SetPickable(base.GetPickable())

    def _drop(self, keys: list[TileKey]) -> None:
        renderer = self._renderer()
        for key in keys:
            layer = self._tiles.pop(key)
            if renderer is not None:
                renderer.RemoveActor(layer.actor)
            layer.close()

    def _set_triangles(
        self,
        layers: dict[TileKey | None, FlowLayer],
        shown: dict[TileKey | None, list[TileKey]],
        view: TileView,
    ) -> None:
        """Draw as few triangles as the view needs, without a crack between tiles."""
        renderer = self._renderer()
        geometry = self._base.textures.geometry
        depth = 0
        blocks = self._base.mesh_levels.blocks.shape[:2]
        if self._loader is None:
            pyramid = None
        else:
            pyramid = self._loader.pyramid
        if pyramid is not None:
            depth = pyramid.depth
            blocks = pyramid.blocks
        regions: dict[TileKey | None, Region] = {}
        for key, layer in layers.items():
            levels = layer.choose_levels(renderer, view)
            if pyramid is not None:
                for child in shown[key]:
                    levels[finer_part(pyramid, child, key)] = -1
            if key is None:
                place = TileKey(depth, 0, 0)
            else:
                place = key
            row, column = (TILE_BLOCKS * index << place.level for index in place[1:])
            ragged = layer.mesh_levels.ragged
            regions[key] = Region(place.level, row, column, levels, ragged)
        drawn = tuple((key, region.levels.tobytes()) for key, region in regions.items())
        if drawn == self._triangles:
            return
        joins: Sequence[Ints | None] = [None] * len(regions)
        if isinstance(self._base.mesh_levels, MeshLevels):
            joins = join(list(regions.values()), (blocks[0], blocks[1]), geometry.periodic)
        for (key, region), borders in zip(regions.items(), joins, strict=True):
            layers[key].set_triangles(region.levels, borders)
        self._triangles = drawn


class SurfaceArrows:
    """The arrows of one surface: arrows of the root, drawn by the finest tile at their places."""

    def __init__(self, renderer: pv.Renderer, settings: Settings) -> None:
        self._renderer = weakref.ref(renderer)
        self._settings = settings
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
        renderer = self._renderer()
        base = layers[None]
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
        self._parts = {}
        self._seeds = None
        self._drawn = ()

    def _shared(
        self, seeds: Seeds, layers: Mapping[TileKey | None, FlowLayer], pyramid: Pyramid | None
    ) -> dict[TileKey | None, dict[str, Floats]]:
        assert self._seeds is not None
        result: dict[TileKey | None, dict[str, Floats]] = {}
        keys = sorted((key for key in layers if key is not None), key=lambda key: key.level)
        for key in keys:
            geometry = layers[key].textures.geometry
            if not isinstance(pyramid, GridPyramid) or not isinstance(geometry, SurfaceGeometry):
                continue  # triangles of a level are not those of another
            row, column = np.divmod(
                self._seeds.corners[seeds.cell, 0], pyramid.shape(pyramid.depth)[1]
            )
            root_place = np.stack([column, row], axis=-1) + seeds.place
            inside, corners, place = in_tile(pyramid, key, geometry, root_place)
            result[key] = vertex_data(geometry, corners, place, seeds.radius[inside])
            seeds = seeds[~inside]
        geometry = layers[None].textures.geometry
        corners = self._seeds.corners[seeds.cell]
        result[None] = vertex_data(geometry, corners, seeds.place, seeds.radius)
        return {key: data for key, data in result.items() if len(data["flowtexRadius"])}


class _Arrows:
    """The arrows of one layer, as an actor."""

    def __init__(self, layer: FlowLayer, renderer: pv.Renderer, settings: Settings) -> None:
        self.layer = layer
        self._renderer = weakref.ref(renderer)
        self._settings = settings
        self._data: dict[str, Floats] = {}
        self._anchor: Floats | None = None
        self._variant: frozenset[str] | None = None
        self.actor = plain_actor(pv.PolyData())
        self.actor.prop.lighting = False
        self.actor.ForceTranslucentOn()  # after the flow
        observe_draws(self.actor.mapper, self._before_draw)

    def set_data(self, data: dict[str, Floats]) -> None:
        self._data = data
        self._anchor = None

    def look(self, place: Floats) -> None:
        geometry = self.layer.textures.geometry
        anchor = self.layer.view.anchor
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
        position = self._data["flowtexPosition"]
        count = 2 * (ARROW_PIECES + 1)
        number = np.arange(count)
        ribbon = np.stack([number // 2, 2 * (number % 2) - 1], axis=-1)
        strip = 2 * np.arange(ARROW_PIECES)[:, None] + [0, 1, 3, 2]
        faces: Any = (np.arange(len(position))[:, None, None] * count + strip).reshape(-1, 4)
        mesh = pv.PolyData.from_regular_faces(np.repeat(position - anchor, count, axis=0), faces)
        mapper = self.actor.mapper
        points = vtkDataObject.FIELD_ASSOCIATION_POINTS
        planar = self.layer.textures.geometry.planar
        unread = {"flowtexPosition"}
        if planar:
            unread.add("flowtexNormal")
        read = self._data.items()
        repeated = {name: np.repeat(a, count, axis=0) for name, a in read if name not in unread}
        for name, values in {**repeated, RIBBON: np.tile(ribbon, (len(position), 1))}.items():
            mesh.point_data[name] = values.astype(np.float32)
            mapper.MapDataArrayToVertexAttribute(name, name, points, -1)
        return mesh

    def _write_text(self) -> None:
        """Give the actor the shader text for its present variant, if that has changed."""
        textures = self.layer.textures
        near = is_near(textures, self._settings, self.layer.view)
        # In triangles only fragments have the data to follow the velocity in a cell.
        near = near and textures.geometry.corners is None
        variant = variants(textures, near=near)
        if variant != self._variant:
            self._variant = variant
            insert_text(self.actor, "flowtex arrows", "arrow_", variant)

    def _before_draw(self, program: vtkShaderProgram | None) -> None:
        self.layer.before_draw(program)
        renderer = self._renderer()
        if program and renderer is not None and program.IsUniformUsed("u_picture"):
            write_uniform(program, "u_picture", tuple(map(float, renderer.GetSize())))
