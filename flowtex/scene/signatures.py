"""Option classes as arguments in signatures and docstrings, and as attributes of objects."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterable
from dataclasses import Field, fields
from typing import TYPE_CHECKING, Any, TypeVar

from flowtex._util.arguments import near_names
from flowtex.field import FlowField
from flowtex.scene.options import Appearance
from flowtex.settings import TABLE, Settings

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


#: Fields of the appearance that are attributes; a method changes the image.
LIVE = tuple(name for name in Appearance.__dataclass_fields__ if name != "image")


def _attribute(name: str) -> property:
    def get(self: AppearanceAttributes) -> Any:
        return getattr(self.scene.appearance, name)

    def change(self: AppearanceAttributes, value: Any) -> None:
        if name == "clim":
            self.scene.fit_range()
        self.scene.appearance = self.scene.appearance.changed(**{name: value})

    return property(get, change, doc=Appearance.__dataclass_fields__[name].metadata["text"])


class AppearanceAttributes:
    """Base of objects that show a scene: its field, settings and appearance as attributes.

    Those of the appearance can be set at any time; ``{appearance}`` in the docstring of a class
    becomes their names. An object that is made takes no other attributes, so that a misspelt name
    raises an error.
    """

    scene: Any  #: A Scene; an attribute or a property of the class.
    _is_made = False

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        cls.__doc__ = (cls.__doc__ or "").replace("{appearance}", ", ".join(LIVE))

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...

    @property
    def field(self) -> FlowField:
        """The flow."""
        field: FlowField = self.scene.field
        return field

    @property
    def settings(self) -> Settings:
        """Every setting, live."""
        settings: Settings = self.scene.settings
        return settings

    def __setattr__(self, name: str, value: Any) -> None:
        """Set an existing attribute; the error for another one names similar ones."""
        is_known = name.startswith("_") or hasattr(type(self), name) or name in vars(self)
        if self._is_made and not is_known:
            names = [n for n in dir(type(self)) if not n.startswith("_")]
            setting_hint = f"it is a setting: use settings.{name}"
            hint = setting_hint if name in TABLE else near_names(name, names)
            raise AttributeError(f"{type(self).__name__} has no attribute {name!r}; {hint}")
        super().__setattr__(name, value)


for _name in LIVE:
    setattr(AppearanceAttributes, _name, _attribute(_name))
