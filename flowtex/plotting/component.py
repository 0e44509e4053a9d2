"""Flow textures in PyVista: ``plotter.flowtex.add(mesh)``.

PyVista finds :class:`FlowtexComponent` through its entry point and makes one for each plotter
that asks for ``plotter.flowtex``. The component keeps a
:class:`~flowtex.plotting.handle.FlowHandle` for each texture.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pyvista as pv

from flowtex.field import FlowField
from flowtex.plotting.handle import FlowHandle
from flowtex.plotting.vtk_camera import look
from flowtex.settings import Settings, SettingsError
from flowtex.textures.image_files import load_image
from flowtex.view import FlowView

__all__ = ["FlowHandle", "FlowtexComponent", "as_field", "with_image"]

#: Colours when there are none to ask for: a neutral grey that can go darker and lighter.
PLAIN, CMAP = "#a0a0a0", "viridis"

#: A lit surface: dark sides stay bright enough to read the texture there.
LIT: dict[str, Any] = {"ambient": 0.3, "diffuse": 0.8}

#: A scalar bar that keeps out of the picture's way.
BAR: dict[str, Any] = {
    "fmt": "%.3g",
    "n_labels": 3,
    "vertical": True,  # labels of a level bar would hang over its ends
    "width": 0.08,
    "height": 0.36,
    "position_x": 0.02,
    "position_y": 0.04,
    "fill": True,
    "background_color": "white",
    "color": "black",
    "title_font_size": 16,
    "label_font_size": 14,
    "unconstrained_font_size": True,
}

#: Arguments of ``add`` that go to the making of the field.
FIELD_ARGUMENTS = ("vectors", "plane", "times", "periodic", "sign_free")


def as_field(mesh: Any, **options: Any) -> FlowField:
    """Return a field from a field, or from a mesh with :meth:`FlowField.from_pyvista`.

    Raises
    ------
    FieldError
        When the mesh does not make a field.
    TypeError
        When options for a mesh are given with a field that is made already.
    """
    given = {key: value for key, value in options.items() if value is not None}
    if not isinstance(mesh, FlowField):
        return FlowField.from_pyvista(mesh, **given)
    if given:
        msg = f"{', '.join(given)} cannot be chosen any more for {mesh!r}; choose when it is made"
        raise TypeError(msg)
    return mesh


def with_image(settings: dict[str, Any]) -> dict[str, Any]:
    """Return settings for an image: its colours alone, unless it is asked to be mixed."""
    noise = settings.get("noise", "image")
    if noise != "image":
        msg = f"noise is {noise!r} and an image is given; leave out one of them"
        raise SettingsError(msg)
    return {"strength": 1.0, **settings, "noise": "image"}


@pv.register_plotter_component("flowtex")
class FlowtexComponent:
    """The flow textures of one plotter."""

    def __init__(self, plotter: Any) -> None:
        self._plotter = plotter
        self._handles: list[FlowHandle] = []

    def add(
        self,
        mesh: Any,
        vectors: str | None = None,
        scalars: str | bool | None = None,  # noqa: FBT001 False is "by nothing", as in PyVista
        cmap: str | Any | None = None,
        *,
        clim: tuple[float, float] | None = None,
        plane: str | None = None,
        times: Any | None = None,
        periodic: str | None = None,
        sign_free: bool | None = None,
        image: Any | None = None,
        color: Any = PLAIN,
        opacity: float = 1.0,
        lighting: bool | None = None,
        show_scalar_bar: bool | None = None,
        scalar_bar_args: dict[str, Any] | None = None,
        reset_camera: bool | None = None,
        **settings: Any,
    ) -> FlowHandle:
        """Draw the flow on a structured mesh as a texture.

        Parameters
        ----------
        mesh
            A structured mesh with one flat index direction, a list of such meshes in time, or
            a :class:`~flowtex.FlowField`.
        vectors
            Name of the velocity; found when there is only one candidate.
        scalars
            What to colour by: the name of an array, ``"speed"`` (the default), or ``False`` for
            a plain texture.
        cmap, clim
            Colour map and range, as PyVista takes them. The range defaults to that over all
            times.
        plane
            Plane of a 3D mesh, such as ``"k=20"``.
        times, periodic, sign_free
            As for :meth:`FlowField.from_pyvista`.
        image
            A picture that the flow smears, in its own colours: an array (H, W), (H, W, 3) or
            (H, W, 4), uint8 or floats from 0 to 1, or the path of a PNG or a JPEG. It is laid
            over the surface once, its left at the first i and its top, row 0, at the last j;
            ``tiles`` repeats it. Where it is transparent the surface's colour shows. It sets
            ``noise="image"``, and ``strength=1`` unless that is given.
        color
            Colour of a plain texture.
        opacity
            1 is opaque, 0 invisible.
        lighting
            Whether the surface is lit; by default a curved one is and a flat one is not.
        show_scalar_bar, scalar_bar_args
            As for ``plotter.add_mesh``; by default there is a bar unless an image covers it.
        reset_camera
            Whether to move the camera so that everything is seen; by default when this is
            the first mesh.
        **settings
            Any setting of :class:`~flowtex.Settings`, such as ``samples=25``.

        Returns
        -------
        FlowHandle

        Raises
        ------
        FieldError
            When the mesh does not make a field.
        SettingsError
            When a setting is unknown or out of range.
        ImageError
            When the image cannot be read or used; a kind of SettingsError.
        """
        chosen = Settings()
        chosen.update(**(settings if image is None else with_image(settings)))
        picture = load_image(image)
        field = as_field(
            mesh,
            vectors=vectors,
            plane=plane,
            times=times,
            periodic=periodic,
            sign_free=sign_free,
        )
        view = FlowView(field, chosen, image=picture)
        name = self._scalar_name(view, scalars=scalars)
        look_first = reset_camera or (reset_camera is None and not self._plotter.renderer.actors)
        flat = view.textures.geometry.planar
        with_bar = image is None if show_scalar_bar is None else show_scalar_bar
        lit = (not flat) if lighting is None else lighting
        add_mesh: dict[str, Any] = {
            "opacity": opacity,
            "lighting": lit,
            **(LIT if lit else {}),
            "reset_camera": False,
            "bar": {**BAR, **(scalar_bar_args or {})} if with_bar else None,
        }
        if name is None:
            add_mesh["color"] = color
        else:
            limits = view.scalar_range(name) if clim is None else clim
            add_mesh |= {"scalars": name, "cmap": cmap or CMAP, "clim": limits}
        handle = FlowHandle(self._plotter, view, name, add_mesh, self._forget)
        self._handles.append(handle)
        if look_first:
            look(self._plotter, field)
        return handle

    @staticmethod
    def _scalar_name(view: FlowView, *, scalars: str | bool | None) -> str | None:
        if scalars is False:
            return None
        name = "speed" if scalars is None or scalars is True else scalars
        view.scalar(name)
        return name

    def __iter__(self) -> Iterator[FlowHandle]:
        """Give the handles that have not been removed."""
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
