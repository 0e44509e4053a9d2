"""Shader text from the files in ``shaders/``: text in, text out.

Files include one another by a line ``//#include common/noise.glsl``, each at most once.
A variant is a set of names defined before the first line. Nothing here knows VTK or WebGL.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from flowtex.rendering.shader_files import shader_source

__all__ = ["VARIANTS", "GLSLError", "compose"]

_INCLUDE = re.compile(r"^[ \t]*//#include[ \t]+(\S+)[ \t]*$", re.MULTILINE)

#: Names that the files ask for with ``#ifdef``.
VARIANTS = (
    "FLOWTEX_PAPER",
    "FLOWTEX_PICTURE",
    "FLOWTEX_PLANAR",
    "FLOWTEX_SIGNFREE",
    "FLOWTEX_UNSTEADY",
)


class GLSLError(ValueError):
    """Shader text cannot be put together."""


def compose(name: str, variants: Iterable[str] = ()) -> str:
    """Return a shader file with its includes, and the variant's names defined before it.

    Parameters
    ----------
    name
        File inside ``shaders/``, such as ``"vtk/fragment_dec.glsl"``.
    variants
        Names out of :data:`VARIANTS`.

    Raises
    ------
    GLSLError
        When a variant is unknown, or files include one another in a circle.
    FileNotFoundError
        When there is no such file.
    """
    unknown = sorted(set(variants) - set(VARIANTS))
    if unknown:
        msg = f"unknown variant {', '.join(unknown)}; there are {', '.join(VARIANTS)}"
        raise GLSLError(msg)
    defines = "".join(
        f"#ifndef {variant}\n#define {variant}\n#endif\n" for variant in sorted(set(variants))
    )
    return defines + _expand(name, set(), ())


def _expand(name: str, seen: set[str], open_files: tuple[str, ...]) -> str:
    if name in open_files:
        msg = f"shader files include one another: {' -> '.join((*open_files, name))}"
        raise GLSLError(msg)
    if name in seen:
        return ""
    seen.add(name)

    def insert(match: re.Match[str]) -> str:
        return _expand(match.group(1), seen, (*open_files, name))

    return _INCLUDE.sub(insert, shader_source(name))
