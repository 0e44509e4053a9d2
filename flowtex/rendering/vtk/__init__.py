"""The texture in VTK: fragment shader replacements on a PyVista actor."""

from __future__ import annotations

from flowtex.rendering.vtk.layer import FlowLayer
from flowtex.rendering.vtk.mesh import set_attributes, surface_mesh, use_flow_mapper

__all__ = ["FlowLayer", "set_attributes", "surface_mesh", "use_flow_mapper"]
