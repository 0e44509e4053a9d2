"""The picture at the head of the page."""

from __future__ import annotations

import numpy as np

from paper.bench import Bench
from paper.findings import Panel
from paper.shots import shoot, tone

__all__ = ["title_picture"]

#: Time step of the vortices, the colour map, and its part that is used.
STEP, COLOURS, PART = 24, "viridis", (0.12, 0.95)


def title_picture(bench: Bench) -> Panel:
    """Draw a wide view of the vortices, coloured by speed."""
    import matplotlib as mpl

    size = bench.pick((1240, 420), (400, 136))
    shot = shoot(bench, bench.vortex, size, zoom=size[0] / size[1] / 0.92, step=STEP)
    speed = shot.speed
    share = np.clip(speed / np.quantile(speed, 0.98), 0, 1)
    colour = mpl.colormaps[COLOURS](PART[0] + (PART[1] - PART[0]) * share)[..., :3]
    image = tone(shot.picture(samples=31).value, colour)
    return Panel(image, "The vortex field, coloured by speed: every streak is a pathline.")
