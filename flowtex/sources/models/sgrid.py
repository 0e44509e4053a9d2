"""Grids whose topology SGRID declares: which dimensions are nodes, and which are middles of cells.

The dimensions of edges become those of nodes and cells, and get names by which rows, columns and
levels are recognised. Other steps then know the grid by these names alone.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError, import_extra
from flowtex.field import units
from flowtex.field.earth.projection import GLOBE, Projection
from flowtex.sources.datasets.axes import COLUMNS, ROWS
from flowtex.sources.datasets.coordinates import ACROSS, LATITUDE, LONGITUDE, UPWARD
from flowtex.sources.datasets.levels import LEVELS
from flowtex.sources.reader_errors import values_in

if TYPE_CHECKING:
    import xarray as xr

#: One entry of an attribute: a dimension, perhaps the one of the nodes, and the cells beyond these.
ENTRY = re.compile(r"([^\s:()]+)(?:\s*:\s*([^\s:()]+))?(?:\s*\(\s*padding\s*:\s*(\w+)\s*\))?")
#: Values of the padding.
PADDINGS = ("none", "low", "high", "both")
NODE = "node"
CELL = "face"
#: Places with coordinates.
PLACES = (NODE, CELL, "edge1", "edge2", "volume")
#: Names by which the dimensions of columns, rows and levels are known, and names that mislead.
KNOWN = ((COLUMNS, ROWS), (ROWS, COLUMNS), (LEVELS, COLUMNS))
#: Beginnings of names that are given to dimensions of columns, rows and levels.
PREFIXES = ("x_", "y_", "lev_")
#: Variables by name.
Variables = dict[str, Any]


class Axis(NamedTuple):
    """Dimensions of the nodes and of the cells along an axis, as declared."""

    node: str
    cell: str
    padding: str  #: Sides on which a cell lies beyond the nodes.


@dataclass(frozen=True)
class Topology:
    """A topology of SGRID, its axes of columns and rows, and perhaps that of levels."""

    name: str
    attrs: dict[str, Any]

    @cached_property
    def axes(self) -> list[Axis]:
        """Axes that are declared."""
        key = "volume_dimensions"
        if key not in self.attrs:
            key = "face_dimensions"
        text = f"{self.attrs.get(key, '')} {self.attrs.get('vertical_dimensions', '')}"
        axes = []
        for cell, node, padding in ENTRY.findall(text):
            axes.append(Axis(node, cell, padding))
        return axes

    @property
    def is_complete(self) -> bool:
        """Whether the axes of rows and columns are known, with the sides of the cells."""
        for axis in self.axes:
            if not axis.node or axis.padding not in PADDINGS:
                return False
        return len(self.axes) in (2, 3)

    @cached_property
    def names(self) -> list[dict[str, str]]:
        """Names of the dimensions of nodes and cells that tell their axis."""
        found = []
        for axis, (pattern, other), prefix in zip(self.axes, KNOWN, PREFIXES, strict=False):
            names = {NODE: axis.node, CELL: axis.cell}
            for kind, name in names.items():
                own = name
                if axis.node == axis.cell:
                    own = f"{name}_{kind}"
                if not pattern.match(own) or other.match(own):
                    own = prefix + own
                names[kind] = own
            found.append(names)
        return found

    @property
    def nodes(self) -> tuple[str, str]:
        """Names of the rows and columns of nodes."""
        return self.names[1][NODE], self.names[0][NODE]

    @property
    def cells(self) -> tuple[str, str]:
        """Names of the rows and columns of cells."""
        return self.names[1][CELL], self.names[0][CELL]

    @cached_property
    def new_names(self) -> dict[str, dict[str, str]]:
        """New names of dimensions by the kind of place, such as ``"edge1"``, and the old name."""
        found: dict[str, dict[str, str]] = {NODE: {}, CELL: {}, "volume": {}}
        for axis, names in zip(self.axes, self.names, strict=True):
            found[NODE][axis.node] = names[NODE]
            found[CELL][axis.cell] = names[CELL]
        found["volume"] = found[CELL]
        for number in range(len(self.axes)):
            found[f"edge{number + 1}"] = self._of_edges(number)
        return found

    def _of_edges(self, number: int) -> dict[str, str]:
        """Return new names of the dimensions of edges across one of the axes."""
        entries = ENTRY.findall(str(self.attrs.get(f"edge{number + 1}_dimensions", "")))
        is_declared = len(entries) == len(self.axes)
        found = {}
        for n, axis in enumerate(self.axes):
            # By default an edge lies on the nodes of one axis, between those of the others.
            dim = axis.cell
            is_cell = n != number
            if not is_cell:
                dim = axis.node
            if is_declared:
                dim, _, padding = entries[n]
                is_cell = bool(padding) or (dim == axis.cell != axis.node)
            found[dim] = self.names[n][NODE]
            if is_cell:
                found[dim] = self.names[n][CELL]
        return found

    def renamed(self, dim: str, place: str) -> str:
        """Return the new name of a dimension of a variable at a kind of place."""
        # The place decides where nodes and cells have one dimension.
        for where in (place, *self.new_names):
            names = self.new_names.get(where, {})
            if dim in names:
                return names[dim]
        return dim

    @property
    def in_new_names(self) -> dict[str, Any]:
        """The attributes of the topology, with the new names."""
        kept: dict[str, Any] = {}
        for key, value in self.attrs.items():
            if not key.endswith(("_dimensions", "_coordinates")):
                kept[key] = value
        words = []
        for names, axis in zip(self.names[:2], self.axes, strict=False):
            words.append(f"{names[CELL]}: {names[NODE]} (padding: {axis.padding})")
        kept["topology_dimension"] = 2
        kept["node_dimensions"] = " ".join(reversed(self.nodes))
        kept["face_dimensions"] = " ".join(words)
        return kept


def with_declared_axes(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset whose dimensions tell nodes from cells, where SGRID declares these.

    Raises
    ------
    FieldError
        When the topology declares no cells of two or three dimensions.
    """
    for name, variable in ds.variables.items():
        if variable.attrs.get("cf_role") != "grid_topology":
            continue
        topology = Topology(str(name), dict(variable.attrs))
        if topology.is_complete:
            return _renamed(ds, topology)
        raise FieldError(
            f"{name} is a grid topology of SGRID with face_dimensions "
            f"{variable.attrs.get('face_dimensions')!r}; expected two of the form 'xc: xn "
            f"(padding: none) yc: yn (padding: none)', with one of {', '.join(PADDINGS)}. Correct "
            f"the attribute, or delete it: del ds[{name!r}].attrs['cf_role']"
        )
    return ds


def _renamed(ds: xr.Dataset, topology: Topology) -> xr.Dataset:
    """Return a dataset in which dimensions and declared coordinates have telling names."""
    variables: Variables = {}
    for name, variable in ds.variables.items():
        place = str(variable.attrs.get("location", CELL))
        dims = {}
        for dim in map(str, variable.dims):
            dims[dim] = topology.renamed(dim, place)
        renamed = variable.to_base_variable().copy(deep=False)
        renamed.dims = tuple(dims.values())
        own = dims.get(str(name), str(name))  # labels have the name of their dimension
        variables.setdefault(own, renamed)
    variables[topology.name].attrs = topology.in_new_names
    coordinates = _coordinates(variables, topology)
    data: Variables = {}
    for name, variable in variables.items():
        if name in ds.coords or name in variable.dims:
            coordinates[name] = variable
        else:
            data[name] = variable
    whole: xr.Dataset = import_extra("xarray", "xarray").Dataset(data, coordinates, ds.attrs)
    whole.encoding = dict(ds.encoding)
    return whole


def _coordinates(variables: Variables, topology: Topology) -> Variables:
    """Take the declared coordinates from variables, under names that tell x from y.

    Those of cells are means of the nodes, if no others are known.
    """
    declared: dict[str, list[str]] = {}
    for place in PLACES:
        given = str(topology.attrs.get(f"{place}_coordinates", "")).split()[:2]
        if len(given) == 2 and {*given} <= {*variables}:
            declared[place] = given
    if NODE in declared and not {CELL, "volume"} & {*declared}:
        middles = _middles(variables, declared[NODE], topology)
        if middles:
            variables |= middles
            declared[CELL] = list(middles)
    coordinates: Variables = {}
    for place, given in declared.items():
        coordinates |= _telling(variables, given, place)
    return coordinates


def _telling(variables: Variables, given: list[str], place: str) -> Variables:
    """Take two coordinates from variables, under names that tell which is x."""
    first, second = given
    if LATITUDE.match(first) or UPWARD.match(first):
        first, second = second, first
    x = variables.pop(first)
    y = variables.pop(second)
    on_earth = LONGITUDE.match(first) and LATITUDE.match(second)
    if on_earth or (ACROSS.match(first) and UPWARD.match(second)):
        return {first: x, second: y}
    if units.is_angle(str(x.attrs.get("units", ""))):
        return {f"lon_{place}": x, f"lat_{place}": y}
    return {f"x_{place}": x, f"y_{place}": y}


def _middles(variables: Variables, given: list[str], topology: Topology) -> Variables:
    """Return the means of the nodes around each cell; empty where they are known or unknown."""
    for name, variable in variables.items():
        if {*variable.dims} == {*topology.cells} and (LONGITUDE.match(name) or ACROSS.match(name)):
            return {}
    paddings = {axis.padding for axis in topology.axes[:2]}
    nodes = [variables[name] for name in given]
    if paddings != {"none"}:
        return {}
    values = []
    for c, line in zip(nodes, reversed(topology.nodes), strict=True):
        if c.dims == (line,):
            values.append(np.asarray(values_in(c), dtype=float))
        elif {*c.dims} == {*topology.nodes}:
            values.append(np.asarray(values_in(c.transpose(*topology.nodes)), dtype=float))
        else:
            return {}
    x, y = values
    if x.ndim != y.ndim:
        return {}
    is_earth = units.is_angle(str(nodes[0].attrs.get("units", "")))
    dims: list[tuple[str, ...]]
    if x.ndim == 1:
        means = ((x[1:] + x[:-1]) / 2, (y[1:] + y[:-1]) / 2)
        dims = [topology.cells[1:], topology.cells[:1]]
    else:
        means = _of_corners(x, y, is_earth=is_earth)
        dims = [topology.cells, topology.cells]
    variable = import_extra("xarray", "xarray").Variable
    found = {}
    for name, c, own, mean in zip(given, nodes, dims, means, strict=True):
        found[f"{name}_{CELL}"] = variable(own, mean, c.attrs)
    return found


def _of_corners(x: Floats, y: Floats, *, is_earth: bool) -> tuple[Floats, Floats]:
    """Return the means of the four corners of each cell, (J, I) each, of nodes (J + 1, I + 1)."""
    p = np.stack([x, y], axis=-1)
    if is_earth:
        p = Projection(GLOBE).positions(x, y)
    middle = (p[1:, 1:] + p[1:, :-1] + p[:-1, 1:] + p[:-1, :-1]) / 4
    if is_earth:
        return Projection(GLOBE).lonlat(middle)
    return middle[..., 0], middle[..., 1]
