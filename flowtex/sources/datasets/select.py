"""The two variables of a dataset that are the components of a velocity.

They are found by CF's standard names, then by long names, then by names: one word of the first is
x, u, eastward or zonal, and the second is the variable whose name has the other word in its place.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.field.vector_names import is_velocity
from flowtex.remedies import Remedy
from flowtex.sources.datasets.axes import FACES, NODES, ON_EARTH, horizontal_dims
from flowtex.sources.datasets.curved import is_around, on_sphere
from flowtex.sources.datasets.directions import (
    ANGLE,
    ANGLES,
    BY_WORD,
    CARTESIAN,
    MAGNITUDES,
    MEANINGS,
    OF_SPEED,
    PLAIN_ANGLES,
    POLAR,
    SPEEDS,
    SPHERICAL,
    TOWARDS,
    TURNS,
    convention,
)
from flowtex.sources.datasets.masks import LAND, SEA
from flowtex.sources.datasets.space_planes import partners_along

if TYPE_CHECKING:
    import xarray as xr

#: Names of a variable, the most reliable first.
NAMES = ("standard_name", "long_name", "name")
#: Words for the first component, and those for the second one.
PARTNERS = {"eastward": "northward", "zonal": "meridional", "east": "north", "x": "y", "u": "v"}
FIRST_OF = {second: first for first, second in PARTNERS.items()}
#: First words for directions of the Earth, not of a grid.
EARTH = ("eastward", "zonal", "east")
#: Preferred names when a dataset has several velocities.
MAIN = ("sea_water_velocity", "sea_water_x_velocity", "wind", "x_wind")
#: The standard name of variables that have none, as cfgrib writes it.
UNKNOWN = "unknown"
#: Words of velocities.
MOVING = re.compile(r"velocity|wind|current|drift|momentum_component")
#: Words of the errors and the spread of a velocity, which are no velocity.
SPREAD = re.compile(
    r"(^|_)(err|errors?|uncert|uncertainty|stde?v?|stddev|standard_deviation|variance)(_|$)"
)
#: Names of a velocity and the letter of its first component, as in ux, vx and U_x.
WITH_LETTER = re.compile(r"^[uv]_?x\d*m?$")
#: Names that are a velocity even where nothing else says so, without the letter of the component.
BARE = re.compile(
    r"^(|o|a|u|v|bar|vel|velocity|wind|wnd|cur|curr|current|grd|as|gos|water|comp|component|"
    r"eulerian_current_velocity|.*(velocity|wind|current).*|"
    r"hvel|dahv|horizontalvel|depthaveragevel|nod|ureconstruct)\d*m?$"
)
#: Names of components that do not follow any pattern: the word for the first, and the second.
KNOWN_NAMES = {
    "vozocrtx": ("x", "vomecrty"),
    "sozocrtx": ("x", "somecrty"),
    "uu": ("x", "vv"),
    "ve": ("east", "vn"),
    "v_e": ("east", "v_n"),
    "vel_e": ("east", "vel_n"),
}
#: Words for the components in a vertical plane.
SECTION_PARTNERS = {"x": "z", "u": "w"}
#: Modifiers of CF's standard names, which make other variables of these.
MODIFIERS = re.compile(
    r"\b(status_flag|standard_error|number_of_observations|detection_minimum)\b|quality_flag"
)
#: A name that ends with the number of a component.
NUMBERED = re.compile(r"^(.*[^0-9])[123]$")
#: Names of components along polar coordinates, without the letters of the vector.
RADIAL = re.compile(r"^[uvw]?_?(r|rad|radial)$|^radial_\w+$", re.I)
AROUND = re.compile(
    r"^[uvw]?_?(phi|theta|t|a|az|azimuth|azimuthal|tangential|angular)$|^(azimuthal|tangential)_\w+$",
    re.I,
)
#: Names of components along colatitude and longitude.
SOUTHWARD = re.compile(r"^(u|v|w|vel|velocity)_?(theta|colat\w*)$", re.I)
AROUND_AXIS = re.compile(r"^(u|v|w|vel|velocity)_?(phi|lon\w*)$", re.I)
#: The key of GRIB's flags, and the bit of components along the grid.
GRIB_FLAGS = "resolutionAndComponentFlags"
ALONG_GRID = 8
#: Words of descriptions that say along what the components are.
TO_EARTH = re.compile(r"\b(earth|true|geographic)[- _]?(rotated|relative|north)|to earth\b", re.I)
TO_GRID = re.compile(r"\bgrid[- _]?(relative|oriented|aligned)|relative to (the )?grid", re.I)
#: Rank of the least likely pairs that a notice names beside the drawn one.
LEAST_LIKELY = 4
#: Coordinates, which are no components though their standard names say x and y.
PLACES = re.compile(r"(coordinate|longitude|latitude)$")


@dataclass(frozen=True, eq=False)
class Pair:
    """Two variables that are the components of a velocity."""

    u: xr.DataArray
    v: xr.DataArray
    #: ``"earth"`` for eastward and northward, ``"grid"`` for along the grid, ``""`` if unknown.
    along: str
    why: str  #: The reason of the choice.
    rank: int = 0  #: How likely they are the velocity, 0 being the most likely.
    kind: str = CARTESIAN  #: How the variables give the components.
    named: bool = False  #: Whether the user named them, so that their unit may be any.
    #: Whether the second component was exchanged with the first, as it is along the columns.
    swapped: bool = False
    guessed: bool = False  #: Whether the reason is a choice that a notice should report.
    words: frozenset[str] = frozenset()  #: Words of the attribute that says what it is.

    def __str__(self) -> str:
        return f"{', '.join(self.parts)} ({self.why})"

    @property
    def parts(self) -> tuple[str, str]:
        """Names of the components in their order."""
        if self.swapped:
            return str(self.v.name), str(self.u.name)
        return str(self.u.name), str(self.v.name)

    @property
    def names(self) -> str:
        """Names of both, with a comma between."""
        return ",".join(self.parts)


def choose_pair(
    datasets: Sequence[xr.Dataset], u: str | None, v: str | None, direction: str | None = None
) -> Pair:
    """Return the velocity that is named, or the only one that is likely.

    ``direction`` names the angle of a speed.

    Raises
    ------
    FieldError
        When no variables are likely to be the velocity, or several are equally likely.
    """
    if direction is not None:
        return _with_direction(datasets, u, direction)
    pairs = find_pairs(datasets)
    if u is not None and v is not None:
        one = variable(datasets, u)
        other = variable(datasets, v)
        others = []
        for ds in datasets:
            for a in ds.data_vars.values():
                if _may_be_component(a):
                    others.append(a)
        pairs = [*pairs, *_speeds(others), *_curved(others)]
        found = next((p for p in pairs if (p.u.name, p.v.name) == (u, v)), None)
        return replace(found or _as_named(one, other), named=True)
    if not pairs:
        raise FieldError(_no_pair(datasets))
    likely = [pair for pair in pairs if pair.rank == pairs[0].rank]
    if len(likely) > 1 and _on_mesh(likely[0].u):
        # The velocity of a model has levels, unlike wind or a depth mean; and it may also have
        # components along the axes of space besides those along the Earth.
        likely = [pair for pair in likely if _preference(pair) == _preference(likely[0])]
    first = likely[0]
    if not _is_plainest(first, likely[1:]):
        listed = "; ".join(
            str(pair) for pair in pairs if pair.rank <= max(first.rank, LEAST_LIKELY)
        )
        text = f"several pairs of variables may be the velocity: {listed}. Name"
        raise FieldError(f'{text} one of them, as in u="{first.u.name}", v="{first.v.name}"')
    return first


def _is_plainest(pair: Pair, others: Sequence[Pair]) -> bool:
    """Return whether the attributes of all others have all words of a pair, and further ones."""
    return all(pair.words and pair.words < other.words for other in others)


def _with_direction(datasets: Sequence[xr.Dataset], speed: str | None, direction: str) -> Pair:
    """Return a speed, the only one if none is named, with the angle that the user names."""
    turn = variable(datasets, direction)
    if speed is not None:
        return _of_angle(variable(datasets, speed), turn)
    alike = []
    for ds in datasets:
        for name, array in ds.data_vars.items():
            is_beside = array.dtype.kind in "fiu" and {*array.dims} == {*turn.dims}
            if is_beside and name != direction:
                alike.append(array)
    speeds = [a for a in alike if SPEEDS.search(_standard(a))]
    if len(speeds) != 1:
        found = ", ".join(str(a.name) for a in speeds or alike) or "none"
        raise FieldError(
            f"direction is {direction!r}, and variables that may be its speed are {found}; name "
            f'the speed, as in vectors="speed", direction="{direction}"'
        )
    return _of_angle(speeds[0], turn)


def _of_angle(speed: xr.DataArray, angle: xr.DataArray) -> Pair:
    """Return a magnitude and an angle that the user names."""
    meaning = convention(speed, angle)
    why = f"{speed.name} and {angle.name}, {meaning.words}"
    if not meaning.is_declared:
        why += ", as nothing says otherwise"
    guessed = not meaning.is_declared
    return Pair(speed, angle, "earth", why, kind=meaning.kind, named=True, guessed=guessed)


def other_angle(pair: Pair) -> Remedy:
    """Return the argument that gives the angle of a pair another meaning."""
    word = "to"
    if pair.kind == TOWARDS:
        word = "from"
    return Remedy("components", word, f"if it is {MEANINGS[word]},")


def likely_others(datasets: Sequence[xr.Dataset], pair: Pair) -> list[str]:
    """Return the names of other pairs that may be a velocity as well.

    Those of other files are left to :func:`other_velocities`.
    """
    own = []
    for ds in datasets:
        if "source" not in ds.encoding or {pair.u.name, pair.v.name} & {*ds}:
            own.append(ds)
    found = []
    for other in find_pairs(own):
        is_same = {str(other.u.name), str(other.v.name)} == {*pair.parts}
        if not is_same and other.rank <= LEAST_LIKELY:
            found.append(other.names)
    return found


def _as_named(one: xr.DataArray, other: xr.DataArray) -> Pair:
    """Return a pair that only its user knows: components, or a magnitude and an angle."""
    if not _is_angle(other) or _is_angle(one):
        return Pair(one, other, _directions(one), "as named")
    return _of_angle(one, other)


def _is_angle(array: xr.DataArray) -> bool:
    unit = str(array.attrs.get("units", ""))
    name = str(array.name)
    if units.parsed(unit) is not None:
        return units.is_angle(unit)
    return bool(ANGLES.search(name) or TURNS.search(name))


def two_names(
    vectors: str | None, argument: str = "vectors", example: str = "uo,vo"
) -> tuple[str, str] | tuple[None, None]:
    """Return the names of two components, such as ``("uo", "vo")`` of ``"uo,vo"``.

    ``argument`` and ``example`` are for messages.

    Raises
    ------
    FieldError
        When the text is not two names with a comma between.
    """
    if vectors is None:
        return None, None
    names = [word.strip() for word in str(vectors).split(",")]
    if len(names) != 2 or not all(names):
        raise FieldError(f'{argument} is {vectors!r}; expected two names, as in "{example}"')
    return names[0], names[1]


def find_pairs(datasets: Sequence[xr.Dataset]) -> list[Pair]:
    """Return the pairs that may be a velocity, the likely ones first."""
    arrays = []
    for ds in datasets:
        for array in ds.data_vars.values():
            if _may_be_component(array):
                arrays.append(array)
    planes = partners_along(arrays, list(map(horizontal_dims, arrays)))
    for partners in (*planes, PARTNERS, SECTION_PARTNERS):
        if pairs := _cartesian(arrays, partners):
            return sorted(pairs, key=_order)
    return [*_speeds(arrays), *_curved(arrays), *_as_coordinates(arrays)]


def _as_coordinates(arrays: Sequence[xr.DataArray]) -> Iterator[Pair]:
    """Yield components whose names end as those of the coordinates, as velocity_n and grid_n."""
    for u, v in product(arrays, arrays):
        first, _, across = str(u.name).rpartition("_")
        second, _, upward = str(v.name).rpartition("_")
        dims = horizontal_dims(u)
        if first != second or not MOVING.search(first) or u.dims != v.dims or len(dims) < 2:
            continue
        on_axis = set()
        for name, c in u.coords.items():
            on_axis.add((c.dims, str(name).rpartition("_")[2]))
        is_told = {(dims[:1], upward), (dims[1:], across)} <= on_axis
        if is_told and _match(u, v):
            why = f"names that end as those of the coordinates, with {across!r} and {upward!r}"
            yield Pair(u, v, "", why, 5)


def _cartesian(arrays: Sequence[xr.DataArray], partners: Mapping[str, str]) -> list[Pair]:
    pairs: dict[tuple[Any, Any], Pair] = {}
    for u, source in product(arrays, NAMES):
        for word, rest, partner in _partners(_text(u, source), source, partners):
            why = f"{source.replace('_', ' ')} with {word!r} and {partners[word]!r}"
            rank = _rank(u, source, rest)
            words: frozenset[str] = frozenset()
            if source != "name":
                words = frozenset(_text(u, source).split("_"))
            for v in arrays if rank is not None else ():
                if (
                    _text(v, source) == partner
                    and _match(u, v)
                    and not _crossed(u, v, arrays, partners)
                ):
                    pair = Pair(u, v, _directions(u), why, rank or 0, words=words)
                    pairs.setdefault((u.name, v.name), pair)
    return list(pairs.values())


def _speeds(arrays: Sequence[xr.DataArray]) -> Iterator[Pair]:
    for speed in arrays:
        if not SPEEDS.search(_standard(speed)) or _is_velocity(speed) is False:
            continue
        turns = [turn for turn in arrays if _turns(speed, turn)]
        stem = OF_SPEED.sub("", _standard(speed))
        own = [turn for turn in turns if OF_SPEED.sub("", _standard(turn)) == stem] or turns
        # Of several with one standard name, names tell which belong together.
        named = OF_SPEED.sub("", str(speed.name))
        same = [turn for turn in own if OF_SPEED.sub("", str(turn.name)) == named]
        for turn in same or own:
            meaning = convention(speed, turn)
            words = f"{speed.name} and {turn.name}, {meaning.words}"
            guessed = meaning.kind == ANGLE and not meaning.is_declared
            yield Pair(speed, turn, "earth", words, 5, meaning.kind, guessed=guessed)


def _turns(speed: xr.DataArray, turn: xr.DataArray) -> bool:
    """Return whether a variable may be the direction of a speed."""
    named = _standard(turn)
    unit = str(turn.attrs.get("units", ""))
    is_angle = units.is_angle(unit) or units.parsed(unit) is None
    if not is_angle or turn.ndim != speed.ndim:
        return False
    if MAGNITUDES.search(_standard(speed)) and ANGLES.search(named):
        return True
    if SPEEDS.fullmatch(_standard(speed)) and PLAIN_ANGLES.fullmatch(named):
        return True
    first = ""
    if speed.attrs.get("standard_name", UNKNOWN) != UNKNOWN:
        first = re.sub(r"_?speed$", "", _standard(speed))
    return bool(TURNS.search(named)) and named.startswith(first)


def _standard(array: xr.DataArray) -> str:
    """Return a standard name, or else a name, with underscores between its words.

    A long name has its place where it says more than the name, as of ``si10`` of GRIB.
    """
    name = str(array.attrs.get("standard_name", UNKNOWN))
    if name != UNKNOWN:
        return _parted(name)
    name = _parted(str(array.name))
    if SPEEDS.search(name) or TURNS.search(name):
        return name
    described = _text(array, "long_name")
    if SPEEDS.search(described) or TURNS.search(described):
        return described
    return name


def _parted(name: str) -> str:
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z][a-z])", "_", name)


def _curved(arrays: Sequence[xr.DataArray]) -> Iterator[Pair]:
    """Yield the components on a sphere and along a radius and an angle."""
    for u, v in product(arrays, arrays):
        names = str(u.name), str(v.name)
        if not _match(u, v):
            continue
        if SOUTHWARD.match(names[0]) and AROUND_AXIS.match(names[1]) and on_sphere(u):
            yield Pair(u, v, "earth", "components along colatitude and longitude", 5, SPHERICAL)
        if RADIAL.match(names[0]) and AROUND.match(names[1]) and not on_sphere(u):
            yield Pair(u, v, "plane", "components along a radius and an angle", 5, POLAR)


def with_directions(pair: Pair, components: str | None) -> Pair:
    """Return a pair whose components have the directions that the user names.

    Of those in polar and spherical coordinates the first is along the columns, as on any grid.
    """
    kind = pair.kind
    if components in BY_WORD:
        kind = BY_WORD[components]
        meaning = f"{' and '.join(pair.parts)}, {MEANINGS[components]}"
        pair = replace(pair, along="earth", why=meaning, guessed=False)
    elif components in ("polar", "cylindrical"):
        kind = POLAR
    elif components == "spherical":
        kind = SPHERICAL
    elif components is not None and kind in (POLAR, SPHERICAL):
        kind = CARTESIAN
    pair = replace(pair, kind=kind)
    if kind in (POLAR, SPHERICAL) and is_around(horizontal_dims(pair.u)[-1]):
        return replace(pair, u=pair.v, v=pair.u, swapped=True)
    return pair


def other_velocities(datasets: Sequence[xr.Dataset], drawn: Pair) -> Iterator[tuple[str, str]]:
    """Yield a notice for each file whose velocity is not drawn, and the names of its components."""
    own = {ds.encoding.get("source") for ds in datasets if {drawn.u.name, drawn.v.name} & {*ds}}
    for ds in datasets:
        source = ds.encoding.get("source")
        if source is not None and source not in own and (pairs := find_pairs([ds])):
            u = pairs[0].u.name
            v = pairs[0].v.name
            yield (
                f"{drawn.u.name} and {drawn.v.name} are drawn, and {u} and {v} of "
                f"{Path(source).name} are not",
                pairs[0].names,
            )


def _preference(pair: Pair) -> tuple[int, int, bool]:
    return pair.rank, -pair.u.ndim, pair.along != "earth"


def _order(pair: Pair) -> tuple[tuple[int, int, bool], int]:
    """Return what sorts pairs: the likely ones first, and of these those with few words."""
    return _preference(pair), len(pair.words)


def velocity_unit(array: xr.DataArray, *, any_kind: bool = False) -> str:
    """Return a variable's unit of velocity, or of any kind; empty where it has no unit.

    Raises
    ------
    FieldError
        When the unit is not one of velocity, unless ``any_kind`` is set.
    """
    unit = str(array.attrs.get("units", "")).strip()
    if unit.lower() in units.NONE:
        return ""
    if not any_kind and not units.measures(unit, units.VELOCITIES):
        raise FieldError(
            f"the unit of {array.name!r} is {unit!r}, which is not a unit of velocity, such as "
            f"m/s, cm/s or knots. If it is wrong, set {array.name}.attrs['units']"
        )
    return unit


def _is_velocity(array: xr.DataArray) -> bool | None:
    """Return whether a variable has a unit of velocity; ``None`` where it has no unit."""
    try:
        return velocity_unit(array) != "" or None
    except FieldError:
        return False


def _may_be_component(array: xr.DataArray) -> bool:
    if _on_mesh(array):
        fewest = 1
    else:
        fewest = 2
    named = f"{array.name} {array.attrs.get('standard_name', '')}"
    other = "bounds" in named or "_bnd" in named or MODIFIERS.search(named)
    other = other or PLACES.search(str(array.attrs.get("standard_name", "")))
    other = other or SEA.match(str(array.name)) or LAND.match(str(array.name))
    return array.ndim >= fewest and array.dtype.kind in "fiu" and not other


def _on_mesh(array: xr.DataArray) -> bool:
    return bool({NODES, FACES} & set(array.dims))


def _text(array: xr.DataArray, source: str) -> str:
    """Return a name of a variable in small letters, its words parted by underscores."""
    text = str(array.name if source == "name" else array.attrs.get(source, ""))
    text = re.sub(r"[^0-9a-z]+", "_", text.lower()).strip("_")
    if source == "standard_name":
        return re.sub(r"_at_\w+_location$", "", text)
    return text


def _partners(
    text: str, source: str, partners: Mapping[str, str] = PARTNERS
) -> Iterator[tuple[str, str, str]]:
    """Yield the word of the component, the text without it, and the text of the partner."""
    if source == "name" and text in KNOWN_NAMES and partners is PARTNERS:
        word, partner = KNOWN_NAMES[text]
        yield word, "velocity", partner
    for word, other in partners.items():
        # A letter may be part of a name, as in uo, u10, UVEL or VSDX; in a text it is a word.
        if source == "name":
            pattern = word
        else:
            pattern = rf"(?<![a-z0-9]){word}(?![a-z0-9])"
        for match in re.finditer(pattern, text):
            a, b = match.span()
            yield word, f"{text[:a]}_{text[b:]}".strip("_"), text[:a] + other + text[b:]


def _match(u: xr.DataArray, v: xr.DataArray) -> bool:
    kinds = {_is_velocity(u), _is_velocity(v)}
    return u.name != v.name and (len(kinds) == 1 or False not in kinds)


def _crossed(
    u: xr.DataArray,
    v: xr.DataArray,
    arrays: Sequence[xr.DataArray],
    partners: Mapping[str, str],
) -> bool:
    """Return whether names say that two variables are of different pairs, as u10 and v100 are."""
    firsts = {second: first for first, second in partners.items()}
    present = {_text(array, "name") for array in arrays}
    u_name = _text(u, "name")
    v_name = _text(v, "name")
    partners_of_u = _name_partners(u_name, partners)
    if v_name in partners_of_u:
        return False
    partners_of_v = _name_partners(v_name, firsts)
    if (partners_of_u | partners_of_v) & present:
        return True
    # Without a number in its name, u may be a partner of any v.
    u_stem = re.sub(r"\d+", "", u_name)
    v_stem = re.sub(r"\d+", "", v_name)
    return u_name != u_stem and v_stem in _name_partners(u_stem, partners)


def are_partners(u: str, v: str) -> bool:
    """Return whether two names are those of horizontal components, such as UVEL and VVEL."""
    return v.lower() in _name_partners(u.lower(), PARTNERS)


def _name_partners(name: str, partners: Mapping[str, str]) -> set[str]:
    return {partner for _, _, partner in _partners(name, "name", partners)}


def _rank(u: xr.DataArray, source: str, rest: str) -> int | None:
    """Return the rank of a pair, 0 for the most likely velocity; ``None`` for other variables."""
    if any(SPREAD.search(_text(u, name)) for name in NAMES):
        return None
    is_velocity = _is_velocity(u)
    if is_velocity is False:
        if source == "standard_name":
            return 6
        return None
    text = _text(u, source)
    if source != "name":
        plain = re.sub(r"^x_|_*(eastward|zonal)_*", "_", text).strip("_")
        if plain in MAIN:
            return 0
        if MOVING.search(text):
            return 1
        if is_velocity:
            return 4
        return None
    bare = BARE.match(rest) is not None or WITH_LETTER.match(text) is not None
    is_place = text in ("x", "y", "z")
    if not is_velocity and (is_place or not bare):
        return None
    if not rest and bare:
        return 2
    if bare:
        return 3
    return 5


def _directions(u: xr.DataArray) -> str:
    """Return ``"grid"`` or ``"earth"`` where attributes or names give directions, else ``""``."""
    relative = relative_to_grid(u)
    if relative is not None:
        if relative:
            return "grid"
        return "earth"
    described = " ".join(str(u.attrs.get(name, "")) for name in ("description", "long_name"))
    if TO_EARTH.search(described):
        return "earth"
    if TO_GRID.search(described):
        return "grid"
    for source in NAMES:
        words = _text(u, source).split("_")
        if "grid" in words or ("x" in words and source != "name"):
            return "grid"
        if any(word in words for word in EARTH):
            return "earth"
    return ""


def relative_to_grid(array: xr.DataArray) -> bool | None:
    """Return whether GRIB says that components are along the grid; ``None`` if it says nothing.

    The key of ecCodes is missing on polar grids, whose flags have it as a bit.
    """
    relative = array.attrs.get("GRIB_uvRelativeToGrid")
    if relative is not None:
        return bool(int(relative))
    flags = str(array.attrs.get(f"GRIB_{GRIB_FLAGS}", ""))
    if flags.isdecimal():
        return bool(int(flags) & ALONG_GRID)
    return None


def variable(datasets: Sequence[xr.Dataset], name: str) -> xr.DataArray:
    """Return a variable by its name, from the first of several datasets that has it.

    Raises
    ------
    FieldError
        When none has it.
    """
    for ds in datasets:
        if name in ds.data_vars:
            return ds[name]
    names = ", ".join(str(n) for ds in datasets for n, a in ds.data_vars.items() if a.ndim >= 2)
    raise FieldError(
        f"the variable {name!r} does not exist; expected one of {names or 'none with two axes'}"
    )


def _no_pair(datasets: Sequence[xr.Dataset]) -> str:
    """Return the text of the error for datasets without two components of a velocity."""
    arrays = [a for ds in datasets for a in ds.data_vars.values() if _may_be_component(a)]
    numbered = _numbered(arrays)
    if numbered:
        return (
            f"the components {', '.join(numbered)} have numbers, which do not tell along which "
            f'axes they are; name the two on the surface, as in vectors="{",".join(numbered[:2])}"'
        )
    for u, source in product(arrays, NAMES):
        text = _text(u, source)
        for _, rest, wanted in (*_partners(text, source), *_partners(text, source, FIRST_OF)):
            if _rank(u, source, rest) not in (None, 5, 6):
                other = next((a for a in arrays if _text(a, source) == wanted), None)
                if other is not None:
                    return _of_other_units(u, other, text, source)
                return (
                    f"the data have one component of a velocity, {u.name!r}, but not the other "
                    f"one, whose {source.replace('_', ' ')} would be {wanted!r}; open the file "
                    "that has it together with this one, or name both, as in u=..., v=..."
                )
    listed = ", ".join(f"{a.name} ({a.attrs.get('units', 'no unit')})" for a in arrays)
    if not listed:
        return (
            "no variable has two axes; expected the two components of a velocity on a surface, or "
            "coordinates such as lon and lat along the one axis of points or cells"
        )
    return (
        "no two variables are recognised as the components of a velocity, in a unit such as m/s; "
        f"the variables are {listed}. Name the components, as in u=..., v=...{_with_angle(arrays)}"
    )


def _of_other_units(u: xr.DataArray, other: xr.DataArray, text: str, source: str) -> str:
    """Return the text of the error for partners of which the other one has no unit of velocity."""
    names = [str(u.name), str(other.name)]
    if _text(other, source) not in {partner for _, _, partner in _partners(text, source)}:
        names.reverse()
    return (
        f"{names[0]} and {names[1]} are named like the components of a velocity, but the unit of "
        f"{other.name} is {str(other.attrs.get('units', ''))!r}; expected one such as m/s. If it "
        f'is wrong, use u="{names[0]}", v="{names[1]}", velocity_unit="m/s"'
    )


def _numbered(arrays: Sequence[xr.DataArray]) -> list[str]:
    """Return the names of the components of the first velocity that differ in a number."""
    names: dict[str, list[str]] = {}
    for array in arrays:
        name = str(array.name)
        match = NUMBERED.match(name)
        if match and is_velocity(name, str(array.attrs.get("units", ""))):
            names.setdefault(match[1], []).append(name)
    return next((sorted(alike) for alike in names.values() if len(alike) > 1), [])


def _with_angle(arrays: Sequence[xr.DataArray]) -> str:
    """Return the arguments for a speed and its direction, if a variable may be one."""
    lengths = []
    turns = []
    for array in arrays:
        if not _is_angle(array):
            lengths.append(array.name)
        elif not ON_EARTH.match(str(array.attrs.get("units", ""))):
            turns.append(array.name)
    if not lengths or not turns:
        return ""
    return f', or a speed and its direction, as in vectors="{lengths[0]}", direction="{turns[0]}"'
