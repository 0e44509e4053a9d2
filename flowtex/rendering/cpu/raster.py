"""The triangle that each pixel shows, and the weights of its corners.

Triangles are drawn in homogeneous coordinates of two dimensions (Olano and Greer 1997). The columns
(x, y, w) of the corners make a matrix M; b = M^-1 (px, py, 1) has the three weights over w of a
pixel, so a pixel is inside where none is negative, and corners mix by b over its sum 1 / w. A pixel
on an edge up to rounding is inside of both triangles, and belongs to the nearer, or the first.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field import Surface
from flowtex.rendering.camera import Camera

CHUNK = 1 << 20  #: Pixels, or rows of pixels, that are tested together.
ROUNDING = 1e-6  #: Pixels by which the rows and columns of a triangle may be off from rounding.
EPSILON = 8 * float(np.finfo(float).eps)  #: Rounding of a term of the edges' values.


@dataclass(frozen=True, eq=False)
class Coverage:
    """The pixels that show a triangle, N of them, from the top row down."""

    pixel: Indices  #: Number of the pixel, (N,): row times width plus column.
    corners: Indices  #: Numbers of the three points of its triangle, (N, 3).
    weights: Floats  #: Share of each corner at the middle of the pixel, in perspective, (N, 3).
    dx: Floats  #: Derivatives of the shares for a pixel to the right and a pixel down, (N, 3).
    dy: Floats
    cell: Indices  #: Place of its cell in scalars of cells, (N,): its first node, or the triangle.

    @property
    def nearest(self) -> Indices:
        """Number of the corner with the greatest share, (N,)."""
        greatest = self.weights.argmax(axis=1)[:, None]
        return np.take_along_axis(self.corners, greatest, axis=1)[:, 0]

    def mix(self, data: NDArray[np.floating]) -> tuple[Floats, Floats, Floats]:
        """Interpolate data of points, (P, C), to the pixels: values and derivatives, (N, C)."""
        return self.mix_corners(data.astype(float)[self.corners])

    def mix_corners(self, values: Floats) -> tuple[Floats, Floats, Floats]:
        """Interpolate values of the corners, (N, 3, C), as :meth:`mix` does."""
        shares = (self.weights, self.dx, self.dy)
        value, dx, dy = (np.einsum("nk,nkc->nc", share, values) for share in shares)
        return value, dx, dy


def cover(surface: Surface, camera: Camera, size: tuple[int, int]) -> Coverage:
    """Find the visible cells of a surface in a picture of some width and height in pixels."""
    points = (surface.points - surface.center).reshape(-1, 3)
    matrix = camera.matrix(size[0] / size[1], surface.center)
    clip = points @ matrix[:, :3].T + matrix[:, 3]
    coverage = rasterise(clip, surface.corners_of(surface.drawn), size)
    return replace(coverage, cell=surface.cells_of(surface.drawn[coverage.cell]))


def rasterise(clip: Floats, triangles: Indices, size: tuple[int, int]) -> Coverage:
    """Find the triangle in front at every pixel of a picture of some width and height, its cell.

    The points are in clip space, (P, 4), as :meth:`Camera.matrix` gives them; ``triangles`` has
    the numbers of three, (M, 3). Both sides are drawn; those without area are not.
    """
    width, height = size
    x = (clip[:, 0] + clip[:, 3]) * (0.5 * width)
    y = (clip[:, 3] - clip[:, 1]) * (0.5 * height)
    flat = np.stack([x, y, clip[:, 3]], axis=-1)
    numbers, edges, area, rows = _prepare(flat, triangles, size)
    triangles = triangles[numbers]
    slack = _slack(flat, triangles, size)
    depths = clip[:, 2][triangles] / area[:, None]
    nearest = np.full(width * height, np.inf)
    owner = np.full(width * height, -1, dtype=np.intp)
    for triangle, row, column in _candidates(edges, rows, width):
        shares = _at_pixels(edges[triangle], row, column)
        inside = (shares >= -slack[triangle]).all(axis=-1)
        triangle = triangle[inside]
        shares = shares[inside]
        pixel = row[inside] * width + column[inside]
        depth = np.einsum("nk,nk->n", shares, depths[triangle])
        closer = depth < nearest[pixel]
        pixel = pixel[closer]
        depth = depth[closer]
        triangle = triangle[closer]
        np.minimum.at(nearest, pixel, depth)
        first = np.flatnonzero(depth == nearest[pixel])[::-1]
        owner[pixel[first]] = triangle[first]
    pixel = np.flatnonzero(owner >= 0)
    owner = owner[pixel]
    inverse = edges[owner]
    shares = _at_pixels(inverse, *np.divmod(pixel, width))
    total = shares.sum(axis=-1, keepdims=True)
    weights = shares / total
    dx, dy = (
        (inverse[..., k] - weights * inverse[..., k].sum(axis=-1, keepdims=True)) / total
        for k in range(2)
    )
    return Coverage(pixel, triangles[owner], weights, dx, dy, numbers[owner])


def _prepare(
    flat: Floats, triangles: Indices, size: tuple[int, int]
) -> tuple[Indices, Floats, Floats, Indices]:
    """Return numbers of visible triangles, edges |det| M^-1 (M, 3, 3), determinants, and rows."""
    rows, seen = _rows(flat, triangles, size)
    triangles = triangles[seen]
    rows = rows[seen]
    a = flat[triangles[:, 0]]
    b = flat[triangles[:, 1]]
    c = flat[triangles[:, 2]]
    edges = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
    determinant = np.einsum("nk,nk->n", edges[:, 0], a)
    solid = np.abs(determinant) > _slack(flat, triangles, size).max(axis=-1)
    determinant = determinant[solid]
    edges = edges[solid] * np.sign(determinant)[:, None, None]
    return np.flatnonzero(seen)[solid], edges, np.abs(determinant), rows[solid]


def _slack(flat: Floats, triangles: Indices, size: tuple[int, int]) -> Floats:
    """Bound the rounding of the edges' values at pixels, (M, 3)."""
    most = np.abs(flat).max(axis=-1)[triangles]
    return np.asarray(np.roll(most, -1, -1) * np.roll(most, 1, -1) * (sum(size) * EPSILON))


def _rows(flat: Floats, triangles: Indices, size: tuple[int, int]) -> tuple[Indices, Bools]:
    """Return the first and last row of pixels of triangles, (M, 2), and a mask of those seen."""
    w = flat[:, 2]
    ahead = w > 0
    # A point behind the camera has no place in the picture; its triangle may be anywhere.
    position = np.divide(flat[:, :2], w[:, None], out=np.zeros((len(w), 2)), where=ahead[:, None])
    low = np.where(ahead[:, None], position, -np.inf)[triangles]
    high = np.where(ahead[:, None], position, np.inf)[triangles]
    low = low.min(axis=1)
    high = high.max(axis=1)
    first = np.ceil(np.clip(low - (0.5 + ROUNDING), 0, size))
    last = np.floor(np.clip(high - (0.5 - ROUNDING), -1, np.subtract(size, 1)))
    seen = (first <= last).all(axis=-1) & ahead[triangles].any(axis=-1)
    return np.stack([first[:, 1], last[:, 1]], axis=-1).astype(np.intp), seen


def _candidates(
    edges: Floats, rows: Indices, width: int
) -> Iterator[tuple[Indices, Indices, Indices]]:
    """Yield triangles with the rows and columns of pixels that may lie in them, in chunks."""
    for chunk in _chunks(rows[:, 1] - rows[:, 0] + 1):
        triangle, row = _spread(chunk.start, rows[chunk, 0], rows[chunk, 1])
        first, last = _columns(edges[triangle], row, width)
        for part in _chunks(np.maximum(last - first + 1, 0)):
            span, column = _spread(part.start, first[part], last[part])
            yield triangle[span], row[span], column


def _chunks(counts: Indices) -> Iterator[slice]:
    """Cut a list of counts into stretches that sum to about a chunk."""
    ends = np.cumsum(counts)
    start = 0
    while start < len(counts):
        if start:
            done = ends[start - 1]
        else:
            done = 0
        stop = max(int(np.searchsorted(ends, done + CHUNK, side="right")), start + 1)
        yield slice(start, stop)
        start = stop


def _spread(start: int, first: Indices, last: Indices) -> tuple[Indices, Indices]:
    """Count from first to last for each of a list; return which one, and the count."""
    counts = np.maximum(last - first + 1, 0)
    which = np.repeat(np.arange(len(counts)), counts)
    within = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    return which + start, first[which] + within


def _columns(edges: Floats, row: Indices, width: int) -> tuple[Indices, Indices]:
    """Return the first and last column in each row within all edges, one more on both sides."""
    slope = edges[..., 0]
    level = edges[..., 1] * (row + 0.5)[:, None] + edges[..., 2]
    with np.errstate(over="ignore"):
        zero = np.divide(-level, slope, out=np.zeros_like(level), where=slope != 0)
    low = np.where(slope > 0, zero, -1.0).max(axis=-1)
    high = np.where(slope < 0, zero, width + 1.0).min(axis=-1)
    first = np.floor(np.clip(low - 0.5, 0, width))
    last = np.ceil(np.clip(high - 0.5, -1, width - 1))
    return first.astype(np.intp), last.astype(np.intp)


def _at_pixels(edges: Floats, row: Indices, column: Indices) -> Floats:
    x = (column + 0.5)[:, None]
    y = (row + 0.5)[:, None]
    return np.asarray(edges[..., 0] * x + edges[..., 1] * y + edges[..., 2])
