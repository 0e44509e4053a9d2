"""What lies over the picture: elements of ``static/flowtex.js``, a tip, a path, help, messages."""

from __future__ import annotations

from typing import Any

from trame.widgets import html
from trame.widgets import vuetify3 as v3
from trame_client.widgets.core import AbstractElement

from flowtex.app.controllers import Controllers
from flowtex.app.controllers.camera_controls import KEYS
from flowtex.app.ui.controls import hint

__all__ = [
    "Client",
    "Keys",
    "PathInset",
    "PathLines",
    "busy",
    "card",
    "complaint",
    "help_text",
    "pane_labels",
    "tip",
]

#: Time for which a complaint stands, for each letter that is to be read.
MS_PER_LETTER = 70


class Client(AbstractElement):
    """The browser's own client over the picture; see ``static/flowtex.js``."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__("flowtex-client", **attributes)
        self._attr_names += ["source", "settings", "camera", "time", "playing"]
        self._event_names += [
            *((f"update_{name}", f"update:{name}") for name in ("camera", "time", "playing")),
            "setting",
            "sharp",
            "point",
            "hover",
        ]


class Keys(AbstractElement):
    """What listens to the keyboard, and knows the window; see ``static/flowtex.js``."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__("flowtex-keys", **attributes)
        self._event_names += ["command", "toggle", "linked"]


class PathLines(AbstractElement):
    """The path through a point, over the picture; see ``static/flowtex.js``."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__("flowtex-path", **attributes)
        self._attr_names += ["over"]


class PathInset(AbstractElement):
    """The samples of the path, enlarged; see ``static/flowtex.js``."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__("flowtex-inset", **attributes)
        self._attr_names += ["over"]


def pane_labels(controllers: Controllers) -> None:
    """Say in which of two panes what is shown."""
    compare = controllers.context.state.key("compare")
    with html.Div(classes="flowtex-panes", v_if=(f"{compare} !== 'nothing'",)):
        html.Span("as set", classes="flowtex-chip")
        html.Span(f"{{{{ {compare} }}}}", classes="flowtex-chip")


def card(controllers: Controllers) -> None:
    """Show the samples of the path through a point, and what becomes of them."""
    name = controllers.context.state.key("card")
    with html.Div(classes="flowtex-card flowtex-glass", v_if=(name,), role="region"):
        with html.Div(classes="flowtex-line"):
            html.Span("The path through this point", classes="flowtex-label")
            html.Button("Close", click=controllers.point_info.close_card, classes="flowtex-link")
        PathInset(
            over=(controllers.context.state.key("over"),),
            classes="flowtex-inset flowtex-path-lines",
        )
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


def tip(controllers: Controllers) -> None:
    """Tell what is under the pointer."""
    name = controllers.context.state.key("tip")
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


def busy(controllers: Controllers) -> None:
    """Tell what is being read or traced, and offer to stop it."""
    name = controllers.context.state.key("busy")
    with html.Div(classes="flowtex-busy flowtex-glass", v_if=(name,), role="status"):
        v3.VProgressCircular(indeterminate=True, size=18, width=2, color="primary")
        html.Span(f"{{{{ {name} }}}}")
        html.Button("Cancel", click=controllers.data.cancel, classes="flowtex-link")


def help_text(controllers: Controllers) -> None:
    """Say what keys and mouse do."""
    shown = controllers.context.state.key("help")
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


def complaint(controllers: Controllers) -> None:
    """Say what is wrong."""
    problem = controllers.context.state.key("problem")
    with (
        v3.VSnackbar(
            f"{{{{ {problem} }}}}",
            model_value=(f"!!{problem}",),
            update_modelValue=f"{problem} = ''",
            timeout=(f"Math.max(8000, {MS_PER_LETTER} * {problem}.length)",),
            location="top",
            content_class="flowtex-complaint",
        ),
        html.Template(v_slot_actions=True),
    ):
        html.Button("Close", click=f"{problem} = ''", classes="flowtex-link")
