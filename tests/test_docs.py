"""Every Python block of the README and the docs runs, in order, page by page."""

from __future__ import annotations

import importlib.util
import inspect
import json
import os
import re
import shlex
import sys
from functools import partial
from importlib import import_module
from operator import attrgetter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
import pyvista as pv
from test_notebooks import smaller

import flowtex
from flowtex.settings import TABLE, Setting

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
PAGES += sorted(p for room in ("howto", "reference") for p in (ROOT / "docs" / room).glob("*.md"))
BEGIN, END = "<!-- settings: made from", "<!-- end of settings -->"


#: Where a Python block that does not run here runs, or why it cannot.
REASON = re.compile(r"<!-- (?:run by (?P<test>tests/[\w/]+\.py)|not run: .{10,}) -->")


class Block(NamedTuple):
    """A block of code on a page."""

    above: str
    language: str
    code: str


def code_blocks(page: Path) -> list[Block]:
    """Return the blocks of code of a page; each must end."""
    lines = page.read_text().splitlines()
    found, mark, language, start = [], "", "", 0
    for number, line in enumerate(lines, start=1):
        match = re.match(r" *(`{3,})([^`]*)$", line)
        if match and not mark:
            mark, language, start = match[1], match[2].strip(), number
        elif match and match[1] == mark and not match[2].strip():
            code = "".join(f"{each}\n" for each in lines[start : number - 1])
            found.append(Block(lines[start - 2], language, code))
            mark = ""
        else:
            nested = match and len(match[1]) >= len(mark)
            assert not nested, f"{page}:{start}: the block has not ended in line {number}"
    assert not mark, f"{page}:{start}: the block does not end"
    return found


def blocks(page: Path) -> list[str]:
    """Python blocks of a page, also those whose result the site shows."""
    shown = [b.code for b in code_blocks(page) if b.language in ("python", "{live}")]
    return [re.sub(r"^:.*\n", "", code, flags=re.MULTILINE) for code in shown]


def fewer(mesh: Any) -> Any:
    """Every second line of nodes, and the last one."""
    i, j, k = mesh.dimensions
    return mesh.extract_subset((0, i - 1, 0, j - 1, 0, k - 1), (2, 2, 1), boundary=True)


@pytest.fixture(scope="module")
def small_examples() -> dict[str, Any]:
    """Examples with every second or third point, and some of their instants."""
    pytest.importorskip("xarray")
    examples = flowtex.examples
    few = {dim: slice(None, None, 5) for dim in ("longitude", "latitude", "lon", "lat")}
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


def era5(path: Path) -> None:
    """Write winds on levels, as the Climate Data Store does."""
    import xarray as xr

    lon, lat, hpa = (
        np.arange(0.0, 360.0, 10.0),
        np.arange(-60.0, 61.0, 10.0),
        (1000.0, 500.0, 100.0),
    )
    dims, ones = ("pressure_level", "latitude", "longitude"), np.ones((3, len(lat), len(lon)))
    winds = {"u": ("eastward_wind", "m s**-1"), "v": ("northward_wind", "m s**-1")}
    winds["w"] = "lagrangian_tendency_of_air_pressure", "Pa s**-1"
    axes = {"longitude": ("X", "degrees_east"), "latitude": ("Y", "degrees_north")}
    places = {"longitude": lon, "latitude": lat, "pressure_level": np.array(hpa)}
    axes["pressure_level"] = "Z", "hPa"
    xr.Dataset(
        {
            name: (dims, ones * (n + 1), {"standard_name": standard, "units": unit})
            for n, (name, (standard, unit)) in enumerate(winds.items())
        },
        {
            name: (name, places[name], {"axis": axis, "units": unit})
            for name, (axis, unit) in axes.items()
        },
    ).to_netcdf(path)


def nemo(path: Path) -> None:
    """Write the component of currents that a name ends with, or the positions of all."""
    import xarray as xr

    j, i = np.mgrid[0:12, 0:16]
    places = {letter: (0.5 * (letter in "uf"), 0.5 * (letter in "vf")) for letter in "tuvf"}
    data = xr.Dataset(attrs={"Conventions": "CF-1.6"})
    if path.stem == "coordinates":
        for letter, (right, up) in places.items():
            data[f"glam{letter}"] = ("y", "x"), i + right - 20.0
            data[f"gphi{letter}"] = ("y", "x"), j + up + 40.0
    else:
        letter = path.stem[-1].lower()
        attrs = {"units": "m/s", "standard_name": f"sea_water_{'xy'[letter == 'v']}_velocity"}
        data[f"{letter}o"] = (f"depth{letter}", "y", "x"), 1.0 + np.stack([i, j]) / 10, attrs
        data[f"depth{letter}"] = f"depth{letter}", [0.5, 1.5], {"units": "m", "positive": "down"}
    data.to_netcdf(path)


def vortex(path: Path) -> None:
    """Write a mesh with a flow."""
    fewer(flowtex.examples.airfoil()).save(path)


#: Files that pages name and readers have, and what writes them.
STAND_INS = {
    "era5.nc": era5,
    **dict.fromkeys(("nemo_U.nc", "nemo_V.nc", "coordinates.nc"), nemo),
    "vortex.vts": vortex,
}


@pytest.fixture
def no_server(monkeypatch: pytest.MonkeyPatch) -> None:
    """Check calls that would serve a page until it is stopped, and return at once."""
    app, server = import_module("flowtex.app"), import_module("trame_server")
    signature = inspect.signature(app.serve)

    def serve(*arguments: Any, **options: Any) -> None:
        source = signature.bind(*arguments, **options).args[0]
        if callable(source):
            source(import_module("trame.app").get_server("a page of the docs"))

    monkeypatch.setattr(app, "serve", serve)
    monkeypatch.setattr(server.Server, "start", lambda *_, **__: None)


def close_all(names: dict[str, Any]) -> None:
    """Close figures, plotters and widgets, as the end of a session does."""
    pv.close_all()
    for name, call in (("matplotlib.pyplot", "close"), ("ipywidgets", "Widget.close_all")):
        if name in sys.modules:
            arguments = ("all",) if call == "close" else ()
            attrgetter(call)(sys.modules[name])(*arguments)


# Pictures are smaller here than on the pages, and FTLE ends before the series.
@pytest.mark.filterwarnings("ignore:FTLE is blank at")
@pytest.mark.filterwarnings("ignore:a picture of .* has no room")
@pytest.mark.filterwarnings("ignore:.* points joined by .* triangles")
@pytest.mark.filterwarnings("ignore:the velocity is the difference of positions in time")
@pytest.mark.parametrize("page", [p for p in PAGES if blocks(p)], ids=lambda p: p.stem)
def test_the_blocks_of_a_page_run(
    page: Path,
    opengl: Any,
    small_examples: dict[str, Any],
    quick_export: None,
    no_server: None,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(pv.global_theme, "window_size", [160, 120])
    monkeypatch.setattr(pv, "OFF_SCREEN", True)
    for draws in (inspect.unwrap(flowtex.render), inspect.unwrap(flowtex.movie)):
        defaults = {**(draws.__kwdefaults__ or {}), "size": (160, 120)}
        monkeypatch.setattr(draws, "__kwdefaults__", defaults)
    monkeypatch.setattr(flowtex, "show", flowtex.render, raising=False)
    few = (5, *flowtex.Settings.__init__.__defaults__[1:])  # type: ignore[index]
    monkeypatch.setattr(flowtex.Settings.__init__, "__defaults__", few)
    monkeypatch.setitem(flowtex.formula.__kwdefaults__ or {}, "resolution", 97)
    for name, shape in (("airfoil_field", (33, 97)), ("double_gyre_field", (33, 65))):
        made = partial(getattr(flowtex.examples, name), shape=shape)
        monkeypatch.setattr(flowtex.examples, name, made)
    for name, example in small_examples.items():
        monkeypatch.setattr(flowtex.examples, name, lambda example=example: example)
    for name in STAND_INS:
        if any(f'"{name}"' in block for block in blocks(page)):
            STAND_INS[name](tmp_path / name)
    names: dict[str, Any] = {}
    try:
        for number, block in enumerate(blocks(page), start=1):
            if "cartopy" in block:
                pytest.importorskip("cartopy")
            exec(compile(smaller(block), f"{page.name}, block {number}", "exec"), names)
    finally:
        close_all(names)


def test_a_python_block_that_does_not_run_names_its_test_or_the_reason() -> None:
    for page in PAGES:
        for above, language, code in code_blocks(page):
            if not re.match(r"py|ipython|\{code-block\} *i?py", language) or language == "python":
                continue
            reason = REASON.fullmatch(above)
            assert reason, f"{page}: {code[:40]!r}"
            test = reason["test"]
            assert test is None or page.name in (ROOT / test).read_text(), f"{page}: {test}"


def test_commands_of_the_docs_have_flags_that_exist() -> None:
    commands = import_module("flowtex.cli.commands")
    lines = [
        line
        for page in PAGES
        for block in code_blocks(page)
        for line in block.code.replace("\\\n", " ").splitlines()
        if block.language in ("", "sh") and line.startswith("flowtex ")
    ]
    assert len(lines) > 40
    for line in lines:
        words = shlex.split(re.split(r"\s#|\s{4,}", line.replace("FILE", "flow.vts"))[0])
        commands.app.parse_args(words[1:], exit_on_error=False, print_error=False)


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


def public_object(name: str) -> object:
    """Return the object that a user gets by ``flowtex.name``, after importing its module.

    ``pydoc.locate`` prefers modules since Python 3.12: ``flowtex.trace`` is the folder there,
    not the function.
    """
    found: object = flowtex
    path = "flowtex"
    for part in name.split("."):
        path = f"{path}.{part}"
        if not hasattr(found, part):
            import_module(path)
        found = getattr(found, part)
    return found


def test_the_reference_has_every_public_name_and_each_an_example() -> None:
    pages = (ROOT / "docs" / "reference").glob("*.md")
    text = "\n".join(page.read_text() for page in pages)
    rooms = [import_module(f"flowtex{name}") for name in MODULES]
    names = re.findall(r"^   flowtex\.([\w.]+)$", text, re.MULTILINE)
    named = {name: public_object(name) for name in names}
    public = [getattr(room, name) for room in rooms for name in room.__all__]
    known = [id(thing) for thing in named.values()]
    assert [thing for thing in public if callable(thing) and id(thing) not in known] == []
    texts = {name: inspect.getdoc(thing) or "" for name, thing in named.items()}
    assert [name for name, text in texts.items() if "Examples\n--------" not in text] == []


def row(setting: Setting) -> str:
    """One row of the table in the guide."""
    default = repr(setting.default).replace("'", '"')
    return f"| `{setting.name}` | `{default}` | {setting.expected} | {setting.text} |"


def check_table(page: Path, begin: str, end: str, table: str) -> None:
    """Compare a table between two marks of a page with the one that is made, or write it anew."""
    text = page.read_text()
    start = text.index("\n", text.index(begin)) + 1
    written = text[start : text.index(end)]
    if os.environ.get("FLOWTEX_WRITE_DOCS"):
        page.write_text(f"{text[:start]}{table}\n{text[text.index(end) :]}")
        return
    assert written.strip() == table.strip(), "run make docs, which writes the table anew"


def test_the_table_of_settings_is_that_of_the_code() -> None:
    head = "| name | default | values | what it does |\n| --- | --- | --- | --- |"
    table = "\n".join([head, *map(row, TABLE.values())])
    check_table(ROOT / "docs" / "guide.md", BEGIN, END, table)


def test_the_table_of_supported_data_is_that_of_the_tests() -> None:
    supported = import_module("test_supported")
    lines = []
    for kind in dict.fromkeys(row.kind for row in supported.ROWS):
        lines += [f"## {kind}", "", "| data | line of code | how flowtex reads it |"]
        lines.append("| --- | --- | --- |")
        for form in supported.ROWS:
            if form.kind == kind:
                needs = f"; needs `{form.needs}`" if form.needs else ""
                lines.append(f"| {form.form} | `{form.code}` | {form.reads}{needs} |")
        lines.append("")
    begin, end = "<!-- forms: made from", "<!-- end of forms -->"
    check_table(ROOT / "docs" / "supported.md", begin, end, "\n".join(lines))
