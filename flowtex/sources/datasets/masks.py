"""Which values are no data: valid ranges, fill values, also undeclared ones, masks and flags."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flowtex._util.arguments import near_names
from flowtex._util.array_types import AnyArray, Bools, Floats
from flowtex.errors import FieldError
from flowtex.remedies import Remedy

if TYPE_CHECKING:
    import xarray as xr

#: The argument that draws the values that masks hide.
DRAW_ALL = Remedy("mask", value=False, aim="to draw these values too,")
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
    reverse: bool = False  #: Whether the opposite marks no data.
    #: Whether values there may be data nevertheless, as winds are on land.
    is_land: bool = False
    is_flag: bool = False  #: Whether it is a flag of the quality of values.
    #: Bits of integers that belong to each value of ``bad``; empty where values are compared whole.
    bits: tuple[int, ...] = ()

    def is_data(self, values: AnyArray) -> Bools:
        """Return where values of the variable mark data."""
        if self.bits:
            is_data = ~self._has_bits(values)
        elif self.bad:
            is_data = ~np.isin(values, self.bad)
        else:
            is_data = np.asarray(values > 0.5)
        if self.reverse:
            return ~is_data
        return is_data

    def _has_bits(self, values: AnyArray) -> Bools:
        numbers = np.nan_to_num(values).astype(np.int64)
        found = np.zeros(numbers.shape, dtype=bool)
        for bit, value in zip(self.bits, self.bad, strict=True):
            found |= (numbers & bit) == int(value)
        return found


class Flags(NamedTuple):
    """The meanings of a flag: values, and the bits of each that are compared, if not all."""

    values: dict[str, float]
    bits: dict[str, int]

    @classmethod
    def of(cls, array: xr.DataArray) -> Flags:
        """Return the flags that the attributes of CF declare."""
        meanings = str(array.attrs.get("flag_meanings", "")).split()
        bits = [int(bit) for bit in declared_numbers(array, "flag_masks")]
        values = (
            declared_numbers(array, "flag_values") or bits or list(map(float, range(len(meanings))))
        )
        return cls(
            dict(zip(meanings, values, strict=False)), dict(zip(meanings, bits, strict=False))
        )

    def mask(self, array: xr.DataArray, words: Iterable[str], **kind: bool) -> Mask | None:
        """Return the mask of values with one of some meanings; ``None`` without any."""
        words = list(words)
        if not words:
            return None
        text = f"{array.name} is {' or '.join(words)}"
        bad = tuple(float(self.values[word]) for word in words)
        bits = tuple(self.bits[word] for word in words if word in self.bits)
        return Mask(array, text, bad, bits=bits, **kind)


def find_masks(
    velocity: Sequence[xr.DataArray], datasets: Sequence[xr.Dataset], wanted: Any
) -> Iterator[Mask]:
    """Yield the masks of a velocity.

    Parameters
    ----------
    velocity
        Its components.
    datasets
        Datasets that may contain masks.
    wanted
        Name of the only mask; ``None`` for all that are recognised, ``False`` for none.

    Raises
    ------
    FieldError
        When no variable has the wanted name.
    """
    if wanted is False:
        return
    beside = {
        name for a in velocity for name in str(a.attrs.get("ancillary_variables", "")).split()
    }
    named = {str(name): ds[name] for ds in reversed(datasets) for name in ds.variables}
    named = {name: a for name, a in named.items() if a.ndim and a.dtype.kind in "fiub"}
    if wanted is not None and wanted not in named:
        own = {str(array.name) for array in velocity}
        others = [name for name, array in named.items() if array.ndim > 1 and name not in own]
        words = "the data have no other variables"
        if others:
            words = near_names(str(wanted), others)
        if not words.endswith("?"):
            words = f"{words}."
        raise FieldError(f"mask is {wanted!r}; {words} To draw all values, use mask=False")
    for name, array in named.items():
        if wanted in (None, name):
            mask = _mask(array, name, is_flag=name in beside, is_wanted=wanted is not None)
            if mask is not None:
                yield mask


def _mask(array: xr.DataArray, name: str, *, is_flag: bool, is_wanted: bool) -> Mask | None:
    standard = str(array.attrs.get("standard_name", ""))
    flags = Flags.of(array)
    is_flag = is_flag or standard.endswith(("status_flag", "quality_flag"))
    bad = flags.mask(array, filter(BAD_WORDS.search, flags.values), is_flag=True)
    if is_flag and bad is not None:
        return bad
    if name in WET:
        return Mask(array, f"{name} == {1 - WET[name]}", bad=(1.0 - WET[name],))
    is_mask = standard in STANDARD or SEA.match(name) or LAND.match(name) or is_wanted
    if not is_mask and not is_flag:
        return None
    land = [word for word in flags.values if LAND_WORDS.search(word)]
    if land or any(map(SEA_WORDS.search, flags.values)):
        land = land or [word for word in flags.values if not SEA_WORDS.search(word)]
        return flags.mask(array, land, is_land=True)
    if not is_mask:
        return None
    if name.lower() == "xland":
        return Mask(array, f"{name} == 1", bad=(1.0,), is_land=True)
    if STANDARD.get(standard, not LAND.match(name)):
        return Mask(array, f"{name} == 0", is_land=standard in STANDARD)
    return Mask(array, f"{name} == 1", reverse=True, is_land=True)


def moves_over_land(array: xr.DataArray) -> bool:
    """Return whether a velocity is the velocity of air, by its names."""
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


def declared_numbers(array: xr.DataArray, name: str) -> list[float]:
    """Return the numbers of an attribute, which may be text or a list; empty without it.

    Raises
    ------
    FieldError
        When the attribute contains anything but numbers.
    """
    given = array.attrs.get(name)
    if given is None:
        return []
    if isinstance(given, str):
        given = re.sub(r"[\[\](),;]|(?<=[\d.])[bsfd]\b", " ", given).split()
    try:
        return [float(number) for number in np.ravel(given)]
    except (TypeError, ValueError) as error:
        raise FieldError(
            f"{array.name} has {name} {array.attrs[name]!r}; expected numbers. Set or delete it, "
            f"as in del ds[{str(array.name)!r}].attrs[{name!r}]"
        ) from error


def valid_range(array: xr.DataArray) -> tuple[float, float] | None:
    """Return the least and greatest valid value of a variable that xarray has unpacked.

    Raises
    ------
    FieldError
        When the attributes are no numbers, or not as many as expected.
    """
    encoding = array.encoding
    low = -np.inf
    high = np.inf
    whole = True
    for name, number in (("valid_range", 2), ("valid_min", 1), ("valid_max", 1)):
        numbers = declared_numbers(array, name)
        if not numbers:
            continue
        if len(numbers) != number:
            raise FieldError(
                f"{array.name} has {name} {array.attrs[name]!r}; expected {number} numbers. Set or "
                f"delete it, as in del ds[{str(array.name)!r}].attrs[{name!r}]"
            )
        if name != "valid_max":
            low = numbers[0]
        if name != "valid_min":
            high = numbers[-1]
        whole = whole and np.asarray(array.attrs[name]).dtype.kind in "iu"
    if not (np.isfinite(low) or np.isfinite(high)):
        return None
    ends = [low, high]
    packed = np.dtype(encoding.get("dtype", float)).kind in "iu"
    if packed and whole:
        # The range is in the unit of the packed numbers if it has their type.
        scale = encoding.get("scale_factor", 1.0)
        offset = encoding.get("add_offset", 0.0)
        ends = sorted(float(scale) * end + float(offset) for end in ends)
    rounding = 1e-6 * max(abs(end) for end in ends if np.isfinite(end))
    return ends[0] - rounding, ends[1] + rounding


#: Values that programs write for missing data, in single precision: repeated digits, ends of the
#: ranges of integers, and 1e10.
_USUAL = re.compile(
    r"-99\.[09]+|-?9{3,}\.[09]+|-(7{3,}|8{3,})\.[078]+|-?3276[78]\.0|65535\.0"
    r"|-?2147483600\.0|-?10000000000\.0"
)
#: From this magnitude on, above the speed of light in cm/s, any value may stand for missing data.
#: Below it an inlet or a moving wall may look the same.
_HUGE = 1e11
#: Least distance of such a value from the others, as a multiple of their extent.
_HUGE_RATIO = 1e3
#: Least distance of a usual fill value from the others, as a multiple of their extent.
_USUAL_RATIO = 0.5
#: The same for a value that occurs a few times only.
_FEW_RATIO = 100.0
#: Least number of other values that tell such a one.
_FEWEST_OTHERS = 30
#: Number of times from which on a fill value is not rare.
_FEW = 10
#: Least share of fill values in small arrays.
_SHARE = 0.01


def undeclared_fills(values: Floats, known: tuple[float, ...] = ()) -> tuple[float, ...]:
    """Return all values of an array that stand for missing data, beside known ones."""
    rest = values[~np.isin(values, known)]
    fills: list[float] = []
    while (found := undeclared_fill(rest)) is not None:
        fills.append(found)
        rest = rest[rest != found]
    return tuple(fills)


def undeclared_fill(values: Floats) -> float | None:
    """Return the value of an array that stands for missing data, or ``None``.

    It is the least or the greatest value, repeats exactly, and lies far outside the others: further
    from them than half their extent, zero included, or much further if it is rare. There may be
    another one once it is masked.
    """
    finite = np.ravel(values)
    if not finite.size:
        return None
    least = float(finite.min())
    most = float(finite.max())
    if not np.isfinite(least + most):
        finite = finite[np.isfinite(finite)]
        least = float(finite.min(initial=0.0))
        most = float(finite.max(initial=0.0))
    for value in sorted({least, most}, key=abs, reverse=True):
        is_huge = abs(value) >= _HUGE
        # Versions of NumPy differ in when `str` writes an exponent.
        digits = np.format_float_positional(np.float32(value), trim="0")
        if not (is_huge or _USUAL.fullmatch(digits)):
            continue
        same = finite == value
        count = int(np.count_nonzero(same))
        rest = finite[~same]
        is_rare = count < max(2, min(_FEW, _SHARE * finite.size))
        if not rest.size or (is_rare and rest.size < _FEWEST_OTHERS):
            continue
        low = min(float(rest.min()), 0.0)
        high = max(float(rest.max()), 0.0)
        distance = max(low - value, value - high)
        ratio = _USUAL_RATIO
        if is_huge:
            ratio = _HUGE_RATIO
        if is_rare:
            ratio = max(ratio, _FEW_RATIO)
        if distance > (high - low) * ratio:
            return value
    return None
