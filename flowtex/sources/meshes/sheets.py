"""The drawn nodes of a mesh at one time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.sources.meshes.vectors import MeshArray


@dataclass(kw_only=True)
class Sheet:
    """Positions (..., 3) and visibility (...) of nodes, which are (J, I) or (N,).

    ``nodes`` computes the values of an array at the nodes, and ``arrays`` are all that there are.
    """

    points: Floats
    shown: Bools
    arrays: list[MeshArray]
    nodes: Callable[[MeshArray], Floats]
    #: Corners of triangles (M, 3), or the cells of a grid that are shown and have a velocity,
    #: (J - 1, I - 1), and whether the last line along (j, i) repeats the first one.
    triangles: Indices | None = None
    cells: Bools | None = None
    wrap: tuple[bool, bool] = (False, False)
