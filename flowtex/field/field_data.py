"""The data of a flow on a surface, and what follows from them alone.

Functions of this package take a :class:`FieldData`; :class:`flowtex.FlowField` is the class that
users know, which makes it and checks it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import compress
from typing import Any, Self, SupportsIndex, TypeVar

import numpy as np

from flowtex._util.arguments import checked_count, is_number
from flowtex._util.array_types import Bools, Floats, Indices
from flowtex._util.arrays import rows_where
from flowtex.errors import FieldError
from flowtex.field.earth.projection import Projection
from flowtex.field.field_arrays import NOTABLE_SHARE, NOTHING, Reading, SectionAxes
from flowtex.field.formula.formula import Formula
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.field.node_surface import IndexVelocity
from flowtex.field.scalars import Scalars
from flowtex.field.steps import (
    LazySteps,
    Steps,
    first_moving,
    map_steps,
    scaled_steps,
    typical_steps,
)
from flowtex.field.triangles.triangle_surface import Surface, TriangleSurface
from flowtex.field.units import factor, speed_unit
from flowtex.field.validation import NO_DATA
from flowtex.field.vector_names import magnitude_label

Data = TypeVar("Data", bound="FieldData")  #: A field, for functions that return one of its kind.
#: Attribute of a coarsest level with the number of nodes (J, I) of the whole field.
WHOLE_SHAPE = "_whole_shape"
#: Attribute of the coarsest level of a store: the function that opens the field again.
OPENED = "_opened"
#: Attribute of a field that is coarser than its data: a :class:`flowtex.field.finer.Finest`.
FINEST = "_finest"

#: Attributes that are computed from positions and velocity alone.
_SHARED = ("surface", "index_velocity")
#: Attributes that a field with other scalars or steps has as well.
_LARGE = (WHOLE_SHAPE, FINEST)


@dataclass(frozen=True, eq=False, repr=False)
class FieldData:
    """Velocity on a surface; :class:`flowtex.FlowField` describes the attributes."""

    points: Floats
    velocity: Steps
    times: Floats
    valid: Bools
    periodic: tuple[bool, bool]
    scalars: Scalars[Steps] = field(default_factory=Scalars)
    name: str = ""
    length_unit: str = ""
    time_unit: str = ""
    has_position: Bools | None = None
    sign_free: bool = False
    units: Mapping[str, str] = field(default_factory=dict)
    long_names: Mapping[str, str] = field(default_factory=dict)
    start: Any = None
    projection: Projection | None = None
    triangles: Indices | None = None
    formula: Formula | None = None
    uncertainty: str = ""
    section: SectionAxes | None = None
    reading: Reading = NOTHING
    velocity_unit: str = ""
    volume_values: Mapping[str, Floats] = field(default_factory=dict)
    on_cells: tuple[str, ...] = ()
    vectors: str = ""
    parts: Mapping[str, Steps] = field(default_factory=dict)

    def __reduce_ex__(self, protocol: SupportsIndex) -> str | tuple[Any, ...]:
        opened = vars(self).get(OPENED)
        if opened is None:
            return super().__reduce_ex__(protocol)
        return (opened, ())

    def __getstate__(self) -> dict[str, Any]:
        """Return the data without cached properties, which are computed again."""
        kind = type(self)
        found = {}
        for name, value in vars(self).items():
            if not isinstance(getattr(kind, name, None), cached_property):
                found[name] = value
        return found

    @property
    def shape(self) -> tuple[int, int]:
        """Number of nodes (J, I)."""
        return self.valid.shape[0], self.valid.shape[1]

    @property
    def size_text(self) -> str:
        """Number of nodes as text, such as ``"120 x 70 nodes (I x J)"``."""
        if self.triangles is not None:
            return f"{self.shape[1]:,} nodes, {self.short_size}"
        return f"{self.shape[1]} x {self.shape[0]} nodes (I x J)"

    @property
    def short_size(self) -> str:
        """Number of nodes as text for captions, such as ``"120 × 70 nodes"``."""
        if self.triangles is not None:
            count = len(self.triangles)
            if count == 1:
                return "1 triangle"
            return f"{count:,} triangles"
        rows, columns = self.__dict__.get(WHOLE_SHAPE, self.shape)
        return f"{columns} × {rows} nodes"

    @property
    def nbytes(self) -> int:
        """Size of the arrays in memory, in bytes."""
        arrays = (self.points, self.velocity, self.valid, *self.scalars.values())
        return sum(array.nbytes for array in arrays)

    @property
    def steady(self) -> bool:
        """Whether the field has a single time step."""
        return len(self.times) == 1

    @cached_property
    def surface(self) -> Surface:
        """The geometry: tangents, cell sizes and positions between nodes."""
        points = self.points
        has_position = self.has_position
        if has_position is not None and not has_position.all():
            # Positions that were filled in must not count as known: tangents would bend.
            points = np.where(has_position[..., None], points, np.nan)
        on_globe = self.projection is not None and self.projection.is_globe
        if self.triangles is not None:
            return TriangleSurface(self.points, self.triangles, self.valid, on_globe=on_globe)
        return GridSurface(points, self.valid, self.periodic, on_globe=on_globe)

    @cached_property
    def index_velocity(self) -> IndexVelocity:
        """The velocity in index space, in cells per unit of time, with its speed."""
        expressed = self.surface.express
        if not isinstance(self.velocity, LazySteps):
            return expressed(self.velocity)

        def components_and_speed(velocity: Floats) -> Floats:
            step = expressed(velocity[None])
            return np.concatenate([step.components[0], step.speed[0, ..., None]], axis=-1)

        steps = self.velocity.map(components_and_speed)
        share = expressed(self.velocity[0][None]).normal_share
        return IndexVelocity(
            steps.map(lambda step: step[..., :2]), steps.map(lambda step: step[..., 2]), share
        )

    @property
    def speed(self) -> Steps:
        """Speed along the surface, on flat maps that on the Earth, (T, J, I)."""
        if not self.on_flat_map:
            return scaled_steps(self.index_velocity.speed, self.speed_scale)
        steps = map_steps(self.scalars["speed"], np.nan_to_num)
        if isinstance(self.velocity, LazySteps):
            return steps
        return np.asarray(steps)

    @property
    def normal_share(self) -> float:
        """Share of the flow that is normal to the surface, and so is not drawn, 0 to 1."""
        surface = self.surface
        frame = surface.frame
        if isinstance(surface, TriangleSurface) and surface.is_large:
            return surface.normal_share(self.velocity[0])
        if isinstance(surface, GridSurface) and surface.is_large and frame is None:
            return surface.normal_share(self._at_hand)
        if frame is None or isinstance(self.velocity, LazySteps):
            return self.index_velocity.normal_share
        total = 0.0
        normal = 0.0
        for step in self.velocity:
            flow = rows_where(step, self.valid)
            out = flow @ np.cross(*frame)
            total += np.vdot(flow, flow)
            normal += np.vdot(out, out)
        if total > 0:
            return float(np.sqrt(min(normal / total, 1.0)))
        return 0.0

    @property
    def _at_hand(self) -> Floats:
        """The velocity at all steps in memory, or at the first one, (T, J, I, 3)."""
        if isinstance(self.velocity, LazySteps):
            return np.asarray(self.velocity[0][None])
        return np.asarray(self.velocity)

    @property
    def leaves_surface(self) -> bool:
        """Whether a notable part of the flow is normal to the surface; see :attr:`speed_label`."""
        return self.normal_share > NOTABLE_SHARE

    def same_flow(self, **changes: Any) -> Self:
        """Return the field with other scalars or texts; positions and velocity stay."""
        if "scalars" in changes:
            changes["scalars"] = Scalars(changes["scalars"])
        flow = replace(self, **changes)
        self._keep(flow, (*_SHARED, *_LARGE))
        return flow

    def with_surface(self, surface: Surface) -> Self:
        """Keep the geometry, which equals what the property would compute; return this field."""
        self.__dict__["surface"] = surface
        return self

    def _keep(self, other: FieldData, names: Sequence[str]) -> None:
        """Give another field the values that are computed already, of some properties."""
        for name, value in self.__dict__.items():
            if name in names:
                other.__dict__[name] = value

    def forget(self) -> None:
        """Free derived data, which are computed again when needed."""
        for name in (*_SHARED, "typical"):
            self.__dict__.pop(name, None)

    def at_step(self, step: int) -> Self:
        """Return one time step as a steady field; negative numbers count from the end."""
        return self.at_steps([self.step_number(step)])

    def at_steps(self, steps: Sequence[int]) -> Self:
        """Return some time steps, given by increasing indices from 0, in memory."""
        first = steps[0]
        last = steps[-1] + 1
        if len(steps) == len(self.times) and not isinstance(self.velocity, LazySteps):
            return self
        if len(steps) < last - first:
            index: Any = list(steps)
        else:
            index = slice(first, last)
        part = replace(
            self,
            velocity=np.asarray(self.velocity[index]),
            times=self.times[index],
            scalars=_at_steps(self.scalars, index),
            parts=_at_steps(self.parts, index),
        )
        self._keep(part, _LARGE)
        return part.with_surface(self.surface)

    @cached_property
    def typical(self) -> Self:
        """The field at typical steps, for ranges and lengths; at all if they are in memory."""
        late = isinstance(self.velocity, LazySteps)
        if late:
            return self.at_steps(typical_steps(len(self.times)))
        return self

    def known_nodes(self, first: int, last: int) -> Bools:
        """Return the valid nodes that have data at all steps of a range, (J, I)."""
        known: Bools = self.valid.copy()
        for step in range(first, last + 1):
            if self.uncertainty == NO_DATA:
                known &= np.asarray(self.scalars[NO_DATA][step]) < 1
            elif self.has_late_gaps:
                # The speed may be one of the data, with gaps of its own.
                at_rest = ~np.any(self.velocity[step], axis=-1)
                known &= ~(np.isnan(self.scalars["speed"][step]) & at_rest)
        return known

    @property
    def has_late_gaps(self) -> bool:
        """Whether data may be missing at steps that are read later, where the speed is NaN."""
        return isinstance(self.velocity, LazySteps) and "speed" in self.scalars

    @cached_property
    def first_time(self) -> float:
        """The time that is shown by default: the first one at which something moves."""
        return float(self.times[first_moving(self.velocity)])

    def step_number(self, step: int) -> int:
        """Return the index of a time step from 0; negative numbers count from the end.

        Raises
        ------
        FieldError
            When the step does not exist.
        """
        count = len(self.times)
        if not (is_number(step) and -count <= step < count and int(step) == step):
            raise FieldError(f"time step {step} does not exist: expected 0 to {count - 1}")
        return int(step) % count

    def downsample(self, factor: int) -> Self:
        """Return the field at every ``factor``-th node along both axes.

        The last line of a closed axis stays.

        Raises
        ------
        FieldError
            When fewer than two lines would be left, or the surface consists of triangles.
        """
        if self.triangles is not None:
            raise FieldError(
                f"{self!r} has no lines of nodes; coarsen it, as in mesh.decimate(0.5)"
            )
        factor = checked_count("factor", factor, expected="1 or more")
        picks = []
        for count, closed in zip(self.shape, self.periodic, strict=True):
            lines = np.arange(0, count, factor)
            if closed and lines[-1] != count - 1:
                lines = np.append(lines, count - 1)
            if closed:
                fewest = 4
            else:
                fewest = 2
            if len(lines) < fewest:
                raise FieldError(
                    f"factor is {factor}, which keeps {len(lines)} of {count} lines; expected a "
                    f"smaller factor that keeps at least {fewest}"
                )
            picks.append(lines)
        return self.at_lines(*picks)

    def at_lines(self, rows: Indices, columns: Indices) -> Self:
        """Return the field on some of its lines of nodes, by increasing indices along j and i.

        A periodic axis keeps its first and its last line.
        """
        at = np.ix_(rows, columns)
        has_position = None
        if self.has_position is not None:
            has_position = self.has_position[at]
        return replace(
            self,
            points=self.points[at],
            velocity=self.velocity[:, at[0], at[1]],
            valid=self.valid[at],
            has_position=has_position,
            scalars=_at_nodes(self.scalars, at),
            parts=_at_nodes(self.parts, at),
            formula=None,  # as its nodes are evenly spaced
        )

    def __repr__(self) -> str:
        facts = [self.size_text]
        if self.steady:
            facts.append("steady")
        else:
            facts.append(f"{len(self.times)} steps")
        if any(self.periodic):
            facts.append("periodic " + "".join(compress("ij", self.periodic[::-1])))
        if self.sign_free:
            facts.append("sign-free")
        facts.append(f"{int((~self.valid).sum())} blanked")
        return f"FlowField({self.name or 'unnamed'}: {', '.join(facts)})"

    @property
    def on_flat_map(self) -> bool:
        """Whether the speed is a scalar, as a flat map distorts that along the surface."""
        flat = self.projection is not None and not self.projection.is_globe
        return flat and "speed" in self.scalars and "speed" in self.units

    @property
    def speed_unit(self) -> str:
        """Unit of the velocity of the data; empty if unknown."""
        if self.on_flat_map:
            return str(self.units["speed"])
        return self.velocity_unit or speed_unit(self.length_unit, self.time_unit)

    @cached_property
    def speed_scale(self) -> float:
        """Factor from units of length per unit of time to :attr:`speed_unit`."""
        own = speed_unit(self.length_unit, self.time_unit)
        if not own or self.speed_unit in ("", own):
            return 1.0
        return factor(own, self.speed_unit) or 1.0

    @property
    def speed_label(self) -> str:
        """Text for ``speed``, which off maps differs from a scalar of that name."""
        apart = self.leaves_surface or ("speed" in self.scalars and self.projection is None)
        return magnitude_label(self.vectors, self.velocity_unit) + " in the surface" * apart

    def label_of(self, name: str) -> str:
        """Return the text for a scalar, or for the speed, in a legend."""
        if name == "speed" and name not in self.scalars:
            return self.speed_label
        return str(self.long_names.get(name, name))

    def unit_of(self, name: str) -> str:
        """Return the unit of a scalar, or of the speed; empty if unknown."""
        if name in self.units or name != "speed" or name in self.scalars:
            return str(self.units.get(name, ""))
        return self.speed_unit


def _at_nodes(scalars: Mapping[str, Any], at: tuple[Any, ...]) -> Scalars[Any]:
    """Return the values of scalars at some nodes, which are an index of rows and columns."""
    return Scalars({name: steps[:, at[0], at[1]] for name, steps in scalars.items()})


def _at_steps(scalars: Mapping[str, Any], index: Any) -> Scalars[Any]:
    """Return the values of scalars at some time steps; those without time stay as they are."""
    chosen: Scalars[Any] = Scalars()
    for name, steps in scalars.items():
        if len(steps) > 1:
            chosen[name] = steps[index]
        else:
            chosen[name] = steps
    return chosen
