"""Every Python block of the README and the docs runs, in order, page by page."""

from __future__ import annotations

import importlib.util
import inspect
import json
import os
import re
from functools import partial
from importlib import import_module
from pathlib import Path
from pydoc import locate
from typing import Any

import pytest
import pyvista as pv
from test_notebooks import smaller

import flowtex
from flowtex.settings import TABLE, Setting

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
PAGES += sorted(p for room in ("howto", "reference") for p in (ROOT / "docs" / room).glob("*.md"))
BEGIN, END = "<!-- settings: made from", "<!-- end of settings -->"


def blocks(page: Path) -> list[str]:
    """Python blocks of a page."""
    return re.findall(r"^```python\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE)


def fewer(mesh: Any) -> Any:
    """Every second line of nodes, and the last one."""
    i, j, k = mesh.dimensions
    return mesh.extract_subset((0, i - 1, 0, j - 1, 0, k - 1), (2, 2, 1), boundary=True)


@pytest.fixture(scope="module")
def small_examples() -> dict[str, Any]:
    """Examples with every second or third point, and some of their instants."""
    pytest.importorskip("xarray")
    examples = flowtex.examples
    few = {dim: slice(None, None, 3) for dim in ("longitude", "latitude", "lon", "lat")}
    return {
        "airfoil": fewer(examples.airfoil()),
        "cylinder_series": [fewer(mesh) for mesh in examples.cylinder_series()[::10]],
        "cylinder_field": examples.cylinder_field().downsample(4).at_steps(range(0, 31, 10)),
        "vortex_field": examples.vortex_field().downsample(4).at_steps(range(0, 31, 6)),
        **{
            name: getattr(examples, name)().isel(few, missing_dims="ignore")
            for name in ("ocean", "weather")
        },
    }


@pytest.mark.parametrize("page", [p for p in PAGES if blocks(p)], ids=lambda p: p.stem)
def test_the_blocks_of_a_page_run(
    page: Path,
    opengl: Any,
    small_examples: dict[str, Any],
    quick_export: None,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(pv.global_theme, "window_size", [160, 120])
    defaults = {**(flowtex.render.__kwdefaults__ or {}), "size": (160, 120)}
    monkeypatch.setattr(flowtex.render, "__kwdefaults__", defaults)
    monkeypatch.setitem(flowtex.formula.__kwdefaults__ or {}, "resolution", 97)
    for name, shape in (("airfoil_field", (33, 97)), ("double_gyre_field", (33, 65))):
        made = partial(getattr(flowtex.examples, name), shape=shape)
        monkeypatch.setattr(flowtex.examples, name, made)
    for name, example in small_examples.items():
        monkeypatch.setattr(flowtex.examples, name, lambda example=example: example)
    names: dict[str, Any] = {}
    for number, block in enumerate(blocks(page), start=1):
        exec(compile(smaller(block), f"{page.name}, block {number}", "exec"), names)


def test_every_link_inside_the_project_leads_somewhere() -> None:
    for page in PAGES:
        links = re.findall(r"\]\((?!https?://|#)([^)#]+)", page.read_text())
        assert [link for link in links if not (page.parent / link).exists()] == [], page


def test_contributors_read_of_every_room_and_of_paths_that_exist() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text()
    picture = text[text.index("```") : text.index("## To change this")]
    rooms = [p.name for p in (ROOT / "flowtex").iterdir() if p.name[0] != "_" or p.is_dir()]
    left_out = ("__pycache__", "py.typed")
    assert [room for room in rooms if room not in left_out and room not in picture] == []
    names = re.findall(r"`((?:flowtex|shaders|client|paper|tests|tools|docs)/[\w./]*)`", text)
    assert len(names) > 12
    assert [name for name in names if not (ROOT / name).exists()] == []


def test_the_tables_of_what_pyramids_cost_are_those_of_the_benchmark() -> None:
    pytest.importorskip("zarr")
    path = ROOT / "benchmarks" / "planning.py"
    spec = importlib.util.spec_from_file_location("planning", path)
    assert spec is not None and spec.loader is not None
    planning: Any = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(planning)
    tables = planning.tables(json.loads(planning.RESULTS.read_text()))
    text = planning.PAGE.read_text()
    assert len(tables) == 5
    wrong = [name for name, table in tables.items() if f"\n\n{table}\n\n" not in text]
    assert not wrong, "run python benchmarks/pyramid.py --only-tables --docs"


MODULES = ("", ".app", ".examples", ".pyramid", ".scene.probe", ".xarray")


def test_the_reference_has_every_public_name_and_each_an_example() -> None:
    pages = (ROOT / "docs" / "reference").glob("*.md")
    text = "\n".join(page.read_text() for page in pages)
    rooms = [import_module(f"flowtex{name}") for name in MODULES]
    names = re.findall(r"^   flowtex\.([\w.]+)$", text, re.MULTILINE)
    named = {name: locate(f"flowtex.{name}") for name in names}
    public = [getattr(room, name) for room in rooms for name in room.__all__]
    known = [id(thing) for thing in named.values()]
    assert [thing for thing in public if callable(thing) and id(thing) not in known] == []
    texts = {name: inspect.getdoc(thing) or "" for name, thing in named.items()}
    assert [name for name, text in texts.items() if "Examples\n--------" not in text] == []


def row(setting: Setting) -> str:
    """One row of the table in the guide."""
    default = repr(setting.default).replace("'", '"')
    return f"| `{setting.name}` | `{default}` | {setting.expected} | {setting.text} |"


def test_the_table_of_settings_is_that_of_the_code() -> None:
    page = ROOT / "docs" / "guide.md"
    text = page.read_text()
    head = "| name | default | values | what it does |\n| --- | --- | --- | --- |"
    table = "\n".join([head, *map(row, TABLE.values())])
    start = text.index("\n", text.index(BEGIN)) + 1
    written = text[start : text.index(END)]
    if os.environ.get("FLOWTEX_WRITE_DOCS"):
        page.write_text(text[:start] + table + "\n" + text[text.index(END) :])
        return
    assert written.strip() == table, "run make docs, which writes the table anew"
