"""The kind of lines along which a time-varying field is drawn.

Pathlines are the paths of particles; streamlines are the lines of the flow at one moment. Both are
the same in a steady field. Where the flow turns while a particle goes the length of a streak,
pathlines through neighbouring points cross, and the picture is speckle.
"""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Indices
from flowtex.field import FlowField
from flowtex.field.steps import LazySteps

#: Length of a streak as a share of the surface, and most change of velocity meanwhile, as a share.
STREAK_EXTENTS, MOST_CHANGE = 0.05, 0.5
#: Most nodes where it changes by more, as a share, for pathlines.
MOST_CHANGING = 0.05
#: Most nodes along each axis, and pairs of steps, by which a field is judged.
MOST_JUDGED = 100


def chosen_lines(field: FlowField, lines: str = "auto") -> str:
    """Return ``"pathlines"`` or ``"streamlines"``; with ``"auto"`` the data decide."""
    if lines != "auto":
        return lines
    return "streamlines" if changing_share(field) > MOST_CHANGING else "pathlines"


def changing_share(field: FlowField) -> float:
    """Return the share of nodes and times where the flow changes by half within a streak, 0 to 1.

    A streak lasts until a particle has moved by a twentieth of the surface. Of a large field some
    of the lines of nodes, and of the steps, are judged.
    """
    if field.steady:
        return 0.0
    j, i = judged_lines(field.shape)
    t = _sample(len(field.times) - 1, MOST_JUDGED)
    if isinstance(field.velocity, LazySteps):
        t = t[:1]
    valid = field.valid[np.ix_(j, i)]
    if not valid.any():
        return 0.0
    velocity = field.velocity[:, j[:, None], i]
    before, after = (np.asarray(velocity[steps])[:, valid] for steps in (t, t + 1))
    spans = (field.times[t + 1] - field.times[t])[:, None]
    change = np.linalg.norm(after - before, axis=-1) / spans
    square = np.sum((0.5 * (before + after)) ** 2, axis=-1)
    extent = float(np.linalg.norm(np.ptp(field.points[np.ix_(j, i)][valid], axis=0)))
    return float(np.mean(STREAK_EXTENTS * extent * change > MOST_CHANGE * square))


def judged_lines(shape: tuple[int, int]) -> tuple[Indices, Indices]:
    """Return the rows and columns of a field with nodes (J, I) by which it is judged."""
    rows, columns = shape
    # Nodes of triangles are one row.
    return _sample(rows, MOST_JUDGED), _sample(columns, MOST_JUDGED if rows > 1 else MOST_JUDGED**2)


def _sample(count: int, most: int) -> Indices:
    return np.arange(0, count, -(-count // most))
