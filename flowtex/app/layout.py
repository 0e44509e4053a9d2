"""The page: the picture over the whole window, and what lies on it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from trame.ui.vuetify3 import VAppLayout
from trame.widgets import html, rca
from trame.widgets import vuetify3 as v3

from flowtex.app.controls import ARIA, PRIMARY, REST, control
from flowtex.settings import TABLE

__all__ = ["THEMES", "build_page"]

THEMES = {
    "dark": {"dark": True, "colors": {"primary": "#4fd1c5", "surface": "#171c23"}},
    "light": {"dark": False, "colors": {"primary": "#0f766e", "surface": "#ffffff"}},
}

#: Attributes that tell the page's state to whoever watches it, such as a test.
DATA = [("data_picture", "data-picture"), ("data_sharp", "data-sharp")]

Key = Callable[[str], str]


def build_page(server: Any, key: Key, area: str, reset: Callable[[], None], *, clock: bool) -> Any:
    """Build the page.

    Parameters
    ----------
    server
        The trame server.
    key
        Gives the state's name of one of the application's own.
    area
        Name of the remote controlled area.
    reset
        Shows the whole surface again.
    clock
        Whether there are times to choose from.

    Returns
    -------
    object
        trame's layout; its ``html`` is the text of the page.
    """
    config = {"theme": {"defaultTheme": "dark", "themes": THEMES}}
    with VAppLayout(server, vuetify_config=config) as layout:
        layout.root.theme = (key("theme"),)
        with html.Div(
            classes=(f"'flowtex flowtex-' + {key('theme')}",),
            data_picture=(key("picture"),),
            data_sharp=(key("sharp"),),
            __properties=DATA,
        ):
            with html.Div(classes="flowtex-view"):
                rca.RemoteControlledArea(
                    name=area,
                    display="image",
                    event_throttle_ms=16,
                    image_style=("{ width: '100%', height: '100%' }",),
                )
            _title(key)
            _buttons(key, reset)
            _panel(key)
            with html.Div(classes="flowtex-foot"):
                _bar(key)
                _player(key, clock=clock)
                html.Div(f"{{{{ {key('figures')} }}}}", classes="flowtex-figures")
            _problem(key)
    return layout


def _title(key: Key) -> None:
    with html.Div(classes="flowtex-title"):
        html.Div("flowtex", classes="flowtex-mark")
        html.Div(f"{{{{ {key('name')} }}}}", classes="flowtex-name")
        html.Div(f"{{{{ {key('about')} }}}}", classes="flowtex-about")


def _button(icon: str, text: str, click: Any) -> None:
    with v3.VBtn(
        icon=True, variant="text", size="small", click=click, aria_label=text, __properties=ARIA
    ):
        v3.VIcon(icon, size=20)
        v3.VTooltip(text=text, activator="parent", location="bottom", open_delay=400)


def _buttons(key: Key, reset: Callable[[], None]) -> None:
    theme, panel = key("theme"), key("panel")
    with html.Div(classes="flowtex-buttons flowtex-glass"):
        _button("mdi-fit-to-screen-outline", "Show the whole surface", reset)
        other = f"{theme} = {theme} === 'dark' ? 'light' : 'dark'"
        _button("mdi-theme-light-dark", "Light or dark", other)
        _button("mdi-tune-variant", "Controls", f"{panel} = !({_shown(panel)})")


def _shown(panel: str) -> str:
    """Whether the panel is shown: as chosen, or at first where there is room for it."""
    return f"{panel} === null ? $vuetify.display.mdAndUp : {panel}"


def _panel(key: Key) -> None:
    more = key("more")
    with html.Div(classes="flowtex-panel flowtex-glass", v_show=(_shown(key("panel")),)):
        for name in PRIMARY:
            control(TABLE[name], key(f"set_{name}"))
        with html.Div(classes="flowtex-row"):
            html.Span("Colour by", classes="flowtex-label")
            v3.VSelect(
                v_model=(key("colour"),),
                items=(key("colours"),),
                aria_label="Colour by",
                __properties=ARIA,
                density="compact",
                variant="plain",
                hide_details=True,
                classes="flowtex-select",
            )
        with html.Button(
            classes="flowtex-more",
            click=f"{more} = !{more}",
            aria_expanded=(f"{more}",),
            __properties=ARIA,
        ):
            html.Span(f"{{{{ {more} ? 'Fewer settings' : 'More settings' }}}}")
            v3.VIcon(f"{{{{ {more} ? 'mdi-chevron-up' : 'mdi-chevron-down' }}}}", size=18)
        with html.Div(v_show=(more,), classes="flowtex-rest"):
            for name in REST:
                control(TABLE[name], key(f"set_{name}"))


def _bar(key: Key) -> None:
    bar = key("bar")
    with html.Div(classes="flowtex-bar flowtex-glass", v_show=(f"{bar}.name",)):
        html.Div(f"{{{{ {bar}.name }}}}", classes="flowtex-label")
        html.Div(
            classes="flowtex-ramp",
            style=(
                f"{{ background: 'linear-gradient(to right, ' + {bar}.stops.join(',') + ')' }}",
            ),
        )
        with html.Div(classes="flowtex-line"):
            html.Span(f"{{{{ {bar}.low }}}}", classes="flowtex-value")
            html.Span(f"{{{{ {bar}.high }}}}", classes="flowtex-value")


def _player(key: Key, *, clock: bool) -> None:
    playing = key("playing")
    with html.Div(classes="flowtex-player flowtex-glass"):
        with v3.VBtn(
            icon=True,
            variant="text",
            size="small",
            click=f"{playing} = !{playing}",
            aria_label=(f"{playing} ? 'Pause' : 'Play'",),
            __properties=ARIA,
        ):
            v3.VIcon(f"{{{{ {playing} ? 'mdi-pause' : 'mdi-play' }}}}", size=24)
        if not clock:
            html.Span("Stream along the flow", classes="flowtex-label flowtex-hint")
            return
        v3.VSlider(
            v_model=(key("time"),),
            min=(key("first"),),
            max=(key("last"),),
            step=(key("tick"),),
            aria_label="Time",
            __properties=ARIA,
            color="primary",
            density="compact",
            hide_details=True,
            thumb_size=14,
            track_size=3,
        )
        html.Span(f"{{{{ {key('moment')} }}}}", classes="flowtex-value flowtex-moment")


def _problem(key: Key) -> None:
    problem = key("problem")
    v3.VSnackbar(
        f"{{{{ {problem} }}}}",
        model_value=(f"!!{problem}",),
        update_modelValue=f"{problem} = ''",
        timeout=6000,
        location="bottom",
    )
