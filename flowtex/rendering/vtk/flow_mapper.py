"""The surface as PyVista draws it: its mesh, the shader's vertex attributes, and its mapper."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike
from pyvista.plotting.mapper import _BaseDataSetMapper
from pyvista.plotting.themes import Theme
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.vtkConstants import VTK_ID_TYPE
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataObject
from vtkmodules.vtkRenderingCore import vtkMapper, vtkPolyDataMapper

from flowtex._util.array_types import Floats, Floats32, Indices
from flowtex._util.colours import ColourScale
from flowtex.textures.geometry import SurfaceGeometry
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.triangle_geometry import TriangleGeometry

FAR_EXTENTS = 1e3  #: Extents from the origin from which on points count from another one.
POSITION = "flowtex position"  #: Point array of positions in the frame of the surface.
COORDINATE = "flowtex coordinate"  #: Point array of coordinates in the slices.
IMAGE = "flowtex image"  #: Point array of coordinates in an image.
CORNERS = "flowtex corners"
NORMAL = "Normals"
MOST_RANGES = 1e3  #: Greatest share of the range of a colour map.


def surface_mesh(textures: TextureSet) -> pv.PolyData:
    """Return the visible cells of the surface, with normals and the shader's attributes."""
    geometry = textures.geometry
    points = np.ascontiguousarray(geometry.at_vertices(geometry.points))
    near = np.abs(geometry.center).max() < FAR_EXTENTS * geometry.extent
    if near and geometry.corners is not None:
        points = points.astype(np.float32)  # there are six times as many vertices as nodes
    faces: Any = geometry.faces
    mesh = pv.PolyData.from_regular_faces(points, faces)
    mesh.point_data[NORMAL] = geometry.vertex_normals
    mesh.point_data.active_normals_name = NORMAL
    set_attributes(mesh, textures)
    return mesh


def set_triangles(mesh: pv.PolyData, triangles: Indices) -> None:
    """Draw other triangles, (N, 3), of the mesh's points."""
    cells = vtkCellArray()
    cells.SetData(3, numpy_to_vtk(triangles.ravel(), deep=True, array_type=VTK_ID_TYPE))
    mesh.SetPolys(cells)


def set_attributes(mesh: pv.PolyData, textures: TextureSet) -> None:
    """Write the vertex attributes of a texture set to its mesh."""
    geometry = textures.geometry
    mesh.point_data[COORDINATE] = geometry.coordinate.reshape(-1, 2)
    if (corners := geometry.corners) is not None:
        mesh.point_data[CORNERS] = corners
    if textures.image is not None:
        mesh.point_data[IMAGE] = textures.image.coordinate.reshape(-1, 2)


def map_attributes(mapper: Any, arrays: Mapping[str, str]) -> None:
    """Give the shader of a mapper the point arrays of some vertex attributes, and no others."""
    mapper.RemoveAllVertexAttributeMappings()
    for attribute, array in arrays.items():
        points = vtkDataObject.FIELD_ASSOCIATION_POINTS
        mapper.MapDataArrayToVertexAttribute(attribute, array, points, -1)


class Ends(NamedTuple):
    """The limits of the colours of one actor alone, whether they are chosen, and its values."""

    limits: tuple[float, float] = (0.0, 1.0)
    values: tuple[float, float] = (0.0, 1.0)
    are_chosen: bool = False


class Lacking(NamedTuple):
    """How a bar shows that values or data are missing in some places."""

    text: str
    color: tuple[float, ...]  #: From 0 to 1, (3,).


class FlowMapper(_BaseDataSetMapper, vtkPolyDataMapper):
    """``vtkPolyDataMapper``, whose attributes and events PyVista's mapper hides."""

    ends = Ends()
    lacking: Lacking | None = None  #: What is missing where the actor, or its map, is drawn.
    #: Identities of the mappers to whose common range the colours were last fitted.
    fitted_with: tuple[int, ...] = ()

    def __init__(self, dataset: pv.PolyData, theme: Theme | None = None) -> None:
        super().__init__(theme=theme)
        self.SetInputData(dataset)


def use_flow_mapper(actor: pv.Actor, mesh: pv.PolyData) -> FlowMapper:
    """Give an actor a mapper that is coloured by a point array of its own mesh, by name."""
    mapper = FlowMapper(mesh)
    mapper.ShallowCopy(actor.mapper)
    mapper.SetInputData(mesh)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SetInterpolateScalarsBeforeMapping(True)
    actor.SetMapper(mapper)
    return mapper


class NormTable(pv.LookupTable):
    """A lookup table of even shares, with the rows of a norm for shaders, which are exact."""

    texels: Floats32 = np.zeros((1, 4), np.float32)
    marks: Mapping[float, str] = MappingProxyType({})  #: Texts along a bar, by their places.


def lookup_table(scale: ColourScale) -> pv.LookupTable:
    """Return the lookup table of a colour scale."""
    if scale.edges is None:
        table = pv.LookupTable(values=scale.table)
    else:
        count = len(scale.table)
        middles = scale.low + (np.arange(count) + 0.5) / count * (scale.high - scale.low)
        values = np.column_stack([255 * scale.colours(middles), np.full(count, 255)])
        table = NormTable(values=np.rint(values).astype(np.uint8))
        table.texels = scale.texels
        table.marks = {place: text for _, place, text in scale.marks}
    table.log_scale = scale.log_scale
    table.scalar_range = (scale.low, scale.high)
    table.below_range_color = scale.below
    table.above_range_color = scale.above
    table.nan_color = scale.nan
    return table


class MappedColours(NamedTuple):
    """The colour map of a point array, and textures in which fragments look values up."""

    values: vtkDataArray  #: A value for each node.
    table: pv.LookupTable  #: The colour map.
    low: float  #: Range of the table.
    high: float
    on_cells: bool  #: Whether the values belong to cells, which are flat.
    state: tuple[object, ...]  #: Equal as long as the colours are the same.

    @classmethod
    def of(cls, mapper: vtkMapper, mesh: pv.PolyData, flat: str | None) -> MappedColours | None:
        """Return the colours of a mapper, if a table gives them; ``flat`` is the array on cells."""
        if mapper.GetScalarVisibility():
            name = mapper.GetArrayName()
        else:
            name = None
        if name:
            values = mesh.GetPointData().GetArray(name)
        else:
            values = None
        table = mapper.GetLookupTable()
        uses_table_range = mapper.GetUseLookupTableScalarRange()
        if uses_table_range:
            low, high = table.GetRange()
        else:
            low, high = mapper.GetScalarRange()
        if values is None or values.GetNumberOfComponents() != 1 or not high > low:
            return None
        if table.UsingLogScale() and not low > 0:
            return None
        state = (name, values.GetMTime(), table, table.GetMTime(), low, high)
        return cls(values, table, low, high, name == flat, state)

    def shares(self, geometry: SurfaceGeometry | TriangleGeometry) -> Floats32:
        """Return texels (1, J, I, 2): shares of the range, and 1; both 0 without a value."""
        nodal = vtk_to_numpy(self.values).astype(float)
        values = geometry.as_image(nodal, on_cells=self.on_cells)
        with np.errstate(all="ignore"):
            shares = (self._scaled(values) - self._scaled(self.low)) / (
                self._scaled(self.high) - self._scaled(self.low)
            )
        has_value = ~np.isnan(shares)
        shares = np.clip(np.where(has_value, shares, 0.0), -MOST_RANGES, MOST_RANGES)
        return np.stack([shares, has_value], axis=-1).astype(np.float32)[None]

    def colours(self) -> Floats32:
        """Return :attr:`ColourScale.texels` (1, 1, N + 3, 4) of the table."""
        if isinstance(self.table, NormTable):
            return self.table.texels[None, None]
        count = max(int(self.table.GetNumberOfAvailableColors()), 1)
        low = self._scaled(self.low)
        high = self._scaled(self.high)
        places = low + (np.arange(-1, count + 1) + 0.5) / count * (high - low)
        if self.table.UsingLogScale():
            inside = 10**places
        else:
            inside = places
        self.table.SetRange(self.low, self.high)
        self.table.BuildSpecialColors()  # which VTK does only when it draws
        values = numpy_to_vtk(np.append(inside, np.nan), deep=True)
        mapped = vtk_to_numpy(self.table.MapScalars(values, 0, 0)) / 255
        mapped[:, 3] = 0.0
        return np.asarray(mapped[None, None], dtype=np.float32)

    def _scaled(self, values: ArrayLike) -> Floats:
        return np.asarray(np.log10(values) if self.table.UsingLogScale() else values)
