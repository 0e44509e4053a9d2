"""The texture in VTK: fragment shader replacements on a PyVista actor."""

from __future__ import annotations

from flowtex.rendering.vtk.mesh import lookup_table, surface_mesh, use_flow_mapper
from flowtex.rendering.vtk.surface import FlowSurface

__all__ = ["FlowSurface", "lookup_table", "surface_mesh", "use_flow_mapper"]
