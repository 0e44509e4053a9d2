"""Colour bars of a plotter: the flows and meshes that share one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import chain, count
from typing import Any

import numpy as np
import pyvista as pv

from flowtex._util.array_types import Bytes
from flowtex._util.colours import ZERO_SHARE, rounded_ends
from flowtex.plotting.bar_layout import END_LABELS, first_arguments, place_bar
from flowtex.rendering.vtk.flow_mapper import Ends, FlowMapper, NormTable

COMPARED = 64  #: Number of colours by which maps are compared.
SAME_BYTES = 4  #: Difference of bytes up to which two colours are one.


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
        arguments = first_arguments(self._options)
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
        if len(self._sharing) == 1:
            place_bar(bar, self._renderer, self._options)
        else:
            place_bar(bar, self._renderer, None)

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
        below = limits[0] > min(lows) + rounding or "below_label" in self._options
        above = limits[1] < max(highs) - rounding or "above_label" in self._options
        ends = own.below_range_color, own.above_range_color
        table.below_range_color = (ends[0] or table.values[0]) if below else None
        table.above_range_color = (ends[1] or table.values[-1]) if above else None
        bar.SetDrawBelowRangeSwatch(below)
        bar.SetDrawAboveRangeSwatch(above)
        # Others are marks without a text; VTK writes them on the side without labels.
        has_marks = isinstance(own, NormTable)
        has_labels = self._options.get("n_labels", 1) >= 1
        has_ends = any(name in self._options for name in END_LABELS)
        bar.SetDrawAnnotations((has_marks and has_labels) or has_ends)
        bar.SetDrawTickLabels(not has_marks and has_labels)
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
