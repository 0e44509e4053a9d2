"""The two variables of a dataset that are the components of a velocity.

They are found by CF's standard names, then by long names, then by names: one word of the first is
x, u, eastward or zonal, and the second is the variable whose name has the other word in its place.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flowtex.errors import FieldError
from flowtex.sources.datasets.axes import FACES, NODES

if TYPE_CHECKING:
    import xarray as xr

#: Words for the first component, and those for the second one.
PARTNERS = {
    "eastward": "northward",
    "zonal": "meridional",
    "east": "north",
    "x": "y",
    "u": "v",
}
FIRST_OF = {second: first for first, second in PARTNERS.items()}
#: First words for directions of the Earth, not of a grid.
EARTH = ("eastward", "zonal", "east")
#: Preferred names when a dataset has several velocities.
MAIN = ("sea_water_velocity", "sea_water_x_velocity", "wind", "x_wind")
#: Words of velocities.
MOVING = re.compile(r"velocity|wind|current|drift|momentum_component")
#: Names that are a velocity even where nothing else says so, without the letter of the component.
BARE = re.compile(
    r"^(|o|a|bar|vel|velocity|wind|wnd|cur|curr|current|grd|as|gos|water|component|"
    r"eulerian_current_velocity|.*(velocity|wind|current).*|"
    r"hvel|dahv|horizontalvel|depthaveragevel|nod|ureconstruct)\d*m?$"
)
#: Names of components in models that do not follow any pattern.
KNOWN_NAMES = {"vozocrtx": "vomecrty", "sozocrtx": "somecrty"}
#: Units of velocities in plain form, in metres per second.
UNITS = {
    "m/s": 1.0,
    "cm/s": 0.01,
    "mm/s": 0.001,
    "km/h": 1 / 3.6,
    "km/s": 1000.0,
    "m/day": 1 / 86400,
    "km/day": 1000 / 86400,
    "knot": 1852 / 3600,
    "ft/s": 0.3048,
}
WORDS = (
    (r"\bmet(?:er|re)s?\b", "m"),
    (r"\bcentimet(?:er|re)s?\b", "cm"),
    (r"\bkilomet(?:er|re)s?\b", "km"),
    (r"\bseconds?\b|\bsec\b", "s"),
    (r"\bhours?\b|\bhr?\b", "h"),
    (r"\bdays?\b|\bd\b", "day"),
    (r"\bknots?\b|\bkts?\b|\bkn\b", "knot"),
    (r"\bfeet\b|\bfoot\b", "ft"),
    (r"\s*\bper\b\s*", "/"),
    (r"[{}]", ""),
    (r"\s*[\s.*]\s*(s|h|day)\s*\**\^?-1\b", r"/\1"),
    (r"\s", ""),
)


@dataclass(frozen=True, eq=False)
class Pair:
    """Two variables that are the components of a velocity."""

    u: xr.DataArray
    v: xr.DataArray
    #: ``"earth"`` for eastward and northward, ``"grid"`` for along the grid, ``""`` if unknown.
    along: str
    why: str  #: The reason of the choice.
    rank: int = 0  #: How likely they are the velocity, 0 being the most likely.

    def __str__(self) -> str:
        return f"{self.u.name}, {self.v.name} ({self.why})"


def choose_pair(datasets: Sequence[xr.Dataset], u: str | None, v: str | None) -> Pair:
    """Return the velocity that is named, or the only one that is likely."""
    if (u is None) != (v is None):
        msg = f"u is {u!r} and v is {v!r}; name both components, or neither"
        raise FieldError(msg)
    pairs = find_pairs(datasets)
    if u is not None and v is not None:
        one, other = (variable(datasets, name) for name in (u, v))
        found = next((p for p in pairs if (p.u.name, p.v.name) == (u, v)), None)
        return found or Pair(one, other, _directions(one), "as named")
    if not pairs:
        raise FieldError(_no_pair(datasets))
    likely = [pair for pair in pairs if pair.rank == pairs[0].rank]
    if len(likely) > 1 and _on_mesh(likely[0].u):
        # The velocity of a model has levels, unlike wind or a depth mean; and it may also have
        # components along the axes of space besides those along the Earth.
        likely = [pair for pair in likely if _preference(pair) == _preference(likely[0])]
    if len(likely) > 1:
        listed = "; ".join(map(str, pairs))
        first = likely[0]
        msg = (
            f"several pairs of variables may be the velocity: {listed}. Name one of them, as in "
            f'u="{first.u.name}", v="{first.v.name}"'
        )
        raise FieldError(msg)
    return likely[0]


def two_names(vectors: str | None) -> dict[str, str]:
    """Return the arguments u and v for names with a comma between, as ``"uo,vo"``."""
    if vectors is None:
        return {}
    names = [word.strip() for word in vectors.split(",")]
    if len(names) != 2 or not all(names):
        msg = f'vectors is {vectors!r}; expected the names of two components, as in "uo,vo"'
        raise FieldError(msg)
    return dict(zip("uv", names, strict=True))


def find_pairs(datasets: Sequence[xr.Dataset]) -> list[Pair]:
    """Return the pairs that may be a velocity, the likely ones first."""
    arrays = [
        array for ds in datasets for array in ds.data_vars.values() if _may_be_component(array)
    ]
    pairs: dict[tuple[Any, Any], Pair] = {}
    for u in arrays:
        for source in ("standard_name", "long_name", "name"):
            for word, rest, partner in _partners(_text(u, source), source):
                for v in arrays:
                    key = (u.name, v.name)
                    if _text(v, source) != partner or key in pairs or not _match(u, v):
                        continue
                    rank = _rank(u, source, rest)
                    if rank is not None:
                        why = f"{source.replace('_', ' ')} with {word!r} and {PARTNERS[word]!r}"
                        pairs[key] = Pair(u, v, _directions(u), why, rank)
    return sorted(pairs.values(), key=_preference)


def other_velocities(datasets: Sequence[xr.Dataset], drawn: Pair) -> Iterator[str]:
    """Yield a notice for each file whose velocity is not drawn, as another file's is."""
    own = {ds.encoding.get("source") for ds in datasets if {drawn.u.name, drawn.v.name} & {*ds}}
    for ds in datasets:
        source = ds.encoding.get("source")
        if source is not None and source not in own and (pairs := find_pairs([ds])):
            u, v = pairs[0].u.name, pairs[0].v.name
            yield (
                f"{drawn.u.name} and {drawn.v.name} are drawn, and {u} and {v} of "
                f"{Path(source).name} are not; draw these by themselves"
            )


def _preference(pair: Pair) -> tuple[int, int, bool]:
    """Return a sort key, least for the most likely pair."""
    return pair.rank, -pair.u.ndim, pair.along != "earth"


def to_metres_per_second(array: xr.DataArray) -> float | None:
    """Return a variable's unit in metres per second; ``None`` where it has no unit."""
    unit, plain = str(array.attrs.get("units", "")).strip(), plain_unit(array)
    if unit in ("", "1", "-", "None", "unknown"):
        return None
    if plain not in UNITS:
        msg = (
            f"the unit of {array.name!r} is {unit!r}, which is not a unit of velocity; expected "
            f"{', '.join(UNITS)}. If it is wrong, set {array.name}.attrs['units']"
        )
        raise FieldError(msg)
    return UNITS[plain]


def plain_unit(array: xr.DataArray) -> str:
    """Return a variable's unit in small letters and short words, such as ``"m/s"``."""
    plain = str(array.attrs.get("units", "")).strip().lower()
    for pattern, word in WORDS:
        plain = re.sub(pattern, word, plain)
    return plain


def _may_be_component(array: xr.DataArray) -> bool:
    fewest = 1 if _on_mesh(array) else 2
    return array.ndim >= fewest and array.dtype.kind in "fiu" and "bounds" not in str(array.name)


def _on_mesh(array: xr.DataArray) -> bool:
    return bool({NODES, FACES} & set(array.dims))


def _text(array: xr.DataArray, source: str) -> str:
    """Return a name of a variable in small letters, its words parted by underscores."""
    text = str(array.name if source == "name" else array.attrs.get(source, ""))
    text = re.sub(r"[^0-9a-z]+", "_", text.lower()).strip("_")
    return re.sub(r"_at_\w+_location$", "", text) if source == "standard_name" else text


def _partners(
    text: str, source: str, partners: Mapping[str, str] = PARTNERS
) -> Iterator[tuple[str, str, str]]:
    """Yield the word of the component, the text without it, and the text of the partner."""
    if source == "name" and text in KNOWN_NAMES and partners is PARTNERS:
        yield "x", "velocity", KNOWN_NAMES[text]
    for word, other in partners.items():
        # A letter may be part of a name, as in uo, u10, UVEL or VSDX; in a text it is a word.
        pattern = word if source == "name" else rf"(?<![a-z0-9]){word}(?![a-z0-9])"
        for match in re.finditer(pattern, text):
            a, b = match.span()
            yield word, f"{text[:a]}_{text[b:]}".strip("_"), text[:a] + other + text[b:]


def _match(u: xr.DataArray, v: xr.DataArray) -> bool:
    """Return whether two variables have as many axes and the same unit."""
    same_unit = u.attrs.get("units", "") == v.attrs.get("units", "")
    return u.name != v.name and u.ndim == v.ndim and same_unit


def _rank(u: xr.DataArray, source: str, rest: str) -> int | None:
    """Return the rank of a pair, 0 for the most likely velocity; ``None`` for other variables."""
    try:
        is_velocity = to_metres_per_second(u) is not None
    except FieldError:
        return 6 if source == "standard_name" else None
    text = _text(u, source)
    if source != "name":
        plain = re.sub(r"_*(eastward|zonal)_*", "_", text).strip("_")
        if plain in MAIN:
            return 0
        return 1 if MOVING.search(text) else (4 if is_velocity else None)
    bare = BARE.match(rest) is not None
    if not bare and not is_velocity:
        return None
    return 2 if not rest and bare else 3 if bare else 5


def _directions(u: xr.DataArray) -> str:
    """Return the direction of a first component, preferably by its standard name."""
    relative = u.attrs.get("GRIB_uvRelativeToGrid")
    if relative is not None:
        return "grid" if int(relative) else "earth"
    for source in ("standard_name", "long_name", "name"):
        words = _text(u, source).split("_")
        if "grid" in words or ("x" in words and source != "name"):
            return "grid"
        if any(word in words for word in EARTH):
            return "earth"
    return ""


def variable(datasets: Sequence[xr.Dataset], name: str) -> xr.DataArray:
    """Return a variable of one of several datasets."""
    for ds in datasets:
        if name in ds.data_vars:
            return ds[name]
    names = ", ".join(str(n) for ds in datasets for n, a in ds.data_vars.items() if a.ndim >= 2)
    msg = f"the variable {name!r} does not exist; expected one of {names or 'none with two axes'}"
    raise FieldError(msg)


def _no_pair(datasets: Sequence[xr.Dataset]) -> str:
    """Return the message for a dataset without a pair, with its variables."""
    arrays = [a for ds in datasets for a in ds.data_vars.values() if _may_be_component(a)]
    for u in arrays:
        for source in ("standard_name", "long_name", "name"):
            text = _text(u, source)
            partners = [*_partners(text, source), *_partners(text, source, FIRST_OF)]
            missing = [
                wanted for _, rest, wanted in partners if _rank(u, source, rest) not in (None, 5, 6)
            ]
            if missing:
                return (
                    f"the data have one component of a velocity, {u.name!r} "
                    f"({u.attrs.get('long_name', source)}), but not the other one, whose "
                    f"{source.replace('_', ' ')} would be {missing[0]!r}; open the file that has "
                    "it together with this one, or name both, as in u=..., v=..."
                )
        for source in ("standard_name", "long_name", "name"):
            for _, _, partner in _partners(_text(u, source), source):
                if any(_text(v, source) == partner and _match(u, v) for v in arrays):
                    try:
                        to_metres_per_second(u)
                    except FieldError as error:
                        return str(error)
    names = ", ".join(str(a.name) for a in arrays)
    if not names:
        msg = "no variable has two axes; expected the two components of a velocity on a surface"
        lines = [(n, a.dims[-1]) for ds in datasets for n, a in ds.data_vars.items() if a.ndim]
        if lines:
            msg += (
                f". If {lines[0][1]} is the axis of an unstructured grid ({lines[0][0]} has it "
                "alone), open the file with its cells together with this one"
            )
        return msg
    return (
        "no two variables are recognised as the components of a velocity; the variables are "
        f"{names}. Name the components, as in u=..., v=..."
    )
