"""Controls of a page, beside those that the view has itself."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from trame.widgets import html
from trame.widgets import vuetify3 as v3

#: Attributes that trame's widgets do not know by themselves.
ARIA = [
    ("aria_label", "aria-label"),
    ("aria_expanded", "aria-expanded"),
    ("data_hint", "data-hint"),
    ("data_side", "data-side"),
]
DATA = [*ARIA, ("data_setting", "data-setting")]


def row(name: str, text: str, **attributes: Any) -> Any:
    """Return a row of the panel, with a hint, to be filled."""
    return html.Div(
        data_setting=name,
        classes="flowtex-row",
        __properties=DATA,
        **hint(text, "start"),
        **attributes,
    )


def hint(text: str, side: str) -> dict[str, str]:
    """Return the attributes of a widget that says what it is for, when the pointer rests on it."""
    return {"data_hint": text, "data_side": side}


def _of(name: str, key: str) -> dict[str, Any]:
    """Return the attributes of every widget of Vuetify's that changes a value."""
    return {"v_model": (key,), "aria_label": name, "__properties": ARIA, "density": "compact"}


def select(name: str, key: str, items: Any, **attributes: Any) -> None:
    """Put a menu of choices into the row that is open."""
    html.Span(name, classes="flowtex-label")
    v3.VSelect(
        **_of(name, key),
        items=items,
        variant="plain",
        hide_details=True,
        menu_props=("{ contentClass: 'flowtex-list' }",),
        list_props=("{ density: 'compact' }",),
        classes="flowtex-select",
        **attributes,
    )


def switch(name: str, key: str) -> None:
    """Put a switch into the row that is open."""
    v3.VSwitch(
        **_of(name, key),
        color="primary",
        hide_details=True,
        inset=True,
        classes="flowtex-switch",
    )


def buttons(name: str, key: str, choices: Sequence[str]) -> None:
    """Put buttons of which one is pressed into the row that is open."""
    html.Span(name, classes="flowtex-label")
    with toggle(name, key):
        for choice in choices:
            v3.VBtn(choice, value=choice, size="small")


def toggle(name: str, key: str, **attributes: Any) -> Any:
    """Return a group of buttons of which one is pressed, to be filled."""
    return v3.VBtnToggle(
        **_of(name, key),
        mandatory=True,
        variant="text",
        color="primary",
        classes="flowtex-toggle",
        **attributes,
    )


def slider(name: str, key: str, low: Any, high: Any, step: Any, **attributes: Any) -> None:
    """Put a slider into the widget that is open."""
    v3.VSlider(
        **_of(name, key),
        min=low,
        max=high,
        step=step,
        color="primary",
        hide_details=True,
        thumb_size=14,
        track_size=3,
        **attributes,
    )


def number(
    name: str, key: str, low: float | None = None, high: float | None = None, *, whole: bool = False
) -> None:
    """Put a field to type a number in into the row that is open."""
    typed = "Number($event.target.value)"
    html.Input(
        type="number",
        step="any",
        value=(key,),
        change=f"{key} = {f'Math.round({typed})' if whole else typed}",
        min=low,
        max=high,
        aria_label=name,
        __properties=[*ARIA, "value", "min", "max", "type", "step"],
        __events=["change"],
        classes="flowtex-number",
    )
