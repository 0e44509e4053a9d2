"""Figure 5: the post with and without level of detail."""

from __future__ import annotations

from paper.bench import Bench
from paper.findings import Finding, Section, Text
from paper.level_of_detail import finding
from paper.views import view_of

__all__ = ["SECTIONS"]

#: A point beside the post.
BESIDE = (0.25, 0.5)


def _post(bench: Bench) -> Finding:
    post = bench.post
    if post is None:
        return Finding([Text("The post's files could not be had, so this figure is left out.")])
    size = bench.pick((420, 400), (160, 152))
    small = bench.pick((300, 286), (120, 114))
    sizes = post.surface.cell_size
    found = finding(
        "figure5_post",
        "The post as a whole (figure 5)",
        view_of(bench, post, size, zoom=5.0, focus=BESIDE),
        view_of(bench, post, size),
        [
            (z, view_of(bench, post, small, zoom=z, focus=BESIDE if z > 1 else None))
            for z in bench.pick((1, 4, 16, 64), (1, 16))
        ],
        times=bench.pick(4, 2),
        resolution=bench.pick(2048, 512),
        caption="The liquid-oxygen post: flow from the left around a round post, whose cells "
        "grow outwards.",
    )
    spread = float(sizes.max() / sizes.min())
    return Finding(found.blocks, {**found.numbers, "cell_sizes": spread}, found.claims)


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
    )
]
