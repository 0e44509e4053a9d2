"""Pictures of flows without a window: :func:`render`."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from typing import Any

import numpy as np

from flowtex._util.arguments import checked_count, checked_flag, checked_size, is_number
from flowtex._util.array_types import Bytes
from flowtex.errors import FieldError, notify
from flowtex.field.options import FieldOptions, accepts_options
from flowtex.plotting.component import WHOLE, Bars, open_plotter, point_camera
from flowtex.rendering.camera import CAMERA_LIMITS, read_camera
from flowtex.rendering.diagnostics import require_opengl
from flowtex.rendering.vtk.contexts import uninterrupted
from flowtex.scene.annotations import Layout, annotate_views, room_of
from flowtex.scene.array_arguments import takes_arrays
from flowtex.scene.fields import TracedFlow
from flowtex.scene.options import Appearance, Options, ViewOptions
from flowtex.scene.scene import Scene, make_scenes
from flowtex.sources.notices import notify_section
from flowtex.textures.images import averaged

LONGEST_SIDE = 16_384  #: Longest side of a drawing, in pixels.
MAX_SUPERSAMPLING = 8  #: Most pixels drawn for one of the picture, along a side.
#: Samples of a pixel for smooth outlines, where the picture is not supersampled.
OUTLINE_SAMPLES = 4
NOTHING_SEEN = (
    "The surface is outside the picture; check zoom, focus and camera, which are in the mesh's "
    "own units."
)


class OffscreenPlotter:
    """Pictures of one scene, or of two side by side, drawn by VTK without a window.

    Parameters and errors are as for :func:`flowtex.render`; ``density`` and ``still`` are
    attributes of the handles, the textures of the views. The scenes are closed with the plotter.
    """

    def __init__(
        self,
        scenes: Sequence[Scene],
        view: ViewOptions = WHOLE,
        *,
        size: tuple[int, int],
        supersampling: int = 1,
        margin: float = CAMERA_LIMITS.margin,
        density: float = 1.0,
        still: bool = False,
        annotations: bool = False,
    ) -> None:
        size, supersampling = _checked_size(size, supersampling)
        require_opengl()
        notify_section(scenes[0].field.section)
        self._legend = scenes[0].has_bar
        annotations = checked_flag("annotations", annotations)
        bars: Bars = "asked"
        if annotations:
            bars = "none"
        self._supersampling = supersampling
        self._margin = margin
        self._view = view
        self._plotter, self.handles = open_plotter(
            scenes,
            view,
            (size[0] * supersampling, size[1] * supersampling),
            margin=margin,
            outline_samples=_outline_samples(supersampling),
            labels=not annotations,
            bars=bars,
            off_screen=True,
            lighting="light kit",
        )
        self._set_density(density, still=still)
        #: Image without the flow, with room for annotations; ``None`` without these.
        self._canvas: Bytes | None = None
        if annotations:
            self._begin_annotations(size)

    def _begin_annotations(self, size: tuple[int, int]) -> None:
        """Leave room for annotations; close the plotter if this fails."""
        try:
            self._reserve(size)
        except BaseException:
            self.close()
            raise

    def _set_density(self, density: float, *, still: bool) -> None:
        """Set the size of texts and of the grain in pixels of the supersampled picture."""
        window = self._plotter.render_window
        window.SetDPI(window.GetDPI() * self._supersampling)
        for handle in self.handles:
            handle.density = self._supersampling * density
            handle.surface.view.still = still

    def picture(
        self, *, time: float | str | None = None, clock: float = 0.0, transparent: bool = False
    ) -> Bytes:
        """Return a picture (height, width, 3), row 0 at the top; by default of the present time.

        A ``transparent`` one has a fourth channel, which is 0 outside the flow.
        """
        # Render once after all changes.
        self._plotter.suppress_rendering = True
        for handle in self.handles:
            if time is not None:
                handle.time = time
            handle.clock = clock
        self._plotter.suppress_rendering = False
        with uninterrupted():
            self._plotter.render()
            image: Any = self._plotter.screenshot(
                return_img=True, transparent_background=transparent
            )
        pixels = np.asarray(image, dtype=np.uint8)
        if not transparent:
            pixels = pixels[..., :3]
        opacities = [handle.scene.appearance.opacity for handle in self.handles]
        visible = max(opacities) > 0
        if visible and (pixels[..., :3] == self._plotter.background_color.int_rgb).all():
            notify(NOTHING_SEEN, UserWarning)
        picture = averaged(pixels, self._supersampling)
        if self._canvas is None:
            return picture
        canvas = self._canvas.copy()
        canvas[self._rows] = picture
        self._annotate(canvas)
        return canvas

    def _reserve(self, size: tuple[int, int]) -> None:
        """Leave room for annotations above and below the flow of a small picture."""
        width, height = size
        self._rows = slice(0, height)
        ground = self._plotter.background_color.int_rgb
        self._canvas = np.full((height, width, 3), ground, np.uint8)
        layouts = self._annotate(self._canvas.copy())
        above, below = room_of(layouts)
        left_out: dict[str, None] = {}
        for each in layouts:
            left_out |= dict.fromkeys(each.left_out)
        if left_out:
            notify(f"a picture of {width} x {height} has no room for: {', '.join(left_out)}")
        if above or below:
            self._rows = slice(above, height - below)
            drawn_height = height - above - below
            self._plotter.window_size = [
                self._supersampling * width,
                self._supersampling * drawn_height,
            ]
            surface = self.handles[0].scene.whole.surface
            point_camera(self._plotter, surface, self._view, self._margin)

    def _annotate(self, canvas: Bytes) -> list[Layout]:
        """Write annotations on a picture in place; return their layouts."""
        return annotate_views(
            canvas,
            [handle.scene for handle in self.handles],
            read_camera(self._plotter.camera),
            self._view.beside or {},
            background=self._view.ground,
            legend=self._legend,
            flow_height=self._rows.stop - self._rows.start,
        )

    def close(self) -> None:
        """Free the graphics card."""
        self._plotter.close()


def _outline_samples(supersampling: int) -> int:
    """Return the samples of a pixel at outlines; supersampling smooths these as well."""
    if supersampling == 1:
        return OUTLINE_SAMPLES
    return 0


def _checked_size(size: Any, supersampling: Any) -> tuple[tuple[int, int], int]:
    """Return width and height, and the samples along a pixel, of a picture that can be drawn."""
    expected = f"1 to {MAX_SUPERSAMPLING}, such as 2"
    supersampling = checked_count(
        "supersampling", supersampling, 1, MAX_SUPERSAMPLING, expected=expected
    )
    size = checked_size(size, low=0)
    if min(size) < 1 or max(size) * supersampling > LONGEST_SIDE:
        if supersampling > 1:
            times = f" times {supersampling}"
        else:
            times = ""
        raise FieldError(
            f"size is {size[0]} x {size[1]}{times}; expected 1 to {LONGEST_SIDE} pixels along "
            "each side: choose a smaller size, or less supersampling"
        )
    return size, supersampling


@takes_arrays()
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
    **options: Any,
) -> Bytes:
    """Draw a flow without a window.

    Parameters
    ----------
    mesh
        PyVista mesh, list of meshes in time, xarray dataset, :class:`~flowtex.FlowField`, path of a
        file, or plain arrays by position: ``x, y, u, v`` as in ``plt.streamplot``.
    size
        Width and height in pixels; each of two views has half the width.
    time
        Time to show of a time-varying field, or a date such as ``"2000-01-02 12:00"`` if its times
        are dates; the first step by default.
    clock
        Time in the animation of a steady flow, in seconds (see the setting ``motion``).
    supersampling
        Factor by which the picture is drawn larger along each side and then averaged, 1 to 8. A
        factor of 2 takes up to three times as long and smooths details finer than a pixel. Grains
        keep their size.
    margin
        Share of the picture that stays empty at each side of the whole surface, from 0 to less than
        0.5. :func:`flowtex.extent` returns the rectangle that a flat picture shows.
    annotations
        Whether legend, scale bar, time and the field's name are drawn on the picture, each if it
        applies and has room. In a small picture the flow is drawn between them.
    {options}

    Returns
    -------
    numpy.ndarray
        The picture, (height, width, 3) uint8, row 0 at the top.

    Raises
    ------
    FieldError, SettingsError
        If the mesh or a setting is invalid.
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
    chosen = Options.split(**options)
    plotter = OffscreenPlotter(
        make_scenes(mesh, chosen),
        chosen.view,
        size=size,
        supersampling=supersampling,
        margin=margin,
        still=True,
        annotations=annotations,
    )
    with closing(plotter):
        scene = plotter.handles[0].scene
        is_advanced = is_number(clock) and clock != 0
        if is_advanced and scene.settings.motion == "off":
            notify(f"clock is {clock!r}, but motion is 'off', and nothing moves")
        picture = plotter.picture(time=time, clock=clock)
        TracedFlow(scene.field, scene.store, scene.pyramid).keep()
        return picture
