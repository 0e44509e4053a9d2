"""Controls made from the table of settings: its kind chooses the widget, its sentence the hint."""

from __future__ import annotations

from collections.abc import Callable

from trame.widgets import html
from trame.widgets import vuetify3 as v3

from flowtex.settings import TABLE, Setting

__all__ = ["ARIA", "PRIMARY", "REST", "control", "label"]

#: What everybody needs; the rest is unfolded.
PRIMARY = ("lod", "noise", "samples", "contrast")
REST = tuple(name for name in TABLE if name not in PRIMARY)

#: More choices than this are a menu.
MOST_BUTTONS = 3
#: A range with more values than this is typed, not dragged.
MOST_STOPS = 1000

#: Attributes that trame's widgets do not know by themselves.
ARIA = [("aria_label", "aria-label"), ("aria_expanded", "aria-expanded")]
DATA = [("data_setting", "data-setting")]

LABELS = {"lod": "Level of detail"}


def label(name: str) -> str:
    """Return a setting's name as people read it."""
    return LABELS.get(name, name.replace("_", " ").capitalize())


def control(row: Setting, key: str) -> None:
    """Put a control for one setting into the widget that is open.

    Parameters
    ----------
    row
        The setting.
    key
        Name of the state that holds its value.
    """
    with html.Div(classes="flowtex-row", data_setting=row.name, __properties=DATA):
        _hint(row.text)
        _widget(row)(row, key)


def _widget(row: Setting) -> Callable[[Setting, str], None]:
    if row.kind is bool:
        return _switch
    if row.choices:
        return _choice if len(row.choices) <= MOST_BUTTONS else _menu
    if (row.high or 0) - (row.low or 0) > MOST_STOPS:
        return _number
    return _slider


def _hint(text: str) -> None:
    v3.VTooltip(
        text=text, activator="parent", location="start", max_width=240, open_delay=400, offset=18
    )


def _name(row: Setting) -> None:
    html.Span(label(row.name), classes="flowtex-label")


def _switch(row: Setting, key: str) -> None:
    _name(row)
    v3.VSwitch(
        v_model=(key,),
        aria_label=label(row.name),
        __properties=ARIA,
        color="primary",
        density="compact",
        hide_details=True,
        inset=True,
        classes="flowtex-switch",
    )


def _choice(row: Setting, key: str) -> None:
    _name(row)
    with v3.VBtnToggle(
        v_model=(key,),
        mandatory=True,
        density="compact",
        variant="text",
        divided=False,
        color="primary",
        classes="flowtex-toggle",
        aria_label=label(row.name),
        __properties=ARIA,
    ):
        for choice in row.choices:
            v3.VBtn(choice, value=choice, size="small")


def _menu(row: Setting, key: str) -> None:
    _name(row)
    v3.VSelect(
        v_model=(key,),
        items=(f"{key}_choices", list(row.choices)),
        aria_label=label(row.name),
        __properties=ARIA,
        density="compact",
        variant="plain",
        hide_details=True,
        classes="flowtex-select",
    )


def _slider(row: Setting, key: str) -> None:
    low, high = row.low or 0, row.high or 1
    step = 1 if row.kind is int else _step(high - low)
    digits = 0 if row.kind is int else 2
    with html.Div(classes="flowtex-stack"):
        with html.Div(classes="flowtex-line"):
            _name(row)
            html.Span(f"{{{{ Number({key}).toFixed({digits}) }}}}", classes="flowtex-value")
        v3.VSlider(
            v_model=(key,),
            min=low,
            max=high,
            step=step,
            aria_label=label(row.name),
            __properties=ARIA,
            color="primary",
            density="compact",
            hide_details=True,
            thumb_size=14,
            track_size=3,
        )


def _number(row: Setting, key: str) -> None:
    _name(row)
    typed = "Number($event.target.value)"
    html.Input(
        type="number",
        value=(key,),
        change=f"{key} = {f'Math.round({typed})' if row.kind is int else typed}",
        min=row.low,
        max=row.high,
        aria_label=label(row.name),
        __properties=[*ARIA, "value", "min", "max", "type"],
        __events=["change"],
        classes="flowtex-number",
    )


def _step(span: float) -> float:
    """Return a round number of which the range holds some hundred."""
    for step in (0.01, 0.02, 0.05, 0.1):
        if span / step <= 400:
            return step
    return 0.25
