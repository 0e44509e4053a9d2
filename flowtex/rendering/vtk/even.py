"""The pass that subtracts the local mean from the sums of a surface, before they are coloured."""

from __future__ import annotations

from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderWindow

from flowtex.rendering.even import EvenBlocks
from flowtex.rendering.vtk.targets import Rectangle, Target

BLEND = 0x0BE2  #: OpenGL's number of blending.
DEPTH_TEST = 0x0B71  #: OpenGL's number of the depth test.
COLOUR_BUFFER = 0x4000  #: OpenGL's number of what is cleared.
ONE = 1  #: OpenGL's number of a factor of blending.


class EvenPass:
    """Evens the texture of one surface after the other, from its sums to its local means."""

    def __init__(self) -> None:
        #: Texture of each pixel before it fades, and the factor by which it does.
        self._texture = Target(2)
        self._means = Target(1)
        self._blurred = Target(1)
        self._steps = {
            name: Rectangle("even", frozenset({f"FLOWTEX_EVEN_{name}"}))
            for name in ("BLOCKS", "BLUR", "LAID")
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

    def draw(self, window: vtkOpenGLRenderWindow, sums: Target, grain: float | None) -> None:
        """Subtract the local mean for a grain in pixels, if any, from the texture in the sums."""
        sums.frame.RemoveColorAttachment(1)
        sums.frame.ActivateDrawBuffer(0)
        if grain is None:
            return
        blocks = EvenBlocks.of(grain, sums.size)
        state = window.GetState()
        state.vtkglDisable(DEPTH_TEST)
        self._draw_means(window, blocks)
        sums.bind()
        state.vtkglEnable(BLEND)
        state.vtkglBlendFunc(ONE, ONE)
        step = self._steps["LAID"]
        step.use(window)
        step.program.SetUniformi("u_side", blocks.side)
        sources = {"u_texture": self._texture, "u_means": self._means}
        _draw(window, step, sums, sources)
        state.vtkglDisable(BLEND)
        state.vtkglEnable(DEPTH_TEST)

    def _draw_means(self, window: vtkOpenGLRenderWindow, blocks: EvenBlocks) -> None:
        """Draw the means of blocks, and blur them along rows and columns."""
        for target in (self._means, self._blurred):
            target.fit(window, (blocks.columns, blocks.rows))
        step = self._steps["BLOCKS"]
        step.use(window)
        step.program.SetUniform2i("u_pixels", self._texture.size)
        step.program.SetUniformi("u_side", blocks.side)
        _draw(window, step, self._means, {"u_texture": self._texture})
        step = self._steps["BLUR"]
        step.use(window)
        step.program.SetUniform2i("u_blocks", self._means.size)
        step.program.SetUniformi("u_reach", blocks.reach)
        step.program.SetUniformf("u_variance", blocks.variance)
        step.program.SetUniform2i("u_along", (1, 0))
        _draw(window, step, self._blurred, {"u_means": self._means})
        step.program.SetUniform2i("u_along", (0, 1))
        _draw(window, step, self._means, {"u_means": self._blurred})


def _draw(
    window: vtkOpenGLRenderWindow, step: Rectangle, target: Target, sources: dict[str, Target]
) -> None:
    """Draw all pixels of a target from other targets, by the names of their samplers."""
    target.bind()
    for name, source in sources.items():
        source.texture.Activate()
        step.program.SetUniformi(name, source.texture.GetTextureUnit())
    step.draw(target, window)
    for source in sources.values():
        source.texture.Deactivate()
