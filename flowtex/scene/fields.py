"""Fields that scenes share: equal ones, and those with a further scalar."""

from __future__ import annotations

from flowtex._util.cache import WeakCache, digest
from flowtex.field import FlowField
from flowtex.field.derived import DERIVED
from flowtex.field.derived.vectors import with_vector_scalar
from flowtex.field.steps import LazySteps
from flowtex.textures.tiles.shared import has_pyramid

_fields: WeakCache[FlowField] = WeakCache()


def with_scalars(field: FlowField, name: str | None) -> FlowField:
    """Return the field with the scalar of its colours, if that is derived from vectors."""
    if name is None or name in field.scalars or has_pyramid(field):
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
    texts = (field.name, field.length_unit, field.time_unit, *field.long_names.items())
    text = field.formula and (field.formula.texts, field.formula.parameters)
    words = (*texts, str(text), field.periodic, field.sign_free, str(field.start), field.projection)
    units = (field.vectors, field.velocity_unit, *field.units.items())
    positions = () if field.has_position is None else (field.has_position,)
    joined = () if field.triangles is None else (field.triangles,)
    inputs = (field.points, field.velocity, field.times, field.valid, *positions, *joined)
    inputs += (*field.scalars.values(), *field.parts.values())
    # Lazy steps are identified by their object, which a field keeps alive.
    lazy_ids = tuple(id(a) for a in inputs if isinstance(a, LazySteps))
    arrays = (a for a in inputs if not isinstance(a, LazySteps))
    kind = (field.has_position is None, field.triangles is None)
    volume = tuple((k, len(v), float(v.sum())) for k, v in field.volume_values.items())
    names = (*field.scalars, field.on_cells, field.uncertainty, volume)
    key = digest(*arrays, words=(words, units, kind, lazy_ids, *names))
    return _fields.get(key, lambda: field)
