"""Traits of the widget: one for each row of the table of settings, and those of the view."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import traitlets

from flowtex.errors import FieldError
from flowtex.rendering.camera import Camera, CameraValues
from flowtex.settings import TABLE, Setting, SettingsError

__all__ = ["CameraTrait", "SettingTrait", "SettingTraits", "SizeTrait", "TraitValueError"]


class TraitValueError(SettingsError, traitlets.TraitError):
    """A value is refused; traitlets restores the old one after its own errors alone."""


class SettingTrait(traitlets.TraitType[Any, Any]):
    """A setting, checked by its row of the table."""

    def __init__(self, row: Setting) -> None:
        self.row = row
        super().__init__(row.default, help=row.text)

    def validate(self, obj: traitlets.HasTraits | None, value: Any) -> Any:
        """Return the value in the setting's own type; raise SettingsError if it is invalid."""
        return self.row.check(value)


class CameraTrait(traitlets.TraitType[CameraValues, Any]):
    """A camera's attributes by name; missing ones keep their values."""

    def validate(self, obj: traitlets.HasTraits | None, value: Any) -> CameraValues:
        """Return the complete camera as plain numbers; raise CameraError if it is invalid."""
        present = getattr(obj, "_trait_values", {}).get(self.name)
        if isinstance(value, Camera):
            return value.to_dict()
        return Camera.from_dict(value, Camera(**present) if present else None).to_dict()


class SizeTrait(traitlets.TraitType[list[int], Any]):
    """Width and height in pixels of the page; a width of 0 fills the cell."""

    def validate(self, obj: traitlets.HasTraits | None, value: Any) -> list[int]:
        """Return both as a list."""
        try:
            width, height = (int(n) for n in value)
        except (TypeError, ValueError):
            width, height = -1, 0
        if not (0 <= width <= 16384 and 1 <= height <= 16384):
            msg = f"size is {value!r}; expected (width, height) in pixels, or (0, height)"
            raise FieldError(msg)
        return [width, height]


if TYPE_CHECKING:

    class SettingTraits(traitlets.HasTraits):
        """One trait for each setting."""
else:
    SettingTraits = type(
        "SettingTraits",
        (traitlets.HasTraits,),
        {
            "__module__": __name__,
            "__doc__": "One trait for each setting.",
            **{name: SettingTrait(row).tag(sync=True) for name, row in TABLE.items()},
        },
    )
