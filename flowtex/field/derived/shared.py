"""Derived scalars that are computed once for a field, however often they are drawn."""

from __future__ import annotations

from typing import Any

from flowtex._util.cache import WeakCache
from flowtex.field.derived.kinds import DERIVED
from flowtex.field.derived.quantities import steps_of, with_derived, with_vector_scalar
from flowtex.field.field_data import Data, FieldData
from flowtex.field.finer import finest_of
from flowtex.field.steps import Steps

_fields: WeakCache[Any] = WeakCache()


def with_scalars(field: Data, name: str | None) -> Data:
    """Return the field with a scalar that is derived from its vectors, such as vorticity.

    A field is returned unchanged that has the scalar already, whose vectors have no such
    derivative, as v and -v mean the same, or of which only a coarse level is in memory. Then
    :func:`steps_of` says what to do.
    """
    if name is None or name in ("speed", *field.scalars) or finest_of(field) is not None:
        return field
    if name in DERIVED and field.sign_free:
        return field

    def make() -> Data:
        if name in DERIVED:
            return with_derived(field, name)
        return with_vector_scalar(field, name)

    shared: Data = _fields.get(name, make, owner=field)
    return shared


def shared_steps(field: FieldData, name: str) -> Steps:
    """Return the values of a scalar at all times, (T or 1, J, I); :func:`steps_of` has errors."""
    return steps_of(with_scalars(field, name), name)
