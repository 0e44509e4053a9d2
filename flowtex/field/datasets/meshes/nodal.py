"""Values at the nodes of a mesh, of those at its nodes or in its faces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex.earth import GLOBE, Projection
from flowtex.field.datasets.axes import NODES, Choice, Section, sections
from flowtex.field.datasets.meshes.mesh import Mesh
from flowtex.field.triangles.arrays import nodal_means

#: Variables that tell which nodes or faces are under water, and what they have there.
WET = {
    "wet_nodes": 1,
    "wet_cells": 1,
    "wetdry_node": 0,
    "wetdry_elem": 0,
    "dryFlagNode": 0,
    "dryFlagElement": 0,
}


class NodalValues:
    """What brings values to the nodes of a mesh: those of faces become means by area."""

    def __init__(self, mesh: Mesh, dim: str) -> None:
        self.mesh, self.at_nodes = mesh, dim == NODES

    def scalar(self, values: Floats) -> Floats:
        """Return values (N,) of those at nodes or in faces."""
        return values if self.at_nodes else self._means(values)

    def vector(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return components (N,) eastward and northward, or along x and y.

        On the Earth these directions are others in each face, so that vectors in space are
        averaged.
        """
        if self.at_nodes:
            return u, v
        if not self.mesh.is_earth:
            x, y = self._means(np.stack([u, v], axis=-1)).T
            return x, y
        globe = Projection(GLOBE)
        means = self._means(globe.vectors(*self.mesh.middles, u, v))
        return globe.components(self.mesh.a, self.mesh.b, means)

    @cached_property
    def _means(self) -> Callable[[Floats], Floats]:
        mesh = self.mesh

        def means(values: Floats) -> Floats:
            (step,) = nodal_means(values[None], mesh.faces, mesh.areas, len(mesh.a))
            return np.asarray(step)

        return means


def wet_at(
    section: Section, dim: str, datasets: Sequence[Any], choice: Choice
) -> Callable[[int], Bools] | None:
    """Return what tells which nodes or faces are under water at a step of a velocity."""
    plain = Choice(choice.sel, choice.isel, {*choice.sel, *choice.isel})
    for ds in datasets:
        for name, water in WET.items():
            if name in ds.data_vars and dim in ds[name].dims:
                (flags,) = sections([ds[name]], plain)
                if flags.is_series == section.is_series:
                    return _reader(flags, water)
    return None


def _reader(flags: Section, water: int) -> Callable[[int], Bools]:
    return lambda number: np.asarray(flags.step(number).values) == water
