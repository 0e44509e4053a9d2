"""The pass that subtracts the local mean from the sums of a surface, before they are coloured."""

from __future__ import annotations

from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderWindow

from flowtex.rendering.even import EvenBlocks
from flowtex.rendering.vtk.area import PassArea
from flowtex.rendering.vtk.layer import FlowLayer
from flowtex.rendering.vtk.targets import Box, Rectangle, Target

DEPTH_TEST = 0x0B71  #: OpenGL's number of the depth test.
COLOUR_BUFFER = 0x4000  #: OpenGL's number of what is cleared.
OFF_SURFACE = -1.0  #: Factor of the texture in pixels into which the surface draws nothing.


class EvenPass:
    """Evens the texture of one surface after the other, and lays it over the colours."""

    def __init__(self) -> None:
        #: Texture of each pixel before it fades, and the factor by which it does.
        self._texture = Target(2, is_half=True)
        self._layers: list[tuple[Box, float]] = []
        self._means = Target(1, is_half=True)
        self._rows = Target(1, is_half=True)
        self._blur = Rectangle("even", frozenset())
        self._shade = Rectangle("shade", frozenset())

    def begin(self, window: vtkOpenGLRenderWindow, sums: Target) -> None:
        """Draw the following sums into a second texture, too, which marks all other pixels."""
        self._texture.fit(window, sums.size)
        self._texture.bind()
        state = window.GetState()
        state.vtkglClearColor(0.0, OFF_SURFACE, 0.0, 0.0)
        state.vtkglClear(COLOUR_BUFFER)
        sums.bind()
        sums.frame.AddColorAttachment(1, self._texture.texture)
        sums.frame.ActivateDrawBuffers(2)
        self._layers = []

    def include(self, box: Box, depth: float) -> None:
        """Take pixels into account into which the sums of a layer are drawn, at its depth."""
        self._layers.append((box, depth))

    @property
    def _box(self) -> Box:
        """All pixels that are taken into account."""
        left, right, low, high = zip(*[box for box, _ in self._layers], strict=True)
        return min(left), max(right), min(low), max(high)

    def draw(self, layer: FlowLayer, sums: Target, shown: Target, area: PassArea) -> None:
        """Draw the pixels of a surface, one of whose layers is given, as they are shown."""
        sums.frame.RemoveColorAttachment(1)
        sums.frame.ActivateDrawBuffer(0)
        window = layer.window
        if window is None or not self._layers:
            return
        state = window.GetState()
        state.vtkglDisable(DEPTH_TEST)
        sources = {"u_sums": sums, "u_texture": self._texture}
        blocks = None
        grain = layer.even_grain
        if grain is not None:
            blocks = EvenBlocks.of(grain, self._box, shift=area.shift, clip=area.end)
            self._draw_means(window, blocks)
            sources["u_means"] = self._means
        self._shade.use(window)
        program = self._shade.program
        layer.before_draw(program)
        if blocks is not None:
            program.SetUniformi("u_side", blocks.side)
            program.SetUniform2i("u_first", blocks.first)
        # Only pixels at the depths of these layers.
        state.vtkglEnable(DEPTH_TEST)
        state.vtkglDepthMask(False)
        for box, depth in self._layers:
            _draw(window, self._shade, shown, sources, box, depth)
        state.vtkglDepthMask(True)
        layer.after_frame()

    def _draw_means(self, window: vtkOpenGLRenderWindow, blocks: EvenBlocks) -> None:
        """Draw means along the rows, and of these along the columns."""
        columns, rows = blocks.size
        across, upward = blocks.pixels
        self._means.grow(window, blocks.size)
        self._rows.grow(window, (columns, upward))
        self._blur.use(window)
        program = self._blur.program
        program.SetUniformi("u_side", blocks.side)
        program.SetUniformf("u_reach", blocks.reach)
        program.SetUniformf("u_variance", blocks.variance)
        program.SetUniform2i("u_from", blocks.first)
        program.SetUniform2i("u_along", (1, 0))
        program.SetUniformi("u_count", across)
        _draw(window, self._blur, self._rows, {"u_source": self._texture}, (0, columns, 0, upward))
        program.SetUniform2i("u_from", (0, 0))
        program.SetUniform2i("u_along", (0, 1))
        program.SetUniformi("u_count", upward)
        _draw(window, self._blur, self._means, {"u_source": self._rows}, (0, columns, 0, rows))


def _draw(
    window: vtkOpenGLRenderWindow,
    step: Rectangle,
    target: Target,
    sources: dict[str, Target],
    box: Box,
    depth: float = 0.0,
) -> None:
    """Draw a box of a target from other targets, by the names of their samplers."""
    target.bind()
    for name, source in sources.items():
        source.texture.Activate()
        step.program.SetUniformi(name, source.texture.GetTextureUnit())
    step.draw(target, window, box, depth)
    for source in sources.values():
        source.texture.Deactivate()
