"""Where a flow crosses the surface: what is left of it along the surface may be rounding or noise.

On the inlet of a box the velocity along the surface is a small difference of large numbers, so its
direction says nothing. Streaks fade there. Slow flow that does not cross the surface, such as a
boundary layer, keeps its streaks, and so does slow flow along a surface that all flow crosses, such
as the secondary flow in a section of a pipe.
"""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats
from flowtex._util.arrays import norm, smoothstep
from flowtex.field import FlowField
from flowtex.field.steps import LazySteps

#: Speed along the surface, over the typical one there and over the whole speed at the place, below
#: which streaks fade if both are less.
FADING_SHARE = 0.02
#: Speed along the surface over the whole speed below which it is rounding of single precision.
ROUNDING_SHARE = 2e-6


def shown_speed(field: FlowField, step: int, typical: float) -> Floats:
    """Return the speed along the surface over the typical one, (J, I), for renderers.

    Where streaks fade it is the share by which they do, with a negative sign.
    """
    along = np.asarray(field.index_velocity.speed[step])
    shown = along / typical
    is_flat = isinstance(field.velocity, LazySteps) and not field.leaves_surface
    if is_flat or field.sign_free:
        return shown
    whole = norm(np.asarray(field.velocity[step]))
    share = np.divide(along, whole, out=np.ones_like(whole), where=whole > 0)
    few = np.flatnonzero((np.minimum(shown, share) < FADING_SHARE).ravel())
    low_share = share.ravel()[few]
    clear = smoothstep(0.0, FADING_SHARE, np.maximum(shown.ravel()[few], low_share))
    clear *= smoothstep(0.0, ROUNDING_SHARE, low_share)
    faded = few[clear < 1.0]
    shown.ravel()[faded] = clear[clear < 1.0] - 1.0
    return shown
