"""Values that stand for missing data without being declared, such as -999 or 1e20."""

from __future__ import annotations

import re

import numpy as np

from flowtex._util.array_types import Floats

#: Values that programs write for missing data, in single precision: repeated digits, ends of the
#: ranges of integers, and 1e10.
_USUAL = re.compile(
    r"-99\.[09]+|-?9{3,}\.[09]+|-(7{3,}|8{3,})\.[078]+|-?3276[78]\.0|65535\.0"
    r"|-?2\.1474836e\+09|-?1e\+10"
)
#: From this magnitude on, above the speed of light in cm/s, any value may stand for missing data,
#: if it exceeds the others by this factor. Below it an inlet or a moving wall may look the same.
_HUGE, _HUGE_RATIO, _USUAL_RATIO = 1e11, 1e3, 0.5
#: Least number of values, or share of all, that a repeated value has.
_FEW, _SHARE = 10, 0.01


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
