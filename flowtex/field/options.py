"""Arguments of functions as fields of frozen classes, each described once.

:func:`accepts_options` puts the names, defaults and texts of the fields into signatures and
docstrings. :class:`FieldOptions` has the arguments that select the flow in a mesh, a file or a
dataset. :mod:`flowtex.scene.options` has the arguments for drawing.
"""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import Field, dataclass, field, fields
from typing import Any, TypeVar

from numpy.typing import ArrayLike

from flowtex._util.arguments import brief, check_types
from flowtex.errors import FieldError

#: Description of all other arguments in docstrings.
SETTINGS_TEXT = "Any setting of :class:`~flowtex.Settings`, such as ``samples=25``."
#: Arguments for geospatial data only.
OF_EARTH = ("projection", "globe", "level", "sel", "isel", "dims", "direction", "max_edge")
#: Arguments for meshes only.
OF_MESHES = ("plane", "slice", "contour", "block", "times", "periodic", "sign_free", "preference")
#: Arguments for the units of data that have none, or other ones.
OF_UNITS = ("length_unit", "time_unit", "velocity_unit")
#: Arguments for meshes and datasets.
OF_BOTH = ("mask", "components", *OF_UNITS, "uncertainty")
OF_DATASETS = ("vectors", *OF_EARTH, *OF_BOTH)  #: Arguments for datasets.

Function = TypeVar("Function", bound=Callable[..., Any])


def option(default: Any, text: str) -> Any:
    """Return a field of an option class with its explanation."""
    return field(default=default, metadata={"text": text})


@dataclass(frozen=True, kw_only=True)
class FieldOptions:
    """The part of a mesh, a file or a dataset to draw."""

    vectors: str | None = option(
        None,
        "Name of the velocity, or of its two or three components, such as ``u,v,w`` or "
        '``("u", "v")``; not needed if there is only one candidate.',
    )
    u: str | None = option(None, "Name of the first component; use it instead of ``vectors``.")
    v: str | None = option(None, "Name of the second component.")
    w: str | None = option(None, "Name of the third component; for meshes only.")
    plane: Any | None = option(None, 'Plane of a structured 3D mesh, such as ``"k=20"``.')
    slice: Any | None = option(
        None,
        'Plane through any volume: ``"x=0.5"``, or a normal and a point, ``"1,1,0 through '
        '0,0,2"``; by default the point is the middle.',
    )
    contour: Any | None = option(
        None, 'Isosurface of a volume, where an array has the given value: ``"pressure=101325"``.'
    )
    block: int | str | None = option(
        None, "Number or path of the block to draw, if there are several."
    )
    times: Sequence[float] | None = option(
        None, "Times of a list of meshes; 0, 1, 2, ... by default."
    )
    periodic: str | None = option(
        None, 'Axes that close on themselves: ``"i"``, ``"j"``, ``"ij"`` or ``""``.'
    )
    sign_free: bool | None = option(None, "Whether v and -v mean the same, as in a field of axes.")
    preference: str | None = option(None, 'Of two arrays of a name, ``"point"`` or ``"cell"``.')
    projection: Any | None = option(
        None,
        "Map of data of the Earth: ``platecarree``, ``mercator``, ``north``, ``south``, "
        "``lambert``, ``robinson``, ``equalearth``, ``globe``, a PROJ string, or a projection of "
        "pyproj or cartopy; by default one that suits the region.",
    )
    globe: bool | None = option(None, "Whether data of the Earth are drawn on a globe.")
    level: float | str | None = option(
        None, "Level of a dataset, such as ``500``; by default the one nearest to the surface."
    )
    sel: Mapping[str, Any] | None = option(
        None, 'Selection along other axes of a dataset, by value: ``{"number": 3}``.'
    )
    isel: Mapping[str, Any] | None = option(
        None, 'Like ``sel``, but by zero-based index: ``{"number": 2}``.'
    )
    mask: str | bool | None = option(
        None,
        "Variable of a dataset that marks where there is data; by default masks of common names, "
        "quality flags and undeclared fill values count. ``False`` draws all values, also fill "
        "values of a mesh.",
    )
    dims: str | None = option(
        None,
        "Coordinates of a dataset that are drawn across and upward, such as ``lon,lat``; by "
        "default their names and attributes decide.",
    )
    length_unit: str | None = option(
        None, "Unit of x and y, such as ``km``, in place of the one in the data."
    )
    time_unit: str | None = option(
        None, "Unit of times that are numbers, such as ``h``, in place of the one in the data."
    )
    velocity_unit: str | None = option(
        None, "Unit of the velocity, such as ``cm/s``, in place of the one in the data."
    )
    components: str | None = option(
        None,
        'Directions of the components: ``"polar"``, ``"cylindrical"`` (radius, angle, z) or '
        '``"spherical"`` (radius, colatitude, longitude); of a dataset also ``"earth"`` (eastward, '
        'northward), ``"grid"`` (along rows and columns) or ``"plane"`` (along x and y). Of a '
        'speed and a direction ``"from"`` or ``"to"`` (where the flow comes from or goes to, '
        'clockwise from north) or ``"angle"`` (counterclockwise from x). By default the names '
        "decide.",
    )
    direction: str | ArrayLike | None = option(
        None,
        "Variable with the direction of a speed, which ``vectors`` names, or for a speed in an "
        "array an array of angles. Attributes, names or ``components`` decide whether it is where "
        "the flow comes from or goes to, clockwise from north, or an angle counterclockwise from "
        "x.",
    )
    max_edge: float | str | None = option(
        None,
        "Longest edge of the triangles between scattered points, in the unit of the positions, on "
        "the Earth in kilometres, or with a unit, such as ``50 km``; by default triangles that are "
        "much larger than others nearby are left out.",
    )
    uncertainty: ArrayLike | None = option(
        None,
        "Directional uncertainty, which shortens and fades streaks: a scalar name or array "
        "(standard deviation ÷ speed), or an ensemble dimension to average over, such as "
        '``"number"``.',
    )
    slices: Any | None = option(
        None,
        "Paths that were traced before: :class:`~flowtex.TraceSlices` of this flow, from "
        ":func:`flowtex.trace` or ``TraceSlices.open``. By default flowtex traces them.",
    )

    #: Values that colour the surface, one for each node or cell; no argument of its own.
    array: Any | None = None

    def __post_init__(self) -> None:
        """Check the types of the values."""
        check_types(self)

    @classmethod
    def of(cls, **given: Any) -> FieldOptions:
        """Return the options of arguments; names of components are joined to ``vectors``.

        Parameters
        ----------
        given
            Fields of this class by name.

        Raises
        ------
        FieldError
            When names are arrays, do not belong together, or contradict one another.
        """
        for argument in ("vectors", "dims"):
            if argument in given:
                given[argument] = _joined_names(given[argument])
        _check_names(given)
        chosen = _with_direction(given)
        components = {}
        for argument in "uvw":
            name = chosen.pop(argument, None)
            if name is not None:
                components[argument] = name
        if not components:
            return cls(**chosen)
        vectors = chosen.get("vectors")
        if vectors is not None or "u" not in components or "v" not in components:
            named = {"vectors": vectors, **components}
            texts = [f"{argument}={name!r}" for argument, name in named.items() if name]
            raise FieldError(
                f"{', '.join(texts)} is given; expected u and v (and w of a mesh), or vectors alone"
            )
        chosen["vectors"] = ",".join(components.values())
        return cls(**chosen)

    @classmethod
    def of_dataset(cls, given: Mapping[str, Any]) -> FieldOptions:
        """Return the options of a dataset; other names select along axes."""
        known = {}
        axes = {}
        for name, value in given.items():
            if name in (*OF_DATASETS, *"uvw"):
                known[name] = value
            else:
                axes[name] = value
        if axes:
            known["sel"] = {**(known.get("sel") or {}), **axes}
        return cls.of(**known)

    @property
    def given(self) -> dict[str, Any]:
        """Values by name of arguments that select data, without those that are ``None``."""
        given = {}
        for name in option_names(FieldOptions):
            value = getattr(self, name)
            if value is not None and name != "slices":
                given[name] = value
        return given

    def refuse(self, names: Iterable[str], scope: str) -> None:
        """Refuse arguments for another kind of data.

        Parameters
        ----------
        names
            Names of the refused arguments.
        scope
            The data for which they are, and what this is instead.

        Raises
        ------
        FieldError
            When one of them is given.
        """
        refused = [name for name in self.given if name in names]
        if refused:
            raise FieldError(f"{', '.join(refused)} applies to {scope}; omit it")


def option_names(kind: type) -> tuple[str, ...]:
    """Return the names of the fields of an option class that are arguments, which have a text."""
    return tuple(each.name for each in fields(kind) if "text" in each.metadata)


def _check_names(given: Mapping[str, Any]) -> None:
    """Raise a FieldError for arrays in place of names."""
    for argument in ("vectors", *"uvw"):
        name = given.get(argument)
        if not isinstance(name, (str, type(None))):
            raise FieldError(
                f"{argument} is {brief(name)}; expected the name of an array. Pass arrays "
                "themselves by position, as in flowtex.show(x, y, u, v)"
            )


def _joined_names(value: Any) -> Any:
    """Return a list of names as one text with commas; anything else as it is."""
    is_list = isinstance(value, (list, tuple))
    if is_list and value and all(isinstance(name, str) for name in value):
        return ",".join(value)
    return value


def _with_direction(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return options with the names of a speed and of its direction in ``vectors``."""
    chosen = dict(given)
    direction = chosen.get("direction")
    if not isinstance(direction, str):
        return chosen
    if chosen.get("v") is not None or chosen.get("w") is not None:
        raise FieldError(
            f"direction is {direction!r} and components are named too; expected the speed "
            f'alone, as in vectors="speed", direction="{direction}"'
        )
    speed = chosen.pop("u", None)
    if speed is None:
        speed = chosen.get("vectors")
    if speed is not None:
        chosen["vectors"] = speed
        if "," not in speed:
            chosen["vectors"] = f"{speed},{direction}"
    return chosen


def accepts_options(
    *kinds: type, names: Collection[str] = (), settings: bool = True
) -> Callable[[Function], Function]:
    """Show the fields of option classes as arguments of a function that takes ``**options``.

    The line ``{options}`` of its docstring becomes their description. ``names`` limits the fields.
    Arguments in ``**selection`` or, with ``settings``, in ``**settings`` follow them.
    """

    def complete(function: Function) -> Function:
        options: list[Field[Any]] = []
        for kind in kinds:
            arguments = option_names(kind)
            for option in fields(kind):
                if option.name in arguments and (not names or option.name in names):
                    options.append(option)
        signature = inspect.signature(function)
        parameters = []
        rest = []
        for parameter in signature.parameters.values():
            if parameter.kind is not parameter.VAR_KEYWORD:
                parameters.append(parameter)
            elif parameter.name == "selection":
                rest = [parameter]
        for option in options:
            if option.name not in signature.parameters:
                parameters.append(
                    inspect.Parameter(
                        option.name, inspect.Parameter.KEYWORD_ONLY, default=option.default
                    )
                )
        if settings:
            rest = [inspect.Parameter("settings", inspect.Parameter.VAR_KEYWORD, annotation=Any)]
        changed = signature.replace(parameters=[*parameters, *rest])
        function.__signature__ = changed  # type: ignore[attr-defined]
        if function.__doc__:
            function.__doc__ = _described(function.__doc__, options, settings=settings)
        return function

    return complete


def _described(text: str, options: Iterable[Field[Any]], *, settings: bool) -> str:
    """Put the description of options into a docstring."""
    lines = []
    for line in text.splitlines():
        if line.strip() != "{options}":
            lines.append(line)
            continue
        indent = line[: line.index("{")]
        described = {option.name: option.metadata["text"] for option in options}
        if settings and "**settings" not in text:
            described["**settings"] = SETTINGS_TEXT
        for name, words in described.items():
            lines.append(f"{indent}{name}")
            filled = textwrap.fill(words, 96 - len(indent), break_on_hyphens=False)
            lines.append(textwrap.indent(filled, indent + "    "))
    return "\n".join(lines)
