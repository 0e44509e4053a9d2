"""The table of forms: the data of each, and what a reader must make of them."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from flow_at_points import check_at
from known_flow import Truth, check

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.field.options import FieldOptions
from flowtex.scene.fields import read_field


@dataclass(frozen=True)
class Form:
    """A form in which people store a flow.

    ``make`` returns the data and the truth, or the data alone if no truth can be read. ``error``
    is a pattern of an error that is allowed, ``says`` one that the record of the reading must
    have, and ``never`` one that an error must not have.
    """

    make: Callable[..., Any]
    error: str = ""
    says: str = ""
    never: str = ""
    options: dict[str, Any] = field(default_factory=dict)
    arguments: tuple[Any, ...] = ()


#: All forms by name.
FORMS: dict[str, Form] = {}


def form(
    *, name: str = "", arguments: tuple[Any, ...] = (), error: str = "", **more: Any
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Register a function as a form; a truth must be read, unless ``error`` is allowed."""

    def register(make: Callable[..., Any]) -> Callable[..., Any]:
        key = make.__name__ + (f"_{name}" if name else "")
        assert key not in FORMS, key
        FORMS[key] = Form(make, error=error, arguments=arguments, **more)
        return make

    return register


def variants(names: Any, **more: Any) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Register a function with one argument once for each of its names."""

    def register(make: Callable[..., Any]) -> Callable[..., Any]:
        for name in names:
            text = re.sub(r"[^0-9A-Za-z]+", "_", re.sub("^-", "minus ", str(name)))
            form(name=text, arguments=(name,), **more)(make)
        return make

    return register


def read(data: Any, **options: Any) -> FlowField:
    """Read data as ``flowtex.render`` does, without its notices."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return read_field(data, FieldOptions.of(**options))


def data_of(one: Form, folder: Path) -> tuple[Any, Truth | None]:
    """Return the data and the truth of a form; some write files into a folder."""
    needed = "folder" in one.make.__code__.co_varnames[: one.make.__code__.co_argcount]
    made = one.make(*one.arguments, **({"folder": folder} if needed else {}))
    return made if isinstance(made, tuple) else (made, None)


def judge(one: Form, folder: Path) -> None:
    """Read a form, and compare the field, or the error, with what the form expects."""
    data, truth = data_of(one, folder)
    try:
        found = read(data, **one.options)
        if truth is not None:
            check(found, truth)
            check_at(found, truth)
    except FieldError as error:
        text = "\n".join([str(error), *getattr(error, "__notes__", ())])
        if not one.error:
            raise
        assert re.search(one.error, text, re.I | re.S), f"{one.error!r} is not in: {text}"
        assert not (one.never and re.search(one.never, text, re.I)), f"{one.never!r} is in: {text}"
        return
    assert truth is not None, f"drawn as {found!r}; expected an error with {one.error!r}"
    if one.says:
        text = str(found.reading)
        assert re.search(one.says, text, re.I | re.S), f"{one.says!r} is not in: {text}"
