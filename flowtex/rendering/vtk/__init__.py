"""The texture in VTK: fragment shader replacements on a PyVista actor."""

from __future__ import annotations

from flowtex.rendering.vtk.flow_mapper import lookup_table, surface_mesh, use_flow_mapper
from flowtex.rendering.vtk.flow_surface import FlowSurface

__all__ = ["FlowSurface", "lookup_table", "surface_mesh", "use_flow_mapper"]
