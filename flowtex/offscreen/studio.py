"""A flow before a camera, off screen: draws as many pictures of it as are asked for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.diagnostics import require_opengl
from flowtex.field import FlowField
from flowtex.plotting.component import FIELD_ARGUMENTS, FlowtexComponent, as_field
from flowtex.plotting.handle import FlowHandle
from flowtex.plotting.vtk_camera import look

__all__ = ["Studio", "new_plotter", "put"]

#: Longest side of what is drawn at once, in pixels, and how many of them make one, at most.
LONGEST_SIDE, MOST_SUPERSAMPLING = 16_384, 8

Changes = Mapping[str, Any]


class Studio:
    """A flow before a camera.

    Parameters
    ----------
    mesh, size, zoom, focus, background, camera_position, beside, supersampling
        As for :func:`flowtex.render`.
    **options
        Further arguments and settings of ``plotter.flowtex.add``.

    Attributes
    ----------
    field
        The flow.
    handles
        Its texture in each view.

    Raises
    ------
    FieldError, SettingsError, OpenGLMissingError, ValueError
        As for :func:`flowtex.render`.
    """

    def __init__(
        self,
        mesh: Any,
        *,
        size: tuple[int, int] = (1024, 768),
        zoom: float = 1.0,
        focus: tuple[float, ...] | None = None,
        background: Any = "white",
        camera_position: Any | None = None,
        beside: Changes | None = None,
        supersampling: int = 1,
        **options: Any,
    ) -> None:
        require_opengl()
        _check(size, supersampling)
        self.field = as_field(mesh, **{k: options.pop(k, None) for k in FIELD_ARGUMENTS})
        self._size, self._times = size, supersampling
        large = (size[0] * supersampling, size[1] * supersampling)
        self._plotter = new_plotter(large, beside, off_screen=True, lighting="light kit")
        try:
            if supersampling == 1:  # which smooths the outline as well
                self._plotter.enable_anti_aliasing("msaa", multi_samples=4)
            else:
                self._plotter.disable_anti_aliasing()
            self._plotter.set_background(background)
            options = {"show_scalar_bar": False, **options}
            self.handles = put(self._plotter, self.field, options, beside)
            self._plotter.render_window.SetDPI(self._plotter.render_window.GetDPI() * supersampling)
            for handle in self.handles:
                handle.density = supersampling
            self._aim(camera_position, zoom, focus)
        except BaseException:
            self._plotter.close()
            raise

    def _aim(self, position: Any | None, zoom: float, focus: tuple[float, ...] | None) -> None:
        if position is None:
            look(self._plotter, self.field, zoom=zoom, focus=focus)
            return
        self._plotter.camera.parallel_projection = False
        self._plotter.camera_position = position

    def picture(self, *, time: float | None = None, clock: float = 0.0) -> NDArray[np.uint8]:
        """Draw the flow.

        Parameters
        ----------
        time
            Time to show of a field that varies in time; what is shown already by default.
        clock
            Moment of the streaming of a steady flow, in seconds.

        Returns
        -------
        numpy.ndarray
            (height, width, 3) uint8, row 0 at the top.
        """
        # One picture for all that changes.
        self._plotter.suppress_rendering = True
        for handle in self.handles:
            if time is not None:
                handle.time = time
            handle.clock = clock
        self._plotter.suppress_rendering = False
        self._plotter.render()
        drawn: Any = self._plotter.screenshot(return_img=True)
        return _averaged(np.asarray(drawn[..., :3], dtype=np.uint8), self._times)

    def close(self) -> None:
        """Free the graphics card."""
        for handle in self.handles:
            handle.remove(render=False)
        self._plotter.close()

    def __enter__(self) -> Studio:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def new_plotter(size: tuple[int, int], beside: Changes | None, **options: Any) -> Any:
    """Return a PyVista plotter with one view, or with two side by side."""
    import pyvista as pv

    shape = (1, 1) if beside is None else (1, 2)
    return pv.Plotter(window_size=list(size), shape=shape, border=False, **options)


def put(
    plotter: Any, field: FlowField, options: Changes, beside: Changes | None
) -> list[FlowHandle]:
    """Add the flow to one view, or to two that share a camera and say how they differ."""
    component = FlowtexComponent(plotter)
    if beside is None:
        return [component.add(field, **options)]
    handles = []
    for column, chosen in enumerate((options, {**options, **beside})):
        plotter.subplot(0, column)
        handles.append(component.add(field, **chosen))
        label = plotter.add_text(_difference(handles[-1], beside), font_size=9, color="black")
        label.prop.background_color, label.prop.background_opacity = "white", 0.8
    plotter.link_views()
    plotter.subplot(0, 0)
    return handles


def _difference(handle: FlowHandle, beside: Changes) -> str:
    """Tell the settings by which one of two views differs from the other."""
    settings = dict(handle.settings)
    return ", ".join(f"{name} = {settings[name]}" for name in beside if name in settings)


def _check(size: tuple[int, int], supersampling: int) -> None:
    if supersampling not in range(1, MOST_SUPERSAMPLING + 1):
        msg = f"supersampling is {supersampling!r}; expected 1 to {MOST_SUPERSAMPLING}, such as 2"
        raise ValueError(msg)
    if not all(1 <= side * supersampling <= LONGEST_SIDE for side in size):
        times = f" times {supersampling}" if supersampling > 1 else ""
        msg = (
            f"size is {size[0]} x {size[1]}{times}; expected 1 to {LONGEST_SIDE} pixels along "
            "each side: choose a smaller size, or less supersampling"
        )
        raise ValueError(msg)


def _averaged(picture: NDArray[np.uint8], times: int) -> NDArray[np.uint8]:
    """Take the mean of every so many pixels along each side."""
    if times == 1:
        return picture
    from PIL import Image

    return np.asarray(Image.fromarray(picture).reduce(times))
