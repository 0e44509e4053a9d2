"""The structure of a flow as it is drawn: the strongest features of a step, on request."""

from __future__ import annotations

from collections import OrderedDict
from typing import TypeVar

from flowtex._util.array_types import Floats
from flowtex._util.cache import WeakCache
from flowtex._util.forks import ProcessLock
from flowtex.field import FlowField
from flowtex.settings import TABLE, Settings, SettingsError
from flowtex.textures.tiles.shared import coarsened_field, has_pyramid, shared_pyramid
from flowtex.trace.structure.critical_points import CriticalPoints, critical_points
from flowtex.trace.structure.formula_lines import nullclines, view_window
from flowtex.trace.structure.orbits import ClosedOrbit, orbits_around
from flowtex.trace.structure.separatrices import Separatrices, separatrices_between

T = TypeVar("T")

#: Most nodes of a field that is searched whole; a larger one is coarsened.
SEARCHED_NODES = 1_000_000
#: Settings of the structure; the first two are numbers of points, and of saddles with lines.
STRUCTURE = ("critical_points", "separatrices", "nullclines")
#: Most points of a step.
MOST_POINTS = int(TABLE["critical_points"].high or 0)
#: Most saddles whose lines are drawn.
MOST_SADDLES = int(TABLE["separatrices"].high or 0)
#: Greatest length of a drawn line as a share of the surface's extent.
DRAWN_EXTENTS = 2.0
#: Most points of a drawn line, two to a cell.
DRAWN_POINTS = 1500
#: Steps whose structure is kept.
KEPT_STEPS = 64


class Structure:
    """Critical points and separatrices of a field. All methods may be called from any thread."""

    def __init__(self, field: FlowField) -> None:
        self._whole = field
        self._field = field
        # A large field is coarsened for the search.
        if field.valid.size > SEARCHED_NODES:
            has_levels = has_pyramid(field) or field.triangles is not None
            if has_levels:
                pyramid = shared_pyramid(field, "arclength", "streamlines")
            else:
                pyramid = None
            if pyramid:
                self._field = pyramid.root
            else:
                self._field = coarsened_field(field, SEARCHED_NODES)
        self._lock = ProcessLock()
        self._all: tuple[int, CriticalPoints] | None = None
        self._points: OrderedDict[int, CriticalPoints] = OrderedDict()
        self._lines: OrderedDict[int, tuple[int, Separatrices]] = OrderedDict()
        self._orbits: OrderedDict[int, list[ClosedOrbit]] = OrderedDict()

    def points(self, step: int) -> CriticalPoints:
        """Return the critical points of a step, the strongest first."""
        with self._lock:
            if step not in self._points:
                _keep(self._points, step, self._all_points(step).strongest(MOST_POINTS))
            return self._points[step]

    def _all_points(self, step: int) -> CriticalPoints:
        """Return all points of a step, which are kept until another step is requested."""
        if self._all is None or self._all[0] != step:
            self._all = step, critical_points(self._field, steps=[step])
        return self._all[1]

    def lines(self, step: int, saddles: int = MOST_SADDLES) -> Separatrices:
        """Return the lines of this many saddles of a step, the strongest."""
        with self._lock:
            count, lines = self._lines.get(step, (0, Separatrices()))
            if count < saddles:
                length = DRAWN_EXTENTS * self._field.surface.extent
                field = self._field.at_step(step)
                points = self._all_points(step)
                lines = separatrices_between(field, points, length, saddles, most=DRAWN_POINTS)
                _keep(self._lines, step, (saddles, lines))
            ordered = CriticalPoints(
                list({id(line.saddle): line.saddle for line in lines}.values())
            )
            kept = {id(saddle) for saddle in ordered.strongest(saddles)}
            return Separatrices(line for line in lines if id(line.saddle) in kept)

    def orbits(self, step: int) -> list[ClosedOrbit]:
        """Return the closed orbits of a step, whether or not a separatrix ends there."""
        with self._lock:
            if step not in self._orbits:
                points = self._all_points(step)
                _keep(self._orbits, step, orbits_around(self._field.at_step(step), points))
            return self._orbits[step]

    def paths(self, step: int, saddles: int) -> dict[str, list[Floats]]:
        """Return lines of this many saddles and closed orbits, (N, 3) each, by kind."""
        by_kind: dict[str, list[Floats]] = {
            name: [] for name in ("from saddle", "to saddle", "stable orbit", "unstable orbit")
        }
        for orbit in self.orbits(step):
            by_kind["stable orbit" if orbit.stable else "unstable orbit"].append(orbit.points)
        for line in self.lines(step, saddles):
            by_kind["from saddle" if line.forward else "to saddle"].append(line.unwound)
            if line.orbit is not None:
                by_kind["stable orbit" if line.forward else "unstable orbit"].append(line.orbit)
        return by_kind

    def nullclines(self, step: int, window: Floats | None = None) -> tuple[Floats, Floats]:
        """Return the pieces of the nullclines of a step, as :func:`nullclines` does."""
        return nullclines(self._field.at_step(step), window)

    def window(self, focus: Floats, visible: float) -> Floats | None:
        """Return the part of the plane around a view, as :func:`view_window` does."""
        return view_window(self._field, focus, visible)

    def find(self, step: int, points: int, saddles: int) -> None:
        """Compute this many points of a step, and the lines of this many saddles."""
        if points:
            self.points(step)
        if saddles:
            self.lines(step, saddles)
            self.orbits(step)

    def has(self, step: int, points: int, saddles: int) -> bool:
        """Return whether :meth:`find` was called for these."""
        count = self._lines.get(step, (0, None))[0]
        has_lines = saddles <= count and (not saddles or step in self._orbits)
        return (not points or step in self._points) and has_lines


def _keep(steps: OrderedDict[int, T], step: int, structure: T) -> None:
    steps[step] = structure
    if len(steps) > KEPT_STEPS:
        steps.popitem(last=False)


_structures: WeakCache[Structure] = WeakCache()


def shared_structure(field: FlowField) -> Structure:
    """Return the structure of a field, which all users of the field share."""
    # A structure keeps its field alive, so the id stays unique.
    return _structures.get(id(field), lambda: Structure(field))


def check_structure(field: FlowField, settings: Settings) -> None:
    """Check that a field has the structure that the settings request.

    Raises
    ------
    SettingsError
        When the field is sign-free and a structure is requested, or nullclines are requested on a
        curved surface.
    """
    for name in STRUCTURE:
        if not (value := getattr(settings, name)):
            continue
        if field.sign_free:
            raise SettingsError(
                f"{name} is {value}; expected {TABLE[name].default}, because the field is sign-free"
            )
        if name == "nullclines" and field.surface.frame is None:
            raise SettingsError(
                "nullclines is True; expected False: the surface is curved and has no x and y"
            )
