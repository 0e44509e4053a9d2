"""Figure 8: the vortex data, close up and zoomed out."""

from __future__ import annotations

from paper.bench import Bench
from paper.findings import Finding, Section
from paper.level_of_detail import finding
from paper.views import view_of

__all__ = ["SECTIONS"]

#: A point between vortices, and the time step that is shown.
POINT, STEP = (0.4, 0.55), 10


def _vortex(bench: Bench) -> Finding:
    vortex = bench.vortex
    size = bench.pick((400, 400), (150, 150))
    small = bench.pick((300, 300), (110, 110))
    return finding(
        "figure8_vortex",
        "The vortex data, zoomed out (figure 8)",
        view_of(bench, vortex, size, zoom=5.0, focus=POINT, step=STEP),
        view_of(bench, vortex, size, step=STEP),
        [
            (
                z,
                view_of(bench, vortex, small, zoom=z, focus=POINT if z > 1 else None, step=STEP),
            )
            for z in bench.pick((1, 4, 16, 64), (1, 16))
        ],
        times=bench.pick(4, 2),
        resolution=bench.pick(2048, 512),
        caption="Decaying turbulence, 100 × 100 nodes, step 10 of 31, along pathlines.",
    )


SECTIONS = [
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
    )
]
