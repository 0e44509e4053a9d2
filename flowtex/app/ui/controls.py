"""Controls made from the table of settings: its kind chooses the widget, its sentence the hint."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from trame.widgets import html
from trame.widgets import vuetify3 as v3

from flowtex.settings import Setting

__all__ = [
    "ARIA",
    "GROUPS",
    "PRIMARY",
    "control",
    "hint",
    "label",
    "number",
    "row",
    "select",
    "slider",
    "switch",
]

#: What everybody needs, besides the colour; the rest is unfolded, group by group.
PRIMARY = ("lod", "noise", "samples", "contrast")
GROUPS: dict[str, tuple[str, ...]] = {
    "Texture": ("kernel", "two_sided", "grain", "fixed_grain", "spacing", "strength", "show_level"),
    "Noise": ("seed", "tiles", "noise_correction", "resolution"),
    "Motion": ("motion", "speed", "speed_in", "period", "parameter"),
}

#: More choices than this are a menu.
MOST_BUTTONS = 3
#: A range with more values than this is typed, not dragged.
MOST_STOPS = 500

#: Attributes that trame's widgets do not know by themselves.
ARIA = [("aria_label", "aria-label"), ("aria_expanded", "aria-expanded")]
DATA = [("data_setting", "data-setting")]

#: When a setting makes a difference, where others decide that.
_TEXTURE, _STREAMS = "set_noise !== 'procedural'", "set_motion !== 'off'"
MATTERS = {
    "tiles": _TEXTURE,
    "noise_correction": _TEXTURE,
    "resolution": f"{_TEXTURE} || set_fixed_grain || !set_lod",
    "speed": _STREAMS,
    "speed_in": _STREAMS,
    "period": _STREAMS,
}

LABELS = {"lod": "Level of detail"}


def label(name: str) -> str:
    """Return a setting's name as people read it."""
    return LABELS.get(name, name.replace("_", " ").capitalize())


def control(setting: Setting, key: str) -> None:
    """Put a control for one setting into the widget that is open.

    Parameters
    ----------
    setting
        The setting.
    key
        Name of the state that holds its value.
    """
    other = key.removesuffix(setting.name)
    matters = MATTERS.get(setting.name, "true").replace("set_", other)
    with row(
        setting.name,
        setting.text,
        classes=(f"{{ 'flowtex-row': true, 'flowtex-idle': !({matters}) }}",),
    ):
        _widget(setting)(setting, key)


def row(name: str, text: str, **attributes: Any) -> Any:
    """Return a row of the panel, with a hint, to be filled."""
    attributes.setdefault("classes", "flowtex-row")
    line = html.Div(data_setting=name, __properties=DATA, **attributes)
    with line:
        hint(text)
    return line


def hint(text: str, location: str = "start") -> None:
    """Say what the widget that is open is for, when the pointer rests on it."""
    v3.VTooltip(
        text=text, activator="parent", location=location, max_width=240, open_delay=400, offset=18
    )


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
    if setting.kind is bool:
        return _switch
    if setting.choices:
        return _choice if len(setting.choices) <= MOST_BUTTONS else _menu
    if (setting.high or 0) - (setting.low or 0) > MOST_STOPS:
        return _number
    return _slider


def _name(setting: Setting) -> None:
    html.Span(label(setting.name), classes="flowtex-label")


def _switch(setting: Setting, key: str) -> None:
    _name(setting)
    switch(label(setting.name), key)


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
    _name(setting)
    with v3.VBtnToggle(
        v_model=(key,),
        mandatory=True,
        density="compact",
        variant="text",
        divided=False,
        color="primary",
        classes="flowtex-toggle",
        aria_label=label(setting.name),
        __properties=ARIA,
    ):
        for choice in setting.choices:
            v3.VBtn(choice, value=choice, size="small")


def _menu(setting: Setting, key: str) -> None:
    select(label(setting.name), key, (f"{key}_choices", list(setting.choices)))


def _slider(setting: Setting, key: str) -> None:
    low, high = setting.low or 0, setting.high or 1
    step = 1 if setting.kind is int else _step(low, high, setting.default)
    digits = 0 if setting.kind is int else 2
    with html.Div(classes="flowtex-stack"):
        with html.Div(classes="flowtex-line"):
            _name(setting)
            html.Span(f"{{{{ Number({key}).toFixed({digits}) }}}}", classes="flowtex-value")
        slider(label(setting.name), key, low, high, step)


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
    number(label(setting.name), key, setting.low, setting.high, whole=setting.kind is int)


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


def _step(low: float, high: float, default: float) -> float:
    """Return a round number of which the range holds some hundred, and that meets the default."""
    for step in (0.01, 0.02, 0.05, 0.1):
        steps = (default - low) / step
        if (high - low) / step <= 400 and abs(steps - round(steps)) < 1e-6:
            return step
    return 0.25
