"""Arrays of the user beside a dataset or table, which become one more variable of it.

Reading may reverse axes, exchange them or close them around the Earth. A variable follows, because
its labels do; an array that is laid onto the nodes afterwards would not.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

from flowtex._util.array_types import AnyArray
from flowtex.errors import FieldError
from flowtex.sources.datasets.select import choose_pair, two_names
from flowtex.sources.opening.dataset_files import as_datasets

if TYPE_CHECKING:
    import xarray as xr


def with_values(
    data: Any, name: str, values: AnyArray, argument: str, vectors: str | None = None
) -> Any:
    """Return data with an array as one more variable or column.

    Parameters
    ----------
    data
        A dataset, a table, or a list of datasets.
    name
        Name of the new variable.
    values
        Along the axes of the velocity, in their order, perhaps without those before the rows. Of a
        table (N,).
    argument
        Name of the argument, for messages.
    vectors
        Names of the components, if the user chose them.

    Returns
    -------
    xarray.Dataset or pandas.DataFrame or list
        The same object if the array has another shape.

    Raises
    ------
    FieldError
        For several datasets of which none has axes of these lengths.
    """
    if hasattr(data, "columns") and hasattr(data, "assign"):
        if values.shape == (len(data),):
            return data.assign(**{name: values})
        return data
    if isinstance(data, (list, tuple)):
        items = list(data)
    else:
        items = [data]
    component = str(choose_pair(as_datasets(data), *two_names(vectors)).u.name)
    for number, item in enumerate(items):
        variable = getattr(item, "data_vars", {}).get(component)
        if variable is None:
            continue
        dims = _dims_of(variable, values.shape)
        if dims:
            items[number] = item.assign({name: (dims, values)})
            if isinstance(data, (list, tuple)):
                return items
            return items[0]
    if len(items) > 1:
        raise FieldError(
            f"{argument} is an array of the shape {values.shape}, and no dataset has {component!r} "
            f"with axes of these lengths; make it a variable of a dataset, as in ds['name'] = "
            f"(dims, array), and pass {argument}='name'"
        )
    return data


def _dims_of(variable: xr.DataArray, shape: tuple[int, ...]) -> tuple[str, ...]:
    """Return the dimensions of a variable that have the lengths of a shape, the last ones first."""
    dims = [str(dim) for dim in variable.dims]
    fitting = []
    for some in combinations(dims, len(shape)):
        if tuple(variable.sizes[dim] for dim in some) == shape:
            fitting.append(some)
    last = tuple(dims[len(dims) - len(shape) :])
    if last in fitting:
        return last
    if len(fitting) == 1:
        return fitting[0]
    return ()
