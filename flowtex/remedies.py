"""Arguments by which users draw something else, and corrections, as text for each front end.

Messages are written for Python. :func:`for_shell` writes their arguments as flags, and
:func:`error_for_page` as controls of a page where it has them. :func:`lines_for_shell` says where
the objects of their lines of Python come from.
"""

from __future__ import annotations

import ast
import json
import re
import shlex
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

#: Words before an argument, where none are given.
ANOTHER = "choose another, as in"
#: Arguments whose value ``False`` is the word ``none`` in a shell; others are switches.
_NONE = ("mask", "scalars")
#: Words that need no quotes in a shell.
_BARE = re.compile(r"[\w.,:/+=-]+")
#: Characters that have a meaning within double quotes in a shell.
_SPECIAL = re.compile(r'["$`\\!]')
#: An argument as it is typed in Python: its name, and a literal or dots.
_ARGUMENT = re.compile(
    r"""(?<![\w.'"=-])([a-z_]+)=("(?:[^"\\]|\\.)*"|'[^']*'|\{[^{}]*\}|\.\.\.|-?\d[\d.e+-]*(?<=\d)|"""
    r"""True\b|False\b)"""
)
#: A line of Python that opens a file and draws it, and the modules in it.
_LINE = re.compile(r'flowtex\.show\([a-z][\w.]*\("[^"]*"\)(?:\.\w+\(\))*\)')
_MODULE = re.compile(r"(?<![\w.])[a-z]\w*(?:\.[a-z]\w*(?=\.))*(?=\.\w+\()")
#: Names of objects in lines of Python, and how they are made of a file.
_OBJECTS = {
    "ds": "xarray.open_dataset({})",
    "df": "pandas.read_csv({})",
    "mesh": "pyvista.read({})",
}


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
        if self.value is False and self.name in _NONE:
            return f"{flag} none"
        if self.value is False:
            return f"--no-{flag.removeprefix('--')}"
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


def for_shell(text: str, names: Collection[str]) -> str:
    """Return a text whose arguments are typed as in a shell, as ``--u uo`` for ``u="uo"``.

    ``names`` are the arguments that have a flag. Those in calls of Python, and behind a whole line
    of Python, remain as they are.
    """
    parts = []
    end = 0
    for match in _typed_arguments(text, names):
        between = text[end : match.start()]
        if end and between == ", ":
            between = " "
        parts += [between, _flag(*match.groups())]
        end = match.end()
    return "".join([*parts, text[end:]])


def error_for_page(text: str, names: Collection[str], controls: Mapping[str, str]) -> str:
    """Return an error as a page shows it, with controls or flags in place of arguments.

    Parameters
    ----------
    text
        The error, written for Python.
    names
        Arguments that have a flag of ``flowtex show``.
    controls
        Names of the controls that the page has for arguments.
    """
    lines = lines_for_shell(text)
    for match in reversed(list(_typed_arguments(text, controls))):
        before = text[: match.start()]
        control = f"with the control {controls[match[1]]}"
        text = f"{before.removesuffix('as in ')}{control}{text[match.end() :]}"
    typed = for_shell(text, names)
    if typed != text:
        typed = f"{typed.rstrip('.')} (flags of flowtex show in a shell)"
    return ". ".join(filter(None, (typed, lines)))


def _typed_arguments(text: str, names: Collection[str]) -> Iterator[re.Match[str]]:
    """Yield the arguments in a text that are no part of a call or a line of Python."""
    line = _LINE.search(text)
    for match in _ARGUMENT.finditer(text):
        is_of_line = line is not None and match.start() > line.start()
        if match[1] in names and not is_of_line and not _is_in_call(text, match.start()):
            yield match


def lines_for_shell(text: str) -> str:
    """Return how a line of Python in an error is typed; empty without such lines.

    The error may start with the path of the file.
    """
    line = _LINE.search(text)
    if line:
        modules = ", ".join(dict.fromkeys(_MODULE.findall(line[0])))
        return f"In a shell: python -c {shlex.quote(f'import {modules}; {line[0]}')}"
    file = "FILE"
    named = re.match(r"(.+?\.\w+): ", text)
    if named:
        file = named[1]
    for name, made in _OBJECTS.items():
        if re.search(rf"(?<![\w.]){name}[.\[]", text):
            source = made.format(json.dumps(file, ensure_ascii=False))
            return f"In Python {name} is {source}, and flowtex.show({name}) draws it."
    return ""


def _flag(name: str, value: str) -> str:
    """Return the flag of an argument whose value is a literal of Python, or dots."""
    if value == "...":
        return f"--{name.replace('_', '-')} ..."
    return Remedy(name, ast.literal_eval(value)).in_shell


def _is_in_call(text: str, place: int) -> bool:
    """Return whether a place in a text is between the parentheses of a call."""
    depth = 0
    for number in range(place - 1, 0, -1):
        if text[number] == ")":
            depth += 1
        elif text[number] == "(" and depth:
            depth -= 1
        elif text[number] == "(":
            return text[number - 1].isidentifier()
    return False


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
