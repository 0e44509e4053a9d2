"""``flowtex render``, ``movie``, ``export`` and ``formula``: a picture, a movie or a page."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from flowtex._util.array_types import AnyArray
from flowtex._util.whole_file import whole_file
from flowtex.cli.console import (
    check_picture_file,
    describe,
    drawing,
    load_field,
    report,
    writing,
)
from flowtex.cli.options import (
    FILE,
    FLAT,
    PICTURE,
    FieldFlags,
    FrameFlags,
    LookFlags,
    SettingFlags,
    UsageError,
    arguments,
    pixels,
)

#: Share of the flow that may leave the surface before the message has it.
NOTABLE_LOSS = 0.01


def render(
    *files: FILE,
    output: Annotated[
        Path,
        Parameter(name=["--output", "-o"], help="Picture to write; the suffix sets the format."),
    ],
    clock: Annotated[
        float, Parameter(group=PICTURE, help="Time of the streaming (--motion), in seconds.")
    ] = 0.0,
    flow: Annotated[FieldFlags | None, FLAT] = None,
    look: Annotated[LookFlags | None, FLAT] = None,
    frame: Annotated[FrameFlags | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Draw a file as a picture."""
    start = time.perf_counter()
    choice = arguments(flow)
    options = _drawing(look, frame or FrameFlags(), settings)
    check_picture_file(output)
    from flowtex.rendering import diagnostics

    diagnostics.begin_trial()
    shown: dict[str, Any] = {"clock": clock}
    if options.get("lines") == "pathlines" and "time" in choice:
        # Pathlines of a moment go through the times around it.
        shown["time"] = choice.pop("time")
    field = load_field(files, choice)
    diagnostics.require_opengl()
    from flowtex import render as draw

    write_picture(draw(field, **shown, **options), output)
    share = field.normal_share
    if share > NOTABLE_LOSS:
        lost = f", {share:.0%} of the flow is normal to the surface"
    else:
        lost = ""
    seconds = time.perf_counter() - start
    report(output, f"{describe(field)}{lost}", f"{_size(options)}, {seconds:.1f} s")
    return 0


def movie(
    *files: FILE,
    output: Annotated[
        Path, Parameter(name=["--output", "-o"], help="File to write: .mp4, .gif or .webp.")
    ],
    seconds: Annotated[
        float | None,
        Parameter(
            group=PICTURE,
            help="Length of the movie in seconds; a steady flow repeats after it. "
            "[default: --period for a steady flow, otherwise by the number of times, from 5 to 30]",
        ),
    ] = None,
    fps: Annotated[
        float | None,
        Parameter(group=PICTURE, help="Frames per second. [default: 30, and 20 in a GIF]"),
    ] = None,
    quality: Annotated[
        int,
        Parameter(
            group=PICTURE, help="1 to 100; higher values give better pictures and larger files."
        ),
    ] = 80,
    flow: Annotated[FieldFlags | None, FLAT] = None,
    look: Annotated[LookFlags | None, FLAT] = None,
    frame: Annotated[FrameFlags | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Write a file as a movie: a seamless loop, or all times of a time-varying flow.

    Raises
    ------
    UsageError
        When a package for the format is missing, or the file cannot be written.
    """
    start = time.perf_counter()
    choice = arguments(flow)
    options = _drawing(look, frame or FrameFlags(), settings)
    from flowtex.plotting.offscreen.encoders import check_movie, default_fps
    from flowtex.rendering import diagnostics

    try:
        check_movie(output, options["size"], default_fps(output) if fps is None else fps, quality)
    except ModuleNotFoundError as error:
        raise UsageError(str(error)) from error
    diagnostics.begin_trial()
    field = load_field(files, choice)
    diagnostics.require_opengl()
    from flowtex import movie as write_movie

    with writing(output):
        result = write_movie(field, output, seconds=seconds, fps=fps, quality=quality, **options)
    if result.closed:
        loop = ", a seamless loop"
    else:
        loop = ""
    figures = (
        f"{_size(options)}, {result.frames} frames in {result.seconds:g} s, "
        f"{result.nbytes / 1e6:.1f} MB, {time.perf_counter() - start:.1f} s"
    )
    report(output, f"{describe(field)}{loop}", figures)
    return 0


def export(
    *files: FILE,
    output: Annotated[
        Path,
        Parameter(name=["--output", "-o"], help="File to write: page.html, flow.mjs or flow.json."),
    ],
    steps: Annotated[
        int | None,
        Parameter(group=PICTURE, help="Number of time steps on the page; all by default."),
    ] = None,
    title: Annotated[
        str | None, Parameter(group=PICTURE, help="Title of the page; the file's name by default.")
    ] = None,
    store: Annotated[
        str | None, Parameter(help="Address from which browsers read the pyramid, https://… or ./…")
    ] = None,
    basemap: Annotated[
        str | None,
        Parameter(help="Address of a style of MapLibre: the flow is a layer of that web map."),
    ] = None,
    flow: Annotated[FieldFlags | None, FLAT] = None,
    look: Annotated[LookFlags | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Write a file as one HTML page that needs neither a server nor a network.

    Raises
    ------
    UsageError
        When ``--steps`` is less than 1, or the file cannot be written.
    """
    start = time.perf_counter()
    choice = arguments(flow)
    options = drawing(look, settings)
    field = load_field(files, choice)
    if steps is not None and steps < 1:
        raise UsageError(
            f"--steps is {steps}; expected 1 to {len(field.times)}, the number of steps in the file"
        )
    from flowtex.host.export import export as write_page

    with writing(output):
        options |= {"steps": steps, "title": title, "store": store, "basemap": basemap}
        page = write_page(field, output, **options)
    seconds = time.perf_counter() - start
    if page.steps == len(field.times):
        selected = ""
    else:
        selected = f", {page.steps} of them"
    report(output, f"{describe(field)}{selected}", f"{page.nbytes / 1e6:.2f} MB, {seconds:.1f} s")
    return 0


def write_picture(picture: AnyArray, output: Path) -> None:
    """Write a picture in the format of its suffix."""
    from PIL import Image

    with writing(output), whole_file(output) as file:
        Image.fromarray(picture).save(file, Image.EXTENSION[output.suffix.lower()])


def _drawing(look: LookFlags | None, frame: FrameFlags, settings: object) -> dict[str, Any]:
    return {**drawing(look, settings), **vars(frame), "size": pixels(frame.size)}


def _size(options: Mapping[str, Any]) -> str:
    width, height = options["size"]
    return f"{width} × {height}"


def formula(
    *words: Annotated[
        str,
        Parameter(
            allow_leading_hyphen=True,
            help=(
                "The rates of x and y, such as y and -sin(x); on a surface the rates of u and v, "
                "or the velocity along x, y and z. Or the name of a known formula, such as "
                "pendulum. Then ranges, x=-7,7; parameters, b=0.2, or with the range of the "
                "slider, b=0.2,0,1; surface=sphere, torus or cylinder; and the first and last "
                "time and their number, t=0,10,41."
            ),
        ),
    ],
    output: Annotated[
        Path | None, Parameter(name=["--output", "-o"], help="Page (.html) or picture to write.")
    ] = None,
    look: Annotated[LookFlags | None, FLAT] = None,
    frame: Annotated[FrameFlags | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Draw a flow from a formula: as a page, as a picture, or in a window."""
    options = drawing(look, settings)
    frame = frame or FrameFlags()
    is_page = output is not None and output.suffix.lower() in (".html", ".htm")
    if output is not None and not is_page:
        check_picture_file(output)
    from flowtex.field.formula.make import line_field

    field = line_field("; ".join(words))
    if output is None:
        from flowtex import show
        from flowtex.rendering import diagnostics

        if diagnostics.has_display():  # a page has no size
            options["size"] = pixels(frame.size)
        show(field, **options)
        return 0
    if is_page:
        from flowtex import export

        with writing(output):
            size = export(field, output, **options).nbytes
        result = f"{size / 1e6:.2f} MB"
    else:
        from flowtex import render

        write_picture(render(field, **_drawing(look, frame, settings)), output)
        result = frame.size
    report(output, describe(field), result)
    return 0
