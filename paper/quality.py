"""Measures of how well a picture shows a flow, computed from its pixels.

They compare methods of drawing. A picture is (H, W), or (H, W, 3), whose channels are averaged,
with row 0 at the top. The flow at each pixel is ``u`` to the right and ``v`` up, of any length.
``mask`` (H, W) selects the pixels to measure: by default those with a flow, except for a border of
:data:`BORDER` pixels.

References
----------
Angle and coherence are those of the structure tensor (J. Bigun and G. H. Granlund, Optimal
orientation detection of linear symmetry, ICCV 1987). Measures of this kind for flow textures are
discussed by V. Matvienko and J. Krüger (A metric for the evaluation of dense vector field
visualizations, IEEE TVCG 19(7), 2013).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Floats
from flowtex.errors import FieldError

#: Width of the border, in pixels, that is not measured by default.
BORDER = 12
#: Deviation in pixels of the derivative, and of the window over which directions are averaged.
EDGE_PIXELS, WINDOW_PIXELS = 1.0, 4.0
#: Shades wider than this many pixels are not grain.
SHADE_PIXELS = 20.0
#: Number of pixels at which grain is measured, and the largest distance.
GRAIN_POINTS, MAX_DISTANCE_PIXELS = 20_000, 64
#: Side in pixels of the window in which the sense is determined, and the percentile of the values
#: above which a pixel belongs to a stroke.
SENSE_WINDOW, STROKE_PERCENTILE = 29, 80


class Alignment(NamedTuple):
    """Direction of a texture: its mean angle to the flow in degrees, and its coherence.

    Examples
    --------
    >>> from paper.quality import Alignment
    >>> Alignment(1.9, 0.97).coherence
    0.97
    """

    angle: float
    coherence: float


class Grain(NamedTuple):
    """Distances in pixels, along and across the flow, at which the correlation is 0.5.

    Examples
    --------
    >>> from paper.quality import Grain
    >>> Grain(15.1, 1.2).along
    15.1
    """

    along: float
    across: float


def alignment(
    picture: ArrayLike,
    u: ArrayLike,
    v: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    window: float = WINDOW_PIXELS,
) -> Alignment:
    """Compare the direction of streaks with that of the flow.

    The direction is that of the structure tensor: the mean, over a Gaussian window, of the outer
    product of the gradient with itself. Its coherence is 1 for parallel lines and 0 for noise.

    Parameters
    ----------
    picture
        The picture, (H, W) or (H, W, 3); NaN outside the flow.
    u, v
        The flow, (H, W) each.
    mask
        Pixels to measure, (H, W).
    window
        Standard deviation of the window, in pixels.

    Returns
    -------
    Alignment
        Mean angle, 0 to 90 degrees, and mean coherence, 0 to 1.

    Raises
    ------
    FieldError
        When the shapes of the arrays differ, or no pixel is left to measure.

    Examples
    --------
    >>> import numpy as np
    >>> from paper.quality import alignment
    >>> stripes = np.sin(np.arange(80.0))[:, None] * np.ones((80, 100))
    >>> found = alignment(stripes, np.ones((80, 100)), np.zeros((80, 100)))
    >>> round(found.angle), round(found.coherence, 2)
    (0, 1.0)
    """
    filled, u, v, mask = _checked(picture, u, v, mask)
    gx = scipy.ndimage.gaussian_filter(filled, EDGE_PIXELS, order=(0, 1))
    gy = scipy.ndimage.gaussian_filter(filled, EDGE_PIXELS, order=(1, 0))
    # As complex numbers of twice the angle, which are the same for opposite directions.
    square, product = (
        scipy.ndimage.gaussian_filter(part, window) for part in (gx * gx - gy * gy, gx * gy)
    )
    turned = square + 2j * product
    energy = scipy.ndimage.gaussian_filter(gx * gx + gy * gy, window)
    flow = np.square(u - 1j * v)  # rows go down, v goes up
    with np.errstate(invalid="ignore"):
        between = np.abs(np.angle(-turned * np.conj(flow))) / 2
    coherence = np.abs(turned) / np.maximum(energy, np.finfo(float).tiny)
    return Alignment(float(np.degrees(between[mask].mean())), float(coherence[mask].mean()))


def grain(
    picture: ArrayLike, u: ArrayLike, v: ArrayLike, mask: ArrayLike | None = None, *, seed: int = 0
) -> Grain:
    """Measure the length of streaks along the flow, which may be curved, and their width.

    Parameters
    ----------
    picture, u, v, mask
        As for :func:`alignment`.
    seed
        Seed of the choice of pixels at which the grain is measured.

    Returns
    -------
    Grain
        Length and width in pixels, at most 64.

    Raises
    ------
    FieldError
        As for :func:`alignment`.

    Examples
    --------
    >>> import numpy as np
    >>> from paper.quality import grain
    >>> stripes = np.sin(np.arange(80.0))[:, None] * np.ones((80, 100))
    >>> found = grain(stripes, np.ones((80, 100)), np.zeros((80, 100)))
    >>> found.along, round(found.across, 1)
    (64.0, 1.0)
    """
    filled, u, v, mask = _checked(picture, u, v, mask)
    flat = filled - scipy.ndimage.gaussian_filter(filled, SHADE_PIXELS)
    rows, columns = np.nonzero(mask)
    pick = np.random.default_rng(seed).integers(0, len(rows), min(GRAIN_POINTS, 4 * len(rows)))
    start = np.stack([rows[pick], columns[pick]]).astype(float)
    length = np.maximum(np.hypot(u, v), np.finfo(float).tiny)
    right, down = u / length, -v / length
    return Grain(
        _half_width(flat, start, np.stack([down, right])),
        _half_width(flat, start, np.stack([right, -down])),
    )


def _half_width(flat: Floats, start: Floats, direction: Floats) -> float:
    """Distance at which the mean product with the value at the start is half the mean square.

    Lines are followed from ``start``, (2, N) as (row, column), along unit vectors (2, H, W).
    """
    first_values = scipy.ndimage.map_coordinates(flat, start, order=1, mode="nearest")
    power = float(np.mean(first_values * first_values))
    if power == 0:
        return float(MAX_DISTANCE_PIXELS)
    position, distance, before = start.copy(), 0.0, 1.0
    while distance < MAX_DISTANCE_PIXELS:
        # Quarters of a pixel close by, where fine grain falls quickly; coarser steps farther off.
        step = 0.25 if distance < 4 else 1.0
        nearest = np.rint(position).astype(np.intp)
        row, column = (np.clip(nearest[a], 0, flat.shape[a] - 1) for a in (0, 1))
        position = position + step * direction[:, row, column]
        values = scipy.ndimage.map_coordinates(flat, position, order=1, mode="nearest")
        correlation = float(np.mean(first_values * values)) / power
        if correlation < 0.5:
            return distance + step * (before - 0.5) / (before - correlation)
        distance, before = distance + step, correlation
    return float(MAX_DISTANCE_PIXELS)


def sense(picture: ArrayLike, u: ArrayLike, v: ArrayLike, mask: ArrayLike | None = None) -> float:
    """Return the share of the pixels of strokes that show the sense of the flow.

    A stroke with a head brightens slowly towards the head and ends there, so along the flow the
    picture has few but large steps downward: the cube of the derivative, averaged over a window, is
    negative. Dense streaks without heads give 0.5, strokes that point backward 0.

    Parameters
    ----------
    picture, u, v, mask
        As for :func:`alignment`; strokes are brighter than the background.

    Returns
    -------
    float
        Share of the pixels of strokes, from 0 to 1.

    Raises
    ------
    FieldError
        As for :func:`alignment`.

    Examples
    --------
    >>> import numpy as np
    >>> from paper.quality import sense
    >>> ramps = np.tile((np.arange(120) % 20) ** 2, (90, 1))
    >>> ones, zeros = np.ones((90, 120)), np.zeros((90, 120))
    >>> sense(ramps, ones, zeros), sense(ramps, -ones, zeros)
    (1.0, 0.0)
    """
    filled, u, v, mask = _checked(picture, u, v, mask)
    length = np.maximum(np.hypot(u, v), np.finfo(float).tiny)
    down, right = np.gradient(filled)
    along = (right * u - down * v) / length
    edges = ~np.isfinite(np.atleast_3d(picture)).all(axis=-1)
    along[scipy.ndimage.binary_dilation(edges, iterations=2)] = 0.0
    cubes = scipy.ndimage.uniform_filter(along**3, SENSE_WINDOW)
    strokes = mask & (filled > np.percentile(filled[mask], STROKE_PERCENTILE))
    return float((cubes[strokes] < 0).mean()) if strokes.any() else 0.5


def sticking(
    first: ArrayLike, second: ArrayLike, dx: ArrayLike, dy: ArrayLike, mask: ArrayLike | None = None
) -> float:
    """Return how well a texture moves as it should from one picture to the next.

    Parameters
    ----------
    first, second
        The pictures, (H, W) or (H, W, 3).
    dx, dy
        Displacement of the point that each pixel of the second picture shows, in pixels to the
        right and down: (H, W), or numbers, as of the surface under a moving camera, or of the flow.
    mask
        Pixels to measure, (H, W).

    Returns
    -------
    float
        Correlation of the first picture, moved, with the second, from -1 to 1.

    Raises
    ------
    FieldError
        As for :func:`alignment`.

    Examples
    --------
    >>> import numpy as np
    >>> from paper.quality import sticking
    >>> noise = np.random.default_rng(0).random((60, 80))
    >>> round(sticking(noise, np.roll(noise, 3, axis=1), 3, 0), 2)
    1.0
    """
    a, b = _pair(first=first, second=second)
    ones = np.ones(a.shape)
    _, dx, dy, mask = _checked(
        b, np.multiply(dx, ones), np.multiply(dy, ones), ones > 0 if mask is None else mask
    )
    rows, columns = np.indices(a.shape)
    place = [rows - dy, columns - dx]
    inside = mask & (place[0] >= 0) & (place[0] <= a.shape[0] - 1)
    inside &= (place[1] >= 0) & (place[1] <= a.shape[1] - 1)
    moved = scipy.ndimage.map_coordinates(a, place, order=1, mode="nearest")
    return float(np.corrcoef(moved[inside], b[inside])[0, 1])


def aliasing(picture: ArrayLike, reference: ArrayLike, mask: ArrayLike | None = None) -> float:
    """Return the error relative to a picture with many samples per pixel.

    Parameters
    ----------
    picture, reference
        The picture, and the same view whose pixels are the means of many, (H, W) or (H, W, 3).
    mask
        Pixels to measure, (H, W).

    Returns
    -------
    float
        Root mean square error over the standard deviation of the reference; 0 if both agree.

    Raises
    ------
    FieldError
        As for :func:`alignment`.

    Examples
    --------
    >>> import numpy as np
    >>> from paper.quality import aliasing
    >>> noise = np.random.default_rng(0).random((60, 80))
    >>> aliasing(noise, noise)
    0.0
    """
    a, b = _pair(picture=picture, reference=reference)
    ones = np.ones(a.shape)
    mask = _checked(b, ones, ones, ones > 0 if mask is None else mask)[3]
    error = a[mask] - b[mask]
    return float(np.sqrt(np.mean(error**2)) / max(float(b[mask].std()), 1e-12))


def spacing(points: ArrayLike) -> float:
    """Return how unevenly marks such as arrows are spaced.

    Parameters
    ----------
    points
        Positions of the marks on the screen, (N, 2), at least two.

    Returns
    -------
    float
        Standard deviation of the distances to the nearest other mark, over their mean: 0 for a
        grid, about 0.5 for random marks.

    Raises
    ------
    FieldError
        When the points have another shape, or are fewer than two.

    Examples
    --------
    >>> import numpy as np
    >>> from paper.quality import spacing
    >>> spacing(np.stack(np.meshgrid(range(5), range(4)), axis=-1).reshape(-1, 2))
    0.0
    """
    places = np.asarray(points, dtype=float)
    if places.ndim != 2 or places.shape[1] != 2 or len(places) < 2 or not np.isfinite(places).all():
        msg = f"points has shape {places.shape}; expected (N, 2), two or more finite points"
        raise FieldError(msg)
    nearest = np.asarray(scipy.spatial.cKDTree(places).query(places, k=2)[0])[:, 1]
    return float(nearest.std() / max(nearest.mean(), np.finfo(float).tiny))


def _grey(name: str, picture: ArrayLike) -> Floats:
    """Return the mean of the channels; missing values are replaced by the mean of all."""
    array = np.asarray(picture)
    if array.dtype.kind not in "biuf" or array.ndim not in (2, 3) or array.size == 0:
        msg = (
            f"{name} is {array.dtype} of shape {array.shape}; expected numbers of shape (H, W) or "
            "(H, W, 3)"
        )
        raise FieldError(msg)
    grey = array.astype(float) if array.ndim == 2 else array[..., :3].mean(axis=-1)
    missing = ~np.isfinite(grey)
    if missing.all():
        msg = f"{name} is NaN everywhere; expected a picture"
        raise FieldError(msg)
    # Filters would spread missing values.
    return np.where(missing, np.mean(grey[~missing]), grey) if missing.any() else grey


def _pair(**pictures: ArrayLike) -> tuple[Floats, Floats]:
    (name, first), (other_name, second) = pictures.items()
    a, b = _grey(name, first), _grey(other_name, second)
    if a.shape != b.shape:
        msg = f"{name} has shape {a.shape} and {other_name} {b.shape}; expected the same"
        raise FieldError(msg)
    return a, b


def _checked(
    picture: ArrayLike, u: ArrayLike, v: ArrayLike, mask: ArrayLike | None
) -> tuple[Floats, Floats, Floats, Bools]:
    grey = _grey("picture", picture)
    u, v = np.asarray(u, dtype=float), np.asarray(v, dtype=float)
    for name, array in {"u": u, "v": v, "mask": np.asarray(mask)}.items():
        if array.shape != grey.shape and not (name == "mask" and mask is None):
            msg = f"{name} has shape {array.shape}; expected {grey.shape}, as the picture has"
            raise FieldError(msg)
    if mask is None:
        inside = np.zeros(grey.shape, bool)
        inside[BORDER:-BORDER, BORDER:-BORDER] = True
        mask = inside & (np.hypot(u, v) > 0)
    has_flow = np.isfinite(u) & np.isfinite(v)
    measured = np.asarray(mask, dtype=bool) & has_flow
    if not measured.any():
        msg = "mask is False everywhere; expected pixels to judge"
        raise FieldError(msg)
    return grey, np.where(has_flow, u, 0.0), np.where(has_flow, v, 0.0), measured
