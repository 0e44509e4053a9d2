"""Files become a field or one clear sentence, and tell what they hold."""

from __future__ import annotations

import logging
import os
import re
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from waiting import PATIENCE_S

from flowtex import FlowField
from flowtex.errors import FieldError, Notice
from flowtex.sources.meshes.plot3d import find_grid, find_solution
from flowtex.sources.read_files import describe, file_identity
from flowtex.sources.reader_errors import errors_of_file

pv = pytest.importorskip("pyvista")


#: The flows of these tests go through their meshes.
pytestmark = pytest.mark.filterwarnings(
    "ignore:.*of the flow is normal to the surface:flowtex.errors.Notice"
)

KNOWN = (
    "a mesh that PyVista reads (.vts, .vtr, .vti, .vtk, .vtu, .vtp, .vtm, .pvd, .cgns, .case, "
    ".foam, .xdmf and more) or meshio (.msh, .med and more), PLOT3D (.xyz with .q beside it), or a "
    "dataset or table (.nc, .zarr, .grib, .json, .geojson, .csv, .txt, .vec)"
)


def says(text: str) -> pytest.RaisesExc[FieldError]:
    """Expect an error with exactly this text."""
    return pytest.raises(FieldError, match=f"^{re.escape(text)}$")


def flowing(i: int = 4, j: int = 3, k: int = 1, speed: float = 1.0) -> Any:
    """A structured grid with a velocity and a pressure."""
    z, y, x = np.meshgrid(*[np.arange(float(n)) for n in (k, j, i)], indexing="ij")
    grid = pv.StructuredGrid()
    grid.points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    grid.dimensions = (i, j, k)
    grid["v"] = np.asarray(grid.points) * speed + 1.0
    grid["p"] = np.arange(float(grid.n_points))
    return grid


def series(folder: Path, times: tuple[float, ...] = (0.5, 1.0, 2.0)) -> Path:
    """A .pvd file with one grid for each time."""
    lines = []
    for n, time in enumerate(times):
        flowing(speed=time).save(folder / f"step{n}.vts")
        lines.append(f'<DataSet timestep="{time}" file="step{n}.vts"/>')
    text = f'<VTKFile type="Collection"><Collection>{"".join(lines)}</Collection></VTKFile>'
    (folder / "flow.pvd").write_text(text, encoding="utf-8")
    return folder / "flow.pvd"


# --- formats of VTK -------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".vts", ".vtk"])
def test_a_structured_grid(tmp_path: Path, suffix: str) -> None:
    flowing().save(tmp_path / f"my flow{suffix}")
    field = FlowField.from_file(tmp_path / f"my flow{suffix}")
    assert field.name == "my flow"
    assert field.shape == (3, 4)
    assert list(field.scalars) == ["p"]


@pytest.mark.parametrize(
    ("grid", "suffix"),
    [
        (pv.ImageData(dimensions=(4, 3, 2)), ".vti"),
        (pv.RectilinearGrid(np.arange(4.0), np.arange(3.0), np.arange(2.0)), ".vtr"),
    ],
)
def test_other_grids_and_the_options(tmp_path: Path, grid: Any, suffix: str) -> None:
    path = tmp_path / f"flow{suffix}"
    mesh = grid.copy()
    mesh["a"], mesh["b"] = np.ones((24, 3)), np.random.default_rng(0).random((24, 3))
    mesh.save(path)
    field = FlowField.from_file(path, vectors="b", plane="k=1", periodic="i")
    assert field.periodic == (False, True)
    assert field.shape == (3, 5)
    assert np.array_equal(field.velocity[0, :, :4], mesh["b"].reshape(2, 3, 4, 3)[1])


def test_a_series_and_one_time_of_it(tmp_path: Path) -> None:
    field = FlowField.from_file(series(tmp_path))
    assert field.times.tolist() == [0.5, 1, 2]
    assert field.velocity[:, 0, 1, 0].tolist() == [1.5, 2, 3]
    one = FlowField.from_file(series(tmp_path), time=1)
    assert one.steady and one.velocity[:, 0, 1, 0].tolist() == [2]
    assert one.times.tolist() == [1], "so that a picture tells its time"


def test_a_time_that_is_not_there(tmp_path: Path) -> None:
    path = series(tmp_path)
    with says(f"{path}: time is 7; the file has the times 0.5, 1, 2"):
        FlowField.from_file(path, time=7)
    flowing().save(tmp_path / "flow.vts")
    with says(f"{tmp_path / 'flow.vts'}: time is 0.7; the file has no times"):
        FlowField.from_file(tmp_path / "flow.vts", time=0.7)


def test_one_of_several_blocks(tmp_path: Path) -> None:
    path = tmp_path / "flow.vtm"
    pv.MultiBlock({"left": flowing(), "hull": pv.Sphere(), "right": flowing(6)}).save(path)
    assert FlowField.from_file(path, block=0).shape == (3, 4)
    assert FlowField.from_file(path, block=2).shape == (3, 6)
    assert FlowField.from_file(path, block="right").shape == (3, 6)
    with says(f"{path}: block is 3; the blocks of the file are: 0 (left), 1 (hull), 2 (right)"):
        FlowField.from_file(path, block=3)
    inner = pv.MultiBlock({"hull": flowing(), "top": flowing(6)})
    pv.MultiBlock({"inside": flowing(5), "boundary": inner}).save(path)
    assert FlowField.from_file(path, block="top").shape == (3, 6), "boundary/top"


# --- PLOT3D ---------------------------------------------------------------------------------


@dataclass
class Plot3D:
    """Writes PLOT3D in any of its layouts."""

    binary: bool = True
    order: str = ">"
    marks: bool = False
    double: bool = False
    blanked: bool = False
    axes: int = 3
    several: bool = False
    sizes: list[tuple[int, ...]] = field(default_factory=lambda: [(6, 5, 3)])
    out: bytes = b""

    def record(self, *parts: Any) -> None:
        """Add one record of whole or real numbers."""
        if self.binary:
            kinds = {"i": f"{self.order}i4", "f": f"{self.order}f{8 if self.double else 4}"}
            body = b"".join(
                np.asarray(p).astype(kinds[np.asarray(p).dtype.kind]).tobytes() for p in parts
            )
            mark = np.array([len(body)], f"{self.order}i4").tobytes() if self.marks else b""
            self.out += mark + body + mark
            return
        for part in parts:
            self.out += (" ".join(f"{n:.8g}" for n in np.ravel(part)) + "\n").encode()

    def header(self) -> None:
        self.out = b""
        if self.several:
            self.record([len(self.sizes)])
        self.record(np.array(self.sizes)[:, : self.axes])

    def save(self, grid: Path, solution: Path) -> None:
        """Write nodes at their indices with momentum (x + 1, y, 2) and a density of 2."""
        self.header()
        places = []
        for number, size in enumerate(self.sizes):
            shape = (*size, 1)[:3] if self.axes == 2 else size
            index = np.indices(shape[::-1])[::-1].astype(float)
            index[0] += 100 * number
            places.append(index)
            blank = np.ones(shape[::-1], int)
            blank[..., 2, 2] = 0
            self.record(index[: self.axes], *[blank] * self.blanked)
        grid.write_bytes(self.out)
        self.header()
        for x, y, z in places:
            self.record([0.5, 0.0, 1e3, 7.0])
            momentum = [x + 1, y, 0 * z + 2][: self.axes]
            self.record(np.array([0 * x + 2, *momentum, 0 * x + 9]))
        solution.write_bytes(self.out)


LAYOUTS = [
    Plot3D(binary=binary, order=order, marks=marks, double=double, blanked=blanked)
    for binary, order, marks, double in [
        (True, ">", False, False),
        (True, "<", False, False),
        (True, ">", True, False),
        (True, "<", True, False),
        (True, "<", True, True),
        (True, ">", False, True),
        (False, "", False, False),
    ]
    for blanked in (False, True)
]


def label(layout: Plot3D) -> str:
    kind = f"binary{layout.order}" if layout.binary else "text"
    parts = [kind, *[n for n in ("marks", "double", "blanked") if getattr(layout, n)]]
    return " ".join(parts)


@pytest.mark.parametrize("several", [False, True])
@pytest.mark.parametrize("layout", LAYOUTS, ids=label)
def test_plot3d_in_any_layout(tmp_path: Path, layout: Plot3D, several: bool) -> None:
    layout.several = several
    layout.save(tmp_path / "wing.xyz", tmp_path / "wing.q")
    field = FlowField.from_file(tmp_path / "wing.xyz", plane="k=1")
    assert field.name == "wing"
    j, i = np.indices((5, 6)).astype(float)
    assert np.array_equal(field.points, np.stack([i, j, 0 * i + 1], axis=-1))
    velocity = np.stack([(i + 1) / 2, j / 2, 0 * i + 1], axis=-1)
    np.testing.assert_allclose(field.velocity[0], velocity * field.valid[..., None])
    assert np.argwhere(~field.valid).tolist() == [[2, 2]] * layout.blanked


@pytest.mark.parametrize("binary", [True, False])
def test_plot3d_of_two_dimensions(tmp_path: Path, binary: bool) -> None:
    Plot3D(binary=binary, axes=2, sizes=[(5, 4)]).save(tmp_path / "a.x", tmp_path / "a.q")
    field = FlowField.from_file(tmp_path / "a.x")
    assert field.shape == (4, 5)
    assert field.velocity[0, 3, 4].tolist() == [2.5, 1.5, 0]


def test_plot3d_of_several_grids(tmp_path: Path) -> None:
    sizes: list[tuple[int, ...]] = [(5, 4, 3), (3, 6, 2)]
    Plot3D(several=True, sizes=sizes).save(tmp_path / "a.g", tmp_path / "a.q")
    assert FlowField.from_file(tmp_path / "a.g", plane="k=0", block=1).shape == (6, 3)
    with says(
        f"{tmp_path / 'a.g'}: the mesh has 2 blocks that are not time steps of one mesh: 0 (0, "
        '5 x 4 x 3 nodes), 1 (1, 3 x 6 x 2 nodes); choose one, as in block="0", draw a plane of '
        'all, as in plane="k=1", or cut all volumes, as in slice="z"'
    ):
        FlowField.from_file(tmp_path / "a.g")
    with pytest.warns(Notice, match="2 blocks are drawn together: 0, 1"):
        both = FlowField.from_file(tmp_path / "a.g", plane="k=0")
    assert both.triangles is not None
    assert len(both.triangles) == 2 * (4 * 3 + 2 * 5)
    assert describe(tmp_path / "a.g").problem == (
        "the file has 2 blocks that are not time steps of one mesh: 0 (0, 5 x 4 x 3 nodes), "
        '1 (1, 3 x 6 x 2 nodes); choose one, as in block="0", draw a plane of '
        'all, as in plane="k=1", or cut all volumes, as in slice="z"'
    )
    assert describe(tmp_path / "a.g", block=1).size == "3 x 6 x 2 nodes"


@pytest.mark.parametrize(
    ("grid", "solution"),
    [
        ("postxyz.bin", "postq.bin"),
        ("xyz.dat", "q.dat"),
        ("wing.xyz", "wing.q"),
        ("WING.XYZ", "WING.Q"),
        ("wing.x", "wing.q"),
        ("wing.g", "wing.q"),
        ("wing.p3d", "wing.q"),
    ],
)
def test_the_two_files_find_each_other(tmp_path: Path, grid: str, solution: str) -> None:
    Plot3D().save(tmp_path / grid, tmp_path / solution)
    assert find_solution(tmp_path / grid) == tmp_path / solution
    assert find_grid(tmp_path / solution) == tmp_path / grid
    for name in (grid, solution):
        found = FlowField.from_file(tmp_path / name, plane="k=1")
        assert found.shape == (5, 6)
        assert found.name == Path(name).stem


def test_a_grid_without_its_solution(tmp_path: Path) -> None:
    path = tmp_path / "postxyz.bin"
    Plot3D().save(path, tmp_path / "other.q")
    with says(
        f"{path}: {path} is a PLOT3D grid, but its solution, which contains the velocity, is not "
        "in the same folder (tried postq.bin, postxyz.q); put it there under one of these names"
    ):
        FlowField.from_file(path)


def test_identity_lists_no_more_folders_than_it_compares(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("a", "b", "c"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "0").touch()
    listed: list[str] = []
    scandir = os.scandir

    def listing(path: Any) -> Any:
        listed.append(Path(path).name)
        return scandir(path)

    monkeypatch.setattr("flowtex.sources.read_files.MOST_FILES", 2)
    monkeypatch.setattr(os, "scandir", listing)
    identity = file_identity([tmp_path])
    monkeypatch.undo()
    assert [Path(name).name for name, *_ in identity] == [tmp_path.name, "0"]
    assert "a" in listed and "c" not in listed


# --- what cannot be read --------------------------------------------------------------------


def test_a_file_that_is_missing(tmp_path: Path) -> None:
    flowing().save(tmp_path / "flow.vtk")
    with says(
        f"{tmp_path / 'flow.vts'}: the file does not exist; check the spelling and the folder "
        "(patterns are not expanded). Similar names: flow.vtk"
    ):
        FlowField.from_file(tmp_path / "flow.vts")
    with says(f"{tmp_path}: this is a folder; expected a file: name the mesh inside it"):
        FlowField.from_file(tmp_path)


@pytest.mark.parametrize("suffix", [".vts", ".xyz", ".pvd", ".abc"])
def test_an_empty_file(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"flow{suffix}"
    path.touch()
    with says(f"{path}: the file is empty; expected {KNOWN}"):
        FlowField.from_file(path)


def test_a_file_without_permission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "flow.vts"
    flowing().save(path)

    def refuse(*_: Any, **__: Any) -> Any:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", refuse)
    with says(f"{path}: cannot be opened (Permission denied); check its permissions"):
        FlowField.from_file(path)


@pytest.mark.parametrize("suffix", [".pkl", ".pickle", ".joblib", ".PKL"])
def test_a_pickle_is_never_loaded(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"flow{suffix}"
    # Loading this would make a folder.
    path.write_bytes(b"cos\nmkdir\n(V" + str(tmp_path / "made").encode() + b"\ntR.")
    with says(
        f"{path}: this is a pickle, which can run any program when it is loaded, so it is "
        'refused; save the mesh as VTK instead, as in mesh.save("flow.vts")'
    ):
        FlowField.from_file(path)
    assert not (tmp_path / "made").exists()


def test_a_format_that_is_not_known(tmp_path: Path) -> None:
    path = tmp_path / "flow.abc"
    path.write_text("hello", encoding="ascii")
    with says(f"{path}: unknown format ('.abc'); expected {KNOWN}"):
        FlowField.from_file(path)
    path.rename(tmp_path / "flow")
    with says(f"{tmp_path / 'flow'}: unknown format (''); expected {KNOWN}"):
        FlowField.from_file(tmp_path / "flow")
    (tmp_path / "flow").rename(tmp_path / "flow.xyz")
    with says(f"{tmp_path / 'flow.xyz'}: unknown format (not PLOT3D); expected {KNOWN}"):
        FlowField.from_file(tmp_path / "flow.xyz")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"CDF\x01", "the file is truncated"),
        (b"x,y,u,v", r"this is not a NetCDF file: it begins with b'x,y,u,v'; expected 'CDF'"),
        (b"", "this is not a NetCDF file: it is empty"),
    ],
)
def test_broken_netcdf_is_told(tmp_path: Path, content: bytes, words: str) -> None:
    path = tmp_path / "flow.nc"
    path.write_bytes(content)
    with pytest.raises(FieldError, match=rf"flow\.nc: {words}"):
        FlowField.from_file(path)


@pytest.mark.vtk_log_allowed("these files are broken")
@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        ("a.vts", "<VTKFile/>", "Cannot find StructuredGrid element in file."),
        (
            "a.vtk",
            "# vtk DataFile Version 3.0\n\ngarbage\n",
            "Unrecognized file type: garbage for file: {path}",
        ),
        ("a.vti", '<VTKFile type="ImageData"></VTKFile>', "Cannot find ImageData element in file."),
    ],
)
def test_a_broken_file(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], name: str, text: str, reason: str
) -> None:
    path = tmp_path / name
    path.write_text(text, encoding="ascii")
    reason = reason.format(path=path)
    with says(
        f"{path}: the file is damaged, incomplete, or not of this format. VTK reports: {reason}"
    ):
        FlowField.from_file(path)
    with says(
        f"{path}: the file is damaged, incomplete, or not of this format. VTK reports: {reason}"
    ):
        describe(path)
    out, err = capfd.readouterr()
    assert out == err == "", "VTK's own lines got through"


def test_a_broken_series(tmp_path: Path) -> None:
    path = tmp_path / "a.pvd"
    path.write_text("garbage", encoding="ascii")
    with says(
        f"{path}: the file is not valid XML (syntax error: line 1, column 0); write or copy "
        "it again"
    ):
        FlowField.from_file(path)
    whole = series(tmp_path)
    (tmp_path / "step1.vts").unlink()
    with says(
        f"{whole}: cannot be read: Path '{tmp_path / 'step1.vts'}' is invalid or does not exist."
    ):
        FlowField.from_file(whole)


@pytest.mark.vtk_log_allowed("a file is broken on purpose")
def test_logging_is_left_as_it_was(tmp_path: Path) -> None:
    from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow

    (tmp_path / "a.vts").write_text("<VTKFile/>", encoding="ascii")
    root = logging.getLogger()

    def state() -> tuple[Any, ...]:
        cutoff, window = vtkLogger.GetCurrentVerbosityCutoff(), vtkOutputWindow.GetInstance()
        return list(root.handlers), list(root.filters), cutoff, window

    before = state()
    with pytest.raises(FieldError):
        FlowField.from_file(tmp_path / "a.vts")
    assert before == state()


MANY_THREADS = """
import sys
from concurrent.futures import ThreadPoolExecutor
from flowtex.errors import FieldError
from flowtex.field import FlowField

def faults(path):
    found = set()
    for _ in range(60):
        try:
            FlowField.from_file(path)
        except FieldError as error:
            found.add(str(error))
    return found

with ThreadPoolExecutor(4) as pool:
    found = set().union(*pool.map(faults, [sys.argv[1]] * 4))
print(*found, sep="\\n")
"""


def test_threads_that_read_broken_files_do_not_corrupt_the_heap(tmp_path: Path) -> None:
    path = tmp_path / "a.vts"
    path.write_text("<VTKFile/>", encoding="ascii")
    done = subprocess.run(
        [sys.executable, "-c", MANY_THREADS, str(path)],
        capture_output=True,
        text=True,
        check=False,
        timeout=PATIENCE_S,
    )
    assert done.returncode == 0, f"{done.returncode}: {done.stderr}"
    assert done.stderr == ""
    (fault,) = done.stdout.splitlines()
    assert fault.startswith(
        f"{path}: the file is damaged, incomplete, or not of this format. VTK reports: "
    )


def test_what_vtk_only_warns_of_is_passed_on(tmp_path: Path) -> None:
    with (
        pytest.warns(UserWarning, match=r"^a\.vts: VTK reports: odd$"),
        errors_of_file(Path("a.vts")),
    ):
        from vtkmodules.vtkCommonCore import vtkOutputWindow

        vtkOutputWindow.GetInstance().DisplayWarningText("odd")


# --- summaries ------------------------------------------------------------------------------


def test_a_file_tells_what_it_holds(tmp_path: Path) -> None:
    path = tmp_path / "flow.vts"
    grid = flowing(4, 3, 2)
    grid.cell_data["c"] = np.array([np.nan, 1, 2, 3, 4, 5])
    grid["empty"] = np.full(24, np.nan)
    grid.hide_points([1, 2])
    grid.save(path)
    summary = describe(path)
    assert summary.grid == "StructuredGrid"
    assert summary.size == "4 x 3 x 2 nodes"
    assert summary.blanked == 2
    assert summary.candidates == ("v",)
    assert summary.times == ()
    assert summary.blocks == ()
    found = {a.name: (a.where, a.components, a.low, a.high) for a in summary.arrays}
    assert found["p"] == ("points", 1, 0, 23)
    assert found["v"] == ("points", 3, np.sqrt(3), np.sqrt(16 + 9 + 4))
    assert found["c"] == ("cells", 1, 1, 5)
    assert list(found) == ["v", "p", "empty", "c"]
    assert np.isnan(found["empty"][2:]).all()
    assert summary.problem == ""


def test_an_unstructured_file_tells_what_it_is(tmp_path: Path) -> None:
    pv.Sphere().save(tmp_path / "hull.vtp")
    summary = describe(tmp_path / "hull.vtp")
    assert summary.grid == "PolyData"
    assert summary.size == "842 points, 1,680 cells"
    assert not summary.volume
    assert summary.problem.startswith("the mesh has no vectors")
