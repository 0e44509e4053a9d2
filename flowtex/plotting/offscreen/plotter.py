"""A PyVista plotter that shows a scene, or two side by side, in a window or without one."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import closing
from dataclasses import replace
from typing import Any

import numpy as np

from flowtex._util.arguments import checked_size, sized
from flowtex._util.array_types import Bytes
from flowtex.errors import FieldError, notify
from flowtex.field.options import FieldOptions, accepts_options
from flowtex.plotting.component import FlowtexComponent
from flowtex.plotting.handle import FlowHandle
from flowtex.plotting.vtk_camera import point_camera
from flowtex.rendering.camera import CAMERA_LIMITS, read_camera
from flowtex.rendering.diagnostics import begin_trial, require_opengl
from flowtex.scene.annotations import Layout, annotate, difference_text
from flowtex.scene.fields import TracedFlow, read_field
from flowtex.scene.options import Appearance, Options, ViewOptions
from flowtex.scene.scene import Scene, share_field
from flowtex.sources.notices import notify_section
from flowtex.textures.images import averaged

#: Longest side of a drawing, in pixels.
LONGEST_SIDE = 16_384
#: Most pixels drawn for one of the picture, along a side.
MAX_SUPERSAMPLING = 8
#: Samples of a pixel for smooth outlines, where the picture is not supersampled.
OUTLINE_SAMPLES = 4
NOTHING_SEEN = (
    "The surface is outside the picture; check zoom, focus and camera, which are in the mesh's "
    "own units."
)


class OffscreenPlotter:
    """A plotter without a window that draws pictures of a flow.

    Parameters and errors are those of :func:`flowtex.render`; ``density`` and ``still`` are those
    of the handles, which are the textures of the views.
    """

    def __init__(
        self,
        mesh: Any,
        options: Options,
        *,
        size: tuple[int, int],
        supersampling: int = 1,
        margin: float = CAMERA_LIMITS.margin,
        density: float = 1.0,
        still: bool = False,
        annotations: bool = False,
        scalar_bar_args: Mapping[str, Any] | None = None,
    ) -> None:
        begin_trial()
        _check_size(size, supersampling)
        # Equal fields share their traces.
        field = share_field(read_field(mesh, options.field))
        notify_section(field.section)
        # The trial has run while the field was read.
        require_opengl()
        options = replace(options, field=FieldOptions())
        appearance = options.appearance
        self._legend = appearance.has_bar
        if scalar_bar_args and (annotations or not appearance.show_scalar_bar):
            case = "without annotations" if annotations else "with show_scalar_bar=True"
            notify(f"scalar_bar_args is given, but this bar is drawn only {case}; it is not used")
        if annotations or appearance.show_scalar_bar is None:
            options = replace(options, appearance=replace(appearance, show_scalar_bar=False))
        self._supersampling = supersampling
        self._view, self._annotations = options.view, annotations
        large = (size[0] * supersampling, size[1] * supersampling)
        self._plotter = new_plotter(large, self._view, off_screen=True, lighting="light kit")
        try:
            if supersampling == 1:  # supersampling smooths outlines as well
                self._plotter.enable_anti_aliasing("msaa", multi_samples=OUTLINE_SAMPLES)
            else:
                self._plotter.disable_anti_aliasing()
            self.handles = add_scenes(
                self._plotter, field, options, scalar_bar_args, labels=not annotations
            )
            window = self._plotter.render_window
            window.SetDPI(window.GetDPI() * supersampling)
            for handle in self.handles:
                handle.density, handle.still = supersampling * density, still
            self._point_camera(margin)
            if annotations:
                self._reserve(size, margin)
        except BaseException:
            self._plotter.close()
            raise

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
        self._plotter.render()
        image: Any = self._plotter.screenshot(return_img=True, transparent_background=transparent)
        pixels = np.asarray(image[..., : 4 if transparent else 3], dtype=np.uint8)
        visible = any(handle.scene.appearance.opacity > 0 for handle in self.handles)
        if visible and (pixels[..., :3] == self._plotter.background_color.int_rgb).all():
            notify(NOTHING_SEEN, UserWarning)
        picture = averaged(pixels, self._supersampling)
        if not self._annotations:
            return picture
        canvas = self._canvas.copy()
        canvas[self._rows] = picture
        self._annotate(canvas)
        return canvas

    def _point_camera(self, margin: float) -> None:
        point_camera(self._plotter, self.handles[0].scene.whole.surface, self._view, margin)

    def _reserve(self, size: tuple[int, int], margin: float) -> None:
        """Leave room for annotations above and below the flow of a small picture."""
        width, height = size
        self._rows, ground = slice(0, height), self._plotter.background_color.int_rgb
        self._canvas = np.full((height, width, 3), ground, np.uint8)
        layouts = self._annotate(self._canvas.copy())
        above, below = (max(getattr(each, n) for each in layouts) for n in ("above", "below"))
        if left_out := dict.fromkeys(name for each in layouts for name in each.left_out):
            notify(f"a picture of {width} x {height} has no room for: {', '.join(left_out)}")
        if above or below:
            self._rows = slice(above, height - below)
            drawn = (width, height - above - below)
            self._plotter.window_size = [self._supersampling * side for side in drawn]
            self._point_camera(margin)

    def _annotate(self, canvas: Bytes) -> list[Layout]:
        """Write on a picture, in place."""
        changes, legend = self._view.beside or {}, self._legend
        look: dict[str, Any] = {"background": self._view.ground, "legend": legend}
        look["flow_height"] = self._rows.stop - self._rows.start
        camera, views = read_camera(self._plotter.camera), len(self.handles)
        return [
            annotate(view, h.scene, camera, label=difference_text(h.scene, changes), **look)
            for view, h in zip(np.array_split(canvas, views, axis=1), self.handles, strict=True)
        ]

    def close(self) -> None:
        """Free the graphics card."""
        for handle in self.handles:
            handle.remove(render=False)
        self._plotter.close()


def new_plotter(size: tuple[int, int], view: ViewOptions, **options: Any) -> Any:
    """Return a PyVista plotter with the background and the one or two views of options."""
    import pyvista as pv

    shape = (1, 1) if view.beside is None else (1, 2)
    plotter = pv.Plotter(window_size=list(size), shape=shape, border=False, **options)
    plotter.set_background(view.ground)
    return plotter


def add_scenes(
    plotter: Any,
    mesh: Any,
    options: Options,
    scalar_bar_args: Mapping[str, Any] | None = None,
    *,
    labels: bool = True,
) -> list[FlowHandle]:
    """Add a flow to one view, or to two that share a camera; labels say how they differ.

    Raises a FieldError when the view has axes, which only browsers draw.
    """
    if options.view.axes is not None:
        raise FieldError(
            f"axes is {options.view.axes!r}, but only browsers draw axes; omit it, or draw a "
            "figure with flowtex.axes"
        )
    component, changes = FlowtexComponent(plotter), options.view.beside
    scenes = [Scene.from_options(mesh, options)]
    if changes is not None:
        scenes.append(scenes[0].beside(changes))
    handles = []
    for column, scene in enumerate(scenes):
        if changes is not None:
            plotter.subplot(0, column)
        handles.append(component.add_scene(scene, scalar_bar_args=scalar_bar_args))
        if changes is not None and labels:
            label = plotter.add_text(difference_text(scene, changes), font_size=9, color="black")
            label.prop.background_color, label.prop.background_opacity = "white", 0.8
    if changes is not None:
        plotter.link_views()
        plotter.subplot(0, 0)
    return handles


def _check_size(size: tuple[int, int], supersampling: int) -> None:
    if supersampling not in range(1, MAX_SUPERSAMPLING + 1):
        raise FieldError(
            f"supersampling is {supersampling!r}; expected 1 to {MAX_SUPERSAMPLING}, such as 2"
        )
    size = checked_size(size, low=0)
    if not all(1 <= side * supersampling <= LONGEST_SIDE for side in size):
        times = f" times {supersampling}" if supersampling > 1 else ""
        raise FieldError(
            f"size is {size[0]} x {size[1]}{times}; expected 1 to {LONGEST_SIDE} pixels along "
            "each side: choose a smaller size, or less supersampling"
        )


@accepts_options(FieldOptions, Appearance, ViewOptions)
@sized
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
        Width and height in pixels, also as ``window_size``; each of two views has half the width.
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
        TracedFlow(scene.field, scene.store, scene.pyramid).keep()
        return picture
