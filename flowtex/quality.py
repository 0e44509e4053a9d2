"""Measures of how well a picture shows a flow, computed from its pixels.

They compare methods of drawing, and settings. A picture is (H, W), or (H, W, 3), whose channels are
averaged, with row 0 at the top. The flow at each pixel is ``u`` to the right and ``v`` up, of any
length.
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
EDGE_PIXELS = 1.0  #: Standard deviation in pixels of the derivative.
#: Standard deviation in pixels of the window over which directions are averaged.
WINDOW_PIXELS = 4.0
#: Shades wider than this many pixels are not grain.
SHADE_PIXELS = 20.0
GRAIN_POINTS = 20_000  #: Number of pixels at which grain is measured.
MAX_DISTANCE_PIXELS = 64  #: Greatest length and width of grain in pixels.
NEAR_PIXELS = 4.0  #: Distance up to which grain is measured in steps of a quarter of a pixel.
SENSE_WINDOW = 29  #: Side in pixels of the window in which the direction of strokes is determined.
STROKE_PERCENTILE = 80  #: Percentile of the values above which a pixel belongs to a stroke.
#: Standard deviation in pixels of the blur that leaves the clouds of a picture.
CLOUD_PIXELS = 12.0


class Alignment(NamedTuple):
    """Direction of a texture: its mean angle to the flow in degrees, and its coherence.

    Examples
    --------
    >>> from flowtex.quality import Alignment
    >>> Alignment(1.9, 0.97).coherence
    0.97
    """

    angle: float
    coherence: float


class Grain(NamedTuple):
    """Distances in pixels, along and across the flow, at which the correlation is 0.5.

    Examples
    --------
    >>> from flowtex.quality import Grain
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
    >>> from flowtex.quality import alignment
    >>> stripes = np.sin(np.arange(80.0))[:, None] * np.ones((80, 100))
    >>> found = alignment(stripes, np.ones((80, 100)), np.zeros((80, 100)))
    >>> round(found.angle), round(found.coherence, 2)
    (0, 1.0)
    """
    filled, u, v, mask = _checked(picture, u, v, mask)
    gx = scipy.ndimage.gaussian_filter(filled, EDGE_PIXELS, order=(0, 1))
    gy = scipy.ndimage.gaussian_filter(filled, EDGE_PIXELS, order=(1, 0))
    # As complex numbers of twice the angle, which are the same for opposite directions.
    square = scipy.ndimage.gaussian_filter(gx * gx - gy * gy, window)
    product = scipy.ndimage.gaussian_filter(gx * gy, window)
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
    >>> from flowtex.quality import grain
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
    right = u / length
    down = -v / length
    along = _half_width(flat, start, np.stack([down, right]))
    across = _half_width(flat, start, np.stack([right, -down]))
    return Grain(along, across)


def _half_width(flat: Floats, start: Floats, direction: Floats) -> float:
    """Return the distance at which the mean product with the first value is half the mean square.

    Lines are followed from ``start``, (2, N) as (row, column), along unit vectors (2, H, W).
    """
    first_values = scipy.ndimage.map_coordinates(flat, start, order=1, mode="nearest")
    power = float(np.mean(first_values * first_values))
    if power == 0:
        return float(MAX_DISTANCE_PIXELS)
    position = start.copy()
    distance = 0.0
    before = 1.0
    while distance < MAX_DISTANCE_PIXELS:
        # The correlation of fine grain falls quickly.
        step = 1.0
        if distance < NEAR_PIXELS:
            step = 0.25
        nearest = np.rint(position).astype(np.intp)
        row = np.clip(nearest[0], 0, flat.shape[0] - 1)
        column = np.clip(nearest[1], 0, flat.shape[1] - 1)
        position = position + step * direction[:, row, column]
        values = scipy.ndimage.map_coordinates(flat, position, order=1, mode="nearest")
        correlation = float(np.mean(first_values * values)) / power
        if correlation < 0.5:
            return distance + step * (before - 0.5) / (before - correlation)
        distance = distance + step
        before = correlation
    return float(MAX_DISTANCE_PIXELS)


def sense(picture: ArrayLike, u: ArrayLike, v: ArrayLike, mask: ArrayLike | None = None) -> float:
    """Return the share of the pixels of strokes that show the direction of the flow.

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
    >>> from flowtex.quality import sense
    >>> ramps = np.tile((np.arange(120) % 20) ** 2, (90, 1))
    >>> ones = np.ones((90, 120))
    >>> zeros = np.zeros((90, 120))
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
    if not strokes.any():
        return 0.5
    return float((cubes[strokes] < 0).mean())


def cloud(picture: ArrayLike, mask: ArrayLike | None = None) -> float:
    """Return how uneven the texture of a picture is on a large scale.

    A texture that is brighter in some places than in others looks cloudy. The picture is blurred
    over 12 pixels, which leaves the clouds and removes the grain; pixels outside the mask have no
    part in it.

    Parameters
    ----------
    picture
        The picture, (H, W) or (H, W, 3), without colours and shading that are not part of the
        texture.
    mask
        Pixels to measure, (H, W); all by default.

    Returns
    -------
    float
        Standard deviation of the blurred picture over that of the picture: 0 for an even texture.

    Raises
    ------
    FieldError
        When the mask has another shape than the picture, or no pixel is left to measure.

    Examples
    --------
    >>> import numpy as np
    >>> from flowtex.quality import cloud
    >>> stripes = np.sin(np.arange(80.0))[:, None] * np.ones((80, 100))
    >>> shade = np.linspace(-1, 1, 100)
    >>> round(cloud(stripes), 2), round(cloud(stripes + shade), 1)
    (0.03, 0.6)
    """
    grey = _grey("picture", picture)
    ones = np.ones(grey.shape)
    if mask is None:
        mask = ones > 0
    inside = _checked(grey, ones, ones, mask)[3]
    detail = np.where(inside, grey - grey[inside].mean(), 0.0)
    share = scipy.ndimage.gaussian_filter(inside.astype(float), CLOUD_PIXELS)
    blurred = scipy.ndimage.gaussian_filter(detail, CLOUD_PIXELS)[inside] / share[inside]
    deviation = float(detail[inside].std())
    if deviation == 0:
        return 0.0
    return float(blurred.std()) / deviation


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
    >>> from flowtex.quality import sticking
    >>> noise = np.random.default_rng(0).random((60, 80))
    >>> round(sticking(noise, np.roll(noise, 3, axis=1), 3, 0), 2)
    1.0
    """
    a, b = _pair(first=first, second=second)
    ones = np.ones(a.shape)
    if mask is None:
        mask = ones > 0
    _, dx, dy, mask = _checked(b, np.multiply(dx, ones), np.multiply(dy, ones), mask)
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
    >>> from flowtex.quality import aliasing
    >>> noise = np.random.default_rng(0).random((60, 80))
    >>> aliasing(noise, noise)
    0.0
    """
    a, b = _pair(picture=picture, reference=reference)
    ones = np.ones(a.shape)
    if mask is None:
        mask = ones > 0
    mask = _checked(b, ones, ones, mask)[3]
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
    >>> from flowtex.quality import spacing
    >>> spacing(np.stack(np.meshgrid(range(5), range(4)), axis=-1).reshape(-1, 2))
    0.0
    """
    places = np.asarray(points, dtype=float)
    if places.ndim != 2 or places.shape[1] != 2 or len(places) < 2 or not np.isfinite(places).all():
        raise FieldError(
            f"points has shape {places.shape}; expected (N, 2), two or more finite points"
        )
    nearest = np.asarray(scipy.spatial.cKDTree(places).query(places, k=2)[0])[:, 1]
    return float(nearest.std() / max(nearest.mean(), np.finfo(float).tiny))


def _grey(name: str, picture: ArrayLike) -> Floats:
    """Return the mean of the channels; missing values are replaced by the mean of all."""
    array = np.asarray(picture)
    if array.dtype.kind not in "biuf" or array.ndim not in (2, 3) or array.size == 0:
        raise FieldError(
            f"{name} is {array.dtype} of shape {array.shape}; expected numbers of shape (H, W) or "
            "(H, W, 3)"
        )
    if array.ndim == 2:
        grey = array.astype(float)
    else:
        grey = array[..., :3].mean(axis=-1)
    missing = ~np.isfinite(grey)
    if missing.all():
        raise FieldError(f"{name} is NaN everywhere; expected a picture")
    if not missing.any():
        return grey
    # Filters would spread missing values.
    return np.where(missing, np.mean(grey[~missing]), grey)


def _pair(**pictures: ArrayLike) -> tuple[Floats, Floats]:
    """Return two pictures as grey values of the same shape."""
    (name, first), (other_name, second) = pictures.items()
    a = _grey(name, first)
    b = _grey(other_name, second)
    if a.shape != b.shape:
        raise FieldError(
            f"{name} has shape {a.shape} and {other_name} {b.shape}; expected the same"
        )
    return a, b


def _checked(
    picture: ArrayLike, u: ArrayLike, v: ArrayLike, mask: ArrayLike | None
) -> tuple[Floats, Floats, Floats, Bools]:
    """Return a picture as grey values, the flow, and the pixels to measure, of one shape."""
    grey = _grey("picture", picture)
    right = np.asarray(u, dtype=float)
    up = np.asarray(v, dtype=float)
    arrays = {"u": right, "v": up}
    if mask is not None:
        arrays["mask"] = np.asarray(mask)
    for name, array in arrays.items():
        if array.shape != grey.shape:
            raise FieldError(
                f"{name} has shape {array.shape}; expected {grey.shape}, as the picture has"
            )
    if mask is None:
        inside = np.zeros(grey.shape, bool)
        inside[BORDER:-BORDER, BORDER:-BORDER] = True
        mask = inside & (np.hypot(right, up) > 0)
    has_flow = np.isfinite(right) & np.isfinite(up)
    measured = np.asarray(mask, dtype=bool) & has_flow
    if not measured.any():
        raise FieldError("no pixel is left to measure; expected a mask that is True somewhere")
    return grey, np.where(has_flow, right, 0.0), np.where(has_flow, up, 0.0), measured
