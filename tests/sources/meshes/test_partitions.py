"""Partitions of one mesh: VTKHDF written by hand, with times, and PyVista's partitioned dataset."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from cfd_files import Piece, write_vtkhdf

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.app.controllers.library import Library
from flowtex.errors import Notice


def vectors(points: Any, time: float = 0.0) -> Floats:
    """The velocity at points, (N, 3)."""
    x, y, _ = np.asarray(points, dtype=float).T
    return np.stack([1 + np.sin(2 * x - time), np.cos(y + time), 0 * x], axis=-1)


def partitioned(meshes: list[Any]) -> Any:
    make: Any = pv.PartitionedDataSet
    return make(meshes)


def square(left: float) -> Piece:
    """The points and triangles of a unit square."""
    mesh = pv.Plane(center=(left + 0.5, 0.5, 0), i_resolution=6, j_resolution=6).triangulate()
    return np.asarray(mesh.points, dtype=float), mesh.faces.reshape(-1, 4)[:, 1:]


def check(field: FlowField, pieces: list[Piece], times: tuple[float, ...]) -> None:
    """Check the nodes, without those that partitions have in common, and all velocities."""
    points = np.asarray(field.points).reshape(-1, 3)
    expected = np.unique(np.concatenate([piece[0] for piece in pieces]).round(6), axis=0)
    np.testing.assert_allclose(np.unique(points.round(6), axis=0), expected, atol=1e-6)
    assert len(points) == len(expected) and field.valid.all()
    assert field.triangles is not None
    assert len(field.triangles) == sum(len(piece[1]) for piece in pieces)
    np.testing.assert_allclose(field.times, times)
    for step, time in enumerate(times):
        velocity = np.asarray(field.velocity[step]).reshape(-1, 3)
        np.testing.assert_allclose(velocity, vectors(points, time), atol=1e-6)


@pytest.mark.parametrize("times", [(0.0,), (0.0, 1.5, 2.0)])
@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("kind", ["UnstructuredGrid", "PolyData"])
def test_times_and_partitions_of_vtkhdf(
    kind: str, count: int, times: tuple[float, ...], tmp_path: Path
) -> None:
    pieces = [square(float(number)) for number in range(count)]
    path = tmp_path / "flow.vtkhdf"
    write_vtkhdf(path, kind, pieces, times, vectors)
    check(FlowField.from_file(path), pieces, times)
    if len(times) > 1:
        between = FlowField.from_file(path, time=times[1])
        check(between, pieces, times[1:2])
    assert Library.of(tmp_path).names


def test_partitioned_dataset_is_one_mesh() -> None:
    pieces = [square(0.0), square(1.0)]
    meshes = []
    for points, triangles in pieces:
        mesh = pv.PolyData.from_regular_faces(points, triangles)
        mesh["velocity"] = vectors(points)
        meshes.append(mesh)
    meshes[1] = meshes[1].cast_to_unstructured_grid()
    check(FlowField.from_pyvista(partitioned(meshes)), pieces, (0.0,))
    series = [partitioned(meshes), partitioned(meshes)]
    assert len(FlowField.from_pyvista(series, times=[0.0, 1.0]).times) == 2


def test_copies_of_other_partitions_are_left_out() -> None:
    """A layer of ghost cells lies on those of the neighbour."""
    pieces = [square(0.0), square(1.0)]
    meshes = []
    for points, triangles in pieces:
        meshes.append(pv.UnstructuredGrid({pv.CellType.TRIANGLE: triangles}, points))
    copied = meshes[1].extract_cells(meshes[1].cell_centers().points[:, 0] < 1.2)
    first = pv.merge([meshes[0], copied])
    first.clear_data()
    meshes[0] = first
    for mesh in meshes:
        mesh["velocity"] = vectors(mesh.points)
        copies = (mesh is first) & (mesh.cell_centers().points[:, 0] > 1.0)
        mesh.cell_data["vtkGhostType"] = copies.astype("u1")
    check(FlowField.from_pyvista(partitioned(meshes)), pieces, (0.0,))


def test_structured_partitions_that_meet_are_one_surface() -> None:
    meshes = []
    for left in (0.0, 4.0):
        mesh = pv.ImageData(dimensions=(5, 5, 1), origin=(left, 0.0, 0.0))
        mesh["velocity"] = vectors(mesh.points)
        meshes.append(mesh)
    with pytest.warns(Notice, match="2 blocks are drawn together"):
        field = FlowField.from_pyvista(partitioned(meshes))
    assert field.points.shape[-2] == 45
    points = field.points.reshape(-1, 3)
    np.testing.assert_allclose(field.velocity[0].reshape(-1, 3), vectors(points), atol=1e-12)
