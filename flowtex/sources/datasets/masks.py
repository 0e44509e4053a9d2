"""Which values are no data: valid ranges, fill values, also undeclared ones, masks and flags."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import near_names
from flowtex._util.array_types import AnyArray, Bools, Floats
from flowtex.errors import FieldError

if TYPE_CHECKING:
    import xarray as xr

#: Names of masks that are 1 where there is water, and of those that are 1 on land.
SEA = re.compile(r"^(mask|mask_?(rho|t|c)|tmask\w*|wet|wet_c|sea_?mask|ocean_?mask)$", re.I)
LAND = re.compile(r"^(lsm|land|land_?mask|land_sea_mask|mask_?land|xland)$", re.I)
#: Masks of nodes and faces of meshes, and their value under water.
WET = {
    **dict.fromkeys(("wet_nodes", "wet_cells"), 1),
    **dict.fromkeys(("wetdry_node", "wetdry_elem", "dryFlagNode", "dryFlagElement"), 0),
}
#: Standard names of masks, and whether they are positive in the sea.
STANDARD = {
    "land_binary_mask": False,
    "land_area_fraction": False,
    "sea_binary_mask": True,
    "sea_area_fraction": True,
}
#: Meanings of flags that are land, water, and bad values.
LAND_WORDS = re.compile(r"land|continent|dry", re.I)
SEA_WORDS = re.compile(r"sea|ocean|water|wet", re.I)
BAD_WORDS = re.compile(r"bad|fail|missing|invalid|reject|error|interference|no_data", re.I)
#: Names of air that moves over land as well.
OVER_LAND = re.compile(r"wind|air|atmos|^[uv]a?s?$|^[uv]_?10|10_?m|^uu$|^[uv]100", re.I)
#: Share of the values on land that are the same, from which on these are no data.
SAME_ON_LAND = 0.95


@dataclass(frozen=True, eq=False)
class Mask:
    """A variable that marks values as data, and when it does."""

    array: xr.DataArray
    text: str  #: The condition for values that are no data, such as ``"lsm == 1"``.
    bad: tuple[float, ...] = ()  #: Values that mark no data; without any, those up to a half.
    reverse: bool = False  #: Whether values above a half mark no data.
    #: Whether values there may be data nevertheless, as winds are on land.
    is_land: bool = False
    is_flag: bool = False  #: Whether it is a flag of the quality of values.

    def is_data(self, values: AnyArray) -> Bools:
        """Return where values of the variable mark data."""
        if self.bad:
            return ~np.isin(values, self.bad)
        return np.asarray(~(values > 0.5) if self.reverse else values > 0.5)


def find_masks(
    velocity: Sequence[xr.DataArray], datasets: Sequence[xr.Dataset], wanted: Any
) -> Iterator[Mask]:
    """Yield the masks of a velocity, or the one of a name; ``False`` wants none."""
    if wanted is False:
        return
    beside = {
        name for a in velocity for name in str(a.attrs.get("ancillary_variables", "")).split()
    }
    named = {str(name): ds[name] for ds in reversed(datasets) for name in ds.variables}
    named = {name: a for name, a in named.items() if a.ndim and a.dtype.kind in "fiub"}
    if wanted is not None and wanted not in named:
        words = near_names(str(wanted), named)
        raise FieldError(f"mask is {wanted!r}; {words} (False draws all values)")
    for name, array in named.items():
        if wanted in (None, name):
            mask = _mask(array, name, is_flag=name in beside, is_wanted=wanted is not None)
            if mask is not None:
                yield mask


def _mask(array: xr.DataArray, name: str, *, is_flag: bool, is_wanted: bool) -> Mask | None:
    standard = str(array.attrs.get("standard_name", ""))
    meanings = str(array.attrs.get("flag_meanings", "")).split()
    values = np.atleast_1d(array.attrs.get("flag_values", range(len(meanings)))).tolist()
    flags = dict(zip(meanings, values, strict=False))
    if is_flag or standard.endswith(("status_flag", "quality_flag")):
        bad = {word: float(flag) for word, flag in flags.items() if BAD_WORDS.search(word)}
        text = f"{name} is {' or '.join(bad)}"
        return Mask(array, text, tuple(bad.values()), is_flag=True) if bad else None
    if name in WET:
        return Mask(array, f"{name} == {1 - WET[name]}", bad=(1.0 - WET[name],))
    if not (standard in STANDARD or SEA.match(name) or LAND.match(name) or is_wanted):
        return None
    land = [word for word in flags if LAND_WORDS.search(word)]
    if land or any(map(SEA_WORDS.search, flags)):
        land = land or [word for word in flags if not SEA_WORDS.search(word)]
        values = tuple(float(flags[word]) for word in land)
        text = f"{name} is {' or '.join(land)}"
        return Mask(array, text, values, is_land=True) if land else None
    if name.lower() == "xland":
        return Mask(array, f"{name} == 1", bad=(1.0,), is_land=True)
    if STANDARD.get(standard, not LAND.match(name)):
        return Mask(array, f"{name} == 0", is_land=standard in STANDARD)
    return Mask(array, f"{name} == 1", reverse=True, is_land=True)


def moves_over_land(array: xr.DataArray) -> bool:
    """Return whether a velocity is that of air, by its names."""
    words = str(array.attrs.get("standard_name", "")) or str(array.attrs.get("long_name", ""))
    if "water" in words or "current" in words.lower():
        return False
    return OVER_LAND.search(words or str(array.name)) is not None


def is_constant(values: Floats) -> bool:
    """Return whether nearly all values are the same, or missing."""
    values = values[np.isfinite(values)]
    if not len(values):
        return True
    _, counts = np.unique(values, return_counts=True)
    return bool(counts.max() >= SAME_ON_LAND * len(values))


def valid_range(array: xr.DataArray) -> tuple[float, float] | None:
    """Return the least and greatest valid value of a variable that xarray has unpacked."""
    attrs, encoding = array.attrs, array.encoding
    low, high = np.atleast_1d(attrs.get("valid_range", (-np.inf, np.inf)))[:2]
    low, high = attrs.get("valid_min", low), attrs.get("valid_max", high)
    if not (np.isfinite(float(low)) or np.isfinite(float(high))):
        return None
    ends = [float(low), float(high)]
    packed = np.dtype(encoding.get("dtype", float)).kind in "iu"
    whole = all(np.asarray(end).dtype.kind in "iu" for end in (low, high) if np.isfinite(end))
    if packed and whole:
        # The range is in the unit of the packed numbers if it has their type.
        scale, offset = encoding.get("scale_factor", 1.0), encoding.get("add_offset", 0.0)
        ends = sorted(float(scale) * end + float(offset) for end in ends)
    rounding = 1e-6 * max(abs(end) for end in ends if np.isfinite(end))
    return ends[0] - rounding, ends[1] + rounding


#: Values that programs write for missing data, in single precision: repeated digits, ends of the
#: ranges of integers, and 1e10.
_USUAL = re.compile(
    r"-99\.[09]+|-?9{3,}\.[09]+|-(7{3,}|8{3,})\.[078]+|-?3276[78]\.0|65535\.0"
    r"|-?2\.1474836e\+09|-?1e\+10"
)
#: From this magnitude on, above the speed of light in cm/s, any value may stand for missing data.
#: Below it an inlet or a moving wall may look the same.
_HUGE = 1e11
#: Least distance of such a value from the others, as a multiple of their extent.
_HUGE_RATIO = 1e3
#: Least distance of a usual fill value from the others, as a multiple of their extent.
_USUAL_RATIO = 0.5
#: Least number of times that a fill value occurs.
_FEW = 10
#: Least share of fill values in small arrays.
_SHARE = 0.01


def undeclared_fill(values: Floats) -> float | None:
    """Return the value of an array that stands for missing data, or ``None``.

    It is the least or the greatest value, repeats exactly, and lies far outside the others: further
    from them than half their extent, zero included. There may be another one once it is masked.
    """
    finite = np.ravel(values)
    if not finite.size:
        return None
    least, most = float(finite.min()), float(finite.max())
    if not np.isfinite(least + most):
        finite = finite[np.isfinite(finite)]
        least, most = float(finite.min(initial=0.0)), float(finite.max(initial=0.0))
    for value in sorted({least, most}, key=abs, reverse=True):
        is_huge = abs(value) >= _HUGE
        if not (is_huge or _USUAL.fullmatch(str(np.float32(value)))):
            continue
        same = finite == value
        count = int(np.count_nonzero(same))
        rest = finite[~same]
        if not rest.size or count < max(2, min(_FEW, _SHARE * finite.size)):
            continue
        low, high = min(float(rest.min()), 0.0), max(float(rest.max()), 0.0)
        distance = max(low - value, value - high)
        if distance > (high - low) * (_HUGE_RATIO if is_huge else _USUAL_RATIO):
            return value
    return None
