"""A panel of ipywidgets for the rows of the table of settings, joined to a widget's traits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import ipywidgets

from flowtex.settings import TABLE, Setting, SettingsError


def make_panel(widget: Any) -> tuple[Any, Callable[[], None]]:
    """Return a panel with a control for each setting, and a function that closes it.

    Controls and the widget's traits of the same names follow each other.
    """
    controls = [_control(row, getattr(widget, row.name)) for row in TABLE.values()]
    ends = [_join(widget, name, control) for name, control in zip(TABLE, controls, strict=True)]
    panel = ipywidgets.VBox(controls)

    def close() -> None:
        for end in ends:
            end()
        for child in controls:
            child.close()
        panel.close()

    return panel, close


def _control(row: Setting, value: Any) -> Any:
    options: dict[str, Any] = {
        "value": value,
        "description": row.label,
        "tooltip": row.text,
        "style": {"description_width": "9em"},
    }
    is_integer = row.kind is int
    if row.control == "checkbox":
        return ipywidgets.Checkbox(**options)
    if row.control == "choice":
        return ipywidgets.Dropdown(options=row.choices, **options)
    options |= {"min": row.low, "max": row.high}
    if row.control == "number":
        kind = ipywidgets.BoundedIntText if is_integer else ipywidgets.BoundedFloatText
        return kind(**options)
    if is_integer:
        return ipywidgets.IntSlider(continuous_update=True, **options)
    return ipywidgets.FloatSlider(step=row.step, readout_format=".2f", **options)


def _join(widget: Any, name: str, control: Any) -> Callable[[], None]:
    def to_widget(change: Any) -> None:
        try:
            setattr(widget, name, change["new"])
        except SettingsError:
            control.value = getattr(widget, name)

    def to_control(change: Any) -> None:
        control.value = change["new"]

    control.observe(to_widget, "value")
    widget.observe(to_control, name)

    def end() -> None:
        control.unobserve(to_widget, "value")
        widget.unobserve(to_control, name)

    return end
