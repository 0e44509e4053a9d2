"""What remains of the arrays of a source when they are checked: the nodes of a field."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from flowtex._util.array_types import Bools, Indices
from flowtex.field.field_arrays import SectionAxes
from flowtex.field.steps import Steps
from flowtex.field.triangles.triangle_surface import Surface


class CheckedNodes(NamedTuple):
    """The surface of a field, and the values at its nodes, at rest where they are not valid."""

    surface: Surface
    velocity: Steps  #: (T, J, I, 3), in the unit of the source.
    scalars: Mapping[str, Any]  #: Those at nodes, and those of cells after them.
    has_position: Bools | None = None  #: Nodes of a grid whose position is known.
    sign_free: bool = False
    section: SectionAxes | None = None
    triangles: Indices | None = None  #: Corners of triangles, (M, 3).
