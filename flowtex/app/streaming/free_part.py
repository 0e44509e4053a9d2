"""The part of the view that panels of the page leave free."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations

from flowtex.camera import ViewPart

#: Left, top, right and bottom of what lies on the view, from 0 to 1 rightwards and downwards.
Cover = tuple[float, float, float, float]
#: Share of the whole view's scale below which a panel lies on the surface.
LEAST_SCALE = 0.4


def free_part(covers: Sequence[Cover], shape: float) -> ViewPart:
    """Return the free rectangle in which a surface is drawn at the largest scale.

    Parameters
    ----------
    covers
        What lies on the view.
    shape
        Width over height of the surface, where the view's own are 1.

    Returns
    -------
    ViewPart
        Where all free rectangles are small, the largest panel is taken to lie on the surface.
    """
    there = [cover for cover in covers if cover[0] < cover[2] and cover[1] < cover[3]]

    def merit(part: Cover) -> tuple[float, float]:
        width, height = part[2] - part[0], part[3] - part[1]
        return min(width / shape, height), width * height

    best = max(_free_parts(there), key=merit, default=(0.0, 0.0, 1.0, 1.0))
    if there and merit(best)[0] < LEAST_SCALE * min(1 / shape, 1):
        there.remove(max(there, key=lambda c: (c[2] - c[0]) * (c[3] - c[1])))
        return free_part(there, shape)
    left, top, right, bottom = best
    return (2 * left - 1, 1 - 2 * bottom, 2 * right - 1, 1 - 2 * top)


def _free_parts(covers: list[Cover]) -> Iterable[Cover]:
    """Rectangles without a cover; each that cannot be extended is among them."""
    edges = sorted({0.0, 1.0, *(min(max(c[k], 0.0), 1.0) for c in covers for k in (0, 2))})
    for left, right in combinations(edges, 2):
        top = 0.0
        across = sorted((c[1], c[3]) for c in covers if c[0] < right and c[2] > left)
        for start, end in (*across, (1.0, 1.0)):
            if start > top:
                yield left, top, right, min(start, 1.0)
            top = max(top, end)


def covers_of_pane(covers: Iterable[Cover], panes: int) -> list[Cover]:
    """Return what lies on any of several equal panes, laid on one."""
    return [
        (max(panes * left - n, 0.0), top, min(panes * right - n, 1.0), bottom)
        for left, top, right, bottom in covers
        for n in range(panes)
    ]
