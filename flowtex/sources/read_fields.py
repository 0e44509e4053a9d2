"""Fields of meshes, files and datasets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

from flowtex.errors import require_pyvista
from flowtex.field import FlowField
from flowtex.field.field_arrays import SourceArrays
from flowtex.field.options import FieldOptions
from flowtex.field.uncertainty import UNCERTAINTY, with_uncertainty
from flowtex.field.validation import with_gaps
from flowtex.sources.datasets.own_values import with_values
from flowtex.sources.datasets.read_datasets import read_datasets
from flowtex.sources.meshes.read_meshes import read_meshes
from flowtex.sources.read_files import errors_of, read_files


def field_of_mesh(mesh: Any, options: FieldOptions, *, name: str = "") -> FlowField:
    """Return the field of a mesh, as :meth:`flowtex.FlowField.from_pyvista` describes it."""
    require_pyvista(f"a flow from an object of type {type(mesh).__name__}")
    field = FlowField.of(read_meshes(mesh, options, name=name))
    return with_uncertainty(field, options.uncertainty)


def field_of_file(
    path: str | Path | Sequence[str | Path],
    options: FieldOptions,
    *,
    time: float | str | None = None,
) -> FlowField:
    """Return the field of files, as :meth:`flowtex.FlowField.from_file` describes it."""
    with errors_of(path):
        arrays = cast("SourceArrays", read_files(path, options, time=time))
        return with_uncertainty(FlowField.of(arrays), options.uncertainty)


def field_of_dataset(data: Any, options: FieldOptions, *, name: str = "") -> FlowField:
    """Return the field of datasets, as :meth:`flowtex.FlowField.from_xarray` describes it."""
    uncertainty: Any = options.uncertainty
    if uncertainty is not None and not isinstance(uncertainty, str):
        values = with_gaps("uncertainty", uncertainty)
        changed = with_values(data, UNCERTAINTY, values, "uncertainty", options.vectors)
        if changed is not data:
            data = changed
            options = replace(options, uncertainty=UNCERTAINTY)
    field = FlowField.of(cast("SourceArrays", read_datasets(data, options, name=name)))
    return with_uncertainty(field, options.uncertainty)
