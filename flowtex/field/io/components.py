"""Vectors that a file has as single components, found by their names.

Solvers, and what turns their results into tables, write ``X Velocity``, ``VelocityY``, ``vel_z``,
``Velocity:0``, ``u`` or ``Velocity u [m/s]``. Names that differ in one letter or number alone, that
of the component, are one vector.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

#: Names of vectors other than the velocity.
NO_VELOCITY = re.compile(
    r".*normals?|.*texture.?coord.*|t_?coords?|coord(inate)?s?|points?|positions?", re.IGNORECASE
)
#: What follows the flow and is not its velocity; a real array of vectors is left to the user.
_MOMENTUM = re.compile(r".*momentum.*|rho.?[uv]?", re.IGNORECASE)
_VELOCITY = re.compile(r"(.*[ _.:-])?(vel|velocit(y|ies)|wind|[uv])([ _.:-].*)?", re.IGNORECASE)

#: Letters and numbers of the components.
_ALPHABETS = ("xyz", "XYZ", "uvw", "UVW", "012", "123")
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


def find_vectors(names: Sequence[str], *, pairs: bool = False) -> dict[str, tuple[str, ...]]:
    """Return the names of the three components of each vector, by a name for the vector.

    With ``pairs``, as on a flat mesh, two components do where there is no third. A vector is named
    as its components without their letter, ``Velocity``, or where that says nothing or is the name
    of an array, as all of them, ``u,v,w``.
    """
    known = set(names)
    found: dict[str, tuple[str, ...]] = {}
    for name in names:
        for before, alphabet, after in _parses(name):
            parts = [before + token + after for token in alphabet]
            # Four numbered arrays are not a vector.
            more = [before + n + after for n in "0123"] if alphabet[0].isdecimal() else []
            if name != parts[0] or (more and known.issuperset(more)):
                continue
            if pairs and parts[1] in known and parts[2] not in known:
                parts = parts[:2]
            if known.issuperset(parts) and tuple(parts) not in found.values():
                stem = _stem(before, after)
                free = len(stem) > 1 and stem not in known and stem not in found
                found[stem if free else ",".join(parts)] = tuple(parts)
    return found


def _parses(name: str) -> Iterator[tuple[str, str, str]]:
    """Go through the ways to read a name as text, alphabet of the component, and text."""
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
            if token in alphabet and _plausible(stem, alphabet, before, velocity=velocity):
                yield before, alphabet, after


def _plausible(stem: str, alphabet: str, before: str, *, velocity: bool) -> bool:
    """Whether a word may be a component: x, y and z are places, and numbers count anything."""
    if alphabet[0] in "uU":
        return velocity or not stem
    if alphabet[0].isdecimal():
        return velocity or before.endswith((":", "["))
    return bool(stem)


def _stem(before: str, after: str) -> str:
    """Return the name of a vector: that of a component without its letter and its unit."""
    return (before + _UNIT.sub("", after)).strip(_EDGES)
