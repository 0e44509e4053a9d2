"""The method in NumPy: the judge of the other renderers' pictures.

``shaders/common`` is mirrored function by function, over all fragments at once. There are no
lights here, no edges and no smoothing of outlines: only what the method itself decides.
"""
