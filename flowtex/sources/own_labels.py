"""An array with labels of pandas or xarray beside a flow: its values in the order of the flow."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex.field.matched_labels import check_positions, has_labels, is_pandas, matched
from flowtex.field.validation import with_gaps
from flowtex.sources.datasets import is_dataset
from flowtex.sources.datasets.select import choose_pair, two_names
from flowtex.sources.opening.dataset_files import as_datasets

#: Name of the array in messages.
NAME = "scalars"


def values_in_order(data: Any, array: Any, vectors: str | None = None) -> AnyArray:
    """Return the values of an array of colours; one with labels gets the order of the data.

    Parameters
    ----------
    data
        Plain arrays, a table or a dataset; others have no labels.
    array
        The array.
    vectors
        Names of the components of a dataset, if the user chose them.

    Raises
    ------
    FieldError
        When the labels are others than those of the data.
    """
    if not has_labels(array):
        return with_gaps(NAME, array)
    name, like = _labelled_part(data, array, vectors)
    if like is not None:
        if is_pandas(array) and not is_pandas(like):
            array = type(like)(np.asarray(array), [array.index, array.columns], like.dims)
        array = matched((name, NAME), (like, array))[1]
    elif isinstance(data, tuple) and len(data) > 2:
        check_positions(NAME, array, data[:2])
    elif isinstance(data, Mapping) and {"x", "y"} <= {*data}:
        check_positions(NAME, array, (data["x"], data["y"]))
    return with_gaps(NAME, array)


def _labelled_part(data: Any, array: Any, vectors: str | None) -> tuple[str, Any]:
    """Return a component with labels of the axes of an array and its name; ``None`` without one."""
    if is_pandas(data) and np.ndim(array) == 1:
        return "the table", data.iloc[:, 0]
    if is_dataset(data):
        return _component(data, array, vectors)
    named: list[tuple[str, Any]] = []
    if isinstance(data, Mapping):
        named = list(data.items())
    elif isinstance(data, tuple):
        named = [("u", item) for item in data]
    for name, item in reversed(named):
        if type(item).__name__ == type(array).__name__ and np.ndim(item) == np.ndim(array):
            return str(name), item
    return "", None


def _component(data: Any, array: Any, vectors: str | None) -> tuple[str, Any]:
    """Return the first component of a dataset on the axes of an array, or on rows and columns."""
    u = choose_pair(as_datasets(data), *two_names(vectors)).u
    dims = u.dims[-2:]
    if not is_pandas(array):
        dims = array.dims
    if np.ndim(array) < 2 or not {*dims} <= {*u.dims}:
        return "", None
    return str(u.name), u.isel({dim: 0 for dim in u.dims if dim not in dims}, drop=True)
