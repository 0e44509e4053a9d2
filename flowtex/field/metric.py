"""Velocity from space into index space, through the metric of the surface.

A velocity v is projected onto the tangents P_i and P_j by solving the 2 x 2 metric system

    | P_i.P_i  P_i.P_j | | u_i |   | v.P_i |
    | P_i.P_j  P_j.P_j | | u_j | = | v.P_j |

for the contravariant components (u_i, u_j), in cells per unit of time (Forssell and Cohen 1995,
section 3). The part that is normal to the surface is left out; its share is returned.

At a pole all nodes of the line are one point and have one velocity, their mean. Each keeps the
component along its line, from which :meth:`flowtex.field.grids.poles.Pole.vector` restores
the whole, and the full speed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex._util.blocks import row_blocks
from flowtex._util.vectors import dot, norm
from flowtex.field.grids.poles import Pole, Poles
from flowtex.field.steps import Steps

#: Below this ratio of squared area to squared lengths a cell counts as collapsed.
COLLAPSED_AREA = 1e-10


@dataclass(frozen=True)
class IndexVelocity:
    """A velocity field in index space."""

    components: Steps  #: (u_i, u_j) in cells per unit of time, (T, J, I, 2).
    #: Length of the velocity along the surface in the mesh's units per unit of time, (T, J, I).
    speed: Steps
    #: Root mean square of the part out of the surface over that of the whole, 0 to 1.
    normal_share: float


def to_index_space(
    tangents: Floats, valid: Bools, poles: Poles | None, velocity: Floats
) -> IndexVelocity:
    """Express a velocity (T, J, I, 3), by tangents (2, J, I, 3) along i and j, in index space."""
    p_i, p_j = tangents
    square = np.einsum("djic,djic->ji", tangents, tangents)
    tiny = COLLAPSED_AREA * float(np.median(square if valid.all() else square[valid]))
    u, speed = np.empty((*velocity.shape[:-1], 2)), np.empty(velocity.shape[:-1])
    squares = np.zeros(2)
    for rows in row_blocks(*valid.shape):
        squares += _project(
            velocity[:, rows], p_i[rows], p_j[rows], valid[rows], tiny, u[:, rows], speed[:, rows]
        )
    for pole in poles or ():
        _at_pole(pole, velocity, u, speed)
    total, normal = squares
    return IndexVelocity(
        components=u,
        speed=speed,
        normal_share=float(np.sqrt(min(normal / total, 1.0))) if total > 0 else 0.0,
    )


def _project(
    velocity: Floats, p_i: Floats, p_j: Floats, valid: Bools, tiny: float, u: Floats, speed: Floats
) -> tuple[float, float]:
    """Write components and speed of nodes, and return squares of all and of the normal part."""
    g_ii, g_jj, g_ij = dot(p_i, p_i), dot(p_j, p_j), dot(p_i, p_j)
    determinant = g_ii * g_jj - g_ij**2
    along_i, along_j = dot(velocity, p_i), dot(velocity, p_j)
    flat = (determinant <= COLLAPSED_AREA * g_ii * g_jj) | (g_ii <= tiny) | (g_jj <= tiny)
    safe = np.where(flat, 1.0, determinant)
    u_i = np.where(flat, _alone(along_i, g_ii, tiny), (g_jj * along_i - g_ij * along_j) / safe)
    u_j = np.where(flat, _alone(along_j, g_jj, tiny), (g_ii * along_j - g_ij * along_i) / safe)
    u[..., 0], u[..., 1] = u_i, u_j
    along = u_i[..., None] * p_i + u_j[..., None] * p_j
    speed[:] = norm(along)
    np.subtract(velocity, along, out=along)
    all_, normal = (float((dot(v, v) * (~flat & valid)).sum()) for v in (velocity, along))
    return all_, normal


def _at_pole(pole: Pole, velocity: Floats, u: Floats, speed: Floats) -> None:
    """Write the velocity of a pole to its nodes."""
    v, u, speed = (pole.lines(a, 1) for a in (velocity, u, speed))
    mean = v[:, pole.line, :-1].mean(axis=1) @ pole.plane.T
    u[:, pole.line, :, 1 - pole.component] = 0.0
    u[:, pole.line, :, pole.component] = pole.along(mean @ pole.plane)
    speed[:, pole.line] = np.linalg.norm(mean, axis=-1)[:, None]


def _alone(along: Floats, square: Floats, tiny: float) -> Floats:
    """Return the component along one tangent where the other one has collapsed."""
    solid = square > tiny
    return np.asarray(np.where(solid, along / np.where(solid, square, 1.0), 0.0))
