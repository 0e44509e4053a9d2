"""Figures 5, 7 and 8: views with and without level of detail, and how far each is off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from flowtex import quality
from flowtex._util.array_types import Floats
from paper import measures
from paper.bench import OURS, PAPER, Bench
from paper.findings import Block, Claim, Finding, Panel, Plate, Section, Table, Text
from paper.views import View, grey, view_of, wing_view

#: Points to zoom into: beside the post, and between vortices of the time step that is shown.
BESIDE_POST, BETWEEN_VORTICES, VORTEX_STEP = (0.25, 0.5), (0.4, 0.55), 10


def _post(bench: Bench) -> Finding:
    post = bench.post
    if post is None:
        return Finding([Text("The post's files could not be had, so this figure is left out.")])
    size = bench.pick((420, 400), (120, 114))
    small = bench.pick((300, 286), (90, 86))
    sizes = post.surface.cell_size
    finding = _finding(
        "figure5_post",
        "The post as a whole (figure 5)",
        view_of(bench, post, size, zoom=5.0, focus=BESIDE_POST),
        view_of(bench, post, size),
        [
            (z, view_of(bench, post, small, zoom=z, focus=BESIDE_POST if z > 1 else None))
            for z in bench.pick((1, 4, 16, 64), (1, 16))
        ],
        times=bench.pick(4, 2),
        resolution=bench.pick(2048, 512),
        caption="The liquid-oxygen post: flow from the left around a round post, whose cells "
        "grow outwards.",
    )
    spread = float(sizes.max() / sizes.min())
    return Finding(finding.blocks, {**finding.numbers, "cell_sizes": spread}, finding.claims)


def _shuttle(bench: Bench) -> Finding:
    size = bench.pick((460, 360), (138, 108))
    small = bench.pick((300, 235), (98, 76))
    return _finding(
        "figure7_shuttle",
        "The shuttle's stand-in, zoomed out (figure 7)",
        wing_view(bench, size, 5.0),
        wing_view(bench, size, 1.0),
        [(z, wing_view(bench, small, z)) for z in bench.pick((1.0, 4.0, 16.0, 64.0), (1.0, 16.0))],
        times=bench.pick(4, 2),
        resolution=bench.pick(2048, 512),
        caption="A delta wing in the shuttle's place: 52 × 62 nodes of a curved surface. Left as "
        "the paper's figure begins, close up; then zoomed out, both ways.",
    )


def _vortex(bench: Bench) -> Finding:
    view = partial(view_of, bench, bench.vortex, step=VORTEX_STEP)
    size = bench.pick((400, 400), (112, 112))
    small = bench.pick((300, 300), (82, 82))
    return _finding(
        "figure8_vortex",
        "The vortex data, zoomed out (figure 8)",
        view(size, zoom=5.0, focus=BETWEEN_VORTICES),
        view(size),
        [
            (z, view(small, zoom=z, focus=BETWEEN_VORTICES if z > 1 else None))
            for z in bench.pick((1, 4, 16, 64), (1, 16))
        ],
        times=bench.pick(4, 2),
        resolution=bench.pick(2048, 512),
        caption="Decaying turbulence, 100 × 100 nodes, step 10 of 31, along pathlines.",
    )


@dataclass(frozen=True, eq=False)
class Comparison:
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


def _compared(view: View, times: int, **settings: Any) -> Comparison:
    """Draw a view both ways, and each again with ``times`` x ``times`` samples a pixel."""
    pictures, figures = {}, {}
    for lod in (True, False):
        values = view.picture(**settings, lod=lod).value
        reference = view.reference(times, **settings, lod=lod)
        streaks = view.streaks(values)
        pictures[lod] = values
        figures[lod] = {
            "aliasing": quality.aliasing(values, reference, view.mask),
            "likeness": measures.likeness(values, reference, view.mask),
            "angle": streaks.angle,
            "coherence": streaks.coherence,
        }
    return Comparison(pictures, figures)


def _claims(name: str, where: str, pair: Comparison) -> list[Claim]:
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


def _series(
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


def _finding(
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
    near, pair = _compared(close, times, **paper), _compared(far, times, **paper)
    panels, numbers = _series(zooms, **OURS)
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
    return Finding(blocks, figures, _claims(name, where, pair))


def _word(lod: bool) -> str:  # noqa: FBT001 - the key of a dictionary
    return "with" if lod else "without"


def _table(near: Comparison, far: Comparison) -> Table:
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


SECTIONS = [
    Section(
        "figure5",
        "Figure 5: the post with and without level of detail",
        "Section 5, figure 5",
        "Cells near the middle of the post's mesh are smaller than the outer ones by orders of "
        "magnitude. With the level of detail the picture has less aliasing than without.",
        "The same data, 32 × 76 nodes of one plane, by the paper's method: noise and step "
        "textures with mip levels, ten even contributions. Without level of detail every pixel "
        "takes the finest level of slices, noise and step.",
        _post,
    ),
    Section(
        "figure7",
        "Figure 7: zooming out of the shuttle",
        "Section 5, figure 7",
        "From a close view the camera zooms out. The multi-resolution method changes to a lower "
        "resolution of slices and noise and keeps a clear pattern; without it there is aliasing.",
        "The shuttle data was not published. In its place stands a curved surface of as many "
        "nodes, 52 × 62, with a flow along it in closed form (flowtex.examples.delta_wing).",
        _shuttle,
    ),
    Section(
        "figure8",
        "Figure 8: zooming out of the vortex data",
        "Section 5, figure 8",
        "The same as figure 7 on the time-varying vortex data: clearer with level of detail, "
        "because aliasing is avoided.",
        "The same on this package's own vortex field, which has the published dimensions. "
        "Streaks follow pathlines, which leave the direction of the moment where the flow turns "
        "quickly: that is part of the mean angle both ways.",
        _vortex,
    ),
]
