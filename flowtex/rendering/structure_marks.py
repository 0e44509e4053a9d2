"""How critical points and separatrices look: dots of a colour for each kind, and lines."""

from __future__ import annotations

from typing import NamedTuple


class KindMark(NamedTuple):
    """The colour of a kind of critical point, and whether the flow turns there: a ring, not a disc.

    Sources are warm, sinks cold.
    """

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
#: Around dots and lines, and in the middle of rings.
RIM_COLOR, RIM_OPACITY, MIDDLE_COLOR = "#101418", 0.85, "#ffffff"
#: Diameters in pixels of the rim of a dot, of its colour, and of the middle of a ring; widths of
#: the rim of a line and of its colour.
DOT_PX, LINE_PX = (12.0, 9.0, 4.0), (3.6, 2.0)
