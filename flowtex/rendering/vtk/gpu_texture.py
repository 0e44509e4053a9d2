"""Textures on the graphics card, through VTK's texture objects.

``vtkTexture`` has neither texture arrays nor half precision, so texture objects are used
directly. They belong to one render window, take a texture unit while a frame is drawn, and are
let go with the window at the latest.
"""

from __future__ import annotations

import numpy as np
from vtkmodules.util.vtkConstants import VTK_FLOAT
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderWindow, vtkTextureObject

from flowtex._util.array_types import AnyArray

#: OpenGL's numbers of internal formats by channels, in half precision and in single.
FORMATS, SINGLE = {1: 0x822D, 2: 0x822F, 4: 0x881A}, {2: 0x8230, 3: 0x8815}
#: OpenGL's number of numbers in half precision.
HALF_FLOAT = 0x140B


class GPUTexture:
    """One texture array with its mip levels; an image is an array of one layer.

    Of VTK's textures from memory the arrays alone get mip levels. The texels (layers, H, W,
    channels), with 1, 2 or 4 channels, are stored in half precision; 2 or 3 may be in ``single``.
    There are so many mip levels beside the finest, or all of them; ``repeat`` says whether the
    texture goes around along (v, u).
    """

    def __init__(
        self,
        texels: AnyArray,
        *,
        levels: int | None = None,
        repeat: tuple[bool, bool] = (False, False),
        single: bool = False,
    ) -> None:
        with np.errstate(over="ignore"):
            self._texels: AnyArray | None = np.ascontiguousarray(
                texels, np.float32 if single else np.float16
            )
        self._levels = levels
        self._repeat = repeat
        self._object: vtkTextureObject | None = None

    def bind(self, window: vtkOpenGLRenderWindow) -> int:
        """Return the texture unit in which the texture lies, sending it first if need be."""
        if self._object is None:
            self._object = self._send(window)
            self._texels = None
        if self._object.GetTextureUnit() < 0:
            self._object.Activate()
        return int(self._object.GetTextureUnit())

    def unbind(self) -> None:
        """Give the texture unit back."""
        if self._object is not None and self._object.GetTextureUnit() >= 0:
            self._object.Deactivate()

    def release(self, window: vtkOpenGLRenderWindow | None) -> None:
        """Free the memory on the graphics card."""
        if self._object is not None and window is not None:
            self.unbind()
            self._object.ReleaseGraphicsResources(window)
        self._object = None

    def _send(self, window: vtkOpenGLRenderWindow) -> vtkTextureObject:
        texels = self._texels
        if texels is None:
            msg = "the texture was released and cannot be sent again"
            raise RuntimeError(msg)
        target = vtkTextureObject()
        target.SetContext(window)
        target.SetGenerateMipmap(self._levels != 0)
        target.SetMinificationFilter(vtkTextureObject.LinearMipmapLinear)
        target.SetMagnificationFilter(vtkTextureObject.Linear)
        repeat, clamp = vtkTextureObject.Repeat, vtkTextureObject.ClampToEdge
        target.SetWrapS(repeat if self._repeat[1] else clamp)
        target.SetWrapT(repeat if self._repeat[0] else clamp)
        layers, height, width, channels = texels.shape
        whole = max(height, width).bit_length() - 1
        # Left as it is, VTK's greatest level is 0, and there is no other level.
        target.SetMaxLevel(whole if self._levels is None else self._levels)
        if texels.dtype == np.float32:
            target.SetInternalFormat(SINGLE[channels])
        else:
            target.SetInternalFormat(FORMATS[channels])
            # VTK has no name for half precision, and takes what was set for that of its own names.
            target.SetDataType(HALF_FLOAT)
        target.Create2DArrayFromRaw(width, height, channels, VTK_FLOAT, layers, texels)
        return target
