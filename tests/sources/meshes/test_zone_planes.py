"""A plane of several structured volumes is drawn in all of them as one surface."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from cfd_files import CGNS, TIMES, box, turning

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError, Notice

X, Y, Z = np.linspace(0, 2, 21), np.linspace(0, 1, 11), np.linspace(0, 0.5, 6)
TOGETHER = "2 blocks are drawn together: left, right"


def flow(points: Any) -> Floats:
    x, y, _ = np.asarray(points, dtype=float).T
    return np.stack([1 + 0.2 * np.sin(3 * y), 0.6 * np.cos(2 * x), 0 * x], axis=-1)


def zone(x: Floats, z: Floats = Z) -> pv.StructuredGrid:
    grid = pv.StructuredGrid(*np.meshgrid(x, Y, z, indexing="ij"))
    grid["velocity"] = flow(grid.points)
    grid["pressure"] = np.asarray(grid.points)[:, 0]
    return grid


def zones() -> pv.MultiBlock:
    return pv.MultiBlock({"left": zone(X[:9]), "right": zone(X[8:])})


def check(field: FlowField, count: int, height: float | None = None) -> None:
    points = field.points.reshape(-1, 3)
    assert len(points) == count and field.valid.all()
    if height is not None:
        np.testing.assert_allclose(points[:, 2], height)
    velocity = np.asarray(field.velocity[0]).reshape(-1, 3)
    np.testing.assert_allclose(velocity, flow(points), atol=1e-6)


@pytest.mark.filterwarnings("ignore:.*is normal to the surface:flowtex.errors.Notice")
def test_plane_is_one_surface() -> None:
    with pytest.warns(Notice, match=TOGETHER):
        field = FlowField.from_pyvista(zones(), plane="k=2")
    check(field, len(X) * len(Y), Z[2])
    np.testing.assert_allclose(field.scalars["pressure"][0], field.points[..., 0], atol=1e-6)
    with pytest.warns(Notice, match=TOGETHER):
        check(FlowField.from_pyvista(zones(), plane="j=3"), len(X) * len(Z))


def test_files_and_other_kinds_of_grids(tmp_path: Path) -> None:
    zones().save(tmp_path / "zones.vtm")
    with pytest.warns(Notice, match=TOGETHER):
        check(FlowField.from_file(tmp_path / "zones.vtm", plane="k=-1"), len(X) * len(Y), Z[-1])
    blocks = pv.MultiBlock(
        {
            "left": pv.RectilinearGrid(X[:9], Y, Z),
            "right": pv.ImageData(
                dimensions=(13, 11, 6), spacing=(0.1, 0.1, 0.1), origin=(X[8], 0, 0)
            ),
        }
    )
    for each in blocks:
        assert each is not None
        each["velocity"] = flow(each.points)
    with pytest.warns(Notice, match=TOGETHER):
        check(FlowField.from_pyvista(blocks, plane="k=2"), len(X) * len(Y))


@pytest.mark.filterwarnings("ignore:.*is normal to the surface:flowtex.errors.Notice")
def test_series_of_cgns_zones(tmp_path: Path) -> None:
    path = tmp_path / "wing.cgns"
    with CGNS.write(path) as file:
        file.base("Base", [("Tip", box(4, 3, 3)), ("Body", box(6, 3, 3, 3.0))], times=TIMES)
    with pytest.warns(Notice, match="Base/Tip, Base/Body"):
        field = FlowField.from_file(path, plane="k=1")
    points = field.points.reshape(-1, 3)
    assert field.times.tolist() == list(TIMES) and len(points) == 9 * 3
    for step, speed in enumerate((1.0, 2.0)):
        velocity = np.asarray(field.velocity[step]).reshape(-1, 3)
        np.testing.assert_allclose(velocity, turning(points, speed), atol=1e-6)


def test_velocities_on_cells_are_means_of_both_sides() -> None:
    blocks = zones()
    for each in blocks:
        assert each is not None
        each.clear_data()
        height = each.cell_centers().points[:, 2]
        each.cell_data["velocity"] = np.stack([1 + height, height, 0 * height], axis=-1)
    with pytest.warns(Notice, match=TOGETHER):
        field = FlowField.from_pyvista(blocks, plane="k=2")
    np.testing.assert_allclose(field.velocity[0, ..., 0], 1 + Z[2], atol=1e-6)


def test_hidden_nodes_stay_hidden() -> None:
    blocks = zones()
    right: Any = blocks["right"]
    shown = np.ones(right.n_points, int)
    shown[40 + 13 * 11 * 2] = 0
    right["IBlank"] = shown
    with pytest.warns(Notice, match=TOGETHER):
        field = FlowField.from_pyvista(blocks, plane="k=2")
    assert (~field.valid).sum() == 1


def test_zones_without_the_plane_are_named() -> None:
    blocks = pv.MultiBlock({"left": zone(X[:9]), "right": zone(X[8:]), "flat": zone(X + 3, Z[:2])})
    with pytest.warns(Notice) as caught:
        field = FlowField.from_pyvista(blocks, plane="k=4")
    assert "flat has no plane k=4, and is not drawn" in [str(each.message) for each in caught]
    check(field, len(X) * len(Y), Z[4])
    with pytest.raises(FieldError, match=r"plane is 'k=9'; expected .* within 9 x 11 x 6 nodes"):
        FlowField.from_pyvista(blocks, plane="k=9")


def test_one_block_and_steps_of_one_block_remain() -> None:
    field = FlowField.from_pyvista(zones(), plane="k=2", block="left")
    assert field.shape == (11, 9)
    steps = FlowField.from_pyvista(pv.MultiBlock([zone(X), zone(X)]), plane="k=2")
    assert len(steps.times) == 2 and steps.shape == (11, 21)


def test_error_of_several_blocks_names_the_plane() -> None:
    with pytest.raises(FieldError, match='a plane of all, as in plane="k=3", or cut all volumes'):
        FlowField.from_pyvista(zones())
