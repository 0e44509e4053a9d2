"""Reading and writing of values as text, in a shell or in a link."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from flowtex.errors import FieldError


class UnreadableError(FieldError):
    """A text that means no value; the error says what was expected."""


@dataclass(frozen=True)
class Form:
    """How the values of an argument are written."""

    words: str = ""  #: Help of a shell for the argument, where it differs from Python's.
    #: Returns the value of a text, or of all texts; an UnreadableError says what was expected.
    read: Callable[[Any], Any] = str
    write: Callable[[Any], str] = str  #: Returns the text of a value.
    repeated: bool = False  #: Whether the argument may be given several times.


def number_or_text(text: str) -> float | str:
    """Return a number where a text is one."""
    try:
        return float(text)
    except ValueError:
        return text


def numbers(*counts: int, expected: str) -> Callable[[str], tuple[float, ...]]:
    """Return a function that reads numbers with commas between them, in one of these counts."""

    def read(text: str) -> tuple[float, ...]:
        words = re.split(r"[,\s]+", text.strip())
        if len(words) not in counts:
            raise UnreadableError(expected)
        values = []
        for word in words:
            value = number_or_text(word)
            if not isinstance(value, float) or not math.isfinite(value):
                raise UnreadableError(expected)
            values.append(value)
        return tuple(values)

    return read


def or_none(value: Any = None) -> Callable[[str], Any]:
    """Return a function that reads any text, and ``none`` as ``value``."""

    def read(text: str) -> Any:
        if text == "none":
            return value
        return text

    return read


def named_texts(
    read: Callable[[str], Any], expected: str
) -> Callable[[Sequence[str]], dict[str, Any]]:
    """Return a function that reads texts such as ``name=value``, each value by ``read``."""

    def read_all(texts: Sequence[str]) -> dict[str, Any]:
        """Return the values by name."""
        values = {}
        for text in texts:
            name, _, value = text.partition("=")
            if not name or not value:
                raise UnreadableError(expected)
            try:
                values[name.strip()] = read(value)
            except ValueError:
                raise UnreadableError(expected) from None
        return values

    return read_all


def _read_switch(text: str) -> bool:
    if text not in ("on", "off"):
        raise UnreadableError("'on' or 'off'")
    return text == "on"


_read_number = numbers(1, expected="a number")
PLAIN = Form()  #: Text, unchanged.
#: A number.
NUMBER = Form(read=lambda text: _read_number(text)[0], write=lambda value: repr(float(value)))
#: A switch, on or off.
SWITCH = Form(read=_read_switch, write=lambda value: "on" if value else "off")
