"""A flow in HoloViews, redrawn for the range and the size of its plot."""

from __future__ import annotations

from functools import partial
from typing import Any

from flowtex.errors import FieldError
from flowtex.plotting.offscreen.figure import USUAL_DPI, axes
from flowtex.scene.annotations import time_text
from flowtex.scene.options import Appearance, FieldOptions
from flowtex.scene.signatures import accepts_options

#: Width and height of a plot whose size is not known yet, in pixels.
FIRST_SIZE = (600, 400)


@accepts_options(FieldOptions, Appearance)
def dynamic_map(mesh: Any, *, clock: float = 0.0, supersampling: int = 1, **options: Any) -> Any:
    """Return a flat flow as a HoloViews element that is redrawn for the range of its plot.

    The flow is redrawn for each range and size of the plot, so that its texture stays sharp. A
    field with several times has the dimension ``time``, for which HoloViews and Panel show a
    slider. The picture is transparent outside the flow, so that it can lie over map tiles.

    Parameters
    ----------
    mesh
        As for :func:`flowtex.axes`. With ``projection="EPSG:3857"`` data of the Earth lie on the
        tiles of ``holoviews.element.tiles``.
    clock, supersampling
        As for :func:`flowtex.render`.
    {options}

    Returns
    -------
    DynamicMap
        A HoloViews ``DynamicMap`` of ``RGB`` elements, in the coordinates of :func:`flowtex.axes`.

    Raises
    ------
    FieldError, SettingsError, OpenGLMissingError
        As for :func:`flowtex.axes`, and when HoloViews is not installed.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field()
    >>> flow = flowtex.dynamic_map(field, cmap="magma")  # doctest: +SKIP
    >>> flow.opts(width=700, data_aspect=1)  # doctest: +SKIP
    """
    try:
        import holoviews as hv
        from holoviews.streams import PlotSize, RangeXY
    except ImportError as error:
        raise FieldError(
            "dynamic_map needs HoloViews; install it: python -m pip install holoviews bokeh"
        ) from error
    from matplotlib.figure import Figure

    # Matplotlib's axes stand for the plot of HoloViews.
    figure = Figure()
    ax = figure.add_axes((0, 0, 1, 1), facecolor="none")
    image = axes(ax, mesh, clock=clock, supersampling=supersampling, **options)
    left, right, bottom, top = image.get_extent()
    field = image.flow

    def draw(*moment: float, **plot: Any) -> Any:
        x, y = plot["x_range"] or (left, right), plot["y_range"] or (bottom, top)
        size = plot["width"] or FIRST_SIZE[0], plot["height"] or FIRST_SIZE[1]
        # The pixels of a plot are the page's, of which the screen may have several.
        figure.set_dpi(USUAL_DPI * plot["scale"])
        figure.set_size_inches(size[0] / USUAL_DPI, size[1] / USUAL_DPI)
        ax.set(xlim=sorted(x), ylim=sorted(y))
        if moment:
            image.time = float(moment[0])
        pixels = image.make_image(None)[0]
        bounds = (min(x), min(y), max(x), max(y))
        return hv.RGB(pixels[::-1], bounds=bounds, label=field.name)

    text = partial(time_text, field)
    time = hv.Dimension("time", values=field.times.tolist(), value_format=text)
    kdims = [time] if len(field.times) > 1 else []
    return hv.DynamicMap(draw, kdims=kdims, streams=[RangeXY(), PlotSize()])
