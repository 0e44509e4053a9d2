"""Functions of a mesh that also take arrays one after the other, as ``plt.streamplot`` does."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, ParamSpec, Protocol, TypeVar, cast, overload

from numpy.typing import ArrayLike

from flowtex._util.host_arrays import is_array

P = ParamSpec("P")
Result = TypeVar("Result")
Returned = TypeVar("Returned", covariant=True)
Function = TypeVar("Function", bound=Callable[..., Any])


class TakesArrays(Protocol[P, Returned]):
    """A function with its own parameters, or with arrays in place of the mesh."""

    @overload
    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> Returned: ...
    @overload
    def __call__(
        self, first: Any, second: ArrayLike, /, *others: Any, **options: Any
    ) -> Returned: ...


def takes_arrays(
    first: int = 0,
) -> Callable[[Callable[P, Result]], TakesArrays[P, Result]]:
    """Return a decorator for functions that take arrays in place of their argument ``mesh``.

    The arrays become one argument, a tuple, which :func:`flowtex.scene.fields.read_field` reads.

    Parameters
    ----------
    first
        Position of ``mesh`` among the arguments, from 0.
    """
    decorate: Any = joins_arrays(first)
    return cast("Callable[[Callable[P, Result]], TakesArrays[P, Result]]", decorate)


def joins_arrays(first: int) -> Callable[[Function], Function]:
    """Return a decorator like :func:`takes_arrays`, for methods, which keep their declared type.

    Consecutive positional arguments from number ``first`` on that are arrays, two or more of them,
    reach the method as one tuple.
    """

    def decorate(function: Function) -> Function:
        @functools.wraps(function)
        def joined(*given: Any, **options: Any) -> Any:
            return function(*_joined(given, first), **options)

        return cast("Function", joined)

    return decorate


def _joined(given: tuple[Any, ...], first: int) -> tuple[Any, ...]:
    """Return positional arguments in which the arrays from number ``first`` on are one tuple."""
    stop = first
    while stop < len(given) and is_array(given[stop]):
        stop += 1
    if stop - first < 2:
        return given
    return (*given[:first], given[first:stop], *given[stop:])
