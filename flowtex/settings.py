"""The one table of settings.

Each row of :class:`Settings` has a setting's name, type, default, range and one sentence that
explains it to users. Command-line flags, shader uniforms, controls and the documentation are made
from :data:`TABLE`, so a new setting is one row here.

``affects`` is the cost of a change: ``"uniform"`` a number on the graphics card, ``"shader"`` a
shader build, ``"textures"`` new textures, ``"trace"`` new traces. For a number with a ``switch``,
True means the value of ``switch`` and False means 0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, fields
from typing import Any, Literal

from flowtex._util.arguments import brief, is_number, near_names
from flowtex.errors import FieldError

Affects = Literal["uniform", "shader", "textures", "trace"]
#: The control of a setting in a panel; a "number" is typed.
Control = Literal["checkbox", "choice", "slider", "number"]
#: A setting, and a value that it must or must not have.
Condition = tuple[str, Literal["==", "!="], Any]

#: Settings that have an effect only if one of these conditions holds.
_NEEDS_DENSE: tuple[Condition] = (("texture", "==", "dense"),)
_NEEDS_MOTION: tuple[Condition] = (("motion", "!=", "off"),)
NEEDS: dict[str, tuple[Condition, ...]] = {
    "texture": (("noise", "==", "procedural"),),
    "kernel": _NEEDS_DENSE,
    "two_sided": _NEEDS_DENSE,
    "tiles": (("noise", "==", "image"),),
    "resolution": (
        ("noise", "==", "texture"),
        ("fixed_grain", "==", True),
        ("lod", "==", False),
    ),
    "arrows": (("noise", "==", "procedural"),),
    "arrow_length": (("arrows", "!=", 0.0),),
    "arrow_color": (("arrows", "!=", 0.0),),
    "speed": _NEEDS_MOTION,
    "speed_in": _NEEDS_MOTION,
    "period": _NEEDS_MOTION,
}
LABELS = {"lod": "Level of detail"}  #: Labels that are not the name.
SLIDER_RANGE = 500  #: Widest range of a slider.
#: Ratio of the ends of a range beyond which a slider that can goes by the logarithm.
LOGARITHMIC_RATIO = 60
#: Words for the two values of a switch; the first two are used for output.
_SWITCH = {"on": True, "off": False, "true": True, "false": False, "yes": True, "no": False}


class SettingsError(FieldError):
    """A setting has an unknown name or an invalid value.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.Settings(samples=0)
    Traceback (most recent call last):
    flowtex.settings.SettingsError: samples is 0; expected a whole number from 1 to 200 (default 49)
    """


@dataclass(frozen=True)
class Setting:
    """One row of the table."""

    name: str
    kind: type
    default: Any
    affects: Affects
    text: str
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    switch: float | None = None

    def check(self, value: Any) -> Any:
        """Return the value in the setting's type.

        Raises
        ------
        SettingsError
            When the value has another type, or is not in the range or among the choices.
        """
        if type(value) is self.kind and value == self.default:
            return value
        if self.switch is not None and isinstance(value, bool):
            if value:
                value = self.switch
            else:
                value = 0
        if self.kind is bool:
            fits = isinstance(value, bool) or type(value).__name__ == "bool"
        elif self.kind is str:
            fits = isinstance(value, str) and value in self.choices
        else:
            fits = is_number(value) and (self.kind is float or float(value).is_integer())
            fits = fits and (self.low is None or value >= self.low)
            fits = fits and (self.high is None or value <= self.high)
        if not fits:
            expected = f"{self.expected} (default {self.default!r})"
            raise SettingsError(f"{self.name} is {brief(value)}; expected {expected}")
        return self.kind(value)

    def parse(self, text: str) -> Any:
        """Return the value of a text such as ``"off"``, ``"1.5"`` or ``"box"``, checked."""
        text = text.strip()
        value: Any = text
        if self.kind is bool or self.switch is not None:
            value = _SWITCH.get(text.lower(), text)
        if self.kind not in (bool, str):
            with suppress(ValueError):
                value = float(text)
        return self.check(value)

    def format(self, value: Any) -> str:
        """Return a value as the text that :meth:`parse` reads, without loss."""
        if self.kind is bool:
            if value:
                return "on"
            return "off"
        if self.kind is float:
            return repr(float(value))
        return str(value)

    @property
    def label(self) -> str:
        """The name as a panel shows it."""
        return LABELS.get(self.name, self.name.replace("_", " ").capitalize())

    @property
    def condition(self) -> str:
        """Condition under which the setting has an effect, as a sentence; empty if always."""
        needs = []
        for name, sign, value in NEEDS.get(self.name, ()):
            label = TABLE[name].label
            text = TABLE[name].format(value)
            if sign == "!=":
                needs.append(f"{label} ≠ {text}")
            else:
                needs.append(f"{label} = {text}")
        if needs:
            return f"Requires {' or '.join(needs)}."
        return ""

    @property
    def control(self) -> Control:
        """The control of the setting in a panel."""
        if self.kind is bool:
            return "checkbox"
        if self.choices:
            return "choice"
        if (self.high or 0) - (self.low or 0) > SLIDER_RANGE:
            return "number"
        return "slider"

    @property
    def logarithmic(self) -> bool:
        """Whether the slider is logarithmic."""
        return bool(self.low and self.high and self.high / self.low > LOGARITHMIC_RATIO)

    @property
    def expected(self) -> str:
        """A description of valid values."""
        if self.kind is bool:
            return "True or False"
        if self.kind is str:
            return " or ".join(map(repr, self.choices))
        if self.kind is int:
            number = "a whole number"
        else:
            number = "a number"
        if self.switch is None:
            switch = ""
        else:
            switch = "True, False or "
        return f"{switch}{number} from {self.low:g} to {self.high:g}"


def _row(
    text: str,
    *,
    default: Any,
    affects: Affects = "uniform",
    span: tuple[float, float] | None = None,
    choices: tuple[str, ...] = (),
    switch: float | None = None,
) -> Any:
    low, high = span or (None, None)
    row = {"affects": affects, "text": text, "low": low, "high": high, "choices": choices}
    row["switch"] = switch
    return field(default=default, metadata=row)


class Signal:
    """An event, and the functions that it calls."""

    def __init__(self) -> None:
        self._listeners: list[Callable[..., object]] = []

    def connect(self, listener: Callable[..., object]) -> Callable[[], None]:
        """Call a function at each event, after the others; the returned function disconnects it."""
        listeners = self._listeners
        listeners.append(listener)

        def disconnect() -> None:
            if listener in listeners:
                listeners.remove(listener)

        return disconnect

    def emit(self, *values: object) -> None:
        """Call the connected functions with these values."""
        for listener in list(self._listeners):
            listener(*values)


@dataclass
class Settings:
    """The settings of a flow texture; all can be changed while it is shown.

    Raises
    ------
    SettingsError
        If a value is out of range, or a name that does not exist is set.

    Examples
    --------
    >>> from flowtex import Settings
    >>> settings = Settings(samples=25, lod=False)
    >>> end = settings.observe(lambda name, value: print(name, value))
    >>> settings.contrast = 1.5
    contrast 1.5
    >>> dict(settings)["samples"]
    25
    """

    samples: int = _row(
        "Noise samples summed along each path (K in the paper).", default=49, span=(1, 200)
    )
    spacing: float = _row(
        "Distance between two samples, in grains of noise.", default=0.7, span=(0.1, 10)
    )
    texture: str = _row(
        "Streaks everywhere, or sparse ones with a bright head, which show which way the flow "
        "goes.",
        default="dense",
        choices=("dense", "streaklets"),
    )
    kernel: str = _row(
        "Weights of the samples: smooth, equal as in the paper, or decreasing behind the particle.",
        default="hann",
        choices=("hann", "box", "ramp"),
    )
    two_sided: bool = _row(
        "Follow the flow forward as well as backward from each point.", default=True
    )
    lod: bool = _row(
        "Fit the grain to each pixel; without it, grains are blobs in close views and flicker "
        "in distant ones.",
        default=True,
    )
    noise: str = _row(
        "Noise that is even in space, the mipmapped noise texture of the paper, or an image in "
        "its place.",
        default="procedural",
        affects="shader",
        choices=("procedural", "texture", "image"),
    )
    tiles: int = _row("Repeats of an image along each side.", default=1, span=(1, 64))
    resolution: int = _row(
        "Number of grains along the surface where their size is fixed, or of texels of a noise "
        "texture.",
        default=1024,
        span=(16, 8192),
    )
    grain: float = _row("Size of a grain of noise, in pixels.", default=1.7, span=(0.25, 32))
    fixed_grain: bool = _row(
        "Fix the size of a grain on the surface, so that it grows as the view comes closer.",
        default=False,
    )
    contrast: float = _row("Contrast of the texture, 0 for none.", default=1.0, span=(0, 4))
    strength: float = _row(
        "How strongly the texture darkens and lightens the colour.", default=0.65, span=(0, 1)
    )
    fade: float = _row(
        "Share of the typical speed below which the texture fades; data of the Earth have 0.05.",
        default=0.0,
        span=(0, 1),
        switch=0.05,
    )
    seed: int = _row("Seed of the noise pattern.", default=0, span=(0, 65535))
    motion: str = _row(
        "Let a steady flow stream: at the same speed everywhere, or faster where the flow is "
        "faster.",
        default="off",
        choices=("off", "uniform", "speed"),
    )
    speed: float = _row(
        "Distance that the pattern moves in a second; with motion='speed', where the flow has "
        "its typical speed.",
        default=40.0,
        span=(0, 1e12),
    )
    speed_in: str = _row(
        "Unit of speed: pixels, the same at every zoom, or the mesh's units.",
        default="pixels",
        choices=("pixels", "units"),
    )
    period: float = _row(
        "Seconds after which the streaming repeats, without a seam.", default=4.0, span=(0.1, 600)
    )
    arrows: float = _row(
        "Distance in pixels between arrows along the flow, 0 for none; True means 40.",
        default=0.0,
        span=(0, 400),
        switch=40.0,
    )
    arrow_length: str = _row(
        "Length of the arrows: the same everywhere, or longer where the flow is faster.",
        default="even",
        choices=("even", "speed"),
    )
    arrow_color: str = _row(
        "Colour of the arrows: dark with a light edge, or from the colour map, over a plain "
        "surface.",
        default="contrast",
        choices=("contrast", "scalars"),
    )
    critical_points: int = _row(
        "Number of critical points to mark, the strongest first; True means 100.",
        default=0,
        span=(0, 500),
        switch=100,
    )
    separatrices: int = _row(
        "Number of saddles whose separatrices are drawn, the strongest first; True means 25.",
        default=0,
        span=(0, 50),
        switch=25,
    )
    nullclines: bool = _row(
        default=False,
        text=(
            "Mark where the velocity along x is zero (orange), and that along y (pink), on a plane."
        ),
    )
    show_level: bool = _row(
        "Colour by the level of detail: one hue per doubling of the grain.", default=False
    )
    lines: str = _row(
        "Lines along which a time-varying flow is drawn; auto decides from its time steps.",
        default="auto",
        affects="trace",
        choices=("auto", "pathlines", "streamlines"),
    )
    parameter: str = _row(
        "Measure of the lag along a streamline: length, or the field's own time.",
        default="arclength",
        affects="trace",
        choices=("arclength", "time"),
    )

    def __post_init__(self) -> None:
        """Start without observers."""
        self._changed = Signal()

    def __setattr__(self, name: str, value: Any) -> None:
        """Check a value, set it, and call the observers when it differs."""
        if name.startswith("_"):
            super().__setattr__(name, value)
            return
        checked = setting(name).check(value)
        changed = name not in self.__dict__ or self.__dict__[name] != checked
        super().__setattr__(name, checked)
        if changed and "_changed" in self.__dict__:
            self._changed.emit(name, checked)

    def update(self, **values: Any) -> None:
        """Set several settings; if one value is invalid, none is changed."""
        checked = {name: setting(name).check(value) for name, value in values.items()}
        for name, value in checked.items():
            setattr(self, name, value)

    def observe(self, observer: Callable[[str, Any], None]) -> Callable[[], None]:
        """Call ``observer(name, value)`` after each change; the returned function ends this."""
        return self._changed.connect(observer)

    def copy(self) -> Settings:
        """Return a copy without the observers."""
        return Settings(**dict(self))

    def __iter__(self) -> Iterator[tuple[str, Any]]:
        """Yield (name, value) of every setting."""
        for name in TABLE:
            yield name, getattr(self, name)


def setting(name: str) -> Setting:
    """Return a row of the table of settings.

    Raises
    ------
    SettingsError
        When no setting has this name; the error lists the nearest names, or all.
    """
    if name in TABLE:
        return TABLE[name]
    raise SettingsError(f"the setting {name!r} does not exist; {near_names(name, TABLE)}")


def named_values(values: Mapping[str, Any]) -> str:
    """Return values of settings as people read them, such as ``"Samples: 10"``."""
    texts = []
    for name, value in values.items():
        row = TABLE[name]
        texts.append(f"{row.label}: {row.format(value)}")
    return ", ".join(texts)


_KINDS: dict[str, type] = {"int": int, "float": float, "bool": bool, "str": str}

#: Every setting by name, in the order of panels and documentation.
TABLE: dict[str, Setting] = {
    f.name: Setting(name=f.name, kind=_KINDS[str(f.type)], default=f.default, **f.metadata)
    for f in fields(Settings)
}
