"""Trace slices: where the particle now at a node was, or will be, at other times.

The slice S(Td, Ts) of the paper (section 3.1) holds, for every node (i, j), the position (a, b)
from which a particle released at Ts reaches the node at Td. It is stored as the displacement
(a - i, b - j), which is continuous across a seam, for a handful of lags = Td - Ts. These double, as
the length of a streak does with every level of detail.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util import __version__
from flowtex._util.arguments import checked_count, checked_number
from flowtex._util.array_types import AnyArray, Floats, Indices
from flowtex._util.cache import digest
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.interpolation import bracket
from flowtex.trace.slice_files import read_group, write_group

#: Arrays over the nodes, and the axis along which j runs in them.
NODE_AXES = {
    "unit": 0,
    "nodes": 0,
    "rate": 1,
    "reach": 1,
    "forward_reach": 1,
    "displacement": 2,
    "forward": 2,
}
FIRST_CELLS = 0.25  #: First lag in cells.
LAST_EXTENTS = 0.25  #: Last lag, as a share of the surface's extent.
MOST_CHOSEN_LAGS = 24  #: Most lags.
LAST_PARTS = 8  #: Parts of an octave to which a chosen last lag is rounded.
SMALL_CELLS = 5  #: Percentile of the sizes of cells that counts as small.
LEAST_CELL = 0.25  #: Least size of cells in multiples of a common unit.
MOST_CELL = 16.0  #: Greatest size of cells in multiples of a common unit.
RATIO = 2.0  #: Quotient of one lag and the one before.
#: Least number of lags that are drawn; the uncertainty of a flow lies in the layer of one more.
LEAST_LAGS = 2


@dataclass(frozen=True)
class SliceOrigin:
    """The flow from which slices were traced.

    Attributes
    ----------
    surface
        Hash of the positions of the nodes and of how they are connected.
    velocities
        Hash of the velocity at each destination time, (T,).
    length_unit, time_unit
        Units of the field.
    tolerance
        Error that one step of the integration was allowed, in cells.
    """

    surface: str
    velocities: tuple[str, ...]
    length_unit: str
    time_unit: str
    tolerance: float

    @classmethod
    def of(cls, field: FlowField, steps: list[int], tolerance: float) -> SliceOrigin:
        """Return the origin of slices of some time steps."""
        velocities = tuple(digest(np.asarray(field.velocity[step])).hex() for step in steps)
        return cls(
            surface_hash(field), velocities, field.length_unit, field.time_unit, float(tolerance)
        )


def surface_hash(field: FlowField) -> str:
    """Return a hash of the nodes of a field and of how they are connected."""
    arrays = [field.points, field.valid]
    if field.has_position is not None:
        arrays.append(field.has_position)
    if field.triangles is not None:
        arrays.append(field.triangles)
    return digest(*arrays, words=field.periodic).hex()


@dataclass(frozen=True, eq=False, repr=False)
class TraceSlices:
    """Displacements in index space along the paths through the nodes.

    On a surface of triangles, whose nodes are one row, displacements and ``nodes`` are vectors in
    space, (..., 1, N, 3): a displacement is the chord from the node to the particle. Rates have
    components along two orthonormal tangents of the surface.

    Attributes
    ----------
    lags
        Lags of the slices, (M,), positive and increasing, in multiples of ``unit``.
    unit
        One unit of lag at each node, (J, I): a length for paths by arc length, otherwise a time.
    displacement
        Backward slices, (T, M, J, I, 2), components (a - i, b - j) in cells, one set for each
        destination time. Beyond a path's reach they continue straight, or stay constant if the path
        has the requested length.
    forward
        Forward slices, the same shape, or ``None``.
    rate, forward_rate
        Derivative of the displacement with respect to lag at lag zero, (T, J, I, 2), in cells per
        ``unit``.
    reach, forward_reach
        Lag, in multiples of ``unit``, at which a path leaves the domain, meets a blanked cell or
        stops, (T, J, I); infinite where it continues beyond the last slice.
    nodes
        Position of each entry in index space, (J, I, 2) as (i, j).
    times
        Destination times, (T,), in the field's unit.
    parameter
        What a lag measures: ``"arclength"`` or ``"time"``.
    origin
        The flow from which the slices were traced; ``None`` for a part of its nodes.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(21, 41))
    >>> slices = flowtex.trace(field, lags=[1.0, 2.0, 4.0])
    >>> slices.positions(1.5).shape
    (21, 41, 2)
    >>> slices.save("gyre_slices.zarr")
    >>> stored = flowtex.TraceSlices.open("gyre_slices.zarr")
    >>> flowtex.render(field, slices=stored, size=(320, 240)).shape
    (240, 320, 3)
    """

    lags: Floats
    unit: Floats
    displacement: AnyArray
    forward: AnyArray | None
    rate: AnyArray
    reach: AnyArray
    forward_reach: AnyArray | None
    nodes: Floats
    times: Floats
    parameter: str
    origin: SliceOrigin | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """Shape of the slices, (J, I)."""
        return self.unit.shape[0], self.unit.shape[1]

    @property
    def in_space(self) -> bool:
        """Whether displacements are vectors in space, as on a surface of triangles."""
        return bool(self.displacement.shape[-1] == 3)

    @property
    def nbytes(self) -> int:
        """Size of the arrays in bytes."""
        nbytes = 0
        for name in self.__dataclass_fields__:
            value = getattr(self, name)
            if isinstance(value, np.ndarray):
                nbytes += value.nbytes
        return nbytes

    def at_step(self, step: int) -> TraceSlices:
        """Return the slices of one destination time, with T = 1."""
        span = slice(step, step + 1 or None)

        def at_span(data: AnyArray, axis: int) -> AnyArray:
            if axis:  # the first axis is time
                return data[span]
            return data

        origin = self.origin
        if origin is not None:
            origin = replace(origin, velocities=origin.velocities[span])
        return replace(self.mapped(at_span), times=self.times[span], origin=origin)

    def part(self, rows: slice, columns: slice | Indices) -> TraceSlices:
        """Return some rows and columns of the slices."""
        part = self.mapped(lambda data, axis: data[(slice(None),) * axis + (rows, columns)])
        return replace(part, origin=None)

    def mapped(self, function: Callable[[AnyArray, int], AnyArray]) -> TraceSlices:
        """Apply a function to each array over the nodes, and to its axis of j."""
        arrays: dict[str, Any] = {}
        for name, axis in NODE_AXES.items():
            data = getattr(self, name)
            if data is not None:
                arrays[name] = function(data, axis)
        return replace(self, **arrays)

    def positions(self, lag: float, *, step: int = 0, forward: bool = False) -> Floats:
        """Return the positions of the particles at a lag.

        Between two slices the mean velocity since lag zero is interpolated linearly, as in the
        shader; on triangles it is constant up to the first slice. A path that has ended stays at
        its end.

        Parameters
        ----------
        lag
            Lag in multiples of ``unit``, from 0 to the last of ``lags``.
        step
            Index of the destination time.
        forward
            Whether to follow the paths forward.

        Returns
        -------
        numpy.ndarray
            Positions in index space, (J, I, 2) as (a, b), or in space, (1, N, 3), on triangles.

        Raises
        ------
        FieldError
            When the lag lies beyond the last slice, or forward slices were not traced.
        """
        last = self.lags[-1]
        expected = f"0 to {last:g}, the lag of the last slice"
        lag = checked_number("lag", lag, 0.0, last, expected=expected)
        count = len(self.times)
        expected = f"a number of a time step, from {-count} to {count - 1}"
        step = checked_count("step", step, -count, count - 1, expected=expected)
        sign = -1.0
        data = self.displacement
        reach = self.reach
        if forward:
            if self.forward is None or self.forward_reach is None:
                raise FieldError("the slices have no forward side: trace with two_sided=True")
            sign = 1.0
            data = self.forward
            reach = self.forward_reach
        held = np.minimum(lag, reach[step].astype(float))
        knots = np.concatenate([[0.0], self.lags])
        m, late = bracket(knots, held)
        late = late[..., None]
        mean = data[step] / self.lags[:, None, None, None]
        # Rates on triangles are along tangents, which are not known here.
        if self.in_space:
            begin = mean[:1]
        else:
            begin = sign * self.rate[step][None]
        mean = np.concatenate([begin, mean])
        rows, columns = np.indices(self.shape)
        before = mean[m, rows, columns]
        after = mean[m + 1, rows, columns]
        return np.asarray(self.nodes + held[..., None] * (before * (1 - late) + after * late))

    def save(self, path: str | Path) -> None:
        """Write the slices to a Zarr group, a folder that replaces older slices of its name.

        Its attributes have the lags, the times and the units, and hashes of the surface and of the
        velocity. Arrays keep every bit.

        Parameters
        ----------
        path
            The folder, such as ``"gyre_slices.zarr"``.

        Raises
        ------
        FieldError
            When something else than slices has the name.
        OSError
            When the folder cannot be written.
        ModuleNotFoundError
            When Zarr is not installed; the error names the extra.

        Examples
        --------
        >>> import flowtex
        >>> field = flowtex.examples.double_gyre_field(shape=(21, 41))
        >>> flowtex.trace(field, lags=[1.0, 2.0, 4.0]).save("gyre_slices.zarr")
        """
        arrays = {}
        for name in NODE_AXES:
            if getattr(self, name) is not None:
                arrays[name] = getattr(self, name)
        origin: dict[str, Any] = {}
        if self.origin is not None:
            origin = asdict(self.origin)
            origin["velocities"] = list(self.origin.velocities)
        about = {
            "version": __version__,
            "parameter": self.parameter,
            "shape": list(self.shape),
            "components": int(self.displacement.shape[-1]),
            "times": self.times.tolist(),
            "lags": self.lags.tolist(),
            **origin,
        }
        write_group(path, arrays, about)

    @classmethod
    def open(cls, path: str | Path) -> TraceSlices:
        """Read slices that :meth:`save` wrote.

        Nothing in the folder is executed, and what it declares is checked.

        Parameters
        ----------
        path
            The folder.

        Raises
        ------
        FieldError
            When the folder contains no slices, another version wrote them, or they are damaged.
        FileNotFoundError
            When there is no such folder.
        ModuleNotFoundError
            When Zarr is not installed; the error names the extra.

        Examples
        --------
        >>> import flowtex
        >>> field = flowtex.examples.double_gyre_field(shape=(21, 41))
        >>> flowtex.trace(field, lags=[1.0, 2.0, 4.0]).save("gyre_slices.zarr")
        >>> flowtex.TraceSlices.open("gyre_slices.zarr").lags
        array([1., 2., 4.])
        """
        arrays, about = read_group(path)
        origin = None
        if about.get("surface") is not None and about.get("velocities") is not None:
            origin = SliceOrigin(
                surface=about["surface"],
                velocities=tuple(about["velocities"]),
                length_unit=about.get("length_unit") or "",
                time_unit=about.get("time_unit") or "",
                tolerance=float(about.get("tolerance") or np.nan),
            )
        sides: dict[str, Any] = {"forward": None, "forward_reach": None, **arrays}
        return cls(
            lags=np.array(about["lags"], dtype=float),
            times=np.array(about["times"], dtype=float),
            parameter=about["parameter"],
            origin=origin,
            **sides,
        )

    def check_origin(self, field: FlowField) -> None:
        """Raise a FieldError when the slices were traced from another flow than this one."""
        if self.shape != field.shape:
            raise FieldError(
                f"the slices have {self.shape} nodes and the field {field.shape}; trace it"
            )
        if not np.array_equal(self.times, field.times):
            raise FieldError(
                f"the slices have {len(self.times)} destination times, from {self.times[0]:g} to "
                f"{self.times[-1]:g}; expected the {len(field.times)} times of the field, from "
                f"{field.times[0]:g} to {field.times[-1]:g}: trace it"
            )
        if self.origin is None:
            return
        if self.origin.surface != surface_hash(field):
            raise FieldError("the slices were traced on another surface; trace the field")
        for step, velocity in enumerate(self.origin.velocities):
            if digest(np.asarray(field.velocity[step])).hex() != velocity:
                raise FieldError(
                    f"the slices were traced from another velocity at time step {step}; trace the "
                    "field"
                )

    def __repr__(self) -> str:
        rows, columns = self.shape
        if self.forward is None:
            sides = "backward"
        else:
            sides = "backward and forward"
        return (
            f"TraceSlices({columns} x {rows} nodes (I x J), {len(self.times)} destination times, "
            f"{len(self.lags)} lags by {self.parameter}, {sides}, {self.nbytes / 1e6:.1f} MB)"
        )


def lag_unit(field: FlowField, parameter: str) -> Floats:
    """Return one unit of lag at each node, (J, I): the cell size by arc length, or a unit of time.

    On triangles it is the size of small cells everywhere, so that paths can be composed.
    """
    if parameter == "arclength":
        size = field.surface.cell_size
        if field.triangles is None:
            return size
        return np.full(field.shape, np.percentile(size[field.valid], SMALL_CELLS))
    return np.ones(field.shape)


def longest_path(field: FlowField) -> float:
    """Return the default length of the paths; a globe is as wide as a side of its bounding box."""
    poles = field.surface.poles
    length = LAST_EXTENTS * float(field.surface.extent)
    if poles is not None and poles.both:
        return length / math.sqrt(3)
    return length


def choose_lags(
    field: FlowField, parameter: str, longest: float | None = None, first_cells: float = FIRST_CELLS
) -> Floats:
    """Return lags from a quarter of a cell to a quarter of the surface, (M,), in lag units.

    ``first_cells`` sets the first one in cells, ``longest`` the last in the mesh's units.
    """
    if longest is None:
        longest = longest_path(field)
    least = LEAST_LAGS + bool(field.uncertainty)
    if parameter == "arclength":
        first = first_cells
        last = longest / small_cell(field)
    else:
        speed = field.typical.index_velocity.speed[:, field.valid]
        if speed.any():
            moving = speed > 1e-6 * speed.max()
        else:
            moving = np.zeros_like(speed, dtype=bool)
        if not moving.any():
            return RATIO ** np.arange(float(least))
        size = field.surface.cell_size[field.valid]
        crossing = np.broadcast_to(size, speed.shape)[moving] / speed[moving]
        first = first_cells * float(np.percentile(crossing, 10))
        on_earth = field.projection is not None
        if on_earth:
            typical = typical_speed(field)
        else:
            typical = np.sqrt(np.mean(speed[moving] ** 2))
        last = longest / float(typical)
        if not field.steady:
            # Long paths can be composed of lags that reach other time steps.
            step = float(np.mean(np.diff(field.times)))
            first = step * RATIO ** np.rint(np.log(first / step) / np.log(RATIO))
    count = max(int(np.ceil(np.log(max(last / first, RATIO)) / np.log(RATIO))) + 1, least)
    return np.asarray(first * RATIO ** np.arange(min(count, MOST_CHOSEN_LAGS)))


def typical_speed(field: FlowField) -> float:
    """Return the root mean square of the speed, on maps that on the Earth; 1 in a flow at rest."""
    typical = field.typical
    on_earth = field.projection is not None and "speed" in field.scalars
    if on_earth:
        steps = typical.scalars["speed"]
    else:
        steps = typical.speed
    speed = np.asarray(steps)[:, field.valid] / field.speed_scale
    finite = speed[np.isfinite(speed)]
    return float(np.sqrt(np.square(finite).sum() / max(finite.size, 1))) or 1.0


def small_cell(field: FlowField) -> float:
    """Return the size of the small cells of a field."""
    return float(np.percentile(field.surface.cell_size[field.valid], SMALL_CELLS))


def drawn_lags(
    field: FlowField,
    parameter: str,
    longest: float | None = None,
    cell: float | None = None,
    first_cells: float = FIRST_CELLS,
) -> tuple[Floats, Floats]:
    """Return lags to draw with, (M,), and their unit at each node, (J, I).

    Cells of about the same size have one unit, so that a path takes the same slice everywhere, and
    is composed at a single look-up. In a part of a surface it is that surface's ``cell`` times a
    power of two: all parts have the same lags. The last is ``longest``, if set.
    """
    unit = lag_unit(field, parameter)
    if parameter == "time":
        lags = choose_lags(field, parameter, longest, first_cells)
        # Half precision holds lags near one, in any unit of time.
        first = 2.0 ** np.rint(np.log2(lags[0]))
        return lags / first, unit * first
    sizes = unit[field.valid]
    even = small_cell(field)
    if cell is not None:
        even = cell * 2.0 ** np.rint(np.log2(even / cell))
    alike = LEAST_CELL * even <= sizes.min() and sizes.max() <= MOST_CELL * even
    if not alike or field.triangles is not None:
        return choose_lags(field, parameter, longest, first_cells), unit
    unit = np.full(field.shape, even)
    if longest is None:
        return choose_lags(field, parameter, first_cells=first_cells), unit
    # The last is a sum of few lags that double, as paths are composed of whole slices.
    part = 2.0 ** np.floor(np.log2(longest / even)) / LAST_PARTS
    last = np.ceil(longest / even / part) * part
    doubled = first_cells * RATIO ** np.arange(MOST_CHOSEN_LAGS - 1)
    # A last lag that is hardly longer than the one before replaces it.
    lags = np.append(doubled[doubled < last / np.sqrt(RATIO)], last)
    lacking = LEAST_LAGS + bool(field.uncertainty) - len(lags)
    return np.append(lags, last * RATIO ** np.arange(1.0, lacking + 1)), unit
