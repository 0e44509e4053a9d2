"""Section 4.1: a step that is adapted to the flow and the level, and one that is not."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from flowtex import quality
from flowtex._util.array_types import Floats
from flowtex.rendering.cpu.fragments import Fragments
from flowtex.rendering.cpu.noise_texture import NoiseImages, NoiseLookup
from flowtex.rendering.cpu.texture import LookupMaker
from flowtex.textures.noise_textures import NoiseTextures
from paper import measures
from paper.bench import PAPER, Bench
from paper.findings import Claim, Finding, Panel, Plate, Section, Table
from paper.plots import Line, line_plot
from paper.views import View, grey, view_of

Values = Mapping[str, Any]

#: Texels of the noise, and the zoom at which one is about as wide as a pixel.
RESOLUTION, POINT = 1024, (0.63, 0.37)
SETTINGS: dict[str, Any] = {**PAPER, "resolution": RESOLUTION, "parameter": "time"}
#: Pixels count as slow or fast below or above these shares of the pixels in view.
SLOW_QUANTILE, FAST_QUANTILE = 0.25, 0.75


class _FixedStep(NoiseLookup):
    """The paper's noise with one step for all, at every place and every level."""

    def __init__(
        self, step: float, fragments: Fragments, values: Values, images: NoiseImages
    ) -> None:
        super().__init__(fragments, values, images)
        self.spacing = np.full(len(self.spacing), step * values["u_spacing"])


class _LocalStep(NoiseLookup):
    """The paper's noise with a step for each place, which is not doubled with the level."""

    def __init__(self, fragments: Fragments, values: Values, images: NoiseImages) -> None:
        super().__init__(fragments, values, images)
        finest = images.step.at(self.start, np.zeros(len(self.start)))[:, 0]
        self.spacing = finest * values["u_spacing"]


def _lookups(noise: NoiseTextures) -> dict[str, LookupMaker | None]:
    images = NoiseImages(noise)
    # The fixed step is right for the typical speed at the finest level.
    step = float(np.median(noise.step))

    def fixed(part: Fragments, values: Values) -> NoiseLookup:
        return _FixedStep(step, part, values, images)

    def local(part: Fragments, values: Values) -> NoiseLookup:
        return _LocalStep(part, values, images)

    return {"adapted to flow and level": None, "adapted to the flow": local, "fixed": fixed}


def _coherence(view: View, values: Floats) -> dict[str, float]:
    """Coherence in all of the view, and where the flow is slow and fast."""
    low, high = np.quantile(view.speed[view.mask], (SLOW_QUANTILE, FAST_QUANTILE))
    masks = {
        "all": view.mask,
        "slow": view.mask & (view.speed <= low),
        "fast": view.mask & (view.speed >= high),
    }
    coherence = {
        name: quality.alignment(values, *view.flow, mask).coherence for name, mask in masks.items()
    }
    return {**coherence, "angle": view.streaks(values).angle}


def _section41(bench: Bench) -> Finding:
    field = bench.gyre
    size = bench.pick((440, 230), (200, 104))
    noise = bench.textures(field, **SETTINGS).image
    assert isinstance(noise, NoiseTextures)
    lookups = _lookups(noise)
    zooms = bench.pick((0.5, 1.0, 2.0, 4.0, 8.0), (1.0, 4.0))
    panel_zoom = 1.0
    figures: dict[str, dict[str, Any]] = {name: {} for name in lookups}
    panels = []
    for zoom in zooms:
        view = view_of(bench, field, size, zoom=zoom, focus=POINT if zoom > 1 else None)
        for name, lookup in lookups.items():
            values = measures.standardised(view.picture(lookup, **SETTINGS).value)
            row = figures[name][f"{zoom:g}"] = _coherence(view, values)
            if zoom == panel_zoom:
                label = f"Δt {name}: coherence {row['all']:.2f}."
                panels.append(Panel(grey(values), label))
    plot = line_plot(
        [
            Line(f"Δt {name}", list(zooms), [figures[name][f"{z:g}"]["all"] for z in zooms])
            for name in lookups
        ],
        x="zoom",
        y="coherence of the streaks",
        caption="Coherence of the streaks against the zoom, ten even contributions.",
        alt="Only the step that is adapted to the level keeps its coherence as the view zooms out.",
        log="x",
        ticks=zooms,
    )
    at = f"{panel_zoom:g}"
    plate = Plate(panels, "A double gyre by the paper's method, the whole of it.")
    return Finding([plate, _table(figures, at), plot], figures, _claims(figures, at))


def _table(figures: dict[str, dict[str, Any]], at: str) -> Table:
    rows = [
        (f"Δt {name}", *(by_zoom[at][key] for key in ("all", "slow", "fast", "angle")))
        for name, by_zoom in figures.items()
    ]
    head = ("step", "coherence", "where slow", "where fast", "mean angle, °")
    return Table(head, rows, "At zoom 1, where a pixel covers several texels of the noise.")


def _claims(figures: dict[str, dict[str, Any]], at: str) -> list[Claim]:
    best, local, fixed = (by_zoom[at] for by_zoom in figures.values())
    text = "Section 4.1: the adapted step makes streaks coherent that a "
    return [
        Claim(
            "section41_adapted_against_fixed",
            f"{text}fixed one does not.",
            best["all"] / fixed["all"],
            1.2,
            "at least",
            "× the coherence",
        ),
        Claim(
            "section41_doubled_with_the_level",
            f"{text}step that is not doubled with each level does not.",
            best["all"] / local["all"],
            1.2,
            "at least",
            "× the coherence",
        ),
        Claim(
            "section41_slow_flow",
            "Section 4.1: where the flow is slow the adapted step keeps streaks as coherent as "
            "where it is fast.",
            best["slow"] / best["fast"],
            0.7,
            "at least",
            "× the coherence",
        ),
    ]


SECTIONS = [
    Section(
        "section41",
        "Section 4.1: the step follows flow and level",
        "Section 4.1, equation 3",
        "For streaks to be coherent, neighbouring contributions must come from neighbouring "
        "texels: |v| Δt ≤ w. So Δt is kept in a texture of its own, for each place by its speed, "
        "with mip levels whose values double.",
        "A steady double gyre, followed by time, drawn three times: with that texture; with the "
        "step of each place but the same at all levels; and with one step for all, which is right "
        "for the typical speed at the finest level.",
        _section41,
    )
]
