"""Surfaces of triangles from meshes of every kind: their own, cut out of a volume, or around it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.errors import FieldError, Notice
from flowtex.field.triangles.triangle_surface import TriangleSurface
from flowtex.sources.open_source import MeshSource

pv = pytest.importorskip("pyvista")

ACROSS = "ignore:.*of the flow is normal to the surface:flowtex.errors.Notice"
WAY = np.array([1.0, -2.0, 0.5])


def says(text: str) -> pytest.RaisesExc[FieldError]:
    """Expect an error with this text in it."""
    return pytest.raises(FieldError, match=re.escape(text))


def count(field: FlowField) -> int:
    """How many triangles there are."""
    return len(shape_of(field).triangles)


def shape_of(field: FlowField) -> TriangleSurface:
    assert isinstance(field.surface, TriangleSurface)
    return field.surface


def turning(mesh: Any) -> Any:
    """Give a mesh the flow around the z axis, on points, and its height."""
    mesh["v"] = np.cross([0, 0, 1.0], np.asarray(mesh.points, dtype=float))
    mesh["height"] = np.asarray(mesh.points)[:, 2].astype(float)
    return mesh


def uniform(mesh: Any, where: str = "points") -> Any:
    """Give a mesh the same vector everywhere."""
    data, count = (
        (mesh.point_data, mesh.n_points) if where == "points" else (mesh.cell_data, mesh.n_cells)
    )
    data["v"] = np.tile(WAY, (count, 1))
    return mesh


def box() -> Any:
    return pv.ImageData(dimensions=(6, 5, 4), spacing=(0.2, 0.25, 1 / 3))


def bent() -> Any:
    """The box as a structured grid whose cells are not bricks."""
    grid = box().cast_to_structured_grid()
    x, y, z = np.asarray(grid.points, dtype=float).T
    grid.points = np.stack([x + 0.1 * y * z, y + 0.1 * z * x, z + 0.1 * x * y], axis=-1)
    return grid


VOLUMES: dict[str, Any] = {
    "image": box,
    "rectilinear": lambda: box().cast_to_rectilinear_grid(),
    "structured": bent,
    "hexahedra": lambda: bent().cast_to_unstructured_grid(),
    "tetrahedra": lambda: box().to_tetrahedra(pass_data=False),
    "quadratic": lambda: quadratic(),
    "polyhedra": lambda: polyhedra(),
}


def quadratic() -> Any:
    """One tetrahedron with nodes in the middle of its edges."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    points = np.vstack([corners, [(corners[a] + corners[b]) / 2 for a, b in edges]])
    return pv.UnstructuredGrid({pv.CellType.QUADRATIC_TETRA: np.arange(10)[None]}, points)


def polyhedra() -> Any:
    """A cube as one polyhedron."""
    points = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    faces = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    stream = [6, *(n for face in faces for n in (4, *face))]
    return pv.UnstructuredGrid([len(stream), *stream], [pv.CellType.POLYHEDRON], points)


# --- surfaces ---------------------------------------------------------------------------------


def strips() -> Any:
    return turning(pv.Sphere().strip())


SURFACES: dict[str, Any] = {
    "triangles": pv.Sphere,
    "quads": lambda: pv.Plane(i_resolution=7, j_resolution=5),
    "polygons": lambda: pv.Disc(inner=0.2, r_res=3, c_res=9).remove_cells([4]),
    "hexagons": lambda: pv.Dodecahedron(),
    "strips": strips,
    "quads of a grid": lambda: pv.Plane(i_resolution=4).cast_to_unstructured_grid(),
    "quadratic triangle": lambda: pv.UnstructuredGrid(
        {pv.CellType.QUADRATIC_TRIANGLE: np.arange(6)[None]},
        np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]]),
    ),
}


@pytest.mark.filterwarnings("ignore:43% of the flow is normal")  # to the faces of a dodecahedron
@pytest.mark.parametrize("kind", SURFACES)
def test_the_flow_of_a_surface_is_that_of_its_points(kind: str) -> None:
    mesh = turning(SURFACES[kind]())
    before = mesh.copy()
    field = FlowField.from_pyvista(mesh, vectors="v", name="mine")
    assert field.triangles is not None and field.valid.all() and field.name == "mine"
    points = field.points[0]
    np.testing.assert_allclose(field.velocity[0, 0], np.cross([0, 0, 1.0], points), atol=1e-6)
    np.testing.assert_allclose(field.scalars["height"][0, 0], points[:, 2], atol=1e-6)
    area = float(np.linalg.norm(shape_of(field).crosses, axis=-1).sum()) / 2
    flat = mesh if isinstance(mesh, pv.PolyData) else mesh.extract_surface(algorithm=None)
    assert area == pytest.approx(flat.triangulate().area, rel=1e-5)
    assert mesh == before


def test_numbers_that_filters_add_are_no_scalars() -> None:
    grid = pv.ImageData(dimensions=(5, 4, 1))
    grid["v"], grid["height"] = np.ones((20, 3)) * [1, 1, 0], np.arange(20.0)
    surface = grid.extract_surface(algorithm="dataset_surface").triangulate()
    assert "vtkOriginalCellIds" in surface.cell_data
    field = FlowField.from_pyvista(surface)
    assert [*field.scalars] == ["height"] and not field.on_cells


def test_lines_and_vertices_beside_a_surface_are_left_out() -> None:
    mesh = pv.Plane(i_resolution=3, j_resolution=3)
    mesh.lines = [2, 0, 5]
    mesh.cell_data["v"] = np.zeros((10, 3))
    mesh.cell_data["v"][0] = 9  # the cell of the line, which VTK counts first
    mesh.cell_data["v"][1:] = [1, 2, 0]
    field = FlowField.from_pyvista(mesh)
    assert count(field) == 18
    np.testing.assert_allclose(field.velocity[0, 0], np.tile([1, 2, 0.0], (16, 1)))


def test_vectors_on_cells_come_to_nodes_by_area() -> None:
    points = np.array([[0, 0, 0], [3, 0, 0], [0, 1, 0], [0, -1, 0.0], [3, 2, 0]])
    mesh = pv.PolyData.from_regular_faces(points, [[0, 1, 2], [0, 3, 1], [1, 4, 2]])
    mesh.cell_data["v"] = [[1.0, 0], [3, 0], [np.nan, 0]]
    mesh.cell_data["p"] = [1.0, 3, 5]
    field = FlowField.from_pyvista(mesh)
    by_place = {tuple(p[:2]): n for n, p in enumerate(field.points[0])}
    assert field.velocity[0, 0, by_place[0, 0], 0] == pytest.approx(2)
    assert field.velocity[0, 0, by_place[3, 0], 0] == pytest.approx(2), "NaN counts for nothing"
    assert not field.valid[0, by_place[3, 2]] and field.valid.sum() == 4
    np.testing.assert_array_equal(field.scalars["p"], [[[1.0, 3, 5]]])


@pytest.mark.parametrize("where", ["points", "cells"])
@pytest.mark.filterwarnings(ACROSS)
def test_hidden_parts_are_blanked(where: str) -> None:
    mesh = uniform(pv.Plane(i_resolution=4, j_resolution=1))
    if where == "points":
        mesh.point_data["vtkGhostType"] = np.array([2] + [0] * 9, np.uint8)
        field = FlowField.from_pyvista(mesh, vectors="v")
        assert int((~field.valid).sum()) == 1
    else:
        mesh.cell_data["vtkGhostType"] = np.array([32, 0, 0, 0], np.uint8)
        field = FlowField.from_pyvista(mesh, vectors="v")
        assert count(field) == 6 and field.valid.all()


def test_a_surface_is_not_cut_and_has_no_planes() -> None:
    mesh = turning(pv.Sphere())
    with says("slice is 'x', but the mesh is already a surface"):
        FlowField.from_pyvista(mesh, slice="x")
    with says("plane='k=0' applies to structured meshes"):
        FlowField.from_pyvista(mesh, plane="k=0")
    with says("plane='z=1', sign_free=True applies to structured meshes, and this one is not"):
        FlowField.from_pyvista(mesh, plane="z=1", sign_free=True)


@pytest.mark.parametrize(
    ("mesh", "text"),
    [
        (pv.PolyData(np.ones((3, 3))), "the mesh has only points or lines; expected a surface"),
        (pv.Line(), "the mesh has only points or lines; expected a surface"),
        (pv.PolyData(), "the mesh has no"),
        (pv.UnstructuredGrid(), "the mesh has no"),
        (pv.Table({"a": np.ones(3)}), "the mesh is a Table; expected a mesh"),
    ],
)
def test_what_has_no_surface(mesh: Any, text: str) -> None:
    if isinstance(mesh, pv.DataSet) and mesh.n_points:
        mesh["v"] = np.ones((mesh.n_points, 3))
    with says(text):
        FlowField.from_pyvista(mesh)


# --- volumes ----------------------------------------------------------------------------------


@pytest.mark.parametrize("where", ["points", "cells"])
@pytest.mark.parametrize("kind", VOLUMES)
@pytest.mark.parametrize(
    "cut",
    [
        "x=0.2",
        "z",
        "1,1,0 through 0.2,0.3,0.4",
        "-1, 2, 0.5 through 0.3,0.3,0.2",
        ((0, 1, 1), (0.2, 0.3, 0.1)),
    ],
)
@pytest.mark.filterwarnings(ACROSS)
def test_a_slice_of_a_uniform_flow_has_it_exactly(kind: str, where: str, cut: Any) -> None:
    mesh = uniform(VOLUMES[kind](), where)
    mesh["place"] = np.asarray(mesh.points)[:, 0].astype(float)
    before = mesh.copy()
    field = FlowField.from_pyvista(mesh, slice=cut)
    np.testing.assert_allclose(field.velocity[0, 0], np.tile(WAY, (field.valid.size, 1)), rtol=1e-6)
    np.testing.assert_allclose(field.scalars["place"][0, 0], field.points[0, :, 0], atol=1e-6)
    normals = np.abs(shape_of(field).normals[0])
    np.testing.assert_allclose(normals, normals[:1].repeat(len(normals), 0), atol=1e-7)
    assert mesh == before


@pytest.mark.parametrize("where", ["points", "cells"])
@pytest.mark.parametrize("kind", ["image", "rectilinear", "structured", "tetrahedra"])
def test_a_contour_of_a_ball(kind: str, where: str) -> None:
    kinds: dict[str, Any] = {
        "image": lambda m: m,
        "rectilinear": lambda m: m.cast_to_rectilinear_grid(),
        "structured": lambda m: m.cast_to_structured_grid(),
        "tetrahedra": lambda m: m.to_tetrahedra(pass_data=False),
    }
    mesh = kinds[kind](pv.ImageData(dimensions=(25,) * 3, spacing=(0.1,) * 3, origin=(-1.2,) * 3))
    turning(mesh)
    mesh["r"] = np.linalg.norm(np.asarray(mesh.points), axis=1)
    if where == "cells":
        mesh = mesh.point_data_to_cell_data()
    field = FlowField.from_pyvista(mesh, contour="r=0.8")
    points = field.points[0]
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 0.8, atol=0.02)
    np.testing.assert_allclose(field.velocity[0, 0], np.cross([0, 0, 1.0], points), atol=0.02)
    assert field.normal_share < 0.03
    assert FlowField.from_pyvista(mesh, contour=("r", 0.8)).shape == field.shape


@pytest.mark.parametrize("kind", ["hexahedra", "tetrahedra", "quadratic", "polyhedra"])
@pytest.mark.filterwarnings(ACROSS)
def test_the_outer_surface_is_taken_and_told(kind: str) -> None:
    mesh = uniform(VOLUMES[kind]())
    with pytest.warns(
        Notice, match="the outer surface of the volume is drawn; to cut the volume, use slice="
    ):
        field = FlowField.from_pyvista(mesh)
    ends = np.reshape(mesh.bounds, (3, 2))
    np.testing.assert_allclose(field.points[0].min(0), ends[:, 0], atol=1e-6)
    np.testing.assert_allclose(field.points[0].max(0), ends[:, 1], atol=1e-6)


@pytest.mark.filterwarnings(ACROSS)
def test_faces_among_volumes_are_the_surface_and_volumes_are_cut() -> None:
    points = np.vstack([np.eye(3), np.zeros((1, 3))])
    mesh = uniform(
        pv.UnstructuredGrid(
            {
                pv.CellType.TETRA: np.array([[0, 1, 2, 3]]),
                pv.CellType.TRIANGLE: np.array([[0, 1, 3]]),
            },
            points,
        )
    )
    with pytest.warns(Notice, match="cells of two dimensions are drawn"):
        assert count(FlowField.from_pyvista(mesh)) == 1
    assert count(FlowField.from_pyvista(mesh, slice="z=0.25")) == 1


@pytest.mark.filterwarnings(ACROSS)
def test_hidden_parts_of_a_volume_are_not_cut() -> None:
    mesh = uniform(box(), "cells")
    mesh.cell_data["v"][:5] = np.nan
    whole = FlowField.from_pyvista(uniform(box()), slice="y=0.6")
    mesh.cell_data["vtkGhostType"] = np.r_[[32] * 10, [0] * (mesh.n_cells - 10)].astype(np.uint8)
    mesh.cell_data["v"][:] = WAY
    field = FlowField.from_pyvista(mesh, slice="y=0.2")
    assert count(field) < count(whole) and field.valid.all()
    mesh = uniform(box())
    mesh["IBlank"] = (np.asarray(mesh.points)[:, 0] > 0.3).astype(np.int32)
    field = FlowField.from_pyvista(mesh, slice="y=0.6")
    assert np.array_equal(field.valid, field.points[..., 0] > 0.39)


@pytest.mark.parametrize(
    ("choice", "text"),
    [
        ({"slice": "q=1"}, "slice is 'q=1'; expected a text such as \"x=0.5\""),
        ({"slice": "0,0,0"}, "slice is '0,0,0'; expected"),
        ({"slice": "x=inf"}, "slice is 'x=inf'; expected"),
        ({"slice": "1,0,0 through 1,2"}, "expected"),
        ({"slice": 5}, "slice is 5; expected"),
        ({"slice": ("z", 1)}, "slice is ('z', 1); expected a text such as \"x=0.5\""),
        ({"slice": "x=7"}, "slice is 'x=7', which does not cut the mesh; it has x from 0 to 1, y"),
        ({"contour": "p"}, "contour is 'p'; expected an array and its value"),
        ({"contour": "plane=1"}, "no array 'plane' of one component; did you mean 'place'?"),
        ({"contour": "place=9"}, "contour is 'place=9'; expected a value of place from 0 to 1"),
        ({"contour": "place=1", "slice": "x"}, "slice is 'x' and contour is 'place=1'; choose one"),
        ({"slice": "x", "plane": "k=1"}, "plane is 'k=1' and slice is 'x'; choose one"),
        ({"slice": "x", "vectors": "w"}, "vectors is 'w'; expected one of: v, place"),
    ],
)
def test_a_cut_that_cannot_be(choice: dict[str, Any], text: str) -> None:
    mesh = uniform(box())
    mesh["place"] = np.asarray(mesh.points)[:, 0].astype(float)
    with says(text):
        FlowField.from_pyvista(mesh, **choice)


# --- series and blocks --------------------------------------------------------------------------


def at_time(time: float, mesh: Any = None) -> Any:
    step = (pv.Sphere() if mesh is None else mesh).copy()
    step["v"] = np.cross([0, 0, time], np.asarray(step.points, dtype=float))
    step["p"] = np.full(step.n_points, time)
    step.field_data["TimeValue"] = [time]
    return step


def test_a_list_of_surfaces_is_a_series() -> None:
    field = FlowField.from_pyvista([at_time(t) for t in (1.0, 2.0, 4.0)], vectors="v")
    assert field.times.tolist() == [1, 2, 4]
    np.testing.assert_allclose(field.velocity[2], 4 * field.velocity[0], atol=1e-7)
    assert field.scalars["p"][:, 0, 0].tolist() == [1, 2, 4]
    steps = [at_time(t, box()) for t in (1.0, 2.0)]
    assert len(FlowField.from_pyvista(steps, slice="1,1,1", times=[0, 7]).times) == 2
    blocks = pv.MultiBlock([at_time(1.0), at_time(3.0)])
    assert FlowField.from_pyvista(blocks, vectors="v").times.tolist() == [1, 3]


@pytest.mark.filterwarnings(ACROSS)
def test_surfaces_are_drawn_together_and_one_can_be_chosen() -> None:
    near, far = at_time(1.0), at_time(2.0, pv.Sphere(center=(3, 0, 0), theta_resolution=12))
    blocks = pv.MultiBlock({"near": near, "far": far})
    with pytest.warns(Notice, match="2 blocks are drawn together: near, far"):
        both = FlowField.from_pyvista(blocks, vectors="v")
    one = FlowField.from_pyvista(blocks, vectors="v", block="far")
    assert count(both) == count(one) + 1680
    assert FlowField.from_pyvista(blocks, vectors="v", block=0).valid.size == 842


def test_volumes_are_cut_together() -> None:
    left, right = uniform(box()), uniform(box())
    right.origin = (1, 0, 0)
    blocks = pv.MultiBlock({"left": left, "right": right})
    with says('choose one, as in block="left", draw a plane of all, as in plane="k=2", or cut'):
        FlowField.from_pyvista(blocks)
    with pytest.warns(Notice, match="2 blocks are drawn together: left, right"):
        field = FlowField.from_pyvista(blocks, slice="z=0.4")
    assert np.ptp(field.points[..., 0]) == pytest.approx(2)
    assert np.ptp(FlowField.from_pyvista(blocks, slice="z=0.4", block=1).points[..., 0]) == 1


# --- files with vectors beside them -------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".stl"])
def test_vectors_beside_a_file(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"ball{suffix}"
    pv.Sphere().save(path)
    with says(f"{path}: the file has no vectors, because its format cannot store them; expected"):
        FlowField.from_file(path)
    mesh = pv.read(path)
    flow = np.cross([0, 0, 1.0], np.asarray(mesh.points, dtype=float))
    np.save(tmp_path / "ball.npy", flow)
    field = FlowField.from_file(path)
    np.testing.assert_allclose(
        field.velocity[0, 0], np.cross([0, 0, 1.0], field.points[0]), atol=1e-6
    )
    assert field.name == "ball" and MeshSource.from_file(path).field().shape == field.shape
    np.save(tmp_path / "ball.npy", [flow, 2 * flow])
    assert FlowField.from_file(path).times.tolist() == [0, 1]
    assert FlowField.from_file(path, time=1).steady
    np.save(tmp_path / "ball.npy", np.cross([0, 0, 1.0], mesh.cell_centers().points))
    assert FlowField.from_file(path).normal_share < 0.01
    if suffix == ".stl":
        corners = mesh.points[mesh.regular_faces].reshape(-1, 3)
        np.save(tmp_path / "ball.npy", np.cross([0, 0, 1.0], corners))
        again = FlowField.from_file(path)
        assert again.shape == field.shape
        np.testing.assert_allclose(
            again.velocity[0, 0], np.cross([0, 0, 1.0], again.points[0]), atol=1e-5
        )


@pytest.mark.parametrize(
    ("vectors", "text"),
    [
        (np.ones((5, 3)), "ball.npy has shape (5, 3); expected vectors in"),
        (np.ones((842, 4)), "has shape (842, 4) and type float64"),
        (np.array([{}] * 842), "ball.npy is not a NumPy array"),
        (np.full((842, 3), "a"), "has shape (842, 3) and type <U1"),
    ],
)
def test_vectors_that_do_not_fit(tmp_path: Path, vectors: Any, text: str) -> None:
    pv.Sphere().save(tmp_path / "ball.ply")
    np.save(tmp_path / "ball.npy", vectors, allow_pickle=True)
    with says(text):
        FlowField.from_file(tmp_path / "ball.ply")


# --- what stays open ------------------------------------------------------------------------------


def test_a_volume_offers_its_cuts() -> None:
    source = MeshSource(uniform(box().to_tetrahedra(pass_data=False)))
    assert source.dimensions is None
    assert source.planes == {"outer": 1, "x": 101, "y": 101, "z": 101}
    assert source.default_plane == "x=0.5" and source.plane_number("x=0.5") == 50
    assert source.plane_text("outer=0") == "outer surface"
    assert np.ptp(source.field().points[..., 0]) < 1e-6
    assert np.ptp(source.field(plane="outer=0").points[..., 0]) == 1
    for axis in "xyz":
        for number in (0, 17, 100):
            plane = source.plane_at(axis, number)
            assert source.plane_number(plane) == number
            assert source.field(plane=plane).triangles is not None
    assert source.plane_number("k=1") is None and source.plane_number("x=nan") is None
    assert source.plane_number("outer=1e999") is None
    surface = MeshSource(turning(pv.Sphere()))
    assert surface.planes == {} and surface.default_plane == ""


# --- any surface ----------------------------------------------------------------------------------


@pytest.mark.filterwarnings(ACROSS)
def test_a_slice_through_rounded_nodes_has_no_crack() -> None:
    # Thirds are not numbers of single precision, so nodes lie beside the plane by some 1e-8.
    mesh = pv.ImageData(dimensions=(13, 13, 13), spacing=(1 / 12,) * 3).to_tetrahedra()
    mesh.points = np.asarray(mesh.points, dtype=np.float32)
    field = FlowField.from_pyvista(turning(mesh), slice="1,0.1,0.2 through 0.3333333,0.5,0.5")
    assert mesh.points.dtype == np.float32, "the mesh is not changed"
    surface = shape_of(field)
    alone, corner = np.nonzero(surface.neighbours < 0)
    ends = np.stack([surface.triangles[alone, (corner + by) % 3] for by in (1, 2)])
    middle = field.points[0][ends].mean(axis=0)
    assert (np.abs(middle - 0.5).max(axis=1) > 0.499).all()
