"""The data of a source: arrays that are not checked yet, and their names and units.

The names are those of the arguments of :meth:`FlowField.from_arrays` and
:meth:`FlowField.from_triangles`, to which :meth:`FlowField.of` passes them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TypeAlias

from numpy.typing import ArrayLike

from flowtex._util.arguments import check_types
from flowtex.field.earth.projection import Projection
from flowtex.remedies import Remedy

#: Share of the flow normal to the surface from which on the speed in it has another name. A curved
#: mesh alone has 1 or 2 %; at 5 % the speeds differ by a thousandth.
NOTABLE_SHARE = 0.05
#: Steps of reading, in their order.
STEPS = ("select", "align", "coordinates", "mask", "units", "components", "surface")


class ReadingStep(NamedTuple):
    """One sentence about what a step of reading did.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.FlowField.from_xarray(flowtex.examples.weather(), level=250)
    >>> step = field.reading[1]
    >>> step.step, step.text, step.caption
    ('select', 'level: 250 hPa', '250 hPa')
    """

    step: str  #: One of ``STEPS``.
    text: str
    notable: bool = False  #: Whether it is a choice that users must know: it is issued as a notice.
    caption: str = ""  #: Text for captions, such as ``"500 hPa"``.
    remedies: tuple[Remedy, ...] = ()  #: Arguments that draw something else, as the text has them.


class Reading(tuple[ReadingStep, ...]):
    """What was done to data before they became a field, one sentence after the other.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.FlowField.from_xarray(flowtex.examples.weather(), level=250)
    >>> field.reading.of("components")
    ('eastward and northward (by the names of the variables)',)
    """

    __slots__ = ()

    @property
    def caption(self) -> str:
        """Text for captions; empty for none."""
        captions = [step.caption for step in self]
        return ", ".join(filter(None, captions))

    def of(self, step: str) -> tuple[str, ...]:
        """Return the sentences of a step."""
        return tuple(item.text for item in self if item.step == step)

    def with_normal_share(self, share: float, notable: float) -> Reading:
        """Return the reading with the share of the flow that is normal to the surface."""
        if share < NOTABLE_SHARE:
            return self
        text = f"{share:.0%} of the flow is normal to the surface and is not drawn"
        return Reading((*self, ReadingStep("surface", text, share > notable)))

    def __str__(self) -> str:
        return "\n".join(f"{step.step}: {step.text}" for step in self)


NOTHING = Reading()  #: The reading of arrays.


class SectionAxes(NamedTuple):
    """Texts for the axes of a vertical section, whose units differ."""

    x: str
    y: str
    downward: bool  #: Whether the values of y grow downward.


@dataclass(frozen=True, kw_only=True, eq=False)
class FieldArrays:
    """The data of all sources; velocity and scalars may be read late."""

    points: ArrayLike
    velocity: Any
    times: ArrayLike | None = None
    valid: ArrayLike | None = None
    scalars: Mapping[str, Any] = field(default_factory=dict)
    cell_scalars: Mapping[str, Any] = field(default_factory=dict)
    name: str = ""
    length_unit: str = ""
    time_unit: str = ""
    velocity_unit: str = ""
    units: Mapping[str, str] = field(default_factory=dict)
    long_names: Mapping[str, str] = field(default_factory=dict)
    projection: Projection | None = None
    reading: Reading = NOTHING
    vectors: str = ""
    parts: tuple[str, ...] = ()  #: Names of the scalars that are components of other vectors.
    #: Share of the flow normal to the surface from which on a notice says so.
    notable_normal: float = 0.5
    volume_values: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check the types of what describes the arrays."""
        check_types(self)


@dataclass(frozen=True, kw_only=True, eq=False)
class GridArrays(FieldArrays):
    """The nodes of a structured surface, (J, I)."""

    periodic: str | None = None
    sign_free: bool = False
    section: SectionAxes | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class TriangleArrays(FieldArrays):
    """The nodes of a surface of triangles, (N,)."""

    triangles: ArrayLike


SourceArrays: TypeAlias = GridArrays | TriangleArrays  #: The arrays of any source.
