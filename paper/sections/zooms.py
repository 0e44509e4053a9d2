"""Beyond: grain and streaks against the zoom, for the paper's noise and the procedural one."""

from __future__ import annotations

from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from paper.bench import OURS, PAPER, Bench
from paper.findings import Claim, Finding, Panel, Plate, Plot, Section
from paper.plots import Line, draw_lines, plot_axes
from paper.references import draw_texture, forssell_lic
from paper.views import View, grey, view_of

#: Texels of the paper's noise, a point to zoom into, and texels of the texture of LIC.
RESOLUTION, POINT, LIC_SHAPE = 1024, (0.63, 0.37), (128, 256)
METHODS = {
    "procedural noise": "Noise in space (default)",
    "noise texture": "The paper's noise texture",
    "LIC": "LIC at 256 × 128, as a texture",
}


def _drawn(bench: Bench, view: View, method: str) -> Floats:
    if method == "procedural noise":
        return view.picture(**OURS).value
    if method == "noise texture":
        return view.picture(**PAPER, resolution=RESOLUTION).value
    texture = bench.once(
        "LIC",
        lambda: forssell_lic(view.field, LIC_SHAPE, length=24.0, kernel="hann", seed=bench.seed),
    )
    values = draw_texture(texture, view.field, view.camera, view.size)
    # Far out there is nothing but grey left.
    return np.asarray((values - np.nanmean(values)) / max(float(np.nanstd(texture)), 1e-9))


def _measured(bench: Bench) -> tuple[dict[str, dict[str, Any]], list[Panel]]:
    zooms = [2.0**n for n in bench.pick(range(11), (0, 5, 10))]
    panel_zooms = bench.pick((1, 16, 256, 1024), (1, 1024))
    size = bench.pick((320, 260), (98, 78))
    figures: dict[str, dict[str, Any]] = {name: {} for name in METHODS}
    panels = []
    for name in METHODS:
        for zoom in zooms:
            view = view_of(bench, bench.gyre, size, zoom=zoom, focus=POINT if zoom > 1 else None)
            values = _drawn(bench, view, name)
            grain, streaks = view.grain(values), view.streaks(values)
            figures[name][f"{zoom:g}"] = {**grain._asdict(), **streaks._asdict()}
            if zoom in panel_zooms:
                panels.append(Panel(grey(values), f"{METHODS[name]}, zoom {zoom:g}."))
    return figures, panels


def _plot(figures: dict[str, dict[str, Any]]) -> Plot:
    zooms = [float(zoom) for zoom in figures["procedural noise"]]
    with plot_axes(
        "Half widths of the autocorrelation, across the flow and along it, from the whole surface "
        "to a thousandth of it. Grain that is wider than some thirty pixels, and streaks longer "
        "than 64, are not measured.",
        "The procedural noise keeps grain and streaks at all zooms; the noise texture keeps them "
        "until its texels are as wide as pixels, and then both grow with the zoom.",
        columns=2,
    ) as figure:
        for axes, key, what in zip(
            figure.axes,
            ("across", "along"),
            ("Grain across the flow", "Length of streaks"),
            strict=True,
        ):
            lines = [
                Line(label, zooms, [figures[name][f"{z:g}"][key] for z in zooms])
                for name, label in METHODS.items()
            ]
            draw_lines(axes, lines, log="xy", ticks=zooms[:: max(1, len(zooms) // 5)])
            axes.set_title(f"{what}, px")
            axes.set_xlabel("zoom")
        figure.figure.legend(
            *figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3
        )
    return figure.plot


def _spread(figures: dict[str, Any], key: str) -> float:
    """Greatest over least value over the zooms."""
    values = [by_zoom[key] for by_zoom in figures.values()]
    return float(max(values) / min(values))


def _grain(bench: Bench) -> Finding:
    figures, panels = _measured(bench)
    spreads = {
        name: {key: _spread(by_zoom, key) for key in ("across", "along")}
        for name, by_zoom in figures.items()
    }
    count = len(panels) // len(METHODS)
    plates = [Plate(panels[n * count : (n + 1) * count]) for n in range(len(METHODS))]
    return Finding([_plot(figures), *plates], {**figures, "spread": spreads}, _claims(spreads))


def _claims(spreads: dict[str, dict[str, float]]) -> list[Claim]:
    ours = "Beyond: from zoom 1 to 1,024 the procedural noise keeps the "
    return [
        Claim(
            "zoom_detail_is_that_of_the_noise",
            "Section 6: how much detail there is close up depends on the resolution of the noise: "
            "the grain of the noise texture grows from zoom 1 to 1,024.",
            spreads["noise texture"]["across"],
            4.0,
            "at least",
            "× from finest to coarsest",
        ),
        Claim(
            "beyond_grain_kept",
            f"{ours}width of its grain.",
            spreads["procedural noise"]["across"],
            1.25,
            "at most",
            "× from finest to coarsest",
        ),
        Claim(
            "beyond_streaks_kept",
            f"{ours}length of its streaks.",
            spreads["procedural noise"]["along"],
            # In the whole view streaks bend with the gyres, which shortens what is measured.
            2.0,
            "at most",
            "× from shortest to longest",
        ),
    ]


SECTIONS = [
    Section(
        "zooms",
        "Grain and streaks from zoom 1 to 1,024",
        "Section 6, future work",
        "How much detail can be seen close up depends on the resolution of the noise, not of the "
        "data. Procedural textures are left to future work.",
        "A double gyre on 120 × 60 nodes, at eleven zooms: noise hashed from positions in space, "
        "which has no resolution to run out of; the paper's noise texture of 1,024 texels; and "
        "LIC computed once and laid on the surface.",
        _grain,
        "Beyond the paper",
    )
]
