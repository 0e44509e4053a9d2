"""The method in NumPy: the judge of the other renderers' pictures.

``shaders/common`` is mirrored function by function, over all fragments at once. There are no
lights here, no edges and no smoothing of outlines: only what the method itself decides.
"""

from __future__ import annotations

from flowtex.renderers.cpu.camera import Camera
from flowtex.renderers.cpu.picture import Picture
from flowtex.renderers.cpu.render import render
from flowtex.renderers.cpu.shade import shade
from flowtex.renderers.cpu.smooth import smooth
from flowtex.renderers.cpu.texture import Lookup, LookupMaker, Sums

__all__ = ["Camera", "Lookup", "LookupMaker", "Picture", "Sums", "render", "shade", "smooth"]
