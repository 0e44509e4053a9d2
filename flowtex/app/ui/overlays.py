"""What lies over the picture for a while: a tip, a path, what goes on, help and complaints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from trame.widgets import html
from trame.widgets import vuetify3 as v3

from flowtex.app.controllers.moves import KEYS
from flowtex.app.ui.controls import hint
from flowtex.app.ui.elements import PathInset

if TYPE_CHECKING:
    from flowtex.app.flow_app import FlowApp

__all__ = ["busy", "card", "complaint", "help_text", "pane_labels", "tip"]

#: Time for which a complaint stands, for each letter that is to be read.
MILLISECONDS = 70


def pane_labels(app: FlowApp) -> None:
    """Say in which of two panes what is shown."""
    compare = app.state.key("compare")
    with html.Div(classes="flowtex-panes", v_if=(f"{compare} !== 'nothing'",)):
        html.Span("as set", classes="flowtex-chip")
        html.Span(f"{{{{ {compare} }}}}", classes="flowtex-chip")


def card(app: FlowApp) -> None:
    """Show the samples of the path through a point, and what becomes of them."""
    name = app.state.key("card")
    with html.Div(classes="flowtex-card flowtex-glass", v_if=(name,), role="region"):
        with html.Div(classes="flowtex-line"):
            html.Span("The path through this point", classes="flowtex-label")
            html.Button("Close", click=app.reader.close_card, classes="flowtex-link")
        PathInset(over=(app.state.key("over"),), classes="flowtex-inset flowtex-path-lines")
        with html.Div(classes="flowtex-bars"):
            hint("Each bar is a sample: its height the weight, its grey the noise it meets.", "end")
            html.I(
                v_for=f"bar in {name}.bars",
                style=("{ height: 100 * bar.weight + '%', background: bar.grey }",),
            )
        with html.Div(classes="flowtex-line flowtex-ends"):
            html.Span("behind")
            html.Span("ahead")
        _pairs(f"{name}.lines")


def tip(app: FlowApp) -> None:
    """Tell what is under the pointer."""
    name = app.state.key("tip")
    place = (
        f"{{ left: {name}.x + '%', top: {name}.y + '%', transform: "
        f"'translate(' + ({name}.x > 70 ? 'calc(-100% - 16px)' : '16px') + ', ' + "
        f"({name}.y > 75 ? 'calc(-100% - 12px)' : '12px') + ')' }}"
    )
    with html.Div(classes="flowtex-tip flowtex-glass", v_if=(name,), style=(place,)):
        _pairs(f"{name}.lines")


def _pairs(lines: str) -> None:
    """Put words and numbers in two columns."""
    with html.Dl(classes="flowtex-pairs"), html.Template(v_for=f"line in {lines}"):
        html.Dt("{{ line[0] }}")
        html.Dd("{{ line[1] }}")


def busy(app: FlowApp) -> None:
    """Tell what is being read or traced, and offer to stop it."""
    name = app.state.key("busy")
    with html.Div(classes="flowtex-busy flowtex-glass", v_if=(name,), role="status"):
        v3.VProgressCircular(indeterminate=True, size=18, width=2, color="primary")
        html.Span(f"{{{{ {name} }}}}")
        html.Button("Cancel", click=app.data.cancel, classes="flowtex-link")


def help_text(app: FlowApp) -> None:
    """Say what keys and mouse do."""
    shown = app.state.key("help")
    with html.Div(classes="flowtex-help flowtex-glass", v_if=(shown,), role="dialog"):
        html.Div("Keys and the mouse", classes="flowtex-name")
        mouse = {
            "drag": "pan a flat surface, turn a curved one",
            "Shift and drag": "the other one of the two",
            "wheel, two fingers": "zoom to the pointer",
            "click": "the path through a point",
        }
        with html.Dl():
            for name, text in {**mouse, **KEYS}.items():
                html.Dt(name)
                html.Dd(text)
        html.Button("Close", click=f"{shown} = false", classes="flowtex-link")


def complaint(app: FlowApp) -> None:
    """Say what is wrong."""
    problem = app.state.key("problem")
    with (
        v3.VSnackbar(
            f"{{{{ {problem} }}}}",
            model_value=(f"!!{problem}",),
            update_modelValue=f"{problem} = ''",
            timeout=(f"Math.max(8000, {MILLISECONDS} * {problem}.length)",),
            location="top",
            content_class="flowtex-complaint",
        ),
        html.Template(v_slot_actions=True),
    ):
        html.Button("Close", click=f"{problem} = ''", classes="flowtex-link")
