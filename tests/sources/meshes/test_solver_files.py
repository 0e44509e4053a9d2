"""Files as flow solvers write them: blocks by their paths, times, and what is not drawn yet."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from cfd_files import (
    CGNS,
    TIMES,
    box,
    turning,
    write_ensight,
    write_exodus,
    write_foam,
    write_wall_stress,
)

from flowtex import FlowField
from flowtex.app.controllers.library import Library
from flowtex.errors import FieldError, Notice
from flowtex.sources.meshes.separate import SeparateReader
from flowtex.sources.open_source import MeshSource
from flowtex.sources.read_files import BlockSummary, describe, file_identity, open_reader

#: The flows of these tests go through their meshes.
pytestmark = pytest.mark.filterwarnings(
    "ignore:.*of the flow is normal to the surface:flowtex.errors.Notice"
)

TIP, BODY = box(4, 3, 2), box(6, 3, 2, 3.0)


def says(text: str) -> pytest.RaisesExc[FieldError]:
    """Expect an error with exactly this text."""
    return pytest.raises(FieldError, match=f"^{re.escape(text)}$")


def cgns(path: Path) -> Path:
    """Two bases, one of them with two zones."""
    with CGNS.write(path) as file:
        file.base("Wing", [("Zone 1", TIP), ("Zone 2", BODY)], times=TIMES)
        file.base("Tail", [("Zone 1", TIP)], times=TIMES, where="cells")
    return path


def test_zones_of_cgns_are_blocks_by_their_paths(tmp_path: Path) -> None:
    path = cgns(tmp_path / "flow.cgns")
    field = FlowField.from_file(path, block="Wing/Zone 2", plane="k=0")
    assert field.times.tolist() == list(TIMES)
    assert np.allclose(field.velocity[0], turning(BODY)[0])
    assert np.allclose(field.velocity[1], turning(BODY, 2.0)[0])
    assert list(field.scalars) == ["Pressure"]
    field = FlowField.from_file(path, block=2, plane="k=0", time=1.0)
    assert field.steady and field.shape == (3, 4), "cells have become nodes"
    with says(
        f"{path}: step 0 has 3 blocks that are not time steps of one mesh: 0 (Wing/Zone 1, "
        "4 x 3 x 2 nodes), 1 (Wing/Zone 2, 6 x 3 x 2 nodes), 2 (Tail/Zone 1, 4 x 3 x 2 nodes); "
        'choose one, as in block="Wing/Zone 1", draw a plane of all, as in plane="k=1", or cut all '
        'volumes, as in slice="z"'
    ):
        FlowField.from_file(path)


def test_cgns_tells_what_it_holds(tmp_path: Path) -> None:
    summary = describe(cgns(tmp_path / "flow.cgns"))
    assert summary.times == TIMES
    assert summary.blocks == (
        BlockSummary("Wing/Zone 1", 0, "StructuredGrid", "4 x 3 x 2 nodes"),
        BlockSummary("Wing/Zone 2", 1, "StructuredGrid", "6 x 3 x 2 nodes"),
        BlockSummary("Tail/Zone 1", 2, "StructuredGrid", "4 x 3 x 2 nodes"),
    )
    assert summary.problem.startswith("the file has 3 blocks that are not time steps of one mesh:")
    summary = describe(tmp_path / "flow.cgns", block="Tail/Zone 1")
    assert [(a.name, a.where) for a in summary.arrays] == [
        ("Velocity", "cells"),
        ("Pressure", "cells"),
    ]
    assert summary.problem == ""


def ensight(path: Path) -> Path:
    write_ensight(path, [("wing tip", TIP), ("body", BODY)])
    return path


def test_parts_of_ensight(tmp_path: Path) -> None:
    path = ensight(tmp_path / "flow.case")
    field = FlowField.from_file(path, block="body", plane="k=1", vectors="velocity")
    assert field.times.tolist() == list(TIMES)
    assert np.allclose(field.velocity[1], turning(BODY, 2.0)[1])
    again = FlowField.from_file(path, block=1, plane="k=1", vectors="u,v,w", time=1)
    assert np.array_equal(again.velocity[0], field.velocity[1])
    between = FlowField.from_file(path, block=1, plane="k=1", vectors="velocity", time=0.625)
    assert between.steady and between.times.tolist() == [0.625]
    assert np.allclose(between.velocity[0], turning(BODY, 1.25)[1])
    assert "interpolated between the times 0.5 and 1" in between.reading.of("align")
    last = FlowField.from_file(path, block=1, plane="k=1", vectors="velocity", time="last")
    assert np.array_equal(last.velocity[0], field.velocity[1])
    summary = describe(path)
    assert summary.times == TIMES
    assert [block.name for block in summary.blocks] == ["wing tip", "body"]


def test_ensight_is_read_in_another_process_as_vtk_reads_it(tmp_path: Path) -> None:
    path = ensight(tmp_path / "flow.case")
    mine = open_reader(path)
    own = pv.EnSightReader(str(path))
    assert isinstance(mine, SeparateReader)
    assert mine.time_values == own.time_values
    assert mine.active_time_value == own.active_time_value
    for reader in (mine, own):
        reader.set_active_time_value(TIMES[1])
    found = mine.read()
    expected = own.read()
    assert found.keys() == expected.keys()
    for block, mesh in zip(found, expected, strict=True):
        assert block == mesh
        assert list(block.point_data) == list(mesh.point_data)
        assert block.active_vectors_name == mesh.active_vectors_name == "velocity"
        assert block.active_scalars_name == mesh.active_scalars_name


@pytest.mark.parametrize("write", [cgns, ensight])
def test_blocks_with_times_are_read_when_they_are_asked_for(
    tmp_path: Path, write: Callable[[Path], Path]
) -> None:
    path = write(tmp_path / ("flow.cgns" if write is cgns else "flow.case"))
    source = MeshSource.from_file(path)
    assert source.nbytes == 0
    last = source.blocks[1]
    assert source.block_vectors[last][0].lower() == "velocity"
    field = source.field(block=last, plane="k=0")
    assert field.times.tolist() == list(TIMES)
    assert np.allclose(field.velocity[1], turning(BODY, 2.0)[0])
    assert source.nbytes == source.part(last).nbytes > 0
    assert np.allclose(source.field(block="1", plane="k=0").velocity, field.velocity)
    assert source.field(block=source.blocks[0]).shape == (3, 4)
    with pytest.raises(FieldError, match=r"block is 'nowhere'; expected one of "):
        source.field(block="nowhere")


def test_nested_blocks(tmp_path: Path) -> None:
    left, right = (pv.ImageData(dimensions=(n, 3, 1)).cast_to_structured_grid() for n in (4, 6))
    for grid in (left, right):
        grid["v"] = np.asarray(grid.points) + 1
    base = pv.MultiBlock({"a/b": left, "hull": pv.Sphere()})
    base.append(right, "a/b")
    tree = pv.MultiBlock({"Base": base, "c": right})
    tree.save(tmp_path / "flow.vtm")
    path = tmp_path / "flow.vtm"
    assert [b.name for b in describe(path).blocks] == ["Base/a/b 0", "Base/hull", "Base/a/b 2", "c"]
    assert FlowField.from_file(path, block="Base/a/b 0").shape == (3, 4)
    assert FlowField.from_file(path, block="Base/a/b 2").shape == (3, 6)
    assert FlowField.from_pyvista(tree, block="c").shape == (3, 6)
    with pytest.raises(FieldError, match="the mesh has no vectors that could be"):
        FlowField.from_file(path, block="Base/hull")


OUTER = "the outer surface of the volume is drawn"


def test_openfoam_tells_its_patches_and_times(tmp_path: Path) -> None:
    path = tmp_path / "case.foam"
    write_foam(path)
    summary = describe(path)
    assert summary.times == TIMES
    assert [(b.name, b.grid) for b in summary.blocks] == [
        ("internalMesh", "UnstructuredGrid"),
        ("boundary/inlet", "PolyData"),
        ("boundary/outlet", "PolyData"),
        ("boundary/walls", "PolyData"),
    ]
    assert "U" in summary.candidates
    assert summary.problem == ""
    with pytest.warns(Notice, match=OUTER):
        field = FlowField.from_file(path)
    assert field.times.tolist() == list(TIMES) and field.triangles is not None
    cut = FlowField.from_file(path, slice="z", time=TIMES[0])
    assert cut.steady and np.ptp(cut.points[..., 2]) < 1e-6
    assert FlowField.from_file(path, block="boundary/walls").triangles is not None
    source = MeshSource.from_file(path)
    assert source.blocks[0] == "internalMesh" and "boundary/walls" in source.blocks


def test_wall_stress_that_the_first_time_lacks(tmp_path: Path) -> None:
    path = tmp_path / "case.foam"
    write_foam(path)
    stress = write_wall_stress(path)
    walls = "boundary/walls"
    with pytest.warns(Notice) as caught:
        field = FlowField.from_file(path, block=walls)
    assert [str(notice.message) for notice in caught.list[:2]] == [
        '"U" is zero on this wall, so "wallShearStress" is drawn; to draw the other one, '
        'vectors="U"',
        "no array 'wallShearStress' at time 0.5, which is left out",
    ]
    assert field.times.tolist() == [1.0]
    # The mean of the faces around each node, as PyVista computes it.
    reader: Any = pv.OpenFOAMReader(str(path))
    reader.set_active_time_value(1.0)
    mesh = reader.read()["boundary"]["walls"]
    mesh.clear_point_data()
    assert np.allclose(mesh.cell_data["wallShearStress"], stress)
    means = mesh.cell_data_to_point_data()
    places = field.points.reshape(-1, 3)
    at = [int(means.find_closest_point(point.tolist())) for point in places]
    expected = np.asarray(means["wallShearStress"])[at]
    assert field.vectors == "wallShearStress"
    assert np.allclose(field.velocity[0].reshape(-1, 3), expected, atol=1e-6)
    with says(f"{path}: time is 0.5; 'wallShearStress' has the times 1"):
        FlowField.from_file(path, block=walls, vectors="wallShearStress", time=0.5)
    with pytest.warns(UserWarning, match="^The velocity is zero at every node"):
        field = FlowField.from_file(path, block=walls, vectors="U")
    assert field.times.tolist() == list(TIMES)
    with says(
        f"{path}: vectors is 'V'; expected one of: U, U. The arrays of the mesh, with their "
        "numbers of components: U (points, 3), U (cells, 3); other times have wallShearStress "
        "(points, 3) at time 1, wallShearStress (cells, 3) at time 1"
    ):
        FlowField.from_file(path, block=walls, vectors="V")


def test_arrays_of_later_times_are_listed(tmp_path: Path) -> None:
    path = tmp_path / "case.foam"
    write_foam(path)
    stress = write_wall_stress(path)
    summary = describe(path, block="boundary/walls")
    assert summary.candidates == ("U", "wallShearStress")
    (array,) = [a for a in summary.arrays if a.name == "wallShearStress" and a.where == "cells"]
    assert array.since == 1.0
    assert array.high == pytest.approx(np.linalg.norm(stress, axis=1).max())
    source = MeshSource.from_file(path)
    assert source.block_vectors["boundary/walls"] == ("U", "wallShearStress")
    walls = source.part("boundary/walls")
    assert walls.vectors == ("wallShearStress", "U")
    assert walls.field().vectors == "wallShearStress"


def test_openfoam_in_the_pieces_of_a_parallel_run(tmp_path: Path) -> None:
    path = tmp_path / "case.foam"
    write_foam(path, decomposed=True)
    summary = describe(path)
    assert summary.times == TIMES
    assert summary.blocks[0].name == "internalMesh"
    assert "U" in summary.candidates


def test_exodus_tells_what_it_is(tmp_path: Path) -> None:
    path = tmp_path / "flow.ex2"
    write_exodus(path, TIP)
    summary = describe(path)
    assert "velocity" in summary.candidates
    with pytest.warns(Notice, match=OUTER):
        assert FlowField.from_file(path).triangles is not None


def test_hexahedra_of_cgns(tmp_path: Path) -> None:
    path = tmp_path / "flow.cgns"
    with CGNS.write(path) as file:
        file.base("Base", [("Zone", TIP)], hexahedra=True)
    assert "Velocity" in describe(path).candidates
    with pytest.warns(Notice, match=OUTER):
        assert FlowField.from_file(path).triangles is not None
    assert FlowField.from_file(path, slice="z").triangles is not None


@pytest.mark.parametrize("name", ["", "case.OpenFOAM", "processors", "case.OpenFOAM in pieces"])
def test_case_of_openfoam_by_its_folder_or_another_ending(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "cavity"
    folder.mkdir()
    usual = folder / "case.foam"
    write_foam(usual, decomposed="pieces" in name or name == "processors")
    path = folder
    if name.startswith("case"):
        path = usual.with_name("case.OpenFOAM")
        path.touch()
    with pytest.warns(Notice, match=OUTER):
        expected = FlowField.from_file(usual)
    if not name.startswith("case"):
        usual.unlink()
    with pytest.warns(Notice, match=OUTER):
        field = FlowField.from_file(path)
    assert field.times.tolist() == list(TIMES)
    np.testing.assert_array_equal(field.points, expected.points)
    np.testing.assert_array_equal(field.velocity, expected.velocity)
    assert describe(path).times == TIMES
    assert len(Library.of(path).names) == 1
    assert {str(folder / "0.5" / "U"), str(folder / "processor0" / "0.5" / "U")} & {
        file for file, *_ in file_identity([path])
    }


def test_case_of_openfoam_without_its_control_raises(tmp_path: Path) -> None:
    (tmp_path / "case" / "constant" / "polyMesh").mkdir(parents=True)
    with pytest.raises(FieldError, match=r"without system/controlDict; .*case\.foam in it"):
        FlowField.from_file(tmp_path / "case")
    (tmp_path / "x.foam").touch()
    with pytest.raises(FieldError, match="its folder has no folder constant"):
        FlowField.from_file(tmp_path / "x.foam")


def test_each_step_of_a_file_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = pv.Plane(i_resolution=4, j_resolution=4)
    mesh.point_data["U"] = np.tile([1.0, 0.0, 0.0], (mesh.n_points, 1))
    mesh.save(tmp_path / "plane.vtp")
    reads = []
    read = pv.XMLPolyDataReader.read

    def counted(reader: Any) -> Any:
        reads.append(reader)
        return read(reader)

    monkeypatch.setattr(pv.XMLPolyDataReader, "read", counted)
    FlowField.from_file(tmp_path / "plane.vtp")
    assert len(reads) == 1
