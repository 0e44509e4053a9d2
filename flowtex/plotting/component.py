"""Flow textures in PyVista: ``plotter.flowtex.add(mesh)``.

PyVista finds :class:`FlowtexComponent` through its entry point and makes one for each plotter
that asks for ``plotter.flowtex``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pyvista as pv

from flowtex._util.notices import notify
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.plotting.bodies import read_bodies
from flowtex.plotting.handle import FlowHandle
from flowtex.plotting.vtk_camera import look, read_camera
from flowtex.rendering.webgl.bodies import Bodies
from flowtex.scene.options import Appearance, FieldOptions, accepts_options
from flowtex.scene.scene import Scene
from flowtex.textures.images import as_image

__all__ = ["FlowHandle", "FlowtexComponent"]


@pv.register_plotter_component("flowtex")
class FlowtexComponent:
    """The flow textures of one plotter.

    Examples
    --------
    >>> import flowtex
    >>> import pyvista as pv
    >>> plotter = pv.Plotter(off_screen=True)
    >>> handle = plotter.flowtex.add(flowtex.examples.airfoil(), cmap="viridis", samples=25)
    >>> len(plotter.flowtex)
    1
    >>> plotter.close()
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter: Any = plotter
        self._handles: list[FlowHandle] = []

    @accepts_options(FieldOptions, Appearance)
    def add(
        self,
        mesh: Any,
        vectors: str | None = None,
        scalars: str | bool | None = None,  # noqa: FBT001 False is "by nothing", as in PyVista
        cmap: str | Any | None = None,
        *,
        scalar_bar_args: Mapping[str, Any] | None = None,
        reset_camera: bool | None = None,
        **options: Any,
    ) -> FlowHandle:
        """Draw the flow on a mesh as a texture.

        Parameters
        ----------
        mesh
            PyVista mesh, list of meshes in time, xarray dataset, :class:`~flowtex.FlowField`, or
            path of a file.
        scalar_bar_args
            As for ``plotter.add_mesh``.
        reset_camera
            Whether to move the camera so that it shows everything; by default for the first mesh
            only.
        {options}

        Returns
        -------
        FlowHandle

        Raises
        ------
        FieldError
            When the mesh does not contain a flow.
        SettingsError
            When a setting is unknown or out of range.
        ImageError
            When the image cannot be read or used; a subclass of SettingsError.

        Examples
        --------
        >>> import flowtex
        >>> import pyvista as pv
        >>> plotter = pv.Plotter(off_screen=True)
        >>> handle = plotter.flowtex.add(flowtex.examples.delta_wing(), scalars="height")
        >>> plotter.close()
        """
        scene = Scene.of(mesh, vectors=vectors, scalars=scalars, cmap=cmap, **options)
        return self.add_scene(scene, scalar_bar_args=scalar_bar_args, reset_camera=reset_camera)

    def add_scene(
        self,
        scene: Scene,
        *,
        scalar_bar_args: Mapping[str, Any] | None = None,
        reset_camera: bool | None = None,
    ) -> FlowHandle:
        """Draw a scene; the parameters are those of :meth:`add`."""
        first = not self._plotter.renderer.actors
        handle = FlowHandle(self._plotter, scene, self._forget, scalar_bar_args)
        self._handles.append(handle)
        if reset_camera or (reset_camera is None and first):
            look(self._plotter, scene.whole)
        return handle

    def for_browser(self) -> tuple[FlowField, dict[str, Any], Bodies]:
        """Return the first flow, its arguments, and the other meshes of the plotter.

        A warning lists what the browser cannot draw. Raises a FieldError if the plotter has no
        flow.
        """
        if not self._handles:
            msg = (
                "this plotter has no flow texture; add one with plotter.flowtex.add(mesh), or "
                "choose another jupyter_backend"
            )
            raise FieldError(msg)
        shown = self._handles[0]
        bodies, left_out = read_bodies(self._plotter, shown)
        if not np.allclose(shown.actor.user_matrix, np.eye(4)) or any(shown.actor.position):
            left_out.append("the place of the flow")
        if left_out:
            notify(
                "the browser draws one flow with meshes and labels; it does not show: "
                f"{', '.join(left_out)}. Another jupyter_backend, such as 'trame', draws them",
                UserWarning,
            )
        return shown.field, self._look_of(shown), bodies

    def _look_of(self, handle: FlowHandle) -> dict[str, Any]:
        """Return the arguments that reproduce the appearance of a handle."""
        mapper, prop, image = handle.actor.mapper, handle.actor.prop, handle.scene.image
        name = handle.scene.scalar_name
        colours: dict[str, Any] = {"scalars": False, "color": prop.color}
        if name is not None:
            table = np.asarray(mapper.lookup_table.values)
            colours = {"scalars": name, "cmap": table, "clim": tuple(mapper.scalar_range)}
        return {
            **dict(handle.settings),
            **colours,
            "image": None if image is None else as_image(image),
            "lighting": bool(prop.lighting),
            "opacity": float(prop.opacity),
            "show_scalar_bar": bool(self._plotter.scalar_bars),
            "background": self._plotter.background_color,
            "camera": read_camera(self._plotter.camera),
        }

    def __iter__(self) -> Iterator[FlowHandle]:
        """Yield the handles that have not been removed."""
        return iter(tuple(self._handles))

    def __len__(self) -> int:
        """Count the handles that have not been removed."""
        return len(self._handles)

    def clear(self, *, render: bool = True) -> None:
        """Remove every flow texture."""
        for handle in tuple(self._handles):
            handle.remove(render=False)
        if render:
            self._plotter.render()

    def _forget(self, handle: FlowHandle) -> None:
        if handle in self._handles:
            self._handles.remove(handle)

    def __plotter_close__(self) -> None:
        """Free the graphics card when the plotter closes."""
        self.clear(render=False)
