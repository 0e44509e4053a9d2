"""Beyond: what the number of contributions does, from 5 to 50."""

from __future__ import annotations

import time
from typing import Any

from paper.bench import PAPER, Bench
from paper.findings import Claim, Finding, Panel, Plate, Plot, Section
from paper.plots import Line, draw_lines, plot_axes
from paper.views import grey, view_of

#: A point to look at, and texels of the noise.
POINT, RESOLUTION = (0.63, 0.37), 1024
KERNELS: dict[str, dict[str, Any]] = {
    "paper: box, backward": {**PAPER, "resolution": RESOLUTION},
    "default: Hann, both sides": {"noise": "procedural"},
}


def _samples(bench: Bench) -> Finding:
    counts = bench.pick((5, 10, 15, 20, 25, 30, 40, 50), (5, 10, 50))
    view = view_of(bench, bench.gyre, bench.pick((320, 260), (130, 104)), zoom=2.0, focus=POINT)
    figures: dict[str, dict[str, Any]] = {}
    seconds: dict[str, dict[str, float]] = {}
    panels = []
    for name, settings in KERNELS.items():
        figures[name], seconds[name] = {}, {}
        for count in counts:
            started = time.perf_counter()
            values = view.picture(**{**settings, "samples": count}).value
            seconds[name][str(count)] = time.perf_counter() - started
            figures[name][str(count)] = {
                **view.streaks(values)._asdict(),
                **view.grain(values)._asdict(),
            }
            if count in (5, 10, 50):
                panels.append(Panel(grey(values), f"{name.capitalize()}, K = {count}."))
    plates = [Plate(panels[:3]), Plate(panels[3:])]
    return Finding([_plot(figures), *plates], figures, _claims(figures), {"seconds": seconds})


def _plot(figures: dict[str, dict[str, Any]]) -> Plot:
    counts = [int(count) for count in next(iter(figures.values()))]
    with plot_axes(
        "Half width of the autocorrelation along the flow, and coherence, against the number of "
        "contributions.",
        "Streaks grow in proportion to K; coherence rises with it and levels off.",
        columns=2,
    ) as figure:
        for axes, key, title in zip(
            figure.axes, ("along", "coherence"), ("Length of streaks, px", "Coherence"), strict=True
        ):
            draw_lines(
                axes,
                [Line(n, counts, [f[str(k)][key] for k in counts]) for n, f in figures.items()],
            )
            axes.set_title(title)
            axes.set_xlabel("contributions K")
        figure.axes[1].legend(loc="lower right")
        figure.axes[1].set_ylim(0, 1)
    return figure.plot


def _claims(figures: dict[str, dict[str, Any]]) -> list[Claim]:
    paper, ours = figures.values()
    return [
        Claim(
            "samples_make_streaks",
            "Section 3.3: contributions of several times make intensities coherent along the "
            "flow. Coherence at K = 50 against K = 5, by the paper's method.",
            paper["50"]["coherence"] / paper["5"]["coherence"],
            1.2,
            "at least",
            "×",
        ),
        Claim(
            "samples_length",
            "Section 3.3: streaks are the overlap of neighbouring sums, so they grow with K. "
            "Length at K = 50 over that at K = 5.",
            paper["50"]["along"] / paper["5"]["along"],
            4.0,
            "at least",
            "×",
        ),
        Claim(
            "beyond_samples_in_one_pass",
            "Beyond: 50 contributions in one pass, where the paper needs further passes beyond "
            "the number of texture units; both kernels reach this coherence.",
            min(paper["50"]["coherence"], ours["50"]["coherence"]),
            0.7,
            "at least",
        ),
    ]


SECTIONS = [
    Section(
        "samples",
        "From 5 to 50 contributions",
        "Sections 3.3 and 5",
        "K was 10 in all experiments. Beyond the number of textures that a fragment program may "
        "use, 16 as a rule, a picture takes further passes.",
        "All slices lie in one texture array, and lags that double are enough for any K, so a "
        "picture takes one pass whatever K is.",
        _samples,
        "Beyond the paper",
    )
]
