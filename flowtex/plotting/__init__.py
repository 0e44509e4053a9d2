"""Flow textures in PyVista plotters."""
