"""The flow on a structured surface: nodes, velocity, times, and which nodes carry data.

Data are checked when a :class:`FlowField` is made, with all faults in one error; the rest of the
package relies on it.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.earth import Projection
from flowtex.errors import FieldError, raise_faults
from flowtex.field.dates import as_seconds
from flowtex.field.interpolation import every_line
from flowtex.field.metric import IndexVelocity, to_index_space
from flowtex.field.periodic import NodalArrays, close_axes
from flowtex.field.signs import oriented, sign_free_faults, with_equal_ends
from flowtex.field.steps import LazySteps, Steps
from flowtex.field.surface import Surface, known_positions
from flowtex.field.units import speed_unit
from flowtex.field.validation import (
    as_numbers,
    finite_nodes,
    node_faults,
    node_positions,
    range_faults,
    scalar_steps,
    shape_faults,
    three_components,
    with_gaps,
)

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["FlowField"]

#: Share of the flow normal to the surface from which on the speed in it has a name of its own. The
#: cells of a curved mesh alone give a per cent or two; at five the speeds differ by a thousandth.
NOTABLE_SHARE = 0.05


@dataclass(frozen=True, eq=False, repr=False)
class FlowField:
    """Velocity on a structured surface, steady or time-varying.

    Make one with :meth:`from_arrays`, :meth:`from_pyvista` or :meth:`from_file`. Where an axis
    is periodic, the last line of nodes is the first one again; a mesh that stops one cell short
    of that gets the line appended, in every array.

    Attributes
    ----------
    points
        Node positions, (J, I, 3), in the mesh's own units.
    velocity
        Velocity, (T, J, I, 3) with T = 1 when steady, in the mesh's units per unit of time;
        zero at nodes that are not valid. Long series of data sets are read step by step.
    times
        Time of each step, (T,), strictly increasing.
    valid
        Nodes that carry data, (J, I): neither blanked nor masked nor NaN.
    periodic
        Whether the (j, i) axis closes on itself.
    scalars
        Other nodal arrays, name to (T or 1, J, I).
    name, length_unit, time_unit
        Words for captions; empty when unknown.
    has_position
        Nodes whose own position is known, (J, I); the others, blanked ones, have the position
        of the nearest node. ``None`` stands for all.
    sign_free
        Whether v and -v mean the same, as in a field of polarisation or principal directions.
    units
        Unit of each scalar, where it is known.
    long_names
        Words for scalars, where there are other ones than their names.
    start
        The date at time 0, a ``datetime`` or one of cftime's, where times count from one.
    projection
        How positions follow from longitude and latitude, for a field of the Earth.
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

    @classmethod
    def from_arrays(
        cls,
        points: ArrayLike,
        velocity: ArrayLike,
        *,
        times: ArrayLike | None = None,
        valid: ArrayLike | None = None,
        periodic: str | None = None,
        scalars: Mapping[str, ArrayLike] | None = None,
        name: str = "",
        length_unit: str = "",
        time_unit: str = "",
        sign_free: bool = False,
        units: Mapping[str, str] | None = None,
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
            Velocity at the nodes, (J, I, 2 or 3), or (T, J, I, 2 or 3) for a field that varies
            in time, in units of length per unit of time. NaN and masked entries blank a node.
        times
            Time of each step, (T,), strictly increasing, in any unit of time. Steps are
            numbered 0, 1, 2, ... when it is left out. Dates (``datetime64``, or cftime's) become
            seconds since the first, and the unit of time ``"s"``; they are told as dates.
        valid
            Nodes that carry data, (J, I). All of them by default.
        periodic
            Axes that close on themselves: ``""``, ``"i"``, ``"j"`` or ``"ij"``. By default it
            is detected: coinciding first and last lines of nodes, a ring that stops one cell
            short, and global longitude on a flat map.
        scalars
            Further nodal arrays, name to (J, I) or (T, J, I), to colour by. What is beyond 1e100
            becomes NaN, as nothing is known there.
        name, length_unit, time_unit
            Words for captions.
        sign_free
            Whether v and -v mean the same. Such a field is steady; it is drawn to both sides,
            with no kernel and no motion that tells forward from backward. Vectors are turned
            over where that makes neighbours agree.
        units
            Unit of each scalar by its name, for legends; that of the speed follows from those of
            length and time.
        projection
            How points followed from longitude and latitude, for a field of the Earth: what tells
            the place of a point, and draws coastlines.

        Returns
        -------
        FlowField

        Raises
        ------
        FieldError
            When the arrays do not make a field. The error lists all faults.

        Warns
        -----
        UserWarning
            When the velocity is zero everywhere: the picture is then plain noise.

        Notes
        -----
        The arrays are copied to float64 and never changed.
        """
        p, masked_points = as_numbers("points", node_positions(points))
        v, masked_velocity = as_numbers("velocity", velocity)
        if scalars is not None and not isinstance(scalars, Mapping):
            msg = f"scalars is a {type(scalars).__name__}; expected a mapping of arrays by name"
            raise FieldError(msg)
        given = {key: with_gaps(f"scalars[{key!r}]", s) for key, s in (scalars or {}).items()}
        times, time_unit, start = as_seconds(times, time_unit)
        t, shown = (
            None if values is None else with_gaps(name, values)
            for name, values in (("times", times), ("valid", valid))
        )
        faults = shape_faults(p, v, t, shown, periodic, given)
        raise_faults(faults + (sign_free_faults(v) if sign_free else []))
        v = v[None] if v.ndim == 3 else v
        # What was given is not changed, and copied once.
        p, v = (three_components(a) if a.shape[-1] == 2 else a.copy("C") for a in (p, v))
        t = np.arange(len(v), dtype=float) if t is None else t.copy()
        ok = finite_nodes(p) & ~masked_points
        ok &= finite_nodes(v) & ~masked_velocity
        if shown is not None:
            ok &= np.nan_to_num(shown) != 0
        # What stands for missing data must not be computed with.
        v[:, ~ok] = np.nan
        raise_faults(range_faults(p, v, ok) or node_faults(p, ok))
        p[~known_positions(p, ok)] = np.nan
        v = with_equal_ends(v) if sign_free else v
        data = {key: scalar_steps(values, p.shape[:2]) for key, values in given.items()}
        nodal, closed = close_axes(NodalArrays(p, v, ok, data), periodic)
        v, ok = nodal.velocity, nodal.valid
        on_globe = projection is not None and projection.is_globe
        surface = Surface(nodal.points, ok, closed, on_globe=on_globe)
        if sign_free:
            v = oriented(np.where(ok[..., None], v[0], 0.0), ok, closed)
            v = with_equal_ends(v[None], closed, surface.poles)
        v[:, ~ok] = 0.0
        flow = cls(
            points=surface.points,
            velocity=v,
            times=t,
            valid=ok,
            periodic=closed,
            scalars=nodal.scalars,
            name=name,
            length_unit=length_unit,
            time_unit=time_unit,
            has_position=surface.has_position,
            sign_free=sign_free,
            units=dict(units or {}),
            start=start,
            projection=projection,
        )
        flow.__dict__["surface"] = surface  # the same that the property would make again
        if not flow.velocity.any():
            warnings.warn(
                "The velocity is zero at every node, so the picture is plain noise; check the "
                "array that was chosen and the region it covers.",
                stacklevel=2,
            )
        return flow

    @classmethod
    def from_pyvista(
        cls,
        mesh: Any,
        *,
        vectors: str | None = None,
        plane: str | None = None,
        times: ArrayLike | None = None,
        periodic: str | None = None,
        name: str = "",
        sign_free: bool = False,
        block: int | str | None = None,
    ) -> FlowField:
        """Make a field from a structured PyVista mesh, or from a series of them.

        Parameters
        ----------
        mesh
            A StructuredGrid, RectilinearGrid or ImageData. A MultiBlock with one structured block
            stands for that block. A list or tuple of meshes, a MultiBlock of several grids with
            the same nodes, and a PyVista reader with time values are time steps.
        vectors
            Name of the velocity on points or cells, with 2 or 3 components. By default the only
            array that can be the velocity, or the one that the mesh marks as its active vectors.
            Two or three arrays of one component are named with commas between, as in
            ``"u,v,w"``, and found where there is no array of vectors, if their names differ in the
            component alone, such as ``X Velocity``, ``Y Velocity`` and ``Z Velocity``.
        plane
            Surface to draw from a mesh of three dimensions: ``"k=20"``, ``"j=0"`` or ``"i=-1"``,
            counted from the end when negative. On a k-plane the surface's (i, j) are the mesh's
            (i, j), on a j-plane (i, k), on an i-plane (j, k). A mesh with one flat index
            direction needs none, and follows the same table.
        times
            Time of each step, (T,). By default the reader's time values, or ``TimeValue`` in the
            field data of every step, or 0, 1, 2, ...
        periodic, name, sign_free
            As for :meth:`from_arrays`.
        block
            Number or path of the block to draw of a MultiBlock, such as ``"Base/Zone 1"``. Numbers
            count the structured grids from 0.

        Returns
        -------
        FlowField
            Positions in the mesh's units. Arrays with one component become ``scalars``; those on
            cells, and vectors on cells, become means of the visible cells around each node.

        Raises
        ------
        FieldError
            When the mesh is not structured, when the plane or the vectors have to be chosen or do
            not exist, when the steps of a series differ in their nodes, and for what
            :meth:`from_arrays` refuses.

        Notes
        -----
        Hidden are points and cells that VTK's ghost arrays hide, points with ``IBlank`` 0
        (PLOT3D), and points that a sampling filter marked in ``vtkValidPointMask``. The mesh is
        not changed.
        """
        from flowtex.field.io.from_pyvista import read_meshes

        options: dict[str, Any] = {"periodic": periodic, "sign_free": sign_free}
        arguments = read_meshes(
            mesh, vectors=vectors, plane=plane, times=times, block=block, **options
        )
        return cls.from_arrays(**arguments, name=name, **options)

    @classmethod
    def from_file(
        cls,
        path: str | Path | Sequence[str | Path],
        *,
        vectors: str | None = None,
        plane: str | None = None,
        periodic: str | None = None,
        time: float | str | None = None,
        block: int | str | None = None,
        sign_free: bool = False,
        projection: str | None = None,
        globe: bool = False,
        level: float | str | None = None,
        sel: Mapping[str, Any] | None = None,
        isel: Mapping[str, Any] | None = None,
    ) -> FlowField:
        """Make a field from a file, or from several that belong together.

        Parameters
        ----------
        path
            A structured mesh in any format that PyVista reads, or a PLOT3D grid or solution. The
            other one of the two is found beside it by its name: ``postxyz.bin`` and
            ``postq.bin``, ``wing.xyz`` (or ``.x``, ``.g``) and ``wing.q``. Or data of the Earth:
            NetCDF, a Zarr store, GRIB, or the JSON of wind maps; of these several at once, as the
            parts of a model's output or the steps of a series.
        vectors
            Name of the velocity, as for :meth:`from_pyvista`. A PLOT3D solution gives
            ``Velocity``, made from its density and momentum.
        plane, periodic, sign_free
            As for :meth:`from_pyvista`.
        time
            Draw this one of the times in the file, as a steady field. All of them by default.
        block
            Number or path of the block to draw, such as ``"Base/Zone 1"``, where the file has
            several grids. Numbers count the structured grids from 0.
        projection, globe, level, sel, isel
            As for :meth:`from_xarray`, for data of the Earth.

        Returns
        -------
        FlowField
            Its ``name`` is the file's, without folder and suffix.

        Raises
        ------
        FieldError
            When the file is missing, empty, not readable, of an unknown or broken format, or does
            not hold a structured flow; the text starts with the path.
        """
        from flowtex.field.io.file_fields import field_of_file

        of_meshes = {"plane": plane, "block": block, "periodic": periodic, "sign_free": sign_free}
        of_earth: dict[str, Any] = {"projection": projection, "globe": globe, "level": level}
        of_earth |= {"sel": sel, "isel": isel}
        field: FlowField = field_of_file(cls, path, vectors, time, of_meshes, of_earth)
        return field

    @classmethod
    def from_xarray(
        cls,
        data: xr.Dataset | Sequence[xr.Dataset],
        u: str | None = None,
        v: str | None = None,
        *,
        projection: str | None = None,
        globe: bool = False,
        name: str = "",
        sel: Mapping[str, Any] | None = None,
        isel: Mapping[str, Any] | None = None,
        **selection: Any,
    ) -> FlowField:
        """Make a field from a dataset of xarray's, as ocean and weather models write them.

        Parameters
        ----------
        data
            A Dataset, or several that belong together, such as NEMO's files of U, of V and of
            coordinates. Nothing but coordinates and one step is read at once; further steps are
            read when they are drawn.
        u, v
            Names of the components. By default the only pair that is likely to be the velocity,
            by CF's standard names, long names and names.
        projection
            A flat map, or ``"globe"``; see :class:`flowtex.earth.Projection`. By default plate
            carree around the middle of the data, and a polar one near a pole.
        globe
            Whether it is put on a sphere: the same as ``projection="globe"``.
        name
            A word for captions.
        sel, isel
            What to draw along axes, by value and by number, such as ``sel={"level": 500}``.
        **selection
            The same as ``sel``, such as ``level=500`` or ``time="2000-01-02"``. ``time`` and
            ``level`` stand for those axes whatever their names. All times by default, the level
            nearest to the surface, and the first along any other axis.

        Returns
        -------
        FlowField
            On longitude and latitude its positions are metres on the map, and its velocity in m/s
            is mapped along; else they are those of the x and y coordinates. Components on the
            sides of cells (Arakawa C) become means in the middle. Other variables at the same
            nodes are ``scalars``; on a flat map ``"speed"`` is that on the Earth.

        Raises
        ------
        FieldError
            When the components, the coordinates or what is chosen cannot be told.
        ModuleNotFoundError
            When xarray, cf_xarray or pyproj is missing.

        Warns
        -----
        DatasetNotice
            When something was chosen without being asked for, such as a level.
        """
        from flowtex.field.datasets.read import field_of

        if globe and projection not in (None, "globe"):
            msg = f"globe=True and projection={projection!r} are given; leave out one of them"
            raise FieldError(msg)
        options: dict[str, Any] = {"sel": {**(sel or {}), **selection}, "isel": isel}
        return field_of(
            cls.from_arrays,
            data,
            u,
            v,
            projection="globe" if globe else projection,
            name=name,
            **options,
        )

    @property
    def shape(self) -> tuple[int, int]:
        """Number of nodes (J, I)."""
        return self.valid.shape[0], self.valid.shape[1]

    @property
    def nbytes(self) -> int:
        """Size of the arrays in memory."""
        arrays = (self.points, self.velocity, self.valid, *self.scalars.values())
        return sum(array.nbytes for array in arrays)

    @property
    def steady(self) -> bool:
        """Whether there is one time step only."""
        return len(self.times) == 1

    @cached_property
    def surface(self) -> Surface:
        """The geometry: tangents, cell sizes and positions between nodes."""
        points, known = self.points, self.has_position
        if known is not None and not known.all():
            # Positions that were filled in must not pass for known ones: tangents would bend.
            points = np.where(known[..., None], points, np.nan)
        on_globe = self.projection is not None and self.projection.is_globe
        return Surface(points, self.valid, self.periodic, on_globe=on_globe)

    @cached_property
    def index_velocity(self) -> IndexVelocity:
        """The velocity in index space, in cells per unit of time, with its speed."""
        if not isinstance(self.velocity, LazySteps):
            return to_index_space(self.surface, self.velocity)

        def both(velocity: Floats) -> Floats:
            step = to_index_space(self.surface, velocity[None])
            return np.concatenate([step.components[0], step.speed[0, ..., None]], axis=-1)

        steps = self.velocity.map(both)
        share = to_index_space(self.surface, self.velocity[0][None]).normal_share
        return IndexVelocity(
            steps.map(lambda step: step[..., :2]), steps.map(lambda step: step[..., 2]), share
        )

    @property
    def speed(self) -> Steps:
        """Speed along the surface, (T, J, I)."""
        return self.index_velocity.speed

    @property
    def normal_share(self) -> float:
        """Share of the flow that is normal to the surface and cannot be drawn on it, 0 to 1."""
        return self.index_velocity.normal_share

    @property
    def leaves_surface(self) -> bool:
        """Whether so much of the flow is normal to the surface that the speed is told apart."""
        return self.normal_share > NOTABLE_SHARE

    @property
    def speed_label(self) -> str:
        """Words for :attr:`speed`; the array of a file may have the short one."""
        apart = self.leaves_surface or "speed" in self.scalars
        return "speed in the surface" if apart else "speed"

    def label_of(self, name: str) -> str:
        """Return the words for a scalar, or for the speed, in a legend."""
        if name == "speed" and name not in self.scalars:
            return self.speed_label
        return self.long_names.get(name, name)

    def unit_of(self, name: str) -> str:
        """Return the unit of a scalar, or of the speed; empty when it is not known."""
        if name in self.units or name != "speed" or name in self.scalars:
            return self.units.get(name, "")
        return speed_unit(self.length_unit, self.time_unit)

    def forget(self) -> None:
        """Drop what was derived from the arrays and can be computed again."""
        for name in ("surface", "index_velocity", "typical"):
            self.__dict__.pop(name, None)

    def at_step(self, step: int) -> FlowField:
        """Return one time step, as for :meth:`step_number`, as a steady field."""
        step = self.step_number(step)
        return self.at_steps([step])

    def at_steps(self, steps: Sequence[int]) -> FlowField:
        """Return some of the time steps, by increasing numbers from 0, in memory."""
        first, last = steps[0], steps[-1] + 1
        some: Any = list(steps) if len(steps) < last - first else slice(first, last)
        data = {k: s[some] if len(s) > 1 else s for k, s in self.scalars.items()}
        part = replace(
            self, velocity=np.asarray(self.velocity[some]), times=self.times[some], scalars=data
        )
        part.__dict__["surface"] = self.surface  # the same that the property would make again
        return part

    @cached_property
    def typical(self) -> FlowField:
        """The steps from which ranges and lengths are taken: some of those that are read late."""
        if not isinstance(self.velocity, LazySteps):
            return self
        last = len(self.times) - 1
        return self.at_steps(sorted({0, last // 2, last}))

    def step_number(self, step: int) -> int:
        """Return the number of a time step from 0, where negative ones count from the end.

        Raises
        ------
        IndexError
            When there is no such step.
        """
        count = len(self.times)
        if not -count <= step < count:
            msg = f"time step {step} does not exist: expected 0 to {count - 1}"
            raise IndexError(msg)
        return int(step) % count

    def downsample(self, factor: int) -> FlowField:
        """Keep every ``factor``-th node along both axes, and the last line of a closed axis.

        Raises
        ------
        ValueError
            When fewer than two lines would be left.
        """
        rows, columns = (
            every_line(count, factor, closed=closed)
            for count, closed in zip(self.shape, self.periodic, strict=True)
        )
        return self.at_lines(rows, columns)

    def at_lines(self, rows: Indices, columns: Indices) -> FlowField:
        """Return the field on some of its lines of nodes, whose numbers along j and i increase.

        An axis that closes on itself keeps its first and its last line.
        """
        at = np.ix_(rows, columns)
        return replace(
            self,
            points=self.points[at],
            velocity=self.velocity[:, at[0], at[1]],
            valid=self.valid[at],
            has_position=None if self.has_position is None else self.has_position[at],
            scalars={k: s[:, at[0], at[1]] for k, s in self.scalars.items()},
        )

    def __repr__(self) -> str:
        rows, columns = self.shape
        steps = "steady" if self.steady else f"{len(self.times)} steps"
        closed = "".join(a for a, p in zip("ji", self.periodic, strict=True) if p)[::-1]
        return (
            f"FlowField({self.name or 'unnamed'}: {columns} x {rows} nodes (I x J), {steps}"
            f"{f', periodic {closed}' if closed else ''}{', sign-free' if self.sign_free else ''}, "
            f"{int((~self.valid).sum())} blanked)"
        )
