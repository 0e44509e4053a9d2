"""Colours and colour maps of any form, as numbers, without loading VTK where that can be."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from flowtex._util.arguments import near_names
from flowtex._util.array_types import AnyArray, Bytes, Floats
from flowtex.errors import FieldError

#: Colour maps by default: of most values, and of those around zero.
DEFAULT_CMAP, SIGNED_CMAP = "viridis", "RdBu_r"
#: Luminance from which black has more contrast than white.
LIGHT_FROM = 0.18
#: Entries of a colour map.
ENTRIES = 256
#: Share of the larger end of a range, or of the range, below which a difference is rounding.
ZERO_SHARE = 1e-5
#: Colour maps to choose from: even steps of lightness first, those that diverge after them.
CMAPS = (
    *("viridis", "cividis", "magma", "inferno", "plasma", "gray", "Blues_r", "YlGnBu_r", "turbo"),
    *("coolwarm", "RdBu_r", "twilight"),
)
#: Packages whose maps are found by their names.
PACKAGES = ("cmocean", "cmcrameri", "colorcet")
#: Maps with a middle, by the names of matplotlib, cmocean and cmcrameri.
DIVERGING = frozenset(
    (
        *("PiYG", "PRGn", "BrBG", "PuOr", "RdGy", "RdBu", "RdYlBu", "RdYlGn", "Spectral"),
        *("coolwarm", "bwr", "seismic", "berlin", "managua", "vanimo"),
        *("balance", "delta", "curl", "diff", "tarn"),
        *("broc", "cork", "vik", "lisbon", "tofino", "roma", "bam"),
    )
)


def rgb(colour: Any) -> tuple[float, float, float]:
    """Return a colour of any form that PyVista takes as red, green and blue from 0 to 1."""
    if isinstance(colour, str):
        from matplotlib.colors import is_color_like, to_rgb

        # A text such as "0.5" is a grey to matplotlib, and no colour to PyVista.
        if is_color_like(colour) and not colour.replace(".", "", 1).isdecimal():
            return to_rgb(colour)
    shares = np.asarray(colour) if isinstance(colour, tuple) else np.empty(0)
    if shares.shape == (3,) and shares.dtype == float and ((shares >= 0) & (shares <= 1)).all():
        red, green, blue = np.rint(shares * 255) / 255  # as PyVista rounds them
        return float(red), float(green), float(blue)
    try:
        import pyvista as pv

        red, green, blue = pv.Color(colour).float_rgb
    except (TypeError, ValueError, OverflowError, ModuleNotFoundError) as error:
        msg = (
            f"the colour {colour!r} does not exist; expected a name such as black, #rrggbb, or "
            "(r, g, b)"
        )
        raise FieldError(msg) from error
    return red, green, blue


def is_light(colour: Sequence[float]) -> bool:
    """Return whether black has more contrast than white to a colour, (3,) from 0 to 1."""
    return float(np.power(colour, 2.2) @ (0.2126, 0.7152, 0.0722)) >= LIGHT_FROM


def colour_table(cmap: Any | None) -> Bytes:
    """Return a colour map as (256, 4).

    It may be a name, a map of matplotlib's or a table as PyVista takes them, or an array
    (N, 3 or 4), uint8 or from 0 to 1. Anything else raises a FieldError, which suggests similar
    names.
    """
    if isinstance(cmap, np.ndarray):
        return _resampled(cmap)
    values = getattr(cmap, "values", None)
    if isinstance(values, np.ndarray):  # a LookupTable of PyVista's
        return _resampled(np.asarray(values))
    name = cmap or DEFAULT_CMAP
    if isinstance(name, str) and name in CMAPS:  # each tile needs it
        return _cached_table(name).copy()
    return _named_table(name)


def _named_table(name: Any) -> Bytes:
    from matplotlib import colormaps

    colours = colormaps[name] if isinstance(name, str) and name in colormaps else name
    if callable(colours):
        # Rounded down, as PyVista does, so that all renderers have the same colours.
        return np.asarray(np.asarray(colours(np.linspace(0, 1, ENTRIES))) * 255, dtype=np.uint8)
    try:
        import pyvista as pv

        return _resampled(np.asarray(pv.LookupTable(name, n_values=ENTRIES).values))
    except (TypeError, ValueError, ModuleNotFoundError) as error:
        hint = near_names(name, colormaps, CMAPS) if isinstance(name, str) else "expected a name"
        package, _, rest = str(name).partition(".")
        if package in PACKAGES:
            hint = f"install {package}, and give its name there, {rest!r}"
        msg = f"the colour map {name!r} does not exist; {hint}"
        raise FieldError(msg) from error


_cached_table = cache(_named_table)


def is_diverging(cmap: Any) -> bool:
    """Return whether a colour map, or the one of a name, has a middle."""
    name = str(getattr(cmap, "name", cmap))
    return name.rpartition(".")[2].removesuffix("_r") in DIVERGING


def colour_shares(values: AnyArray, low: float, high: float, *, log_scale: bool = False) -> Floats:
    """Return places of values on the colour map, from 0 to 1; NaN stays."""
    numbers = np.asarray(values, dtype=float)
    if log_scale:
        numbers = np.log(np.maximum(numbers, low))
        low, high = np.log([low, high])
    return np.asarray(np.clip((numbers - low) / ((high - low) or 1.0), 0, 1))


def rounded_ends(low: float, high: float, *, log_scale: bool) -> tuple[float, float]:
    """Return the ends of a legend: one that is 0 up to rounding is 0."""
    least = 0.0 if log_scale else ZERO_SHARE * max(abs(low), abs(high))
    return (low if abs(low) >= least else 0.0), (high if abs(high) >= least else 0.0)


def _resampled(colours: AnyArray) -> Bytes:
    if colours.ndim != 2 or colours.shape[1] not in (3, 4) or not len(colours):
        msg = f"cmap has shape {colours.shape}; expected a name, or (N, 3) or (N, 4)"
        raise FieldError(msg)
    values = colours.astype(float) * (255.0 if colours.dtype.kind == "f" else 1.0)
    table = np.full((ENTRIES, 4), 255.0)
    table[:, : values.shape[1]] = values[np.arange(ENTRIES) * len(values) // ENTRIES]
    return np.asarray(np.rint(table.clip(0, 255)), dtype=np.uint8)
