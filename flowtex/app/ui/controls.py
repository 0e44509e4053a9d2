"""Controls of a page; those of settings are made from the table in :mod:`flowtex.settings`."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import Any

from trame.widgets import html
from trame.widgets import vuetify3 as v3

from flowtex.settings import NEEDS, STEADINESS, Setting

#: More choices than this are a menu.
MOST_BUTTONS = 3
#: Attributes that trame's widgets do not know by themselves.
ARIA = [
    ("aria_label", "aria-label"),
    ("aria_expanded", "aria-expanded"),
    ("data_hint", "data-hint"),
    ("data_side", "data-side"),
]
DATA = [*ARIA, ("data_setting", "data-setting")]


def control(setting: Setting, key: str) -> None:
    """Put a control for a setting, with the state of this key, into the widget that is open."""
    prefix = key.removesuffix(setting.name)
    needs = " || ".join(
        f"{prefix}{name} {sign} {_literal(to)}" for name, sign, to in NEEDS.get(setting.name, ())
    )
    idle = [(f"!({needs})", setting.condition)] if needs else []
    if setting.name in STEADINESS:
        steady = prefix.removesuffix("set_") + "steady"
        is_steady = STEADINESS[setting.name]
        reason = f"Only for a flow that {'does not vary' if is_steady else 'varies'} in time."
        idle.insert(0, (f"{steady} !== {_literal(is_steady)}", reason))
    with row(setting.name, setting.text, idle):
        _widget(setting)(setting, key)


def row(name: str, text: str, idle: Sequence[tuple[str, str]] = (), **attributes: Any) -> Any:
    """Return a row of the panel, with a hint, to be filled.

    ``idle`` has conditions in JavaScript under which the row makes no difference, and why.
    """
    reasons = "".join(f"{condition} ? {_literal(why + ' ')} : " for condition, why in idle)
    dim = " || ".join(condition for condition, _ in idle) or "false"
    return html.Div(
        data_setting=name,
        data_hint=(f"({reasons}'') + {_literal(text)}",),
        data_side="start",
        classes=(f"{{ 'flowtex-row': true, 'flowtex-idle': {dim} }}",),
        __properties=DATA,
        **attributes,
    )


def hint(text: str, side: str) -> dict[str, str]:
    """Return the attributes of a widget that says what it is for, when the pointer rests on it."""
    return {"data_hint": text, "data_side": side}


def select(name: str, key: str, items: Any, **attributes: Any) -> None:
    """Put a menu of choices into the row that is open."""
    html.Span(name, classes="flowtex-label")
    v3.VSelect(
        v_model=(key,),
        items=items,
        aria_label=name,
        __properties=ARIA,
        density="compact",
        variant="plain",
        hide_details=True,
        menu_props=("{ contentClass: 'flowtex-list' }",),
        list_props=("{ density: 'compact' }",),
        classes="flowtex-select",
        **attributes,
    )


def _widget(setting: Setting) -> Callable[[Setting, str], None]:
    if setting.control == "choice":
        return _choice if len(setting.choices) <= MOST_BUTTONS else _menu
    return {"checkbox": _switch, "number": _number, "slider": _slider}[setting.control]


def _literal(value: Any) -> str:
    """Return a value as JavaScript has it."""
    if isinstance(value, str):
        return "'" + value.replace("\\", "\\\\").replace("'", "\\'") + "'"
    return json.dumps(value)


def _name(setting: Setting) -> None:
    html.Span(setting.label, classes="flowtex-label")


def _switch(setting: Setting, key: str) -> None:
    _name(setting)
    switch(setting.label, key)


def switch(name: str, key: str) -> None:
    """Put a switch into the row that is open."""
    v3.VSwitch(
        v_model=(key,),
        aria_label=name,
        __properties=ARIA,
        color="primary",
        density="compact",
        hide_details=True,
        inset=True,
        classes="flowtex-switch",
    )


def _choice(setting: Setting, key: str) -> None:
    buttons(setting.label, key, setting.choices)


def buttons(name: str, key: str, choices: Sequence[str]) -> None:
    """Put buttons of which one is pressed into the row that is open."""
    html.Span(name, classes="flowtex-label")
    with toggle(name, key):
        for choice in choices:
            v3.VBtn(choice, value=choice, size="small")


def toggle(name: str, key: str, **attributes: Any) -> Any:
    """Return a group of buttons of which one is pressed, to be filled."""
    return v3.VBtnToggle(
        v_model=(key,),
        mandatory=True,
        density="compact",
        variant="text",
        color="primary",
        classes="flowtex-toggle",
        aria_label=name,
        __properties=ARIA,
        **attributes,
    )


def _menu(setting: Setting, key: str) -> None:
    select(setting.label, key, (f"{key}_choices", list(setting.choices)))


def _slider(setting: Setting, key: str) -> None:
    low, high = setting.low or 0, setting.high or 1
    digits = 0 if setting.kind is int else 2
    with html.Div(classes="flowtex-stack"):
        with html.Div(classes="flowtex-line"):
            _name(setting)
            html.Span(f"{{{{ Number({key}).toFixed({digits}) }}}}", classes="flowtex-value")
        slider(setting.label, key, low, high, setting.step)


def slider(name: str, key: str, low: Any, high: Any, step: Any, **attributes: Any) -> None:
    """Put a slider into the widget that is open."""
    v3.VSlider(
        v_model=(key,),
        min=low,
        max=high,
        step=step,
        aria_label=name,
        __properties=ARIA,
        color="primary",
        density="compact",
        hide_details=True,
        thumb_size=14,
        track_size=3,
        **attributes,
    )


def _number(setting: Setting, key: str) -> None:
    _name(setting)
    number(setting.label, key, setting.low, setting.high, whole=setting.kind is int)


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
