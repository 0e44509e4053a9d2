"""Arguments of all functions that draw a flow, each described once.

``plotter.flowtex.add``, :func:`flowtex.render`, :func:`flowtex.show`, :func:`flowtex.movie`,
:func:`flowtex.host.export`, :class:`flowtex.FlowWidget` and the command line pass on the fields of
three frozen classes: the part of a mesh to draw (:class:`~flowtex.field.options.FieldOptions`), the
appearance of the surface, and the view. Others are settings.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
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
from flowtex.field.derived.kinds import SIGNED
from flowtex.field.earth.coast import Coast
from flowtex.field.matched_labels import has_labels
from flowtex.field.options import FieldOptions, option, option_names
from flowtex.field.validation import with_gaps
from flowtex.field.vector_names import COMPONENTS, component_name
from flowtex.rendering.camera import CAMERA_LIMITS, Camera, read_camera
from flowtex.scene.fields import DATA
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

    @classmethod
    def of(cls, **given: Any) -> Appearance:
        """Return the appearance of arguments, of which some stand for others.

        ``scalars=None`` is the speed, ``cmap=None`` the colour map that suits the scalars, one
        number as ``clim`` a range around zero, ``land=False`` or ``"none"`` no colour, and any
        other ``None`` the default.

        Parameters
        ----------
        given
            Fields of this class by name.

        Raises
        ------
        FieldError
            When a value is invalid; the error lists all that are.
        """
        values = {}
        for name, value in given.items():
            if value is not None or name == "land":
                values[name] = value
        scalars = values.get("scalars")
        if scalars is None or scalars is True:
            values["scalars"] = SPEED
        if values.get("cmap") is None:
            values["cmap"] = default_cmap(values["scalars"])
        values["clim"] = _as_range(values.get("clim"))
        count: Any = values.get("n_colors")
        if is_number(count) and float(count).is_integer():
            values["n_colors"] = int(count)
        land = values.get("land", LAND_COLOR)
        if land is False or (isinstance(land, str) and land == "none"):
            values["land"] = None
        return cls(**values)

    def __post_init__(self) -> None:
        """Check the values."""
        faults = []
        if self.scalars is not False and not isinstance(self.scalars, str):
            faults.append(
                f"scalars is {brief(self.scalars)}; expected the name of an array, or False"
            )
        if self.component is not None and str(self.component) not in COMPONENTS:
            faults.append(f"component is {brief(self.component)}; expected 0 to 2, or x to z")
        if not (is_number(self.opacity) and 0 <= self.opacity <= 1):
            faults.append(f"opacity is {brief(self.opacity)}; expected a number from 0 to 1")
        faults += self._range_faults()
        for name in (*SWITCHES, *EARTH_LINES):
            value = getattr(self, name)
            is_coast = name == COASTLINES and isinstance(value, Coast)
            if not (is_coast or isinstance(value, (bool, np.bool_, type(None)))):
                faults.append(f"{name} is {brief(value)}; expected True or False")
        raise_faults(faults + self._colour_faults())

    def _range_faults(self) -> list[str]:
        """Return the faults of the range and of the norm."""
        faults = []
        is_robust = isinstance(self.clim, str) and self.clim == ROBUST
        if not (self.clim is None or is_robust or _is_range(self.clim)):
            faults.append(
                f"clim is {brief(self.clim)}; expected two numbers, (low, high), the lower one "
                f'first, or "{ROBUST}"'
            )
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
        log_scale = changes.get("log_scale")
        is_log = isinstance(log_scale, (bool, np.bool_)) and bool(log_scale)
        ended = changes.get("clim") is not None or is_log
        if ended or {"clim", "scalars"} <= set(changes):
            changes = {"norm": None, **changes}
        if isinstance(self.cmap, str) and self.cmap == default_cmap(self.scalars):
            changes = {"cmap": None, **changes}
        return Appearance.of(**{**vars(self), **changes})

    @property
    def scalar_name(self) -> str | None:
        """Name of the array that colours the surface; ``None`` for a plain one."""
        if self.component is None or not isinstance(self.scalars, str):
            if isinstance(self.scalars, str):
                return self.scalars
            return None
        return component_name(self.scalars, str(self.component))


def _as_range(clim: Any) -> Any:
    """Return two numbers, or the range around zero of one, as floats; anything else as it is."""
    if clim is None or isinstance(clim, str):
        return clim
    limits = clim
    if is_number(clim):  # as in PyVista
        limits = (-clim, clim)
    try:
        low, high = map(float, limits)
    except (TypeError, ValueError, OverflowError):
        return clim
    if not _is_range((low, high)):
        return clim
    return low, high


def _is_range(clim: Any) -> bool:
    """Return whether these are two finite numbers, the lower one first."""
    if not isinstance(clim, tuple) or len(clim) != 2:
        return False
    low, high = clim
    return bool(low < high and math.isfinite(low + high))


#: Fields of the appearance that are attributes; a method changes the image.
LIVE = tuple(name for name in option_names(Appearance) if name != "image")


class AppearanceAttribute:
    """An attribute that reads and changes the field of the appearance that has its name."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name
        self.__doc__ = Appearance.__dataclass_fields__[name].metadata["text"]

    def __get__(self, instance: AppearanceAttributes | None, owner: type) -> Any:
        if instance is None:
            return self
        return getattr(instance.scene.appearance, self._name)

    def __set__(self, instance: AppearanceAttributes, value: Any) -> None:
        if self._name == COASTLINES:
            value = as_coast(value)
        instance.scene.change({self._name: value})


class AppearanceAttributes:
    """Base of objects that show a scene: its field, settings and appearance as attributes.

    Attributes of the appearance can be set at any time. ``{appearance}`` in the docstring of a
    class becomes their names. After ``__init__`` any other name raises an error.
    """

    scene: Any  #: A Scene; an attribute or a property of the class.
    _is_made = False

    scalars = AppearanceAttribute()
    component = AppearanceAttribute()
    cmap = AppearanceAttribute()
    clim = AppearanceAttribute()
    log_scale = AppearanceAttribute()
    norm = AppearanceAttribute()
    n_colors = AppearanceAttribute()
    flip_scalars = AppearanceAttribute()
    nan_color = AppearanceAttribute()
    below_color = AppearanceAttribute()
    above_color = AppearanceAttribute()
    color = AppearanceAttribute()
    opacity = AppearanceAttribute()
    visible = AppearanceAttribute()
    lighting = AppearanceAttribute()
    show_scalar_bar = AppearanceAttribute()
    coastlines = AppearanceAttribute()
    graticule = AppearanceAttribute()
    land = AppearanceAttribute()

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

    @classmethod
    def of(cls, **given: Any) -> ViewOptions:
        """Return the view of arguments; the camera of a plotter is read.

        Parameters
        ----------
        given
            Fields of this class by name.

        Raises
        ------
        FieldError
            When a value is invalid.
        """
        if hasattr(given.get("camera"), "GetFocalPoint"):
            given["camera"] = read_camera(given["camera"])
        return cls(**given)

    def __post_init__(self) -> None:
        """Check values that nothing else checks."""
        is_known = isinstance(self.axes, str) and self.axes in AXES
        if self.axes is not None and not is_known:
            raise FieldError(
                f"axes is {brief(self.axes)}; expected {', '.join(map(repr, AXES))}, or None"
            )
        if self.background is not None:
            rgb(self.background)
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
        is_chosen = isinstance(lines, str) and lines != "auto"
        if field is not None and field.steady and is_chosen:
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
        if COASTLINES in values:
            values[COASTLINES] = as_coast(values[COASTLINES])
        accepted = kinds or tuple(_KINDS)
        if "field" in accepted:
            values = _with_data(values)
        parts: dict[str, Any] = {}
        known = list(TABLE)
        for kind_name, kind in _KINDS.items():
            arguments = {}
            if kind_name in accepted:
                names = option_names(kind)
                known += names
                for name in (*names, *_INTERNAL.get(kind_name, ())):
                    if name in values:
                        arguments[name] = values.pop(name)
            parts[kind_name] = kind.of(**arguments)
        for name in values:
            if name not in TABLE:
                raise SettingsError(_unknown_argument(name, values[name], known))
        return cls(**parts, settings=values)


def _with_data(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return arguments of which scalars are a name; an array of them is read with the mesh."""
    scalars: Any = values.get("scalars")
    is_list = isinstance(scalars, (list, tuple))  # perhaps of rows of different lengths
    if not is_list and np.ndim(scalars) == 0:
        return dict(values)
    if not has_labels(scalars):
        scalars = with_gaps("scalars", scalars)
    return {**values, "scalars": DATA, "array": scalars}


def _unknown_argument(name: str, value: Any, known: Sequence[str]) -> str:
    """Return the error for an argument that does not exist."""
    if close := closest(name, known):
        near = f"did you mean {' or '.join(map(repr, close))}?"
    else:
        axis = f"to select along an axis, use sel={{{name!r}: {brief(value)}}}"
        near = f"help(flowtex.render) has all of them; {axis}"
    return f"the setting or argument {name!r} does not exist; {near}"


#: Fields of the option classes that are no arguments of their own.
_INTERNAL = {"field": ("array",)}
_KINDS: dict[str, Any] = {"field": FieldOptions, "appearance": Appearance, "view": ViewOptions}
