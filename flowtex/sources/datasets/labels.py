"""Labels along axes: which of two axes are the same, as values or as times.

Labels are equal up to rounding. An axis may be reversed, or count longitude from another meridian.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy

from flowtex._util.array_types import AnyArray, Floats, Indices
from flowtex.errors import FieldError
from flowtex.field.dates import as_seconds

#: Share of the spacing up to which labels are equal.
SAME = 0.02
#: Share up to which labels in single precision are equal.
BLURRED = 0.2
#: Shares of the way between two labels that count as the middle.
MIDDLE = (0.4, 0.6)
#: Seconds up to which dates are equal.
SAME_DATE_S = 0.5


class Match(NamedTuple):
    """Numbers of the labels that two axes have in common, in the order of the first."""

    one: Indices
    other: Indices


def match(one: AnyArray, other: AnyArray, period: float | None = None) -> Match:
    """Return the labels that two axes, (N,) and (M,), have in common; each label counts once."""
    if one.dtype.kind not in "fiumMO" or other.dtype.kind not in "fiumMO":
        place = {value: n for n, value in reversed(list(enumerate(other.tolist())))}
        found = np.array([place.get(value, -1) for value in one.tolist()], dtype=np.intp)
        return Match(np.flatnonzero(found >= 0), found[found >= 0])
    a, b = numbers(one, other)
    dates = one.dtype.kind in "MO"
    if dates:
        near = min(SAME_DATE_S, BLURRED * spacing(a))
    else:
        near = tolerance(a, b)
    distance, nearest = _nearest(a, b, period)
    same = np.flatnonzero(distance <= near)
    _, first = np.unique(nearest[same], return_index=True)
    same = same[np.sort(first)]
    return Match(same, nearest[same])


def is_between(one: Floats, other: Floats, period: float | None = None) -> bool:
    """Return whether the labels of one axis are midway between the labels of another."""
    if min(len(one), len(other)) < 2:
        return False
    distance, _ = _nearest(one, other, period)
    share = distance / spacing(other)
    inside = share[share < 1.0]
    return len(inside) >= len(share) - 1 and bool(
        ((inside >= MIDDLE[0]) & (inside <= MIDDLE[1])).all()
    )


def numbers(one: AnyArray, other: AnyArray) -> tuple[Floats, Floats]:
    """Return two axes as numbers; dates and spans become seconds since the first label of one.

    Raises
    ------
    FieldError
        When the labels cannot be compared, such as dates of different calendars.
    """
    if one.dtype.kind not in "mMO" and other.dtype.kind not in "mMO":
        return one.astype(float), other.astype(float)
    try:
        joined, _, _ = as_seconds(np.concatenate([one, other]), "")
        seconds: Floats = np.ma.filled(np.ma.asarray(joined, dtype=float), np.nan)
    except (TypeError, ValueError) as error:
        raise FieldError(
            f"times {text(one)} and {text(other)} cannot be compared: {error}"
        ) from error
    return seconds[: len(one)], seconds[len(one) :]


def spacing(line: Floats) -> float:
    """Return the least distance of different labels; infinite for one."""
    steps = np.diff(np.unique(line[np.isfinite(line)]))
    if len(steps):
        return float(steps.min())
    return np.inf


def tolerance(a: Floats, b: Floats) -> float:
    """Return the difference up to which labels are equal."""
    size = max(float(np.abs(line[np.isfinite(line)]).max(initial=0.0)) for line in (a, b))
    apart = min(spacing(a), spacing(b))
    rounding = 4.0 * float(np.finfo(np.float32).eps) * size
    if np.isfinite(apart):
        return max(SAME * apart, min(rounding, BLURRED * apart))
    return rounding


def _nearest(a: Floats, b: Floats, period: float | None) -> tuple[Floats, Indices]:
    distance = np.full(len(a), np.inf)
    nearest = np.zeros(len(a), dtype=np.intp)
    known = np.flatnonzero(np.isfinite(b))
    sought = np.isfinite(a)
    if len(known):
        places = b[known][:, None]
        targets = a[sought][:, None]
        if period is not None:
            places = places % period % period
            targets = targets % period % period
        tree: Any = scipy.spatial.cKDTree(places, boxsize=period)  # type: ignore[arg-type]
        distance[sought], found = tree.query(targets)
        nearest[sought] = known[found]
    return distance, nearest


def text(line: Any) -> str:
    """Return an axis as text: its ends, its spacing and the number of labels."""
    line = np.asarray(line)
    if line.size == 0:
        return "no values"
    if line.dtype.kind == "M":
        words = np.datetime_as_string(line, unit="auto")
    else:
        words = line
    if line.size < 4:
        return ", ".join(_word(value) for value in words)
    by = ""
    if line.dtype.kind in "fiu":
        steps = np.diff(line.astype(float))
        even = np.allclose(steps, steps[0], rtol=1e-3, atol=0)
        if even:
            by = f" by {abs(steps.mean()):.4g}"
        else:
            by = ""
    return f"{_word(words[0])} to {_word(words[-1])}{by} ({line.size} values)"


def _word(value: Any) -> str:
    if isinstance(value, (float, np.floating)):
        return f"{value:.6g}"
    return str(value)
