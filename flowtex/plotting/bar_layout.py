"""Places, sizes and texts of the colour bars of a plotter.

What users give of a bar is kept. The rest follows from the view: bars with a free position stand
in rows from the lower left corner, and their boxes are as large as their texts need.
"""

from __future__ import annotations

import inspect
import math
import weakref
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkTextProperty, vtkTextRenderer

from flowtex._util.arguments import brief
from flowtex._util.colours import is_light
from flowtex.errors import FieldError
from flowtex.rendering.vtk.frame import FrameSteps, Step
from flowtex.scene.annotations import OPACITY, round_values

#: Arguments of every bar before it is placed.
DEFAULTS: dict[str, Any] = {
    "fmt": "%.10g",  # of round numbers
    "title_font_size": 16,
    "label_font_size": 14,
    "unconstrained_font_size": True,
}
#: First place of a vertical bar, at the left border, as tall as those of PyVista.
VERTICAL = {"width": 0.08, "height": 0.45, "position_x": 0.02, "position_y": 0.04}
#: First place of a horizontal bar, as in PyVista's theme.
HORIZONTAL = {"width": 0.6, "height": 0.08, "position_x": 0.35, "position_y": 0.05}
#: Arguments of PyVista's bars that flows set themselves.
OWN_ARGUMENTS = ("mapper", "lookup_table", "cmap", "clim", "render", "unique_bar", "theme")
#: Arguments by which users set the background of a bar. The default are plates behind its texts:
#: one behind the whole bar would cover as much as the title is wide.
BEHIND = ("fill", "background_color", "color")
TEXT_SHARE = 1 / 40  #: Height of the text as a share of the view's.
TEXT_POINTS = (10, 18)  #: Limits of the height of the text, in points.
LEAST_TITLE = 6  #: Least height of a title that is narrowed to fit into the view, in points.
TITLE_SHARE = 1.15  #: Height of a title over that of the text.
HEIGHT_SHARE = VERTICAL["height"]  #: Height of a vertical bar without its title.
LEAST_LINES = 5  #: Least height of a vertical bar without its title, in lines of text.
THICKNESS = 1.6  #: Width of the colours, in heights of the text.
TEXT_PAD = 0.4  #: Room around texts, in heights of the text.
BAR_RATIO = 0.375  #: Share of the colours in a box with a size of the user's, VTK's default.
#: Share of a line by which the title of a horizontal bar is higher than VTK writes it, which is
#: into the labels.
TITLE_RAISE = 0.6
#: Arguments with the texts at the ends of a bar, for values beyond its range.
END_LABELS = ("below_label", "above_label")
END_LINE = 1.5  #: Length of the line from an end to its text, in heights of the text.
POINTS = 72  #: Points in an inch.
MOST_DIGITS = 10  #: Most digits of a label.
#: Bars that are drawn here with the arguments of users, ``None`` for those that PyVista has made
#: and that keep their place and labels.
_options: weakref.WeakKeyDictionary[Any, Mapping[str, Any] | None] = weakref.WeakKeyDictionary()


class Box(NamedTuple):
    """Sizes of a bar in pixels: its box, and how far its texts extend beyond the box."""

    width: float
    height: float
    left: float
    right: float
    above: float
    below: float


class Texts(NamedTuple):
    """Sizes of the texts of a bar in pixels."""

    em: float  #: Height of a label.
    pad: int  #: Room around texts.
    title_width: float
    title_height: float
    label_width: float  #: Width of the longest label.
    end_width: float  #: Width of the longest text beside a swatch of its own, with its line.
    end_rows: int  #: Rows of these texts below a horizontal bar.


def checked_bar_options(options: Mapping[str, Any] | None) -> dict[str, Any]:
    """Return the arguments for a bar that are given, without those that are ``None``.

    Raises
    ------
    FieldError
        If ``plotter.add_scalar_bar`` has no such argument, flowtex sets it, or it is no dict.
    """
    parameters = inspect.signature(pv.Plotter.add_scalar_bar).parameters
    known = [name for name in parameters if name not in ("self", *OWN_ARGUMENTS)]
    given: dict[str, Any] = {}
    if options is None:
        return given
    if not isinstance(options, Mapping):
        raise FieldError(
            f"scalar_bar_args is {brief(options)}; expected a dict of arguments of "
            "plotter.add_scalar_bar, such as {'title': 'speed', 'n_labels': 3}"
        )
    for name, value in options.items():
        if name not in known:
            raise FieldError(
                f"scalar_bar_args has {name!r}; expected some of {', '.join(known)}. The colours "
                "are arguments of the flow, such as cmap and clim"
            )
        if value is not None:
            given[name] = value
    return given


def first_arguments(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments with which PyVista makes a bar: the user's ones, else defaults."""
    if is_vertical(options):
        place = VERTICAL
    else:
        place = HORIZONTAL
    return {"vertical": True, **DEFAULTS, **place, **options}


def is_vertical(options: Mapping[str, Any]) -> bool:
    """Return whether a bar is vertical; labels of a horizontal one would hang over its ends."""
    return bool(options.get("vertical", True))


def place_bar(bar: vtkScalarBarActor, renderer: Any, options: Mapping[str, Any] | None) -> None:
    """Place a bar before each frame of its renderer; one that PyVista has made has no options."""
    _options.setdefault(bar, options)
    FrameSteps.of(renderer).add(Step.BARS, _arrange)


def _arrange(renderer: Any) -> None:
    """Place bars from left to right, and in a row above where there is no room."""
    width, height = renderer.GetSize()
    window = renderer.GetRenderWindow()
    # In a picture that VTK draws in tiles, it enlarges texts as well.
    dpi = window.GetDPI() * window.GetTileScale()[1]
    points = float(np.clip(height * TEXT_SHARE * POINTS / dpi, *TEXT_POINTS))
    line = points * dpi / POINTS
    gap = TEXT_PAD * line
    x = y = row = 0.0
    for bar in renderer.GetViewProps():
        if bar not in _options:
            continue
        options = _options[bar]
        _colour_texts(bar, renderer.GetBackground(), options or {})
        if options is None:
            continue
        labels = _write_labels(bar, options)
        if options.get("interactive"):
            continue
        box = _fit(bar, labels, points, (width, height), dpi, options)
        if "position_x" in options or "position_y" in options:
            own_x = options.get("position_x", (gap + box.left) / width)
            own_y = options.get("position_y", (gap + line / 2 + box.below) / height)
            bar.SetPosition(own_x, own_y)
            continue
        if x and x + box.left + box.width + box.right + 2 * gap > width:
            x = 0.0
            y += row + gap
            row = 0.0
        # The lowest label hangs over the end of the bar.
        lowest = y + gap + line / 2 + box.below
        bar.SetPosition((x + gap + box.left) / width, lowest / height)
        x += gap + box.left + box.width + box.right
        row = max(row, box.below + box.height + box.above + line / 2)


def _write_labels(bar: vtkScalarBarActor, options: Mapping[str, Any]) -> list[str]:
    """Give a bar round labels, or as many as users want; return them."""
    table = bar.GetLookupTable()
    # PyVista's ``annotations`` fails where VTK has added texts at the ends.
    marks = list(map(table.GetAnnotation, range(table.GetNumberOfAnnotatedValues())))
    number = options.get("n_labels")
    if number is None:
        values = _round_labels(*table.GetRange(), log_scale=table.UsingLogScale())
        bar.SetCustomLabels(values)
        bar.UseCustomLabelsOn()
        shown = vtk_to_numpy(values)
    elif number < 1:
        return []
    else:
        shown = _even_values(table.GetRange(), number, log_scale=table.UsingLogScale())
        if "fmt" not in options:
            bar.SetLabelFormat(_format_of(shown))
    if marks:
        return marks
    form = bar.GetLabelFormat()
    if "%" in form:
        return [form % value for value in shown]
    return [form.format(value) for value in shown]


def _colour_texts(
    bar: vtkScalarBarActor, background: Sequence[float], options: Mapping[str, Any]
) -> None:
    """Make the texts of a bar readable on a background, unless users have chosen colours."""
    if not options.keys().isdisjoint(BEHIND):
        return
    ink = (1.0,) * 3
    plate = (0.0,) * 3
    if is_light(background):
        ink = (0.0,) * 3
        plate = (1.0,) * 3
    texts = bar.GetTitleTextProperty(), bar.GetLabelTextProperty(), bar.GetAnnotationTextProperty()
    for text in texts:
        text.SetColor(*ink)
        text.SetBackgroundColor(*plate)
        text.SetBackgroundOpacity(OPACITY)


@lru_cache(16)
def _round_labels(low: float, high: float, *, log_scale: bool) -> vtkDataArray:
    """Return round values within a range, or its ends, for VTK."""
    values = round_values(low, high, log_scale=log_scale, steps=(1, 2, 5, 10))
    clipped = np.clip(values, low, high)
    # A value just beyond an end would be written with all digits of the end.
    is_round = np.isclose(clipped, values, rtol=0, atol=1e-9 * (high - low))
    if is_round.sum() > 1:
        clipped = clipped[is_round]
    return numpy_to_vtk(clipped, deep=True)


def _even_values(limits: tuple[float, float], number: int, *, log_scale: bool) -> Any:
    """Return the values at which VTK writes a number of labels."""
    if log_scale:
        return np.geomspace(*limits, number)
    return np.linspace(*limits, number)


def _format_of(values: Any) -> str:
    """Return a format with enough digits to tell neighbours apart to a hundredth of a step."""
    steps = np.abs(np.diff(values))
    largest = float(np.abs(values).max())
    least = float(steps.min(initial=largest))
    if not least:
        return DEFAULTS["fmt"]
    digits = 2 + math.ceil(math.log10(largest / least) - 1e-9)
    return f"%.{min(max(digits, 3), MOST_DIGITS)}g"


def _fit(
    bar: vtkScalarBarActor,
    labels: Sequence[str],
    points: float,
    view: tuple[int, int],
    dpi: int,
    options: Mapping[str, Any],
) -> Box:
    """Set the sizes of a bar and of its texts where users give none; return those of the bar."""
    texts = _fit_texts(bar, labels, points, view[0], dpi, options)
    if is_vertical(options):
        box, ratio = _vertical_box(texts, view, options)
        bar.GetTitleTextProperty().SetLineOffset(0)
    else:
        box, ratio = _horizontal_box(texts, view, options)
        bar.GetTitleTextProperty().SetLineOffset(-TITLE_RAISE * texts.em)
    bar.SetBarRatio(min(ratio, 1.0))
    bar.SetTextPad(texts.pad)
    bar.SetWidth(options.get("width", box.width / view[0]))
    bar.SetHeight(options.get("height", box.height / view[1]))
    return box


def _fit_texts(
    bar: vtkScalarBarActor,
    labels: Sequence[str],
    points: float,
    view_width: int,
    dpi: int,
    options: Mapping[str, Any],
) -> Texts:
    """Set the fonts of a bar so that its title fits into the view; return the sizes of texts."""
    title = bar.GetTitleTextProperty()
    label = bar.GetLabelTextProperty()
    label_points = options.get("label_font_size", round(points))
    label.SetFontSize(label_points)
    bar.GetAnnotationTextProperty().SetFontSize(label_points)
    em = label_points * dpi / POINTS
    pad = round(TEXT_PAD * em)
    title.SetFontSize(options.get("title_font_size", round(TITLE_SHARE * points)))
    width, height = _size(title, bar.GetTitle(), dpi)
    room = _title_room(view_width, pad, options)
    if width > room and "title_font_size" not in options:
        title.SetFontSize(max(int(title.GetFontSize() * room / width), LEAST_TITLE))
        width, height = _size(title, bar.GetTitle(), dpi)
    label_width = 0
    for text in labels:
        label_width = max(label_width, _size(label, text, dpi)[0])
    beside = side_texts(bar, options)
    end_width = 0.0
    for text in beside:
        end_width = max(end_width, _size(label, text, dpi)[0] + END_LINE * em)
    end_rows = min(len(beside), 1)
    if bar.GetDrawNanAnnotation() and "above_label" in options:
        end_rows = 2  # VTK writes one below the other
    return Texts(em, pad, width, height, label_width, end_width, end_rows)


def side_texts(bar: vtkScalarBarActor, options: Mapping[str, Any]) -> list[str]:
    """Return the texts of swatches beyond the colours: of the ends, and of missing values."""
    texts = []
    for name in END_LABELS:
        if name in options:
            texts.append(str(options[name]))
    if bar.GetDrawNanAnnotation():
        texts.append(bar.GetNanAnnotation())
    return texts


def _title_room(view_width: int, pad: int, options: Mapping[str, Any]) -> float:
    """Return the width in pixels that a title has inside the view; it is centred on its bar."""
    if "position_x" not in options:
        return view_width - 6 * pad
    left = options["position_x"] * view_width
    if "width" not in options:
        return view_width - left - 2 * pad
    middle = left + options["width"] * view_width / 2
    return 2 * min(middle, view_width - middle)


def _vertical_box(
    texts: Texts, view: tuple[int, int], options: Mapping[str, Any]
) -> tuple[Box, float]:
    """Return the sizes of a vertical bar and the share of its colours in the width."""
    thick = THICKNESS * texts.em
    labels = texts.label_width + 2 * texts.pad
    width = max(texts.title_width, thick + labels) + 2 * texts.pad
    height = max(HEIGHT_SHARE * view[1], LEAST_LINES * texts.em) + texts.title_height
    if "position_x" in options:
        width = max(min(width, (1 - options["position_x"]) * view[0]), thick)
    if "position_y" in options:  # the title is written above
        room = (1 - options["position_y"]) * view[1] - texts.title_height
        height = max(min(height, room), LEAST_LINES * texts.em)
    ratio = thick / width
    if "width" in options:
        width = options["width"] * view[0]
        ratio = BAR_RATIO
    height = options.get("height", height / view[1]) * view[1]
    title_over = max((texts.title_width - width) / 2, 0.0)
    right = max(title_over, ratio * width + labels - width)
    left = max(title_over, texts.end_width)  # which VTK writes on the side without labels
    return Box(width, height, left, right, texts.title_height, 0.0), ratio


def _horizontal_box(
    texts: Texts, view: tuple[int, int], options: Mapping[str, Any]
) -> tuple[Box, float]:
    """Return the sizes of a horizontal bar and the share of its colours in the height."""
    label_over = texts.label_width / 2 + texts.pad  # the last one hangs over the end
    thick = THICKNESS * texts.em
    height = thick + texts.em + 3 * texts.pad
    ratio = thick / (height - 2 * texts.pad)
    room = (1 - options.get("position_x", 0.0)) * view[0] - label_over
    width = max(min(HORIZONTAL["width"] * view[0], room), LEAST_LINES * texts.em)
    if "width" in options:
        width = options["width"] * view[0]
    if "height" in options:
        height = options["height"] * view[1]
        ratio = BAR_RATIO
    sides = max((texts.title_width - width) / 2, label_over)
    top = ratio * height + 3 * texts.pad + texts.em + texts.title_height
    below = 0.0
    if texts.end_rows:
        below = (texts.end_rows + END_LINE) * texts.em
    return Box(width, height, sides, sides, max(top - height, 0.0), below), ratio


def _size(text: vtkTextProperty, words: str, dpi: int) -> tuple[int, int]:
    box = [0, 0, 0, 0]
    vtkTextRenderer.GetInstance().GetBoundingBox(text, words, box, dpi)
    return box[1] - box[0] + 1, box[3] - box[2] + 1
