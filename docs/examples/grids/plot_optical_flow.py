"""
Optical flow
============

How an image moves to the next one, by the method of Lucas and Kanade: around each place, the
velocity that best explains the change by the slopes. Here clouds turn around an eye. Where the
picture has no slope, as in the clear sky at the right, its motion is not known: streaks are
shorter and fainter.
"""

import numpy as np

import flowtex

y, x = np.mgrid[-1:1:128j, -1.5:1.5:192j]
random = np.random.default_rng(2)
waves = random.normal(0, 14, (60, 2))
turn = 0.03 * np.exp(-(x**2 + y**2) / 0.5)  # radians from one picture to the next


def clouds(angle: np.ndarray) -> np.ndarray:
    """Clouds after they have turned."""
    a, b = x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)
    ripples = sum(np.cos(k * (a + 1) + m * (b + 2)) for k, m in waves)
    return ripples / (1 + np.exp(12 * (a - 0.9)))


def around(values: np.ndarray, size: int = 7) -> np.ndarray:
    """Means over a square around each pixel."""
    for axis, count in enumerate(values.shape):
        places = np.arange(count) + np.arange(-size, size + 1)[:, None]
        values = values.take(np.clip(places, 0, count - 1), axis).mean(axis)
    return values


first, second = clouds(0 * x), clouds(turn)
down, right = np.gradient(0.5 * (first + second), y[:, 0], x[0])
aa, ab, bb = around(right * right), around(right * down), around(down * down)
at, bt = (around(slope * (second - first)) for slope in (right, down))
det = aa * bb - ab * ab + 1.0
velocity = np.stack([ab * bt - bb * at, ab * at - aa * bt], axis=-1) / det[..., None]
field = flowtex.FlowField.from_arrays((x[0], y[:, 0]), velocity, scalars={"picture": second})
flowtex.show(field, scalars="picture", cmap="gray", uncertainty=1 / (1 + 0.02 * det**0.5))
