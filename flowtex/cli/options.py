"""Flags of the command line: those of the file, of the picture, of the page, and the settings.

Their help comes from the fields of the option classes of :mod:`flowtex.options` and from
:data:`flowtex.settings.TABLE`; it stands here only where a shell has another form for a value.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, make_dataclass
from dataclasses import field as data_field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Group, Parameter
from cyclopts.validators import Number

from flowtex.errors import FieldError
from flowtex.options import Appearance, FieldOptions, ViewOptions, option_text
from flowtex.settings import TABLE, Setting, Settings, setting

__all__ = [
    "FILE",
    "FLAT",
    "PICTURE",
    "DrawFlags",
    "FieldFlags",
    "FrameFlags",
    "LookFlags",
    "ServeFlags",
    "SettingFlags",
    "UsageError",
    "number_or_text",
    "settings_from",
]

FLOW, PICTURE = Group("The flow", sort_key=1), Group("The picture", sort_key=2)
PAGE, SETTINGS = Group("The page", sort_key=3), Group("Settings", sort_key=4)

PORT = Number(gte=0, lt=65536)
ALLOW_HOST = Parameter(
    group=PAGE,
    help="Name under which browsers may ask for the page besides localhost and --host, such as "
    "that of a proxy before it; several times for several, '*' for any.",
    negative=(),
)
FILE = Annotated[
    Path,
    Parameter(
        help="A mesh: any file that PyVista reads, or PLOT3D; or data of the Earth: "
        "NetCDF, Zarr, GRIB or the JSON of wind maps, several files where they belong together."
    ),
]
FLAT = Parameter(name="*")
#: What a flag of several numbers expects.
POINT, RANGE = "two or three coordinates", "two numbers"


class UsageError(FieldError):
    """Arguments that cannot be followed; the text says how they can."""


def _flag(kind: type, name: str, text: str | None = None, **more: Any) -> Parameter:
    """Return a flag for a field of an option class.

    The text of the field is the help, but where a shell has another form for the value.
    """
    group = FLOW if kind is FieldOptions else PICTURE
    return Parameter(group=group, help=text or option_text(kind, name), **more)


@dataclass(kw_only=True)
class FieldFlags:
    """What of a file makes the flow."""

    plane: Annotated[str | None, _flag(FieldOptions, "plane")] = None
    slice: Annotated[
        str | None,
        _flag(
            FieldOptions,
            "slice",
            "Plane through any volume: ``x=0.5``, or a normal and a point, "
            '``"1,1,0 through 0,0,2"``; the point is the middle by default.',
            allow_leading_hyphen=True,
        ),
    ] = None
    contour: Annotated[
        str | None,
        _flag(
            FieldOptions,
            "contour",
            "Surface in a volume where an array has a value: ``pressure=101325``.",
        ),
    ] = None
    vectors: Annotated[str | None, _flag(FieldOptions, "vectors")] = None
    time: Annotated[
        str | None,
        Parameter(
            group=FLOW,
            help="One time of a series, a number or a date, by its streamlines; all by default.",
        ),
    ] = None
    projection: Annotated[str | None, _flag(FieldOptions, "projection")] = None
    globe: Annotated[bool | None, _flag(FieldOptions, "globe", negative="")] = None
    level: Annotated[str | None, _flag(FieldOptions, "level", allow_leading_hyphen=True)] = None
    select: Annotated[
        tuple[str, ...],
        _flag(FieldOptions, "sel", "What to draw along another axis of a data set, as number=3."),
    ] = ()
    periodic: Annotated[
        str | None,
        _flag(
            FieldOptions, "periodic", "Axes that close on themselves: ``i``, ``j``, ``ij`` or none."
        ),
    ] = None
    block: Annotated[str | None, _flag(FieldOptions, "block")] = None
    sign_free: Annotated[bool | None, _flag(FieldOptions, "sign_free", negative="")] = None

    def arguments(self) -> dict[str, Any]:
        """Return the flags that were set, as arguments of ``FlowField.from_file``."""
        values = {name: value for name, value in asdict(self).items() if value not in (None, ())}
        for name in ("time", "level"):
            if name in values:
                values[name] = number_or_text(values[name])
        if chosen := values.pop("select", ()):
            pairs = [text.partition("=") for text in chosen]
            if not all(name and value for name, _, value in pairs):
                msg = f"--select is {' '.join(chosen)}; expected an axis and a value, as number=3"
                raise UsageError(msg)
            values["sel"] = {name: number_or_text(value) for name, _, value in pairs}
        if values.get("periodic") == "none":
            values["periodic"] = ""
        if str(values.get("block", "")).isdecimal():
            values["block"] = int(values["block"])
        return values


@dataclass(kw_only=True)
class LookFlags:
    """Colours, and what of the flow is seen."""

    scalars: Annotated[
        str, _flag(Appearance, "scalars", "Array to colour by, or none for a plain surface.")
    ] = "speed"
    cmap: Annotated[str | None, _flag(Appearance, "cmap", "Colour map, by matplotlib's name.")] = (
        Appearance.cmap
    )
    clim: Annotated[
        str | None,
        _flag(
            Appearance,
            "clim",
            "Values at the ends of the colour map, as low,high; by default the range over all "
            "times.",
            allow_leading_hyphen=True,
        ),
    ] = None
    coastlines: Annotated[bool | None, _flag(Appearance, "coastlines")] = None
    graticule: Annotated[bool | None, _flag(Appearance, "graticule")] = None
    land: Annotated[
        str,
        _flag(
            Appearance,
            "land",
            "Colour of the Earth where a field with a projection has no data, or none.",
        ),
    ] = Appearance.land
    background: Annotated[str, _flag(ViewOptions, "background")] = ViewOptions.background
    zoom: Annotated[float, _flag(ViewOptions, "zoom")] = ViewOptions.zoom
    focus: Annotated[
        str | None,
        _flag(
            ViewOptions,
            "focus",
            "Point of the mesh to look at, as x,y or x,y,z; the middle by default.",
            allow_leading_hyphen=True,
        ),
    ] = None
    image: Annotated[
        Path | None,
        _flag(Appearance, "image", "PNG or JPEG that the flow smears, in place of the noise."),
    ] = Appearance.image

    def arguments(self) -> dict[str, Any]:
        """Return colours, camera and image, as arguments of ``flowtex.render``."""
        if not self.zoom > 0:
            msg = f"--zoom is {self.zoom:g}; expected a positive number, 1 for the whole surface"
            raise UsageError(msg)
        return {
            "scalars": False if self.scalars == "none" else self.scalars,
            "cmap": self.cmap,
            "clim": None if self.clim is None else _numbers("--clim", self.clim, RANGE),
            "coastlines": self.coastlines,
            "graticule": self.graticule,
            "land": None if self.land == "none" else self.land,
            "background": self.background,
            "zoom": self.zoom,
            "focus": None if self.focus is None else _numbers("--focus", self.focus, POINT),
            "image": self.image,
        }


@dataclass(kw_only=True)
class DrawFlags(LookFlags):
    """How a picture is taken."""

    size: Annotated[str, Parameter(group=PICTURE, help="Width and height in pixels.")] = "1024x768"

    def pixels(self) -> tuple[int, int]:
        """Return width and height."""
        words = self.size.lower().replace("×", "x").split("x")
        if len(words) != 2 or not all(w.isdecimal() and 1 <= int(w) <= 16384 for w in words):
            msg = f"--size is {self.size!r}; expected width x height up to 16384, as in 1024x768"
            raise UsageError(msg)
        return int(words[0]), int(words[1])


@dataclass(kw_only=True)
class FrameFlags(DrawFlags):
    """How a picture, or each of a movie, is taken without a window."""

    supersampling: Annotated[
        int, Parameter(group=PICTURE, help="Draw larger by as much along each side, and average.")
    ] = 1
    annotations: Annotated[
        bool,
        Parameter(group=PICTURE, help="Write legend, scale bar, time and name on it.", negative=""),
    ] = False
    beside: Annotated[
        tuple[str, ...],
        _flag(
            ViewOptions,
            "beside",
            "What is different in a second view to the right of the first one, such as lod=false.",
            negative="",
            show_default=False,
        ),
    ] = ()

    def arguments(self) -> dict[str, Any]:
        """Return what :meth:`LookFlags.arguments` does, and these."""
        own = {
            "beside": _parsed_settings(self.beside),
            "supersampling": self.supersampling,
            "annotations": self.annotations,
        }
        return {**super().arguments(), **own}


@dataclass(kw_only=True)
class ServeFlags:
    """Where the page is served."""

    port: Annotated[
        int, Parameter(group=PAGE, help="Port; 0 takes a free one.", validator=PORT)
    ] = 0
    host: Annotated[
        str, Parameter(group=PAGE, help="Address to listen on: others may reach another one.")
    ] = "127.0.0.1"
    allow_host: Annotated[tuple[str, ...], ALLOW_HOST] = ()
    limit: Annotated[
        int | None,
        Parameter(
            group=PAGE,
            help="Pages at one time, each with a state of its own; by default what cores and "
            "memory have room for.",
        ),
    ] = None
    idle: Annotated[
        float,
        Parameter(group=PAGE, help="Minutes for which a page that was closed can come back."),
    ] = 15.0
    browser: Annotated[bool, Parameter(group=PAGE, help="Open the page in the browser.")] = True


def number_or_text(text: str) -> float | str:
    """Return a number where a text is one."""
    try:
        return float(text)
    except ValueError:
        return text


def _numbers(flag: str, text: str, expected: str) -> tuple[float, ...]:
    try:
        values = tuple(float(word) for word in text.split(","))
    except ValueError:
        values = ()
    if len(values) not in ((2,) if expected == RANGE else (2, 3)):
        msg = f"{flag} is {text!r}; expected {expected}, as in {flag} 1.5,0"
        raise UsageError(msg)
    return values


def settings_from(flags: SettingFlags | None) -> dict[str, Any]:
    """Return the settings of flags that were set, checked, as keyword arguments."""
    values = {name: v for name, v in vars(flags or SettingFlags()).items() if v is not None}
    Settings().update(**values)
    return values


def _parsed_settings(words: tuple[str, ...]) -> dict[str, Any] | None:
    """Read words such as ``lod=false`` as settings; ``None`` where there are none."""
    values: dict[str, Any] = {}
    for word in words:
        name, equals, text = word.partition("=")
        if not equals:
            msg = f"--beside {word!r} is no setting; expected name=value, as in --beside lod=false"
            raise UsageError(msg)
        row = setting(name.strip().replace("-", "_"))
        values[row.name] = row.parse(text)
    return values or None


def _annotation(row: Setting) -> Any:
    """Type of a flag that is None by default; its help names the default of the setting."""
    kind: Any = Literal[row.choices] if row.choices else row.kind
    span = f" From {row.low:g} to {row.high:g}." if row.low is not None else ""
    default = f" [default: {row.default}]"
    return Annotated[kind | None, Parameter(group=SETTINGS, help=row.text + span + default)]


if TYPE_CHECKING:

    @dataclass
    class SettingFlags:
        """One flag for each setting."""
else:
    SettingFlags = make_dataclass(
        "SettingFlags",
        [(row.name, _annotation(row), data_field(default=None)) for row in TABLE.values()],
        kw_only=True,
        # Annotations are looked up in the module that a class says it comes from.
        namespace={"__module__": __name__, "__doc__": "One flag for each setting."},
    )
