"""The flow on a structured surface, as the rest of flowtex sees it.

:class:`FlowField` is the one form in which data arrives: nodes, velocity, times, and which nodes
count. Everything that can be wrong with data is found here, told in one error, and nothing
behind this module checks again.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flowtex.errors import raise_faults
from flowtex.field import checks
from flowtex.field.metric import IndexVelocity, to_index_space
from flowtex.field.periodic import Closure, find_closure, requested_closure
from flowtex.field.signs import oriented, with_equal_ends
from flowtex.field.surface import Surface

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["FlowField"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


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
        zero at nodes that are not valid.
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
    placed
        Nodes whose own position is known, (J, I); the others, blanked ones, have the position
        of the nearest node. ``None`` stands for all.
    sign_free
        Whether v and -v mean the same, as in a field of polarisation or principal directions.
    """

    points: Floats
    velocity: Floats
    times: Floats
    valid: Bools
    periodic: tuple[bool, bool]
    scalars: Mapping[str, Floats] = field(default_factory=dict)
    name: str = ""
    length_unit: str = ""
    time_unit: str = ""
    placed: Bools | None = None
    sign_free: bool = False

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
    ) -> FlowField:
        """Make a field from arrays.

        Parameters
        ----------
        points
            Node positions, (J, I, 2) or (J, I, 3), in any unit of length.
        velocity
            Velocity at the nodes, (J, I, 2 or 3), or (T, J, I, 2 or 3) for a field that varies
            in time, in units of length per unit of time. NaN and masked entries blank a node.
        times
            Time of each step, (T,), strictly increasing, in any unit of time. Steps are
            numbered 0, 1, 2, ... when it is left out.
        valid
            Nodes that carry data, (J, I). All of them by default.
        periodic
            Axes that close on themselves: ``""``, ``"i"``, ``"j"`` or ``"ij"``. By default it
            is found out: coinciding first and last lines of nodes, a ring that stops one cell
            short, and global longitude on a flat map.
        scalars
            Further nodal arrays, name to (J, I) or (T, J, I), to colour by.
        name, length_unit, time_unit
            Words for captions.
        sign_free
            Whether v and -v mean the same. Such a field is steady; it is drawn to both sides,
            with no kernel and no motion that tells forward from backward. Vectors are turned
            over where that makes neighbours agree.

        Returns
        -------
        FlowField

        Raises
        ------
        FieldError
            When the arrays do not make a field. All faults are told at once.

        Warns
        -----
        UserWarning
            When the velocity is zero everywhere: the picture is then plain noise.

        Notes
        -----
        The arrays are copied to float64 and never changed.
        """
        p, masked_points = checks.numbers(points)
        v, masked_velocity = checks.numbers(velocity)
        faults = checks.shapes(p, v, times, valid, periodic, scalars)
        raise_faults(faults + checks.signs(v, sign_free=sign_free))
        v = v[None] if v.ndim == 3 else v
        p, v = checks.three(p), checks.three(v)
        v = with_equal_ends(v) if sign_free else v
        t = np.arange(len(v), dtype=float) if times is None else np.array(times, dtype=float)
        ok = np.isfinite(p).all(axis=-1) & ~masked_points
        ok &= np.isfinite(v).all(axis=(0, -1)) & ~masked_velocity
        if valid is not None:
            ok &= np.asarray(valid, dtype=bool)
        raise_faults(checks.usable(p, ok))
        data = {key: checks.steps(value) for key, value in (scalars or {}).items()}
        p, v, ok, data, closed = _close(p, v, ok, data, periodic)
        surface = Surface(p, ok, closed)
        if sign_free:
            v = oriented(np.where(ok[..., None], v[0], 0.0), ok, closed)
            v = with_equal_ends(v[None], closed, surface.poles)
        made = cls(
            points=surface.points,
            velocity=np.where(ok[..., None], v, 0.0),
            times=t,
            valid=ok,
            periodic=closed,
            scalars=data,
            name=name,
            length_unit=length_unit,
            time_unit=time_unit,
            placed=surface._usable,
            sign_free=sign_free,
        )
        if not made.velocity.any():
            warnings.warn(
                "The velocity is zero at every node, so the picture is plain noise; check the "
                "array that was chosen and the region it covers.",
                stacklevel=2,
            )
        return made

    @classmethod
    def from_pyvista(cls, mesh: Any, **options: Any) -> FlowField:
        """Make a field from PyVista; see :func:`flowtex.field.io.from_pyvista.from_pyvista`."""
        from flowtex.field.io.from_pyvista import from_pyvista

        return from_pyvista(mesh, **options)

    @classmethod
    def from_file(cls, path: str | Path, **options: Any) -> FlowField:
        """Make a field from a file; see :func:`flowtex.field.io.files.from_file`."""
        from flowtex.field.io.files import from_file

        return from_file(path, **options)

    @property
    def shape(self) -> tuple[int, int]:
        """Number of nodes (J, I)."""
        return self.valid.shape[0], self.valid.shape[1]

    @property
    def steady(self) -> bool:
        """Whether there is one time step only."""
        return len(self.times) == 1

    @cached_property
    def surface(self) -> Surface:
        """The geometry: tangents, cell sizes and positions between nodes."""
        known = True if self.placed is None else self.placed[..., None]
        # Positions that were filled in must not pass for known ones: tangents would bend.
        points = np.where(known, self.points, np.nan)
        return Surface(points, self.valid, self.periodic)

    @cached_property
    def index_velocity(self) -> IndexVelocity:
        """The velocity in index space, in cells per unit of time, with its speed."""
        return to_index_space(self.surface, self.velocity)

    @property
    def speed(self) -> Floats:
        """Speed along the surface, (T, J, I)."""
        return self.index_velocity.speed

    @property
    def lost(self) -> float:
        """Share of the flow that points out of the surface and cannot be drawn on it."""
        return self.index_velocity.lost

    def at_step(self, step: int) -> FlowField:
        """Return one time step of this field as a steady field.

        Raises
        ------
        IndexError
            When there is no such step.
        """
        count = len(self.times)
        if not -count <= step < count:
            msg = f"time step {step} does not exist: expected 0 to {count - 1}"
            raise IndexError(msg)
        step %= count
        data = {k: s[step : step + 1] if len(s) > 1 else s for k, s in self.scalars.items()}
        at = slice(step, step + 1)
        return replace(self, velocity=self.velocity[at], times=self.times[at], scalars=data)

    def downsample(self, factor: int) -> FlowField:
        """Keep every ``factor``-th node along both axes, and the last line of a closed axis.

        This is what the paper compares trace slices with (section 5, figures 3 and 4).

        Raises
        ------
        ValueError
            When fewer than two lines would be left.
        """
        picks = [
            checks.every(count, factor, closed=closed)
            for count, closed in zip(self.shape, self.periodic, strict=True)
        ]
        at = np.ix_(*picks)
        return replace(
            self,
            points=self.points[at],
            velocity=self.velocity[:, at[0], at[1]],
            valid=self.valid[at],
            placed=None if self.placed is None else self.placed[at],
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


def _close(
    p: Floats, v: Floats, ok: Bools, data: dict[str, Floats], periodic: str | None
) -> tuple[Floats, Floats, Bools, dict[str, Floats], tuple[bool, bool]]:
    """Find or follow the periodic axes; append and unify the closing line in every array."""
    closed = [False, False]
    for axis, letter in ((0, "j"), (1, "i")):
        lines = np.swapaxes(p, 0, axis)
        if periodic is None:
            closure = find_closure(np.where(np.swapaxes(ok, 0, axis)[..., None], lines, np.nan))
        elif letter in periodic:
            closure = requested_closure(lines, np.swapaxes(v, 1, axis + 1))
        else:
            closure = Closure(periodic=False)
        closed[axis] = closure.periodic
        if closure.line is not None:
            p = np.swapaxes(np.concatenate([lines, closure.line]), 0, axis)
            v, ok = checks.repeat_first(v, axis + 1), checks.repeat_first(ok, axis)
            data = {k: checks.repeat_first(s, axis + 1) for k, s in data.items()}
        elif closure.periodic:
            v, ok = checks.join_ends(v, ok, axis)
    return p, v, ok, data, (closed[0], closed[1])
