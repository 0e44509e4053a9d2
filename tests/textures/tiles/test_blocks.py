"""Where a coarser level shows the same: cells are larger there, and the root has fewer nodes."""

from __future__ import annotations

import numpy as np
import pytest
from triangle_meshes import sphere

from flowtex._util.array_types import Floats, Indices
from flowtex.field import FlowField
from flowtex.field.triangles.triangle_nodes import triangle_normals
from flowtex.textures.tiles import blocks
from flowtex.textures.tiles.blocks import BLOCK_CELLS, SMOOTH_CELLS
from flowtex.textures.tiles.grid_pyramid import GridPyramid
from flowtex.textures.tiles.triangle_pyramid import TrianglePyramid
from flowtex.trace.trace import trace

#: Nodes along x and y.
NODES = (385, 257)
Y, X = np.mgrid[0:1:257j, 0:1.5:385j]
#: Node in the middle of one of the blocks of the first coarser level, of 2 x 3.
BESIDE = (1, 2)
AT = tuple(2 * BLOCK_CELLS * at + BLOCK_CELLS for at in BESIDE)


def gyre() -> Floats:
    """Return the velocity of streamfunction sin(pi x) sin(pi y)."""
    u = -np.pi * np.sin(np.pi * X) * np.cos(np.pi * Y)
    return np.stack([u, np.pi * np.cos(np.pi * X) * np.sin(np.pi * Y)], -1)


def field(velocity: Floats | None = None, z: Floats | float = 0.0, **given: object) -> FlowField:
    points = np.stack([X, Y, z + 0 * X], -1)
    flow = gyre() if velocity is None else velocity
    return FlowField.from_arrays(points, flow, **given)  # type: ignore[arg-type]


def test_root_of_smooth_field_is_coarse_and_keeps_its_streamlines() -> None:
    pyramid = GridPyramid(field())
    assert pyramid.depth == 2 and (pyramid.enlarged(2) > 2).all()
    root = pyramid.root
    slices = trace(root, progress=False)
    step = root.points[0, 1, 0]
    start = np.sin(np.pi * root.points[..., 0]) * np.sin(np.pi * root.points[..., 1])
    inside = slices.lags[:, None, None] < slices.reach[0]
    x, y = np.moveaxis((slices.nodes + slices.displacement[0]) * step, -1, 0)
    change = np.abs(np.sin(np.pi * x) * np.sin(np.pi * y) - start)
    # Away from its streamline by less than a seventh of a cell of the root.
    assert inside.mean() > 0.5 and change[inside].max() < 0.15 * step * np.pi


def vortex() -> FlowField:
    flow, (j, i) = gyre(), AT
    flow[j - 2 : j + 3, i - 2 : i + 3] *= -1
    return field(flow)


def blank() -> FlowField:
    valid = np.ones(X.shape, dtype=bool)
    valid[AT] = False
    return field(valid=valid)


def scalar() -> FlowField:
    spot = 0 * X
    spot[AT] = 1
    return field(scalars={"spot": spot, "even": 0 * X + 1 / 3})


def bump() -> FlowField:
    z = 0 * X
    z[AT] = 1 / 256
    return field(z=z)


@pytest.mark.parametrize("make", [vortex, blank, scalar, bump])
def test_only_block_with_detail_is_refined_as_before(make: object) -> None:
    pyramid = GridPyramid(make())  # type: ignore[operator]
    for level in (1, 2):
        factors = pyramid.enlarged(level)
        rough = BESIDE if level == 1 else (BESIDE[0] // 2, BESIDE[1] // 2)
        assert factors[rough] == 1
        assert (np.delete(factors.ravel(), np.ravel_multi_index(rough, factors.shape)) > 2).all()


def test_noise_and_series_have_the_usual_root() -> None:
    noise = np.random.default_rng(1).normal(size=(*X.shape, 2))
    series = np.stack([gyre(), 2 * gyre()])
    for flow in (noise, series):
        pyramid = GridPyramid(field(flow))
        assert pyramid.depth == 0 and (pyramid.enlarged(0) == 1).all()


def test_thin_cells_beside_long_ones_may_bend() -> None:
    # Rows close to one another turn within a part of the length of a cell.
    j, i = np.mgrid[0:257, 0:257]
    flow = np.stack([np.cos(j / 2), np.sin(j / 2)], -1)
    for height, expected in ((0.01, SMOOTH_CELLS), (1.0, 1.0)):
        points = np.stack([i, height * j], -1).astype(float)
        assert (GridPyramid(FlowField.from_arrays(points, flow)).enlarged(1) == expected).all()


def test_triangles_without_neighbours_have_no_errors(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 3000)
    rng = np.random.default_rng(0)
    corners = rng.uniform(0, 1, (3000, 1, 3)) + rng.normal(scale=0.004, size=(3000, 3, 3))
    points, numbers = corners.reshape(-1, 3) * [1, 1, 0], np.arange(9000).reshape(-1, 3)
    pyramid = TrianglePyramid(FlowField.from_triangles(points, numbers, points))
    assert pyramid.depth and np.isfinite(pyramid.enlarged(1)).all()


def test_triangles_of_smooth_flow_may_be_larger(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 3000)
    points, triangles = sphere(5)
    smooth = np.cross([0.3, 0.2, 1.0], points)
    rough = smooth * np.where(points[:, :1] > 0.2, np.sign(np.sin(40 * points[:, 1:2])), 1)
    pyramids = [
        TrianglePyramid(FlowField.from_triangles(points, triangles, v)) for v in (smooth, rough)
    ]
    even, uneven = (pyramid.enlarged(1) for pyramid in pyramids)
    assert (even == 2).all() and even.size == 16
    middle = pyramids[1].places(1)[..., 0]
    assert (uneven[middle > 0.4] == 1).all() and (uneven[middle < -0.2] == 2).all()


def test_some_triangles_of_a_large_block_tell_how_rough_it_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 2000)
    points, triangles = sphere(5)
    x, y, z = points.T
    waves = np.stack([np.sin(6 * y), np.cos(5 * z), np.sin(7 * x)], axis=-1)
    velocity = waves - (waves * points).sum(axis=1, keepdims=True) * points
    flow = FlowField.from_triangles(points, triangles, velocity)
    measured: list[int] = []

    def recorded(points: Floats, triangles: Indices) -> Floats:
        measured.append(len(triangles))
        return triangle_normals(points, triangles)

    monkeypatch.setattr(blocks, "triangle_normals", recorded)
    monkeypatch.setattr(blocks, "MOST_MEASURED", 100)
    some = TrianglePyramid(flow).enlarged(1)
    monkeypatch.setattr(blocks, "MOST_MEASURED", len(triangles))
    every = TrianglePyramid(flow).enlarged(1)
    assert measured[0] < 0.6 * measured[1]
    assert np.abs(some / every - 1).max() < 0.1
