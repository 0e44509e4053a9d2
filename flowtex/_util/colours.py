"""Colours, colour maps and norms of any form, as numbers, without loading VTK where that can be.

A norm is baked into a table of :data:`NORM_ENTRIES` colours with the values at which each begins,
so that all renderers look a value up in the same table, and as exactly where a norm is steep.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any

import numpy as np

from flowtex._util.arguments import brief, near_names
from flowtex._util.array_types import AnyArray, Bytes, Floats, Floats32
from flowtex.errors import FieldError

DEFAULT_CMAP = "viridis"  #: Colour map of most values.
SIGNED_CMAP = "RdBu_r"  #: Colour map of values around zero.
LIGHT_FROM = 0.18  #: Luminance from which black has more contrast than white.
ENTRIES = 256  #: Entries of a colour map.
#: Share of the larger end of a range, or of the range, below which a difference is rounding.
ZERO_SHARE = 1e-5
#: Colour maps to choose from: even steps of lightness first, those that diverge after them.
CMAPS = (
    *("viridis", "cividis", "magma", "inferno", "plasma", "gray", "Blues_r", "YlGnBu_r", "turbo"),
    *("coolwarm", "RdBu_r", "twilight"),
)
#: Maps with a middle, by the names of matplotlib, cmocean and cmcrameri.
DIVERGING = frozenset(
    (
        *("PiYG", "PRGn", "BrBG", "PuOr", "RdGy", "RdBu", "RdYlBu", "RdYlGn", "Spectral"),
        *("coolwarm", "bwr", "seismic", "berlin", "managua", "vanimo"),
        *("balance", "delta", "curl", "diff", "tarn"),
        *("broc", "cork", "vik", "lisbon", "tofino", "roma", "bam"),
    )
)

NORM_ENTRIES = 1024  #: Colours of the table of a norm.
BISECTIONS = 120  #: Steps of bisection that find where a colour of a norm begins.
ROUNDING = 1e-9  #: Share of the colour map by which a norm may decrease: rounding.
BAR_SIZE = (3.0, 1.0)  #: Size in inches of a colour bar for choosing ticks.
TICK_GAP = 0.12  #: Least distance of two ticks, as a share of the bar.
DIGITS = range(3, 9)  #: Possible numbers of digits in the labels of a colour bar.
LARGE = 1e6  #: Value from which on labels have an exponent.
NO_COLOURS = np.zeros((0, 4), np.uint8)  #: The table of no colours.

Colour = tuple[float, float, float]


def rgb(colour: Any) -> tuple[float, float, float]:
    """Return a colour of any form that PyVista takes as red, green and blue from 0 to 1."""
    if isinstance(colour, str):
        from matplotlib.colors import is_color_like, to_rgb

        # A text such as "0.5" is a grey to matplotlib, and no colour to PyVista.
        if is_color_like(colour) and not colour.replace(".", "", 1).isdecimal():
            return to_rgb(colour)
    shares: AnyArray = np.empty(0)
    if isinstance(colour, tuple):
        shares = np.asarray(colour)
    if shares.shape == (3,) and shares.dtype == float and ((shares >= 0) & (shares <= 1)).all():
        red, green, blue = np.rint(shares * 255) / 255  # as PyVista rounds them
        return float(red), float(green), float(blue)
    try:
        import pyvista as pv

        red, green, blue = pv.Color(colour).float_rgb
    except (TypeError, ValueError, OverflowError, ModuleNotFoundError) as error:
        raise FieldError(
            f"the colour {colour!r} does not exist; expected a name such as black, #rrggbb, or "
            "(r, g, b)"
        ) from error
    return red, green, blue


def is_light(colour: Sequence[float]) -> bool:
    """Return whether black has more contrast than white to a colour, (3,) from 0 to 1."""
    return float(np.power(colour, 2.2) @ (0.2126, 0.7152, 0.0722)) >= LIGHT_FROM


def colour_table(cmap: Any | None, count: int | None = None, *, flip: bool = False) -> Bytes:
    """Return a colour map as (N, 4) with a number of colours, 256 by default, or in reverse.

    ``cmap`` is a name, a matplotlib or PyVista colour map, or an array (N, 3 or 4), uint8 or from 0
    to 1. Anything else raises a FieldError, which suggests similar names.
    """
    values = getattr(cmap, "values", None)
    if isinstance(cmap, np.ndarray):
        values = cmap
    if isinstance(values, np.ndarray):  # also that of a LookupTable of PyVista's
        table = _resampled(np.asarray(values), count or ENTRIES)
    else:
        name = cmap or DEFAULT_CMAP
        if isinstance(name, str) and name in CMAPS:
            table = _cached_table(name, count or ENTRIES)  # each tile needs it
        else:
            table = _named_table(name, count or ENTRIES)
    if flip:
        table = table[::-1]
    return table.copy()


def colour_map(cmap: Any | None, count: int | None = None, *, flip: bool = False) -> Any:
    """Return the matplotlib colour map of what :func:`colour_table` accepts."""
    from matplotlib.colors import Colormap, ListedColormap

    if cmap is None:
        cmap = DEFAULT_CMAP
    colours = _known(cmap)
    if not isinstance(colours, Colormap):
        colours = ListedColormap(colour_table(cmap)[:, :3] / 255)
    if count is not None:
        colours = colours.resampled(count)
    if flip:
        return colours.reversed()
    return colours


def _known(name: Any) -> Any:
    from matplotlib import colormaps

    if isinstance(name, str) and name in colormaps:
        return colormaps[name]
    return name


def _named_table(name: Any, count: int) -> Bytes:
    """Return a colour map by its name, as RGBA rows, (count, 4) uint8."""
    from matplotlib import colormaps
    from matplotlib.colors import to_rgba_array

    colours = _known(name)
    try:
        if callable(colours):
            return _computed(colours, count)
        if not isinstance(name, str):  # colours, as lists of names or numbers
            return _resampled(to_rgba_array(name), count)
        import pyvista as pv

        return _resampled(np.asarray(pv.LookupTable(name, n_values=count).values), count)
    except (TypeError, ValueError, ModuleNotFoundError) as error:
        if isinstance(name, str):
            hint = near_names(name, colormaps, CMAPS)
        else:
            hint = "expected a name, a colour map of matplotlib, or colours"
        raise FieldError(f"the colour map {brief(name)} does not exist; {hint}") from error


def _computed(colours: Callable[[Floats], AnyArray], count: int) -> Bytes:
    """Return the table (count, 4) of a function from 0 to 1, as colour maps of matplotlib are."""
    table = np.asarray(colours(np.linspace(0, 1, count)))
    if table.shape != (count, 4):
        raise ValueError(f"the function returns the shape {table.shape}; expected ({count}, 4)")
    # Rounded down, as PyVista does, so that all renderers have the same colours.
    return np.asarray(table * 255, dtype=np.uint8)


_cached_table = cache(_named_table)


def is_diverging(cmap: Any) -> bool:
    """Return whether a colour map, or the one of a name, has a middle."""
    name = str(getattr(cmap, "name", cmap))
    return name.rpartition(".")[2].removesuffix("_r") in DIVERGING


def rounded_ends(low: float, high: float, *, log_scale: bool) -> tuple[float, float]:
    """Return the ends of a legend; an end that is 0 except for rounding becomes 0."""
    if log_scale:
        return low, high
    rounding = ZERO_SHARE * max(abs(low), abs(high))
    if abs(low) < rounding:
        low = 0.0
    if abs(high) < rounding:
        high = 0.0
    return low, high


def _resampled(colours: AnyArray, count: int) -> Bytes:
    """Return a table (count, 4) uint8 from colours (N, 3 or 4), floats from 0 to 1 or bytes."""
    if colours.ndim != 2 or colours.shape[1] not in (3, 4) or not len(colours):
        raise FieldError(f"cmap has shape {colours.shape}; expected a name, or (N, 3) or (N, 4)")
    values = colours.astype(float)
    if colours.dtype.kind == "f":
        values *= 255.0
    table = np.full((count, 4), 255.0)
    number = np.arange(count) * len(values) // count
    if count < len(values):  # with the first and the last
        number = np.rint(np.linspace(0, len(values) - 1, count)).astype(int)
    table[:, : values.shape[1]] = values[number]
    return np.asarray(np.rint(table.clip(0, 255)), dtype=np.uint8)


@dataclass(frozen=True, eq=False)
class ColourScale:
    """The colours of values from ``low`` to ``high``, beyond, and where there is no value."""

    #: Colours, (N, 4), each for an equal share of a bar.
    table: Bytes = field(default_factory=lambda: NO_COLOURS)
    low: float = 0.0
    high: float = 1.0
    log_scale: bool = False
    #: Values at which the colours of a norm begin, and the last one ends, (N + 1,), not decreasing.
    edges: Floats | None = None
    below: Colour | None = None  #: Colours from 0 to 1: those of the ends of the table by default.
    above: Colour | None = None
    nan: Colour = (0.663, 0.663, 0.663)
    norm: Any = None

    def places(self, values: Any) -> Floats:
        """Return the places of values on a bar, from 0 to 1; NaN stays."""
        if self.edges is not None:
            return np.asarray(np.interp(values, self.edges, np.linspace(0, 1, len(self.edges))))
        scaled: Any = np.asarray
        if self.log_scale:
            scaled = np.log
        low, high = scaled([self.low, self.high])
        numbers = scaled(np.maximum(np.asarray(values, dtype=float), self.low))
        return np.asarray(np.clip((numbers - low) / ((high - low) or 1.0), 0, 1))

    def colours(self, values: Any) -> Floats:
        """Return the colours of values, (..., 3), from 0 to 1."""
        numbers = np.asarray(values, dtype=float)
        count = len(self.table)
        with np.errstate(invalid="ignore"):
            if self.edges is None:
                entry = np.nan_to_num(self.places(numbers) * count).clip(0, count - 1).astype(int)
            else:
                entry = np.searchsorted(self.edges, numbers, side="right").clip(1, count) - 1
            entry = np.where(numbers < self.low, 0, np.where(numbers > self.high, count, entry) + 1)
        entry[np.isnan(numbers)] = count + 2
        return np.asarray(self.texels[entry, :3], dtype=float)

    @property
    def part(self) -> AnyArray:
        """The table for a browser: (N, 4) uint8, and of a norm float32, with shares as below."""
        if self.edges is None:
            return np.ascontiguousarray(self.table)
        return np.column_stack([self.table[:, :3], self.texels[1:-2, 3]]).astype(np.float32)

    @cached_property
    def texels(self) -> Floats32:
        """Colours below the range, in it, above it, and without a value, (N + 3, 4), for shaders.

        The fourth channel is the share of the range at which a colour of a norm begins, and 1 of
        the first row; else 0.
        """
        table = self.table[:, :3] / 255
        below = self.below
        if below is None:
            below = table[0]
        above = self.above
        if above is None:
            above = table[-1]
        texels = np.zeros((len(table) + 3, 4))
        texels[:, :3] = np.vstack([below, table, above, self.nan])
        if self.edges is not None:
            texels[1:-2, 3] = (self.edges[:-1] - self.low) / (self.high - self.low)
            texels[0, 3] = 1
        return texels.astype(np.float32)

    @cached_property
    def marks(self) -> tuple[tuple[float, float, str], ...]:
        """Values beside a bar where there is a norm, their places on it, and their texts.

        They are the ticks of matplotlib, if there is room.
        """
        if self.norm is None:
            return ()
        from matplotlib.cm import ScalarMappable
        from matplotlib.figure import Figure

        bar = Figure(BAR_SIZE)
        axis = "horizontal"
        shown = bar.colorbar(ScalarMappable(self.norm), bar.add_subplot(), orientation=axis)
        values = np.asarray(shown.get_ticks(), dtype=float)
        values = values[(values >= self.low) & (values <= self.high)]
        kept: list[float] = []
        for value, place in zip(values.tolist(), self.places(values), strict=True):
            if not kept or place - self.places(kept[-1]) >= TICK_GAP:
                kept.append(value)
        if not (len(kept) > 1):
            kept = [self.low, self.high]
        return tuple(zip(kept, self.places(kept).tolist(), distinct_texts(kept), strict=True))


def distinct_texts(values: Any) -> list[str]:
    """Write numbers with the fewest digits that distinguish them, as 1000 and 1e6."""
    texts: list[str] = []
    for digits in DIGITS:
        texts = [_number_text(value, digits) for value in values]
        if len(set(texts)) == len(texts):
            break
    return texts


def _number_text(value: float, digits: int) -> str:
    text = f"{value:.{digits}g}"
    if "e+" in text and abs(value) < LARGE:
        return f"{float(text):.0f}"
    return re.sub(r"e(-?)\+?0?", r"e\1", text)


def matplotlib_norm(norm: Any) -> Any:
    """Return a norm of matplotlib, also of the name of a scale; raise a FieldError for others."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import NoNorm, Normalize

    try:
        found = ScalarMappable(norm=norm).norm
    except (TypeError, ValueError):
        found = None
    if not isinstance(found, Normalize) or isinstance(found, NoNorm):
        raise FieldError(
            f"norm is {norm!r}; expected a matplotlib Normalize, such as PowerNorm(0.5), or a name "
            "such as 'log', 'symlog' or 'asinh'"
        )
    return found


def with_limits(norm: Any, low: float, high: float) -> Any:
    """Return a copy of a norm whose missing limits become the ends of a range."""
    norm = copy.copy(matplotlib_norm(norm))
    norm.autoscale_None(np.array([low, high]))
    if not norm.vmin < norm.vmax:
        kind = type(norm).__name__
        raise FieldError(
            f"norm is {kind} from {norm.vmin:g} to {norm.vmax:g}, and the values range from "
            f"{low:g} to {high:g}; give it limits, as in {kind}(vmin=1, vmax=10)"
        )
    return norm


@np.errstate(all="ignore")
def norm_scale(norm: Any, cmap: Any, **beyond: Any) -> ColourScale:
    """Return the colours of a norm that has limits; raise a FieldError where it has no table.

    ``beyond`` are ``below``, ``above`` and ``nan`` of :class:`ColourScale`; by default they are
    those of matplotlib.
    """
    low = float(norm.vmin)
    high = float(norm.vmax)

    def places(values: Floats) -> Floats:
        found = norm(values)
        filled: Floats = np.ma.filled(np.ma.asarray(found, dtype=float), np.nan)
        if np.asarray(found).dtype.kind in "iu":  # numbers of colours
            filled /= cmap.N
        return filled

    known = places(np.linspace(low, high, NORM_ENTRIES + 1))
    is_increasing = np.isfinite(known).all() and (np.diff(known) >= -ROUNDING).all()
    if not (low < high and is_increasing and known[-1] > known[0]):
        raise FieldError(
            f"norm is {type(norm).__name__} from {low:g} to {high:g}, which does not increase with "
            "the value there; expected one that does: give it other limits, as in "
            f"{type(norm).__name__}(..., vmin=1, vmax=10)"
        )
    boundaries = getattr(norm, "boundaries", None)
    if boundaries is not None:
        parts = max(NORM_ENTRIES // (len(boundaries) - 1), 1)
        numbers = np.arange((len(boundaries) - 1) * parts + 1) / parts
        edges = np.interp(numbers, np.arange(len(boundaries)), boundaries)
    else:
        edges = _even_edges(places, low, high)
    table = (255 * np.asarray(cmap(norm((edges[:-1] + edges[1:]) / 2)))).astype(np.uint8)
    outside = np.ma.filled(norm(np.array([2 * low - high, 2 * high - low])), -1)
    below, above = np.asarray(cmap(outside))[:, :3].tolist()
    if beyond.get("below") is None:
        beyond["below"] = tuple(below)
    if beyond.get("above") is None:
        beyond["above"] = tuple(above)
    if beyond.get("nan") is None:
        beyond.pop("nan", None)
    return ColourScale(table, low, high, edges=edges, norm=norm, **beyond)


def _even_edges(places: Callable[[Floats], Floats], low: float, high: float) -> Floats:
    """Return values from low to high whose places on a colour map are evenly spaced, by bisection.

    ``places`` returns the place of each value, from 0 to 1.
    """
    shares = np.linspace(0, 1, NORM_ENTRIES + 1)
    lower = np.full(len(shares), low)
    edges = np.full(len(shares), high)
    for _ in range(BISECTIONS):
        middle = lower + (edges - lower) / 2
        reached = places(middle) >= shares
        lower = np.where(reached, lower, middle)
        edges = np.where(reached, middle, edges)
    edges[0] = low
    edges[-1] = high
    return edges


def scale_of(look: Any, limits: tuple[float, float]) -> ColourScale:
    """Return the colours of an appearance, which has some limits."""
    beyond: dict[str, Any] = {"nan": rgb(look.nan_color)}
    if look.below_color is not None:
        beyond["below"] = rgb(look.below_color)
    if look.above_color is not None:
        beyond["above"] = rgb(look.above_color)
    form = look.cmap, look.n_colors
    if look.norm is None or look.scalar_name is None:
        table = colour_table(*form, flip=look.flip_scalars)
        return ColourScale(table, *limits, look.log_scale, **beyond)
    return norm_scale(
        with_limits(look.norm, *limits), colour_map(*form, flip=look.flip_scalars), **beyond
    )
