"""The drawn nodes of a mesh at one time, and the nodes and cells without data.

Meshes hide nodes and cells in several ways: VTK's ghost arrays on points and on cells, PLOT3D's
``IBlank``, and the mask of points that a sampling filter missed. Vectors may have a fill value.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.sources.datasets.masks import undeclared_fill
from flowtex.sources.meshes.vectors import MeshArray, data_of, values_of
from flowtex.sources.record import Record

#: Flags of VTK's ghost arrays that hide: a hidden point; a refined or a hidden cell. Points and
#: cells that are duplicates of a neighbouring piece carry data and count as visible.
_HIDDEN_POINT, _HIDDEN_CELL = 2, 8 | 32


@dataclass(kw_only=True)
class Sheet:
    """Positions (..., 3) and visibility (...) of nodes, which are (J, I) or (N,).

    ``nodes`` computes the values of an array at the nodes, ``flat`` returns those of the cells,
    (J - 1, I - 1) or (M,), and ``arrays`` are all that there are.
    """

    points: Floats
    shown: Bools
    arrays: list[MeshArray]
    nodes: Callable[[MeshArray], Floats]
    flat: Callable[[MeshArray], Floats]
    #: Corners of triangles (M, 3), or the cells of a grid that are shown and have a velocity,
    #: (J - 1, I - 1), and whether the last line along (j, i) repeats the first one.
    triangles: Indices | None = None
    cells: Bools | None = None
    wrap: tuple[bool, bool] = (False, False)


def hidden_nodes(mesh: Any) -> Bools:
    """Return which nodes a mesh hides, (N,)."""
    return np.any([np.zeros(mesh.n_points, bool), *_hidden(mesh).values()], axis=0)


def visible_cells(mesh: Any) -> Bools:
    """Return which cells a mesh shows, (N,)."""
    flags = mesh.cell_data.get("vtkGhostType", np.zeros(mesh.n_cells, np.uint8))
    return (np.asarray(flags) & _HIDDEN_CELL) == 0


def _hidden(mesh: Any) -> dict[str, Bools]:
    """Return the hidden nodes by the reason."""
    # Negative values and those above one are walls and overlaps of grids, with data.
    tests: dict[str, Callable[[Any], Bools]] = {
        "vtkGhostType": lambda flags: (flags & _HIDDEN_POINT) != 0,
        "IBlank": lambda flags: flags == 0,
        "vtkValidPointMask": lambda flags: flags == 0,
    }
    data = mesh.point_data
    return {name: test(np.asarray(data[name])) for name, test in tests.items() if name in data}


class Masks:
    """The masks of a series, and the greatest share that each of them hides."""

    def __init__(self, velocity: MeshArray) -> None:
        self._velocity = velocity
        self._shares: dict[str, float] = {}
        self._fills: dict[float, str] = {}

    def masked(self, mesh: Any) -> Any:
        """Return a mesh whose vectors are NaN where they have a fill value."""
        name, where, parts = self._velocity.name, self._velocity.where, self._velocity.parts
        values = values_of(mesh, self._velocity)
        hidden = {f"of the nodes are hidden by {array}": at for array, at in _hidden(mesh).items()}
        hidden["of the cells are hidden by vtkGhostType"] = ~visible_cells(mesh)
        if values.size and np.isnan(values.min()):
            missing = f"of the {where} have no velocity: {name} is NaN"
            hidden[missing] = np.asarray(np.isnan(values).any(-1))
        visible = visible_cells(mesh) if where == "cells" else ~hidden_nodes(mesh)
        known = values if visible.all() else values[visible]
        for fill in self._fills:
            known = np.where(known == fill, np.nan, known)
        while (found := undeclared_fill(known)) is not None:
            text = f"{name} is {found:g} there, which is taken for a fill value"
            self._fills[found] = f"of the {where} are masked: {text}"
            known = np.where(known == found, np.nan, known)
        for fill, text in self._fills.items():
            hidden[text] = (values == fill).any(axis=-1) & visible
        for text, at in hidden.items():
            share = float(at.mean()) if at.size else 0.0
            self._shares[text] = max(share, self._shares.get(text, 0.0))
        if not self._fills:
            return mesh
        left = np.where(np.isin(values, list(self._fills)), np.nan, values)
        mesh = mesh.copy(deep=False)
        for array, column in zip(parts or (name,), left.T if parts else (left,), strict=True):
            data_of(mesh, where)[array] = column
        return mesh

    def tell(self, record: Record) -> None:
        """Record what was hidden."""
        for text, share in self._shares.items():
            percent = f"{share:.0%}" if share >= 0.01 else "less than 1%"
            if share:
                record("mask", f"{percent} {text}", notable=text in self._fills.values())
