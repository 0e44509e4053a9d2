from __future__ import annotations

import email.parser
import email.policy
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

import flowtex
from flowtex.rendering import shaders

ROOT = Path(__file__).resolve().parents[1]
SHADERS = ROOT / "shaders"

# Runs in a process that knows the installed copy alone: -P and the working folder keep the
# checkout out, PYTHONPATH comes before what is installed as editable.
TELL = """
import json, sys
import flowtex
from flowtex.rendering import shaders
json.dump({
    "package": flowtex.__file__,
    "folder": str(shaders.shader_folder()),
    "texts": {name: shaders.shader_source(name) for name in shaders.shader_names()},
}, sys.stdout)
"""


def _texts_of_checkout() -> dict[str, str]:
    return {
        path.relative_to(SHADERS).as_posix(): path.read_text(encoding="utf-8")
        for path in SHADERS.rglob("*")
        if path.is_file() and not path.name.startswith(".")
    }


def _client_of_checkout() -> list[Path]:
    folder = ROOT / "flowtex" / "host" / "static"
    found = [path for path in folder.iterdir() if path.suffix in (".js", ".mjs", ".css", ".html")]
    assert {"core.js", "store.js", "exports.mjs", "scene.mjs", "page.css", "page.html"} <= {
        path.name for path in found
    }
    return found


def _paper_of_checkout() -> list[Path]:
    files = [
        path for path in (ROOT / "paper").rglob("*") if path.suffix in (".py", ".html", ".css")
    ]
    assert {"__main__.py", "page.html", "style.css", "redundancy.py"} <= {f.name for f in files}
    return files


def _run(*command: str, cwd: Path, **environment: str) -> str:
    done = subprocess.run(
        command,
        cwd=cwd,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the wheel, from the checkout, without the network."""
    folder = tmp_path_factory.mktemp("wheel")
    _run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder), cwd=ROOT)
    (built,) = folder.glob("*.whl")
    return built


def test_wheel_holds_every_shader_and_every_module(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        held = {name: archive.read(name) for name in archive.namelist()}
    for name, text in _texts_of_checkout().items():
        assert held[f"flowtex/_shaders/{name}"].decode() == text
    for path in (ROOT / "flowtex").rglob("*.py"):
        assert path.relative_to(ROOT).as_posix() in held
    assert "flowtex/py.typed" in held
    for path in _client_of_checkout():
        assert held[path.relative_to(ROOT).as_posix()] == path.read_bytes()


#: What a wheel may hold, by folder and ending, and bytes that it may have.
HELD = re.compile(
    r"flowtex/(?:[\w/]+\.pyi?|py\.typed"
    r"|_shaders/(?:common|vtk|webgl2)/\w+\.glsl"
    r"|host/static/\w+\.(?:m?js|css|html)|app/(?:[\w/]+\.(?:js|css|html))"
    r"|examples/data/\w+\.(?:npz|nc\.gz)|field/earth/coastlines\.(?:npz|md))"
    r"|flowtex-[\d.]+\.dist-info/(?:METADATA|RECORD|WHEEL|entry_points\.txt|licenses/LICENSE)"
)
MOST_BYTES = 3_500_000


def test_wheel_is_small_and_holds_no_file_of_another_kind(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    tops = {name.split("/")[0] for name in names}
    assert tops == {"flowtex", f"flowtex-{flowtex.__version__}.dist-info"}
    assert [name for name in names if not HELD.fullmatch(name)] == []
    assert [name for name in names if "test" in name.lower() or "__pycache__" in name] == []
    assert wheel.stat().st_size < MOST_BYTES


def test_wheel_holds_every_file_of_the_package(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        held = set(archive.namelist())
    git = shutil.which("git")
    if git is None or not (ROOT / ".git").exists():
        pytest.skip("what belongs to the package is known to git alone")
    kept = _run(git, "ls-files", "-z", "flowtex", cwd=ROOT).split("\0")
    assert {name for name in kept if name and (ROOT / name).exists()} <= held


def test_metadata_are_whole_and_links_of_the_readme_hold_on_pypi(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [n for n in archive.namelist() if n.endswith("dist-info/METADATA")]
        told = email.parser.BytesParser(policy=email.policy.default).parsebytes(archive.read(name))
    assert told["Name"] == "flowtex"
    assert told["License-Expression"] == "BSD-3-Clause"
    assert told["Requires-Python"] == ">=3.11"
    assert told["Description-Content-Type"] == "text/markdown"
    urls = dict(line.split(", ") for line in told.get_all("Project-URL", []))
    assert {"Repository", "Documentation", "Issues", "Changelog"} == set(urls)
    text = str(told.get_payload())
    links = re.findall(r"\]\(([^)#]+)", text)
    assert links
    assert [link for link in links if not link.startswith("https://")] == []
    own = f"{urls['Repository']}/(?:blob|raw)/v{flowtex.__version__}/"
    for path in [re.sub(own, "", link) for link in links if re.match(own, link)]:
        assert (ROOT / path).exists(), path


def test_wheel_declares_command_and_plotter_component(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [n for n in archive.namelist() if n.endswith("dist-info/entry_points.txt")]
        declared = archive.read(name).decode()
    assert "flowtex = flowtex.cli:main" in declared
    # PyVista hands the value to import_module, so it must name a module and nothing in it.
    assert "flowtex = flowtex.plotting.component\n" in f"{declared}\n"
    # Here PyVista loads the value itself, so it must name a function.
    assert "flowtex = flowtex.host.show:show_plotter" in declared


def test_installed_wheel_reads_its_own_shaders(wheel: Path, tmp_path: Path) -> None:
    site, elsewhere = tmp_path / "site", tmp_path / "elsewhere"
    (elsewhere / "shaders").mkdir(parents=True)  # a stray folder that must not be taken for ours
    (elsewhere / "shaders" / "stray.glsl").write_text("stray", encoding="utf-8")
    pip = (sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check")
    offline = ("--no-index", "--no-deps", "--no-compile", "--target", str(site))
    _run(*pip, *offline, str(wheel), cwd=tmp_path)

    told = json.loads(_run(sys.executable, "-P", "-c", TELL, cwd=elsewhere, PYTHONPATH=str(site)))

    assert Path(told["package"]).is_relative_to(site)
    assert Path(told["folder"]) == (site / "flowtex" / "_shaders").resolve()
    assert told["texts"] == _texts_of_checkout()


@pytest.mark.parametrize("name", ["noise.glsl", "", "../secret", "/etc/passwd"])
def test_unknown_shader_lists_the_known(name: str) -> None:
    expected = rf"^the shader '{name}' does not exist; expected one of: common/"
    with pytest.raises(FileNotFoundError, match=expected):
        shaders.shader_source(name)


def test_shaders_beside_an_installed_package_are_not_ours(tmp_path: Path) -> None:
    package = tmp_path / "site-packages" / "flowtex"
    package.mkdir(parents=True)
    (package.parent / "shaders").mkdir()
    with pytest.raises(FileNotFoundError, match=r"^flowtex's shaders are missing in "):
        shaders.shader_folder(package)


def test_wheel_can_be_built_from_the_source_archive(tmp_path: Path) -> None:
    _run(sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", str(tmp_path), cwd=ROOT)
    (archive,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(archive) as packed:
        # The first releases of Python 3.11 have no filters, those from 3.12 on ask for one.
        safe = {"filter": "data"} if hasattr(tarfile, "data_filter") else {}
        packed.extractall(tmp_path, **safe)  # type: ignore[arg-type]
    source = tmp_path / archive.name.removesuffix(".tar.gz")
    for path in _paper_of_checkout():
        assert (source / path.relative_to(ROOT)).read_bytes() == path.read_bytes()
    _run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path), cwd=source)
    (built,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(built) as held:
        names = set(held.namelist())
    assert {f"flowtex/_shaders/{name}" for name in _texts_of_checkout()} <= names
    assert {path.relative_to(ROOT).as_posix() for path in _client_of_checkout()} <= names
