"""The structure of a flow as it is drawn: of any step, the strongest of it, on request."""

from __future__ import annotations

import threading
from collections import OrderedDict
from typing import Any

from flowtex._util.array_types import Floats
from flowtex._util.cache import WeakCache
from flowtex.field import FlowField
from flowtex.settings import TABLE, Settings, SettingsError
from flowtex.textures.tiles.coarse import coarsened_field
from flowtex.textures.tiles.shared import has_pyramid, shared_pyramid
from flowtex.trace.structure import (
    ClosedOrbit,
    CriticalPoints,
    Separatrices,
    critical_points,
    nullclines,
    orbits_around,
    separatrices_between,
)

#: Nodes of a field up to which all of it is searched; of a larger one a coarser form is.
SEARCHED_NODES = 1_000_000
#: Settings that say how much of it is drawn: points, and saddles with their lines.
STRUCTURE = ("critical_points", "separatrices", "nullclines")
#: Points of a step, and saddles whose lines are drawn, at most.
MOST_POINTS, MOST_SADDLES = (int(TABLE[name].high or 0) for name in STRUCTURE[:2])
#: Length of a line that is drawn, as a share of the surface's extent, at most.
DRAWN_EXTENTS = 2.0
#: Points of a line that is drawn, two to a cell, at most.
DRAWN_POINTS = 1500
#: Steps whose structure is kept.
KEPT_STEPS = 64


class Structure:
    """Critical points and separatrices of a field. All methods may be called from any thread."""

    def __init__(self, field: FlowField) -> None:
        self._whole, self._field = field, _searched(field)
        self._lock = threading.Lock()
        self._every: tuple[int, CriticalPoints] | None = None
        self._points: OrderedDict[int, CriticalPoints] = OrderedDict()
        self._lines: OrderedDict[int, tuple[int, Separatrices]] = OrderedDict()
        self._orbits: OrderedDict[int, list[ClosedOrbit]] = OrderedDict()

    def points(self, step: int) -> CriticalPoints:
        """Return the critical points of a step, the strongest first."""
        with self._lock:
            if step not in self._points:
                _keep(self._points, step, self._every_point(step).strongest(MOST_POINTS))
            return self._points[step]

    def _every_point(self, step: int) -> CriticalPoints:
        """Return all points of a step, which are kept until those of another one are wanted."""
        if self._every is None or self._every[0] != step:
            self._every = step, critical_points(self._field, steps=[step])
        return self._every[1]

    def lines(self, step: int, saddles: int = MOST_SADDLES) -> Separatrices:
        """Return the lines of this many saddles of a step, the strongest."""
        with self._lock:
            count, lines = self._lines.get(step, (0, Separatrices()))
            if count < saddles:
                length = DRAWN_EXTENTS * self._field.surface.extent
                field, points = self._field.at_step(step), self._every_point(step)
                lines = separatrices_between(field, points, length, saddles, most=DRAWN_POINTS)
                _keep(self._lines, step, (saddles, lines))
            kept = {id(saddle) for saddle in _saddles(lines)[:saddles]}
            return Separatrices(line for line in lines if id(line.saddle) in kept)

    def orbits(self, step: int) -> list[ClosedOrbit]:
        """Return the closed orbits of a step, whether or not a separatrix ends there."""
        with self._lock:
            if step not in self._orbits:
                points = self._every_point(step)
                _keep(self._orbits, step, orbits_around(self._field.at_step(step), points))
            return self._orbits[step]

    def paths(self, step: int, saddles: int) -> dict[str, list[Floats]]:
        """Return lines of this many saddles, and closed orbits, (N, 3) each, by what they are."""
        found: dict[str, list[Floats]] = {
            name: [] for name in ("from saddle", "to saddle", "stable orbit", "unstable orbit")
        }
        for orbit in self.orbits(step):
            found["stable orbit" if orbit.stable else "unstable orbit"].append(orbit.points)
        for line in self.lines(step, saddles):
            found["from saddle" if line.forward else "to saddle"].append(line.unwound)
            if line.orbit is not None:
                found["stable orbit" if line.forward else "unstable orbit"].append(line.orbit)
        return found

    def nullclines(self, step: int) -> tuple[Floats, Floats]:
        """Return the pieces of the nullclines of a step, as :func:`nullclines` does."""
        return nullclines(self._field.at_step(step))

    def find(self, step: int, points: int, saddles: int) -> None:
        """Have what shows this many points, and the lines of this many saddles, of a step."""
        if points:
            self.points(step)
        if saddles:
            self.lines(step, saddles)
            self.orbits(step)

    def has(self, step: int, points: int, saddles: int) -> bool:
        """Return whether all that shows these has been found."""
        found = self._lines.get(step, (0, None))[0]
        has_lines = saddles <= found and (not saddles or step in self._orbits)
        return (not points or step in self._points) and has_lines


def _saddles(lines: Separatrices) -> CriticalPoints:
    """Return the saddles of lines, each once, the strongest first."""
    found = {id(line.saddle): line.saddle for line in lines}
    return CriticalPoints(list(found.values())).strongest(len(found))


def _keep(steps: OrderedDict[int, Any], step: int, found: Any) -> None:
    steps[step] = found
    if len(steps) > KEPT_STEPS:
        steps.popitem(last=False)


_structures: WeakCache[Structure] = WeakCache()


def shared_structure(field: FlowField) -> Structure:
    """Return the structure of a field, which all users of the field share."""
    # A structure keeps its field alive, so the number of the field is its own meanwhile.
    return _structures.get(id(field), lambda: Structure(field))


def check_structure(field: FlowField, settings: Settings) -> None:
    """Raise a SettingsError where a structure is to be drawn that a field does not have."""
    for name in STRUCTURE:
        if not (value := getattr(settings, name)):
            continue
        if field.sign_free:
            msg = (
                f"{name} is {value}; expected {TABLE[name].default}, because the field is sign-free"
            )
            raise SettingsError(msg)
        if name == "nullclines" and field.surface.frame is None:
            msg = "nullclines is True; expected False: the surface is curved and has no x and y"
            raise SettingsError(msg)


def _searched(field: FlowField) -> FlowField:
    """Return a field, or of a large one a coarser form."""
    if field.valid.size <= SEARCHED_NODES:
        return field
    if has_pyramid(field) or field.triangles is not None:
        return shared_pyramid(field, "arclength", "streamlines").root
    return coarsened_field(field, SEARCHED_NODES)
