"""TraceSlices to TextureSet: packing, noise and step size; all that a renderer is given."""

from __future__ import annotations

from flowtex.textures.ahead import Ahead
from flowtex.textures.geometry import Geometry
from flowtex.textures.images import ImageError, as_picture
from flowtex.textures.paper import PaperTextures
from flowtex.textures.texture_set import TextureSet

__all__ = ["Ahead", "Geometry", "ImageError", "PaperTextures", "TextureSet", "as_picture"]
