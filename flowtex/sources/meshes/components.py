"""Vectors in single components, found by the names of arrays.

Solvers and their converters write ``X Velocity``, ``VelocityY``, ``vel_z``, ``Velocity:0``, ``u``
or ``Velocity u [m/s]``. Names that differ only in one letter or number, that of the component, are
one vector.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

#: Names of vectors other than the velocity.
NO_VELOCITY = re.compile(
    r".*normals?|.*texture.?coord.*|t_?coords?|coord(inate)?s?|points?|positions?", re.IGNORECASE
)
#: Momenta, which are not velocities; a real array of vectors is left to the user.
_MOMENTUM = re.compile(r".*momentum.*|rho.?[uv]?", re.IGNORECASE)
_VELOCITY = re.compile(r"(.*[ _.:-])?(vel|velocit(y|ies)|wind|[uv])([ _.:-].*)?", re.IGNORECASE)

#: Letters and numbers of the components.
_AXES = ("xyz", "XYZ")
_ALPHABETS = (*_AXES, "uvw", "UVW", "012", "123")
_GAP = r"[ _.:-]+"
_FORMS = tuple(
    re.compile(form)
    for form in (
        rf"(?P<token>[x-zu-w]){_GAP}.+",
        rf"(?P<token>[X-ZU-W]){_GAP}.+",
        r"(?P<token>[XYZ])[A-Z][a-z].*",
        rf".+?{_GAP}(?P<token>[X-ZU-Wx-zu-w0-3])",
        r".+?[\[(](?P<token>[X-ZU-Wx-zu-w0-3])[\])]",
        r".*[a-z0-9](?P<token>[XYZ])",
        r"([uv]|vel|velocity)(?P<token>[xyz0-3])",
        r"([UV]|Vel|Velocity|VEL|VELOCITY)(?P<token>[xyzXYZ0-3])",
        r"(?P<token>[uvwUVW])",
    )
)
_UNIT = re.compile(r"\s*(\[[^\]]{2,}\]|\([^)]{2,}\))$")
_EDGES = " _.:-()[]"


def find_vectors(
    names: Sequence[str], pair: tuple[int, int] | None = None
) -> dict[str, tuple[str, ...]]:
    """Return the names of the components of each vector, by a name for the vector.

    Two components are sufficient on a flat mesh: those along the ``pair`` of axes in its plane, or
    the first two if their letters name no axes. A vector has the name of its components without
    their letter, ``Velocity``, or if that is too short or the name of an array, all their names,
    ``u,v,w``.
    """
    all_names = set(names)
    vectors: dict[str, tuple[str, ...]] = {}
    for name in names:
        for before, alphabet, after in _parses(name):
            whole = tuple(before + token + after for token in alphabet)
            # Four numbered arrays are not a vector.
            numbered = [before + n + after for n in "0123"] if alphabet[0].isdecimal() else []
            if numbered and all_names.issuperset(numbered):
                continue
            choices = [whole]
            if pair is not None:
                pairs = dict.fromkeys((pair, pair if alphabet in _AXES else (0, 1)))
                choices += [(whole[first], whole[second]) for first, second in pairs]
            parts = next((parts for parts in choices if all_names.issuperset(parts)), ())
            if parts and name == parts[0] and parts not in vectors.values():
                stem = _stem(before, after)
                free = len(stem) > 1 and stem not in all_names and stem not in vectors
                vectors[stem if free else ",".join(parts)] = parts
    return vectors


def named_axes(parts: Sequence[str]) -> tuple[tuple[int, ...], bool]:
    """Return the axes, 0 to 2, of named components, empty if unknown, and if these say x, y, z."""
    parses = (*_parses(parts[0]), *(("", axes, "") for axes in _AXES)) if parts else ()
    for before, alphabet, after in parses:
        whole = [before + token + after for token in alphabet]
        if set(parts) <= set(whole) and len(set(parts)) == len(parts):
            axes = tuple(whole.index(part) for part in parts)
            return (axes, True) if alphabet in _AXES else (() if axes == (0, 1) else axes, False)
    return (), False


def _parses(name: str) -> Iterator[tuple[str, str, str]]:
    """Yield the ways to read a name: text, alphabet of the component, and text."""
    bare = _UNIT.sub("", name)
    for form in _FORMS:
        match = form.fullmatch(bare)
        if match is None or "," in name:
            continue
        start, end = match.span("token")
        before, after = name[:start], name[end:]
        stem, token = _stem(before, after), match["token"]
        if NO_VELOCITY.fullmatch(stem) or _MOMENTUM.fullmatch(stem):
            continue
        velocity = bool(_VELOCITY.fullmatch(stem))
        for alphabet in _ALPHABETS:
            if token in alphabet and _is_plausible(stem, alphabet, before, velocity=velocity):
                yield before, alphabet, after


def _is_plausible(stem: str, alphabet: str, before: str, *, velocity: bool) -> bool:
    """Return whether a name may be a component: x, y, z and numbers also have other uses."""
    if alphabet[0] in "uU":
        return velocity or not stem
    if alphabet[0].isdecimal():
        return velocity or before.endswith((":", "["))
    return bool(stem)


def _stem(before: str, after: str) -> str:
    """Return the name of a vector: that of a component without its letter and its unit."""
    return (before + _UNIT.sub("", after)).strip(_EDGES)
