"""The shaders ask for no more than OpenGL 3.2 and WebGL 2 have; macOS ends at OpenGL 4.1.

What a newer driver takes silently is looked for by its name; with ``glslangValidator`` on the path,
which Debian has in glslang-tools, every variant is compiled as GLSL 1.50 as well.
"""

from __future__ import annotations

import itertools
import re
import shutil
import subprocess

import pytest

from flowtex.rendering import shaders

#: Words of GLSL after 1.50, or after what GLSL ES 3.00 has.
NEWER = (
    r"layout|precise|patch|subroutine|buffer|shared|coherent|readonly|writeonly|double|dvec\w+"
    r"|u?image\w*[123]D\w*|samplerCube\w*Array\w*|atomic\w+|gl_SampleID|gl_PointCoord"
    r"|(?:un)?pack(?:Half|Unorm|Snorm|Double)\w+|bitfield\w+|bitCount|find[LM]SB|fma|frexp|ldexp"
    r"|intBitsToFloat|uintBitsToFloat|floatBitsTo\w+|[iu]mulExtended|uaddCarry|textureQuery\w+"
    r"|textureGather\w*|interpolateAt\w+|dFd[xy](?:Fine|Coarse)|fwidth(?:Fine|Coarse)"
)
#: Textures that the fragments of one draw may read; VTK has some of its own.
MOST_SAMPLERS = 16 - 6
STAGES = {
    "frag": ("vtk/fragment_dec.glsl", "vtk/fragment_impl.glsl"),
    "vert": ("vtk/vertex_dec.glsl", "vtk/vertex_impl.glsl"),
    "line": ("vtk/line_vertex_dec.glsl", "vtk/line_vertex_impl.glsl"),
}
#: What VTK has declared by the place where the text goes.
AROUND = {
    "frag": "vec3 ambientColor = vec3(1.0), diffuseColor = vec3(1.0);"
    "float ambientIntensity = 0.15, diffuseIntensity = 1.0;",
    "vert": "",
    "line": "",
}
LINE_UNIFORMS = (
    "uniform mat4 MCDCMatrix; uniform vec4 flowtexViewport; uniform float flowtexRadius;"
    "uniform float flowtexNearer;"
)


def without_comments(text: str) -> str:
    return re.sub(r"//.*|/\*.*?\*/", "", text)


#: Those of them that GLSL ES 3.00 has.
WEBGL2 = {"layout", "floatBitsToUint", "uintBitsToFloat", "packHalf2x16", "unpackHalf2x16"}


@pytest.mark.parametrize("name", shaders.shader_names())
def test_no_word_is_newer(name: str) -> None:
    text = without_comments(shaders.shader_source(name))
    allowed = WEBGL2 if name.startswith("webgl2/") else set()
    assert set(re.findall(rf"\b(?:{NEWER})\b", text)) <= allowed
    if not name.startswith("webgl2/"):
        assert not re.search(r"#version|#extension|\bprecision\b", text)


def test_samplers_and_arrays_are_few() -> None:
    text = without_comments(shaders.shader_text("vtk/sum_fragment.glsl"))
    samplers = re.findall(r"uniform (?:\w+ )?(\w*sampler\w+) u_\w+", text)
    assert set(samplers) == {"sampler2D", "sampler2DArray"}  # in OpenGL since 3.0
    assert len(samplers) <= MOST_SAMPLERS
    # 1024 numbers are sure; an entry of an array takes four.
    lengths = dict(re.findall(r"const int (FLOWTEX_\w+) = (\d+);", text))
    arrays = [int(lengths[n]) for n in re.findall(r"uniform float u_\w+\[(FLOWTEX_\w+)\]", text)]
    assert 4 * sum(arrays) + 4 * text.count("uniform ") <= 1024


VARIANTS = tuple(
    f"FLOWTEX_{name}"
    for name in (
        *("CELLS", "DEFERRED", "MOVING", "IMAGE", "OPAQUE", "PLANAR", "SIGNFREE"),
        *("SPARSE", "TRIANGLES", "UNCERTAIN", "UNSTEADY"),
    )
)


def chosen_variants() -> list[tuple[str, ...]]:
    """Variants in pairs, and all that do not exclude each other: more take minutes."""
    single = [()] + [(name,) for name in VARIANTS]
    return [*single, *itertools.combinations(VARIANTS, 2), VARIANTS]


@pytest.mark.skipif(shutil.which("glslangValidator") is None, reason="apt-get: glslang-tools")
def test_every_variant_is_glsl_150() -> None:
    for variant, stage in itertools.product(chosen_variants(), STAGES):
        declarations, body = (shaders.shader_text(name, variant) for name in STAGES[stage])
        uniforms = LINE_UNIFORMS if stage == "line" else ""
        main = f"void main() {{\n{AROUND[stage]}\n{body}\n}}\n"
        done = subprocess.run(
            ["glslangValidator", "--stdin", "-S", "frag" if stage == "frag" else "vert"],
            input="\n".join(["#version 150", uniforms, declarations, main]),
            capture_output=True,
            encoding="utf-8",
            check=False,
        )
        assert done.returncode == 0, f"{stage} {variant}\n{done.stdout}"
