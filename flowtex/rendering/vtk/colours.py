"""Values of the nodes and their colours as textures, in which a fragment looks up its own.

Triangles would have to be as small as cells where colours are interpolated across them, and
triangles of a few pixels are shaded several times over.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkRenderingCore import vtkMapper

from flowtex._util.array_types import Floats, Floats32
from flowtex.textures import SurfaceGeometry, TriangleGeometry

#: Greatest share of the range of a colour map that half precision is to hold.
MOST_RANGES = 1e3


class MappedColours(NamedTuple):
    """The colour map of a point array of a mesh."""

    values: vtkDataArray  #: A value for each node.
    table: pv.LookupTable  #: The colour map.
    low: float  #: Range of the table.
    high: float
    state: tuple[object, ...]  #: Equal as long as the colours are the same.

    @classmethod
    def of(cls, mapper: vtkMapper, mesh: pv.PolyData) -> MappedColours | None:
        """Return the colours of a mapper, or None where its mesh is not coloured by a table."""
        name = mapper.GetArrayName() if mapper.GetScalarVisibility() else None
        values = mesh.GetPointData().GetArray(name) if name else None
        table = mapper.GetLookupTable()
        uses_table_range = mapper.GetUseLookupTableScalarRange()
        low, high = table.GetRange() if uses_table_range else mapper.GetScalarRange()
        if values is None or values.GetNumberOfComponents() != 1 or not high > low:
            return None
        if table.UsingLogScale() and not low > 0:
            return None
        state = (name, values.GetMTime(), table, table.GetMTime(), low, high)
        return cls(values, table, low, high, state)

    def shares(self, geometry: SurfaceGeometry | TriangleGeometry) -> Floats32:
        """Return texels (1, J, I, 2): shares of the range, and 1; both 0 where there is no value.

        Those of triangles lie as in the slices. So interpolated, the first over the second is the
        mean of those that are known.
        """
        values = geometry.as_image(vtk_to_numpy(self.values).astype(float))
        with np.errstate(all="ignore"):
            shares = (self._scaled(values) - self._scaled(self.low)) / (
                self._scaled(self.high) - self._scaled(self.low)
            )
        has_value = ~np.isnan(shares)
        shares = np.clip(np.where(has_value, shares, 0.0), -MOST_RANGES, MOST_RANGES)
        return np.stack([shares, has_value], axis=-1).astype(np.float32)[None]

    def colours(self) -> Floats32:
        """Return texels (1, 1, N + 3, 4): below the range, its N colours, above, without value."""
        count = max(int(self.table.GetNumberOfAvailableColors()), 1)
        low, high = self._scaled(self.low), self._scaled(self.high)
        places = low + (np.arange(-1, count + 1) + 0.5) / count * (high - low)
        inside = 10**places if self.table.UsingLogScale() else places
        self.table.SetRange(self.low, self.high)
        values = numpy_to_vtk(np.append(inside, np.nan), deep=True)
        mapped = vtk_to_numpy(self.table.MapScalars(values, 0, 0))
        return np.asarray(mapped[None, None] / 255, dtype=np.float32)

    def _scaled(self, values: ArrayLike) -> Floats:
        return np.asarray(np.log10(values) if self.table.UsingLogScale() else values)
