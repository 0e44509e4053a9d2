"""One sum for each visible pixel: where on the surface it lies, then the texture there.

Before a renderer draws, two passes do so off the screen. The first draws the triangles of its
layers into a texture of places, without anything else, so that small and hidden triangles cost
little. The second draws a rectangle for each layer, whose pixels look up their place and sum noise
along their paths. Then the actors are drawn as ever and fetch the sums of their pixels, so
lighting, clipping, picking and multisampling remain VTK's.

::

    FlowLayer --mesh--> places --pixels--> sums --texture u_sums--> Actor
"""

from __future__ import annotations

import weakref

import numpy as np
import pyvista as pv
from vtkmodules.util.vtkConstants import VTK_FLOAT
from vtkmodules.vtkRenderingCore import vtkRenderer
from vtkmodules.vtkRenderingOpenGL2 import (
    vtkOpenGLFramebufferObject,
    vtkOpenGLRenderWindow,
    vtkOpenGLVertexArrayObject,
    vtkShaderProgram,
    vtkTextureObject,
)

from flowtex._util.array_types import Floats, Ints
from flowtex.rendering.shaders import shader_text
from flowtex.rendering.vtk.layer import FlowLayer, insert_text, observe_draws, weak_callback
from flowtex.rendering.vtk.mesh import COORDINATE, CORNERS, FlowMapper, map_attributes

#: OpenGL's numbers of blending, of it and of the tests of depth and of the scissor, and of the
#: colours of a buffer.
BLEND, TESTS, COLOUR_BUFFER = 0x0BE2, (0x0BE2, 0x0B71, 0x0C11), 0x4000
#: VTK begins shaders with what it writes for these.
MARKS = "//VTK::System::Dec\n//VTK::Output::Dec\n"
#: Before the actors are drawn, but after all else that waits for the start of a frame.
LAST = -1.0


class DeferredPasses:
    """The passes before the frames of one renderer."""

    def __init__(self, renderer: pv.Renderer) -> None:
        self._renderer = weakref.ref(renderer)
        self._shown: dict[int, list[FlowLayer]] = {}
        self._parts: weakref.WeakKeyDictionary[FlowLayer, _Part] = weakref.WeakKeyDictionary()
        self._places = vtkRenderer()
        self._places.AutomaticLightCreationOff()
        self._observed = renderer.AddObserver("StartEvent", weak_callback(self._draw), LAST)

    @classmethod
    def of(cls, renderer: pv.Renderer) -> DeferredPasses:
        """Return those of a renderer."""
        if renderer not in _passes:
            _passes[renderer] = cls(renderer)
        return _passes[renderer]

    def show(self, owner: object, layers: list[FlowLayer]) -> None:
        """Draw these layers of an owner in the next frames, of those that are deferred."""
        self._shown[id(owner)] = layers

    def remove(self, owner: object) -> None:
        """Draw nothing of an owner any more."""
        self._shown.pop(id(owner), None)
        self._follow([])

    def _draw(self) -> None:
        renderer = self._renderer()
        layers = [layer for shown in self._shown.values() for layer in shown if layer.deferred]
        if renderer is None or not layers:
            return
        self._follow(layers)
        window = renderer.GetRenderWindow()
        buffers, state = _buffers.setdefault(window, _Buffers()), window.GetState()
        state.Push()
        state.PushFramebufferBindings()
        buffers.fit(window)
        buffers.places.bind()
        self._places.SetRenderWindow(window)
        self._places.SetViewport(renderer.GetViewport())
        self._places.SetActiveCamera(renderer.GetActiveCamera())
        self._places.Render()
        buffers.sums.bind()
        places = buffers.places.texture
        for name in TESTS:
            state.vtkglDisable(name)
        state.vtkglClearColor(0.0, 0.0, 0.0, 0.0)
        state.vtkglClear(COLOUR_BUFFER)
        places.Activate()
        camera = renderer.GetActiveCamera()
        matrix = camera.GetCompositeProjectionTransformMatrix(renderer.GetTiledAspectRatio(), -1, 1)
        view = np.asarray(pv.array_from_vtkmatrix(matrix), dtype=float)
        corner, size = _part_of(window, renderer)
        for layer in layers:
            self._parts[layer].sum(buffers, view, corner, size)
            layer.after_frame()
            layer.sums = buffers.sums.texture
        places.Deactivate()
        state.PopFramebufferBindings()
        state.Pop()

    def _follow(self, layers: list[FlowLayer]) -> None:
        for layer in [*self._parts]:
            if layer not in layers:
                self._places.RemoveActor(self._parts.pop(layer).actor)
        for number, layer in enumerate(layers):
            if layer not in self._parts:
                self._parts[layer] = _Part(layer)
                self._places.AddActor(self._parts[layer].actor)
            self._parts[layer].follow(number + 1)


def _part_of(window: vtkOpenGLRenderWindow, renderer: pv.Renderer) -> tuple[Ints, Ints]:
    """Return the corner and the size of a renderer in the pixels that a window draws, (2,) each.

    Of a large picture it draws one part after another.
    """
    whole, tile = np.array(window.GetSize()), np.reshape(window.GetTileViewport(), (2, 2))
    shown = np.clip(np.reshape(renderer.GetViewport(), (2, 2)), tile[0], tile[1]) - tile[0]
    low, high = np.floor(shown * whole + 0.5).astype(int)
    return low, high - low


class _Target:
    """A texture of four numbers in single precision, into which passes draw."""

    def __init__(self) -> None:
        self.texture, self.frame = vtkTextureObject(), vtkOpenGLFramebufferObject()
        self._depth = vtkTextureObject()

    def fit(self, window: vtkOpenGLRenderWindow, size: tuple[int, int], *, depth: bool) -> None:
        """Have as many pixels as a window."""
        if (self.texture.GetWidth(), self.texture.GetHeight()) == size:
            return
        for part in (self.texture, self._depth, self.frame):
            part.SetContext(window)
        self.texture.Allocate2D(*size, 4, VTK_FLOAT)
        self.frame.Bind()
        self.frame.AddColorAttachment(0, self.texture)
        if depth:
            self._depth.AllocateDepth(*size, vtkTextureObject.Float32)
            self.frame.AddDepthAttachment(self._depth)

    def bind(self) -> None:
        """Have the next draws go there."""
        self.frame.Bind()
        self.frame.ActivateDrawBuffer(0)


class _Buffers:
    """The textures of one window: its renderers draw one after another, so they share them."""

    def __init__(self) -> None:
        self.places, self.sums = _Target(), _Target()

    def fit(self, window: vtkOpenGLRenderWindow) -> None:
        """Have as many pixels as a window."""
        width, height = window.GetActualSize()
        self.places.fit(window, (width, height), depth=True)
        self.sums.fit(window, (width, height), depth=False)


#: Of renderers, and of windows.
_passes: weakref.WeakKeyDictionary[pv.Renderer, DeferredPasses] = weakref.WeakKeyDictionary()
_buffers: weakref.WeakKeyDictionary[vtkOpenGLRenderWindow, _Buffers] = weakref.WeakKeyDictionary()


class _Part:
    """What the passes draw of one layer."""

    def __init__(self, layer: FlowLayer) -> None:
        self._layer = weakref.ref(layer)
        self.actor = pv.Actor(mapper=FlowMapper(layer.mesh))
        self.actor.mapper.scalar_visibility = False
        self.actor.prop.lighting = False
        self._number = 0
        self._variant: frozenset[str] | None = None
        self._program: vtkShaderProgram | None = None
        observe_draws(self.actor.mapper, self._before_places)

    def follow(self, number: int) -> None:
        """Draw what the layer draws, with a number."""
        layer = self._layer()
        assert layer is not None
        self._number = number
        if self.actor.mapper.dataset is not layer.mesh:
            self.actor.mapper.SetInputData(layer.mesh)
        shown, prop = layer.actor, self.actor.prop
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
        self._variant, self._program = variant, None
        self._vertices = vtkOpenGLVertexArrayObject()
        arrays = {"flowtexCoordinate": COORDINATE}
        if "FLOWTEX_TRIANGLES" in variant:
            arrays["flowtexCorners"] = CORNERS
        map_attributes(self.actor.mapper, arrays)
        insert_text(self.actor, "flowtex places", "place_", variant)

    def sum(self, buffers: _Buffers, view: Floats, corner: Ints, size: Ints) -> None:
        """Sum the pixels of the layer, in a part of the window with a corner and a size."""
        layer = self._layer()
        assert layer is not None and self._variant is not None and layer.window is not None
        box = layer.box(view, size)
        if box is None:
            return
        cache = layer.window.GetShaderCache()
        if self._program is None:
            vertex, fragment = (
                MARKS + shader_text(f"vtk/sum_{stage}.glsl", self._variant)
                for stage in ("vertex", "fragment")
            )
            self._program = cache.ReadyShaderProgram(vertex, fragment, "")
        else:
            cache.ReadyShaderProgram(self._program)
        program = self._program
        layer.before_draw(program)
        program.SetUniformi("u_places", buffers.places.texture.GetTextureUnit())
        program.SetUniformf("u_layer", self._number)
        origin, along, up = layer.rays(view, size)
        origin -= corner[0] * along + corner[1] * up
        for name, value in (("u_rayCorner", origin), ("u_rayX", along), ("u_rayY", up)):
            program.SetUniform3f(name, value.tolist())
        frame, (left, right, low, high) = buffers.sums.frame, box
        frame.StartNonOrtho(*layer.window.GetActualSize())
        layer.window.GetState().vtkglViewport(0, 0, *layer.window.GetActualSize())
        x, y = corner.tolist()
        # VTK draws it narrower by up to a pixel; what is beside it has no place of the layer.
        left, low = max(left + x - 1, 0), max(low + y - 1, 0)
        frame.RenderQuad(left, right + x, low, high + y, program, self._vertices)

    def _before_places(self, program: vtkShaderProgram | None) -> None:
        layer = self._layer()
        if program is not None and layer is not None and (window := layer.window) is not None:
            # The fourth channel is no opacity.
            window.GetState().vtkglDisable(BLEND)
            program.SetUniformf("u_layer", self._number)
