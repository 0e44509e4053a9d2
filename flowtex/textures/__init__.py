"""TraceSlices to TextureSet: packing, noise and step size; all that a renderer takes."""

from __future__ import annotations

from flowtex.textures.geometry import SurfaceGeometry
from flowtex.textures.images import ImageError, as_picture
from flowtex.textures.paper import PaperTextures
from flowtex.textures.texture_set import LayerPrefetch, TextureSet, check_noise
from flowtex.textures.triangle_geometry import TriangleGeometry

__all__ = [
    "ImageError",
    "LayerPrefetch",
    "PaperTextures",
    "SurfaceGeometry",
    "TextureSet",
    "TriangleGeometry",
    "as_picture",
    "check_noise",
]
