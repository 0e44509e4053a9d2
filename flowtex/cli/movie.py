"""``flowtex movie``: a file as a movie."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from flowtex.cli.checks import check_colours, check_film, check_image, need_opengl
from flowtex.cli.console import nodes, say
from flowtex.cli.options import (
    FILE,
    FLAT,
    PICTURE,
    FieldOptions,
    FrameOptions,
    SettingFlags,
    UsageError,
    given,
    read,
)

__all__ = ["movie"]


def movie(
    file: FILE,
    /,
    *,
    output: Annotated[
        Path, Parameter(name=["--output", "-o"], help="File to write: .mp4, .gif or .webp.")
    ],
    seconds: Annotated[
        float | None,
        Parameter(group=PICTURE, help="Length; a steady flow begins again after as many."),
    ] = None,
    fps: Annotated[
        float | None,
        Parameter(group=PICTURE, help="Frames in a second. [default: 30, and 20 in a GIF]"),
    ] = None,
    quality: Annotated[
        int, Parameter(group=PICTURE, help="1 to 100: the more, the truer and the larger.")
    ] = 80,
    which: Annotated[FieldOptions | None, FLAT] = None,
    draw: Annotated[FrameOptions | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Write a file as a movie: a loop without a seam, or all times of a flow that varies."""
    started = time.perf_counter()
    draw = draw or FrameOptions()
    options, size = {**draw.look(), **given(settings)}, draw.pixels()
    check_film(output, size, fps, quality)
    check_image(options)
    need_opengl()
    field = read(file, which)
    check_colours(field, options)
    from flowtex.offscreen import movie as movies

    try:
        made = movies.movie(
            field, output, size=size, seconds=seconds, fps=fps, quality=quality, **options
        )
    except OSError as error:
        msg = f"{output}: cannot be written ({error.strerror or error})"
        raise UsageError(msg) from error
    loop = ", a loop without a seam" if made.closed else ""
    say(
        f"[bold]{output}[/]  {field.name}, {nodes(field)}{loop}  "
        f"[dim]{size[0]} × {size[1]}, {made.frames} frames in {made.seconds:g} s, "
        f"{made.nbytes / 1e6:.1f} MB, {time.perf_counter() - started:.1f} s[/]"
    )
    return 0
