"""Nodal values of many time steps; each step is read when it is requested."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats
from flowtex._util.arrays import is_nonzero
from flowtex._util.cache import ByteCache

KEPT_BYTES = 256_000_000  #: Bytes of steps that stay in memory.
MOST_KEPT = 8  #: Most steps that stay in memory.
MOST_EXAMINED = 4_000_000  #: Most values of a series that are examined before it is drawn.
#: Most lazy steps that are read one after the other to find one that moves.
MOST_AT_REST = 16


class LazySteps:
    """An array (T, J, I, ...) that reads a step when it is indexed.

    It takes an index of NumPy's whose first part chooses steps: a number gives an array, a slice or
    a list of numbers another array of steps, read later. ``np.asarray`` reads all. ``read`` returns
    a step, (J, I, ...), by its number from 0, and may be called by several threads; ``kept`` bytes
    of steps stay in memory once they have been read, and as many of those that are made from them.
    Other steps than the first one are examined if that is ``quick``.
    A pickle has ``read``, and not the steps; a deep copy is the array itself, which never changes.
    """

    def __init__(
        self,
        count: int,
        read: Callable[[int], Floats],
        *,
        kept: int = KEPT_BYTES,
        quick: bool = False,
    ) -> None:
        self._count = count
        self._read = read
        self._most = kept
        self.quick = quick
        self._kept: ByteCache[int, Floats] = ByteCache(kept, max_count=MOST_KEPT)
        self._shape: tuple[int, ...] | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        make = partial(LazySteps, kept=self._most, quick=self.quick)
        return make, (self._count, self._read)

    def __deepcopy__(self, memo: Any) -> LazySteps:
        return self

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[Floats]:
        return map(self.step, range(self._count))

    def step(self, number: int) -> Floats:
        """Return one step, (J, I, ...).

        Raises
        ------
        IndexError
            When the step does not exist; negative numbers count from the end.
        """
        if not -self._count <= number < self._count:
            raise IndexError(f"step {number} does not exist: expected 0 to {self._count - 1}")
        number %= self._count
        return self._kept.get(number, lambda: self._read(number))

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the array; reads the first step."""
        if self._shape is None:
            self._shape = (self._count, *self.step(0).shape)
        return self._shape

    @property
    def ndim(self) -> int:
        """Number of axes."""
        return len(self.shape)

    @property
    def nbytes(self) -> int:
        """Bytes of the steps that are in memory."""
        return self._kept.nbytes

    def map(self, function: Callable[[Floats], Floats]) -> LazySteps:
        """Return steps that a function makes from these when they are read."""
        read = partial(self._mapped, function)
        return LazySteps(self._count, read, kept=self._most, quick=self.quick)

    def _mapped(self, function: Callable[[Floats], Floats], number: int) -> Floats:
        return function(self.step(number))

    def _picked(self, numbers: AnyArray, rest: Any, number: int) -> Floats:
        step = self.step(int(numbers[number]))
        if rest:
            return np.asarray(step[rest])
        return step

    def __getitem__(self, key: Any) -> Any:
        """Return a step, some steps that stay lazy, or an array for any other index of NumPy."""
        if isinstance(key, tuple):
            first = key[0]
            rest = key[1:]
        else:
            first = key
            rest = ()
        if isinstance(first, (int, np.integer)):
            if rest:
                return self.step(int(first))[rest]
            return self.step(int(first))
        numbers = np.arange(self._count)[first]
        if first is Ellipsis or numbers.ndim != 1:
            return np.asarray(self)[key]
        if isinstance(first, slice) and not rest and len(numbers) == self._count:
            return self
        read = partial(self._picked, numbers, rest)
        return LazySteps(len(numbers), read, kept=self._most, quick=self.quick)

    def __array__(self, dtype: Any = None, copy: Any = None) -> AnyArray:
        """Read all steps."""
        del copy
        result = np.empty(self.shape, dtype or float)
        for number, step in enumerate(self):
            result[number] = step
        return result


Steps: TypeAlias = Any  #: Nodal values at all time steps, (T, J, I, ...), in memory or read late.


class Nodes(NamedTuple):
    """Data of some nodes, as in a field; at one time step its velocity is (J, I, C)."""

    points: Floats
    valid: Bools
    velocity: Steps
    scalars: Mapping[str, Steps]
    has_position: Bools | None = None


def first_step(values: Any) -> Any:
    """Return the first step of lazy ones, and anything else as it is."""
    if isinstance(values, LazySteps):
        return values[0]
    return values


def typical_steps(count: int) -> list[int]:
    """Return steps that represent all of this many: the first, the middle and the last one."""
    return sorted({0, (count - 1) // 2, count - 1})


def examined_steps(count: int, size: int) -> list[int]:
    """Return steps with this many values each to examine: all of a small series, or at least three.

    The others are evenly spaced.
    """
    most = max(MOST_EXAMINED // max(size, 1), 3)
    if count <= most:
        return list(range(count))
    return list(map(round, np.linspace(0, count - 1, most).tolist()))


def moves(steps: Steps) -> bool:
    """Return whether a velocity moves at any step, or at a typical one of a late series."""
    count = len(steps)
    numbers: Sequence[int]
    if isinstance(steps, LazySteps):
        numbers = typical_steps(count)
    else:
        numbers = range(count)
    return any(is_nonzero(steps[number]) for number in numbers)


def first_moving(steps: Steps) -> int:
    """Return the first step at which something moves, 0 if none.

    Of lazy steps only some at the beginning are read, then typical ones.
    """
    count = len(steps)
    if count == 1:
        return 0
    numbers: Sequence[int] = range(count)
    if isinstance(steps, LazySteps):
        numbers = sorted({*range(min(count, MOST_AT_REST)), *typical_steps(count)})
    for number in numbers:
        if is_nonzero(steps[number]):
            return number
    return 0


def map_steps(steps: Steps, function: Callable[[Floats], Floats]) -> Steps:
    """Apply a function to each step (J, I, ...) of an array; lazy steps are mapped when read."""
    if isinstance(steps, LazySteps):
        return steps.map(function)
    if len(steps) == 1:
        only = function(steps[0])
        if not np.may_share_memory(only, steps):
            return only[None]
    return np.stack([function(step) for step in steps])


def scaled_steps(steps: Steps, scale: float) -> Steps:
    """Return steps times a factor."""
    if scale == 1.0:
        return steps
    if isinstance(steps, LazySteps):
        return steps.map(partial(np.multiply, scale))
    return steps * scale
