from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from cfd_files import CGNS, TIMES, box
from page_reader import Reader
from PIL import Image

from flowtex import examples
from flowtex.cli import main
from flowtex.field.options import FieldOptions, option_names
from flowtex.rendering import diagnostics
from flowtex.scene.options import Appearance, ViewOptions
from flowtex.settings import TABLE

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    def call(*words: object) -> tuple[int, str, str]:
        code = main([str(word) for word in words])
        captured = capsys.readouterr()
        # Rich wraps at the width of the terminal; words are what is judged here.
        return code, " ".join(captured.out.split()), " ".join(captured.err.split())

    return call


@pytest.fixture(scope="session")
def gyre(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("flow") / "gyre.vts"
    examples.double_gyre(2.5).save(path)
    return path


@pytest.fixture(scope="session")
def block(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A box of 6 x 5 x 4 nodes in which everything moves along x."""

    mesh = pv.ImageData(dimensions=(6, 5, 4)).cast_to_structured_grid()
    mesh.point_data["wind"] = np.tile([1.0, 0.0, 0.0], (mesh.n_points, 1))
    mesh.point_data["force"] = np.tile([0.0, 1.0, 0.5], (mesh.n_points, 1))
    path = tmp_path_factory.mktemp("flow") / "block.vts"
    mesh.save(path)
    return path


def grey(path: Path) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    with Image.open(path) as picture:
        return np.asarray(picture.convert("L"), dtype=float)


def roughness(pixels: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> tuple[float, float]:
    """Mean difference of neighbours along x and along y."""
    return float(np.abs(np.diff(pixels, axis=1)).mean()), float(
        np.abs(np.diff(pixels, axis=0)).mean()
    )


def test_without_arguments_the_help_is_printed(run: Run) -> None:
    code, out, err = run()
    assert code == 0 and not err
    assert all(word in out for word in ("demo", "show", "render", "info", "doctor"))


@pytest.mark.parametrize("token", ["", "word", "x" * 15, "a b" * 9, "ä" * 20])
@pytest.mark.parametrize("way", ["--token", "--token-file", "FLOWTEX_TOKEN"])
def test_a_token_that_can_be_guessed_is_refused(
    run: Run, tmp_path: Path, token: str, way: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("trame_rca")
    file = tmp_path / "token"
    file.write_text(token, encoding="utf-8")
    monkeypatch.setenv("FLOWTEX_TOKEN", token if way == "FLOWTEX_TOKEN" else "x" * 20)
    given = {"--token": (way, token), "--token-file": (way, file)}.get(way, ())
    code, _, err = run("serve", tmp_path, *given)
    assert code == 2 and "expected 16 or more letters" in err
    assert (f"--token is {token!r}" if way == "--token" else "contains another text") in err


def test_a_token_that_others_can_read_warns(run: Run, tmp_path: Path) -> None:
    pytest.importorskip("trame_rca")
    file = tmp_path / "token"
    file.write_text("x" * 20)
    file.chmod(0o644)
    warning = "other users of this machine can read or change"
    err = run("serve", tmp_path, "--token", "x" * 20)[2]
    assert f"{warning} --token in the list of processes; use --token-file or FLOW" in err
    assert f"{warning} {file}" in run("serve", tmp_path, "--token-file", file)[2]
    file.chmod(0o600)
    assert warning not in run("serve", tmp_path, "--token-file", file)[2]
    assert "which cannot be read (No such file" in run("serve", tmp_path, "--token-file", "x")[2]


def test_every_setting_and_option_is_a_flag_with_its_sentence(run: Run) -> None:
    _, out, _ = run("render", "--help")
    plain = "".join(c for c in out if c.isalnum())
    for row in TABLE.values():
        assert f"--{row.name.replace('_', '-')}" in out
        first = row.text.split(",")[0].split(" ")[0]
        assert first in plain
        if row.kind is bool:
            assert f"--no-{row.name.replace('_', '-')}" in out
    for kind in (FieldOptions, Appearance, ViewOptions):
        # A file has its own times, and slices are no text.
        for name in set(option_names(kind)) - {"times", "slices"}:
            assert f"--{name.replace('_', '-')}" in out
    for words in ("1 is opaque, 0 invisible", "[default: 1.0]", "--no-lighting"):
        assert words in out


def test_a_picture_is_drawn_along_the_flow(
    run: Run, block: Path, tmp_path: Path, opengl: object
) -> None:
    out = tmp_path / "wind.png"
    code, output, err = run(
        "render", block, "-o", out, "--plane", "k=1", "--vectors", "wind", "--size", "200x150",
        "--scalars", "none", "--zoom", "2",
    )  # fmt: skip
    assert (code, err) == (0, "")
    assert "6 × 5 nodes" in output and "200 × 150" in output and "leaves the surface" not in output
    pixels = grey(out)
    assert pixels.shape == (150, 200)
    along, across = roughness(pixels)
    assert across > 5 and across > 2.5 * along


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("render {gyre} -o {tmp}/a.xyz", "'.xyz' is not a picture format"),
        ("render {gyre} -o {tmp}/a", "the file name has no suffix"),
        ("render {gyre} -o {tmp}/nowhere/a.png", "does not exist; create it"),
        ("render {tmp}/no.vts -o {tmp}/a.png", "the file does not exist"),
        ("render {gyre} -o {tmp}/a.png --samples 0", "samples is 0; expected"),
        ("render {gyre} -o {tmp}/a.png --samples x", "--samples"),
        ("render {gyre} -o {tmp}/a.png --size 10", "expected width x height"),
        ("render {gyre} -o {tmp}/a.png --zoom 0", "zoom is 0"),
        ("render {block} -o {tmp}/a.png --plane z=2", "a whole number N within"),
        ("render {gyre} -o {tmp}/a.png --camera 1,2", "camera is '1,2'; expected nine numbers"),
        ("render {gyre} -o {tmp}/a.png --isel number=x", "--isel is number=x; expected an axis"),
        ("render {gyre} -o {tmp}/a.png --isel number=2", "isel applies to datasets, but this"),
        ("render {gyre} -o {tmp}/a.png --log-scale --clim 0,1", "log_scale is True"),
        ("render {gyre} -o {tmp}/a.png --clim 1", "--clim is '1'; expected two numbers"),
        ("render {gyre} -o {tmp}/a.png --axes scale", "axes is 'scale', but only browsers draw"),
        ("render {gyre} -o {tmp}/a.png --beside lod", "such as --beside lod=false"),
        ("render {gyre} -o {tmp}/a.png --beside smaples=3", "did you mean 'samples'?"),
        ("render {gyre}", "missing option --output: picture to write"),
        (
            "render {gyre} -o {tmp}/a.png --coastlines-file {tmp}/no.shp",
            "no.shp', which does not exist",
        ),
        (
            "render {gyre} -o {tmp}/a.png --u a --v b --vectors c",
            "--vectors c --u a --v b is given",
        ),
        ("render {gyre} --opacty 1", "Did you mean --opacity?"),
        ("render {gyre} --slize z=0", "Did you mean --size?"),
        ("export {gyre} -o {tmp}/page.png", "page.png'; expected a name that ends in .html"),
        ("export {gyre} -o {tmp}/page.html --steps 0", "--steps is 0; expected 1 to 1"),
        ("movie {gyre} -o {tmp}/a.avi", "'.avi' is not a movie format; expected .mp4"),
        ("info {tmp}/u.nc {tmp}/v.nc", "v.nc: no such file; check the path"),
        ("info", "no input file; usage: flowtex info FILE"),
        ("info {tmp}", "this is a folder"),
        ("demo --example soup", "the example 'soup' does not exist; expected one of cylinder"),
        ("demo --no-opne", "flowtex: Unknown option: --no-opne. Did you mean --no-open?"),
        ("demo --port 80000", "65536"),
        ("show {gyre} --no-browser --allow-host http://a.b", "allow_host is 'http://a.b'; exp"),
        ("shwo", "Unknown command"),
    ],
)
def test_what_cannot_be_is_told_in_one_paragraph(
    run: Run, words: str, message: str, gyre: Path, block: Path, tmp_path: Path, opengl: object
) -> None:
    if "--allow-host" in words:
        pytest.importorskip("trame_rca")
    places = {"gyre": gyre, "block": block, "tmp": tmp_path}
    code, out, err = run(*(word.format(**places) for word in words.split()))
    assert code == 2
    assert message in err and err.startswith("flowtex: ")
    assert not out and "Traceback" not in err
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes")
@pytest.mark.parametrize("name", ["flow.vts", "flow.nc", "flow.zarr"])
def test_paths_that_are_no_files_are_refused(run: Run, tmp_path: Path, name: str) -> None:
    loop, pipe, folder = tmp_path / f"loop.{name}", tmp_path / f"pipe.{name}", tmp_path / "empty"
    loop.symlink_to(loop)
    os.mkfifo(pipe)
    folder.mkdir()
    (folder / name).symlink_to(folder / name)
    long = "x" * 1_000_000 + name
    for command in ("info", "show", "serve", "pyramid -o a.zarr", "render -o a.png"):
        words = command.split()
        for path, words_of in (
            (loop, "Too many levels of symbolic links"),
            (pipe, "this is a pipe or a device; expected a file or a folder"),
            (long, "File name too long"),
        ):
            code, _, err = run(words[0], path, *words[1:])
            assert code == 2 and words_of in err and len(err) < 1000
    assert "the folder has no file that can be opened" in run("show", folder)[2]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device without room")
def test_a_full_output_is_an_error() -> None:
    words = [sys.executable, "-m", "flowtex", "--version"]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(words, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr == "flowtex: the output cannot be written (No space left on device)\n"


@pytest.mark.parametrize(
    ("missing", "used", "extra"),
    [
        ("trame", "import flowtex.app; flowtex.app.serve('x')", "app"),
        ("aiohttp", "from flowtex.app import serve", "app"),
        ("xarray", "import flowtex.xarray", "xarray"),
    ],
)
def test_a_missing_package_of_an_extra_is_named(missing: str, used: str, extra: str) -> None:
    code = f"import sys; sys.modules[{missing!r}] = None; {used}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    last = done.stderr.splitlines()[-1]
    assert f"{missing} is missing; install it with python -m pip install" in last
    assert f"[{extra}]" in last


def test_missing_opengl_has_a_code_of_its_own(
    run: Run, gyre: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def missing() -> diagnostics.OpenGLReport:
        msg = "VTK cannot draw here"
        raise diagnostics.OpenGLMissingError(msg)

    monkeypatch.setattr(diagnostics, "require_opengl", missing)
    for words in (("render", gyre, "-o", tmp_path / "a.png"), ("show", gyre), ("demo",)):
        code, out, err = run(*words)
        assert (code, out, err) == (1, "", "flowtex: VTK cannot draw here")


def test_a_missing_extra_is_told_with_its_command(
    run: Run, gyre: Path, monkeypatch: pytest.MonkeyPatch, opengl: object
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    monkeypatch.setattr("flowtex.rendering.diagnostics.has_display", lambda: True)
    for words in (("demo",), ("show", gyre.parent)):
        code, _, err = run(*words)
        assert code == 2 and 'pip install -e ".[app]"' in err and "trame_rca" in err


def test_info_describes_the_file_and_the_flow(run: Run, gyre: Path) -> None:
    code, out, err = run("info", gyre)
    assert (code, err) == (0, "")
    for words in ("StructuredGrid, 201 × 101 × 1 nodes", "vorticity", "What would be drawn"):
        assert words in out
        assert words in out


def test_info_says_what_is_needed(run: Run, block: Path, tmp_path: Path) -> None:

    code, out, err = run("info", block)
    assert code == 0 and "What would be drawn" in out
    assert 'the plane is "k=2", the middle' in out and "as in --plane j=2" in out and not err
    mesh: Any = pv.read(block)
    mesh["heat"] = 2 * mesh["wind"]
    mesh["wave"] = 3 * mesh["wind"]
    del mesh.point_data["wind"]
    mesh.save(tmp_path / "two.vts")
    code, out, _ = run("info", tmp_path / "two.vts")
    assert code == 0 and "To draw it:" in out and "What would be drawn" not in out
    code, out, _ = run("info", tmp_path / "two.vts", "--plane", "k=1", "--vectors", "wave")
    assert code == 0 and "6 × 5 (i × j)" in out


def test_info_lists_blocks_and_times(run: Run, tmp_path: Path) -> None:
    with CGNS.write(tmp_path / "wing.cgns") as file:
        file.base("Base", [("Tip 1", box(4, 3, 2)), ("Body", box(6, 3, 2, 3.0))], times=TIMES)
    code, out, _ = run("info", tmp_path / "wing.cgns")
    assert code == 0
    table = "0 Base/Tip 1 StructuredGrid 4 × 3 × 2"
    for words in ("blocks 2", "times 2: 0.5, 1", table, "least at t = 0.5", "(magnitude)"):
        assert words in out
    assert 'choose one, as in --block "Base/Tip 1"' in out
    code, out, _ = run("info", tmp_path / "wing.cgns", "--block", "Base/Body", "--plane", "k=0")
    assert "6 × 3 (i × j)" in out and "times 2, 0.5 to 1" in out
    assert run("info", tmp_path / "wing.cgns", "--block", "1", "--plane", "k=0") == (code, out, "")


@pytest.mark.usefixtures("opengl")
def test_a_port_in_use_is_told(run: Run) -> None:
    pytest.importorskip("trame_rca")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        code, _, err = run("demo", "--no-browser", "--port", port)
    assert code == 2
    assert f"cannot listen on 127.0.0.1:{port}" in err and "Traceback" not in err


def test_the_console_script_runs_without_loading_vtk() -> None:
    code = (
        "import sys; from flowtex.cli import main; assert main(['--help']) == 0;"
        "assert not {'vtkmodules', 'pyvista', 'trame'} & set(sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.usefixtures("quick_export")
def test_export_writes_a_page_and_tells_its_size(run: Run, gyre: Path, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    code, out, err = run(
        "export", gyre, "-o", page, "--samples", 9, "--title", "two gyres", "--axes", "scale"
    )
    assert (code, err) == (0, "")
    assert " MB, " in out
    assert f"{page.stat().st_size / 1e6:.2f} MB" in out
    read = Reader(page.read_text(encoding="utf-8"))
    assert (read.title, read.header()["axes"]) == ("two gyres", "scale")
    assert run("export", gyre, "-o", tmp_path / "flow.mjs", "--samples", 9)[0] == 0
    assert "export" in (tmp_path / "flow.mjs").read_text(encoding="utf-8")


def test_data_of_the_earth_are_told_and_drawn(run: Run, tmp_path: Path) -> None:
    pytest.importorskip("xarray")
    from earth_data import c_grid

    files = [tmp_path / "U.nc", tmp_path / "V.nc"]
    for ds, file in zip(c_grid("nemo"), files, strict=True):
        ds.to_netcdf(file)
    code, out, _ = run("info", *files)
    assert code == 0
    for words in ("uo, vo", "along the grid", "Arakawa C", "nav_lon and nav_lat", "39 × 39"):
        assert words in out, words
    code, _, err = run("info", files[0])
    assert code != 0 and "one component of a velocity, 'uo'" in err
    picture = tmp_path / "a.png"
    assert run("render", *files, "-o", picture, "--globe", "--size", "80x60")[0] == 0
    assert picture.is_file()
    for flags, words in (
        (("--projection", "flat"), "'flat' is unknown"),
        (("--level", "3"), "the axis 'level' does not exist"),
        (("--select", "number"), "expected an axis and a value"),
    ):
        code, _, err = run("render", *files, "-o", picture, *flags, "--size", "80x60")
        assert code != 0 and words in err, err


def test_a_formula_is_drawn_and_its_errors_are_told(run: Run, tmp_path: Path) -> None:
    picture = tmp_path / "pendulum.png"
    words = ("y", "-sin(x) - b*y", "x=-7,7", "y=-4,4", "-o", picture)
    code, _, err = run("formula", *words)
    assert code == 2 and "b is unknown; known are x, y. Give a parameter its value" in err
    code, out, err = run("formula", *words, "b=0.2,0,1", "--size", "80x60", "--samples", 3)
    assert code == 0 and not err and "80x60" in out
    assert roughness(grey(picture))[0] > 1
    for wrong, told in {
        "x=7,-7": "x is (7.0, -7.0); expected two numbers, the lower one first",
        "x=a": "x is 'a'; expected one to three numbers",
        "b=2,3,4": "b is (2.0, 3.0, 4.0)",
        "t=1": "expected the first time, the last, and their number, such as t=0,10,41",
    }.items():
        code, _, err = run("formula", "y", "x", wrong, "-o", picture)
        assert code == 2 and told in err


def test_choices_are_told_once_as_flags(run: Run, block: Path, tmp_path: Path) -> None:
    """What a command says can be typed after it."""
    target = tmp_path / "block.png"
    words = ("render", block, "-o", target, "--vectors", "wind", "--size", "40x30")
    code, out, _ = run(*words)
    told = "choose another, as in --plane j=2, or cut anywhere, as in --slice z"
    assert code == 0
    assert out.count(told) == 1
    for flags in (("--plane", "j=2"), ("--slice", "z")):
        code, out, _ = run(*words, *flags)
        assert code == 0 and "choose another" not in out
