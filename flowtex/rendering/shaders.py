"""Shader text from the files in ``shaders/``, and its constants. Nothing here knows VTK or WebGL.

An installed wheel has the files as ``flowtex/_shaders``, a checkout (also one installed as
editable) as ``shaders`` beside the package. The folder is found from this module's own place and
never from the working folder, where a ``shaders`` folder would be the user's.
Files include one another by a line ``//#include common/noise.glsl``, each at most once. A variant
is a set of names that are defined before the first line.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path, PurePosixPath
from statistics import NormalDist
from typing import Any

import numpy as np

KERNELS = ("hann", "box", "ramp")  #: Kernels by their numbers in the shaders.
#: Values of a texture that stand for all, which are spread as a normal distribution.
MEAN_VALUES = np.array([NormalDist().inv_cdf((n + 0.5) / 16) for n in range(16)])

_PACKAGE = Path(__file__).resolve().parents[1]
_INCLUDE = re.compile(r"^[ \t]*//#include[ \t]+(\S+)[ \t]*$", re.MULTILINE)


@cache
def shader_folder(package: Path = _PACKAGE) -> Path:
    """Return the folder with the shaders: in an installed package, or in a checkout beside it.

    Raises
    ------
    FileNotFoundError
        When neither folder exists.
    """
    installed = package / "_shaders"
    if installed.is_dir():
        return installed
    checkout = package.parent
    # Beside an installed package lies site-packages, where "shaders" would be someone else's.
    if (checkout / "pyproject.toml").is_file() and (checkout / "shaders").is_dir():
        return checkout / "shaders"
    raise FileNotFoundError(
        f"flowtex's shaders are missing in {installed} and {checkout / 'shaders'}: install it again"
    )


def shader_names() -> tuple[str, ...]:
    """Return the name of every shader, sorted, such as ``"common/noise.glsl"``."""
    folder = shader_folder()
    paths = (path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    return tuple(
        sorted(path.as_posix() for path in paths if not any(p.startswith(".") for p in path.parts))
    )


@cache
def shader_source(name: str) -> str:
    """Return the text of one shader, by its path in the folder of shaders; it is read once.

    Raises
    ------
    FileNotFoundError
        When no shader has this name, or the name leads out of the folder.
    """
    path = shader_folder() / name
    # Listing all names takes longer than reading one, and is left to the error.
    inside = not any(part.startswith((".", "/")) for part in PurePosixPath(name).parts)
    if not inside or not path.is_file():
        raise FileNotFoundError(
            f"the shader {name!r} does not exist; expected one of: {', '.join(shader_names())}"
        )
    return path.read_text(encoding="utf-8")


def shader_text(name: str, variants: Iterable[str] = ()) -> str:
    """Return a shader with its includes, and the names of variants defined before it."""
    defines = "".join(
        f"#ifndef {variant}\n#define {variant}\n#endif\n" for variant in sorted(set(variants))
    )
    return defines + _expand(name, set())


def _expand(name: str, seen: set[str]) -> str:
    if name in seen:
        return ""
    seen.add(name)
    return _INCLUDE.sub(lambda match: _expand(match.group(1), seen), shader_source(name))


def _constant(kind: str, value: str) -> Any:
    """Return a constant of a type of GLSL; vectors are rows."""
    numbers = re.findall(r"(?<![\w.])-?(?:0x[0-9a-f]+|[\d.]+(?:e-?\d+)?)", value)
    if kind in ("int", "float"):
        return {"int": int, "float": float}[kind](numbers[0])
    if kind == "mat3":
        return np.array(numbers, dtype=float).reshape(3, 3)
    whole = np.array([int(number, 0) for number in numbers], dtype=np.uint32)
    if kind == "uint":
        return whole[0]
    return whole


class _Constants:
    def __getattr__(self, name: str) -> Any:
        """Read all constants when the first one is needed."""
        text = shader_source("common/constants.glsl")
        found = re.findall(r"const (\w+) FLOWTEX_(\w+) = ([^;]*);", text)
        vars(self).update({name: _constant(kind, value) for kind, name, value in found})
        if name not in vars(self):
            raise AttributeError(f"the shaders have no constant {name!r}")
        return vars(self)[name]


#: The numbers of the method by their names without the prefix; the file explains each.
const = _Constants()
