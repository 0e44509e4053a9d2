"""Reading the finest level of a large field that has only a coarse level in memory."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.field_data import FINEST, FieldData


class FinePart(NamedTuple):
    """Some nodes of the finest level."""

    field: FieldData
    #: Takes (j, i) in this part to that in the coarse field.
    coarse_index: Callable[[tuple[float, float]], tuple[float, float]]


class Finest(Protocol):
    """The finest level of a field."""

    def near(self, place: Floats) -> FinePart:
        """Return the nodes around a place (3,) in space, on the Earth on the globe."""
        ...


def finest_of(field: FieldData) -> Finest | None:
    """Return what reads the finest level of a field; ``None`` if the field has all nodes."""
    finest: Finest | None = vars(field).get(FINEST)
    return finest


def check_derivable(field: FieldData, name: str) -> None:
    """Check that a field has the nodes from which a scalar is derived.

    Raises
    ------
    FieldError
        When only a coarser level of a large field is in memory.
    """
    if finest_of(field) is None:
        return
    rows, columns = field.shape
    raise FieldError(
        f"{name} needs all nodes, but of this large field only {columns} x {rows} are in memory; "
        f'derive it before building a store, as in flowtex.pyramid.build(field.with_derived("'
        f'{name}"), "flow.zarr"), or from the part that you need'
    )
