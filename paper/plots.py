"""Plots in one style, as SVG text that takes its colours from the page around it.

Text, axes and grids are drawn in marker colours that become CSS variables, so that a plot
follows a page from light to dark. Lines have one order of colours, told apart by people who do
not see all of them, and by their marks.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from paper.findings import Plot

#: Marker colours, and the CSS variables that they stand for.
INKS = {
    "#010101": "var(--ink)",
    "#020202": "var(--soft)",
    "#030303": "var(--rule)",
    "#040404": "var(--paper)",
    "#111110": "var(--c0)",
    "#111111": "var(--c1)",
    "#111112": "var(--c2)",
    "#111113": "var(--c3)",
    "#111114": "var(--c4)",
    "#111115": "var(--c5)",
}
INK, SOFT, RULE, GROUND, *COLOURS = INKS
MARKS = "osD^vP"
#: Size of a plot in inches of 72 CSS pixels each.
WIDTH, HEIGHT = 8.6, 4.3

STYLE: Any = {
    "axes.edgecolor": SOFT,
    "axes.facecolor": "none",
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlecolor": INK,
    "axes.titlelocation": "left",
    "axes.titlesize": 11,
    "figure.facecolor": "none",
    "font.family": "sans-serif",
    "font.size": 10.5,
    "grid.color": RULE,
    "grid.linewidth": 0.8,
    "legend.frameon": False,
    "legend.labelcolor": INK,
    "lines.linewidth": 2.0,
    "lines.markersize": 5.5,
    "savefig.facecolor": "none",
    "svg.fonttype": "none",
    "svg.hashsalt": "flowtex",
    "text.color": INK,
    "xtick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.color": SOFT,
    "ytick.labelcolor": INK,
}


@dataclass(frozen=True)
class Line:
    """One line of a plot: its name, its values, and whether it is dashed."""

    name: str
    x: Sequence[float]
    y: Sequence[float]
    dashed: bool = False


@dataclass
class PlotAxes:
    """Axes to draw on, of :func:`plot_axes`."""

    figure: Any
    axes: Any
    _plot: Plot | None = None

    @property
    def plot(self) -> Plot:
        """The finished plot.

        Raises
        ------
        RuntimeError
            Before the ``with`` block is left.
        """
        if self._plot is None:
            msg = "the plot is not finished; expected to be read after the with block"
            raise RuntimeError(msg)
        return self._plot


@contextmanager
def plot_axes(
    caption: str, alt: str, *, columns: int = 1, size: tuple[float, float] = (WIDTH, HEIGHT)
) -> Iterator[PlotAxes]:
    """Yield axes in the page's style, and turn the drawing into a plot."""
    import matplotlib as mpl
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    with mpl.rc_context(STYLE):
        figure = Figure(figsize=size, layout="constrained")
        FigureCanvasSVG(figure)
        axes = figure.subplots(1, columns)
        result = PlotAxes(figure, axes)
        yield result
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    result._plot = Plot(_themed(text.getvalue(), alt), caption, alt)


def line_plot(
    lines: Sequence[Line],
    *,
    x: str,
    y: str,
    caption: str,
    alt: str,
    log: str = "",
    ticks: Sequence[float] | None = None,
) -> Plot:
    """Draw lines over one pair of axes.

    Parameters
    ----------
    lines
        The lines.
    x, y
        What the axes show, with units.
    caption, alt
        What is written below, and what it shows in words.
    log
        Axes that are logarithmic: ``""``, ``"x"``, ``"y"`` or ``"xy"``.
    ticks
        Where the x axis has ticks.
    """
    with plot_axes(caption, alt) as figure:
        draw_lines(figure.axes, lines, log=log, ticks=ticks)
        figure.axes.set_xlabel(x)
        figure.axes.set_ylabel(y)
        figure.axes.legend()
    return figure.plot


def draw_lines(
    axes: Any, lines: Sequence[Line], *, log: str = "", ticks: Sequence[float] | None = None
) -> None:
    """Draw lines on axes, each with its own colour and mark."""
    for number, line in enumerate(lines):
        axes.plot(
            line.x,
            line.y,
            label=line.name,
            color=COLOURS[number % len(COLOURS)],
            marker=MARKS[number % len(MARKS)],
            linestyle="--" if line.dashed else "-",
        )
    if "x" in log:
        axes.set_xscale("log", base=2 if ticks is not None else 10)
    if "y" in log:
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter("{x:g}")
    else:
        axes.set_ylim(bottom=0)
    if ticks is not None:
        axes.set_xticks(list(ticks), [f"{t:g}" for t in ticks])
        axes.minorticks_off()


def _themed(svg: str, alt: str) -> str:
    """Cut the SVG out of its file, let it take the width it gets, and name its colours."""
    svg = svg[svg.index("<svg") :]
    head, body = svg.split(">", 1)
    box = re.search(r'viewBox="([^"]*)"', head)
    label = alt.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")
    head = f'<svg viewBox="{box.group(1) if box else ""}" role="img" aria-label="{label}"'
    body = re.sub(r"<metadata>.*?</metadata>", "", body, flags=re.DOTALL)
    body = body.replace("xlink:href", "href")
    for marker, variable in INKS.items():
        body = body.replace(marker, variable)
    return f"{head}>{body}"
