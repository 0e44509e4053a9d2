"""Textures off the screen, and programs that draw rectangles of pixels into them."""

from __future__ import annotations

from typing import TypeAlias

from vtkmodules.util.vtkConstants import VTK_FLOAT
from vtkmodules.vtkRenderingOpenGL2 import (
    vtkOpenGLFramebufferObject,
    vtkOpenGLRenderWindow,
    vtkOpenGLVertexArrayObject,
    vtkShaderProgram,
    vtkTextureObject,
)

from flowtex.rendering.shaders import shader_text

#: VTK begins shaders with what it writes for these.
MARKS = "//VTK::System::Dec\n//VTK::Output::Dec\n"


#: OpenGL's numbers of textures of one, two and four channels in half precision.
HALF_FLOATS = {1: 0x822D, 2: 0x822F, 4: 0x881A}
#: First and end of columns and rows of pixels.
Box: TypeAlias = tuple[int, int, int, int]


class Target:
    """A texture of some channels, into which passes draw, maybe with depths.

    It is in single precision, or in half precision, which takes less time.
    """

    def __init__(
        self,
        channels: int,
        *,
        is_half: bool = False,
        has_depth: bool = False,
        depth_of: Target | None = None,
    ) -> None:
        self._channels = channels
        self._is_half = is_half
        self.texture = vtkTextureObject()
        self.frame = vtkOpenGLFramebufferObject()
        self._depth: vtkTextureObject | None = None
        if has_depth:
            self._depth = vtkTextureObject()
        #: A target whose depths it shares, which is fitted before.
        self._depth_of = depth_of

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self.texture.GetWidth(), self.texture.GetHeight()

    def fit(self, window: vtkOpenGLRenderWindow, size: tuple[int, int]) -> None:
        """Have a texture of a width and a height."""
        if self.size == size:
            return
        self.frame.SetContext(window)
        self.frame.Bind()
        self.texture.SetContext(window)
        if self._is_half:
            self.texture.SetInternalFormat(HALF_FLOATS[self._channels])
        self.texture.Allocate2D(*size, self._channels, VTK_FLOAT)
        self.frame.AddColorAttachment(0, self.texture)
        if self._depth is not None:
            self._depth.SetContext(window)
            self._depth.AllocateDepth(*size, vtkTextureObject.Float32)
            self.frame.AddDepthAttachment(self._depth)
        shared = self._depth_of
        if shared is not None and shared._depth is not None:
            self.frame.AddDepthAttachment(shared._depth)

    def grow(self, window: vtkOpenGLRenderWindow, size: tuple[int, int]) -> None:
        """Have a texture of at least a width and a height."""
        width, height = self.size
        self.fit(window, (max(width, size[0]), max(height, size[1])))

    def bind(self) -> None:
        """Draw into the texture from now on."""
        self.frame.Bind()
        self.frame.ActivateDrawBuffer(0)


class Rectangle:
    """A program that draws a rectangle of pixels, with the text of a fragment shader."""

    def __init__(self, name: str, variant: frozenset[str]) -> None:
        self._texts = [
            MARKS + shader_text(f"vtk/{text}.glsl", variant)
            for text in ("sum_vertex", f"{name}_fragment")
        ]
        self._vertices = vtkOpenGLVertexArrayObject()
        self._program: vtkShaderProgram | None = None
        self._context = 0  # the time at which VTK made the context of both

    @property
    def program(self) -> vtkShaderProgram:
        """The program in use."""
        assert self._program is not None
        return self._program

    def use(self, window: vtkOpenGLRenderWindow) -> None:
        """Draw with the program from now on."""
        cache = window.GetShaderCache()
        if window.GetContextCreationTime() != self._context:
            self._context = window.GetContextCreationTime()
            self._vertices = vtkOpenGLVertexArrayObject()
            self._program = None
        if self._program is None:
            self._program = cache.ReadyShaderProgram(self._texts[0], self._texts[1], "")
        else:
            cache.ReadyShaderProgram(self._program)

    def draw(
        self,
        target: Target,
        window: vtkOpenGLRenderWindow,
        box: Box | None = None,
        depth: float = 0.0,
    ) -> None:
        """Run the program once for each pixel of a target.

        Parameters
        ----------
        target
            The textures into which the program draws.
        window
            The window that has the OpenGL context.
        box
            Pixels to draw: first and end of columns and rows; all by default.
        depth
            Depth of the rectangle from 0 to 1, for the depth test.
        """
        width, height = target.size
        self.program.SetUniformf("u_depth", 2 * depth - 1)
        target.frame.StartNonOrtho(width, height)
        window.GetState().vtkglViewport(0, 0, width, height)
        # VTK draws it narrower by up to a pixel; the depths of what is beside it are others.
        left, right, low, high = box or (0, width, 0, height)
        first = max(left - 1, 0)
        last = max(low - 1, 0)
        target.frame.RenderQuad(first, right, last, high, self.program, self._vertices)
