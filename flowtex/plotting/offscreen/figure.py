"""Flat flows in data coordinates: the extent of a picture, matplotlib axes, and HoloViews."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from flowtex._util.arguments import brief, checked_size
from flowtex.errors import FieldError
from flowtex.field.dates import time_text
from flowtex.field.options import FieldOptions, accepts_options
from flowtex.plotting.offscreen.axes_kinds import is_geo
from flowtex.plotting.offscreen.flow_image import USUAL_DPI, FlowImage, plane_frame
from flowtex.rendering.camera import CAMERA_LIMITS
from flowtex.scene.array_arguments import takes_arrays
from flowtex.scene.options import Appearance, Options, ViewOptions
from flowtex.scene.scene import make_scenes

Extent = tuple[float, float, float, float]  #: Left, right, bottom and top.

FIRST_SIZE = (600, 400)  #: Width and height of a plot whose size is not known yet, in pixels.


@takes_arrays()
@accepts_options(FieldOptions, Appearance, ViewOptions)
def extent(
    mesh: Any,
    *,
    size: tuple[int, int] = (1024, 768),
    margin: float = CAMERA_LIMITS.margin,
    **options: Any,
) -> Extent:
    """Return the rectangle that :func:`flowtex.render` shows for the same arguments.

    ``plt.imshow(picture, extent=...)`` then shows each pixel at its coordinates.

    Parameters
    ----------
    mesh
        As for :func:`flowtex.render`; its surface must be flat.
    size, margin
        As for :func:`flowtex.render`.
    {options}
    **settings
        Any setting of :class:`~flowtex.Settings`; they have no effect.

    Returns
    -------
    tuple of float
        Left, right, bottom and top in the mesh's units: x and y of a plane of constant z, x and z
        of one of constant y, y and z of one of constant x. For any other plane, lengths along the
        picture's sides from the origin of the mesh.

    Raises
    ------
    FieldError, SettingsError
        If the mesh or a setting is invalid.
        When the surface is curved, the camera does not look straight on, or there are two views.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field()
    >>> flowtex.extent(field, size=(200, 100), margin=0)
    (0.0, 2.0, 0.0, 1.0)
    """
    chosen = Options.split(**options)
    size = checked_size(size)
    if chosen.view.beside is not None:
        raise FieldError("beside makes two views, which do not have one common extent; omit it")
    surface = make_scenes(mesh, chosen)[0].whole.surface
    frame = plane_frame(surface)
    view = chosen.view
    aspect = size[0] / size[1]
    camera = view.first_camera(surface, aspect, margin)
    if not (camera.parallel and np.allclose(camera.axes[:2], frame, atol=1e-9)):
        raise FieldError(
            f"camera is {brief(view.camera)}; expected one that looks straight at the surface "
            "without perspective. Omit it, and use zoom and focus"
        )
    x, y = frame @ camera.focal_point
    half = camera.parallel_scale
    return float(x - half * aspect), float(x + half * aspect), float(y - half), float(y + half)


@takes_arrays(1)
@accepts_options(FieldOptions, Appearance)
def axes(
    ax: Axes,
    mesh: Any,
    *,
    time: float | str | None = None,
    clock: float = 0.0,
    supersampling: int = 1,
    **options: Any,
) -> FlowImage:
    """Draw a flat flow into matplotlib axes, in data coordinates.

    The flow is redrawn at the resolution of the axes whenever these are drawn, so the texture stays
    sharp after a zoom, in a larger window, and in a file with more dots per inch.

    Parameters
    ----------
    ax
        Rectilinear axes, with logarithmic or other scales too, polar axes, or map axes of cartopy
        (``projection=ccrs.Robinson()``). Their limits become those of the surface, unless they have
        been set, and the aspect of axes with linear scales becomes equal. On polar axes x is the
        angle in radians and y the radius, as for ``ax.plot``, and the velocity is along the
        growing angle and along the radius, both in the unit of the radius per unit of time. Data on
        longitudes and latitudes are drawn in degrees, or in the projection of the argument
        ``projection``, with meridians and parallels as ticks; axes of cartopy already have a
        projection.
    mesh
        As for :func:`flowtex.render`; its surface must be flat. On axes of cartopy a field of the
        Earth is put on their map, whichever it lies on. A large store must lie on their map, which
        may end at another meridian.
    time, clock, supersampling
        As for :func:`flowtex.render`.
    {options}

    Returns
    -------
    FlowImage
        The image on the axes, which ``plt.colorbar`` accepts. Where data of the Earth are missing
        at sea, the axes get a legend with the entries ``land`` and ``no data``, unless they have
        one; ``ax.legend()`` includes these entries.

    Raises
    ------
    FieldError, SettingsError, OpenGLMissingError
        As for :func:`flowtex.render`.
        When ``ax`` are other axes, the surface is curved, or data on axes of a map are not of the
        Earth, or are a large store on another map.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import flowtex
    >>> figure, ax = plt.subplots(figsize=(3, 2))
    >>> image = flowtex.axes(ax, flowtex.examples.double_gyre_field(), cmap="magma")
    >>> bar = figure.colorbar(image, label="speed")
    >>> figure.savefig("gyre.png", dpi=50)
    >>> plt.close(figure)
    """
    if not is_geo(ax) and getattr(ax, "name", "") not in ("rectilinear", "polar"):
        raise FieldError(
            f"ax is {brief(ax)}; expected rectilinear or polar matplotlib axes, such as those of "
            "plt.subplots(), or axes of cartopy"
        )
    chosen = Options.split("field", "appearance", **options)
    image = FlowImage(ax, mesh, chosen, supersampling)
    if time is None:
        image.time = image.time
    else:
        image.time = time
    image.clock = clock
    image.set_clip_path(ax.patch)
    ax.add_image(image)
    image.frame_axes()
    return image


@takes_arrays()
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
    # Matplotlib's axes stand for the plot of HoloViews.
    figure = Figure()
    ax = figure.add_axes((0, 0, 1, 1), facecolor="none")
    image = axes(ax, mesh, clock=clock, supersampling=supersampling, **options)
    left, right, bottom, top = image.get_extent()
    field = image.flow

    def draw(*moment: float, **plot: Any) -> Any:
        x = plot["x_range"] or (left, right)
        y = plot["y_range"] or (bottom, top)
        size = plot["width"] or FIRST_SIZE[0], plot["height"] or FIRST_SIZE[1]
        # A plot counts the pixels of the page; the screen may have several for one of these.
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
    if len(field.times) > 1:
        kdims = [time]
    else:
        kdims = []
    return hv.DynamicMap(draw, kdims=kdims, streams=[RangeXY(), PlotSize()])
