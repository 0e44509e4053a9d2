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
from typing import TYPE_CHECKING

import pytest

import flowtex
from flowtex.rendering import shaders

if TYPE_CHECKING:
    from playwright.sync_api import Page

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


def test_the_checkout_has_shaders() -> None:
    assert _texts_of_checkout(), f"{SHADERS} is empty: the other tests here would see nothing"


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
MOST_BYTES = 3_000_000


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


def test_wheel_is_named_after_the_one_version(wheel: Path) -> None:
    assert wheel.name == f"flowtex-{flowtex.__version__}-py3-none-any.whl"


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


WIDGET = """
import json, shutil, sys, threading
import flowtex
from flowtex.host.flow_widget import FlowWidget

came, parts, done = [], {}, threading.Event()
def send(self, content, buffers=None):
    for info, data in zip(content["parts"], buffers or ()):
        parts[info["name"]] = {**info, "data": bytes(data).hex()}
    if "flow/0" in parts:
        done.set()
FlowWidget.send = send
widget = FlowWidget(flowtex.examples.double_gyre_field(shape=(20, 40)), samples=5)
assert done.wait(30)
header = {
    **widget._header, "shaders": widget._shaders[0], "settings": dict(widget.settings),
    "camera": widget.camera, "time": widget.time, "clock": widget.clock,
}
json.dump({
    "package": flowtex.__file__, "node": shutil.which("node"), "client": str(widget._esm),
    "header": header, "parts": parts,
}, sys.stdout)
"""
SHOWN = """async ([source, header, parts]) => {
  const url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
  const client = await import(url);
  const opened = Object.values(parts).map((part) => client.decoded(
    part, Uint8Array.from(part.data.match(/../g), (h) => parseInt(h, 16))));
  document.body.style.height = "200px";
  window.viewer = client.mountPage(document.body, [{ header, parts: opened }]);
}"""


@pytest.fixture
def empty_environment(wheel: Path, tmp_path: Path) -> Path:
    """Install the wheel in its own environment, which sees the libraries of this one.

    Nothing else of this environment's own is seen: neither its flowtex nor its commands.
    """
    folder = tmp_path / "environment"
    _run(sys.executable, "-m", "venv", "--without-pip", str(folder), cwd=tmp_path)
    python = folder / "bin" / "python"
    site = Path(_run(str(python), "-c", SITE, cwd=tmp_path).strip())
    _run(*PIP, "--target", str(site), str(wheel), cwd=tmp_path)
    # A path file does not run those that lie where it points to, such as an editable install's.
    (site / "libraries.pth").write_text("\n".join(p for p in sys.path if p.endswith("-packages")))
    return python


SITE = "import sysconfig; print(sysconfig.get_path('purelib'))"
PIP = (
    *(sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"),
    *("--no-index", "--no-deps", "--no-compile"),
)


@pytest.mark.slow
@pytest.mark.browser
@pytest.mark.skipif(os.name == "nt", reason="commands lie in another folder there")
def test_installed_wheel_shows_the_widget_without_node(
    empty_environment: Path, page: Page, tmp_path: Path
) -> None:
    pytest.importorskip("anywidget")
    plain = {"PATH": str(empty_environment.parent), "PYTHONPATH": ""}
    told = json.loads(_run(str(empty_environment), "-P", "-c", WIDGET, cwd=tmp_path, **plain))
    assert told["node"] is None
    assert Path(told["package"]).is_relative_to(empty_environment.parents[1])
    page.goto("about:blank")
    web = Path(told["package"]).parent / "host" / "static"
    told_parts = [web.joinpath(name).read_text("utf-8") for name in ("core.js", "exports.mjs")]
    assert "".join(told_parts) == told["client"]
    page.evaluate(SHOWN, [told["client"], told["header"], told["parts"]])
    page.locator('.flowtex[data-sharp="true"]').wait_for()
    drawn = page.evaluate(DRAWN)
    assert drawn > 10


#: Standard deviation of what is drawn, in steps of 8 bits.
DRAWN = """() => {
  const { canvas } = window.viewer;
  const { width, height } = canvas;
  const data = canvas.getContext("2d").getImageData(0, 0, width, height).data;
  const red = data.filter((_, n) => n % 4 === 0);
  const mean = red.reduce((sum, x) => sum + x, 0) / red.length;
  return Math.sqrt(red.reduce((sum, x) => sum + (x - mean) ** 2, 0) / red.length);
}"""


def test_editable_install_reads_the_checkout() -> None:
    package = Path(flowtex.__file__).resolve().parent
    if package.parent != ROOT:
        pytest.skip(f"flowtex is installed in {package.parent}, not as editable")
    assert shaders.shader_folder() == SHADERS
    assert {n: shaders.shader_source(n) for n in shaders.shader_names()} == _texts_of_checkout()


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Make a folder of two shaders, and read shaders from there."""
    made = tmp_path / "shaders"
    monkeypatch.setattr(shaders, "shader_folder", lambda: made)
    (made / "common").mkdir(parents=True)
    (made / "common" / "noise.glsl").write_text("// µ noise\n", encoding="utf-8")
    (made / "main.frag").write_text("void main() {}\n", encoding="utf-8")
    (made / ".swap").write_text("", encoding="utf-8")
    return made


@pytest.mark.usefixtures("folder")
def test_names_are_sorted_without_hidden_files_and_sources_read_as_utf8() -> None:
    assert shaders.shader_names() == ("common/noise.glsl", "main.frag")
    assert shaders.shader_source("common/noise.glsl") == "// µ noise\n"


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("name", ["noise.glsl", "", "../secret", "/etc/passwd", ".swap"])
def test_an_unknown_name_lists_the_known(name: str) -> None:
    expected = (
        rf"^the shader '{name}' does not exist; expected one of: common/noise\.glsl, main\.frag$"
    )
    with pytest.raises(FileNotFoundError, match=expected):
        shaders.shader_source(name)


def test_shaders_beside_an_installed_package_are_not_ours(tmp_path: Path) -> None:
    package = tmp_path / "site-packages" / "flowtex"
    package.mkdir(parents=True)
    (package.parent / "shaders").mkdir()
    with pytest.raises(
        FileNotFoundError, match=r"^flowtex's shaders are missing: .*--no-deps flowtex$"
    ):
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
