"""A PyVista mapper that draws polygons itself.

PyVista's own mapper hides the polygon mapper inside ``vtkDataSetMapper``, where neither vertex
attributes nor the event before a draw can be reached. This one is the polygon mapper, with the
same PyVista properties.
"""

from __future__ import annotations

from typing import Any

import pyvista as pv
from pyvista.plotting.mapper import _BaseDataSetMapper
from vtkmodules.vtkRenderingCore import vtkPolyDataMapper

__all__ = ["FlowMapper", "use_flow_mapper"]


class FlowMapper(_BaseDataSetMapper, vtkPolyDataMapper):
    """PyVista's mapper properties on ``vtkPolyDataMapper``."""

    def __init__(self, dataset: pv.PolyData, theme: Any = None) -> None:
        super().__init__(theme=theme)
        self.SetInputData(dataset)


def use_flow_mapper(actor: pv.Actor, mesh: pv.PolyData, scalars: str | None) -> FlowMapper:
    """Give an actor a polygon mapper with the colours of its present one.

    ``scalars`` names the point array to colour by; PyVista's mapper relies on the active array
    of a mesh of its own instead.
    """
    mapper = FlowMapper(mesh)
    mapper.ShallowCopy(actor.mapper)
    mapper.SetInputData(mesh)
    if scalars is not None:
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray(scalars)
    actor.SetMapper(mapper)
    return mapper
