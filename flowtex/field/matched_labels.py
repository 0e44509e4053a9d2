"""Labels of pandas and xarray on plain arrays: components in one order, and their positions.

No library is loaded; the objects do the work with their own methods.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex.errors import FieldError


def matched(names: Sequence[str], arrays: Sequence[Any]) -> list[Any]:
    """Return arrays with their rows and columns in the order of the first one that has labels.

    Those without labels, and those of another kind, stay as they are.

    Raises
    ------
    FieldError
        When two arrays have other labels, or other dimensions.
    """
    found: list[Any] = []
    first: tuple[str, Any] | None = None
    for name, array in zip(names, arrays, strict=True):
        if not has_labels(array):
            found.append(array)
            continue
        if first is None:
            first = name, array
        found.append(_in_order(first, (name, array)))
    return found


def labelled_lines(arrays: Sequence[Any]) -> tuple[AnyArray, AnyArray] | None:
    """Return x (I,) and y (J,) by the labels of the columns and rows of tables, if these have any.

    Raises
    ------
    FieldError
        For arrays of xarray with coordinates, whose dimensions may be in any order.
    """
    first = arrays[0]
    if _is_xarray(first) and any(dim in first.coords for dim in first.dims[-2:]):
        raise FieldError(
            f"u and v have the coordinates {', '.join(map(str, first.coords))}, which from_arrays "
            "does not read; use FlowField.from_xarray([u, v]), or give x and y as well"
        )
    if not is_pandas(first) or np.ndim(first) != 2:
        return None
    lines = np.asarray(first.columns), np.asarray(first.index)
    counted = all(np.array_equal(line, np.arange(len(line))) for line in lines)
    if counted or not all(line.dtype.kind in "fiu" for line in lines):
        return None
    return lines


def check_positions(name: str, array: Any, places: Sequence[Any]) -> None:
    """Check that the labels of a table are not those of x and y in another order.

    Raises
    ------
    FieldError
        When they are.
    """
    if not is_pandas(array) or np.ndim(array) != 2 or len(places) != 2:
        return
    by_axis = {"columns": array.columns, "rows": array.index}
    for (axis, labels), place in zip(by_axis.items(), places, strict=True):
        own = np.asarray(labels)
        line = np.ravel(np.asarray(place))
        if own.dtype.kind not in "fiu" or own.shape != line.shape or np.allclose(own, line):
            continue
        if np.allclose(np.sort(own), np.sort(line)):
            raise FieldError(
                f"the {axis} of {name} have the labels {own[0]:g} to {own[-1]:g}, and the "
                f"positions are {line[0]:g} to {line[-1]:g}, the same in another order; pass the "
                "tables alone, as in flowtex.show(u, v)"
            )


def has_labels(array: Any) -> bool:
    """Return whether an array may have labels: a table of pandas, or an array of xarray."""
    return is_pandas(array) or _is_xarray(array)


def is_pandas(array: Any) -> bool:
    """Return whether this is a Series or a DataFrame of pandas."""
    return type(array).__name__ in ("DataFrame", "Series") and hasattr(array, "reindex_like")


def _is_xarray(array: Any) -> bool:
    return type(array).__name__ == "DataArray" and hasattr(array, "dims")


def _in_order(first: tuple[str, Any], second: tuple[str, Any]) -> Any:
    """Return the second of two named arrays in the order of the first one."""
    name, one = first
    other_name, other = second
    if one is other or type(one).__name__ != type(other).__name__:
        return other
    if _is_xarray(one):
        if {*one.dims} != {*other.dims}:
            return other
        other = other.transpose(*one.dims)
    for axis in range(np.ndim(one)):
        labels = _labels(one, axis)
        own = _labels(other, axis)
        if labels is None or own is None or labels.equals(own):
            continue
        is_same = len(labels) == len(own) and labels.is_unique and not len(labels.difference(own))
        if not is_same:
            both = f"{name}.align({other_name}, join='inner')"
            if _is_xarray(one):
                both = f"xarray.align({name}, {other_name}, join='inner')"
            raise FieldError(
                f"{name} and {other_name} have different labels, {_text(labels)} and {_text(own)}; "
                "expected the same ones in any order. Take those that both have, as in "
                f"{name}, {other_name} = {both}"
            )
    return other.reindex_like(one)


def _labels(array: Any, axis: int) -> Any:
    """Return the index of pandas along an axis; ``None`` without labels."""
    if is_pandas(array):
        return array.axes[axis]
    return array.indexes.get(array.dims[axis])


def _text(labels: Any) -> str:
    return f"{labels[0]} to {labels[-1]} ({len(labels)} values)"
