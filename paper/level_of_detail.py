"""The same view with and without level of detail, and how far each is from what it should be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flowtex._util.array_types import Floats
from paper import measures
from paper.bench import OURS, PAPER
from paper.findings import Block, Claim, Finding, Panel, Plate, Table
from paper.views import View, grey

__all__ = ["Pair", "clearer", "compare", "finding", "series"]


@dataclass(frozen=True, eq=False)
class Pair:
    """One view with and without level of detail: pictures and what they measure."""

    pictures: dict[bool, Floats]
    figures: dict[bool, dict[str, float]]

    def gain(self, name: str) -> float:
        """Value without level of detail over that with it."""
        return self.figures[False][name] / self.figures[True][name]

    def panels(self) -> list[Panel]:
        """Both pictures, each with its error printed."""
        return [
            Panel(
                grey(self.pictures[lod]),
                f"{'With' if lod else 'Without'} level of detail: aliasing error "
                f"{self.figures[lod]['aliasing']:.2f}, coherence "
                f"{self.figures[lod]['coherence']:.2f}.",
            )
            for lod in (True, False)
        ]


def compare(view: View, times: int, **settings: Any) -> Pair:
    """Draw a view both ways, and each again with ``times`` x ``times`` samples a pixel."""
    pictures, figures = {}, {}
    for lod in (True, False):
        values = view.picture(**settings, lod=lod).value
        reference = view.reference(times, **settings, lod=lod)
        streaks = view.streaks(values)
        pictures[lod] = values
        figures[lod] = {
            "aliasing": measures.aliasing(values, reference, view.mask),
            "likeness": measures.likeness(values, reference, view.mask),
            "angle": streaks.angle,
            "coherence": streaks.coherence,
        }
    return Pair(pictures, figures)


def clearer(name: str, where: str, pair: Pair) -> list[Claim]:
    """Less aliasing, and streaks that are clearer and nearer to the flow, with level of detail."""
    return [
        Claim(
            f"{name}_less_aliasing",
            f"{where}: with level of detail there is less aliasing than without.",
            1 / pair.gain("aliasing"),
            0.5,
            "at most",
            "× the error without",
        ),
        Claim(
            f"{name}_clearer_streaks",
            f"{where}: with level of detail the streaks are clearer.",
            1 / pair.gain("coherence"),
            1.5,
            "at least",
            "× the coherence without",
        ),
        Claim(
            f"{name}_streaks_follow_the_flow",
            f"{where}: with level of detail the streaks lie closer to the flow.",
            pair.figures[True]["angle"] - pair.figures[False]["angle"],
            -10.0,
            "at most",
            "° of mean angle",
        ),
    ]


def series(
    views: Sequence[tuple[float, View]], **settings: Any
) -> tuple[list[Panel], dict[str, dict[str, float]]]:
    """Draw a view at several zooms with level of detail, and measure streaks and grain."""
    panels, numbers = [], {}
    for zoom, view in views:
        values = view.picture(**settings).value
        streaks, grain = view.streaks(values), view.grain(values)
        panels.append(Panel(grey(values), f"Zoom {zoom:g}: grain {grain.across:.2f} px across."))
        numbers[f"{zoom:g}"] = {**streaks._asdict(), **grain._asdict()}
    return panels, numbers


def finding(
    name: str,
    where: str,
    close: View,
    far: View,
    zooms: Sequence[tuple[float, View]],
    *,
    times: int,
    resolution: int,
    caption: str,
) -> Finding:
    """Make the finding of a figure: close up, from afar both ways, a zoom series.

    Parameters
    ----------
    name
        Beginning of the claims' names.
    where
        What is seen, for the claims.
    close, far
        The view close up, and the one from which is zoomed out.
    zooms
        Zooms and views of the series.
    times
        Samples along each side of a pixel in the reference.
    resolution
        Texels of the noise along the surface.
    caption
        What is written under the pictures.
    """
    paper = {**PAPER, "resolution": resolution}
    near, pair = compare(close, times, **paper), compare(far, times, **paper)
    panels, numbers = series(zooms, **OURS)
    blocks: list[Block] = [
        Plate([Panel(grey(near.pictures[True]), "Close up."), *pair.panels()], caption),
        _table(near, pair),
        Plate(
            panels,
            "What flowtex draws by default, noise in space and 49 samples, at several zooms: the "
            "grain keeps its size in pixels.",
        ),
    ]
    figures = {
        "close": {_word(lod): figures for lod, figures in near.figures.items()},
        "far": {_word(lod): figures for lod, figures in pair.figures.items()},
        "default_by_zoom": numbers,
    }
    return Finding(blocks, figures, clearer(name, where, pair))


def _word(lod: bool) -> str:  # noqa: FBT001 - the key of a dictionary
    return "with" if lod else "without"


def _table(near: Pair, far: Pair) -> Table:
    rows = [
        (
            view,
            f"{_word(lod)} level of detail",
            *(pair.figures[lod][key] for key in ("aliasing", "likeness", "angle", "coherence")),
        )
        for view, pair in (("close up", near), ("from afar", far))
        for lod in (True, False)
    ]
    head = ("view", "", "aliasing error", "likeness", "mean angle to the flow, °", "coherence")
    caption = (
        "Aliasing error: root mean square difference from the same texture with many samples a "
        "pixel, over the deviation of that; likeness: their correlation."
    )
    return Table(head, rows, caption)
