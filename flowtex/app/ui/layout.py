"""The page: the picture over the whole window, and what lies on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from trame.ui.vuetify3 import VAppLayout
from trame.widgets import html
from trame.widgets import vuetify3 as v3
from trame_client.widgets.core import AbstractElement

from flowtex.app.controllers import Controllers
from flowtex.app.controllers.appearance import ANOTHER_FILE, ANOTHER_TIME
from flowtex.app.controllers.camera_controls import KEYS
from flowtex.app.controllers.playback import PACES
from flowtex.app.server.uploads import UPLOAD_SUFFIXES
from flowtex.app.ui.controls import ARIA, hint, select, slider, toggle
from flowtex.app.ui.panel import build_panel, panel_shown

#: What complains is dark in both.
COMPLAINT = {"surface-variant": "#2a3440", "on-surface-variant": "#e8edf2"}
THEMES = {
    "dark": {"dark": True, "colors": {"primary": "#4fd1c5", "surface": "#171c23", **COMPLAINT}},
    "light": {"dark": False, "colors": {"primary": "#0f766e", "surface": "#ffffff", **COMPLAINT}},
}

#: Attributes that tell the page's state to whoever watches it, such as a test.
DATA = [("data_picture", "data-picture"), ("data_sharp", "data-sharp"), ("data_busy", "data-busy")]
#: Time for which a complaint stands, for each letter that is to be read.
MS_PER_LETTER = 70


class PageElement(AbstractElement):
    """An element that ``static/flowtex.js`` makes."""

    def __init__(
        self, name: str, properties: Sequence[str], events: Sequence[Any] = (), **attributes: Any
    ) -> None:
        super().__init__(f"flowtex-{name}", **attributes)
        self._attr_names += properties
        self._event_names += events


def build_page(controllers: Controllers) -> Any:
    """Build the page; return trame's layout, whose ``html`` is the text of the page."""
    key = controllers.context.state.key
    config = {"theme": {"defaultTheme": "dark", "themes": THEMES}}
    with VAppLayout(controllers.context.state.server, vuetify_config=config) as layout:
        layout.root.theme = (key("theme"),)
        with html.Div(
            classes=(f"'flowtex flowtex-' + {key('theme')}",),
            data_picture=(key("picture"),),
            data_sharp=(key("sharp"),),
            data_busy=(key("busy"),),
            __properties=DATA,
        ):
            controllers.context.area.ui(
                classes="flowtex-view",
                pointerleave=controllers.point_info.leave,
                __events=["pointerleave"],
            )
            _client(controllers)
            over = (key("over"),)
            PageElement("path", ["over"], over=over, classes="flowtex-path flowtex-path-lines")
            _keys(controllers)
            PageElement(
                "covers", [], ["change"], change=(controllers.camera.take_covers, "[$event]")
            )
            _pane_labels(controllers)
            with html.Div(classes="flowtex-left"):
                _title(controllers)
                _planes(controllers)
                _card(controllers)
            _buttons(controllers)
            build_panel(controllers)
            _busy(controllers)
            with html.Div(classes="flowtex-foot"):
                _bar(controllers)
                _player(controllers)
                html.Div(f"{{{{ {key('figures')} }}}}", classes="flowtex-figures")
            _tip(controllers)
            _help_text(controllers)
            _complaint(controllers)
            PageElement("hints", [])
    return layout


def _client(controllers: Controllers) -> None:
    key, browser = controllers.context.state.key, controllers.browser
    followed = ("camera", "time", "playing")
    PageElement(
        "client",
        ["source", "settings", *followed],
        [
            *((f"update_{name}", f"update:{name}") for name in followed),
            *("setting", "sharp", "point", "hover"),
        ],
        v_if=(key("client_source"),),
        classes="flowtex-client",
        source=(key("client_source"),),
        settings=(key("client_settings"),),
        camera=(key("client_camera"),),
        time=(key("client_time"),),
        playing=(key("playing"),),
        update_camera=(browser.take_camera, "[$event]"),
        update_time=(browser.take_time, "[$event]"),
        update_playing=f"{key('playing')} = $event",
        setting=(controllers.appearance.take_setting, "[$event]"),
        sharp=(browser.take_sharp, "[$event]"),
        point=(controllers.point_info.take_point, "[$event]"),
        hover=(controllers.point_info.take_place, "[$event]"),
    )


def _keys(controllers: Controllers) -> None:
    key = controllers.context.state.key
    close_card = controllers.context.state.server.trigger_name(controllers.point_info.close_card)
    toggles = {
        "play": f"{key('playing')} = !{key('playing')}",
        "theme": _other_theme(key("theme")),
        "close": f"{key('help')} = false; {key('group')} = null; trigger('{close_card}')",
        "help": f"{key('help')} = !{key('help')}",
    }
    cases = "; ".join(f"if ($event === '{name}') {{ {code} }}" for name, code in toggles.items())
    PageElement(
        "keys",
        [],
        ["command", "toggle", "linked"],
        command=(controllers.camera.command, "[$event]"),
        toggle=cases,
        linked=(controllers.sharing.take_link, "[$event]"),
    )


def _title(controllers: Controllers) -> None:
    key = controllers.context.state.key
    with html.Div(classes="flowtex-title flowtex-glass"):
        html.Div("flowtex", classes="flowtex-mark")
        with html.Div(
            classes="flowtex-name", v_if=(f"{key('files')}.length + {key('unshown')}.length < 2",)
        ):
            html.Span(f"{{{{ {key('name')} }}}}")
        with html.Button(
            classes="flowtex-name flowtex-open",
            v_else=True,
            click=controllers.data.list_files,
            aria_label="Open another file",
            __properties=ARIA,
        ):
            html.Span(f"{{{{ {key('name')} }}}}")
            v3.VIcon("mdi-chevron-down", size=18)
            current = (f"item === {key('file')}",)
            _menu(
                key("files"),
                f"{key('file')} = item",
                active=current,
                max_height=360,
                unshown=key("unshown"),
            )
        with html.Div(classes="flowtex-about"):
            html.Span(f"{{{{ {key('about')} }}}}")
            with html.Button(
                classes="flowtex-again",
                v_if=(key("is_file"),),
                click=controllers.data.reload,
                aria_label="Read the file again",
                __properties=ARIA,
                **hint("Read the file again, where it has changed.", "bottom"),
            ):
                v3.VIcon("mdi-refresh", size=16)
        PageElement(
            "upload",
            ["address", "accept"],
            ["problem", "busy"],
            address=(key("upload"),),
            accept=",".join(UPLOAD_SUFFIXES),
            problem=f"{key('problem')} = $event",
            busy=f"{key('busy')} = $event",
        )


def _planes(controllers: Controllers) -> None:
    """Let array and plane be chosen, where there is a choice."""
    key = controllers.context.state.key
    some = " || ".join(f"{key(name)}.length" for name in ("vectors_choices", "axes", "blocks"))
    with html.Div(classes="flowtex-planes flowtex-glass", v_if=(some,)):
        word = key("block_word")
        for label, name, choices, more, text in (
            ("Grid", "block", "blocks", f" && {word} === 'Grid'", "Which of the grids is drawn."),
            ("Map", "block", "blocks", f" && {word} === 'Map'", "On which map it is drawn."),
            ("Velocity", "vectors", "vectors_choices", "", "What is taken for the velocity."),
        ):
            with html.Div(
                classes="flowtex-row",
                v_if=(f"{key(choices)}.length{more}",),
                __properties=ARIA,
                **hint(text, "end"),
            ):
                select(label, key(name), (key(choices),))
        with html.Div(classes="flowtex-stack", v_if=(f"{key('axes')}.length",)):
            with html.Div(classes="flowtex-line"):
                html.Span("Plane", classes="flowtex-label")
                across = hint("Along which axis a plane, or a level, is chosen.", "end")
                with toggle("Axis across the plane", key("axis"), **across):
                    one = f"one in {key('axes')}"
                    v3.VBtn("{{ one }}", v_for=one, key="one", value=("one",), size="small")
                html.Span(f"{{{{ {key('plane_text')} }}}}", classes="flowtex-value")
            with html.Div(v_if=(key("planes"),)):
                slider("Plane", key("index"), 0, (key("planes"),), 1)


def _menu(
    items: str,
    click: Any,
    *,
    title: str = "item",
    max_height: Any = None,
    unshown: str = "[]",
    **attributes: Any,
) -> None:
    """Open a list of items at the widget that is open; ``item`` is the one that is clicked.

    ``unshown`` are those that cannot be chosen, with ``name`` and ``why``.
    """
    height = {} if max_height is None else {"max_height": max_height}
    with (
        v3.VMenu(activator="parent", **height),
        v3.VList(density="compact", classes="flowtex-list"),
    ):
        v3.VListItem(
            v_for=f"item in {items}", key="item", title=(title,), click=click, **attributes
        )
        if unshown != "[]":
            v3.VListItem(
                v_for=f"file in {unshown}",
                key="file.name",
                title=("file.name",),
                subtitle=("file.why",),
                disabled=True,
            )


def _button(icon: str, text: str, click: Any, **attributes: Any) -> Any:
    button = v3.VBtn(
        icon=True,
        variant="text",
        size="small",
        click=click,
        aria_label=text,
        __properties=ARIA,
        **hint(text, "bottom"),
        **attributes,
    )
    with button:
        v3.VIcon(icon, size=20)
    return button


def _buttons(controllers: Controllers) -> None:
    key = controllers.context.state.key
    with html.Div(classes="flowtex-buttons flowtex-glass"):
        _button(
            "mdi-fit-to-screen-outline",
            "Show the whole surface",
            controllers.context.area.reset_camera,
        )
        some = (f"{key('views')}.length",)
        with _button("mdi-axis-arrow", "Look from a side", None, v_if=some):
            _menu(key("views"), (controllers.camera.look_from, "[item]"))
        _button("mdi-theme-light-dark", "Light or dark", _other_theme(key("theme")))
        _button("mdi-fullscreen", "Full screen", "flowtex_fullscreen()")
        _button("mdi-help", "Keys and the mouse", f"{key('help')} = true")
        _button("mdi-tune-variant", "Controls", f"{key('panel')} = !({panel_shown(key('panel'))})")


def _other_theme(theme: str) -> str:
    return f"{theme} = {theme} === 'dark' ? 'light' : 'dark'"


def _bar(controllers: Controllers) -> None:
    bar, scale = controllers.context.state.key("bar"), controllers.context.state.key("scale")
    with html.Div(classes="flowtex-corner"):
        with html.Div(classes="flowtex-scale", v_show=(f"{scale}.width",)):
            html.Span(f"{{{{ {scale}.text }}}}")
            html.Div(classes="flowtex-ruler", style=(f"{{ width: {scale}.width + 'vw' }}",))
        _colour_bar(bar, v_show=(f"{bar}.name",))


def _colour_bar(bar: str, **attributes: Any) -> None:
    with html.Div(classes="flowtex-bar flowtex-glass", **attributes):
        html.Div(f"{{{{ {bar}.name }}}}", classes="flowtex-label")
        ramp = f"{{ background: 'linear-gradient(to right, ' + {bar}.stops.join(',') + ')' }}"
        html.Div(classes="flowtex-ramp", style=(ramp,))
        with html.Div(classes="flowtex-line"):
            html.Span(f"{{{{ {bar}.low }}}}", classes="flowtex-value")
            html.Span(f"{{{{ {bar}.high }}}}", classes="flowtex-value")


def _player(controllers: Controllers) -> None:
    key = controllers.context.state.key
    playing, steady = key("playing"), key("steady")
    step = controllers.playback.step
    with html.Div(classes="flowtex-player flowtex-glass"):
        _button("mdi-skip-previous", "A step back", (step, "[-1]"), v_if=(f"!{steady}",))
        with v3.VBtn(
            icon=True,
            variant="text",
            size="small",
            click=f"{playing} = !{playing}",
            aria_label=(f"{playing} ? 'Pause' : 'Play'",),
            __properties=ARIA,
        ):
            v3.VIcon(f"{{{{ {playing} ? 'mdi-pause' : 'mdi-play' }}}}", size=24)
        _button("mdi-skip-next", "A step on", (step, "[1]"), v_if=(f"!{steady}",))
        html.Span("Stream along the flow", classes="flowtex-label flowtex-hint", v_if=(steady,))
        slider(
            "Time",
            key("time"),
            (key("first"),),
            (key("last"),),
            (key("tick"),),
            v_if=(f"!{steady}",),
        )
        html.Span(
            f"{{{{ {key('moment')} }}}}",
            classes="flowtex-value flowtex-moment",
            v_if=(f"!{steady}",),
        )
        with html.Button(
            f"{{{{ {key('pace')} }}}}×",
            classes="flowtex-link flowtex-pace",
            aria_label="How fast time goes by",
            __properties=ARIA,
            **hint("How fast time goes by.", "top"),
        ):
            _menu(str(list(PACES)), f"{key('pace')} = item", title="item + '×'")


def _pane_labels(controllers: Controllers) -> None:
    """Say in which of two panes what is shown."""
    names = ("compare", "bar_beside", "moment", "moment_beside", "pane_names")
    compare, bar, moment, beside, files = map(controllers.context.state.key, names)
    other_time = f"{compare} === '{ANOTHER_TIME}'"
    first = f"{files}[0] ?? ({other_time} ? {moment} : 'as set')"
    second = f"{files}[1] ?? ({other_time} ? {beside} : {compare})"
    two = f"{compare} === '{ANOTHER_FILE}' ? {files}.length : {compare} !== 'nothing'"
    with html.Div(classes="flowtex-panes", v_if=(two,)):
        html.Span(f"{{{{ {first} }}}}", classes="flowtex-chip")
        with html.Div(classes="flowtex-beside"):
            _colour_bar(bar, v_if=(bar,))
            html.Span(f"{{{{ {second} }}}}", classes="flowtex-chip")


def _card(controllers: Controllers) -> None:
    """Show the samples of the path through a point, and what becomes of them."""
    name = controllers.context.state.key("card")
    with html.Div(classes="flowtex-card flowtex-glass", v_if=(name,), role="region"):
        with html.Div(classes="flowtex-line"):
            html.Span("The path through this point", classes="flowtex-label")
            html.Button("Close", click=controllers.point_info.close_card, classes="flowtex-link")
        over = (controllers.context.state.key("over"),)
        PageElement("inset", ["over"], over=over, classes="flowtex-inset flowtex-path-lines")
        samples = "Each bar is a sample: its height the weight, its grey the noise it meets."
        with html.Div(classes="flowtex-bars", __properties=ARIA, **hint(samples, "end")):
            html.I(
                v_for=f"bar in {name}.bars",
                style=("{ height: 100 * bar.weight + '%', background: bar.grey }",),
            )
        with html.Div(classes="flowtex-line flowtex-ends"):
            html.Span("behind")
            html.Span("ahead")
        _pairs(f"{name}.lines")


def _tip(controllers: Controllers) -> None:
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


def _busy(controllers: Controllers) -> None:
    """Tell what is being read or traced, and offer to stop it."""
    name = controllers.context.state.key("busy")
    with html.Div(classes="flowtex-busy flowtex-glass", v_if=(name,), role="status"):
        v3.VProgressCircular(indeterminate=True, size=18, width=2, color="primary")
        html.Span(f"{{{{ {name} }}}}")
        html.Button("Cancel", click=controllers.cancel_opening, classes="flowtex-link")


def _help_text(controllers: Controllers) -> None:
    """Say what keys and mouse do."""
    visible = controllers.context.state.key("help")
    with html.Div(classes="flowtex-help flowtex-glass", v_if=(visible,), role="dialog"):
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
        html.Button("Close", click=f"{visible} = false", classes="flowtex-link")


def _complaint(controllers: Controllers) -> None:
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
