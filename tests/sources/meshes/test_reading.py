"""What reading a mesh does, step by step, and that the record tells it."""

from __future__ import annotations

import re
import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import property_test

from flowtex import FlowField
from flowtex.errors import FieldError, Notice

pv = pytest.importorskip("pyvista")

AXES = {"x": (1, 2), "y": (0, 2), "z": (0, 1)}


def flow(first: Any, second: Any) -> Any:
    """Two components of a flow in the plane."""
    return np.stack([1 - second, first + 0.5 * second**2], axis=-1)


def read(mesh: Any, **options: Any) -> tuple[FlowField, list[str]]:
    """Read a mesh, and the notices that are issued."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        field = FlowField.from_pyvista(mesh, **options)
    return field, [str(warning.message) for warning in caught]


def flat(axis: str, kind: str = "PolyData") -> Any:
    """A mesh in the plane where a coordinate is 0.5."""
    if kind == "PolyData":
        normal = [float(letter == axis) for letter in "xyz"]
        return pv.Plane(center=(0.5,) * 3, direction=normal, i_resolution=8, j_resolution=5)
    size = [1 if letter == axis else n for letter, n in zip("xyz", (7, 6, 5), strict=True)]
    mesh = pv.ImageData(dimensions=size, spacing=(0.2,) * 3, origin=(0.5,) * 3)
    return {
        "ImageData": lambda: mesh,
        "StructuredGrid": mesh.cast_to_structured_grid,
        "UnstructuredGrid": mesh.cast_to_unstructured_grid,
    }[kind]()


# --- components ----------------------------------------------------------------------------------


@pytest.mark.parametrize("where", ["points", "cells"])
@pytest.mark.parametrize("kind", ["PolyData", "ImageData", "StructuredGrid", "UnstructuredGrid"])
@pytest.mark.parametrize("axis", "xyz")
def test_two_components_lie_in_the_plane_of_a_mesh(axis: str, kind: str, where: str) -> None:
    mesh, axes = flat(axis, kind), list(AXES[axis])
    mesh["U"] = flow(*np.asarray(mesh.points, dtype=float).T[axes])
    if where == "cells":
        mesh = mesh.point_data_to_cell_data()
    field, notices = read(mesh)
    expected = np.zeros(field.points.shape)
    expected[..., axes] = (
        flow(*field.points[..., axes].T).swapaxes(0, -2).reshape(*field.valid.shape, 2)
    )
    inner = slice(None) if where == "points" else ~np.isnan(expected[..., 0])
    tolerance = 1e-6 if where == "points" else 0.5
    np.testing.assert_allclose(field.velocity[0][inner], expected[inner], atol=tolerance)
    assert not notices and field.normal_share < 1e-6
    along = " and ".join("xyz"[n] for n in axes)
    assert field.reading.of("components") == (
        f"U: two components, along {along} in the plane of the mesh",
    )


@pytest.mark.parametrize("names", [("u", "w"), ("w", "u"), ("x", "z"), ("c_X", "c_Z")])
def test_named_components_are_along_their_axes(names: tuple[str, str]) -> None:
    for mesh in (flat("y"), pv.Sphere(), pv.ImageData(dimensions=(4, 5, 6))):
        for name in names:
            value = 1.0 if name[-1] in "uxX" else 2.0
            mesh[name] = np.full(mesh.n_points, value)
        field, _ = read(mesh, vectors=",".join(names))
        assert np.unique(field.velocity.reshape(-1, 3), axis=0).tolist() == [[1, 0, 2]]


def test_two_components_across_the_axes_raise() -> None:
    mesh = pv.Plane(direction=(1, 1, 0), i_resolution=5, j_resolution=5)
    mesh["U"] = np.ones((mesh.n_points, 2))
    with pytest.raises(FieldError, match="'U' has two components, and the mesh lies in a plane"):
        FlowField.from_pyvista(mesh)
    mesh["X Velocity"], mesh["Z Velocity"] = mesh["U"].T
    assert read(mesh, vectors="X Velocity,Z Velocity")[0].velocity[0, 0, 0].tolist() == [1, 0, 1]


@pytest.mark.parametrize("options", [{"plane": "j=2"}, {"slice": "y=2"}, {"slice": "1,1,0"}])
def test_two_components_of_a_volume_are_along_x_and_y(options: dict[str, str]) -> None:
    mesh = pv.ImageData(dimensions=(6, 5, 4))
    mesh["U"] = np.tile([1.0, 0.01], (mesh.n_points, 1))
    field, notices = read(mesh, **options)
    assert np.allclose(field.velocity[0, field.valid], (1, 0.01, 0))
    told = "U has two components, which are drawn along x and y: the one along z is taken to be"
    assert any(told in notice for notice in notices)
    for level in ({"plane": "k=2"}, {"slice": "z=2"}):
        assert not read(mesh, **level)[1]


# --- the normal component ------------------------------------------------------------------------

THROUGH = r"^(\d+)% of the flow is normal to the surface and is not drawn$"


@pytest.mark.parametrize("kind", ["PolyData", "ImageData", "UnstructuredGrid"])
@pytest.mark.parametrize(("part", "told"), [(0.03, False), (0.08, True), (0.6, True)])
def test_flow_through_a_surface_is_told(kind: str, part: float, told: bool) -> None:
    mesh = flat("z", kind)
    mesh["U"] = np.tile([np.sqrt(1 - part**2), 0, part], (mesh.n_points, 1))
    field, notices = read(mesh)
    assert [bool(re.match(THROUGH, notice)) for notice in notices] == [True] * told
    assert field.reading.of("surface") == tuple(notices)
    assert not told or f"{part:.0%}" in notices[0]


@pytest.mark.parametrize("options", [{"plane": "k=1"}, {"slice": "z=1"}, {"contour": "h=1"}])
def test_flow_through_a_cut_is_recorded_and_most_of_it_told(options: dict[str, str]) -> None:
    mesh = pv.ImageData(dimensions=(6, 5, 4))
    mesh["h"] = mesh.points[:, 2].astype(float)
    for part, told in ((0.3, False), (0.8, True)):
        mesh["U"] = np.tile([np.sqrt(1 - part**2), 0, part], (mesh.n_points, 1))
        field, notices = read(mesh, vectors="U", **options)
        text = f"{part:.0%} of the flow is normal to the surface and is not drawn"
        assert field.reading.of("surface")[-1] == text
        assert notices == [text] * told


# --- the record ----------------------------------------------------------------------------------


def test_the_record_tells_each_step() -> None:
    mesh = pv.ImageData(dimensions=(6, 5, 4)).to_tetrahedra()
    for n, name in enumerate("uvw"):
        mesh.cell_data[name] = np.full(mesh.n_cells, 1.0 - 0.5 * n)
    mesh["IBlank"] = (np.arange(mesh.n_points) >= 12).astype(int)
    field, _ = read(mesh, slice="x=0.5")
    assert str(field.reading).splitlines()[:5] == [
        'select: the velocity is "u,v,w", the only cell array with 3 components',
        "mask: 10% of the nodes are hidden by IBlank",
        "components: u, v, w combined",
        "surface: slice x=0.5",
        "surface: velocity averaged from the cells to the nodes",
    ]


# --- masks ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("where", ["points", "cells"])
@pytest.mark.parametrize("kind", ["ImageData", "UnstructuredGrid", "volume"])
@pytest.mark.parametrize("fill", [-999.0, 1e20, np.nan])
def test_fill_values_are_masked(fill: float, kind: str, where: str) -> None:
    grid = pv.ImageData(dimensions=(21, 15, 5 if kind == "volume" else 1))
    mesh = grid.cast_to_unstructured_grid() if kind == "UnstructuredGrid" else grid
    data = mesh.point_data if where == "points" else mesh.cell_data
    places = np.asarray(mesh.points if where == "points" else mesh.cell_centers().points)
    values = np.stack([np.cos(places[:, 0]), 1 + places[:, 1], 0 * places[:, 0]], axis=-1)
    values[places[:, 0] > 14.2] = fill
    data["U"] = values.astype(np.float32)
    options = {"slice": "z=1.6"} if kind == "volume" else {}
    field, notices = read(mesh, **options)
    assert np.abs(field.velocity).max() < 17
    at = field.points[..., 0]
    assert field.valid[at < 14].all() and not field.valid[at > 15.1].any()
    share = f"{float((places[:, 0] > 14.2).mean()):.0%} of the {where}"
    if np.isnan(fill):
        assert not notices
        assert field.reading.of("mask") == (f"{share} have no velocity: U is NaN",)
    else:
        text = f"{share} are masked: U is {fill:g} there, which is taken for a fill value; "
        text += "to draw these values too, mask=False"
        assert notices == list(field.reading.of("mask")) == [text]


def test_a_fill_value_of_one_step_is_one_in_the_following_steps() -> None:
    steps = []
    for count in (40, 1):
        mesh = pv.ImageData(dimensions=(20, 20, 1))
        mesh["U"] = np.random.default_rng(0).normal(size=(400, 2))
        mesh["U"][:count] = -9999
        steps.append(mesh)
    field, notices = read(steps)
    assert np.abs(field.velocity).max() < 10 and len(notices) == 1


# --- series --------------------------------------------------------------------------------------


def step(kind: str, time: float) -> Any:
    """A mesh whose velocity grows in time."""
    mesh: Any = {
        "grid": lambda: pv.ImageData(dimensions=(7, 5, 1)).cast_to_structured_grid(),
        "triangles": lambda: pv.ParametricEllipsoid(u_res=15, v_res=12).clean().triangulate(),
        "tetrahedra": lambda: pv.ImageData(dimensions=(4, 4, 4)).to_tetrahedra(pass_data=False),
        "faces": lambda: pv.Plane(i_resolution=5, j_resolution=4),
    }[kind]()
    mesh["U"] = np.cross([0, 0, time], np.asarray(mesh.points, dtype=float))
    mesh["p"] = time + np.arange(mesh.n_points)
    mesh.cell_data["c"] = time + np.arange(mesh.n_cells, dtype=float)
    mesh.field_data["TimeValue"] = [time]
    return mesh


def shuffled(mesh: Any, seed: int, labels: str = "") -> Any:
    """Return a mesh with the same content in another order."""
    random = np.random.default_rng(seed)
    if isinstance(mesh, pv.StructuredGrid):
        size = [mesh.dimensions[1], mesh.dimensions[0]]
        turned = pv.StructuredGrid()
        turned.points = np.asarray(mesh.points).reshape(*size, 3)[::-1].reshape(-1, 3)
        turned.dimensions = mesh.dimensions
        for name in mesh.point_data:
            values = np.asarray(mesh.point_data[name])
            turned[name] = values.reshape(*size, -1)[::-1].reshape(values.shape)
        turned.cell_data["c"] = mesh.cell_data["c"].reshape(size[0] - 1, -1)[::-1].ravel()
    else:
        order, cells = random.permutation(mesh.n_points), random.permutation(mesh.n_cells)
        place = np.argsort(order)
        flat_mesh = mesh.cast_to_unstructured_grid()
        corners = place[flat_mesh.cells.reshape(mesh.n_cells, -1)[:, 1:]][cells]
        if isinstance(mesh, pv.PolyData):
            turned = pv.PolyData.from_regular_faces(np.asarray(mesh.points)[order], corners)
        else:
            turned = pv.UnstructuredGrid(
                {pv.CellType.TETRA: corners}, np.asarray(mesh.points)[order]
            )
        for name in mesh.point_data:
            turned.point_data[name] = np.asarray(mesh.point_data[name])[order]
        turned.cell_data["c"] = mesh.cell_data["c"][cells]
    if "TimeValue" in mesh.field_data:
        turned.field_data["TimeValue"] = mesh.field_data["TimeValue"]
    return turned


@property_test(12)
@given(
    st.integers(0, 2**31), st.sampled_from(["grid", "triangles", "faces", "tetrahedra", "slice"])
)
def test_steps_in_another_order_are_matched(seed: int, kind: str) -> None:
    options = {"slice": "0.3,1,0.2"} if kind == "slice" else {}
    steps = [step("tetrahedra" if kind == "slice" else kind, time) for time in (1.0, 2.0)]
    expected, _ = read(steps, **options)
    field, notices = read([steps[0], shuffled(steps[1], seed)], **options)
    assert np.array_equal(field.points, expected.points)
    np.testing.assert_allclose(field.velocity, expected.velocity, atol=1e-12)
    for name in ("p", "c"):
        np.testing.assert_allclose(field.scalars[name], expected.scalars[name], atol=1e-12)
    text = "nodes or cells of 1 steps are in another order than those of the first"
    assert sum(notice.startswith(text) for notice in notices) == 1


def test_steps_are_sorted_by_time() -> None:
    field, notices = read([step("grid", time) for time in (3.0, 1.0, 2.0)])
    assert field.times.tolist() == [1, 2, 3]
    np.testing.assert_allclose(field.velocity[2], 3 * field.velocity[0], atol=1e-12)
    assert field.scalars["p"][:, 0, 0].tolist() == [1, 2, 3]
    assert notices == ["the steps are sorted by their times"]


def test_notices_name_the_line_that_calls() -> None:
    mesh = pv.ImageData(dimensions=(4, 4, 4))
    mesh["U"] = np.tile([1.0, 2, 0], (64, 1))
    with pytest.warns(Notice, match="the plane is") as caught:
        FlowField.from_pyvista(mesh)
    assert caught[0].filename == __file__


def test_a_first_step_at_rest_is_told() -> None:
    _, notices = read([step("grid", time) for time in (0.0, 0.5, 1.0)])
    assert notices == [
        "the velocity is zero everywhere at the first step; it is not from time 0.5 on, where "
        "pictures begin; for another one, time=1"
    ]
