"""Scalar bars as large as their texts, side by side at the bottom of a view."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkTextProperty, vtkTextRenderer

#: A scalar bar at the left border of the picture.
SCALAR_BAR: dict[str, Any] = {
    "fmt": "%.3g",
    "n_labels": 3,
    "vertical": True,  # labels of a level bar would hang over its ends
    "width": 0.08,
    "height": 0.28,
    "position_x": 0.02,
    "position_y": 0.04,
    "color": "black",
    "title_font_size": 16,
    "label_font_size": 14,
    "unconstrained_font_size": True,
}
#: Arguments by which users set the position or size of a bar.
BY_HAND = (
    *("width", "height", "position_x", "position_y", "vertical", "interactive"),
    *("title_font_size", "label_font_size"),
)
#: Arguments by which users set the background of a bar, and the default plate behind its texts:
#: one behind the whole bar would cover as much as the title is wide.
BEHIND, PLATE, OPACITY = ("fill", "background_color", "color"), (1.0, 1.0, 1.0), 0.8
#: Height of the text: a share of the view's, within limits in points; a title's is larger.
TEXT_SHARE, LEAST_TEXT, MOST_TEXT, TITLE_SHARE = 1 / 34, 10, 14, 1.15
#: Height of a bar without its title: a share of the view's, and at least this many lines.
HEIGHT_SHARE, LEAST_LINES = 0.28, 5
#: Lengths in heights of the text: the width of the colours, and the room around texts.
THICKNESS, PAD = 1.1, 0.4
#: Points in an inch.
POINTS = 72
#: Name of the bars that are arranged.
NAME = "flowtex"


def arrange_with(
    bar: vtkScalarBarActor, renderer: Any, options: Mapping[str, Any]
) -> Callable[[], None]:
    """Place a bar beside the others of a renderer whenever it draws, unless options place it.

    Returns a function that ends this.
    """
    if not any(name in options for name in BEHIND):
        for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
            text.SetBackgroundColor(*PLATE)
            text.SetBackgroundOpacity(OPACITY)
    if any(name in options for name in BY_HAND):
        return lambda: None
    bar.SetObjectName(NAME)
    observer = renderer.AddObserver("StartEvent", lambda caller, _: _arrange(caller))
    return lambda: renderer.RemoveObserver(observer)


def _arrange(renderer: Any) -> None:
    """Place bars from left to right, and in a row above where there is no room."""
    width, height = renderer.GetSize()
    dpi = renderer.GetRenderWindow().GetDPI()
    x = y = row = 0.0
    for bar in renderer.GetViewProps():
        if bar.GetObjectName() != NAME:
            continue
        points = min(max(height * TEXT_SHARE * POINTS / dpi, LEAST_TEXT), MOST_TEXT)
        wide, high, title = _fit(bar, points, (width, height), dpi)
        line = points * dpi / POINTS
        gap = PAD * line
        if x and x + wide + 2 * gap > width:
            x, y, row = 0.0, y + row + gap, 0.0
        # The lowest label hangs over the end of the bar.
        bar.SetPosition((x + gap) / width, (y + gap + line / 2) / height)
        bar.SetWidth(wide / width)
        bar.SetHeight((high + title) / height)
        # VTK keeps room for the title in the bar, and yet writes it above.
        x, row = x + gap + wide, max(row, high + 2 * title + line / 2)


def _fit(
    bar: vtkScalarBarActor, points: float, view: tuple[int, int], dpi: int
) -> tuple[float, float, float]:
    """Set the sizes of a bar's texts; return its width, its height, and that of the title."""
    title, labels = bar.GetTitleTextProperty(), bar.GetLabelTextProperty()
    labels.SetFontSize(round(points))
    title.SetFontSize(round(TITLE_SHARE * points))
    em = points * dpi / POINTS
    pad = round(PAD * em)
    room = view[0] - 6 * pad
    title_width, title_height = _size(title, bar.GetTitle(), dpi)
    if title_width > room:
        title.SetFontSize(max(int(title.GetFontSize() * room / title_width), 1))
        title_width, title_height = _size(title, bar.GetTitle(), dpi)
    low, high = bar.GetLookupTable().GetRange()
    form = bar.GetLabelFormat()
    texts = [form % v if "%" in form else form.format(v) for v in (low, (low + high) / 2, high)]
    label_width = max(_size(labels, text, dpi)[0] for text in texts)
    thick = THICKNESS * em
    bar_width = max(title_width, thick + label_width + 2 * pad) + 2 * pad
    bar.SetTextPad(pad)
    bar.SetBarRatio(thick / bar_width)
    return bar_width, max(HEIGHT_SHARE * view[1], LEAST_LINES * em), title_height


def _size(text: vtkTextProperty, words: str, dpi: int) -> tuple[int, int]:
    """Return the width and height of a text in pixels."""
    box = [0, 0, 0, 0]
    vtkTextRenderer.GetInstance().GetBoundingBox(text, words, box, dpi)
    return box[1] - box[0] + 1, box[3] - box[2] + 1
