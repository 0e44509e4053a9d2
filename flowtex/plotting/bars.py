"""Colour bars of a plotter: the flows and meshes that share one, and where they are placed."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from itertools import chain, count
from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkTextProperty, vtkTextRenderer

from flowtex._util.array_types import Bytes
from flowtex._util.colours import ZERO_SHARE, is_light, rounded_ends
from flowtex.rendering.vtk.flow_mapper import Ends, FlowMapper, NormTable
from flowtex.scene.annotations import OPACITY, round_values

#: A bar at the left border of the window, as tall as those of PyVista.
SCALAR_BAR: dict[str, Any] = {
    "fmt": "%.10g",  # of round numbers
    "vertical": True,  # labels of a level bar would hang over its ends
    "width": 0.08,
    "height": 0.45,
    "position_x": 0.02,
    "position_y": 0.04,
    "title_font_size": 16,
    "label_font_size": 14,
    "unconstrained_font_size": True,
}
#: Arguments by which users set the position or size of a bar.
BY_HAND = (
    *("width", "height", "position_x", "position_y", "vertical", "interactive"),
    *("title_font_size", "label_font_size"),
)
#: Arguments by which users set the background of a bar. The default are plates behind its texts:
#: one behind the whole bar would cover as much as the title is wide.
BEHIND = ("fill", "background_color", "color")
#: Arguments of a bar that PyVista has made: it keeps its place and its labels.
AS_IT_IS = {"position_x": None, "n_labels": None}
TEXT_SHARE = 1 / 40  #: Height of the text as a share of the view's.
TEXT_POINTS = (10, 18)  #: Limits of the height of the text, in points.
TITLE_SHARE = 1.15  #: Height of a title over that of the text.
HEIGHT_SHARE = 0.45  #: Height of a bar without its title, as a share of the view's.
LEAST_LINES = 5  #: Least height of a bar without its title, in lines of text.
THICKNESS = 1.6  #: Width of the colours, in heights of the text.
TEXT_PAD = 0.4  #: Room around texts, in heights of the text.
COMPARED = 64  #: Number of colours by which maps are compared.
SAME_BYTES = 4  #: Difference of bytes up to which two colours are one.
POINTS = 72  #: Points in an inch.
#: Bars that are drawn here, with the arguments of users, and renderers that have some.
_options: weakref.WeakKeyDictionary[Any, Mapping[str, Any]] = weakref.WeakKeyDictionary()
_renderers: weakref.WeakSet[Any] = weakref.WeakSet()


class FlowBar:
    """The colour bar of one flow, which others with the same title and colours share.

    All of them have one range, that of all their values, as PyVista's meshes have it.
    """

    def __init__(self, plotter: Any, mapper: FlowMapper, options: Mapping[str, Any]) -> None:
        self._bars, self._plotter, self._mapper = plotter.scalar_bars, plotter, mapper
        self._options = options
        self._renderer, self._place = plotter.renderer, plotter.renderers.active_index
        self.key: str | None = None  #: Key among the bars of the plotter; ``None`` without a bar.
        self._names = ("", "")
        self._shown: tuple[Any, ...] = ()

    @property
    def _sharing(self) -> list[Any]:
        """Mappers that share the bar, also those of PyVista's meshes."""
        sharing: list[Any] = self._bars._scalar_bar_mappers.get(self.key, [])
        return sharing

    def show(self, name: str, title: str) -> None:
        """Show the colours of a scalar, in the bar of others or in one of its own."""
        arguments = {**SCALAR_BAR, **self._options}
        if "title" in arguments:
            name = title = arguments.pop("title")
        if self._names == (name, title) and self._mapper in self._sharing:
            return
        self.remove()
        self._names = name, title
        keys = chain([name], (f"{name} {n}" for n in count(2)))
        self.key = next(key for key in keys if key not in self._bars or self._fits(key, title))
        renderers = self._plotter.renderers
        active = renderers.active_index
        renderers.set_active_renderer(*np.atleast_1d(renderers.index_to_loc(self._place)))
        # With a mapper, PyVista joins the ranges of all.
        arguments |= {"title": self.key, "mapper": self._mapper, "render": False}
        self._plotter.add_scalar_bar(**arguments)
        renderers.set_active_renderer(*np.atleast_1d(renderers.index_to_loc(active)))
        bar = self._bars[self.key]
        bar.SetTitle(title)
        _options.setdefault(bar, self._options if len(self._sharing) == 1 else AS_IT_IS)
        if self._renderer not in _renderers:
            _renderers.add(self._renderer)
            self._renderer.AddObserver("StartEvent", lambda caller, _: _arrange(caller))

    def _fits(self, key: str, title: str) -> bool:
        """Return whether a bar has the same title and colours, in the same renderer."""
        bar = self._bars[key]
        return (
            bar.GetTitle() in (title, key)  # which PyVista takes as the title
            and bool(self._renderer.HasViewProp(bar))
            and all(_same_colours(self._mapper, m) for m in self._bars._scalar_bar_mappers[key])
        )

    def set_range(self, limits: tuple[float, float] | None) -> None:
        """Give all that share the bar these limits, or those of all of them."""
        sharing = self._sharing or [self._mapper]
        if limits is None:
            lows, highs = zip(*(_ends(mapper).limits for mapper in sharing), strict=True)
            limits = min(lows), max(highs)
        for mapper in sharing:
            mapper.scalar_range = limits
        if self.key in self._bars:
            self._bars._scalar_bar_ranges[self.key] = limits

    def look(self, colours: Callable[[], Bytes], settings: object) -> None:
        """Follow changes of what shares the bar; ``colours`` are the picture's with settings."""
        sharing = self._sharing
        if self._mapper not in sharing:  # a user has removed the bar
            self.key = None
            return
        flows = [mapper for mapper in sharing if isinstance(mapper, FlowMapper)]
        bar, limits = self._bars[self.key], self._mapper.scalar_range
        shown = (bar.GetLookupTable(), limits, len(sharing), self._mapper.ends, settings)
        if flows[0] is not self._mapper or shown == self._shown:
            return
        own = self._mapper.lookup_table
        log_scale, is_mixed = own.log_scale, len(flows) < len(sharing)
        table = pv.LookupTable(values=own.values if is_mixed else colours())
        table.scalar_range, table.log_scale = rounded_ends(*limits, log_scale=log_scale), log_scale
        if isinstance(own, NormTable):  # along its bar are places, with the values as texts
            table.scalar_range, table.annotations = (0.0, 1.0), own.marks
        bar.SetLookupTable(table)
        self._shown = (table, *shown[1:])
        lows, highs = zip(*(_ends(mapper).values for mapper in sharing), strict=True)
        rounding = ZERO_SHARE * (max(highs) - min(lows))
        below, above = limits[0] > min(lows) + rounding, limits[1] < max(highs) - rounding
        ends = own.below_range_color, own.above_range_color
        table.below_range_color = (ends[0] or table.values[0]) if below else None
        table.above_range_color = (ends[1] or table.values[-1]) if above else None
        bar.SetDrawBelowRangeSwatch(below)
        bar.SetDrawAboveRangeSwatch(above)
        # Others are marks without a text; VTK writes them on the side without labels.
        has_marks = isinstance(own, NormTable)
        bar.SetDrawAnnotations(has_marks)
        bar.SetDrawTickLabels(not has_marks)
        bar.SetTextPosition(int(not has_marks))

    def remove(self) -> None:
        """Leave the bar, and remove it if no other shares it."""
        key, self.key = self.key, None
        sharing = self._bars._scalar_bar_mappers.get(key, [])
        if self._mapper in sharing:
            sharing.remove(self._mapper)
        if key in self._bars and not sharing:
            self._plotter.remove_scalar_bar(key, render=False)


def _ends(mapper: Any) -> Ends:
    """Return the limits that a flow has without others and the range of its values."""
    shown = mapper.scalar_range
    return mapper.ends if isinstance(mapper, FlowMapper) else Ends(shown, shown)


def _same_colours(one: Any, other: Any) -> bool:
    """Return whether two mappers have the same colour map, however many entries it has."""
    tables = [mapper.lookup_table for mapper in (one, other)]
    if one is other or any(type(table) is not pv.LookupTable for table in tables):
        return one is other
    first, second = (
        np.asarray(table.values, dtype=int)[np.arange(COMPARED) * table.n_values // COMPARED]
        for table in tables
    )
    same = tables[0].log_scale == tables[1].log_scale
    return same and bool((np.abs(first - second) <= SAME_BYTES).all())


def _arrange(renderer: Any) -> None:
    """Place bars from left to right, and in a row above where there is no room."""
    width, height = renderer.GetSize()
    dpi = renderer.GetRenderWindow().GetDPI()
    x = y = row = 0.0
    for bar in renderer.GetViewProps():
        if (options := _options.get(bar)) is None:
            continue
        labels = _write_labels(bar, renderer.GetBackground(), options)
        if any(name in options for name in BY_HAND):
            continue
        points = float(np.clip(height * TEXT_SHARE * POINTS / dpi, *TEXT_POINTS))
        wide, high, title = _fit(bar, labels, points, (width, height), dpi)
        line = points * dpi / POINTS
        gap = TEXT_PAD * line
        if x and x + wide + 2 * gap > width:
            x, y, row = 0.0, y + row + gap, 0.0
        # The lowest label hangs over the end of the bar.
        bar.SetPosition((x + gap) / width, (y + gap + line / 2) / height)
        bar.SetWidth(wide / width)
        bar.SetHeight((high + title) / height)
        # VTK keeps room for the title in the bar, and yet writes it above.
        x, row = x + gap + wide, max(row, high + 2 * title + line / 2)


def _write_labels(
    bar: vtkScalarBarActor, background: Sequence[float], options: Mapping[str, Any]
) -> list[str]:
    """Give a bar round labels, readable on a background; return them."""
    ink, plate = ((0.0,) * 3, (1.0,) * 3) if is_light(background) else ((1.0,) * 3, (0.0,) * 3)
    texts = bar.GetTitleTextProperty(), bar.GetLabelTextProperty(), bar.GetAnnotationTextProperty()
    for text in texts:
        if not any(name in options for name in BEHIND):
            text.SetColor(*ink)
            text.SetBackgroundColor(*plate)
            text.SetBackgroundOpacity(OPACITY)
    table = bar.GetLookupTable()
    values = _round_labels(*table.GetRange(), log_scale=table.UsingLogScale())
    if "n_labels" not in options:
        bar.SetCustomLabels(values)
        bar.UseCustomLabelsOn()
    form, marks = bar.GetLabelFormat(), list(table.annotations.values())
    if marks:
        return marks
    return [form % v if "%" in form else form.format(v) for v in vtk_to_numpy(values)]


@lru_cache(16)
def _round_labels(low: float, high: float, *, log_scale: bool) -> vtkDataArray:
    values = round_values(low, high, log_scale=log_scale, steps=(1, 2, 5, 10))
    clipped = np.clip(values, low, high)
    # A value just beyond an end would be written with all digits of the end.
    is_round = np.isclose(clipped, values, rtol=0, atol=1e-9 * (high - low))
    return numpy_to_vtk(clipped[is_round] if is_round.sum() > 1 else clipped, deep=True)


def _fit(
    bar: vtkScalarBarActor, labels: Sequence[str], points: float, view: tuple[int, int], dpi: int
) -> tuple[float, float, float]:
    """Set the sizes of a bar's texts; return its width, its height, and that of the title."""
    title, label = bar.GetTitleTextProperty(), bar.GetLabelTextProperty()
    label.SetFontSize(round(points))
    bar.GetAnnotationTextProperty().SetFontSize(round(points))
    title.SetFontSize(round(TITLE_SHARE * points))
    em = points * dpi / POINTS
    pad = round(TEXT_PAD * em)
    room = view[0] - 6 * pad
    title_width, title_height = _size(title, bar.GetTitle(), dpi)
    if title_width > room:
        title.SetFontSize(max(int(title.GetFontSize() * room / title_width), 1))
        title_width, title_height = _size(title, bar.GetTitle(), dpi)
    label_width = max(_size(label, text, dpi)[0] for text in labels)
    thick = THICKNESS * em
    bar_width = max(title_width, thick + label_width + 2 * pad) + 2 * pad
    bar.SetTextPad(pad)
    bar.SetBarRatio(thick / bar_width)
    return bar_width, max(HEIGHT_SHARE * view[1], LEAST_LINES * em), title_height


def _size(text: vtkTextProperty, words: str, dpi: int) -> tuple[int, int]:
    box = [0, 0, 0, 0]
    vtkTextRenderer.GetInstance().GetBoundingBox(text, words, box, dpi)
    return box[1] - box[0] + 1, box[3] - box[2] + 1
