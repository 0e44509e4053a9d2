"""Critical points and separatrices for browsers: two parts of each time step.

``critical/3`` has a row for each point of step 3, (K, 4): where it is, and the number of its kind.
``separatrices/3`` has one for each point of its closed orbits and lines, (N, 4): its position, and
a number that identifies the line; lines that leave saddles end on stable orbits. Both begin with
the strongest; ``client/src/marks.ts`` is the other side. ``nullclines/3`` has two for each straight
piece, and the number of the component.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Floats, Floats32
from flowtex._util.colours import rgb
from flowtex.rendering.map_overlay import USUAL_HEIGHT_PX, WIDTH_RANGE
from flowtex.rendering.structure_marks import (
    DOT_PX,
    KIND_MARKS,
    LINE_COLORS,
    LINE_PX,
    MIDDLE_COLOR,
    NULLCLINE_COLORS,
    RIM_COLOR,
    RIM_OPACITY,
)
from flowtex.rendering.webgl.protocol import Header, Parts
from flowtex.textures.geometry import DrawnSurface
from flowtex.textures.tiles import Structure

#: Kinds of parts, by the settings that ask for them.
MARK_PARTS = {
    "critical_points": "critical",
    "separatrices": "separatrices",
    "nullclines": "nullclines",
}
#: The number of a line is SADDLE times that of its saddle, plus a sum of flags.
SADDLE, ORBIT, LEAVING, SIDE = 8, 4, 2, 1


@dataclass(frozen=True, eq=False)
class Marks:
    """The structure of a flow, as parts for a client."""

    structure: Structure
    kinds: tuple[str, ...] = tuple(MARK_PARTS.values())  #: Parts that are available.
    carried: bool = False  #: Whether they come with each step, or when requested.

    def header(self) -> Header:
        """Return their part of the header."""
        return {
            "parts": list(self.kinds),
            "kinds": [
                {"name": name, "color": list(rgb(mark.color)), "turns": mark.turns}
                for name, mark in KIND_MARKS.items()
            ],
            "lines": {name: list(rgb(color)) for name, color in LINE_COLORS.items()},
            "nullclines": [
                {"name": name, "color": list(rgb(color))}
                for name, color in NULLCLINE_COLORS.items()
            ],
            "rim": [*rgb(RIM_COLOR), RIM_OPACITY],
            "middle": list(rgb(MIDDLE_COLOR)),
            "dot": list(DOT_PX),
            "line": list(LINE_PX),
            "usualHeight": USUAL_HEIGHT_PX,
            "widthRange": list(WIDTH_RANGE),
        }

    def parts(self, kind: str, source: int, step: int, geometry: DrawnSurface) -> Parts:
        """Return the part of a kind, of step ``source`` of the field, by the name of a step."""
        make = {"critical": self._points, "nullclines": self._nullclines}.get(kind, self._lines)
        rows = make(source)
        local = (rows[:, :3] - geometry.center) @ geometry.frame.T
        part: Floats32 = np.concatenate([local, rows[:, 3:]], axis=1).astype("<f4")
        return {f"{kind}/{step}": part}

    def _points(self, step: int) -> Floats:
        numbers = {kind: number for number, kind in enumerate(KIND_MARKS)}
        rows = [[*p.position, numbers[p.kind]] for p in self.structure.points(step)]
        return np.array(rows, dtype=float).reshape(-1, 4)

    def _nullclines(self, step: int) -> Floats:
        rows = []
        for component, pieces in enumerate(self.structure.nullclines(step)):
            points = pieces.reshape(-1, 3)
            rows.append(np.concatenate([points, np.full((len(points), 1), component)], axis=1))
        return np.concatenate(rows)

    def _lines(self, step: int) -> Floats:
        rows = [np.empty((0, 4))]
        for n, found in enumerate(self.structure.orbits(step)):
            code = ORBIT + LEAVING * found.stable + SIDE * (n % 2)
            codes = np.full((len(found.points), 1), code)
            rows.append(np.concatenate([found.points, codes], axis=1))
        ranks: dict[int, int] = {}
        count: dict[int, int] = {}
        for line in self.structure.lines(step):
            rank = ranks.setdefault(id(line.saddle), len(ranks))
            number = SADDLE * rank + LEAVING * line.forward
            count[number] = count.get(number, -1) + 1
            number += SIDE * (count[number] % 2)
            for path, is_orbit in ((line.unwound, 0), (line.orbit, 1)):
                if path is not None:
                    codes = np.full((len(path), 1), number + ORBIT * is_orbit)
                    rows.append(np.concatenate([path, codes], axis=1))
        return np.concatenate(rows)
