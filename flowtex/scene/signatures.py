"""Option classes in the signatures and docstrings of functions, for ``help`` and editors."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterable
from dataclasses import Field, fields
from typing import Any, TypeVar

from flowtex._util.written import Form

#: Description of all other arguments in docstrings.
SETTINGS_TEXT = "Any setting of :class:`~flowtex.Settings`, such as ``samples=25``."

Function = TypeVar("Function", bound=Callable[..., Any])


def accepts_options(*kinds: type) -> Callable[[Function], Function]:
    """Show the fields of option classes as arguments of a function that takes ``**options``.

    The line ``{options}`` of its docstring becomes their description.
    """

    def complete(function: Function) -> Function:
        options = [f for kind in kinds for f in fields(kind)]
        signature = inspect.signature(function)
        parameters = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
        keyword = [
            inspect.Parameter(f.name, inspect.Parameter.KEYWORD_ONLY, default=f.default)
            for f in options
            if f.name not in signature.parameters
        ]
        settings = inspect.Parameter("settings", inspect.Parameter.VAR_KEYWORD, annotation=Any)
        complete_signature = signature.replace(parameters=[*parameters, *keyword, settings])
        function.__signature__ = complete_signature  # type: ignore[attr-defined]
        if function.__doc__:
            function.__doc__ = _described(function.__doc__, options)
        return function

    return complete


def option_text(kind: type, name: str) -> str:
    """Return the description of a field of an option class, as one paragraph."""
    return str(kind.__dataclass_fields__[name].metadata["text"])  # type: ignore[attr-defined]


def option_form(kind: type, name: str) -> Form:
    """Return how the values of a field of an option class are written."""
    form: Form = kind.__dataclass_fields__[name].metadata["form"]  # type: ignore[attr-defined]
    return form


def _described(text: str, options: Iterable[Field[Any]]) -> str:
    """Put the description of options into a docstring."""
    lines = []
    for line in text.splitlines():
        if line.strip() != "{options}":
            lines.append(line)
            continue
        indent = line[: line.index("{")]
        described = {option.name: option.metadata["text"] for option in options}
        if "**settings" not in text:
            described["**settings"] = SETTINGS_TEXT
        for name, words in described.items():
            lines.append(f"{indent}{name}")
            filled = textwrap.fill(words, 96 - len(indent), break_on_hyphens=False)
            lines.append(textwrap.indent(filled, indent + "    "))
    return "\n".join(lines)
