"""Fields that scenes share: equal ones, and those with a further scalar."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from flowtex._util.cache import WeakCache, digest
from flowtex.field import FlowField
from flowtex.field.derived import DERIVED, with_vector_scalar
from flowtex.field.steps import LazySteps
from flowtex.textures.tiles.shared import has_pyramid

_fields: WeakCache[FlowField] = WeakCache()
#: Attributes that are compared as texts, or not at all.
APART = {"formula", "start", "section", "reading"}


def with_scalars(field: FlowField, name: str | None) -> FlowField:
    """Return the field with the scalar of its colours, if that is derived from vectors."""
    if name is None or name in ("speed", *field.scalars) or has_pyramid(field):
        return field
    if name not in DERIVED:
        return _fields.get(name, lambda: with_vector_scalar(field, name), owner=field)
    if field.sign_free:
        return field
    return _fields.get(name, lambda: field.with_derived(name), owner=field)


def share_field(field: FlowField) -> FlowField:
    """Return an equal field that is in use already, or this one.

    A notebook shows one mesh many times, and makes a new field each time.
    """
    if has_pyramid(field):
        return field
    formula = field.formula and (field.formula.texts, field.formula.parameters)
    words: list[object] = [str(formula), str(field.start)]
    arrays = []
    for name in sorted(FlowField.__dataclass_fields__.keys() - APART):
        value = getattr(field, name)
        for key, part in value.items() if isinstance(value, Mapping) else [(name, value)]:
            is_array = isinstance(part, np.ndarray)
            arrays += [part] if is_array else []
            # Lazy steps are identified by their object, which a field keeps alive.
            words += [name, key, id(part) if isinstance(part, LazySteps) else is_array or part]
    return _fields.get(digest(*arrays, words=words), lambda: field)
