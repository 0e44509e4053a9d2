"""Figure 7: a curved surface, close up and zoomed out."""

from __future__ import annotations

from flowtex.rendering.cpu import Camera
from paper.bench import Bench
from paper.findings import Finding, Section
from paper.level_of_detail import finding
from paper.views import View

__all__ = ["SECTIONS", "wing"]

#: Where the camera stands, what it looks at from afar and close up, and half the height it sees.
EYE, WHOLE, NEAR, HALF = (0.25, -1.0, 1.5), (0.56, 0.0, 0.0), (0.78, -0.16, 0.03), 0.43


def wing(bench: Bench, size: tuple[int, int], zoom: float) -> View:
    """Look at the wing from above and aside; closer, at the flow beside its left edge."""
    at = NEAR if zoom > 1 else WHOLE
    eye = tuple(e - w + a for e, w, a in zip(EYE, WHOLE, at, strict=True))
    scale = HALF * max(1.0, 1.45 * size[1] / size[0]) / zoom
    camera = Camera((eye[0], eye[1], eye[2]), at, (0.0, 0.0, 1.0), size, parallel_scale=scale)
    return View(bench, bench.shuttle, camera)


def _shuttle(bench: Bench) -> Finding:
    size = bench.pick((460, 360), (184, 144))
    small = bench.pick((300, 235), (130, 102))
    return finding(
        "figure7_shuttle",
        "The shuttle's stand-in, zoomed out (figure 7)",
        wing(bench, size, 5.0),
        wing(bench, size, 1.0),
        [(z, wing(bench, small, z)) for z in bench.pick((1.0, 4.0, 16.0, 64.0), (1.0, 16.0))],
        times=bench.pick(4, 2),
        resolution=bench.pick(2048, 512),
        caption="A delta wing in the shuttle's place: 52 × 62 nodes of a curved surface. Left as "
        "the paper's figure begins, close up; then zoomed out, both ways.",
    )


SECTIONS = [
    Section(
        "figure7",
        "Figure 7: zooming out of the shuttle",
        "Section 5, figure 7",
        "From a close view the camera zooms out. The multi-resolution method changes to a lower "
        "resolution of slices and noise and keeps a clear pattern; without it there is aliasing.",
        "The shuttle data was not published. In its place stands a curved surface of as many "
        "nodes, 52 × 62, with a flow along it in closed form (flowtex.examples.delta_wing).",
        _shuttle,
    )
]
