"""Axes of maps: their unit, ticks in degrees, and the projections of cartopy."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, Locator, MaxNLocator

from flowtex._util.array_types import Floats
from flowtex.field.earth import DEGREE, EARTH_RADIUS, MOST_LINES, STEPS, Projection

#: Leading digits of ticks in degrees.
DEGREE_STEPS = [1, 1.5, 2, 3, 5, 6, 10]
#: Degrees between ticks on a border.
TICKS = (90, 60, *STEPS)
#: Share of the ticks for which matplotlib sees room, where they are longitudes.
WIDE = 0.85
#: Places along a border of axes, and inwards from it, where longitude and latitude are looked up.
ALONG, INWARDS = 241, 33
#: Share of the axes within which a place maps back to where it was looked up.
NEAR = 1e-3

#: Writes degrees.
DegreeText = Callable[..., str]


@dataclass(frozen=True)
class AxesUnit:
    """Unit of axes: a position of the map is ``scale * value + offset``, of x and y."""

    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)

    def on_map(self, values: Floats) -> Floats:
        """Return positions (..., 2) on the map of values of the axes."""
        return np.asarray(values * np.array(self.scale) + self.offset)

    def on_axes(self, positions: Floats) -> Floats:
        """Return values (..., 2) of the axes of positions on the map."""
        return np.asarray((np.asarray(positions) - self.offset) / self.scale)


def is_geo(ax: Axes) -> bool:
    """Return whether axes are cartopy's."""
    return hasattr(ax, "projection") and hasattr(ax.projection, "proj4_init")


def projection_of_axes(ax: Any) -> tuple[str, AxesUnit]:
    """Return the projection of cartopy's axes, as PROJ takes it, and their unit.

    Axes in degrees show a plate carrée in metres.
    """
    text = str(ax.projection.proj4_init)
    if ax.projection.is_projected:
        return text, AxesUnit()
    middle = re.search(r"\+pm=(\S+)", text)
    text = re.sub(r"\+(pm|a|ellps|to_meter)=\S+ ?", "", text)
    text = re.sub(r"proj=lat ?long?|proj=longlat", "proj=eqc", text)
    if middle:
        text += f" +lon_0={middle[1]}"
    return f"{text} +R={EARTH_RADIUS:.12g}", AxesUnit((DEGREE, DEGREE))


def unit_of(projection: Projection | None) -> AxesUnit:
    """Return the unit of straight axes: degrees on a plate carrée, else that of the data."""
    if projection is None or projection.name != "platecarree":
        return AxesUnit()
    lon, standard = projection.center
    scale = DEGREE * math.cos(math.radians(standard)), DEGREE
    return AxesUnit(scale, (-lon * scale[0], 0.0))


def label_degrees(ax: Axes, projection: Projection, unit: AxesUnit) -> None:
    """Give straight axes ticks in degrees: of a map, where its graticule meets their border."""
    for number, axis in enumerate((ax.xaxis, ax.yaxis)):
        if unit == AxesUnit():
            border = _Border(ax, projection, number)
            axis.set_major_locator(border)
            axis.set_major_formatter(FuncFormatter(border.text))
        else:
            axis.set_major_locator(_DegreeLocator(nbins="auto", steps=DEGREE_STEPS))
            axis.set_major_formatter(FuncFormatter((longitude_text, latitude_text)[number]))


def longitude_text(degrees: float, position: int | None = None) -> str:
    """Return a longitude as ``"30°E"``."""
    del position
    turned = (degrees + 180.0) % 360.0 - 180.0
    half = abs(abs(turned) - 180.0) < 1e-6
    return f"{abs(turned):.6g}°{'' if half or abs(turned) < 1e-6 else 'E' if turned > 0 else 'W'}"


def latitude_text(degrees: float, position: int | None = None) -> str:
    """Return a latitude as ``"60°N"``."""
    del position
    return f"{abs(degrees):.6g}°{'' if abs(degrees) < 1e-6 else 'N' if degrees > 0 else 'S'}"


def _room(axis: Any) -> int:
    """Return the number of ticks for which an axis has room: longitudes are wide."""
    share = WIDE if axis.axis_name == "x" else 1.0
    return max(min(MOST_LINES, round(share * axis.get_tick_space())), 1)


def _step(degrees: float, most: float) -> float:
    """Return the degrees between ticks, of which ``most`` have room."""
    return next((step for step in TICKS[::-1] if degrees / step <= most), TICKS[0])


class _Border(Locator):
    """Crossings of meridians with the lower border of axes (0), or parallels with the left (1)."""

    def __init__(self, ax: Axes, projection: Projection, number: int) -> None:
        self._ax, self._projection, self._number = ax, projection, number
        self._find = lru_cache(maxsize=1)(self._crossings)  # each tick asks

    def crossings(self) -> tuple[Floats, Floats, DegreeText]:
        """Return the places along the border, their degrees, and the function for their text."""
        most = _room((self._ax.xaxis, self._ax.yaxis)[self._number])
        return self._find((self._ax.get_xlim(), self._ax.get_ylim()), most)

    def __call__(self) -> list[float]:
        """Return the places along the border."""
        return [float(place) for place in self.crossings()[0]]

    def tick_values(self, vmin: float, vmax: float) -> list[float]:
        """Return the ticks of the axes as they are."""
        del vmin, vmax
        return self()

    def text(self, x: float, position: int | None = None) -> str:
        """Return the degrees at the nearest crossing."""
        del position
        places, values, text = self.crossings()
        return text(values[np.argmin(np.abs(places - x))]) if len(places) else ""

    def _crossings(
        self, axis_limits: tuple[tuple[float, float], tuple[float, float]], most: int
    ) -> tuple[Floats, Floats, DegreeText]:
        limits = np.array(axis_limits)
        (start, end), (border, other) = limits[self._number], limits[1 - self._number]
        along, inwards = np.linspace(start, end, ALONG), np.linspace(border, other, INWARDS)
        grid = np.zeros((ALONG, INWARDS, 3))
        grid[..., self._number], grid[..., 1 - self._number] = along[:, None], inwards
        lon, lat = self._projection.lonlat(grid)
        # Outside of a map with an outline, PROJ returns places of the other side.
        mapped_back = self._projection.positions(lon, lat)
        with np.errstate(invalid="ignore"):
            on_map = np.linalg.norm(mapped_back - grid, axis=-1) <= NEAR * np.ptp(limits)
        # A map with an outline begins further in.
        first, has_place = (np.arange(ALONG), np.argmax(on_map, axis=1)), on_map.any(axis=1)
        along, lon, lat = along[has_place], lon[first][has_place], lat[first][has_place]
        if len(along) < 2:
            return np.zeros(0), np.zeros(0), longitude_text
        steps = np.diff(lat)
        if self._number == 1 and ((steps >= 0).all() or (steps <= 0).all()):
            degrees, text = lat, latitude_text
        else:  # around a pole meridians meet all sides
            degrees, text = np.unwrap(lon, period=360.0), longitude_text
        low, high = degrees.min(), degrees.max()
        room = most * abs(float(np.ptp(along) / np.ptp(limits[self._number])))
        step = _step(high - low, room)
        places, values = [], []
        for value in np.arange(math.ceil(low / step), math.floor(high / step) + 1) * step:
            beyond = degrees >= value
            for k in np.flatnonzero(beyond[1:] != beyond[:-1]):
                share = (value - degrees[k]) / (degrees[k + 1] - degrees[k])
                places.append(along[k] + share * (along[k + 1] - along[k]))
                values.append(value)
        return np.array(places), np.array(values), text


class _DegreeLocator(MaxNLocator):
    """Ticks at whole parts of a right angle, where the axes show more than some degrees."""

    def tick_values(self, vmin: float, vmax: float) -> Any:
        """Return ticks between two values, and one beyond each."""
        low, high = sorted((vmin, vmax))
        step = _step(high - low, _room(self.axis))
        if step < 2 * TICKS[-1]:
            return super().tick_values(vmin, vmax)
        return np.arange(math.floor(low / step), math.ceil(high / step) + 1) * step
