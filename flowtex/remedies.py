"""Arguments by which users draw something else than was chosen, as text for each front end."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

#: Words before an argument, where none are given.
ANOTHER = "choose another, as in"
#: Words that need no quotes in a shell.
_BARE = re.compile(r"[\w.,:/+=-]+")
#: Characters that have a meaning within double quotes in a shell.
_SPECIAL = re.compile(r'["$`\\!]')


@dataclass(frozen=True)
class Remedy:
    """An argument, and the words before it that say what it is for."""

    name: str  #: Name of the argument in Python, such as ``"level"``.
    value: Any  #: A text, a number, a boolean, or values by name.
    aim: str = ANOTHER

    @property
    def in_python(self) -> str:
        """The argument as it is typed in Python, such as ``level="250 hPa"``."""
        return f"{self.name}={_literal(self.value)}"

    @property
    def in_shell(self) -> str:
        """The argument as it is typed in a shell, such as ``--level "250 hPa"``."""
        flag = f"--{self.name.replace('_', '-')}"
        if self.value is True:
            return flag
        if self.value is False:
            return f"{flag} none"
        if isinstance(self.value, Mapping):
            words = [_quoted(f"{key}={value}") for key, value in self.value.items()]
            return " ".join(f"{flag} {word}" for word in words)
        return f"{flag} {_quoted(str(self.value))}"

    def on_page(self, controls: Mapping[str, str]) -> str:
        """Return words for a page, whose ``controls`` have the names of arguments."""
        control = controls.get(self.name)
        if control is None:
            return f"{self.aim} {self.in_shell}"
        return f"choose another with the control {control}"

    def packed(self) -> list[Any]:
        """Return a value of JSON, from which ``Remedy(*packed)`` is this one again."""
        return [self.name, self.value, self.aim]


def sentence(text: str, remedies: Iterable[Remedy]) -> str:
    """Return a text and its remedies as they are typed in Python."""
    words = [f"{remedy.aim} {remedy.in_python}" for remedy in remedies]
    if not words:
        return text
    return f"{text}; {', '.join(words)}"


def for_shell(text: str, remedies: Iterable[Remedy]) -> str:
    """Return a text with its remedies as they are typed in a shell."""
    for remedy in remedies:
        text = text.replace(remedy.in_python, remedy.in_shell)
    return text


def for_page(text: str, remedies: Iterable[Remedy], controls: Mapping[str, str]) -> str:
    """Return a text with the controls of a page, by the names of arguments, as remedies."""
    for remedy in remedies:
        words = remedy.on_page(controls)
        typed = f"{remedy.aim} {remedy.in_python}"
        if words in text:
            # Two arguments may have one control.
            text = text.replace(f", {typed}", "")
        else:
            text = text.replace(typed, words)
    return text


def _literal(value: Any) -> str:
    if isinstance(value, bool):
        return str(value)
    return json.dumps(value, ensure_ascii=False)


def _quoted(word: str) -> str:
    """Return a word with quotes that all shells know, if it needs any."""
    if _BARE.fullmatch(word):
        return word
    if _SPECIAL.search(word):
        return shlex.quote(word)
    return f'"{word}"'
