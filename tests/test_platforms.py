"""What other systems do with paths and characters, as far as it can be tried on this one."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
from pathlib import Path, PureWindowsPath
from typing import Any

import pytest

import flowtex
from flowtex.cli import main
from flowtex.pyramid import places

PACKAGE = Path(flowtex.__file__).parent
#: Names of files that Windows takes for devices, with any suffix.
WINDOWS_DEVICES = {
    *("CON", "PRN", "AUX", "NUL"),
    *(f"COM{number}" for number in range(1, 10)),
    *(f"LPT{number}" for number in range(1, 10)),
}


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        (str(PureWindowsPath("s3://bucket/a/b.zarr")), "s3://bucket/a/b.zarr"),
        (str(Path("s3://bucket/a/b.zarr")), "s3://bucket/a/b.zarr"),
        ("gs://bucket/b.zarr", "gs://bucket/b.zarr"),
        ("https://host:8080/b.zarr", "https://host:8080/b.zarr"),
    ],
)
def test_a_url_is_known_though_pathlib_has_had_it(place: str, expected: str) -> None:
    assert places.place_text(place) == expected


@pytest.mark.parametrize("place", [r"C:\data\b.zarr", "C:/data/b.zarr", "c:b.zarr", r"\\host\b"])
def test_a_drive_is_no_url(place: str) -> None:
    assert not places.is_remote(place)


@pytest.mark.parametrize("name", ["NUL.vts", "con", "Com1.nc", "aux .json", "LPT9"])
def test_a_file_is_not_called_as_a_device_of_windows(name: str) -> None:
    files = pytest.importorskip("flowtex.app.server.files")
    stem = files.plain_name(name).partition(".")[0]
    assert stem.rstrip().upper() not in WINDOWS_DEVICES
    assert files.plain_name("console.vts") == "console.vts"


#: Tests of fields, paths and widgets, which end soon without threads.
BARRED = ("field/test_field.py", "trace/test_paths.py", "host/test_tile_feed.py")


@pytest.mark.slow
def test_the_core_needs_neither_vtk_nor_threads_nor_processes() -> None:
    options = ("-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-rfE")
    environment = {**os.environ, "FLOWTEX_BARRED": "1"}
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *options, *(f"tests/{name}" for name in BARRED)],
        cwd=PACKAGE.parent,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
    passed = re.search(r"(\d+) passed", done.stdout)
    assert passed is not None and int(passed[1]) >= 60, done.stdout


@pytest.mark.parametrize("missing", ["render", "movie", "axes"])
def test_what_needs_vtk_says_what_does_without(
    monkeypatch: pytest.MonkeyPatch, missing: str
) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    told = rf"^flowtex\.{missing} needs PyVista and VTK.*pip install pyvista.*flowtex\.FlowWidget"
    with pytest.raises(ModuleNotFoundError, match=told):
        getattr(flowtex, missing)
    with pytest.raises(ModuleNotFoundError, match=r"^a flow from an object of type list needs"):
        flowtex.FlowField.from_pyvista([])
    with pytest.raises(ModuleNotFoundError, match=r"^a mesh needs PyVista and VTK"):
        flowtex.examples.double_gyre(0.0)


def test_what_a_console_cannot_show_ends_nothing(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    written = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(written, encoding="ascii"))
    mesh = tmp_path / "µ.vts"
    flowtex.examples.double_gyre(0.0).save(mesh)
    assert main(["info", str(mesh)]) == 0
    sys.stdout.flush()
    assert b"?.vts" in written.getvalue()


#: Calls that open text, and a word in them without which the system's own encoding is meant.
OPENING = re.compile(r"\.(?:read_text|write_text)\(([^()]*(?:\([^()]*\)[^()]*)*)\)")


def test_every_text_is_opened_with_its_encoding() -> None:
    guilty: list[Any] = []
    for path in PACKAGE.rglob("*.py"):
        found = OPENING.finditer(path.read_text(encoding="utf-8"))
        guilty += [f"{path.name}: {call[0]}" for call in found if "utf-8" not in call[1]]
    assert [call for call in guilty if not call.endswith("._write_text()")] == []
