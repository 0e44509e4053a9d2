"""Field, settings and appearance of a scene as attributes of what shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flowtex._util.arguments import near_names
from flowtex.field import FlowField
from flowtex.scene.options import Appearance, option_text
from flowtex.settings import TABLE, Settings

#: What of the appearance is an attribute; the image is changed by a method.
LIVE = tuple(name for name in Appearance.__dataclass_fields__ if name != "image")


def _attribute(name: str) -> Any:
    def get(self: AppearanceAttributes) -> Any:
        return getattr(self.scene.appearance, name)

    def change(self: AppearanceAttributes, value: Any) -> None:
        self.scene.appearance = self.scene.appearance.changed(**{name: value})

    return property(get, change, doc=option_text(Appearance, name))


class AppearanceAttributes:
    """The field, settings and appearance of a scene as attributes of what shows it.

    Each of the appearance is to be set at any time; ``{appearance}`` in the docstring of a class
    becomes their names.

    Once it is made, other attributes cannot be set, so that a slip of the pen is not a silent one.
    """

    scene: Any
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
        """Set an attribute that there is; the error for another one names those that are near."""
        is_known = name.startswith("_") or hasattr(type(self), name) or name in vars(self)
        if self._is_made and not is_known:
            own = [n for n in dir(type(self)) if not n.startswith("_")]
            of_settings = f"it is a setting: use settings.{name}"
            hint = of_settings if name in TABLE else near_names(name, own)
            msg = f"{type(self).__name__} has no attribute {name!r}; {hint}"
            raise AttributeError(msg)
        super().__setattr__(name, value)


for _name in LIVE:
    setattr(AppearanceAttributes, _name, _attribute(_name))
