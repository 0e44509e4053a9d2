"""The pass that subtracts the local mean from the sums of a surface, before they are coloured."""

from __future__ import annotations

from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderWindow

from flowtex.rendering.even import EvenBlocks
from flowtex.rendering.vtk.area import PassArea
from flowtex.rendering.vtk.targets import Box, Rectangle, Target

BLEND = 0x0BE2  #: OpenGL's number of blending.
DEPTH_TEST = 0x0B71  #: OpenGL's number of the depth test.
COLOUR_BUFFER = 0x4000  #: OpenGL's number of what is cleared.
ONE = 1  #: OpenGL's number of a factor of blending.


class EvenPass:
    """Evens the texture of one surface after the other, from its sums to its local means."""

    def __init__(self) -> None:
        #: Texture of each pixel before it fades, and the factor by which it does.
        self._texture = Target(2)
        self._box: Box | None = None
        self._means = Target(1)
        self._rows = Target(1)
        self._steps = {
            name: Rectangle("even", frozenset({f"FLOWTEX_EVEN_{name}"}))
            for name in ("BLUR", "LAID")
        }

    def begin(self, window: vtkOpenGLRenderWindow, sums: Target) -> None:
        """Have sums drawn as a second texture beside their target from now on, zero elsewhere."""
        self._texture.fit(window, sums.size)
        self._texture.bind()
        state = window.GetState()
        state.vtkglClearColor(0.0, 0.0, 0.0, 0.0)
        state.vtkglClear(COLOUR_BUFFER)
        sums.bind()
        sums.frame.AddColorAttachment(1, self._texture.texture)
        sums.frame.ActivateDrawBuffers(2)
        self._box = None

    def include(self, box: Box) -> None:
        """Take pixels into account into which sums are drawn."""
        if self._box is None:
            self._box = box
            return
        left, right, low, high = zip(self._box, box, strict=True)
        self._box = (min(left), max(right), min(low), max(high))

    def draw(
        self, window: vtkOpenGLRenderWindow, sums: Target, grain: float | None, area: PassArea
    ) -> None:
        """Subtract the local mean for a grain in pixels, if any, from the texture in the sums."""
        sums.frame.RemoveColorAttachment(1)
        sums.frame.ActivateDrawBuffer(0)
        if grain is None or self._box is None:
            return
        blocks = EvenBlocks.of(grain, self._box, shift=area.shift, clip=area.end)
        state = window.GetState()
        state.vtkglDisable(DEPTH_TEST)
        self._draw_means(window, blocks)
        sums.bind()
        state.vtkglEnable(BLEND)
        state.vtkglBlendFunc(ONE, ONE)
        step = self._use("LAID", window, blocks)
        step.program.SetUniform2i("u_first", blocks.first)
        _draw(window, step, sums, {"u_texture": self._texture, "u_means": self._means}, self._box)
        state.vtkglDisable(BLEND)
        state.vtkglEnable(DEPTH_TEST)

    def _draw_means(self, window: vtkOpenGLRenderWindow, blocks: EvenBlocks) -> None:
        """Draw means along the rows, and of these along the columns."""
        columns, rows = blocks.size
        across, upward = blocks.pixels
        self._means.grow(window, blocks.size)
        self._rows.grow(window, (columns, upward))
        program = self._use("BLUR", window, blocks).program
        program.SetUniformf("u_reach", blocks.reach)
        program.SetUniformf("u_variance", blocks.variance)
        program.SetUniform2i("u_from", blocks.first)
        program.SetUniform2i("u_along", (1, 0))
        program.SetUniformi("u_count", across)
        step = self._steps["BLUR"]
        _draw(window, step, self._rows, {"u_source": self._texture}, (0, columns, 0, upward))
        program.SetUniform2i("u_from", (0, 0))
        program.SetUniform2i("u_along", (0, 1))
        program.SetUniformi("u_count", upward)
        _draw(window, step, self._means, {"u_source": self._rows}, (0, columns, 0, rows))

    def _use(self, name: str, window: vtkOpenGLRenderWindow, blocks: EvenBlocks) -> Rectangle:
        step = self._steps[name]
        step.use(window)
        step.program.SetUniformi("u_side", blocks.side)
        return step


def _draw(
    window: vtkOpenGLRenderWindow,
    step: Rectangle,
    target: Target,
    sources: dict[str, Target],
    box: Box,
) -> None:
    """Draw a box of a target from other targets, by the names of their samplers."""
    target.bind()
    for name, source in sources.items():
        source.texture.Activate()
        step.program.SetUniformi(name, source.texture.GetTextureUnit())
    step.draw(target, window, box)
    for source in sources.values():
        source.texture.Deactivate()
