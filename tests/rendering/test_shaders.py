"""Shader text is put together as text, and every variant compiles where it is used."""

from __future__ import annotations

import re
from pathlib import Path

import flowtex
from flowtex.rendering import shaders

WORD = re.compile(r"FLOWTEX_[A-Z]+").findall


def test_an_include_is_put_in_once() -> None:
    text = shaders.shader_text("vtk/fragment_dec.glsl")
    assert text.count("struct FlowtexSums") == 1
    assert "//#include" not in text


def test_files_ask_for_every_variant() -> None:
    folders = (Path(flowtex.__file__).parent / name for name in ("rendering", "plotting"))
    texts = [path.read_text() for folder in folders for path in folder.rglob("*.py")]
    named = {name for text in texts for name in re.findall(r'"(FLOWTEX_[A-Z]+)"', text)}
    sources = map(shaders.shader_source, shaders.shader_names())
    asked = {n for s in sources for line in re.findall(r"#(?:if|elif).*", s) for n in WORD(line)}
    assert {"FLOWTEX_IMAGE", "FLOWTEX_OPAQUE", "FLOWTEX_DEFERRED"} <= named <= asked


def test_no_line_of_shader_text_stands_in_python() -> None:
    package = Path(flowtex.__file__).parent
    marks = re.compile(r"\b(?:gl_Position|texture(?:Lod)?\(u_|vec[234]\(|uniform (?:float|vec))")
    guilty = [path.name for path in package.rglob("*.py") if marks.search(path.read_text())]
    assert guilty == []


def test_every_uniform_that_is_declared_is_set() -> None:
    texts = map(
        shaders.shader_source,
        (
            *("common/uniforms.glsl", "common/arrow.glsl", "common/place.glsl", "common/even.glsl"),
            *(f"vtk/{path.name}" for path in (shaders.shader_folder() / "vtk").iterdir()),
        ),
    )
    declared = set(re.findall(r"^uniform .*?(u_\w+)", "\n".join(texts), re.M))
    package = Path(shaders.__file__).parent
    written = set()
    for path in package.rglob("*.py"):
        written |= set(re.findall(r'"(u_\w+)"', path.read_text()))
    assert declared == written
