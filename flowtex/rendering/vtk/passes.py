"""One sum for each visible pixel: where on the surface it lies, then the texture there.

Before a renderer draws, three passes do so off the screen. The first draws the triangles of its
layers into a texture of places. The second draws a rectangle for each layer, whose pixels look up
their place and sum noise along their paths. The third subtracts the local mean of these sums and
lays them over the colours. Then the actors are drawn as usual and fetch their pixels from the
result, so VTK remains in charge of lighting, clipping, picking and multisampling.
"""

from __future__ import annotations

import weakref

import numpy as np
import pyvista as pv
from vtkmodules.util.vtkConstants import VTK_FLOAT
from vtkmodules.vtkRenderingCore import vtkRenderer
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderWindow, vtkShaderProgram

from flowtex._util.array_types import Floats32
from flowtex.rendering.vtk.area import PassArea, PicturePart, part_of, tile_of
from flowtex.rendering.vtk.even import EvenPass
from flowtex.rendering.vtk.flow_mapper import (
    COORDINATE,
    CORNERS,
    FlowMapper,
    map_attributes,
    set_triangles,
)
from flowtex.rendering.vtk.frame import FrameSteps, Step
from flowtex.rendering.vtk.layer import FlowLayer, insert_text, observe_draws
from flowtex.rendering.vtk.targets import Box, Rectangle, Target

BLEND = 0x0BE2  #: OpenGL's number of blending.
SCISSOR = 0x0C11  #: OpenGL's number of the scissor test.
DEPTH_TEST = 0x0B71  #: OpenGL's number of the depth test.
EQUAL = 0x0202  #: OpenGL's number of the comparison of equal depths.
ALWAYS = 0x0207  #: OpenGL's number of the comparison that is always true.
MOST_LAYERS = 4096  #: Most layers, a power of two: their numbers are depths.
COLOUR_AND_DEPTH = 0x4100  #: OpenGL's number of what is cleared.
DEPTH_BUFFER = 0x100  #: OpenGL's number of the depths among it.
SKIPPED = 3  #: Distance in pixels of the samples by which the visible tiles are found.


class DeferredPasses:
    """The passes before the frames of one renderer."""

    def __init__(self, renderer: pv.Renderer) -> None:
        self._renderer = weakref.ref(renderer)
        #: Layers by owner, including hidden owners.
        self._shown: weakref.WeakKeyDictionary[object, list[FlowLayer]] = (
            weakref.WeakKeyDictionary()
        )
        self._hidden: weakref.WeakSet[object] = weakref.WeakSet()
        self._parts: dict[FlowLayer, _Part] = {}
        self._places = vtkRenderer()
        self._places.AutomaticLightCreationOff()
        self._alone: tuple[weakref.ref[FlowLayer], _Part, vtkRenderer] | None = None
        #: The whole picture, if the next frames are parts of it.
        self.part: PicturePart | None = None
        FrameSteps.of(renderer).add(Step.PASSES, self._draw)

    @classmethod
    def of(cls, renderer: pv.Renderer) -> DeferredPasses:
        """Return the passes of a renderer, the same ones at each call."""
        if renderer not in _passes:
            _passes[renderer] = cls(renderer)
        return _passes[renderer]

    def show(self, owner: object, layers: list[FlowLayer]) -> None:
        """Draw an owner's layers in the next frames, as far as they are deferred."""
        self._hidden.discard(owner)
        self._shown[owner] = layers

    def hide(self, owner: object) -> None:
        """Draw nothing of an owner in the next frames."""
        self._hidden.add(owner)

    def remove(self, owner: object) -> None:
        """Stop drawing an owner and free its resources."""
        self._shown.pop(owner, None)
        self._follow([])

    def _draw(self, renderer: pv.Renderer) -> None:
        surfaces = self._surfaces()
        layers = [layer for surface in surfaces for layer in surface]
        if not layers:
            return
        self._follow(layers)
        window = renderer.GetRenderWindow()
        state = window.GetState()
        state.Push()
        state.PushFramebufferBindings()
        part = self.part or tile_of(window)
        margin = max((layer.even_margin for layer in layers), default=0)
        area = PassArea.of(renderer, part, margin)
        buffers = self._draw_places(self._places, renderer, area)
        places = buffers.places.texture
        places.Activate()
        buffers.sums.bind()
        for name in (BLEND, SCISSOR):
            state.vtkglDisable(name)
        state.vtkglEnable(DEPTH_TEST)
        state.vtkglDepthMask(True)
        state.vtkglDepthFunc(ALWAYS)
        buffers.number(window, [self._parts[layer].box(area) for layer in layers])
        state.vtkglDepthFunc(EQUAL)
        for surface in surfaces:
            buffers.even.begin(window, buffers.sums)
            for layer in surface:
                self._parts[layer].sum(buffers, area)
                layer.after_frame()
                layer.shown = buffers.shown.texture
                layer.shown_area = area
            buffers.even.draw(surface[0], buffers.sums, buffers.shown, area)
        places.Deactivate()
        state.PopFramebufferBindings()
        state.Pop()

    def _surfaces(self) -> list[list[FlowLayer]]:
        """Return the layers to draw of each surface that has any."""
        owners = [owner for owner in self._shown if owner not in self._hidden]
        surfaces = []
        for owner in owners:
            layers = []
            for layer in self._shown[owner]:
                if layer.deferred:
                    layers.append(layer)
            if layers:
                surfaces.append(layers)
        return surfaces

    def places(self, layer: FlowLayer) -> Floats32:
        """Return the places (N, 4) at sampled pixels where a layer would be seen alone."""
        renderer = self._renderer()
        assert renderer is not None
        if self._alone is None or self._alone[0]() is not layer:
            part = _Part(layer, whole=True)
            alone = vtkRenderer()
            alone.AutomaticLightCreationOff()
            alone.AddActor(part.actor)
            self._alone = weakref.ref(layer), part, alone
        _, part, alone = self._alone
        part.follow(1)
        window = renderer.GetRenderWindow()
        state = window.GetState()
        state.Push()
        state.PushFramebufferBindings()
        area = PassArea.of(renderer, None, 0)
        texture = self._draw_places(alone, renderer, area).places.texture
        state.PopFramebufferBindings()
        state.Pop()
        size = texture.GetWidth(), texture.GetHeight()
        pixels = np.empty((size[1], size[0], 4), np.float32)
        texture.Download().Download2D(VTK_FLOAT, pixels.reshape(-1), [*size], 4, [0, 0])
        (left, low), (width, height) = part_of(window, renderer)
        seen = pixels[low : low + height : SKIPPED, left : left + width : SKIPPED].reshape(-1, 4)
        return seen[seen[:, 3] > 0]

    def _draw_places(self, places: vtkRenderer, renderer: pv.Renderer, area: PassArea) -> _Buffers:
        window = renderer.GetRenderWindow()
        buffers = _buffers.get(window)
        if buffers is None or buffers.context != window.GetContextCreationTime():
            buffers = _buffers[window] = _Buffers(window)
        buffers.fit(window, area.margin)
        buffers.places.bind()
        if area.margin:
            # The renderer clears what the frame shows.
            state = window.GetState()
            state.vtkglDisable(SCISSOR)
            state.vtkglClearColor(0.0, 0.0, 0.0, 0.0)
            state.vtkglClear(COLOUR_AND_DEPTH)
        places.SetRenderWindow(window)
        for layer_part in self._parts.values():
            layer_part.area = area
        places.SetViewport(renderer.GetViewport())
        places.SetActiveCamera(area.camera(renderer.GetActiveCamera()))
        places.Render()
        return buffers

    def _follow(self, layers: list[FlowLayer]) -> None:
        known = {layer for shown in self._shown.values() for layer in shown}
        for layer, part in [*self._parts.items()]:
            part.actor.SetVisibility(layer in layers)
            if layer not in known:
                self._places.RemoveActor(self._parts.pop(layer).actor)
        for number, layer in enumerate(layers):
            if layer not in self._parts:
                self._parts[layer] = _Part(layer)
                self._places.AddActor(self._parts[layer].actor)
            self._parts[layer].follow(number + 1)


class _Buffers:
    """The textures of one window: its renderers draw one after another, so they share them."""

    def __init__(self, window: vtkOpenGLRenderWindow) -> None:
        self.context = window.GetContextCreationTime()
        self.places = Target(4, has_depth=True)
        self.sums = Target(4, has_depth=True)  #: Colour and texture of each pixel.
        #: Colour under the texture, and the texture less its local mean.
        self.shown = Target(4, is_half=True, depth_of=self.sums)
        self.even = EvenPass()
        self._numbers = Rectangle("depth", frozenset())

    def fit(self, window: vtkOpenGLRenderWindow, margin: int) -> None:
        width, height = window.GetActualSize()
        size = (width + 2 * margin, height + 2 * margin)
        self.places.fit(window, size)
        self.sums.fit(window, size)
        self.shown.fit(window, size)

    def number(self, window: vtkOpenGLRenderWindow, boxes: list[Box | None]) -> None:
        """Draw the numbers of the layers as depths, in the boxes of pixels that have layers."""
        state = window.GetState()
        state.vtkglClear(DEPTH_BUFFER)
        drawn = [box for box in boxes if box is not None]
        if not drawn:
            return
        left, right, low, high = zip(*drawn, strict=True)
        self._numbers.use(window)
        program = self._numbers.program
        program.SetUniformi("u_places", self.places.texture.GetTextureUnit())
        program.SetUniformf("u_layers", MOST_LAYERS)
        state.vtkglColorMask(False, False, False, False)
        self._numbers.draw(self.sums, window, (min(left), max(right), min(low), max(high)))
        state.vtkglColorMask(True, True, True, True)


#: Of renderers, and of windows.
_passes: weakref.WeakKeyDictionary[pv.Renderer, DeferredPasses] = weakref.WeakKeyDictionary()
_buffers: weakref.WeakKeyDictionary[vtkOpenGLRenderWindow, _Buffers] = weakref.WeakKeyDictionary()


class _Part:
    """What the passes draw of one layer."""

    def __init__(self, layer: FlowLayer, *, whole: bool = False) -> None:
        self._layer = weakref.ref(layer)
        self._whole = whole
        mesh = layer.mesh
        if whole:
            mesh = mesh.copy(deep=False)
            levels = layer.mesh_levels
            set_triangles(mesh, levels.triangles(np.zeros(levels.blocks.shape[:2], np.int64)))
        self.actor = pv.Actor(mapper=FlowMapper(mesh))
        self.actor.mapper.scalar_visibility = False
        self.actor.prop.lighting = False
        self.area: PassArea | None = None  #: In which places are drawn.
        self._number = 0
        self._variant: frozenset[str] | None = None
        observe_draws(self.actor.mapper, self._before_places)

    def follow(self, number: int) -> None:
        layer = self._layer()
        assert layer is not None
        self._number = number
        if self.actor.mapper.dataset is not layer.mesh and not self._whole:
            self.actor.mapper.SetInputData(layer.mesh)
        shown = layer.actor
        prop = self.actor.prop
        prop.culling = shown.prop.culling
        self.actor.SetUserMatrix(shown.GetMatrix())
        planes = shown.mapper.GetClippingPlanes()
        if planes is not self.actor.mapper.GetClippingPlanes():
            self.actor.mapper.RemoveAllClippingPlanes()
            if planes is not None:
                self.actor.mapper.SetClippingPlanes(planes)
        variant = layer.variant
        if variant == self._variant:
            return
        self._variant = variant
        self._sum = Rectangle("sum", variant)
        arrays = {"flowtexCoordinate": COORDINATE}
        if "FLOWTEX_TRIANGLES" in variant:
            arrays["flowtexCorners"] = CORNERS
        map_attributes(self.actor.mapper, arrays)
        insert_text(self.actor, "flowtex places", "place_", variant)

    def box(self, area: PassArea) -> Box | None:
        """Return the pixels that the layer may cover, counted from the corner of the area."""
        layer = self._layer()
        assert layer is not None
        box = layer.box(area.view, area.size)
        if box is None:
            return None
        left, right, low, high = box
        x, y = area.corner.tolist()
        return left + x, right + x, low + y, high + y

    def sum(self, buffers: _Buffers, area: PassArea) -> None:
        """Sum the pixels of the layer."""
        layer = self._layer()
        assert layer is not None and layer.window is not None
        box = self.box(area)
        if box is None:
            return
        self._sum.use(layer.window)
        program = self._sum.program
        layer.before_draw(program)
        program.SetUniformi("u_places", buffers.places.texture.GetTextureUnit())
        origin, along, up = layer.rays(area.view, area.size)
        x, y = area.corner.tolist()
        origin -= x * along + y * up
        for name, value in (("u_rayCorner", origin), ("u_rayX", along), ("u_rayY", up)):
            program.SetUniform3f(name, value.tolist())
        depth = self._number / MOST_LAYERS
        buffers.even.include(box, depth)
        self._sum.draw(buffers.sums, layer.window, box, depth)

    def _before_places(self, program: vtkShaderProgram | None) -> None:
        layer = self._layer()
        if program is not None and layer is not None and (window := layer.window) is not None:
            # The fourth channel is no opacity.
            window.GetState().vtkglDisable(BLEND)
            program.SetUniformf("u_layer", self._number)
            area = self.area
            if area is not None and area.margin:
                window.GetState().vtkglDisable(SCISSOR)
                window.GetState().vtkglViewport(*area.corner.tolist(), *area.size.tolist())
