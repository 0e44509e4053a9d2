"""TraceSlices to TextureSet: packing, noise and step size; all that a renderer takes."""
