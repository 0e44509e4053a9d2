"""The flow on a surface: nodes, velocity, times, and which nodes carry data.

Data are checked when a :class:`FlowField` is made, with all faults in one error; the rest of the
package relies on it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import compress
from typing import Any, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import checked_count, is_number
from flowtex._util.array_types import Bools, Floats, Indices
from flowtex._util.progress import finish
from flowtex.errors import FieldError, notify
from flowtex.field.constructors import FieldConstructors
from flowtex.field.earth.projection import Projection
from flowtex.field.field_arrays import NOTABLE_SHARE, NOTHING, FieldArrays, Reading, SectionAxes
from flowtex.field.finer import FINEST
from flowtex.field.folds import with_faces
from flowtex.field.formula.formula import Formula
from flowtex.field.grids.grid_nodes import grid_nodes
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.field.node_surface import IndexVelocity
from flowtex.field.plain_arrays import plain_grid
from flowtex.field.quantities import FieldQuantities
from flowtex.field.scalars import Scalars
from flowtex.field.steps import (
    LazySteps,
    Steps,
    first_moving,
    map_steps,
    moves,
    scaled_steps,
    typical_steps,
)
from flowtex.field.triangles.triangle_arguments import READING_PARTS, triangle_nodes
from flowtex.field.triangles.triangle_surface import Surface, TriangleSurface
from flowtex.field.validation import ALL_AT_REST, prepared

#: Attribute of a coarsest level with the number of nodes (J, I) of the whole field.
WHOLE_SHAPE = "_whole_shape"
#: Attribute of the coarsest level of a store: the function that opens the field again.
OPENED = "_opened"

#: Attributes that a field takes from its source as they are.
KEPT = ("section", "reading", "volume_values")
#: Attributes that are computed from positions and velocity alone.
_SHARED = ("surface", "index_velocity")
#: Attributes that a field with other scalars or steps has as well.
_LARGE = (WHOLE_SHAPE, FINEST)


@dataclass(frozen=True, eq=False, repr=False)
class FlowField(FieldConstructors, FieldQuantities):
    """Velocity on a surface, steady or time-varying.

    Make one with :meth:`from_arrays`, :meth:`from_triangles`, :meth:`from_pyvista`,
    :meth:`from_xarray` or :meth:`from_file`. The nodes of a structured surface have the shape (J,
    I); those of triangles are one row, (1, N). Along a periodic axis the last line of nodes repeats
    the first; if a mesh ends one cell earlier, the line is appended to every array.

    Attributes
    ----------
    points
        Node positions, (J, I, 3), in the mesh's own units.
    velocity
        Velocity, (T, J, I, 3) with T = 1 when steady, in units of length per unit of time; zero at
        nodes that are not valid. Long series of datasets are read step by step.
    times
        Time of each step, (T,), strictly increasing.
    valid
        Nodes that have data, (J, I): neither blanked nor masked nor NaN.
    periodic
        Whether the (j, i) axis closes on itself.
    scalars
        Other nodal arrays, name to (T or 1, J, I). Those in ``on_cells`` are drawn flat: a cell has
        the value of its first node (j, i), and triangles have one each, (T or 1, 1, M).
    name, length_unit, time_unit
        Text for captions; empty when unknown.
    has_position
        Nodes whose position is known, (J, I), or ``None`` for all; others have the nearest one.
    sign_free
        Whether v and -v mean the same, as in a field of polarisations or principal directions.
    units, long_names
        Unit of each scalar, and its description for legends, where they are known.
    start
        The date at time 0, a ``datetime`` or a date of cftime, if the times count from a date.
    projection
        The map from longitude and latitude to positions, for a field of the Earth.
    triangles
        Indices of the nodes at the corners of triangles, (M, 3); ``None`` on a structured surface.
    formula
        The formula, if :func:`flowtex.formula` made the field.
    uncertainty
        Name of the scalar with the uncertainty of the direction; empty for none.
    section
        Texts for the axes of a vertical section; ``None`` for other surfaces.
    reading
        What was done to the data of a file, mesh or dataset, step by step; ``print(field.reading)``
        lists it.
    velocity_unit
        Unit of the velocity of the data, and of :attr:`speed`; empty for length per time.
    volume_values
        Values (N,) of scalars in the volume of a slice, at all times: the extremes, and a sample.
        Colours have their range.
    on_cells
        Names of the scalars that belong to cells.
    vectors
        Name of the vectors in the data, for legends; empty for a velocity without a name.
    parts
        Components of other vectors of a mesh, such as ``gradP_x``, by name, as in ``scalars``.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.airfoil_field()
    >>> field.shape, field.steady, field.periodic
    ((65, 193), True, (False, True))
    >>> float(field.speed.max()) > 1
    True
    """

    points: Floats
    velocity: Steps
    times: Floats
    valid: Bools
    periodic: tuple[bool, bool]
    scalars: Mapping[str, Steps] = field(default_factory=dict)
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

    def __post_init__(self) -> None:
        """Let unknown names of scalars raise errors that say how to get them."""
        if not isinstance(self.scalars, Scalars):
            object.__setattr__(self, "scalars", Scalars(self.scalars))

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

    @classmethod
    def of(cls, arrays: FieldArrays) -> FlowField:
        """Make a field from a source.

        Examples
        --------
        >>> import flowtex
        >>> from flowtex.field.field_arrays import GridArrays
        >>> arrays = GridArrays(points=([0, 1, 2], [0, 1]), velocity=[[(1, 0)] * 3] * 2)
        >>> flowtex.FlowField.of(arrays).shape
        (2, 3)
        """
        if hasattr(arrays, "triangles"):
            make: Any = cls.from_triangles
        else:
            make = cls.from_arrays
        arguments = dict(vars(arrays))
        notable = arguments.pop("notable_normal")
        kept = {}
        for k in KEPT:
            if k in arguments:
                kept[k] = arguments.pop(k)
        parts = arguments.pop("parts")
        field: FlowField = make(**arguments)
        scalars = dict(field.scalars)
        kept["parts"] = {name: scalars.pop(name) for name in parts}
        field = with_faces(field.same_flow(scalars=scalars, **kept))
        if isinstance(field.velocity, LazySteps) or arrays.projection is not None:
            return field
        reading = field.reading.with_normal_share(field.normal_share, notable)
        if reading != field.reading and reading[-1].notable:
            notify(reading[-1].text)
        return field.same_flow(reading=reading)

    @classmethod
    def from_arrays(
        cls,
        points: Any,
        velocity: Any = None,
        *components: Any,
        times: ArrayLike | None = None,
        valid: ArrayLike | None = None,
        periodic: str | None = None,
        scalars: Mapping[str, Any] | None = None,
        cell_scalars: Mapping[str, Any] | None = None,
        name: str = "",
        length_unit: str = "",
        time_unit: str = "",
        velocity_unit: str = "",
        vectors: str = "",
        sign_free: bool = False,
        units: Mapping[str, str] | None = None,
        long_names: Mapping[str, str] | None = None,
        projection: Projection | None = None,
    ) -> FlowField:
        """Make a field from arrays.

        Parameters
        ----------
        points
            Node positions, (J, I, 2) or (J, I, 3), in any unit of length. Or a tuple of
            coordinates: ``(x, y)`` of a rectilinear grid, (I,) and (J,), or two or three arrays
            (J, I).
        velocity
            Velocity at the nodes, (J, I, 2 or 3), or (T, J, I, 2 or 3) for a time-varying field, in
            ``velocity_unit``; or complex, u + iv, or with the components first. NaN and masked
            entries blank a node. A node with data at only some times is at rest at the others,
            without streaks, and the scalar ``"no data"`` is 1 there. Lazy steps (``LazySteps``)
            stay lazy: at most three are read to find such nodes.
        *components
            Further arrays: ``from_arrays(x, y, u, v)`` takes those of ``plt.streamplot`` and
            ``plt.quiver``, with u and v of the shape (J, I) or (T, J, I). ``from_arrays(u, v)``
            counts positions from 0, and ``from_arrays(x, y, z, u, v, w)`` is a surface in space.
            Quantities of pint and astropy have their units.
        times
            Time of each step, (T,), strictly increasing; 0, 1, 2, ... by default. Dates
            (``datetime64``, or cftime's) become seconds since the first, and are shown as dates.
        valid
            Nodes that have data, (J, I). All by default.
        periodic
            Axes that close on themselves: ``""``, ``"i"``, ``"j"`` or ``"ij"``. By default they are
            detected: first and last lines of nodes that coincide, a ring that ends one cell short,
            and global longitude on a flat map.
        scalars
            Further nodal arrays, name to (J, I) or (T, J, I); values beyond 1e100 become NaN.
        cell_scalars
            Arrays of one value for each cell, (J - 1, I - 1) or (T, J - 1, I - 1), drawn flat.
        name, length_unit, time_unit
            Text for captions.
        velocity_unit
            Unit of the velocity, such as ``"m/s"`` where positions are in mm; by default the unit
            of length per unit of time.
        vectors
            Name of the vectors for legends, such as ``"B"``; by default they are a velocity.
        sign_free
            Whether v and -v mean the same. Such a field is steady; it is drawn to both sides, and
            kernels and motions that distinguish forward from backward are not available. Vectors
            are reversed where that makes neighbours agree.
        units
            Unit of each scalar by its name, for legends.
        long_names
            Descriptions of scalars for legends, where they differ from their names.
        projection
            The map from longitude and latitude to the points, for a field of the Earth. It is used
            for coordinates of points and for coastlines. On a flat map the speed on the Earth is
            the scalar ``"speed"``, unless ``scalars`` has one.

        Returns
        -------
        FlowField

        Raises
        ------
        FieldError
            When the arrays do not describe a field. The error lists all faults.

        Warns
        -----
        UserWarning
            When the velocity is zero everywhere, so that the picture is plain.

        Notes
        -----
        The arrays are copied to float64 and never changed. At a fold, where cells turn by 35
        degrees or more, velocities of both sides mix over one cell, and a picture issues a notice;
        :meth:`from_pyvista` makes triangles of such a mesh, which keep them apart.

        Examples
        --------
        >>> import numpy as np
        >>> import flowtex
        >>> x, y = np.linspace(-1, 1, 41), np.linspace(-1, 1, 31)
        >>> v = np.stack(np.meshgrid(x, y), axis=-1)[..., ::-1] * (1, -1)  # (31, 41, 2): (y, -x)
        >>> flowtex.FlowField.from_arrays((x, y), v, name="a vortex").shape
        (31, 41)
        """
        plain = plain_grid(points, velocity, components)
        points = plain.points
        velocity = plain.velocity
        texts = length_unit or plain.length_unit, time_unit, velocity_unit or plain.velocity_unit
        t, scale, v, data, words = prepared(times, texts, velocity, scalars, units, axes=2)
        words |= {"name": name, "vectors": vectors, "projection": projection}
        words |= {"long_names": dict(long_names or {}), "on_cells": tuple(cell_scalars or ())}
        on_globe = projection is not None and projection.is_globe
        parts = points, v, t, valid, periodic, data, cell_scalars or {}
        surface, nodes = grid_nodes(*parts, sign_free=sign_free, on_globe=on_globe)
        flow = cls._moving(t, scale, sign_free=sign_free, **words, **nodes)
        flow.__dict__["surface"] = surface  # equal to what the property would make
        if "speed" in (scalars or {}):
            return flow
        return flow._with_speed_on_earth()

    @classmethod
    def from_triangles(
        cls,
        points: ArrayLike,
        triangles: ArrayLike,
        velocity: Any,
        *,
        times: ArrayLike | None = None,
        valid: ArrayLike | None = None,
        scalars: Mapping[str, Any] | None = None,
        cell_scalars: Mapping[str, Any] | None = None,
        name: str = "",
        length_unit: str = "",
        time_unit: str = "",
        velocity_unit: str = "",
        vectors: str = "",
        units: Mapping[str, str] | None = None,
        long_names: Mapping[str, str] | None = None,
        projection: Projection | None = None,
    ) -> FlowField:
        """Make a field on a surface of triangles from arrays.

        Parameters
        ----------
        points
            Node positions, (N, 2) or (N, 3), in any unit of length.
        triangles
            Indices of the nodes at the corners of each triangle, (M, 3). Triangles may face either
            way and share an edge with several others; the surface may have borders and several
            parts.
        velocity
            Velocity at the nodes, (N, 2 or 3), or (T, N, 2 or 3) for a time-varying field. NaN and
            masked entries blank a node. The component normal to the surface is not drawn
            (:attr:`normal_share`). The velocity may be lazy.
        times, name, length_unit, time_unit, velocity_unit, vectors, units, long_names, projection
            As for :meth:`from_arrays`.
        valid
            Nodes that have data, (N,). All by default.
        scalars
            Further nodal arrays, name to (N,) or (T, N), to colour by.
        cell_scalars
            Arrays of one value for each triangle, (M,) or (T, M), drawn flat.

        Returns
        -------
        FlowField
            Its nodes are those that triangles use; border nodes at the same position are merged,
            with the mean of their values. At sharp edges, of 35 degrees or more, each face has its
            own nodes, which have the values of nodes in that face.

        Raises
        ------
        FieldError
            When the arrays do not describe a field. The error lists all faults.

        Warns
        -----
        UserWarning
            When triangles without area or repeated triangles are left out, or the velocity is zero
            everywhere.

        Examples
        --------
        >>> import flowtex
        >>> points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        >>> velocity = [(1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0, 0)]
        >>> flowtex.FlowField.from_triangles(points, [(0, 1, 2), (0, 2, 3)], velocity).size_text
        '4 nodes, 2 triangles'
        """
        texts = length_unit, time_unit, velocity_unit
        t, scale, v, data, words = prepared(times, texts, velocity, scalars, units, axes=1)
        words |= {"name": name, "vectors": vectors, "projection": projection}
        words |= {"long_names": dict(long_names or {}), "on_cells": tuple(cell_scalars or ())}
        on_globe = projection is not None and projection.is_globe
        parts = points, triangles, v, t, valid, data, cell_scalars or {}
        reading = triangle_nodes(*parts, on_globe=on_globe)
        surface, nodes = finish(reading, READING_PARTS, "Reading")
        flow = cls._moving(t, scale, periodic=(False, False), **words, **nodes)
        flow.__dict__["surface"] = surface  # equal to what the property would make
        if "speed" in (scalars or {}):
            return flow
        return flow._with_speed_on_earth()

    @classmethod
    def _moving(cls, times: Floats | None, scale: float, **arrays: Any) -> FlowField:
        """Make a field with a scaled velocity; warn if it is at rest."""
        velocity = scaled_steps(arrays.pop("velocity"), scale)
        if times is None:
            times = np.arange(len(velocity), dtype=float)
        else:
            times = times.copy()
        if not moves(velocity):
            notify(ALL_AT_REST, UserWarning)
        return cls(velocity=velocity, times=times, **arrays)

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
        if not self._on_flat_map:
            return scaled_steps(self.index_velocity.speed, self.speed_scale)
        steps = map_steps(self.scalars["speed"], np.nan_to_num)
        if isinstance(self.velocity, LazySteps):
            return steps
        return np.asarray(steps)

    @property
    def normal_share(self) -> float:
        """Share of the flow that is normal to the surface, and so is not drawn, 0 to 1."""
        frame = self.surface.frame
        if isinstance(self.surface, TriangleSurface) and self.surface.is_large:
            return self.surface.normal_share(self.velocity[0])
        if frame is None or isinstance(self.velocity, LazySteps):
            return self.index_velocity.normal_share
        flow = np.asarray(self.velocity[:, self.valid])
        total = np.vdot(flow, flow)
        out = flow @ np.cross(*frame)
        if total > 0:
            return float(np.sqrt(min(np.vdot(out, out) / total, 1.0)))
        return 0.0

    @property
    def leaves_surface(self) -> bool:
        """Whether a notable part of the flow is normal to the surface; see :attr:`speed_label`."""
        return self.normal_share > NOTABLE_SHARE

    def same_flow(self, **changes: Any) -> FlowField:
        """Return the field with other scalars or texts; positions and velocity stay."""
        flow = replace(self, **changes)
        self._keep(flow, (*_SHARED, *_LARGE))
        return flow

    def _keep(self, other: FlowField, names: Sequence[str]) -> None:
        """Give another field the values that are computed already, of some properties."""
        for name, value in self.__dict__.items():
            if name in names:
                other.__dict__[name] = value

    def forget(self) -> None:
        """Free derived data, which are computed again when needed."""
        for name in (*_SHARED, "typical"):
            self.__dict__.pop(name, None)

    def at_step(self, step: int) -> FlowField:
        """Return one time step as a steady field; negative numbers count from the end."""
        return self.at_steps([self.step_number(step)])

    def at_steps(self, steps: Sequence[int]) -> FlowField:
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
        part.__dict__["surface"] = self.surface  # equal to what the property would make
        self._keep(part, _LARGE)
        return part

    @cached_property
    def typical(self) -> FlowField:
        """The field at typical steps, for ranges and lengths; at all if they are in memory."""
        late = isinstance(self.velocity, LazySteps)
        if late:
            return self.at_steps(typical_steps(len(self.times)))
        return self

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

    def downsample(self, factor: int) -> FlowField:
        """Keep every ``factor``-th node along both axes, and the last line of a closed axis.

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

    def at_lines(self, rows: Indices, columns: Indices) -> FlowField:
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


def _at_nodes(scalars: Mapping[str, Any], at: tuple[Any, ...]) -> dict[str, Any]:
    """Return the values of scalars at some nodes, which are an index of rows and columns."""
    return {name: steps[:, at[0], at[1]] for name, steps in scalars.items()}


def _at_steps(scalars: Mapping[str, Any], index: Any) -> dict[str, Any]:
    """Return the values of scalars at some time steps; those without time stay as they are."""
    chosen = {}
    for name, steps in scalars.items():
        if len(steps) > 1:
            chosen[name] = steps[index]
        else:
            chosen[name] = steps
    return chosen
