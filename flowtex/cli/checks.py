"""Checks before anything is drawn; each error says how to mend it."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flowtex._util.extras import install_extra
from flowtex.cli.options import FieldFlags, UsageError, number_or_text

if TYPE_CHECKING:
    from flowtex.field import FlowField

__all__ = [
    "begin_opengl",
    "check_colours",
    "check_image",
    "check_lines",
    "check_movie_file",
    "check_page_file",
    "check_picture_file",
    "check_time",
    "require_app",
    "require_opengl",
]


def check_picture_file(output: Path) -> None:
    """Refuse a picture that could not be written, before anything is drawn."""
    from PIL import Image

    Image.init()
    suffixes = {suffix for suffix, kind in Image.EXTENSION.items() if kind in Image.SAVE}
    if output.suffix.lower() not in suffixes:
        what = f"{output.suffix!r} is no format" if output.suffix else "no suffix is no format"
        msg = f"{output}: {what} that pictures are written in; use .png, .jpg, .webp or .tiff"
        raise UsageError(msg)
    _check_folder(output)


def check_page_file(output: Path) -> None:
    """Refuse a page that could not be written, before anything is traced."""
    if output.suffix.lower() not in (".html", ".htm"):
        msg = f"{output}: expected a name that ends in .html, as a page has"
        raise UsageError(msg)
    _check_folder(output)


def check_movie_file(output: Path, size: tuple[int, int], fps: float | None, quality: int) -> None:
    """Refuse a movie that could not be written, before anything is drawn."""
    from flowtex.offscreen.encoders import check_movie, default_fps

    try:
        check_movie(output, size, default_fps(output) if fps is None else fps, quality)
    except ModuleNotFoundError as error:
        raise UsageError(str(error)) from error
    _check_folder(output)


def _check_folder(output: Path) -> None:
    if not output.parent.is_dir():
        msg = f"{output}: there is no folder {str(output.parent)!r}; make it, or write elsewhere"
        raise UsageError(msg)


def check_image(options: dict[str, Any]) -> None:
    """Read the picture of ``image``; refuse one that cannot be read, or that is missing."""
    if options["image"] is None:
        if options.get("noise") == "image":
            msg = "--noise is image and there is no picture; name one with --image FILE"
            raise UsageError(msg)
        return
    if options.get("noise", "image") != "image":
        msg = f"--noise is {options['noise']} and --image is given; leave out one of them"
        raise UsageError(msg)
    from flowtex.textures.images import load_image

    options["image"] = load_image(options["image"])


def check_lines(flow: FieldFlags | None, options: dict[str, Any]) -> None:
    """Refuse pathlines of one time that is read alone."""
    if flow is not None and flow.time is not None and options.get("lines") == "pathlines":
        msg = "--lines is pathlines, which need all times; leave out --time, or use flowtex render"
        raise UsageError(msg)


def check_time(field: FlowField, time: str | None) -> float | None:
    """Return a time in the field's own unit; refuse one that the file has not."""
    if time is None:
        return None
    from flowtex.field.dates import seconds_since

    first, last = field.times[0], field.times[-1]
    try:
        value = seconds_since(field.start, number_or_text(time))
    except ValueError as error:
        msg = f"--{error}"
        raise UsageError(msg) from error
    if not first <= value <= last:
        msg = f"--time is {time}; expected {first:g} to {last:g}, the times of the file"
        raise UsageError(msg)
    return value


def check_colours(field: FlowField, options: dict[str, Any]) -> None:
    """Refuse a scalar or a colour map that there is not."""
    from flowtex.field.derived import DERIVED

    names = dict.fromkeys(("speed", *field.scalars, *DERIVED))
    if options["scalars"] is not False and options["scalars"] not in names:
        msg = f"--scalars is {options['scalars']!r}; there are {', '.join(names)} and none"
        raise UsageError(msg)
    from flowtex._util.colours import colour_table, rgb

    try:
        rgb(options.get("background", "white"))
    except ValueError as error:
        msg = f"--background is {options['background']!r}; expected a colour, such as black"
        raise UsageError(msg) from error
    if options["cmap"] is None:
        return
    try:
        colour_table(options["cmap"])
    except (ValueError, KeyError, ImportError) as error:
        msg = f"--cmap is {options['cmap']!r}; expected a colour map such as viridis or cividis"
        raise UsageError(msg) from error


def begin_opengl() -> None:
    """Begin to try OpenGL, beside what is read and imported before it is needed."""
    from flowtex import diagnostics

    diagnostics.begin_trial()


def require_opengl() -> None:
    """Refuse to go on where nothing can draw."""
    from flowtex import diagnostics

    diagnostics.require_opengl()


def require_app() -> None:
    """Refuse to serve a page where what it needs is not installed."""
    packages = ("trame", "trame_vuetify", "trame_rca")
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    if missing:
        msg = (
            f"the page needs {', '.join(missing)}, not installed here. To mend it:\n"
            f"  {install_extra('app')}"
        )
        raise UsageError(msg)
