"""Flow textures from xarray: ``import flowtex.xarray`` gives datasets and arrays ``.flowtex``.

::

    import flowtex.xarray

    ds.flowtex.show(level=500)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

import flowtex
from flowtex._util.arguments import brief, checked_array, checked_count
from flowtex.errors import import_extra
from flowtex.field import FlowField
from flowtex.sources.datasets.named_places import placed_on
from flowtex.sources.opening.tables import as_dataset

try:
    import xarray as xr
    from xarray.plot import FacetGrid
except ModuleNotFoundError:
    import_extra("xarray", "xarray")  # whose error names the command that installs it
    raise

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import BoundaryNorm
    from numpy.typing import ArrayLike

    from flowtex._util.array_types import Bytes
    from flowtex.host.export import Page
    from flowtex.host.flow_widget import FlowWidget
    from flowtex.plotting.offscreen.flow_image import FlowImage
    from flowtex.plotting.offscreen.movie import Movie
    from flowtex.pyramid import Built

__all__ = ["FlowtexAccessor"]

PANEL_SIZE = 3.0  #: Height of a panel in inches.
PANEL_ASPECT = 1.6  #: Width of a panel over its height.


@xr.register_dataarray_accessor("flowtex")  # type: ignore[no-untyped-call]
@xr.register_dataset_accessor("flowtex")  # type: ignore[no-untyped-call]
class FlowtexAccessor:
    """Functions of flowtex for a dataset; each has the arguments of the function of the same name.

    A DataArray with an axis of components, or of complex values u + iv, has them too.

    Examples
    --------
    >>> import flowtex
    >>> import flowtex.xarray
    >>> winds = flowtex.examples.weather()
    >>> winds.flowtex.render(level=250, globe=True, size=(160, 120), samples=5).shape
    (120, 160, 3)
    """

    def __init__(self, data: xr.Dataset | xr.DataArray) -> None:
        self._data = data

    @property
    def _dataset(self) -> xr.Dataset:
        """The dataset, or a dataset of the components of an array."""
        return as_dataset(self._data, several=False)

    def field(self, *names: str, **options: Any) -> FlowField:
        """Return the field, as :meth:`flowtex.FlowField.from_xarray` does."""
        return FlowField.from_xarray(self._dataset, *names, **options)

    def show(self, **options: Any) -> FlowWidget | None:
        """Show the flow, as :func:`flowtex.show` does."""
        return flowtex.show(self._dataset, **options)

    def render(self, **options: Any) -> Bytes:
        """Draw the flow as a picture, as :func:`flowtex.render` does."""
        return flowtex.render(self._dataset, **options)

    def movie(self, *file: str | Path, **options: Any) -> Movie:
        """Write the flow as a movie, as :func:`flowtex.movie` does."""
        return flowtex.movie(self._dataset, *file, **options)

    def export(self, *file: str | Path, **options: Any) -> Page:
        """Write the flow as a page, as :func:`flowtex.export` does."""
        return flowtex.export(self._dataset, *file, **options)

    def axes(self, ax: Axes, **options: Any) -> FlowImage:
        """Draw the flow into axes of matplotlib or cartopy, as :func:`flowtex.axes` does."""
        return flowtex.axes(ax, self._dataset, **options)

    def dynamic_map(self, **options: Any) -> Any:
        """Return the flow for HoloViews and Panel, as :func:`flowtex.dynamic_map` does."""
        return flowtex.dynamic_map(self._dataset, **options)

    def plot(
        self,
        *,
        x: str | None = None,
        y: str | None = None,
        u: str | None = None,
        v: str | None = None,
        hue: str | None = None,
        ax: Axes | None = None,
        row: str | None = None,
        col: str | None = None,
        col_wrap: int | None = None,
        transform: Any = None,
        vmin: float | None = None,
        vmax: float | None = None,
        robust: bool = False,
        norm: Any = None,
        levels: int | ArrayLike | None = None,
        xlim: tuple[float, float] | None = None,
        ylim: tuple[float, float] | None = None,
        add_colorbar: bool = True,
        cbar_kwargs: Mapping[str, Any] | None = None,
        figsize: tuple[float, float] | None = None,
        size: float | None = None,
        aspect: float | None = None,
        subplot_kws: Mapping[str, Any] | None = None,
        **options: Any,
    ) -> FlowImage | FacetGrid[xr.Dataset]:
        """Draw the flow with the arguments of ``ds.plot.quiver`` and ``ds.plot.streamplot``.

        Parameters
        ----------
        x, y
            Names of the coordinates across and upward; recognised by default.
        u, v
            Names of the components; recognised by default.
        hue
            Variable to colour by; the speed by default.
        ax
            Axes of matplotlib or cartopy; the current ones by default. Not for facets.
        row, col, col_wrap
            Dimensions with one panel for each value, and the number of panels in a row.
        transform
            Accepted for compatibility: ``ccrs.PlateCarree()`` or ``ccrs.Geodetic()``. The
            projection of longitudes and latitudes is known.
        vmin, vmax, robust
            Range of the colours, the same in all panels.
        norm
            Norm from values to colours, as for :func:`flowtex.axes`, in place of these.
        levels
            Number of levels of the colours, at round values, or their edges.
        xlim, ylim
            Limits of the axes.
        add_colorbar, cbar_kwargs
            Whether to add a colour bar, and arguments of ``figure.colorbar``.
        figsize, size, aspect, subplot_kws
            As in xarray.
        **options
            As for :func:`flowtex.axes`, such as ``cmap="magma"`` or ``samples=25``.

        Returns
        -------
        FlowImage or xarray.plot.FacetGrid
            The image on the axes, or the panels.

        Raises
        ------
        FieldError
            As for :func:`flowtex.axes`, or when an argument is not allowed, such as ``ax`` for
            facets.

        Examples
        --------
        >>> import flowtex
        >>> import flowtex.xarray
        >>> winds = flowtex.examples.weather()
        >>> panels = winds.flowtex.plot(col="level", col_wrap=2, samples=5)
        >>> len(panels.axs.flat)
        4
        """
        _check_transform(transform)
        if norm is not None:
            _check_alone(norm, vmin=vmin, vmax=vmax, levels=levels)
        options |= {"u": u, "v": v, **_colour_options(hue, norm, robust=robust)}
        dataset = placed_on(self._dataset, x, y)
        panels: FacetGrid[xr.Dataset] | None = None
        if row is None and col is None:
            if figsize is None and size is not None:
                figsize = (size * (aspect or PANEL_ASPECT), size)
            shown = [(ax or _axes(figsize, subplot_kws or {}), dataset)]
        elif ax is None:
            panels = FacetGrid(
                dataset,
                row=row,
                col=col,
                col_wrap=col_wrap,
                figsize=figsize,
                size=size or PANEL_SIZE,
                aspect=aspect or PANEL_ASPECT,
                subplot_kws=dict(subplot_kws or {}),
            )
            shown = _parts_of(panels, dataset)
        else:
            raise flowtex.FieldError(
                "ax is given, but row and col make their own axes; omit ax, or row and col"
            )
        images = [flowtex.axes(panel, data, **options) for panel, data in shown]
        label = images[0].colour_label
        if label:
            _share_colours(images, vmin, vmax, levels)
        for panel, _ in shown:
            _set_limits(panel, xlim, ylim)
        beside: Any = shown[0][0]
        if panels is not None:
            _finish_panels(panels)
            beside = list(panels.axs.flat)
        if label and add_colorbar:
            bar_options = {"label": label, **(cbar_kwargs or {})}
            images[0].axes.figure.colorbar(images[0], ax=beside, **bar_options)
        return panels or images[0]

    def pyramid(self, store: str | Path, **options: Any) -> Built:
        """Build a pyramid of the flow, as :func:`flowtex.pyramid.build` does."""
        return flowtex.pyramid.build(self._dataset, store, **options)

    def widget(self, **options: Any) -> FlowWidget:
        """Return a :class:`flowtex.FlowWidget` of the flow."""
        return flowtex.FlowWidget(self._dataset, **options)


def _check_alone(norm: Any, **others: Any) -> None:
    """Raise a FieldError for an argument that a norm replaces."""
    for name, value in others.items():
        if value is not None:
            raise flowtex.FieldError(
                f"norm is {brief(norm)}, and {name} is {brief(value)}; expected one of them: give "
                "the norm its limits, as in PowerNorm(0.5, 0, 10)"
            )


def _levels_norm(levels: Any, image: FlowImage) -> BoundaryNorm:
    """Return the norm of a number of levels at round values, or of their edges."""
    from matplotlib.colors import BoundaryNorm
    from matplotlib.ticker import MaxNLocator

    edges = checked_array("levels", levels, expected="a number of levels, or their edges")
    if edges.ndim == 0:
        count = checked_count("levels", levels, expected="a number of levels, or their edges")
        edges = np.asarray(MaxNLocator(count + 1).tick_values(*image.get_clim()))
    if edges.ndim != 1 or len(edges) < 2 or not (np.diff(edges) > 0).all():
        raise flowtex.FieldError(f"levels is {brief(levels)}; expected edges that increase")
    return BoundaryNorm(edges, image.cmap.N)


def _axes(figsize: tuple[float, float] | None, options: Mapping[str, Any]) -> Axes:
    """Return axes of a new figure if it has a size or they have options, or the current ones."""
    import matplotlib.pyplot as plt

    if figsize is None and not options:
        return plt.gca()
    return cast("Axes", plt.figure(figsize=figsize).add_subplot(**options))


def _check_transform(transform: Any) -> None:
    """Check that a transform is none, or one from longitudes and latitudes."""
    turned = float(getattr(transform, "proj4_params", {}).get("pm", 0))
    if type(transform).__name__ not in ("NoneType", "Geodetic", "PlateCarree") or turned:
        raise flowtex.FieldError(
            f"transform is {brief(transform)}; expected ccrs.PlateCarree() or none: the "
            "positions follow from the longitudes and latitudes of the data"
        )


def _parts_of(panels: FacetGrid[xr.Dataset], dataset: xr.Dataset) -> list[tuple[Any, xr.Dataset]]:
    """Return the axes of each panel that has data, and the part of the dataset that it shows."""
    parts = []
    for panel, place in zip(panels.axs.flat, panels.name_dicts.flat, strict=True):
        if place is not None:
            parts.append((panel, dataset.loc[place]))
    return parts


def _colour_options(hue: str | None, norm: Any, *, robust: bool) -> dict[str, Any]:
    """Return those options of :func:`flowtex.axes` for colours that are given."""
    options: dict[str, Any] = {}
    if hue is not None:
        options["scalars"] = hue
    if robust:
        options["clim"] = "robust"
    if norm is not None:
        options["norm"] = norm
    return options


def _set_limits(
    panel: Axes, xlim: tuple[float, float] | None, ylim: tuple[float, float] | None
) -> None:
    """Set the limits of axes that are given."""
    if xlim is not None:
        panel.set(xlim=xlim)
    if ylim is not None:
        panel.set(ylim=ylim)


def _share_colours(
    images: Sequence[FlowImage],
    vmin: float | None,
    vmax: float | None,
    levels: int | ArrayLike | None,
) -> None:
    """Give images the same range of colours, by default the range of all of them."""
    lows, highs = np.transpose([image.get_clim() for image in images])
    if vmin is None:
        vmin = lows.min()
    if vmax is None:
        vmax = highs.max()
    for image in images:
        image.set_clim(vmin, vmax)
        if levels is not None:
            image.set_norm(_levels_norm(levels, image))


def _finish_panels(panels: FacetGrid[xr.Dataset]) -> None:
    """Hide the panels without data, and write the titles of the others."""
    for panel, place in zip(panels.axs.flat, panels.name_dicts.flat, strict=True):
        panel.set_title("")
        panel.set_visible(place is not None)
    panels.set_titles()
    panels.fig.set_layout_engine("constrained")
