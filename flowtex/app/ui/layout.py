"""The page: the view, what may be opened above it, and a panel of what is done with it."""

from __future__ import annotations

from typing import Any

from trame.ui.vuetify3 import VAppLayout
from trame.widgets import html
from trame.widgets import vuetify3 as v3

from flowtex.app.controllers import Controllers
from flowtex.app.server.page import PageElement
from flowtex.app.server.uploads import UPLOAD_SUFFIXES
from flowtex.app.ui.controls import ARIA, hint, select, slider, toggle
from flowtex.app.ui.panel import build_panel
from flowtex.settings import TABLE

#: What complains is dark in both.
COMPLAINT = {"surface-variant": "#2a3440", "on-surface-variant": "#e8edf2"}
THEMES = {
    "dark": {"dark": True, "colors": {"primary": "#4fd1c5", "surface": "#171c23", **COMPLAINT}},
    "light": {"dark": False, "colors": {"primary": "#0f766e", "surface": "#ffffff", **COMPLAINT}},
}
#: Time for which a complaint stands, for each letter that is to be read.
MS_PER_LETTER = 70
#: What mouse and keys do.
HELP = {
    "drag": "pan a flat surface, turn a curved one",
    "Shift and drag": "the opposite: turn, or pan",
    "wheel, two fingers": "zoom to the pointer",
    "click": "values and path of a point",
    "arrows": "pan",
    "+ and -": "zoom",
    "space": "play or pause",
    ", and .": "a step back or on",
    "0": "the whole surface",
    "d": f"{TABLE['lod'].label.lower()} on or off",
    "h": "the bar of controls",
    "t": "light or dark",
    "f": "full screen",
    "Esc": "close panels and messages",
}


def build_page(controllers: Controllers) -> Any:
    """Build the page; return trame's layout, whose ``html`` is the text of the page."""
    key = controllers.context.state.key
    config = {"theme": {"defaultTheme": "dark", "themes": THEMES}}
    with VAppLayout(controllers.context.state.server, vuetify_config=config) as layout:
        layout.root.theme = (key("theme"),)
        with html.Main(
            classes=(f"'flowtex-page flowtex-' + {key('theme')}",),
            data_busy=(key("busy"),),
            __properties=[("data_busy", "data-busy")],
        ):
            with html.Div(classes="flowtex-head"):
                html.Span("flowtex", classes="flowtex-mark")
                _title(controllers)
                _planes(controllers)
                _buttons(controllers)
            controllers.context.area.ui(classes="flowtex-area")
            _keys(controllers)
            build_panel(controllers)
            _busy(controllers)
            _help_text(controllers)
            _complaint(controllers)
            PageElement("hints", [])
    return layout


def _keys(controllers: Controllers) -> None:
    key = controllers.context.state.key
    toggles = {
        "theme": _other_theme(key("theme")),
        "close": f"{key('help')} = {key('panel')} = false",
        "help": f"{key('help')} = !{key('help')}",
    }
    cases = "; ".join(f"if ($event === '{name}') {{ {code} }}" for name, code in toggles.items())
    linked = (controllers.sharing.take_link, "[$event]")
    PageElement("keys", [], ["toggle", "linked"], toggle=cases, linked=linked)


def _title(controllers: Controllers) -> None:
    key = controllers.context.state.key
    with html.Div(classes="flowtex-title"):
        with html.Div(
            classes="flowtex-name", v_if=(f"{key('files')}.length + {key('unshown')}.length < 2",)
        ):
            html.Span(f"{{{{ {key('name')} }}}}")
        with html.Button(
            classes="flowtex-name flowtex-files",
            v_else=True,
            click=controllers.data.list_files,
            aria_label=(f"{key('name')} + ': open another file'",),
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
                **hint("Read the file again if it has changed.", "bottom"),
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
    with html.Div(classes="flowtex-planes", v_if=(some,)):
        word = key("block_word")
        for label, name, choices, more, text in (
            ("Grid", "block", "blocks", f" && {word} === 'Grid'", "Choose the grid to draw."),
            ("Map", "block", "blocks", f" && {word} === 'Map'", "Choose the map."),
            ("Velocity", "vectors", "vectors_choices", "", "Choose the velocity."),
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
                across = hint(
                    "Choose the axis along which the slider selects a plane or a level.", "end"
                )
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
    with html.Div(classes="flowtex-buttons"):
        some = (f"{key('views')}.length",)
        with _button("mdi-axis-arrow", "Look from a side", None, v_if=some):
            _menu(key("views"), (controllers.viewpoint.look_from, "[item]"))
        _button("mdi-theme-light-dark", "Light or dark", _other_theme(key("theme")))
        _button("mdi-help", "Keys and the mouse", f"{key('help')} = true")
        _button("mdi-share-variant", "Compare, save, share", f"{key('panel')} = !{key('panel')}")


def _other_theme(theme: str) -> str:
    return f"{theme} = {theme} === 'dark' ? 'light' : 'dark'"


def _busy(controllers: Controllers) -> None:
    """Show what is being read or traced, and offer to stop it."""
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
        with html.Dl():
            for name, text in HELP.items():
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
            # What points at a place in a formula needs letters of one width.
            content_class=(
                f"'flowtex-complaint' + ({problem}.includes('\\n') ? ' flowtex-pointing' : '')",
            ),
        ),
        html.Template(v_slot_actions=True),
    ):
        html.Button("Close", click=f"{problem} = ''", classes="flowtex-link")
