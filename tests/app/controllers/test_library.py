"""What a page may open: which files of a folder are listed, and those that it brings itself."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from small_pages import small

from flowtex import FlowField, examples
from flowtex.app import Choice, Library
from flowtex.app.controllers.library import reason_text
from flowtex.errors import FieldError
from flowtex.pyramid import build
from flowtex.scene.fields import TracedFlow
from flowtex.settings import Settings
from flowtex.sources.open_source import MeshSource
from flowtex.textures.tiles.shared import has_pyramid


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A series with its steps in a folder, a surface without vectors, and a text."""
    (tmp_path / "steps").mkdir()
    for n in range(2):
        examples.double_gyre(float(n)).save(tmp_path / "steps" / f"{n}.vts")
    lines = [f'<DataSet timestep="{n}" file="steps/{n}.vts"/>' for n in range(2)]
    text = f'<VTKFile type="Collection"><Collection>{"".join(lines)}</Collection></VTKFile>'
    (tmp_path / "series.pvd").write_text(text)
    pv.Sphere().save(tmp_path / "hull.stl")
    (tmp_path / "notes.txt").write_text("nothing")
    return tmp_path


def test_members_of_a_series_are_folded_and_surfaces_without_vectors_left_out(folder: Path) -> None:
    library = Library.of(folder)
    assert library.names == ("series.pvd",)
    with pytest.raises(FieldError, match="is not among those"):
        library.source("hull.stl")


def test_reasons_of_undrawable_files(folder: Path) -> None:
    """A surface without vectors, and files that cannot be read, have a reason and no path."""
    (folder / "torn.vts").write_text("<VTKFile", encoding="utf-8")
    pv.Plane().cast_to_unstructured_grid().save(folder / "still.vtu")
    library = Library.of(folder)
    assert library.names == ("series.pvd", "still.vtu", "torn.vts")
    because = "a surface without vectors; put them into hull.npy, one row for each point"
    assert library.unshown == {"hull.stl": because}
    assert not library.may_open("hull.stl")
    for name in ("torn.vts", "still.vtu"):
        with pytest.raises(FieldError):
            library.field(name, library.complete(name, Choice()))
    assert library.names == ("series.pvd", "still.vtu", "torn.vts")
    assert list(library.unshown) == ["hull.stl", "still.vtu", "torn.vts"]
    for name, reason in library.branch().unshown.items():
        assert str(folder) not in reason and "\n" not in reason
        assert 10 < len(reason) <= 200
        assert not reason.startswith(name)
    assert "vectors" in library.unshown["still.vtu"]
    # A file that is written again may be drawn.
    gyre(folder / "torn.vts", 1.0)
    assert library.names == ("series.pvd", "still.vtu", "torn.vts")
    assert "torn.vts" not in library.unshown
    library.field("torn.vts", library.complete("torn.vts", Choice()))


def test_undrawable_part_is_no_fault_of_a_file(tmp_path: Path) -> None:
    gyre(tmp_path / "flow.vts", 0.0)
    library = Library.of(tmp_path)
    with pytest.raises(FieldError):
        library.field("flow.vts", Choice(vectors="missing"))
    assert library.names == ("flow.vts",) and library.unshown == {}


def test_folder_without_a_flow_names_reasons(tmp_path: Path) -> None:
    pv.Sphere().save(tmp_path / "hull.stl")
    with pytest.raises(
        FieldError, match=r"no file that can be opened.*hull.stl: a surface without"
    ):
        Library.of(tmp_path)


def test_reason_has_no_path(tmp_path: Path) -> None:
    path = tmp_path / "flow.vtu"
    error = FieldError(f"{path}: cannot be read: {tmp_path}/flow.vtu is\nnot XML")
    assert reason_text(error, [path]) == "cannot be read: flow.vtu is not XML"
    missing = FileNotFoundError(2, "No such file or directory", str(path))
    assert reason_text(missing, [path]) == "No such file or directory"


def test_pyramids_in_a_folder_are_offered(folder: Path) -> None:
    pytest.importorskip("zarr")
    y, x = np.mgrid[0:40, 0:60] / 10.0
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack([y, x], axis=-1))
    build(field, folder / "deep" / "ocean.zarr", progress=False)
    library = Library.of(folder)
    assert library.names == ("series.pvd", "deep/ocean.zarr")
    for shown in (library.branch(), Library.of(folder / "deep" / "ocean.zarr")):
        name = shown.names[-1]
        opened = shown.field(name, shown.complete(name, Choice()))
        assert has_pyramid(opened) and opened.short_size == "60 × 40 nodes"


def test_a_page_has_what_it_brought_for_itself(tmp_path: Path) -> None:
    source = MeshSource(small())
    shared = Library({"flow.vts": lambda: source})
    one, other = shared.branch(), shared.branch()
    examples.double_gyre(1.0).save(tmp_path / "flow.vts")
    name = one.add("flow.vts", tmp_path / "flow.vts")
    assert name == "flow.vts (2)" and one.names == ("flow.vts", name)
    assert other.names == shared.names == ("flow.vts",)
    assert one.field(name, Choice()).shape != one.field("flow.vts", Choice()).shape
    assert one.source("flow.vts") is other.source("flow.vts") is source
    assert one.is_file(name)
    for library in (other, shared):
        with pytest.raises(FieldError, match="is not among those"):
            library.source(name)


# --- files that change --------------------------------------------------------------------------


def gyre(path: Path, moment: float) -> float:
    """Write a flow; return its mean speed at the nodes."""
    mesh = examples.double_gyre(moment)
    mesh.save(path)
    return float(np.linalg.norm(mesh["velocity"], axis=-1).mean())


def mean_speed(field: FlowField) -> float:
    return float(np.linalg.norm(field.velocity[-1], axis=-1).mean())


def test_a_page_opens_what_was_named_and_nothing_else(tmp_path: Path) -> None:
    runs, secret = tmp_path / "runs", tmp_path / "secret.vts"
    (runs / "deep").mkdir(parents=True)
    for path in (runs / "a.vts", runs / "deep" / "b.vts", secret):
        gyre(path, 1.0)
    library = Library.of(runs)
    assert library.names == ("a.vts", "deep/b.vts")
    for name in (
        *(str(secret), "../secret.vts", "deep/../../secret.vts", f"file://{secret}", "secret.vts"),
        *(str(runs / "a.vts"), "./a.vts", "A.vts", "", "https://host/a.zarr", "a.vts\0"),
    ):
        with pytest.raises(FieldError):
            library.branch().source(name)


def test_a_file_that_is_written_anew_is_opened_anew(tmp_path: Path) -> None:
    path = tmp_path / "latest.vts"
    library = Library.of(tmp_path if gyre(path, 0.0) else path)
    choice = library.complete("latest.vts", Choice())
    source, field = library.source("latest.vts"), library.field("latest.vts", choice)
    TracedFlow.of(field, Settings()).keep()
    assert library.source("latest.vts") is source
    assert library.field("latest.vts", choice) is field, "what has not changed is not read again"
    new = gyre(path, 2.5)
    again = library.field("latest.vts", choice)
    assert mean_speed(again) == pytest.approx(new) != pytest.approx(mean_speed(field))
    TracedFlow.of(field, Settings()).keep()
    assert mean_speed(library.field("latest.vts", choice)) == pytest.approx(new)
    assert library.source("latest.vts") is not source


def test_a_member_or_a_file_beside_that_changes_is_read_anew(folder: Path) -> None:
    library = Library.of(folder)
    choice = library.complete("series.pvd", Choice())
    before = library.field("series.pvd", choice)
    new = gyre(folder / "steps" / "1.vts", 2.5)
    assert mean_speed(library.field("series.pvd", choice)) == pytest.approx(new)
    assert mean_speed(before) != pytest.approx(new)
    nodes = pv.read(folder / "hull.stl").points
    for turn in (1.0, 2.0):
        np.save(folder / "hull.npy", turn * np.cross(nodes, [0.0, 0.0, 1.0]))
        hull = library.field("hull.stl", Choice()) if "hull.stl" in library.names else None
        assert hull is not None
        assert np.linalg.norm(hull.velocity, axis=-1).max() == pytest.approx(turn / 2, rel=0.02)


def test_a_source_whose_process_has_died_is_opened_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flowtex.sources.remote.READER", "child_handler:TrickyReader")
    gyre(tmp_path / "flow.vts", 0.0)
    library = Library.of(tmp_path)
    source: Any = library.source("flow.vts")
    with pytest.raises(FieldError, match="crashed"):
        source._file.ask("trick", level="crash")
    assert library.source("flow.vts") is not source
    assert library.field("flow.vts", Choice()).steady


# --- large fields -------------------------------------------------------------------------------


def test_a_formula_that_is_typed_is_a_flow_where_that_is_allowed() -> None:
    line = "y; -sin(x) - b*y; x=-7,7; b=0.2"
    flows = {"gyre": lambda: MeshSource(small())}
    library = Library(flows, typed=True).branch()
    field = library.field(line, library.complete(line, Choice()))
    assert field.formula is not None and field.formula.texts == ("y", "-sin(x) - b*y")
    assert library.names == ("gyre",) and not library.is_file(line)
    with pytest.raises(FieldError, match="cannot be read"):
        library.source("y; sin(x")
    for name, other in ((line, Library(flows)), ("../secret", library)):
        with pytest.raises(FieldError, match="is not among those"):
            other.source(name)
