"""The method in NumPy: the judge of the other renderers' pictures.

``shaders/common`` is mirrored function by function, over all fragments at once. There are no
lights here, no edges and no smoothing of outlines: only what the method itself decides.
"""

from __future__ import annotations

from flowtex.rendering.cpu.render import Picture, render
from flowtex.rendering.cpu.shade import shade
from flowtex.rendering.cpu.texture import Lookup, LookupMaker, Sums

__all__ = ["Lookup", "LookupMaker", "Picture", "Sums", "render", "shade"]
