"""Fields of scenes: reading, additional scalars, and sharing between equal fields.

A cache keeps the last flows with their traces, for all front ends.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.arguments import are_paths, checked_source
from flowtex._util.array_types import AnyArray
from flowtex._util.cache import ByteCache, WeakCache, digest
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.options import OF_MESHES, FieldOptions
from flowtex.field.steps import LazySteps
from flowtex.field.uncertainty import nodal_steps, with_uncertainty
from flowtex.settings import Settings
from flowtex.sources.datasets import is_dataset
from flowtex.sources.datasets.own_values import with_values
from flowtex.sources.meshes.vectors import with_array
from flowtex.sources.own_labels import values_in_order
from flowtex.sources.plain_arrays import (
    are_labelled,
    is_plain,
    labelled_dataset,
    read_arrays,
    read_labelled,
)
from flowtex.sources.read_fields import field_of_dataset, field_of_file, field_of_mesh
from flowtex.textures.tiles.pyramid import Pyramid
from flowtex.textures.tiles.shared import has_pyramid, shared_pyramid
from flowtex.trace.slices import TraceSlices
from flowtex.trace.store import SliceStore, chosen_lines, shared_store

#: Ratio of the memory of a field with its derived arrays to the memory of its own arrays.
DERIVED_FACTOR = 4
KEPT_BYTES = 500_000_000  #: Memory limit of the cache of drawn fields and traces, in bytes.
DATA = "Data"  #: Name of a scalar array without a name, as in PyVista.

_fields: WeakCache[FlowField] = WeakCache()
#: Number of values of an array that are compared first, to tell fields apart.
MOST_SAMPLED = 2000
#: Attributes that are compared as texts, or not at all.
APART = {"formula", "start", "section", "reading"}


def share_field(field: FlowField) -> FlowField:
    """Return an equal field that is in use already, or this one.

    A notebook shows one mesh many times, and makes a new field each time. Few fields are alike in a
    sample of their values, so all values are seldom read.
    """
    if has_pyramid(field):
        return field
    words, arrays = _identity(field)
    samples = []
    for array in arrays:
        samples.append(array.reshape(-1)[:: 1 + array.size // MOST_SAMPLED])
    found = _fields.get(digest(*samples, words=words), lambda: field)
    if found is field or _are_equal(arrays, _identity(found)[1]):
        return found
    return _fields.get(digest(*arrays, words=words), lambda: field)


def _identity(field: FlowField) -> tuple[list[object], list[AnyArray]]:
    """Return what makes a field: texts, numbers, shapes, and the arrays themselves."""
    formula = field.formula and (field.formula.texts, field.formula.parameters)
    words: list[object] = [str(formula), str(field.start)]
    arrays = []
    for name in sorted(FlowField.__dataclass_fields__.keys() - APART):
        value = getattr(field, name)
        parts: Mapping[str, Any] = {name: value}
        if isinstance(value, Mapping):
            parts = value
        for key, part in parts.items():
            words += [name, key]
            if isinstance(part, np.ndarray):
                arrays.append(part)
                words.append(part.shape)
            elif isinstance(part, LazySteps):
                # Lazy steps are identified by their object, which a field keeps alive.
                words.append(id(part))
            else:
                words.append(part)
    return words, arrays


def _are_equal(arrays: list[AnyArray], others: list[AnyArray]) -> bool:
    """Return whether arrays of the same shapes and types have the same values."""
    for one, other in zip(arrays, others, strict=True):
        if not np.array_equal(_bytes(one), _bytes(other)):
            return False
    return True


def _bytes(array: AnyArray) -> AnyArray:
    """Return the bytes of an array, (n,)."""
    return np.ascontiguousarray(array).reshape(-1).view(np.uint8)


def read_field(mesh: Any, options: FieldOptions, time: float | str | None = None) -> FlowField:
    """Return the field of a mesh or of a file (at one time), or a field unchanged.

    Raises
    ------
    FieldError
        For data without a flow, and for an array of colours whose nodes are unknown.
    """
    array = options.array
    uncertainty = options.uncertainty
    if array is not None and are_labelled(mesh):
        mesh, options = labelled_dataset(mesh, options)
    if array is not None:
        array = values_in_order(mesh, array, options.vectors)
    if array is not None and hasattr(mesh, "point_data"):
        mesh = with_array(mesh, DATA, array)
        array = None
    if is_plain(mesh) and not is_dataset(mesh):
        if array is None:
            own = {}
        else:
            own = {DATA: array}
        field = read_arrays(mesh, options, own)
        array = None
    else:
        if array is not None and is_dataset(mesh):
            changed = with_values(mesh, DATA, array, "scalars", options.vectors)
            if changed is not mesh:
                mesh = changed
                array = None
        field = _read(mesh, options, time)
    if array is not None:
        is_file = not isinstance(mesh, FlowField) and not is_dataset(mesh)
        if is_file and field.reading.of("coordinates"):
            raise FieldError(
                f"scalars is an array, but reading may change the order of the axes of {mesh}; "
                "open the file with xarray, add the array as in ds['name'] = (dims, array), and "
                "pass scalars='name'"
            )
        steps = nodal_steps(field, array, "scalars", "the name of an array, or ")
        field = field.same_flow(scalars={**field.scalars, DATA: steps})
    # Datasets and files are averaged where they are read.
    is_done = uncertainty is None or bool(field.uncertainty and field is not mesh)
    if is_done:
        return field
    return with_uncertainty(field, uncertainty)


def _read(mesh: Any, options: FieldOptions, time: float | str | None) -> FlowField:
    """Return the field of a mesh, a dataset, files or a store."""
    if (stored := _stored(mesh, options, time)) is not None:
        return stored
    if are_labelled(mesh):
        return read_labelled(mesh, options)
    if is_dataset(mesh):
        return field_of_dataset(mesh, options)
    if isinstance(mesh, (list, tuple)) and mesh:
        meshes = mesh
    else:
        meshes = [mesh]
    if are_paths(meshes):
        return field_of_file(mesh, options, time=time)
    if not isinstance(mesh, FlowField):
        return field_of_mesh(mesh, options)
    refused = [name for name in options.given if name != "uncertainty"]
    if refused:
        raise FieldError(
            f"{', '.join(refused)} cannot be set for a field that already exists, {mesh!r}; "
            "set it when you make the field"
        )
    return mesh


def is_stored(place: Any) -> bool:
    """Return whether a place is a store that flowtex built, whose field has its map already."""
    if not isinstance(place, (str, Path)) or checked_source(place).is_file():
        return False  # before anything is loaded
    from flowtex.pyramid import is_store
    from flowtex.pyramid.source import has_parts

    return has_parts(place) and is_store(place)


def _stored(place: Any, options: FieldOptions, time: float | str | None) -> FlowField | None:
    """Return the field of a pyramid in a store, where there is one."""
    if not isinstance(place, (str, Path)) or checked_source(place).is_file():
        return None  # before anything is loaded
    from flowtex.pyramid import is_store, open_store
    from flowtex.pyramid.source import has_parts

    if not has_parts(place):
        return None
    if is_store(place):
        names = []
        for name in options.given:
            if name != "uncertainty":
                names.append(name)
        if time is not None:
            names.append("time")
        if names:
            raise FieldError(f"{', '.join(names)} applies to the source of a pyramid; omit it")
    options.refuse(OF_MESHES, "meshes, but this is a dataset")
    choices = options.given
    if time is not None:
        choices["sel"] = {**choices.get("sel", {}), "time": time}
    return open_store(place, **choices)


def is_tiled(field: FlowField, settings: Settings) -> bool:
    """Return whether a large field is drawn in tiles."""
    return settings.noise == "procedural" and not field.sign_free


@dataclass(frozen=True)
class TracedFlow:
    """A field, its traces and its tiles; of a large field the traces of its coarsest level."""

    field: FlowField
    store: SliceStore
    pyramid: Pyramid | None

    @classmethod
    def of(cls, field: FlowField, settings: Settings) -> TracedFlow:
        """Return the traces from which scenes of a field draw their first picture."""
        lines = chosen_lines(field, settings.lines)
        pyramid = None
        if is_tiled(field, settings):
            pyramid = shared_pyramid(field, settings.parameter, lines)
        if pyramid is not None and pyramid.depth:
            whole = pyramid.root
        else:
            whole = field
        return cls(field, shared_store(whole, settings.parameter, lines), pyramid)

    @property
    def nbytes(self) -> int:
        """Size in memory with derived arrays, in bytes."""
        return DERIVED_FACTOR * self.field.nbytes + self.store.nbytes

    def keep(self) -> TracedFlow:
        """Keep the flow for the next picture of equal data, and return it.

        :func:`share_field` finds the field, and a store with equal data its slices. The cache drops
        the least recently drawn flow first. It keeps only the slices of a field with lazy steps,
        because such a field holds a file open.
        """
        field = self.field
        if any(isinstance(steps, LazySteps) for steps in (field.velocity, *field.scalars.values())):
            for slices in self.store.traced:
                kept_flows.put(id(slices), slices)
        elif not has_pyramid(field):
            kept_flows.put(id(self.store), self)
        return self


#: Cache of the last drawn flows, limited by memory.
kept_flows: ByteCache[int, TracedFlow | TraceSlices] = ByteCache(KEPT_BYTES, min_count=0)
