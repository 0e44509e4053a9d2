"""Traits of the widget: one for each row of the table of settings, and those of the view."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import traitlets

from flowtex.settings import TABLE, Setting

__all__ = ["CameraTrait", "SettingTrait", "SettingTraits", "SizeTrait"]

POINTS, NUMBERS = ("position", "focal_point", "up"), ("parallel_scale", "view_angle")


class SettingTrait(traitlets.TraitType[Any, Any]):
    """A setting, checked by its row of the table."""

    def __init__(self, row: Setting) -> None:
        self.row = row
        super().__init__(row.default, help=row.text)

    def validate(self, obj: Any, value: Any) -> Any:
        """Return the value in the setting's own type; raise SettingsError where it is none."""
        return self.row.check(value)


class CameraTrait(traitlets.TraitType[Any, Any]):
    """A camera as the header of a scene has it; what is left out stays as it was."""

    def validate(self, obj: Any, value: Any) -> Any:
        """Return the whole camera as plain numbers.

        Raises
        ------
        TraitError
            When there is a name that no camera has, or a value that is not finite numbers.
        """
        known = (*POINTS, *NUMBERS, "parallel")
        if not isinstance(value, Mapping) or not set(value) <= set(known):
            msg = f"camera is {value!r}; expected a dict with some of {', '.join(known)}"
            raise traitlets.TraitError(msg)
        old = obj._trait_values.get(self.name) or {}
        made = {**old, **value}
        try:
            points = {name: _numbers(made[name], 3) for name in POINTS}
            scale, angle = _numbers([made[name] for name in NUMBERS], 2)
            parallel = bool(made["parallel"])
        except (KeyError, TypeError, ValueError) as error:
            msg = f"camera is {value!r}; expected points of three numbers, and positive numbers"
            raise traitlets.TraitError(msg) from error
        if not (scale > 0 and 0 < angle < 180):
            msg = f"camera is {value!r}; expected a positive scale and an angle below 180 degrees"
            raise traitlets.TraitError(msg)
        return {**points, "parallel": parallel, "parallel_scale": scale, "view_angle": angle}


class SizeTrait(traitlets.TraitType[Any, Any]):
    """Width and height in pixels of the page; a width of 0 fills the cell."""

    def validate(self, obj: Any, value: Any) -> list[int]:
        """Return both as a list."""
        try:
            width, height = (int(n) for n in value)
        except (TypeError, ValueError):
            width, height = -1, 0
        if not (0 <= width <= 16384 and 1 <= height <= 16384):
            msg = f"size is {value!r}; expected (width, height) in pixels, or (0, height)"
            raise traitlets.TraitError(msg)
        return [width, height]


def _numbers(values: Any, count: int) -> list[float]:
    numbers = np.asarray(values, dtype=float)
    if numbers.shape != (count,) or not np.isfinite(numbers).all():
        msg = "not finite numbers"
        raise ValueError(msg)
    return [float(n) for n in numbers]


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
