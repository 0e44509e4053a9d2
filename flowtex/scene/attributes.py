"""Field, settings and appearance of a scene as attributes of an object that shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flowtex._util.arguments import near_names
from flowtex.field import FlowField
from flowtex.scene.options import Appearance
from flowtex.scene.signatures import option_text
from flowtex.settings import TABLE, Settings

#: Fields of the appearance that are attributes; a method changes the image.
LIVE = tuple(name for name in Appearance.__dataclass_fields__ if name != "image")


def _attribute(name: str) -> property:
    def get(self: AppearanceAttributes) -> Any:
        return getattr(self.scene.appearance, name)

    def change(self: AppearanceAttributes, value: Any) -> None:
        if name == "clim":
            self.scene.fit_range()
        self.scene.appearance = self.scene.appearance.changed(**{name: value})

    return property(get, change, doc=option_text(Appearance, name))


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
