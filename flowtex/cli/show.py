"""``flowtex demo`` and ``flowtex show``: flows in a window, or on a page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from flowtex import examples
from flowtex.cli.commands import begin, serve_library, serve_processes
from flowtex.cli.console import drawing, load_field
from flowtex.cli.options import (
    FLAT,
    SIZE,
    FieldFlags,
    LookFlags,
    ServeFlags,
    SettingFlags,
    UsageError,
    arguments,
    pixels,
)
from flowtex.examples import NAMES
from flowtex.field.earth.projection import GLOBE, map_name
from flowtex.field.formula.make import KNOWN
from flowtex.field.options import OF_EARTH, OF_UNITS

if TYPE_CHECKING:
    from flowtex.app import Library
    from flowtex.field import FlowField
    from flowtex.sources.open_source import MeshSource

#: Initial zoom and focus of examples.
FIRST_LOOKS: dict[str, tuple[float, tuple[float, ...] | None]] = {
    "cylinder": (3.2, (4.0, 0.0)),
    "airfoil": (6.0, (0.5, 0.0)),
}
#: Options that change the field of a file; the others choose a part of it.
FIELD_OPTIONS = (
    *("slice", "contour", "periodic", "time", "sign_free", "preference"),
    *(*OF_EARTH, "mask", "components", *OF_UNITS),
)

FILE = Annotated[
    Path,
    Parameter(help="Files that PyVista reads, PLOT3D or data of the Earth; or one folder of them."),
]


def demo(
    *,
    example: Annotated[str, Parameter(help=f"Which flow: {', '.join(NAMES)}.")] = "cylinder",
    page: Annotated[ServeFlags | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Show the examples on a page in the browser.

    Raises
    ------
    UsageError
        When no example has this name.
    """
    if example not in NAMES:
        raise UsageError(
            f"the example {example!r} does not exist; expected one of {', '.join(NAMES)}"
        )
    options = drawing(settings)
    from flowtex.rendering import diagnostics

    diagnostics.begin_trial()
    begin()
    diagnostics.require_opengl()
    if serve_processes(page):
        return 0
    from flowtex.app import Library
    from flowtex.field.formula.make import formula

    openers = {}
    for name in dict.fromkeys((example, *NAMES)):  # the first of them is shown first
        make = getattr(examples, f"{name}_field")
        openers[name.replace("_", " ")] = partial(_source, make)
    for name in KNOWN:
        openers[name.replace("_", " ")] = partial(_source, partial(formula, name))
    library = Library(openers, looks=FIRST_LOOKS, typed=True)
    zoom, focus = FIRST_LOOKS.get(example, (1.0, None))
    return serve_library(library, page, {**options, "zoom": zoom, "focus": focus})


def _source(make: Callable[[], FlowField]) -> MeshSource:
    from flowtex.sources.open_source import MeshSource

    return MeshSource(make())


def show(
    *files: FILE,
    flow: Annotated[FieldFlags | None, FLAT] = None,
    look: Annotated[LookFlags | None, FLAT] = None,
    size: SIZE = "1024x768",
    page: Annotated[ServeFlags | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Show a file in a window, or on a page if there is no display.

    Several files, or a folder, are shown on a page with a list of files.
    """
    choice = arguments(flow)
    options = drawing(look, settings)
    window = pixels(size)
    from flowtex.rendering import diagnostics

    on_page = page is not None or not diagnostics.has_display()
    on_page = on_page or not (len(files) == 1 or _belong_together(files)) or _is_folder(files[0])
    if on_page:
        begin()
    diagnostics.require_opengl()
    if on_page:
        return _show_page(files, choice, page, options)
    field = load_field(files, choice)
    from flowtex import show as show_window

    show_window(field, size=window, **options)
    return 0


def _show_page(
    files: tuple[Path, ...],
    choice: dict[str, Any],
    page: ServeFlags | None,
    options: dict[str, Any],
) -> int:
    """Serve a page of files; return the exit code."""
    if not files:
        raise UsageError("no file is given; name a file or a folder, or try `flowtex demo`")
    for name, group in (("background", "Colours"), ("beside", "View")):
        if name in options:
            raise UsageError(
                f"--{name} is for pictures and windows; on the page it is a control under {group}"
            )
    if serve_processes(page):
        return 0
    from flowtex.app import Library
    from flowtex.pyramid.source import has_parts

    is_store = len(files) == 1 and has_parts(files[0])
    is_one_flow = _belong_together(files) or (len(files) == 1 and not _is_folder(files[0]))
    if is_one_flow and not is_store:
        library = Library.of(list(files))
        part = _part_of(library, choice)
        if part is not None:
            return serve_library(library, page, {**options, **part})
    if is_store or is_one_flow:
        return serve_library(Library.of(load_field(files, choice)), page, options)
    for name in FIELD_OPTIONS:
        if name in choice:
            raise UsageError(
                f"--{name.replace('_', '-')} can be used with one file, not with several files or "
                "a folder"
            )
    return serve_library(Library.of(*files), page, {**options, **choice})


def _part_of(library: Library, choice: dict[str, Any]) -> dict[str, Any] | None:
    """Return the part of a file that options choose, as values of the controls of the page.

    Returns ``None`` if no control chooses it, such as a flow on an oblique plane.
    """
    part = dict(choice)
    given = []
    for name in FIELD_OPTIONS:
        if name in choice:
            given.append(name)
    if not given:
        return part
    if not {"slice", "projection", "globe"}.issuperset(given):
        return None
    source = library.source(library.names[0])
    if "slice" in part:
        plane = source.part(part.get("block")).plane_of(str(part.pop("slice")))
        if plane is None or "plane" in choice:
            return None
        part["plane"] = plane
    projection = map_name(str(part.pop("projection", "")))
    if part.pop("globe", False):
        projection = projection or GLOBE
    if projection:
        if projection not in source.blocks or "block" in choice:
            return None
        part["block"] = projection
    return part


def _is_folder(path: Path) -> bool:
    from flowtex.sources.inspection.foam_files import case_of
    from flowtex.sources.opening.dataset_files import is_dataset_file

    return path.is_dir() and not is_dataset_file(path) and case_of(path) is None


def _belong_together(files: Sequence[Path]) -> bool:
    from flowtex.sources.opening.dataset_files import belong_together, dataset_paths

    return len(files) > 1 and bool(dataset_paths(files)) and belong_together(files)
