"""One picture of a flow without a window: :func:`render`."""

from __future__ import annotations

from contextlib import closing
from typing import Any, NamedTuple

from flowtex._util.array_types import Bytes
from flowtex._util.cache import ByteCache
from flowtex._util.notices import notify
from flowtex.field import FlowField
from flowtex.field.steps import LazySteps
from flowtex.plotting.offscreen.plotter import OffscreenPlotter
from flowtex.rendering.camera import CAMERA_LIMITS
from flowtex.scene.options import Appearance, FieldOptions, Options, ViewOptions, accepts_options
from flowtex.scene.scene import Scene
from flowtex.textures.tiles import Pyramid, has_pyramid
from flowtex.trace import SliceStore, TraceSlices

#: Memory of fields and traces that are kept after a picture, and of a node of a field.
KEPT_BYTES, NODE_BYTES = 500_000_000, 200


@accepts_options(FieldOptions, Appearance, ViewOptions)
def render(
    mesh: Any,
    *,
    size: tuple[int, int] = (1024, 768),
    time: float | str | None = None,
    clock: float = 0.0,
    supersampling: int = 1,
    margin: float = CAMERA_LIMITS.margin,
    annotations: bool = False,
    scalar_bar_args: dict[str, Any] | None = None,
    **options: Any,
) -> Bytes:
    """Draw a flow without a window.

    Parameters
    ----------
    mesh
        PyVista mesh, list of meshes in time, xarray dataset, :class:`~flowtex.FlowField`, or path
        of a file.
    size
        Width and height in pixels; each of two views has half the width.
    time
        Time to show of a time-varying field, or a date such as ``"2000-01-02 12:00"`` if its times
        are dates; the first step by default.
    clock
        Time in the animation of a steady flow, in seconds (see the setting ``motion``).
    supersampling
        Factor by which the picture is drawn larger along each side and then averaged, 1 to 8. A
        factor of 2 takes four times as long and smooths details finer than a pixel. Grains keep
        their size.
    margin
        Share of the picture that stays empty at each side of the whole surface, from 0 to less than
        0.5. :func:`flowtex.extent` returns the rectangle that a flat picture shows.
    annotations
        Whether legend, scale bar, time and the field's name are drawn on the picture, each if it
        applies and has room.
    scalar_bar_args
        As for ``plotter.add_mesh``. This bar is drawn only with ``show_scalar_bar=True`` and
        without annotations.
    {options}

    Returns
    -------
    numpy.ndarray
        The picture, (height, width, 3) uint8, row 0 at the top.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
        When the picture would be too large to draw, or the margin is out of range.
    OpenGLMissingError
        When OpenGL is missing; the text names the command that installs it.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.airfoil_field()
    >>> flowtex.render(field, size=(160, 120), zoom=4, samples=9).shape
    (120, 160, 3)
    """
    plotter = OffscreenPlotter(
        mesh,
        Options.split(mesh=mesh, **options),
        size=size,
        supersampling=supersampling,
        margin=margin,
        still=True,
        annotations=annotations,
        scalar_bar_args=scalar_bar_args,
    )
    with closing(plotter):
        scene = plotter.handles[0].scene
        if clock and scene.settings.motion == "off":
            notify(f"clock is {clock!r}, but motion is 'off', and nothing moves")
        picture = plotter.picture(time=time, clock=clock)
        _keep(scene)
        return picture


class _Drawn(NamedTuple):
    """A field that was drawn, and its traces."""

    field: FlowField
    store: SliceStore
    pyramid: Pyramid | None

    @property
    def nbytes(self) -> int:
        return self.field.valid.size * len(self.field.times) * NODE_BYTES + self.store.nbytes


_drawn: ByteCache[int, _Drawn | TraceSlices] = ByteCache(KEPT_BYTES, min_count=0)


def _keep(scene: Scene) -> None:
    """Keep the field of a scene and its traces, for a script that draws the same numbers again.

    :func:`flowtex.scene.scene.share_field` finds the field, and a store of the same numbers its
    slices. The least recently drawn is dropped first. For a field with lazy steps, which holds a
    file open, only the slices are kept.
    """
    field, store = scene.field, scene.store
    if any(isinstance(steps, LazySteps) for steps in (field.velocity, *field.scalars.values())):
        for slices in store.traced:
            _drawn.put(id(slices), slices)
    elif not has_pyramid(field):
        _drawn.put(id(store), _Drawn(field, store, scene.pyramid))
