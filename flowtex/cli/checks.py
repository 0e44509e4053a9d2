"""Checks before anything is drawn; each error names the remedy."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from flowtex._util.arguments import checked_target
from flowtex._util.extras import install_extra
from flowtex.cli.options import UsageError, arguments
from flowtex.scene.options import Options
from flowtex.textures.images import load_image


def check_picture_file(output: Path) -> None:
    """Raise an error if the picture could not be written, before anything is drawn."""
    from PIL import Image

    Image.init()
    suffixes = {suffix for suffix, kind in Image.EXTENSION.items() if kind in Image.SAVE}
    if output.suffix.lower() not in suffixes:
        suffix = output.suffix
        fault = f"{suffix!r} is not a picture format" if suffix else "the file name has no suffix"
        msg = f"{output}: {fault}; expected .png, .jpg, .webp or .tiff"
        raise UsageError(msg)
    checked_target(output)


def check_page_file(output: Path) -> None:
    """Raise an error if the page could not be written, before anything is traced."""
    from flowtex.web.export import SUFFIXES

    if output.suffix.lower() not in SUFFIXES:
        msg = f"{output}: expected a name that ends in {', '.join(SUFFIXES)}"
        raise UsageError(msg)
    checked_target(output)


def check_movie_file(output: Path, size: tuple[int, int], fps: float | None, quality: int) -> None:
    """Raise an error if the movie could not be written, before anything is drawn."""
    from flowtex.plotting.offscreen.encoders import check_movie, default_fps

    try:
        check_movie(output, size, default_fps(output) if fps is None else fps, quality)
    except ModuleNotFoundError as error:
        raise UsageError(str(error)) from error


def drawing(*groups: object) -> dict[str, Any]:
    """Return the drawing options of flags; raise an error if they conflict."""
    values = arguments(*groups)
    if values.get("noise") == "image" and "image" not in values:
        msg = "--noise is image but no image is given; add --image FILE"
        raise UsageError(msg)
    options = Options.split("appearance", "view", **values)
    options.make_settings()
    if options.appearance.image is not None:
        load_image(options.appearance.image)
    return values


def check_lines(choice: Mapping[str, Any], values: Mapping[str, Any]) -> None:
    """Raise an error for pathlines of a single time."""
    if "time" in choice and values.get("lines") == "pathlines":
        msg = "--lines is pathlines, which need all times; omit --time, or use flowtex render"
        raise UsageError(msg)


def require_app() -> None:
    """Raise an error if a package that pages need is not installed."""
    packages = ("trame", "trame_vuetify", "trame_rca")
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    if missing:
        msg = (
            f"the page needs {', '.join(missing)}, which is not installed. To install it:\n  "
            f"{install_extra('app')}"
        )
        raise UsageError(msg)


@contextmanager
def writing(output: object) -> Iterator[None]:
    """Turn errors of the disk into one that names the file."""
    try:
        yield
    except OSError as error:
        msg = f"{output}: cannot be written ({error.strerror or error})"
        raise UsageError(msg) from error
