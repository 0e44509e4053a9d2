"""Flow textures from xarray: ``import flowtex.xarray`` gives every Dataset ``ds.flowtex``.

import flowtex.xarray
ds.flowtex.show(level=500)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import xarray as xr

import flowtex
from flowtex.field import FlowField

if TYPE_CHECKING:
    from flowtex.widget import FlowWidget

__all__ = ["FlowtexAccessor"]


@xr.register_dataset_accessor("flowtex")  # type: ignore[no-untyped-call]
class FlowtexAccessor:
    """The calls of flowtex on a dataset; each takes the arguments of the function of its name.

    Examples
    --------
    >>> import flowtex
    >>> import flowtex.xarray
    >>> winds = flowtex.examples.weather()
    >>> winds.flowtex.render(level=250, globe=True, size=(160, 120), samples=5).shape
    (120, 160, 3)
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        self._dataset = dataset

    def field(self, *names: str, **options: Any) -> FlowField:
        """Return :meth:`flowtex.FlowField.from_xarray` of the dataset."""
        return FlowField.from_xarray(self._dataset, *names, **options)

    def show(self, **options: Any) -> FlowWidget | None:
        """Show it, as :func:`flowtex.show` does."""
        return flowtex.show(self._dataset, **options)

    def render(self, **options: Any) -> Any:
        """Draw it as a picture, as :func:`flowtex.render` does."""
        return flowtex.render(self._dataset, **options)

    def movie(self, *file: Any, **options: Any) -> Any:
        """Write it as a movie, as :func:`flowtex.movie` does."""
        return flowtex.movie(self._dataset, *file, **options)

    def export(self, *file: Any, **options: Any) -> Any:
        """Write it as a page, as :func:`flowtex.export` does."""
        return flowtex.export(self._dataset, *file, **options)

    def widget(self, **options: Any) -> FlowWidget:
        """Return a :class:`flowtex.FlowWidget` of it."""
        return flowtex.FlowWidget(self._dataset, **options)
