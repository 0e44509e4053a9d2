"""Arguments of all functions that draw a flow, each described once.

``plotter.flowtex.add``, :func:`flowtex.render`, :func:`flowtex.show`, :func:`flowtex.movie`,
:func:`flowtex.host.export`, :class:`flowtex.FlowWidget` and the command line pass on the fields of
three frozen classes: the part of a mesh to draw (:class:`~flowtex.field.options.FieldOptions`), the
appearance of the surface, and the view. Others are settings.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import brief, checked_count, closest, is_number, near_names
from flowtex._util.colours import (
    DEFAULT_CMAP,
    NORM_ENTRIES,
    SIGNED_CMAP,
    colour_table,
    matplotlib_norm,
    rgb,
)
from flowtex.errors import FieldError, notify, raise_faults
from flowtex.field import FlowField, Surface
from flowtex.field.derived.quantities import COMPONENTS, SIGNED, component_name
from flowtex.field.earth.coast import Coast
from flowtex.field.options import FieldOptions, option
from flowtex.field.validation import with_gaps
from flowtex.rendering.camera import CAMERA_LIMITS, Camera, read_camera
from flowtex.scene.fields import ARRAY, DATA
from flowtex.settings import TABLE, Settings, SettingsError
from flowtex.sources.coast_files import as_coast

if TYPE_CHECKING:
    from flowtex.rendering.webgl.bodies import Bodies

#: Colour of a surface without scalars: a grey that can become darker and lighter.
PLAIN_COLOR = "#a0a0a0"
NO_VALUE_COLOR = "darkgray"  #: Colour where there is no value, as in PyVista.
#: Colour of land, unobtrusive on a light and on a dark background.
LAND_COLOR = "#8f8b82"
#: Axes of a view in a browser: coordinates, a scale bar, or none.
AXES = ("ticks", "scale", "none")

COUNT = f"a whole number from 1 to {NORM_ENTRIES:,}"  #: Values of ``n_colors``.
SPEED = "speed"  #: The scalar that every flow has.
ROBUST = "robust"  #: The range of colours without outliers.
#: Arguments that are true or false.
SWITCHES = ("log_scale", "flip_scalars", "visible", "lighting", "show_scalar_bar")
COASTLINES = "coastlines"  #: The option of coasts, which may be lines of the user.
GRATICULE = "graticule"  #: The option of meridians and parallels.
EARTH_LINES = (COASTLINES, GRATICULE)  #: Lines of the Earth that are drawn or not.


def is_drawn(value: Any) -> bool:
    """Return whether the value of one of :data:`EARTH_LINES` draws lines, as by default."""
    return value is None or bool(value)


def coast_of(look: Appearance) -> Coast | None:
    """Return the lines of the user in place of coasts, if there are any."""
    if isinstance(look.coastlines, Coast):
        return look.coastlines
    return None


def default_cmap(scalars: Any) -> str:
    """Return the colour map of scalars for which none was chosen."""
    if isinstance(scalars, str) and scalars in SIGNED:
        return SIGNED_CMAP
    return DEFAULT_CMAP


@dataclass(frozen=True, kw_only=True, eq=False)  # arrays are not compared
class Appearance:
    """How the surface looks under the texture."""

    scalars: str | bool | None = option(
        None,
        "Values for the colours: the name of an array, also of vectors for their magnitude, "
        '``"speed"`` (the default: that of the flow along the surface), an array for the points or '
        "cells of a mesh or the nodes of a field, or ``False`` for a plain surface.",
    )
    component: int | str | None = option(
        None, "Component of the vectors that ``scalars`` names, 0 to 2 or ``x`` to ``z``."
    )
    cmap: Any | None = option(
        None,
        "Colour map: a name, a matplotlib map, a PyVista lookup table, or an array (N, 3 or 4), "
        "uint8 or from 0 to 1. By default it is RdBu_r for vorticity, divergence and okubo_weiss, "
        "and viridis for other values.",
    )
    clim: Any = option(
        None,
        "Values at the ends of the colour map, low and high, or ``5`` for -5 and 5; by default the "
        "range over all times, and in a slice that of its whole volume. "
        "The outermost 2 % of the values at an end are left out if they more than double it; "
        '``"robust"`` always leaves them out. If values lie beyond an end, the legend is pointed '
        "there. If the map diverges, such as coolwarm, and the values have both signs, zero is in "
        "the middle.",
    )
    log_scale: bool = option(
        default=False, text="Whether colours follow the logarithm, for values above 0."
    )
    norm: Any | None = option(
        None,
        "Norm from values to colours, in place of ``clim`` and ``log_scale``: a matplotlib "
        '``Normalize``, such as ``PowerNorm(0.5)``, or the name of a scale, such as ``"symlog"``. '
        "Limits that it lacks are those of the values.",
    )
    n_colors: int | None = option(None, "Number of colours of the map; by default 256.")
    flip_scalars: bool = option(default=False, text="Whether the colour map is reversed.")
    nan_color: Any = option(NO_VALUE_COLOR, "Colour where there is flow but no value.")
    below_color: Any | None = option(
        None, "Colour of values below the range; by default the first colour of the map."
    )
    above_color: Any | None = option(
        None, "Colour of values above the range; by default the last colour of the map."
    )
    color: Any = option(PLAIN_COLOR, "Colour of a plain surface, in any form that PyVista accepts.")
    opacity: float = option(1.0, "Opacity: 1 is opaque, 0 invisible.")
    visible: bool = option(default=True, text="Whether the surface is drawn.")
    lighting: bool | None = option(
        None,
        "Whether the surface is lit; by default only curved ones are, and no globes, whose colours "
        "are those of the legend.",
    )
    show_scalar_bar: bool | None = option(
        None,
        "Whether a legend of the colours is shown; by default it is, unless an image covers the "
        "colours.",
    )
    image: Any | None = option(
        None,
        "A picture that the flow smears, in its own colours: an array (H, W), (H, W, 3) or (H, "
        "W, 4), uint8 or floats from 0 to 1, or the path of a PNG or a JPEG. It covers the "
        "surface once, with its left at the first i and its top, row 0, at the last j; ``tiles`` "
        "repeats it. Where it is transparent the surface's colour is visible. It sets "
        '``noise="image"``, and ``strength=1`` unless that is given.',
    )
    coastlines: Any | None = option(
        None,
        "Whether coasts are drawn; by default if the field has a projection. Or other lines in "
        "their place: a GeoDataFrame or GeoSeries, or the path of a GeoJSON, shapefile or "
        "GeoPackage.",
    )
    graticule: bool | None = option(
        None, "Whether meridians and parallels are drawn; by default if the field has a projection."
    )
    land: Any = option(
        LAND_COLOR,
        "Colour of land where a field with a projection has no data. Coasts say what is land; the "
        "sea without data has a colour near the background. ``None`` draws nothing there.",
    )

    def __post_init__(self) -> None:
        """Check the values, and replace those that stand for others."""
        faults = []
        if self.scalars is None or self.scalars is True:
            object.__setattr__(self, "scalars", SPEED)
        elif self.scalars is not False and not isinstance(self.scalars, str):
            faults.append(
                f"scalars is {brief(self.scalars)}; expected the name of an array, or False"
            )
        if self.component is not None and str(self.component) not in COMPONENTS:
            faults.append(f"component is {brief(self.component)}; expected 0 to 2, or x to z")
        if self.cmap is None:
            object.__setattr__(self, "cmap", default_cmap(self.scalars))
        if not (is_number(self.opacity) and 0 <= self.opacity <= 1):
            faults.append(f"opacity is {brief(self.opacity)}; expected a number from 0 to 1")
        faults += self._check_range()
        for name in (*SWITCHES, *EARTH_LINES):
            value = getattr(self, name)
            is_coast = name == COASTLINES and isinstance(value, Coast)
            if not (is_coast or isinstance(value, (bool, np.bool_, type(None)))):
                faults.append(f"{name} is {brief(value)}; expected True or False")
        if self.land is False or (isinstance(self.land, str) and self.land == "none"):
            object.__setattr__(self, "land", None)
        raise_faults(faults + self._colour_faults())

    def _check_range(self) -> list[str]:
        """Replace ``clim`` by two numbers; return the faults of it and of the norm."""
        faults = []
        clim = self.clim
        if is_number(clim):  # as in PyVista
            clim = (-clim, clim)
        if clim is not None and not (isinstance(clim, str) and clim == ROBUST):
            try:
                low, high = map(float, clim)
            except (TypeError, ValueError, OverflowError):
                low = high = math.nan
            if not (low < high and math.isfinite(low + high)):
                faults.append(
                    f"clim is {brief(self.clim)}; expected two numbers, (low, high), the lower one "
                    f'first, or "{ROBUST}"'
                )
            elif not (isinstance(self.clim, tuple) and self.clim == (low, high)):
                object.__setattr__(self, "clim", (low, high))
        if self.norm is None:
            return faults
        superfluous = None
        if self.clim is not None:
            superfluous = "clim"
        elif self.log_scale:
            superfluous = "log_scale"
        if superfluous is not None:
            faults.append(
                f"norm is {brief(self.norm)}, and {superfluous} is given too; omit it, and give "
                "the norm its limits, as in PowerNorm(0.5, 0, 10)"
            )
        return faults

    def _colour_faults(self) -> list[str]:
        """Return the faults of colours, and of what maps values to colours."""
        count = partial(checked_count, "n_colors", high=NORM_ENTRIES, expected=COUNT)
        land = self.land
        if land is None:
            land = LAND_COLOR
        checks: tuple[tuple[Callable[[Any], Any], Any, Any], ...] = (
            (matplotlib_norm, self.norm, None),
            (count, self.n_colors, None),
            (colour_table, self.cmap, default_cmap(self.scalars)),
            (rgb, self.color, PLAIN_COLOR),
            (rgb, land, LAND_COLOR),
            (rgb, self.nan_color, NO_VALUE_COLOR),
            (rgb, self.below_color, None),
            (rgb, self.above_color, None),
        )
        faults = []
        for check, value, default in checks:
            if value is default:  # it needs no check, and loads nothing
                continue
            try:
                check(value)
            except ValueError as error:
                faults.append(str(error))
        return faults

    def changed(self, **changes: Any) -> Appearance:
        """Return another appearance; a colour map by default follows the scalars.

        A norm replaces ``clim`` and ``log_scale``, and either of these, or a new range for other
        scalars, the norm.
        """
        switch = changes.get(COASTLINES)
        if isinstance(self.coastlines, Coast) and isinstance(switch, bool):
            changes = {**changes, COASTLINES: replace(self.coastlines, shown=switch)}
        if changes.get("norm") is not None:
            changes = {"clim": None, "log_scale": False, **changes}
        ended = changes.get("clim") is not None or changes.get("log_scale")
        if ended or {"clim", "scalars"} <= set(changes):
            changes = {"norm": None, **changes}
        if isinstance(self.cmap, str) and self.cmap == default_cmap(self.scalars):
            changes = {"cmap": None, **changes}
        return replace(self, **changes)

    @property
    def scalar_name(self) -> str | None:
        """Name of the array that colours the surface; ``None`` for a plain one."""
        if self.component is None or not isinstance(self.scalars, str):
            if isinstance(self.scalars, str):
                return self.scalars
            return None
        return component_name(self.scalars, str(self.component))


#: Fields of the appearance that are attributes; a method changes the image.
LIVE = tuple(name for name in Appearance.__dataclass_fields__ if name != "image")


def _attribute(name: str) -> property:
    """Return a property that reads and changes a field of the appearance of ``self.scene``."""

    def get(self: AppearanceAttributes) -> Any:
        return getattr(self.scene.appearance, name)

    def change(self: AppearanceAttributes, value: Any) -> None:
        if name == COASTLINES:
            value = as_coast(value)
        self.scene.change({name: value})

    return property(get, change, doc=Appearance.__dataclass_fields__[name].metadata["text"])


class AppearanceAttributes:
    """Base of objects that show a scene: its field, settings and appearance as attributes.

    Attributes of the appearance can be set at any time. ``{appearance}`` in the docstring of a
    class becomes their names. After ``__init__`` any other name raises an error.
    """

    scene: Any  #: A Scene; an attribute or a property of the class.
    _is_made = False

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        cls.__doc__ = (cls.__doc__ or "").replace("{appearance}", ", ".join(LIVE))

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...

    @property
    def field(self) -> FlowField:
        """The flow."""
        field: FlowField = self.scene.field
        return field

    @property
    def settings(self) -> Settings:
        """Every setting, live."""
        settings: Settings = self.scene.settings
        return settings

    def __setattr__(self, name: str, value: Any) -> None:
        """Set an existing attribute; the error for another one names similar ones."""
        is_known = name.startswith("_") or hasattr(type(self), name) or name in vars(self)
        if self._is_made and not is_known:
            names = []
            for n in dir(type(self)):
                if not n.startswith("_"):
                    names.append(n)
            setting_hint = f"it is a setting: use settings.{name}"
            if name in TABLE:
                hint = setting_hint
            else:
                hint = near_names(name, names)
            raise AttributeError(f"{type(self).__name__} has no attribute {name!r}; {hint}")
        super().__setattr__(name, value)


for _name in LIVE:
    setattr(AppearanceAttributes, _name, _attribute(_name))


@dataclass(frozen=True, kw_only=True)
class ViewOptions:
    """The view of a flow, a second view beside it, and the background."""

    zoom: float = option(1.0, "Zoom: 1 shows the whole surface, 8 an eighth of its width.")
    focus: tuple[float, ...] | None = option(
        None, "Point of the mesh to look at, two or three coordinates; the middle by default."
    )
    camera: Any | None = option(
        None,
        "Camera: a :class:`flowtex.rendering.camera.Camera`, its values by name, that of a plotter "
        "(``plotter.camera``), or position, focal point and up direction as three points.",
    )
    background: Any = option(
        None, "Background colour; by default white, and in a browser that of the surrounding page."
    )
    beside: Mapping[str, Any] | None = option(
        None,
        "Settings of a second view to the right of the first, where they differ, such as "
        '``{"lod": False}``; both views move together.',
    )
    axes: str | None = option(
        None,
        'Axes of a view in a browser: ``"ticks"`` with coordinates, a ``"scale"`` bar, or '
        '``"none"``; by default ticks if the surface is flat or a map.',
    )

    def __post_init__(self) -> None:
        """Check values that nothing else checks."""
        if self.axes is not None and self.axes not in AXES:
            raise FieldError(
                f"axes is {brief(self.axes)}; expected {', '.join(map(repr, AXES))}, or None"
            )
        if self.background is not None:
            rgb(self.background)
        if hasattr(self.camera, "GetFocalPoint"):
            object.__setattr__(self, "camera", read_camera(self.camera))
        if not (self.beside is None or isinstance(self.beside, Mapping)):
            raise FieldError(
                f"beside is {brief(self.beside)}; expected settings by name, such as "
                "{'lod': False}"
            )

    @property
    def ground(self) -> Any:
        """Colour behind the surface, outside a page."""
        if self.background is None:
            return "white"
        return self.background

    def first_camera(
        self, surface: Surface, aspect: float = 1.5, margin: float = CAMERA_LIMITS.margin
    ) -> Camera:
        """Return the initial camera; :meth:`Camera.fit` has the parameters."""
        whole = Camera.fit(surface, aspect, zoom=self.zoom, focus=self.focus, margin=margin)
        if self.camera is None or isinstance(self.camera, Camera):
            return self.camera or whole
        if isinstance(self.camera, Mapping):
            return Camera.from_dict(self.camera, whole)
        return Camera.from_points(self.camera)


@dataclass(frozen=True, kw_only=True)
class Options:
    """Arguments of one call by purpose; ``bodies`` are the other meshes of the scene."""

    field: FieldOptions
    appearance: Appearance
    view: ViewOptions
    settings: Mapping[str, Any]
    bodies: Bodies | None = None

    def make_settings(self, field: FlowField | None = None, **defaults: Any) -> Settings:
        """Return all settings.

        An image keeps its own colours unless ``strength`` is given, and where winds and currents of
        the Earth are calm the texture fades unless ``fade`` is.

        Parameters
        ----------
        field
            The flow, for defaults that depend on it.
        defaults
            Settings where none are given.

        Raises
        ------
        SettingsError
            When both an image and another kind of ``noise`` are given, or a setting is invalid.
        """
        values = {**defaults, **self.settings}
        if field is not None and field.projection is not None:
            values.setdefault("fade", True)
        for name in EARTH_LINES:
            if field is not None and field.projection is None and getattr(self.appearance, name):
                notify(f"{name} is True, but the field is not on the Earth; none is drawn")
        lines = self.settings.get("lines", "auto")
        if field is not None and field.steady and lines != "auto":
            notify(f"lines is {lines!r}, but the flow is steady: its lines are all the same")
        if self.appearance.image is not None:
            noise = values.setdefault("noise", "image")
            if noise != "image":
                raise SettingsError(f"noise is {noise!r}, but an image is given; omit one of them")
            values.setdefault("strength", 1.0)
        return Settings(**values)

    @classmethod
    def split(cls, *kinds: str, **values: Any) -> Options:
        """Sort fields of the option classes, and settings, by name.

        Classes that are accepted are ``"field"``, ``"appearance"`` and ``"view"``, all by default.

        Raises
        ------
        SettingsError
            When no argument has the name; the error lists the nearest names.
        """
        accepted = {name: tuple(vars(_KINDS[name]())) for name in kinds or _KINDS}
        if COASTLINES in values:
            values[COASTLINES] = as_coast(values[COASTLINES])
        array: Any = values.get("scalars")
        is_list = isinstance(array, (list, tuple))  # perhaps of rows of different lengths
        if is_array := "field" in accepted and (is_list or np.ndim(array) > 0):
            array = with_gaps("scalars", array)
            values["scalars"] = DATA
        parts: dict[str, Any] = {}
        known = list(TABLE)
        for kind_name, kind in _KINDS.items():
            names = accepted.get(kind_name, ())
            arguments = {name: values.pop(name) for name in names if name in values}
            parts[kind_name] = kind(**arguments)
            known += names
        for name in values:
            if name not in TABLE:
                near = ""
                if close := closest(name, known):
                    near = f"did you mean {' or '.join(map(repr, close))}?"
                axis = f"to select along an axis, use sel={{{name!r}: {brief(values[name])}}}"
                near = near or f"help(flowtex.render) has all of them; {axis}"
                raise SettingsError(f"the setting or argument {name!r} does not exist; {near}")
        if is_array:  # which is read with the mesh, and is no argument of its own
            object.__setattr__(parts["field"], ARRAY, array)
        return cls(**parts, settings=values)


_KINDS: dict[str, type] = {"field": FieldOptions, "appearance": Appearance, "view": ViewOptions}
