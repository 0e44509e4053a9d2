from __future__ import annotations

import math
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from strategies import links, property_test, setting_values

pytest.importorskip("trame_rca")

import flowtex
from flowtex.app.controllers.appearance import COMPARISONS, comparison
from flowtex.app.controllers.serialization import DEFAULTS, from_link, to_link, to_python
from flowtex.app.streaming.viewport import Viewport
from flowtex.settings import TABLE, SettingsError

CAMERA: dict[str, Any] = {
    "parallel": True,
    "position": [1 / 3, -2e-17, 3e8],
    "focal_point": [1 / 3, math.pi, 0.0],
    "up": [0.0, 1.0, 0.1],
    "parallel_scale": 1e-7 / 3,
    "view_angle": 30.0,
}
STATE: dict[str, Any] = {
    "file": "runs of May/post + wake.vtk",
    "block": "1",
    "vectors": 'the "momentum" & more',
    "plane": "k=20",
    "time": 0.1 + 0.2,
    "clock": 1.75,
    "colour": "Geschwindigkeit ü",
    "cmap": "RdBu_r",
    "clim": (-1e-20, 1e20 / 3),
    "log_scale": True,
    "opacity": 0.25,
    "coastlines": False,
    "graticule": False,
    "theme": "light",
    "background": "black",
    "split": "Colour by: p & q",
    "camera": CAMERA,
    "settings": {"lod": False, "samples": 25, "grain": 1 / 3, "kernel": "ramp", "speed": 1e7},
}


def test_a_state_comes_back_from_its_link() -> None:
    faults: list[str] = []
    link = to_link(STATE)
    assert from_link(link, faults) == STATE and not faults
    for address in ("http://127.0.0.1:8080/?", "http://host/index.html?secret=abc#", "#", "?"):
        assert from_link(address + link, faults) == STATE and not faults


def test_a_link_is_short_and_safe_and_can_be_read() -> None:
    defaults = {**DEFAULTS, "settings": {name: row.default for name, row in TABLE.items()}}
    assert to_link(defaults) == to_link({}) == ""
    assert to_link({"file": "post.vtk", "plane": "k=20", "settings": {"lod": False}}) == (
        "file=post.vtk&plane=k=20&lod=off"
    )
    link = to_link(STATE)
    assert link.isascii() and not set(link) & set(" \"'<>#?+\\") and "ü" in unquote(link)
    assert not set(DEFAULTS) & set(TABLE) and not set(STATE) & set(TABLE)


def test_an_image_and_unknown_settings_are_not_in_a_link() -> None:
    assert to_link({"settings": {"noise": "image", "seed": 3}}) == "seed=3"
    with pytest.raises(SettingsError, match="the setting 'smaples'"):
        to_link({"settings": {"smaples": 3}})


@pytest.mark.parametrize(
    ("link", "told"),
    [
        ("samples=1000", "samples is 1000.0; expected a whole number from 1 to 200"),
        ("grain=1e999", "grain is inf; expected a number from 0.25 to 32"),
        ("lod=maybe", "lod is 'maybe'; expected True or False"),
        ("plane=../etc", "plane is '../etc'; expected an axis and a number, such as k=20"),
        ("cmap=os.system", "cmap is 'os.system'; expected the name of a colour map"),
        ("clim=2,1", "clim is '2,1'; expected two numbers, the lower one first"),
        ("opacity=x", "opacity is 'x'; expected a number"),
        ("theme=pink", "theme is 'pink'; expected 'dark' or 'light'"),
        ("split=all", "split is 'all'; expected 'nothing' or"),
        ("split=Time:%20x", "split is 'Time: x'; expected a number"),
        ("file=a%00b", "file is 'a\\x00b'; expected a name"),
        ("file=" + "a" * 500, "expected a name of at most 400 printable"),
        ("camera=parallel,0,0", "camera is 'parallel,0,0'; expected nine numbers"),
        ("camera=parallel,0,0,1,0,0,1,0,1,0,1,30", "on one line; expected up to point away"),
        ("camera=parallel,0,0,1,0,0,0,0,1,0,-1,30", "camera.parallel_scale is -1.0; expected"),
        ("evil=1", "the link has the unknown name 'evil'"),
        ("a=1&" * 101, "too many values"),
        ("x" * 9000, "has 9,000 characters"),
    ],
)
def test_what_is_of_no_use_is_left_out_and_told(link: str, told: str) -> None:
    faults: list[str] = []
    rest = "" if len(link) > 300 else "&seed=7"
    assert from_link(link + rest, faults) == ({"settings": {"seed": 7}} if rest else {})
    assert len(faults) == 1 and told in faults[0] and len(faults[0]) < 300


@property_test(30, fuzz=80)
@given(links())
@example("file=\ud800")
@example("camera=parallel," + ",".join(["1e308"] * 11))
def test_whatever_comes_is_taken_without_an_error(link: str) -> None:
    faults: list[str] = []
    state = from_link(link, faults)
    assert all(len(fault) < 400 for fault in faults)
    assert to_link(from_link(to_link(state))) == to_link(state)
    compile(to_python(state, source="None"), "lines", "exec", flags=1024)


@property_test(25, fuzz=60)
@given(
    setting_values(resolution=8192, samples=200),
    st.fixed_dictionaries(
        {},
        optional={
            "file": st.text("aü/&=#?+% ", min_size=1),
            "time": st.floats(allow_nan=False, allow_infinity=False),
            "clim": st.tuples(st.floats(-1e30, 0), st.floats(1e-30, 1e30)),
            "split": st.sampled_from(list(COMPARISONS)[1:]),
        },
    ),
)
def test_any_state_comes_back_from_its_link(
    settings: dict[str, Any], state: dict[str, Any]
) -> None:
    changed = {k: v for k, v in settings.items() if v != TABLE[k].default}
    whole = {**state, "settings": changed} if changed else state
    faults: list[str] = []
    assert from_link("http://host/#" + to_link(whole), faults) == whole and not faults


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("flow") / "two gyres.vts"
    flowtex.examples.double_gyre(2.5).save(path)
    return path


@pytest.mark.parametrize("split", ["Fixed grain: on", "File: later.vts"])
def test_the_python_lines_draw_the_same_picture(
    file: Path, monkeypatch: pytest.MonkeyPatch, split: str, opengl: object
) -> None:
    monkeypatch.chdir(file.parent)
    field = flowtex.FlowField.from_file(file.name)
    changed: dict[str, Any] = {"samples": 7, "seed": 3, "motion": "speed", "opacity": 0.6}
    scene = Viewport(field, zoom=3.0, scalars="vorticity", cmap="magma", clim=(-1, 2.0), **changed)
    flowtex.examples.double_gyre(7.0).save(file.parent / "later.vts")
    later = {"field": flowtex.FlowField.from_file("later.vts")}
    scene.compare(later if split == "File: later.vts" else comparison(split) or None)
    count = len(scene.panes)
    scene.resize(count * 160 + 2 * (count - 1), 120)
    scene.clock = 0.7
    scene.set_background("light")
    state = {
        "file": file.name,
        "colour": "vorticity",
        "cmap": "magma",
        "clim": (-1, 2.0),
        "opacity": 0.6,
        "clock": 0.7,
        "theme": "light",
        "split": split,
        "camera": scene.camera.to_dict(),
        "settings": dict(scene.handle.settings),
    }
    drawn = np.hstack([scene.draw(160, 120, pane=pane) for pane in scene.panes]).astype(int)
    scene.close()
    names: dict[str, Any] = {}
    exec(to_python(from_link(to_link(state)), size=(160, 120)), names)
    shown = np.hstack([names["picture"], names["beside"]]).astype(int)
    assert shown.shape == drawn.shape
    assert np.abs(shown - drawn).mean() < 1.0
    assert np.abs(np.roll(shown, 2, axis=1) - drawn).mean() > 5


def test_the_python_lines_are_plain() -> None:
    state = {"file": "post.vtk", "plane": "k=20", "settings": {"lod": False}}
    assert to_python(state) == (
        "import flowtex\n\n"
        "picture = flowtex.render(\n"
        '    "post.vtk",\n    plane="k=20",\n    size=(1024, 768),\n    scalars="speed",\n'
        '    background="#12161c",\n    lod=False,\n)\n'
    )
    assert "    time=0.0,\n" in to_python({"file": "a.pvd", "time": 0.0})
    own = to_python({"colour": "none"}, source="flowtex.examples.cylinder_field()")
    assert "    flowtex.examples.cylinder_field(),\n" in own and "scalars=False" in own
    bare = to_python({"file": "winds.nc", "coastlines": False, "graticule": True})
    assert "coastlines=False" in bare and "graticule" not in bare
    with pytest.raises(ValueError, match="has no file"):
        to_python({})


def test_no_name_becomes_code() -> None:
    evil = "a\"); import os; os.abort() #'"
    state = {"file": evil, "vectors": evil, "colour": evil, "cmap": evil, "block": evil}
    lines = to_python(state)
    tree = compile(lines, "lines", "exec", flags=1024)  # a syntax tree, which runs nothing
    import ast

    names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    assert names <= {"flowtex", "picture"}


def test_a_place_in_space_is_a_slice() -> None:
    for plane in ("x=0.25", "z=-1e-05", "y=3"):
        assert from_link(to_link({"file": "a.vtu", "plane": plane}))["plane"] == plane
        assert f'slice="{plane}",' in to_python({"file": "a.vtu", "plane": plane})
    assert "=0" not in to_python({"file": "a.vtu", "plane": "outer=0"})
    assert from_link("plane=level=0.5") == {}
