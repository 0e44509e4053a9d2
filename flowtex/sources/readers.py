"""The readers that the constructors of a field call, by what they read.

The package registers this module in :mod:`flowtex.field.readers`.
"""

from __future__ import annotations

from collections.abc import Callable

from flowtex.field import FlowField
from flowtex.field.readers import Kind
from flowtex.sources.plain_arrays import read_arrays
from flowtex.sources.read_fields import field_of_dataset, field_of_file, field_of_mesh

READERS: dict[Kind, Callable[..., FlowField]] = {
    "arrays": read_arrays,
    "mesh": field_of_mesh,
    "file": field_of_file,
    "dataset": field_of_dataset,
}
