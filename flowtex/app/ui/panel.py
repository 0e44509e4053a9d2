"""The panel of what a page does beside drawing: comparing, saving, sharing."""

from __future__ import annotations

from collections.abc import Callable

from trame.widgets import html
from trame.widgets import vuetify3 as v3

from flowtex.app.controllers import Controllers
from flowtex.app.controllers.appearance import ANOTHER_FILE, ANOTHER_TIME, BACKGROUNDS
from flowtex.app.controllers.sharing import FORMATS
from flowtex.app.streaming.element import PAINTERS
from flowtex.app.ui.controls import ARIA, buttons, number, row, select, slider, switch


def build_panel(controllers: Controllers) -> None:
    """Put the panel into the page that is open."""
    key = controllers.context.state.key
    with html.Div(
        classes="flowtex-panel flowtex-glass",
        v_show=(key("panel"),),
        role="region",
        aria_label="Panel",
        __properties=ARIA,
    ):
        _group(controllers, "View", lambda: _view(controllers))
        _group(controllers, "Save", lambda: _save(controllers))
        _group(controllers, "Share", lambda: _share(controllers))


def _group(controllers: Controllers, title: str, fill: Callable[[], None]) -> None:
    """Put a group that unfolds into the panel; one is open at a time."""
    group = controllers.context.state.key("group")
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


def _view(controllers: Controllers) -> None:
    key = controllers.context.state.key
    if controllers.context.library.typed:
        with row(
            "formula",
            "Type a formula: the rates of x and y, ranges and parameters, separated by semicolons.",
        ):
            html.Span("Formula", classes="flowtex-label")
            html.Input(
                placeholder="y; -sin(x) - b*y; x=-7,7; b=0.2",
                change=f"{key('file')} = $event.target.value",
                aria_label="Formula",
                __properties=[*ARIA, "placeholder"],
                __events=["change"],
                classes="flowtex-formula",
            )
    with row("compare", "Add a second view that moves with the first."):
        select("Beside it", key("compare"), (key("comparisons"),))
    with row(
        "time_beside",
        "Choose the time in the second view.",
        v_if=(f"{key('compare')} === '{ANOTHER_TIME}'",),
    ):
        html.Span("Time beside", classes="flowtex-label")
        slider("Time beside", key("time_beside"), (key("first"),), (key("last"),), (key("tick"),))
    with row(
        "file_beside",
        "Choose the file in the second view.",
        v_if=(f"{key('compare')} === '{ANOTHER_FILE}'",),
    ):
        others = f"{key('files')}.filter(name => name !== {key('file')})"
        select("File beside", key("file_beside"), (others,))
    with row("image", "Choose an image of your own, PNG or JPEG, that the flow smears."):
        html.Span("Your image", classes="flowtex-label")
        v3.VFileInput(
            v_model=(key("image_file"),),
            accept="image/png,image/jpeg,image/webp",
            density="compact",
            variant="plain",
            hide_details=True,
            prepend_icon="",
            aria_label="Your image",
            __properties=[*ARIA, "accept"],
            classes="flowtex-file",
        )
    with row("background", "Choose the background colour."):
        select("Background", key("background"), (f"{list(BACKGROUNDS)}",))
    with row("painter", "Choose who draws: the browser, or the server, which sends pictures."):
        buttons("Drawn by", key("painter"), PAINTERS)


def _save(controllers: Controllers) -> None:
    """Put what makes pictures and movies into the group that is open."""
    key = controllers.context.state.key
    movie = f"{key('out_format')} !== 'PNG'"
    with row(
        "format", "Choose a picture, or a movie: one seamless period, or all times of the flow."
    ):
        buttons("Format", key("out_format"), FORMATS)
    with row("size", "Width and height in pixels; may exceed the window."):
        html.Span("Size", classes="flowtex-label")
        with html.Span(classes="flowtex-range"):
            number("Width in pixels", key("out_width"), 16, 30_000, whole=True)
            number("Height in pixels", key("out_height"), 16, 30_000, whole=True)
    with row("density", "Pixels per screen pixel: 2 for print, with larger grain."):
        html.Span("Fineness", classes="flowtex-label")
        number("Fineness", key("out_density"), 1, 8)
    with row(
        "smooth", "Draw at twice the size and average: smoother edges, but four times slower."
    ):
        html.Span("Smooth edges", classes="flowtex-label")
        switch("Smooth edges", key("out_smooth"))
    with row("annotations", "Add legend, scale bar, time and name."):
        html.Span("Annotations", classes="flowtex-label")
        switch("Annotations", key("out_annotations"))
    with row("seconds", "Length of the movie, and pictures per second.", v_if=(movie,)):
        html.Span("Seconds, rate", classes="flowtex-label")
        with html.Span(classes="flowtex-range"):
            number("Seconds", key("out_seconds"), 0.1, 600)
            number("Pictures per second", key("out_fps"), 1, 60)
    progress, file = key("out_progress"), key("out_file")
    with html.Div(classes="flowtex-row", v_if=(f"{progress} === null",)):
        html.Button("Make it", click=controllers.sharing.start, classes="flowtex-action")
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
        html.Button("Cancel", click=controllers.sharing.cancel, classes="flowtex-link")


def _share(controllers: Controllers) -> None:
    """Put the link and the lines of Python into the group that is open."""
    key = controllers.context.state.key
    with html.Div(classes="flowtex-row"):
        html.Button(
            "Describe what is shown", click=controllers.sharing.show_state, classes="flowtex-action"
        )
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
