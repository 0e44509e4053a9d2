"""TraceSlices to TextureSet: packing, noise and step size; all that a renderer is given."""

from __future__ import annotations

from flowtex.textures.geometry import Geometry
from flowtex.textures.paper import PaperTextures
from flowtex.textures.textureset import TextureSet

__all__ = ["Geometry", "PaperTextures", "TextureSet"]
