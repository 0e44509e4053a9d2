"""Colour bars of a plotter: the flows and meshes that share one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import pyvista as pv

from flowtex._util.array_types import Bytes, Indices
from flowtex._util.colours import ZERO_SHARE, rounded_ends
from flowtex._util.pyvista_internals import mappers_of_bar, set_range_of_bar
from flowtex.plotting.bar_layout import first_arguments, place_bar, side_texts
from flowtex.rendering.vtk.flow_mapper import Ends, FlowMapper, Lacking, NormTable

COMPARED = 64  #: Number of colours by which maps are compared.
SAME_BYTES = 4  #: Difference of bytes up to which two colours are one.
#: Ranges that PyVista's meshes have without the flows that share their bar.
_mesh_ranges: WeakKeyDictionary[Any, tuple[float, float]] = WeakKeyDictionary()


class FlowBar:
    """The colour bar of one flow, which others with the same title and colours share.

    All of them have one range: the limits that users choose for some of them, or else the range of
    all values, as for PyVista's meshes. It does not depend on the order of changes.
    """

    def __init__(self, plotter: Any, mapper: FlowMapper, options: Mapping[str, Any]) -> None:
        self._bars = plotter.scalar_bars
        self._plotter = plotter
        self._mapper = mapper
        self._options = options
        self._renderer = plotter.renderer
        self._place = plotter.renderers.active_index
        self.key: str | None = None  #: Key among the bars of the plotter; ``None`` without a bar.
        self._names = ("", "")
        self._shown: tuple[Any, ...] = ()

    @property
    def _sharing(self) -> list[Any]:
        """Mappers that share the bar, also those of PyVista's meshes."""
        return mappers_of_bar(self._bars, self.key)

    def show(self, name: str, title: str) -> None:
        """Show the colours of a scalar, in the bar of others or in one of its own."""
        arguments = first_arguments(self._options)
        if "title" in arguments:
            name = title = arguments.pop("title")
        if self._names == (name, title) and self._mapper in self._sharing:
            return
        self.remove()
        self._names = name, title
        self.key = self._find_key(name, title)
        if self.key in self._bars:
            _remember_meshes(self._sharing)
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
        self.fit()

    def _find_key(self, name: str, title: str) -> str:
        """Return the key of the first bar that fits, or else an unused key."""
        free = []
        for n in range(1, len(self._bars) + 2):
            key = name
            if n > 1:
                key = f"{name} {n}"
            if key not in self._bars:
                free.append(key)
            elif self._fits(key, title):
                return key
        return free[0]

    def _fits(self, key: str, title: str) -> bool:
        """Return whether a bar has the same title and colours, in the same renderer."""
        bar = self._bars[key]
        if bar.GetTitle() not in (title, key):  # PyVista takes the key as the title
            return False
        if not self._renderer.HasViewProp(bar):
            return False
        mappers = mappers_of_bar(self._bars, key)
        return all(_same_colours(self._mapper, mapper) for mapper in mappers)

    def fit(self) -> None:
        """Give all that share the bar the limits chosen for some, or the range of all values."""
        if self._mapper not in self._sharing:
            self._mapper.scalar_range = self._mapper.ends.limits
            return
        _fit_range(self._bars, self.key)

    def look(self, colours: Callable[[], Bytes], settings: object) -> None:
        """Follow changes of what shares the bar; ``colours`` are the picture's with settings."""
        sharing = self._sharing
        if self._mapper not in sharing:  # a user has removed the bar
            self.key = None
            return
        flows = _flows(sharing)
        if flows[0] is not self._mapper:
            return
        if self._mapper.fitted_with != _identities(sharing):  # a mesh has joined or left
            self.fit()
        ends = list(map(_ends, sharing))
        bar = self._bars[self.key]
        limits = self._mapper.scalar_range
        lacking = _first_lacking(flows)
        shown = (bar.GetLookupTable(), limits, ends, settings, lacking)
        if shown == self._shown:
            return
        own = self._mapper.lookup_table
        if len(flows) < len(sharing):  # meshes share it
            table = pv.LookupTable(values=own.values)
        else:
            table = pv.LookupTable(values=colours())
        table.scalar_range = rounded_ends(*limits, log_scale=own.log_scale)
        table.log_scale = own.log_scale
        if isinstance(own, NormTable):  # along its bar are places, with the values as texts
            table.scalar_range = (0.0, 1.0)
            table.annotations = own.marks
        bar.SetLookupTable(table)
        self._shown = (table, *shown[1:])
        self._draw_beyond(table, limits, _joined(each.values for each in ends))
        self._draw_lacking(table, lacking)
        self._draw_labels(has_marks=isinstance(own, NormTable))

    def _draw_beyond(
        self, table: pv.LookupTable, limits: tuple[float, float], values: tuple[float, float]
    ) -> None:
        """Draw the colours of values beyond the limits, where there are values or a label."""
        least, most = values
        rounding = ZERO_SHARE * (most - least)
        below = limits[0] > least + rounding or "below_label" in self._options
        above = limits[1] < most - rounding or "above_label" in self._options
        own = self._mapper.lookup_table
        table.below_range_color = None
        if below:
            table.below_range_color = own.below_range_color or table.values[0]
        table.above_range_color = None
        if above:
            table.above_range_color = own.above_range_color or table.values[-1]
        bar = self._bars[self.key]
        bar.SetDrawBelowRangeSwatch(below)
        bar.SetDrawAboveRangeSwatch(above)

    def _draw_lacking(self, table: pv.LookupTable, lacking: Lacking | None) -> None:
        """Draw the colour of places without a value, or without data, where there are some."""
        table.nan_color = self._mapper.lookup_table.nan_color
        bar = self._bars[self.key]
        if "nan_annotation" in self._options:  # PyVista has followed it
            return
        bar.SetDrawNanAnnotation(lacking is not None)
        if lacking is not None:
            table.nan_color = lacking.color
            bar.SetNanAnnotation(lacking.text)

    def _draw_labels(self, *, has_marks: bool) -> None:
        """Write numbers beside the bar, or the texts of the marks of a norm."""
        # Others are marks without a text; VTK writes them on the side without labels.
        has_labels = self._options.get("n_labels", 1) >= 1
        bar = self._bars[self.key]
        has_texts = bool(side_texts(bar, self._options))
        bar.SetDrawAnnotations((has_marks and has_labels) or has_texts)
        # VTK's own texts would appear with those of others.
        if "below_label" not in self._options:
            bar.SetBelowRangeAnnotation("")
        if "above_label" not in self._options:
            bar.SetAboveRangeAnnotation("")
        bar.SetDrawTickLabels(not has_marks and has_labels)
        bar.SetTextPosition(int(not has_marks))

    def remove(self) -> None:
        """Leave the bar, and remove it if no other shares it."""
        key = self.key
        self.key = None
        sharing = mappers_of_bar(self._bars, key)
        if self._mapper in sharing:
            sharing.remove(self._mapper)
        if key in self._bars and not sharing:
            self._plotter.remove_scalar_bar(key, render=False)
        elif sharing:
            _fit_range(self._bars, key)
        self.fit()


def _fit_range(bars: Any, key: str | None) -> None:
    """Give all that share a bar the limits chosen for some, or the range of all values."""
    sharing = mappers_of_bar(bars, key)
    ends = list(map(_ends, sharing))
    chosen = [each for each in ends if each.are_chosen]
    limits = _joined(each.limits for each in chosen or ends)
    for mapper in sharing:
        mapper.scalar_range = limits
        if isinstance(mapper, FlowMapper):
            mapper.fitted_with = _identities(sharing)
    set_range_of_bar(bars, key, limits)


def _identities(mappers: Iterable[Any]) -> tuple[int, ...]:
    return tuple(map(id, mappers))


def _joined(ranges: Iterable[tuple[float, float]]) -> tuple[float, float]:
    """Return the range of several ranges."""
    lows, highs = zip(*ranges, strict=True)
    return min(lows), max(highs)


def _ends(mapper: Any) -> Ends:
    """Return the limits that a flow or a mesh has without others and the range of its values."""
    if isinstance(mapper, FlowMapper):
        return mapper.ends
    if mapper not in _mesh_ranges:  # PyVista has joined its range with that of flows
        shown = mapper.scalar_range
        low, high = mapper.dataset.get_data_range(mapper.array_name)
        _mesh_ranges[mapper] = max(shown[0], low), min(shown[1], high)
    return Ends(_mesh_ranges[mapper], _mesh_ranges[mapper])


def _remember_meshes(mappers: Iterable[Any]) -> None:
    """Remember the ranges of meshes before the first flow shares their bar."""
    mappers = list(mappers)
    if _flows(mappers):
        return
    for mapper in mappers:
        _mesh_ranges[mapper] = mapper.scalar_range


def _first_lacking(flows: Iterable[FlowMapper]) -> Lacking | None:
    """Return what the first flow lacks that lacks something."""
    for mapper in flows:
        if mapper.lacking is not None:
            return mapper.lacking
    return None


def _flows(mappers: Iterable[Any]) -> list[FlowMapper]:
    """Return the mappers that draw flows."""
    return [mapper for mapper in mappers if isinstance(mapper, FlowMapper)]


def _same_colours(one: Any, other: Any) -> bool:
    """Return whether two mappers have the same colour map, however many entries it has."""
    if one is other:
        return True
    first = one.lookup_table
    second = other.lookup_table
    if type(first) is not pv.LookupTable or type(second) is not pv.LookupTable:
        return False
    if first.log_scale != second.log_scale:
        return False
    return bool((np.abs(_compared(first) - _compared(second)) <= SAME_BYTES).all())


def _compared(table: pv.LookupTable) -> Indices:
    """Return evenly spaced colours of a table, (COMPARED, 4)."""
    numbers = np.arange(COMPARED) * table.n_values // COMPARED
    return np.asarray(table.values, dtype=int)[numbers]
