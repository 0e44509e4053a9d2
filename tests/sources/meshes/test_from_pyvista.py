"""PyVista's structured meshes become a field, whichever way they lie and hide."""

from __future__ import annotations

import re
import warnings
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from flowtex import FlowField
from flowtex.errors import FieldError, Notice
from flowtex.scene.scene import Scene
from flowtex.sources.meshes.volume import nodes_to_keep

pv = pytest.importorskip("pyvista")

#: The flows of these tests go through their meshes.
pytestmark = pytest.mark.filterwarnings(
    "ignore:.*of the flow is normal to the surface:flowtex.errors.Notice"
)

Floats = NDArray[np.float64]

HIDDEN_POINT, HIDDEN_CELL = 2, 32
SHIFT = np.array([0.5, 0.25, 0.125])


def says(text: str) -> pytest.RaisesExc[FieldError]:
    """Expect an error with exactly this text."""
    return pytest.raises(FieldError, match=f"^{re.escape(text)}$")


def structured(i: int = 4, j: int = 3, k: int = 1) -> Any:
    """A grid whose nodes tell their indices: x = i, y = 10 j, z = 100 k."""
    z, y, x = np.meshgrid(*[np.arange(float(n)) for n in (k, j, i)], indexing="ij")
    grid = pv.StructuredGrid()
    grid.points = np.stack([x, 10 * y, 100 * z], axis=-1).reshape(-1, 3)
    grid.dimensions = (i, j, k)
    return grid


def rectilinear(i: int = 4, j: int = 3, k: int = 1) -> Any:
    return pv.RectilinearGrid(*[np.arange(float(n)) * s for n, s in ((i, 1), (j, 10), (k, 100))])


def image(i: int = 4, j: int = 3, k: int = 1) -> Any:
    return pv.ImageData(dimensions=(i, j, k), spacing=(1, 10, 100))


KINDS = [structured, rectilinear, image]


def with_flow(grid: Any) -> Any:
    """Give a grid a velocity that is its own positions, shifted."""
    grid["v"] = np.asarray(grid.points, dtype=float) + SHIFT
    return grid


def flowing(i: int = 4, j: int = 3, k: int = 1) -> Any:
    return with_flow(structured(i, j, k))


def expected(i: Any, j: Any, k: Any) -> Floats:
    """Positions of nodes with these indices, broadcast to (J, I, 3)."""
    return np.stack(np.broadcast_arrays(1.0 * i, 10.0 * j, 100.0 * k), axis=-1)


# --- planes ---------------------------------------------------------------------------------


@pytest.mark.parametrize("make", KINDS)
@pytest.mark.parametrize(
    ("size", "flat_axis"), [((4, 3, 1), "k"), ((4, 1, 3), "j"), ((1, 4, 3), "i")]
)
def test_a_flat_mesh_of_any_direction(
    make: Any, size: tuple[int, int, int], flat_axis: str
) -> None:
    field = FlowField.from_pyvista(with_flow(make(*size)))
    first, second = np.arange(4)[None], np.arange(3)[:, None]
    wanted = {
        "k": expected(first, second, 0),
        "j": expected(first, 0, second),
        "i": expected(0, first, second),
    }[flat_axis]
    assert np.array_equal(field.points, wanted)
    np.testing.assert_array_equal(field.velocity[0], wanted + SHIFT)


@pytest.mark.parametrize("make", KINDS)
@pytest.mark.parametrize(
    ("plane", "wanted"),
    [
        ("k=1", expected(np.arange(5)[None], np.arange(4)[:, None], 1)),
        ("K = -1", expected(np.arange(5)[None], np.arange(4)[:, None], 2)),
        ("j=3", expected(np.arange(5)[None], 3, np.arange(3)[:, None])),
        ("j=-4", expected(np.arange(5)[None], 0, np.arange(3)[:, None])),
        (" i=+2 ", expected(2, np.arange(4)[None], np.arange(3)[:, None])),
    ],
)
def test_a_plane_of_a_solid_mesh(make: Any, plane: str, wanted: Floats) -> None:
    field = FlowField.from_pyvista(with_flow(make(5, 4, 3)), plane=plane)
    assert np.array_equal(field.points, wanted)
    np.testing.assert_array_equal(field.velocity[0], wanted + SHIFT)


def test_an_image_that_is_turned_and_shifted() -> None:
    grid = pv.ImageData(dimensions=(4, 3, 2), spacing=(1, 2, 3), origin=(5, 6, 7))
    grid.direction_matrix = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    grid.offset = (10, 20, 30)
    with_flow(grid)
    field = FlowField.from_pyvista(grid, plane="k=1")
    wanted = np.asarray(grid.points).reshape(2, 3, 4, 3)[1]
    np.testing.assert_allclose(field.points, wanted, atol=1e-12)


def test_a_bare_vtk_mesh_is_a_mesh() -> None:
    from vtkmodules.vtkCommonDataModel import vtkStructuredGrid

    bare = vtkStructuredGrid()
    bare.ShallowCopy(flowing())
    assert FlowField.from_pyvista(bare).shape == (3, 4)


# --- vectors --------------------------------------------------------------------------------


def test_the_only_candidate_is_found() -> None:
    grid = flowing()
    grid["Normals"] = np.ones((12, 3))
    grid["surface_normals"] = np.ones((12, 3))
    grid["Texture Coordinates"] = np.ones((12, 2))
    grid["coords"] = np.ones((12, 3))
    grid["rgb"] = np.ones((12, 3), np.uint8)
    grid["stress"] = np.ones((12, 6))
    grid["p"] = np.arange(12.0)
    grid["n"] = np.ones((12, 3))
    grid.point_data.active_normals_name = "n"
    field = FlowField.from_pyvista(grid)
    assert field.velocity[0, 0, 0].tolist() == [0.5, 0.25, 0.125]


def test_the_active_vectors_win() -> None:
    grid = flowing()
    grid["w"] = np.full((12, 3), 7.0)
    grid.set_active_vectors("w")
    assert (FlowField.from_pyvista(grid).velocity == 7).all()
    assert (FlowField.from_pyvista(grid, vectors="v").velocity != 7).any()


def test_zero_everywhere_warns() -> None:
    grid = structured()
    grid["v"] = np.zeros((12, 3))
    with pytest.warns(UserWarning, match="^The velocity is zero at every node, so the picture"):
        FlowField.from_pyvista(grid)


# --- scalars --------------------------------------------------------------------------------


def test_other_arrays_of_one_component_become_scalars() -> None:
    grid = flowing(4, 3, 2)
    grid["p"] = np.arange(24, dtype=np.int32)
    grid["one column"] = np.arange(24.0).reshape(-1, 1)
    grid["words"] = np.array(["a"] * 24)
    grid["w"] = np.ones((24, 3))
    grid["IBlank"] = np.ones(24, np.int32)
    grid.cell_data["c"] = np.arange(6.0)
    grid.cell_data["p"] = np.full(6, -1.0)
    field = FlowField.from_pyvista(grid, vectors="v", plane="k=1")
    assert list(field.scalars) == ["p", "one column", "c"]
    assert field.on_cells == ("c",)
    assert np.array_equal(field.scalars["p"][0], np.arange(12, 24).reshape(3, 4))
    assert np.array_equal(field.scalars["one column"], field.scalars["p"])
    assert field.scalars["c"][0, :-1, :-1].tolist() == [[0, 1, 2], [3, 4, 5]]
    assert (
        np.isnan(field.scalars["c"][0, -1]).all() and np.isnan(field.scalars["c"][0, :, -1]).all()
    )


def test_preference_chooses_between_points_and_cells() -> None:
    grid = flowing(4, 3, 1)
    grid["p"], grid.cell_data["p"] = np.arange(12.0), np.arange(6.0)
    assert FlowField.from_pyvista(grid, vectors="v").on_cells == ()
    assert FlowField.from_pyvista(grid, vectors="v", preference="point").on_cells == ()
    field = FlowField.from_pyvista(grid, vectors="v", preference="cell")
    assert field.on_cells == ("p",)
    np.testing.assert_array_equal(field.scalars["p"][0, :-1, :-1].ravel(), np.arange(6.0))
    with pytest.raises(FieldError, match="preference is 'cells'; expected"):
        FlowField.from_pyvista(grid, vectors="v", preference="cells")


def test_the_range_is_that_of_the_preferred_array_of_the_volume() -> None:
    grid = flowing(4, 3, 4)
    grid["p"], grid.cell_data["p"] = np.arange(48.0), 100 + np.arange(18.0)
    for preference, ends in (("point", (0, 47)), ("cell", (100, 117))):
        field = FlowField.from_pyvista(grid, vectors="v", plane="k=1", preference=preference)
        assert Scene(field).scalar_range("p") == ends


def test_a_plane_of_nodes_has_the_cells_of_extract_subset() -> None:
    grid = flowing(4, 3, 3)
    grid.cell_data["c"] = np.arange(12.0)
    for index in (0, 1, 2):
        field = FlowField.from_pyvista(grid, vectors="v", plane=f"k={index}")
        plane = grid.extract_subset((0, 3, 0, 2, index, index))
        np.testing.assert_array_equal(field.scalars["c"][0, :-1, :-1].ravel(), plane["c"])
    # A hidden cell gives way to the one before the plane.
    grid.hide_cells([6], inplace=True)
    field = FlowField.from_pyvista(grid, vectors="v", plane="k=1")
    assert field.scalars["c"][0, 0].tolist()[:-1] == [0.0, 7.0, 8.0]


# --- cells ----------------------------------------------------------------------------------


@pytest.mark.parametrize("plane", ["k=0", "k=2", "k=3", "j=1", "i=4"])
def test_cells_on_both_sides_of_a_plane_count(plane: str) -> None:
    grid = structured(5, 4, 4)
    grid.cell_data["v"] = np.random.default_rng(0).random((36, 3))
    nodes = with_points(grid, grid.cell_data_to_point_data()["v"])
    np.testing.assert_allclose(
        FlowField.from_pyvista(grid, plane=plane).velocity,
        FlowField.from_pyvista(nodes, plane=plane).velocity,
    )


def with_points(grid: Any, velocity: Any) -> Any:
    bare = pv.StructuredGrid()
    bare.copy_structure(grid)
    bare["v"] = np.asarray(velocity)
    return bare


@pytest.mark.parametrize("how", ["ghosts", "nan"])
def test_hidden_cells_leak_nothing(how: str) -> None:
    grid = structured(7, 6)
    velocity, ghosts = np.ones((30, 3)), np.zeros(30, np.uint8)
    block = [14, 15, 20, 21]
    if how == "ghosts":
        velocity[block] = 1e6
        ghosts[block] = HIDDEN_CELL
        grid.cell_data["vtkGhostType"] = ghosts
    else:
        velocity[block] = np.nan
    grid.cell_data["v"] = velocity
    grid.cell_data["c"] = velocity[:, 0]
    field = FlowField.from_pyvista(grid)
    assert np.argwhere(~field.valid).tolist() == [[3, 3]]
    assert (field.velocity[0, field.valid] == 1).all()
    hidden = np.zeros(30, bool)
    hidden[block] = True
    assert np.array_equal(field.surface.cells, ~hidden.reshape(5, 6))
    assert (field.scalars["c"][0, :-1, :-1].ravel()[~hidden] == 1).all()
    assert Scene(field).scalar_range("c") == (0.95, 1.05), "the hidden 1e6 is not in the range"


def test_cells_are_kept_as_they_are_shown() -> None:
    """No hidden cell is drawn, and one that is two cells away from any is."""
    rng = np.random.default_rng(6)
    for _ in range(50):
        visible = rng.random((8, 9)) > 0.2
        keep = nodes_to_keep(visible, (False, False))
        drawn = keep[:-1, :-1] & keep[1:, :-1] & keep[:-1, 1:] & keep[1:, 1:]
        assert not (drawn & ~visible).any()
        near = np.pad(~visible, 1)
        calm = ~np.logical_or.reduce(
            [near[1 + a : 9 + a, 1 + b : 10 + b] for a in (-1, 0, 1) for b in (-1, 0, 1)]
        )
        assert drawn[calm].all()


def test_duplicates_of_a_neighbouring_piece_are_kept() -> None:
    grid = flowing()
    grid.point_data["vtkGhostType"] = np.full(12, 1, np.uint8)
    grid.cell_data["vtkGhostType"] = np.full(6, 1, np.uint8)
    assert FlowField.from_pyvista(grid).valid.all()


def annulus() -> Any:
    angle, radius = np.linspace(0, 2 * np.pi, 13), np.linspace(1, 2, 4)
    a, r = np.meshgrid(angle, radius)
    grid = pv.StructuredGrid()
    grid.points = np.stack([r * np.cos(a), r * np.sin(a), 0 * a], axis=-1).reshape(-1, 3)
    grid.dimensions = (13, 4, 1)
    return grid


def test_cell_vectors_agree_on_both_sides_of_a_seam() -> None:
    grid = annulus()
    grid.cell_data["v"] = np.random.default_rng(0).random((36, 3))
    field = FlowField.from_pyvista(grid)
    assert field.periodic == (False, True)
    cells = grid.cell_data["v"].reshape(3, 12, 3)
    np.testing.assert_allclose(field.velocity[0, 0, 0], (cells[0, 0] + cells[0, -1]) / 2)
    np.testing.assert_allclose(field.velocity[0, 0, -1], (cells[0, 0] + cells[0, -1]) / 2)
    apart = FlowField.from_pyvista(grid, periodic="")
    assert apart.periodic == (False, False)
    np.testing.assert_allclose(apart.velocity[0, 0, 0], cells[0, 0])


# --- hidden points --------------------------------------------------------------------------


@pytest.mark.parametrize("how", ["vtkGhostType", "IBlank", "vtkValidPointMask", "hide_points"])
def test_hidden_points_are_not_valid(how: str) -> None:
    grid = flowing(4, 3, 2)
    flags = np.zeros(24, np.int32 if how == "IBlank" else np.uint8)
    if how == "vtkGhostType":
        flags[18] = HIDDEN_POINT
        grid[how] = flags
    elif how == "hide_points":
        grid.hide_points([18])
    else:
        flags[:] = 1
        flags[18] = 0
        grid[how] = flags
    assert np.argwhere(~FlowField.from_pyvista(grid, plane="k=1").valid).tolist() == [[1, 2]]
    assert FlowField.from_pyvista(grid, plane="k=0").valid.all()


# --- series ---------------------------------------------------------------------------------


def at_time(time: float | None, speed: float = 1.0, **size: int) -> Any:
    grid = structured(**size)
    grid["v"] = np.full((grid.n_points, 3), speed)
    grid["p"] = np.full(grid.n_points, 10 * speed)
    if time is not None:
        grid.field_data["TimeValue"] = [time]
    return grid


@pytest.mark.parametrize("container", [list, tuple, pv.MultiBlock])
def test_grids_are_time_steps(container: Any) -> None:
    series = container([at_time(0.5, 1.0), at_time(2.0, 3.0), at_time(2.5, 4.0)])
    field = FlowField.from_pyvista(series)
    assert field.times.tolist() == [0.5, 2.0, 2.5]
    assert field.velocity[:, 1, 1, 0].tolist() == [1, 3, 4]
    assert field.scalars["p"][:, 1, 1].tolist() == [10, 30, 40]
    assert FlowField.from_pyvista(series, times=[0, 1, 2]).times.tolist() == [0, 1, 2]


def test_steps_without_times_are_numbered() -> None:
    field = FlowField.from_pyvista([at_time(None), at_time(None)])
    assert field.times.tolist() == [0, 1]
    assert "step 0 has no time, so the 2 steps are numbered from 0" in field.reading.of("align")
    with pytest.warns(Notice, match="step 0 has no time, so the 2 steps are numbered from 0"):
        assert FlowField.from_pyvista([at_time(None), at_time(7.0)]).times.tolist() == [0, 1]


def test_one_structured_block_is_the_mesh() -> None:
    blocks = pv.MultiBlock([None, pv.Sphere(), pv.MultiBlock([at_time(None, 5.0), None])])
    field = FlowField.from_pyvista(blocks)
    assert field.steady
    assert (field.velocity == 5).all()
    steps = [pv.MultiBlock([at_time(1.0, 1.0)]), pv.MultiBlock([at_time(2.0, 2.0)])]
    assert FlowField.from_pyvista(steps).times.tolist() == [1, 2]


def test_a_node_hidden_at_one_time_is_hidden_at_all() -> None:
    second = at_time(1.0)
    second.hide_points([5])
    field = FlowField.from_pyvista([at_time(0.0), second])
    assert np.argwhere(~field.valid).tolist() == [[1, 1]]


class Reader:
    """As little of a PyVista reader as is needed."""

    def __init__(self, meshes: dict[float, Any]) -> None:
        self.meshes = meshes
        self.time_values = list(meshes)
        self.active_time_value = self.time_values[0]

    def set_active_time_value(self, time: float) -> None:
        self.active_time_value = time

    def read(self) -> Any:
        return self.meshes[self.active_time_value]


def test_a_reader_of_a_series_is_read_through_and_left_as_it_was() -> None:
    reader = Reader({t: pv.MultiBlock([at_time(None, t)]) for t in (1.0, 2.0, 4.0)})
    reader.set_active_time_value(2.0)
    field = FlowField.from_pyvista(reader)
    assert field.times.tolist() == [1, 2, 4]
    assert field.velocity[:, 0, 0, 0].tolist() == [1, 2, 4]
    assert reader.active_time_value == 2.0
    assert FlowField.from_pyvista(Reader({3.0: at_time(None)})).times.tolist() == [3]


def test_parts_of_one_mesh_are_no_steps() -> None:
    left, right = flowing(), moved()
    right.points = np.asarray(right.points) + np.array([1.0, 0, 0])
    with says(
        "the mesh has 2 blocks that are not time steps of one mesh: 0 (left, 4 x 3 x 1 nodes), "
        '1 (right, 4 x 3 x 1 nodes); choose one, as in block="left"'
    ):
        FlowField.from_pyvista(pv.MultiBlock({"left": left, "right": right}))
    field = FlowField.from_pyvista(pv.MultiBlock({"left": left, "right": right}), block="right")
    assert field.points[..., 0].min() == 4


@pytest.mark.parametrize("lacking", [0, 1])
def test_scalar_of_some_steps_is_missing_at_the_others(lacking: int) -> None:
    steps = [at_time(0.0), at_time(1.0)]
    expected = [np.asarray(step["p"]) for step in steps]
    steps[lacking].point_data.remove("p")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", Notice)
        field = FlowField.from_pyvista(steps)
    text = f"'p' is missing at time {lacking}, where it has no data"
    assert text in str(field.reading)
    # Initial values often lack what is computed from a flow.
    told = [str(notice.message) for notice in caught]
    assert told.count(text) == lacking
    assert set(field.scalars) == {"p"} and not field.parts
    assert np.isnan(np.asarray(field.scalars["p"][lacking])).all()
    np.testing.assert_array_equal(
        np.sort(np.ravel(field.scalars["p"][1 - lacking])), np.sort(expected[1 - lacking])
    )


def test_a_gap_in_time_is_told() -> None:
    meshes = [at_time(time) for time in (0.0, 5.0, 5.25, 5.5)]
    with pytest.warns(Notice, match=r"^no data lie between the times 0 and 5, .* are 0\.25 apart"):
        FlowField.from_pyvista(meshes)
    FlowField.from_pyvista(meshes[1:])


# --- what is wrong with a mesh ---------------------------------------------------------------


PLANES = 'expected "i=N", "j=N" or "k=N" with a whole number N within'
PARTS = " If these are parts of one mesh and not time steps, give one of them, as in block=0"
KNOWN = "arrays, with their numbers of components:"


def carrying(**arrays: Any) -> Any:
    """A flat grid with point arrays; those named ``cells_...`` are of cells."""
    grid = structured()
    for name, array in arrays.items():
        of = grid.cell_data if name.startswith("cells_") else grid.point_data
        of[name.removeprefix("cells_")] = array
    return grid


def marked() -> Any:
    """A grid whose reader took the momentum for its vectors."""
    grid = carrying(Momentum=np.ones((12, 3)), Velocity=np.full((12, 3), 2.0))
    grid.set_active_vectors("Momentum")
    return grid


def moved() -> Any:
    grid = flowing()
    grid.points = np.asarray(grid.points) + np.array([3.0, 0, 0])
    return grid


@pytest.mark.parametrize(
    ("mesh", "given", "text"),
    [
        (flowing(5, 4, 3), {"plane": "k=3"}, f"plane is 'k=3'; {PLANES} 5 x 4 x 3 nodes"),
        (flowing(5, 4, 3), {"plane": "i=-6"}, f"plane is 'i=-6'; {PLANES}"),
        (flowing(5, 4, 3), {"plane": "z=3"}, f"plane is 'z=3'; {PLANES}"),
        (flowing(5, 4, 3), {"plane": 3}, f"plane is 3; {PLANES}"),
        (flowing(), {"plane": "i=2"}, "within 4 x 3 x 1 nodes (I x J x K), and no plane for a"),
        (flowing(4, 1, 1), {}, "a surface needs at least 2 along two of the axes"),
        (pv.StructuredGrid(), {}, "the mesh has 0 x 0 x 0 nodes (I x J x K); a surface needs"),
        (
            carrying(v=np.ones((12, 3)), cells_w=np.ones((6, 2))),
            {},
            "the mesh has 2 arrays that could be the velocity: v (points, 3), w (cells, 2); choose "
            'one, as in vectors="w"',
        ),
        (
            carrying(p=np.ones(12)),
            {},
            "the mesh has no vectors that could be the velocity; expected an array of real numbers",
        ),
        (
            carrying(velocity=np.ones((12, 3))),
            {"vectors": "velcity"},
            "vectors is 'velcity'; did you mean 'velocity'?",
        ),
        (
            carrying(v=np.ones((12, 3)), p=np.ones(12)),
            {"vectors": "p"},
            "vectors is 'p'; expected an array of 2 or 3 components, or the names of 2 or 3 arrays",
        ),
        (
            carrying(v=np.full((12, 3), np.nan)),
            {},
            "none of the 12 nodes is usable: all are blanked",
        ),
        ([at_time(2.0), at_time(1.0), at_time(2.0)], {}, "step 0 and step 2 both have the time 2;"),
        ([at_time(2.0), at_time(1.0)], {"times": [2, 1]}, "times[1] = 1 is not greater than times"),
        ([at_time(0.0), at_time(1.0)], {"times": [0, 1, 2]}, "times has shape (3,); expected (2,)"),
        (
            [at_time(0.0), at_time(1.0, i=5)],
            {},
            "step 1 has 5 x 3 x 1 nodes and the first step has 4 x 3 x 1 nodes; expected the same "
            f"nodes in every step.{PARTS}",
        ),
        ([flowing(), moved()], {}, "the nodes of step 1 are up to 3 away from those of the first"),
        ([at_time(0.0), carrying(p=np.ones(12))], {}, "step 1 has no array v (points, 3), which"),
        ([], {}, "the list of meshes is empty; expected one mesh for each time step"),
        (
            pv.MultiBlock([None]),
            {},
            "the mesh has no blocks; check the file or filter that made it",
        ),
        ("flow.vts", {}, "the mesh has type str; expected a PyVista mesh or MultiBlock, a list of"),
    ],
)
def test_what_is_wrong_is_told(mesh: Any, given: dict[str, Any], text: str) -> None:
    with pytest.raises(FieldError, match=re.escape(text)):
        FlowField.from_pyvista(mesh, **given)


# --- manners --------------------------------------------------------------------------------


def test_the_mesh_is_not_changed() -> None:
    grid = flowing(4, 3, 2)
    grid.cell_data["c"] = np.arange(6.0)
    grid.hide_points([3])
    before = grid.copy()
    field = FlowField.from_pyvista(grid, vectors="v", plane="k=1", name="mine")
    assert field.name == "mine"
    assert grid == before
    assert grid.active_vectors_name is None
    assert not np.shares_memory(field.points, np.asarray(grid.points))


def test_of_a_volume_the_middle_is_drawn_with_a_notice() -> None:
    told = r'the plane is "k=1", the middle of 5 x 4 x 3 nodes .* in plane="j=2", .* slice="z"$'
    with pytest.warns(Notice, match=told):
        field = FlowField.from_pyvista(flowing(5, 4, 3))
    np.testing.assert_array_equal(
        field.velocity, FlowField.from_pyvista(flowing(5, 4, 3), plane="k=1").velocity
    )


def test_of_several_vectors_the_one_that_is_named_so_is_the_velocity() -> None:
    told = r'the velocity is "Velocity", chosen by its name; other vectors: Momentum \(points, 3\)'
    with pytest.warns(Notice, match=told):
        FlowField.from_pyvista(marked())


def test_an_array_on_points_and_on_cells_is_one() -> None:
    grid = carrying(w=np.full((12, 3), 2.0), cells_w=np.ones((6, 3)))
    assert np.all(FlowField.from_pyvista(grid).velocity[..., :2] == 2)
