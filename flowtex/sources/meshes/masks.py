"""Nodes and cells without data: hidden ones, and vectors with a fill value.

Meshes hide nodes and cells in several ways: VTK's ghost arrays on points and on cells, PLOT3D's
``IBlank``, and the mask of points that a sampling filter missed.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from flowtex._util.array_types import Bools
from flowtex.sources.fill import undeclared_fill
from flowtex.sources.meshes.vectors import MeshArray, data_of, values_of
from flowtex.sources.record import Record

#: Flags of VTK's ghost arrays that hide: a hidden point; a refined or a hidden cell. Points and
#: cells that are duplicates of a neighbouring piece carry data and count as visible.
_HIDDEN_POINT, _HIDDEN_CELL = 2, 8 | 32


def hidden_nodes(mesh: Any) -> Bools:
    """Return which nodes a mesh hides, (N,)."""
    return np.any([np.zeros(mesh.n_points, bool), *_hidden(mesh).values()], axis=0)


def visible_cells(mesh: Any) -> Bools:
    """Return which cells a mesh shows, (N,)."""
    flags = mesh.cell_data.get("vtkGhostType", np.zeros(mesh.n_cells, np.uint8))
    return (np.asarray(flags) & _HIDDEN_CELL) == 0


def _hidden(mesh: Any) -> dict[str, Bools]:
    """Return the hidden nodes by the reason."""
    data, hidden = mesh.point_data, {}
    if "vtkGhostType" in data:
        hidden["vtkGhostType"] = (np.asarray(data["vtkGhostType"]) & _HIDDEN_POINT) != 0
    # Negative values and those above one are walls and overlaps of grids, with data.
    for name in ("IBlank", "vtkValidPointMask"):
        if name in data:
            hidden[f"{name} == 0"] = np.asarray(data[name]) == 0
    return hidden


class Masks:
    """The masks of a series, and the greatest share that each of them hides."""

    def __init__(self, velocity: MeshArray) -> None:
        self._velocity = velocity
        self._shares: dict[str, float] = {}
        self._fills: dict[float, float] = {}

    def masked(self, mesh: Any) -> Any:
        """Return a mesh whose vectors are NaN where they have a fill value."""
        hidden = {f"of the nodes are hidden: {name}": at for name, at in _hidden(mesh).items()}
        hidden["of the cells are hidden: vtkGhostType"] = ~visible_cells(mesh)
        name, where = self._velocity.name, self._velocity.where
        values = values_of(mesh, self._velocity)
        missing = np.asarray(np.isnan(values).any(axis=-1))
        hidden[f"of the {where} have no velocity: {name} is NaN"] = missing
        fills = dict.fromkeys(self._fills)
        left = np.where(np.isin(values, list(fills)), np.nan, values) if fills else values
        while (fill := undeclared_fill(left)) is not None:
            fills[fill] = None
            left = np.where(left == fill, np.nan, left)
        for fill in fills:
            share = float((values == fill).any(axis=-1).mean())
            self._fills[fill] = max(share, self._fills.get(fill, 0.0))
        for text, at in hidden.items():
            share = float(at.mean()) if at.size else 0.0
            self._shares[text] = max(share, self._shares.get(text, 0.0))
        if not fills:
            return mesh
        mesh = mesh.copy(deep=False)
        data = data_of(mesh, where)
        for part, column in zip(self._velocity.parts, left.T, strict=False):
            data[part] = column
        if not self._velocity.parts:
            data[name] = left
        return mesh

    def tell(self, record: Record) -> None:
        """Record what was hidden."""
        for text, share in self._shares.items():
            if share:
                record("mask", f"{_percent(share)} {text}")
        for fill, share in self._fills.items():
            text = f"{self._velocity.name} is {fill:g} there, which is taken for a fill value"
            what = f"of the {self._velocity.where} are masked"
            record("mask", f"{_percent(share)} {what}: {text}", notable=True)


def _percent(share: float) -> str:
    return f"{share:.0%}" if share >= 0.01 else "less than 1%"
