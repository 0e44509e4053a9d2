"""Arguments of all functions that draw a flow, each described once.

``plotter.flowtex.add``, :func:`flowtex.render`, :func:`flowtex.show`, :func:`flowtex.movie`,
:func:`flowtex.web.export`, :class:`flowtex.FlowWidget` and the command line pass on the fields of
three frozen classes: the part of a mesh to draw, the appearance of the surface, and the view.
Others are settings. :mod:`flowtex.scene.signatures` puts the names, defaults and texts of the
fields into signatures and docstrings.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import brief, checked_count, closest, elsewhere, is_number
from flowtex._util.colours import (
    DEFAULT_CMAP,
    NORM_ENTRIES,
    SIGNED_CMAP,
    colour_table,
    matplotlib_norm,
    rgb,
)
from flowtex._util.notices import notify
from flowtex._util.written import (
    NUMBER,
    PLAIN,
    SWITCH,
    Form,
    UnreadableError,
    named_texts,
    number_or_text,
    numbers,
    or_none,
)
from flowtex.errors import FieldError, raise_faults
from flowtex.field import FlowField, Surface
from flowtex.field.derived import COMPONENTS, SIGNED, component_name
from flowtex.field.uncertainty import nodal_steps, with_uncertainty
from flowtex.field.validation import with_gaps
from flowtex.rendering.camera import CAMERA_LIMITS, Camera, read_camera
from flowtex.settings import TABLE, Settings, SettingsError, setting
from flowtex.sources.datasets import is_dataset
from flowtex.sources.datasets.select import two_names
from flowtex.sources.meshes.vectors import with_array

if TYPE_CHECKING:
    from flowtex.rendering.webgl.bodies import Bodies

#: Colour of a surface without scalars: a grey that can become darker and lighter.
PLAIN_COLOR = "#a0a0a0"
#: Colour where there is no value, as in PyVista.
NO_VALUE_COLOR = "darkgray"
#: Colour of land, unobtrusive on a light and on a dark background.
LAND_COLOR = "#8f8b82"
#: Axes of a view in a browser: coordinates, a scale bar, or none.
AXES = ("ticks", "scale", "none")

#: Arguments for data of the Earth only, and for meshes only.
OF_EARTH = ("projection", "globe", "level", "sel", "isel", "mask", "components")
OF_MESHES = ("plane", "slice", "contour", "block", "times", "periodic", "sign_free", "preference")
#: Values of ``n_colors``, and the form of a whole number or a name.
COUNT = f"a whole number from 1 to {NORM_ENTRIES:,}"
WHOLE = Form(read=lambda text: int(text) if text.isdecimal() else text)
#: The scalar that every flow has, and the range of colours without outliers.
SPEED, ROBUST = "speed", "robust"
#: Name of an array that is given as scalars, as in PyVista, and of the attribute that keeps it.
DATA, ARRAY = "Data", "_array"


def _option(default: Any, text: str, form: Form | None = PLAIN) -> Any:
    """Return a field with its explanation; ``form`` writes it in a shell or a link."""
    return field(default=default, metadata={"text": text, "form": form})


def _read_ends(text: str) -> str | tuple[float, ...]:
    if text == ROBUST:
        return ROBUST
    low, high = numbers(2, expected="two numbers, such as 1.5,3")(text)
    if not low < high:
        raise UnreadableError("two numbers, the lower one first")
    return low, high


def _read_differences(words: Sequence[str]) -> dict[str, Any]:
    """Read words such as ``lod=false`` as settings and as fields of :class:`Appearance`."""
    expected = "name=value, such as --beside lod=false"
    texts = named_texts(str, expected)(words)
    values: dict[str, Any] = {}
    for name, text in texts.items():
        key = name.strip().replace("-", "_")
        if (row := Appearance.__dataclass_fields__.get(key)) is not None:
            values[key] = row.metadata["form"].read(text)
        else:
            values[key] = setting(key).parse(text)
    return values


@dataclass(frozen=True, kw_only=True)
class FieldOptions:
    """The part of a mesh to draw; the names are those of :meth:`FlowField.from_pyvista`."""

    vectors: str | None = _option(
        None,
        "Name of the velocity, or of its two or three components separated by commas, such as "
        "``u,v,w``; not needed if there is only one candidate.",
    )
    u: str | None = _option(None, "Name of the first component; use it instead of ``vectors``.")
    v: str | None = _option(None, "Name of the second component.")
    w: str | None = _option(None, "Name of the third component; for meshes only.")
    plane: str | None = _option(None, 'Plane of a structured 3D mesh, such as ``"k=20"``.')
    slice: Any | None = _option(
        None,
        'Plane through any volume: ``"x=0.5"``, or a normal and a point, ``"1,1,0 through '
        '0,0,2"``; by default the point is the middle.',
    )
    contour: Any | None = _option(
        None, 'Isosurface of a volume, where an array has the given value: ``"pressure=101325"``.'
    )
    block: int | str | None = _option(
        None,
        "Number or path of the block to draw, if there are several.",
        WHOLE,
    )
    times: Sequence[float] | None = _option(
        None, "Times of a list of meshes; 0, 1, 2, ... by default.", form=None
    )
    periodic: str | None = _option(
        None,
        'Axes that close on themselves: ``"i"``, ``"j"``, ``"ij"`` or ``""``.',
        Form(read=or_none("")),
    )
    sign_free: bool | None = _option(None, "Whether v and -v mean the same, as in a field of axes.")
    preference: str | None = _option(None, 'Of two arrays of a name, ``"point"`` or ``"cell"``.')
    projection: str | None = _option(
        None,
        "Map of data of the Earth: ``platecarree``, ``mercator``, ``north``, ``south``, "
        "``lambert``, ``robinson``, ``equalearth``, ``globe``, or a PROJ string; by default one "
        "that suits the region.",
    )
    globe: bool | None = _option(None, "Whether data of the Earth are drawn on a globe.")
    level: float | str | None = _option(
        None,
        "Level of a dataset, such as ``500``; by default the one nearest to the surface.",
        Form(read=number_or_text),
    )
    sel: Mapping[str, Any] | None = _option(
        None,
        'Selection along other axes of a dataset, by value: ``{"number": 3}``.',
        Form(
            read=named_texts(number_or_text, "an axis and a value, such as number=3"), repeated=True
        ),
    )
    isel: Mapping[str, Any] | None = _option(
        None,
        'Like ``sel``, but by zero-based index: ``{"number": 2}``.',
        Form(read=named_texts(int, "an axis and a whole number, such as number=2"), repeated=True),
    )
    mask: str | bool | None = _option(
        None,
        "Variable of a dataset that marks where there is data; by default masks of common names, "
        "quality flags and undeclared fill values count. ``False`` draws all values.",
        Form(read=lambda text: text if text.lower() not in ("none", "false") else False),
    )
    components: str | None = _option(
        None,
        'Directions of the components of a dataset: ``"earth"`` (eastward, northward), ``"grid"`` '
        '(along rows and columns) or ``"plane"`` (along x and y); by default the names decide.',
    )
    uncertainty: ArrayLike | None = _option(
        None,
        "Directional uncertainty, which shortens and fades streaks: a scalar name or array "
        "(standard deviation ÷ speed), or an ensemble dimension to average over, such as "
        '``"number"``.',
    )

    def __post_init__(self) -> None:
        """Join the names of components to ``vectors``."""
        names = [name for name in (self.u, self.v, self.w) if name is not None]
        if not names:
            return
        if self.vectors is not None or self.u is None or self.v is None:
            given = {k: n for k, n in vars(self).items() if k in ("vectors", *"uvw") and n}
            words = ", ".join(f"{name}={value!r}" for name, value in given.items())
            raise FieldError(
                f"{words} is given; expected u and v (and w of a mesh), or vectors alone"
            )
        object.__setattr__(self, "vectors", ",".join(names))
        for name in "uvw":
            object.__setattr__(self, name, None)

    def field(self, mesh: Any, time: float | str | None = None) -> FlowField:
        """Return the field of a mesh or of a file (at one time), or a field unchanged."""
        choices = {name: value for name, value in vars(self).items() if value is not None}
        uncertainty, array = choices.pop("uncertainty", None), choices.pop(ARRAY, None)
        if array is not None and hasattr(mesh, "point_data"):
            mesh, array = with_array(mesh, DATA, array), None
        field = self._read(mesh, choices, time, uncertainty)
        if array is not None:
            steps = nodal_steps(field, array, "scalars", "the name of an array, or ")
            field = field.same_flow(scalars={**field.scalars, DATA: steps})
        # Datasets and files are averaged where they are read.
        is_done = uncertainty is None or bool(field.uncertainty and field is not mesh)
        return field if is_done else with_uncertainty(field, uncertainty)

    def _read(
        self, mesh: Any, choices: dict[str, Any], time: float | str | None, uncertainty: Any
    ) -> FlowField:
        if (stored := self._of_store(mesh, choices, time, uncertainty)) is not None:
            return stored
        if is_dataset(mesh):
            return FlowField.from_xarray(mesh, uncertainty=uncertainty, **self._of_dataset(choices))
        meshes = mesh if isinstance(mesh, (list, tuple)) and mesh else [mesh]
        if all(isinstance(item, (str, Path)) for item in meshes):
            if "times" in choices:
                raise FieldError(f"times is given, but {str(mesh)!r} already has times; omit it")
            return FlowField.from_file(mesh, time=time, uncertainty=uncertainty, **choices)
        if not isinstance(mesh, FlowField):
            self._refuse(choices, OF_EARTH, "datasets, but this is a mesh")
            return FlowField.from_pyvista(mesh, **choices)
        if choices:
            raise FieldError(
                f"{', '.join(choices)} cannot be set for a field that already exists, {mesh!r}; "
                "set it when you make the field"
            )
        return mesh

    def _of_store(
        self, place: Any, choices: dict[str, Any], time: float | str | None, uncertainty: Any
    ) -> FlowField | None:
        """Return the field of a pyramid in a store, where there is one."""
        if not isinstance(place, (str, Path)) or Path(place).is_file():
            return None  # before anything is loaded
        from flowtex.pyramid import is_store, open_store
        from flowtex.pyramid.source import has_parts

        if not has_parts(place):
            return None
        if is_store(place):
            arguments = choices if time is None else {**choices, "time": time}
            self._refuse(arguments, tuple(arguments), "the source of a pyramid")
        if time is not None:
            choices = {**choices, "sel": {**choices.get("sel", {}), "time": time}}
        return open_store(place, uncertainty=uncertainty, **self._of_dataset(choices))

    def _of_dataset(self, choices: dict[str, Any]) -> dict[str, Any]:
        self._refuse(choices, OF_MESHES, "meshes, but this is a dataset")
        return {**two_names(choices.pop("vectors", None)), **choices}

    @staticmethod
    def _refuse(choices: Mapping[str, Any], names: tuple[str, ...], scope: str) -> None:
        if given := [name for name in names if name in choices]:
            raise FieldError(f"{', '.join(given)} applies to {scope}; omit it")


#: Lines of the Earth that are drawn or not.
EARTH_LINES = ("coastlines", "graticule")


def default_cmap(scalars: Any) -> str:
    """Return the colour map of scalars for which none was chosen."""
    return SIGNED_CMAP if isinstance(scalars, str) and scalars in SIGNED else DEFAULT_CMAP


@dataclass(frozen=True, kw_only=True, eq=False)  # arrays are not compared
class Appearance:
    """How the surface looks under the texture."""

    scalars: str | bool | None = _option(
        None,
        "Values for the colours: the name of an array, also of vectors for their magnitude, "
        '``"speed"`` (the default: that of the flow along the surface), an array for the points or '
        "cells of a mesh or the nodes of a field, or ``False`` for a plain surface.",
        Form(read=or_none(value=False)),
    )
    component: int | str | None = _option(
        None,
        "Component of the vectors that ``scalars`` names, 0 to 2 or ``x`` to ``z``.",
        WHOLE,
    )
    cmap: Any | None = _option(
        None,
        "Colour map: a name, a matplotlib map, a PyVista lookup table, or an array (N, 3 or 4), "
        "uint8 or from 0 to 1. By default it is RdBu_r for vorticity, divergence and okubo_weiss, "
        "and viridis for other values.",
        Form(
            "Colour map, a matplotlib name; by default RdBu_r for vorticity, divergence and "
            "okubo_weiss, otherwise viridis."
        ),
    )
    clim: Any = _option(
        None,
        "Values at the ends of the colour map, low and high, or ``5`` for -5 and 5; by default the "
        "range over all times, and in a slice that of its whole volume. "
        "The outermost 2 % of the values at an end are left out if they more than double it; "
        '``"robust"`` always leaves them out. If values lie beyond an end, the legend is pointed '
        "there. If the map diverges, such as coolwarm, and the values have both signs, zero is in "
        "the middle.",
        Form(read=_read_ends, write=lambda ends: ",".join(repr(float(end)) for end in ends)),
    )
    log_scale: bool = _option(
        default=False, text="Whether colours follow the logarithm, for values above 0.", form=SWITCH
    )
    norm: Any | None = _option(
        None,
        "Norm from values to colours, in place of ``clim`` and ``log_scale``: a matplotlib "
        '``Normalize``, such as ``PowerNorm(0.5)``, or the name of a scale, such as ``"symlog"``. '
        "Limits that it lacks are those of the values.",
        Form("Norm from values to colours: the name of a matplotlib scale, such as symlog."),
    )
    n_colors: int | None = _option(None, "Number of colours of the map; by default 256.", WHOLE)
    flip_scalars: bool = _option(
        default=False, text="Whether the colour map is reversed.", form=SWITCH
    )
    nan_color: Any = _option(NO_VALUE_COLOR, "Colour where there is flow but no value.")
    below_color: Any | None = _option(
        None, "Colour of values below the range; by default the first colour of the map."
    )
    above_color: Any | None = _option(
        None, "Colour of values above the range; by default the last colour of the map."
    )
    color: Any = _option(
        PLAIN_COLOR, "Colour of a plain surface, in any form that PyVista accepts."
    )
    opacity: float = _option(1.0, "Opacity: 1 is opaque, 0 invisible.", NUMBER)
    visible: bool = _option(default=True, text="Whether the surface is drawn.", form=SWITCH)
    lighting: bool | None = _option(
        None, "Whether the surface is lit; by default only curved ones are.", SWITCH
    )
    show_scalar_bar: bool | None = _option(
        None,
        "Whether a legend of the colours is shown; by default it is, unless an image covers the "
        "colours.",
        SWITCH,
    )
    image: Any | None = _option(
        None,
        "A picture that the flow smears, in its own colours: an array (H, W), (H, W, 3) or (H, "
        "W, 4), uint8 or floats from 0 to 1, or the path of a PNG or a JPEG. It covers the "
        "surface once, with its left at the first i and its top, row 0, at the last j; ``tiles`` "
        "repeats it. Where it is transparent the surface's colour is visible. It sets "
        '``noise="image"``, and ``strength=1`` unless that is given.',
        Form("PNG or JPEG that the flow smears, instead of the noise.", Path),
    )
    coastlines: bool | None = _option(
        None, "Whether coasts are drawn; by default if the field has a projection.", SWITCH
    )
    graticule: bool | None = _option(
        None,
        "Whether meridians and parallels are drawn; by default if the field has a projection.",
        SWITCH,
    )
    land: Any = _option(
        LAND_COLOR,
        "Colour of the Earth where a field with a projection has no data, such as land in an "
        "ocean model; ``None`` draws nothing there.",
        Form(read=or_none()),
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
        clim = (-self.clim, self.clim) if is_number(self.clim) else self.clim  # as in PyVista
        if clim is not None and not (isinstance(clim, str) and clim == ROBUST):
            try:
                low, high = (float(value) for value in clim)
            except (TypeError, ValueError, OverflowError):
                low = high = math.nan
            if not (low < high and math.isfinite(low + high)):
                faults.append(
                    f"clim is {brief(self.clim)}; expected two numbers, (low, high), the lower one "
                    f'first, or "{ROBUST}"'
                )
            elif not (isinstance(self.clim, tuple) and self.clim == (low, high)):
                object.__setattr__(self, "clim", (low, high))
        if self.norm is not None and (self.clim is not None or self.log_scale):
            faults.append(
                f"norm is {brief(self.norm)}, and {'clim' if self.clim else 'log_scale'} is given "
                "too; omit it, and give the norm its limits, as in PowerNorm(0.5, 0, 10)"
            )
        switches = ("log_scale", "flip_scalars", "visible", "lighting", "show_scalar_bar")
        for name in (*switches, *EARTH_LINES):
            if not isinstance(value := getattr(self, name), (bool, np.bool_, type(None))):
                faults.append(f"{name} is {brief(value)}; expected True or False")
        if self.land is False or (isinstance(self.land, str) and self.land == "none"):
            object.__setattr__(self, "land", None)
        count = partial(checked_count, "n_colors", high=NORM_ENTRIES, expected=COUNT)
        checks: tuple[tuple[Callable[[Any], Any], Any, Any], ...] = (
            (matplotlib_norm, self.norm, None),
            (count, self.n_colors, None),
            (colour_table, self.cmap, default_cmap(self.scalars)),
            (rgb, self.color, PLAIN_COLOR),
            (rgb, LAND_COLOR if self.land is None else self.land, LAND_COLOR),
            (rgb, self.nan_color, NO_VALUE_COLOR),
            *((rgb, c, None) for c in (self.below_color, self.above_color)),
        )
        for check, value, default in checks:
            if value is not default:  # a default needs no check, and loads nothing
                try:
                    check(value)
                except ValueError as error:
                    faults.append(str(error))
        raise_faults(faults)

    def changed(self, **changes: Any) -> Appearance:
        """Return another appearance; a colour map by default follows the scalars.

        A norm replaces ``clim`` and ``log_scale``, and either of these, or a new range for other
        scalars, the norm.
        """
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
            return self.scalars if isinstance(self.scalars, str) else None
        return component_name(self.scalars, str(self.component))

    @property
    def has_bar(self) -> bool:
        """Whether there is a legend."""
        shown = self.image is None if self.show_scalar_bar is None else self.show_scalar_bar
        return shown and self.visible


@dataclass(frozen=True, kw_only=True)
class ViewOptions:
    """The view of a flow, a second view beside it, and the background."""

    zoom: float = _option(1.0, "Zoom: 1 shows the whole surface, 8 an eighth of its width.")
    focus: tuple[float, ...] | None = _option(
        None,
        "Point of the mesh to look at, two or three coordinates; the middle by default.",
        Form(read=numbers(2, 3, expected="two or three coordinates, such as 1.5,0")),
    )
    camera: Any | None = _option(
        None,
        "Camera: a :class:`flowtex.rendering.camera.Camera`, its values by name, that of a plotter "
        "(``plotter.camera``), or position, focal point and up direction as three points.",
        Form(
            "Position, focal point and up direction, nine numbers separated by commas; or the "
            "camera from a page's link.",
            Camera.from_text,
        ),
    )
    background: Any = _option(
        None,
        "Background colour; by default white, and in a browser that of the surrounding page.",
        Form("Background colour; by default white, or that of the surrounding page."),
    )
    beside: Mapping[str, Any] | None = _option(
        None,
        "Settings of a second view to the right of the first, where they differ, such as "
        '``{"lod": False}``; both views move together.',
        Form(read=_read_differences, repeated=True),
    )
    axes: str | None = _option(
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
        return "white" if self.background is None else self.background

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
    def split(cls, *kinds: str, mesh: Any = None, **values: Any) -> Options:
        """Sort fields of the option classes, and settings, by name.

        Classes that are accepted are ``"field"``, ``"appearance"`` and ``"view"``, all by default.
        The mesh is what is drawn, whose axes may be named by mistake.
        Raises a SettingsError for an unknown argument, with the nearest names.
        """
        accepted = {name: tuple(vars(_KINDS[name]())) for name in kinds or _KINDS}
        array: Any = values.get("scalars")
        is_list = isinstance(array, (list, tuple))  # perhaps of rows of different lengths
        if is_array := "field" in accepted and (is_list or np.ndim(array) > 0):
            array, values["scalars"] = with_gaps("scalars", array), DATA
        parts = {
            name: kind(**{n: values.pop(n) for n in accepted.get(name, ()) if n in values})
            for name, kind in _KINDS.items()
        }
        known = (*TABLE, *(name for names in accepted.values() for name in names))
        for name in values:
            if name not in TABLE:
                near = elsewhere(name, known)
                if not near and (close := closest(name, known)):
                    near = f"did you mean {' or '.join(map(repr, close))}?"
                axis = f"to select along an axis, use sel={{{name!r}: {brief(values[name])}}}"
                several = mesh if isinstance(mesh, (list, tuple)) else [mesh]
                has_axis = any(name in getattr(one, "dims", ()) for one in several)
                if has_axis and is_dataset(mesh) and "sel" in known:
                    near = axis
                of_file = f"; {axis}" if isinstance(mesh, (str, Path)) else ""
                near = near or f"help(flowtex.render) has all of them{of_file}"
                raise SettingsError(f"the setting or argument {name!r} does not exist; {near}")
        if is_array:  # which is read with the mesh, and is no argument of its own
            object.__setattr__(parts["field"], ARRAY, array)
        return cls(**parts, settings=values)


_KINDS: dict[str, type] = {"field": FieldOptions, "appearance": Appearance, "view": ViewOptions}
