"""Critical points and separatrices: how they look, and two parts of each time step for browsers.

``critical/3`` has a row for each point of step 3, (K, 4): where it is, and the number of its kind.
``separatrices/3`` has one for each point of its closed orbits and lines, (N, 4): its position, and
a number that identifies the line; lines that leave saddles end on stable orbits. Both begin with
the strongest; ``client/src/marks.ts`` is the other side. ``nullclines/3`` has two for each straight
piece, and the number of the component.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from flowtex._util.array_types import Floats, Floats32
from flowtex._util.colours import rgb
from flowtex.rendering.map_overlay import USUAL_HEIGHT_PX, WIDTH_RANGE
from flowtex.rendering.structure import Structure
from flowtex.rendering.webgl.protocol import Header, Parts
from flowtex.settings import Settings
from flowtex.textures.geometry import DrawnSurface

#: Kinds of parts, by the settings that ask for them.
MARK_PARTS = {
    "critical_points": "critical",
    "separatrices": "separatrices",
    "nullclines": "nullclines",
}
SADDLE = 8  #: Factor of the saddle's number in the number of a line, which adds flags.
ORBIT = 4  #: Flag of a closed orbit.
LEAVING = 2  #: Flag of a line that leaves its saddle.
SIDE = 1  #: Flag of the second side of a saddle.


class KindMark(NamedTuple):
    """The colour of a kind of critical point, and whether the flow turns there: a ring."""

    color: str
    turns: bool = False


#: By kind, in the order of legends.
KIND_MARKS = {
    "saddle": KindMark("#ffd21f"),
    "source": KindMark("#ff5a36"),
    "spiral source": KindMark("#ff5a36", turns=True),
    "centre": KindMark("#35c46a", turns=True),
    "spiral sink": KindMark("#3b8bff", turns=True),
    "sink": KindMark("#3b8bff"),
    "degenerate": KindMark("#b36bff"),
}
#: Lines along which the flow leaves saddles and comes to them, and closed orbits to which lines
#: come or which they leave, in the order of legends.
LINE_COLORS = {
    "from saddle": "#ff5a36",
    "to saddle": "#3b8bff",
    "stable orbit": "#35c46a",
    "unstable orbit": "#ffffff",
}
#: Lines along which the components along x and y are zero.
NULLCLINE_COLORS = {"u = 0": "#ffa733", "v = 0": "#ff9ad5"}
#: Colour around dots and lines.
RIM_COLOR = "#101418"
RIM_OPACITY = 0.85  #: Opacity around dots and lines.
#: Colour in the middle of rings.
MIDDLE_COLOR = "#ffffff"
DOT_PX = (12.0, 9.0, 4.0)  #: Diameters of the rim of a dot, its colour, and the middle of a ring.
LINE_PX = (3.6, 2.0)  #: Widths in pixels of the rim of a line and of its colour.


def strokes(
    structure: Structure, settings: Settings, step: int, window: Floats | None = None
) -> Iterator[tuple[Floats, str, float, int]]:
    """Yield pieces (N, 2, 3) of lines and dots, a colour, a width in pixels, and the order."""
    lines: list[tuple[Floats, str, int]] = []
    if settings.nullclines:
        found = zip(structure.nullclines(step, window), NULLCLINE_COLORS.values(), strict=True)
        lines += [(pieces, color, 1) for pieces, color in found]
    if settings.separatrices:
        paths = structure.paths(step, settings.separatrices)
        colors = enumerate(LINE_COLORS.items(), 1)
        lines += [(_pieces(paths[name]), color, above) for above, (name, color) in colors]
    if lines:
        yield np.concatenate([pieces for pieces, *_ in lines]), RIM_COLOR, LINE_PX[0], 0
    yield from ((pieces, color, LINE_PX[1], above) for pieces, color, above in lines)
    if settings.critical_points:
        points = structure.points(step)[: settings.critical_points]
        yield _pieces([p.position[None] for p in points]), RIM_COLOR, DOT_PX[0], 5
        for kind, mark in KIND_MARKS.items():
            dots = _pieces([p.position[None] for p in points.of_kind(kind)])
            yield dots, mark.color, DOT_PX[1], 6
            yield dots[: len(dots) * mark.turns], MIDDLE_COLOR, DOT_PX[2], 7


def _pieces(paths: Sequence[Floats]) -> Floats:
    """Cut paths (N, 3) into pieces, and double the only point of a dot."""
    ends = ((path[:-1], path[1:]) if len(path) > 1 else (path, path) for path in paths)
    return np.concatenate([np.zeros((0, 2, 3)), *(np.stack(pair, axis=1) for pair in ends)])


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
        found = enumerate(self.structure.nullclines(step))
        return np.concatenate([np.insert(p.reshape(-1, 3), 3, n, axis=1) for n, p in found])

    def _lines(self, step: int) -> Floats:
        rows = [np.empty((0, 4))]
        for n, found in enumerate(self.structure.orbits(step)):
            code = ORBIT + LEAVING * found.stable + SIDE * (n % 2)
            rows.append(np.insert(found.points, 3, code, axis=1))
        ranks: dict[int, int] = {}
        count: dict[int, int] = {}
        for line in self.structure.lines(step):
            rank = ranks.setdefault(id(line.saddle), len(ranks))
            number = SADDLE * rank + LEAVING * line.forward
            count[number] = count.get(number, -1) + 1
            number += SIDE * (count[number] % 2)
            for path, is_orbit in ((line.unwound, 0), (line.orbit, 1)):
                if path is not None:
                    rows.append(np.insert(path, 3, number + ORBIT * is_orbit, axis=1))
        return np.concatenate(rows)
