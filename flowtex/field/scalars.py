"""The scalars of a field by name; an unknown name raises an error that says how to get it."""

from __future__ import annotations

from typing import NoReturn, TypeVar

from flowtex._util.arguments import near_names
from flowtex.errors import FieldError
from flowtex.field.derived.kinds import DERIVED, FOLLOWED

V = TypeVar("V")


class UnknownScalarError(FieldError, KeyError):
    """No scalar has this name."""

    def __str__(self) -> str:
        return str(self.args[0])  # a KeyError would quote it


class Scalars(dict[str, V]):
    """Scalars, or their values at a point, by name."""

    def __missing__(self, name: str) -> NoReturn:
        msg = f"the field has no scalar {name!r}; "
        if name in FOLLOWED:
            msg += f"add it: field = field.with_derived({name!r}, horizon=...)"
        elif name in DERIVED:
            msg += (
                f"add it: field = field.with_derived({name!r}); field.derive({name!r}) returns it"
            )
        elif name == "speed":
            msg += "field.speed has it at the nodes, and field.at(x, y).speed at a point"
        else:
            msg += near_names(str(name), self)
        raise UnknownScalarError(msg)
