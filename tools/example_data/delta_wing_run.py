"""Upper side of a winged body, in the manner of an orbiter, and a flow along it, in closed form.

    s = -1 ... 1   from the left edge over the back to the right edge
    t = 0 ... 1    from the nose to the tail

The half span grows from a blunt nose along a slender body and spreads into delta wings. A ridge
along the middle is the body; the wings are thin and fall off to a sharp edge. Nodes crowd at the
nose, in the middle and at the edges.

The flow is the stream's part along the surface, and what the vortices above the leading edges
add to it: outwards on the inner part of each wing, inwards towards its edge, so that it parts on
one line and meets on another, as in pictures of oil flow on delta wings.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from packing import save

from flowtex._util.array_types import Floats
from flowtex.examples._shipped import DATA, DELTA_WING

#: Nodes across and along the body.
SHAPE = (52, 62)

#: Half span at the nose, of the body, and at the tail; where along the body the wings begin.
NOSE, BODY, SPAN, WINGS = 0.012, 0.085, 0.46, 0.34
#: Length over which the nose widens, and over which it rises.
BLUNT, RISE = 0.22, 0.3
#: Height of the body and thickness of the wings; how much the nodes crowd in the middle.
HEIGHT, THICK, CROWDED = 0.11, 0.035, 2.2
#: Strength of the vortices, and angle of the stream to the body, in degrees.
SWIRL, INCIDENCE = 2.0, 12.0


def run(shape: tuple[int, int] = SHAPE) -> tuple[Floats, Floats]:
    """Compute nodes (J, I, 3) and velocity (J, I, 3); j across and i along the body."""
    rows, columns = shape
    across, along = np.linspace(-1.0, 1.0, rows), np.linspace(0.0, 1.0, columns)
    s = np.sign(across) * _crowded(np.abs(across))
    t = 0.25 * along + 0.75 * along**2
    points = _place(s[:, None], t[None, :])
    return points, _velocity(s[:, None], t[None, :])


def _crowded(x: Floats) -> Floats:
    """Take 0 ... 1 to itself with steps that are small at both ends."""
    return np.asarray(0.5 + 0.5 * np.tanh(CROWDED * (x - 0.5)) / np.tanh(CROWDED / 2))


def _half_span(t: Floats) -> Floats:
    """Return the half span at a distance from the nose."""
    blunt = np.minimum(t / BLUNT, 1.0)
    body = NOSE + (BODY - NOSE) * np.sqrt(blunt * (2.0 - blunt))
    wing = np.maximum(t - WINGS, 0.0) / (1.0 - WINGS)
    return np.asarray(body + (SPAN - BODY) * wing**1.35)


def _place(s: Floats, t: Floats) -> Floats:
    """Return points of the surface, (..., 3)."""
    half = _half_span(t)
    y = s * half
    rise = np.clip(t / RISE, 0.0, 1.0)
    nose = np.sqrt(rise * (2.0 - rise))
    tail = 1.0 - 0.35 * np.clip((t - 0.7) / 0.3, 0.0, 1.0) ** 2
    ridge = HEIGHT * nose * tail * np.exp(-((y / 0.075) ** 2))
    z = ridge + THICK * nose * (1.0 - s * s) - 0.02 * nose
    return np.stack(np.broadcast_arrays(t + 0.0 * s, y, z), axis=-1)


def _velocity(s: Floats, t: Floats) -> Floats:
    """Return the flow along the surface, (..., 3)."""
    step = 1e-5
    # At the nose itself the surface stands upright: the slope is taken a little behind it.
    t = np.maximum(t, 2 * step)
    along = (_place(s, t + step) - _place(s, t - step)) / step
    across = (_place(s + step, t) - _place(s - step, t)) / step
    normal = np.cross(along, across)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    angle = np.radians(INCIDENCE)
    stream = np.array([np.cos(angle), 0.0, np.sin(angle)])
    stream = stream - np.sum(stream * normal, axis=-1, keepdims=True) * normal
    outward = across / np.linalg.norm(across, axis=-1, keepdims=True)
    # Outwards on the body and the inner wing, inwards beside the edge, nothing on the edge itself.
    wing = np.clip((t - WINGS) / (1.0 - WINGS), 0.0, 1.0) ** 0.7
    side = np.sin(np.pi * s) * (0.62 - np.abs(s)) * (1.0 + 1.6 * np.abs(s))
    return np.asarray(stream + (SWIRL * wing * side)[..., None] * outward)


def write(folder: Path | None = None) -> None:
    """Compute and write the file."""
    points, velocity = run()
    arrays = {"points": points.astype(np.float32), "velocity": velocity.astype(np.float32)}
    save((folder or DATA) / DELTA_WING, arrays)
