"""From a mesh and the arguments of ``plotter.flowtex.add`` to what a browser is handed.

:class:`Stage` joins a :class:`~flowtex.view.FlowView` to its colours and makes a
:class:`~flowtex.rendering.webgl.Scene` of both. The widget and the exported page begin with it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.field import FlowField
from flowtex.first_look import first_look
from flowtex.plotting.component import CMAP, FIELD_ARGUMENTS, PLAIN, as_field, with_image
from flowtex.rendering.webgl import Colours, Scene, camera_state
from flowtex.settings import TABLE, Settings
from flowtex.sharing import Shared, shared_field, shared_textures
from flowtex.textures.image_files import load_image
from flowtex.trace import SliceStore
from flowtex.view import FlowView, steps_of

__all__ = ["Stage", "coarsened", "staged", "straight"]

#: Entries of a colour map.
ENTRIES = 256

_coarse: Shared[SliceStore] = Shared()


class Stage:
    """A flow with its settings and colours, for a client in a browser.

    Parameters
    ----------
    mesh
        What ``plotter.flowtex.add`` takes.
    scalars, cmap, clim, color, opacity, lighting, show_scalar_bar
        As there; a colour map may also be an array (N, 3 or 4), uint8 or from 0 to 1.
    image
        A picture that the flow smears, as there.
    background
        Colour behind the surface.
    steps
        Number of time steps that are handed over, evenly chosen with the first and the last
        among them; all of them by default. Paths are traced through all of them all the same.
    **options
        Arguments for the making of the field, and settings.

    Attributes
    ----------
    view
        The flow, its settings and its traces.
    name
        What it is coloured by; ``None`` for a plain surface.
    own
        Settings of this view alone, where it stands beside another.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
    KeyError
        When there is no such scalar.
    ValueError
        When there is no such colour map, the opacity is none, or fewer than one time step is
        wanted.
    """

    def __init__(
        self,
        mesh: Any,
        *,
        scalars: str | bool | None = None,
        cmap: Any | None = None,
        clim: tuple[float, float] | None = None,
        color: Any = PLAIN,
        opacity: float = 1.0,
        lighting: bool | None = None,
        show_scalar_bar: bool | None = None,
        image: Any | None = None,
        background: Any = "white",
        steps: int | None = None,
        **options: Any,
    ) -> None:
        of_field = {name: options.pop(name, None) for name in FIELD_ARGUMENTS}
        settings = Settings()
        settings.update(**(options if image is None else with_image(options)))
        picture = load_image(image)
        table, plain, behind = colour_table(cmap), rgb(color), rgb(background)
        field = shared_field(as_field(mesh, **of_field))
        self.view = FlowView(field, settings, image=picture)
        self._kept = evenly(len(self.view.field.times), steps)
        self._clim = None if clim is None else (float(clim[0]), float(clim[1]))
        if not 0 <= opacity <= 1:
            msg = f"opacity is {opacity!r}; expected a number from 0 to 1"
            raise ValueError(msg)
        bar = image is None if show_scalar_bar is None else show_scalar_bar
        self._look = Colours(
            table=table, plain=plain, background=behind, opacity=float(opacity), bar=bar
        )
        self._lighting = lighting
        self.own: tuple[str, ...] = ()
        self.name = None if scalars is False else "speed"
        if isinstance(scalars, str):
            self.name = scalars
        if self.name is not None:
            self.view.scalar(self.name)

    @property
    def field(self) -> FlowField:
        """The flow."""
        return self.view.field

    def first_look(
        self,
        aspect: float = 1.5,
        *,
        zoom: float = 1.0,
        focus: tuple[float, ...] | None = None,
    ) -> dict[str, Any]:
        """Return a camera as a header has it; :func:`flowtex.first_look.first_look` has more."""
        return camera_state(first_look(self.field, aspect, zoom=zoom, focus=focus))

    @property
    def flat(self) -> bool:
        """Whether the surface lies in a plane."""
        return self.field.surface.frame is not None

    def colours(self, field: FlowField | None = None) -> Colours:
        """Return the colours of the field, or of a coarser one over the same range."""
        lit = (not self.flat) if self._lighting is None else self._lighting
        look = replace(self._look, lighting=lit)
        if self.name is None:
            return look
        values = steps_of(field or self.field, self.name)
        low, high = self._clim or self.view.scalar_range(self.name)
        return replace(look, name=self.name, values=values, low=low, high=high)

    def scene(self) -> Scene:
        """Return the scene as the settings are now; makes noise textures, and traces nothing."""
        settings = self.view.settings.copy()  # those of this moment: a thread may be building
        textures = shared_textures(self.view.store, settings, self.view.image)
        return Scene(textures, self.colours(), self._kept)

    def coarse_scene(self, nodes: int) -> Scene:
        """Return the same with so many nodes at most, for a first picture."""
        settings = self.view.settings
        field = shared_field(coarsened(self.field, nodes))
        store = _coarse.get(
            (id(field), settings.parameter),  # a store keeps its field alive
            lambda: SliceStore(field, parameter=settings.parameter, compose=False),
        )
        textures = shared_textures(store, settings, self.view.image)
        return Scene(textures, self.colours(field), self._kept)


def staged(mesh: Any, beside: Mapping[str, Any] | None = None, **options: Any) -> tuple[Stage, ...]:
    """Return the stage of a flow, and of a second view that differs in what ``beside`` has.

    Parameters
    ----------
    mesh, **options
        As for :class:`Stage`.
    beside
        Options of the second view, where there is one; the field is that of the first.
    """
    first = Stage(mesh, **options)
    if beside is None:
        return (first,)
    of_field = [name for name in FIELD_ARGUMENTS if name in beside]
    if of_field:
        msg = f"beside has {', '.join(of_field)}; both views show one field, expected settings"
        raise ValueError(msg)
    rest = {name: value for name, value in options.items() if name not in FIELD_ARGUMENTS}
    second = Stage(first.field, **{**rest, **beside})
    second.own = tuple(name for name in beside if name in TABLE)
    return first, second


def straight(image: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return an image of a view as it was given: row 0 at the top, colours without opacity."""
    opacity = image[..., 3:]
    plain = image[..., :3] / np.where(opacity > 0, opacity, np.float32(1.0))
    whole = np.concatenate([plain, opacity], axis=-1)[::-1]
    return np.asarray(whole.clip(0, 1), dtype=np.float32)


def evenly(count: int, wanted: int | None) -> tuple[int, ...]:
    """Return so many of the numbers below a count, or none of them where all are wanted.

    Raises
    ------
    ValueError
        When fewer than one is wanted.
    """
    if wanted is None or wanted >= count:
        return ()
    if wanted < 1:
        msg = f"steps is {wanted}; expected 1 to {count}, the time steps of the field"
        raise ValueError(msg)
    if wanted == 1:
        return (count - 1,)
    return tuple(int(n) for n in np.rint(np.linspace(0, count - 1, wanted)))


def coarsened(field: FlowField, nodes: int) -> FlowField:
    """Keep lines of nodes, the first and the last among them, so that so many nodes are left.

    Parameters
    ----------
    field
        The field.
    nodes
        How many nodes there may be, at least some dozens; a smaller field is returned as it is.
    """
    if field.valid.size <= nodes:
        return field
    share = np.sqrt(nodes / field.valid.size)
    rows, columns = (
        np.unique(np.rint(np.linspace(0, n - 1, max(int(n * share), min(n, 8)))).astype(int))
        for n in field.shape
    )
    at = np.ix_(rows, columns)
    return replace(
        field,
        points=field.points[at],
        velocity=field.velocity[:, at[0], at[1]],
        valid=field.valid[at],
        placed=None if field.placed is None else field.placed[at],
        scalars={k: s[:, at[0], at[1]] for k, s in field.scalars.items()},
    )


def colour_table(cmap: Any | None) -> NDArray[np.uint8]:
    """Return a colour map as (256, 4) uint8.

    Parameters
    ----------
    cmap
        A name, a map of matplotlib's, or a table as PyVista takes them; or an array (N, 3 or 4),
        uint8 or from 0 to 1.

    Raises
    ------
    ValueError
        When there is no such map.
    """
    if isinstance(cmap, np.ndarray):
        return _resampled(cmap)
    import pyvista as pv

    if isinstance(cmap, pv.LookupTable):
        return _resampled(np.asarray(cmap.values))
    table = pv.LookupTable(cmap or CMAP, n_values=ENTRIES)
    return _resampled(np.asarray(table.values))


def _resampled(colours: NDArray[Any]) -> NDArray[np.uint8]:
    if colours.ndim != 2 or colours.shape[1] not in (3, 4) or not len(colours):
        msg = f"cmap has shape {colours.shape}; expected a name, or (N, 3) or (N, 4)"
        raise ValueError(msg)
    values = colours.astype(float) * (255.0 if colours.dtype.kind == "f" else 1.0)
    table = np.full((ENTRIES, 4), 255.0)
    table[:, : values.shape[1]] = values[np.arange(ENTRIES) * len(values) // ENTRIES]
    return np.rint(table.clip(0, 255)).astype(np.uint8)


def rgb(colour: Any) -> tuple[float, float, float]:
    """Return a colour of any form that PyVista takes as red, green and blue from 0 to 1."""
    import pyvista as pv

    red, green, blue = pv.Color(colour).float_rgb
    return red, green, blue
