"""The texture in VTK: fragment shader replacements on a PyVista actor."""

from __future__ import annotations

from flowtex.renderers.vtk.layer import FlowLayer
from flowtex.renderers.vtk.mesh import surface_mesh

__all__ = ["FlowLayer", "surface_mesh"]
