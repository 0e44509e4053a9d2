"""The method in NumPy: the judge of the other renderers' pictures.

``shaders/common`` is mirrored function by function, over all fragments at once. There are no
lights here, no edges and no smoothing of outlines: only what the method itself decides.
"""

from __future__ import annotations

from flowtex.rendering.cpu.camera import Camera
from flowtex.rendering.cpu.picture import Picture
from flowtex.rendering.cpu.render import render
from flowtex.rendering.cpu.shade import shade
from flowtex.rendering.cpu.smooth import smooth
from flowtex.rendering.cpu.texture import Lookup, LookupMaker, Sums

__all__ = ["Camera", "Lookup", "LookupMaker", "Picture", "Sums", "render", "shade", "smooth"]
