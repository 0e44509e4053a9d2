"""The panel of controls: five that everybody needs, and the rest in groups to unfold."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from trame.widgets import html
from trame.widgets import vuetify3 as v3

from flowtex.app.controllers.browser import RENDERERS
from flowtex.app.controllers.look import BACKGROUNDS, CMAPS
from flowtex.app.controllers.share import FORMATS
from flowtex.app.ui.controls import ARIA, GROUPS, PRIMARY, control, number, row, select, switch
from flowtex.settings import TABLE

if TYPE_CHECKING:
    from flowtex.app.flow_app import FlowApp

__all__ = ["build_panel"]


def build_panel(app: FlowApp) -> None:
    """Put the panel into the page that is open."""
    from flowtex.app.ui.layout import shown

    key = app.state.key
    with html.Div(
        classes="flowtex-panel flowtex-glass", v_show=(shown(key("panel")),), role="region"
    ):
        for name in PRIMARY:
            control(TABLE[name], key(f"set_{name}"))
        with row("colour", "What the colours tell."):
            select("Colour by", key("colour"), (key("colours"),))
        _group(app, "Colours", lambda: _colours(app))
        for title, names in GROUPS.items():
            _group(app, title, _settings(app, title, names))
        _group(app, "View", lambda: _view(app))
        _group(app, "Save", lambda: _save(app))
        _group(app, "Share", lambda: _share(app))


def _group(app: FlowApp, title: str, fill: Callable[[], None]) -> None:
    """Put a group that unfolds into the panel; one is open at a time."""
    group = app.state.key("group")
    is_open = f"{group} === '{title}'"
    with html.Button(
        classes="flowtex-more",
        click=f"{group} = {is_open} ? null : '{title}'",
        aria_expanded=(is_open,),
        __properties=ARIA,
    ):
        html.Span(title)
        v3.VIcon(f"{{{{ {is_open} ? 'mdi-chevron-up' : 'mdi-chevron-down' }}}}", size=18)
    with html.Div(v_show=(is_open,), classes="flowtex-rest"):
        fill()


def _settings(app: FlowApp, title: str, names: tuple[str, ...]) -> Callable[[], None]:
    def fill() -> None:
        for name in names:
            control(TABLE[name], app.state.key(f"set_{name}"))
        if title == "Noise":
            _image(app)

    return fill


def _image(app: FlowApp) -> None:
    with row("image", "A picture of your own, PNG or JPEG, that the flow smears."):
        html.Span("Your image", classes="flowtex-label")
        v3.VFileInput(
            v_model=(app.state.key("image_file"),),
            accept="image/png,image/jpeg,image/webp",
            density="compact",
            variant="plain",
            hide_details=True,
            prepend_icon="",
            aria_label="Your image",
            __properties=[*ARIA, "accept"],
            classes="flowtex-file",
        )


def _colours(app: FlowApp) -> None:
    key = app.state.key
    with row("cmap", "From low to high: even steps of lightness first, then maps with a middle."):
        select("Colour map", key("cmap"), (f"{list(CMAPS)}",))
    with row("range", "Values at the ends of the colour map."):
        html.Span("Range", classes="flowtex-label")
        with html.Span(classes="flowtex-range"):
            number("Lowest value", key("low"))
            number("Highest value", key("high"))
            html.Button("auto", click=app.look.forget_range, classes="flowtex-link")
    with row("background", "What lies behind the surface."):
        select("Background", key("background"), (f"{list(BACKGROUNDS)}",))


def _view(app: FlowApp) -> None:
    key = app.state.key
    with row("compare", "A second view beside the first, which moves with it."):
        select("Beside it", key("compare"), (key("comparisons"),))
    with row("rendering", "The server sends pictures; the browser draws with its own graphics."):
        _toggle("Drawn by", key("rendering"), RENDERERS)


def _toggle(name: str, key: str, choices: tuple[str, ...]) -> None:
    html.Span(name, classes="flowtex-label")
    with v3.VBtnToggle(
        v_model=(key,),
        mandatory=True,
        density="compact",
        variant="text",
        color="primary",
        classes="flowtex-toggle",
        aria_label=name,
        __properties=ARIA,
    ):
        for choice in choices:
            v3.VBtn(choice, value=choice, size="small")


def _save(app: FlowApp) -> None:
    """Put what makes pictures and movies into the group that is open."""
    key = app.state.key
    movie = f"{key('out_format')} !== 'PNG'"
    with row("format", "A picture, or a movie: one seamless round, or all times of the flow."):
        _toggle("Format", key("out_format"), FORMATS)
    with row("size", "Width and height in pixels; it may be larger than the window."):
        html.Span("Size", classes="flowtex-label")
        with html.Span(classes="flowtex-range"):
            number("Width in pixels", key("out_width"), 16, 30_000, whole=True)
            number("Height in pixels", key("out_height"), 16, 30_000, whole=True)
    with row("density", "Pixels for one of the screen: 2 for print, with larger grain."):
        html.Span("Fineness", classes="flowtex-label")
        number("Fineness", key("out_density"), 1, 8)
    with row("smooth", "Draw at twice the size and average: smoother edges, four times as long."):
        html.Span("Smooth edges", classes="flowtex-label")
        switch("Smooth edges", key("out_smooth"))
    with row("seconds", "How long the movie is, and its pictures in a second.", v_if=(movie,)):
        html.Span("Seconds, rate", classes="flowtex-label")
        with html.Span(classes="flowtex-range"):
            number("Seconds", key("out_seconds"), 0.1, 600)
            number("Pictures in a second", key("out_fps"), 1, 60)
    progress, file = key("out_progress"), key("out_file")
    with html.Div(classes="flowtex-row", v_if=(f"{progress} === null",)):
        html.Button("Make it", click=app.share.begin, classes="flowtex-action")
        html.A(
            f"Save {{{{ {file}.name }}}}",
            v_if=(file,),
            href=(f"{file}.url",),
            download=(f"{file}.name",),
            classes="flowtex-link",
            __properties=["href", "download"],
        )
    with html.Div(classes="flowtex-row", v_else=True):
        v3.VProgressLinear(model_value=(progress,), color="primary", height=6, rounded=True)
        html.Button("Cancel", click=app.share.cancel, classes="flowtex-link")


def _share(app: FlowApp) -> None:
    """Put the link and the lines of Python into the group that is open."""
    key = app.state.key
    with html.Div(classes="flowtex-row"):
        html.Button("Describe what is shown", click=app.share.show_state, classes="flowtex-action")
    with html.Div(v_if=(key("python"),)):
        for title, text in (
            ("Link", f"flowtex_address({key('link')})"),
            ("Python", key("python")),
        ):
            with html.Div(classes="flowtex-row"):
                html.Span(title, classes="flowtex-label")
                html.Button(
                    "Copy",
                    click=f"flowtex_copy({text})",
                    classes="flowtex-link",
                    aria_label=f"Copy the {title.lower()}",
                    __properties=ARIA,
                )
            html.Pre(f"{{{{ {text} }}}}", classes="flowtex-text")
