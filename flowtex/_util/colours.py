"""Colours and colour maps of any form, as numbers, without loading VTK where that can be."""

from __future__ import annotations

from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Bytes

__all__ = ["DEFAULT_CMAP", "colour_table", "rgb"]

DEFAULT_CMAP = "viridis"
#: Entries of a colour map.
ENTRIES = 256


def rgb(colour: Any) -> tuple[float, float, float]:
    """Return a colour of any form that PyVista takes as red, green and blue from 0 to 1.

    Raises a ValueError when there is no such colour.
    """
    if isinstance(colour, str):
        from matplotlib.colors import is_color_like, to_rgb

        # A text such as "0.5" is a grey to matplotlib, and no colour to PyVista.
        if is_color_like(colour) and not colour.replace(".", "", 1).isdecimal():
            return to_rgb(colour)
    import pyvista as pv

    red, green, blue = pv.Color(colour).float_rgb
    return red, green, blue


def colour_table(cmap: Any | None) -> Bytes:
    """Return a colour map as (256, 4).

    It may be a name, a map of matplotlib's or a table as PyVista takes them, or an array
    (N, 3 or 4), uint8 or from 0 to 1. Anything else raises a ValueError.
    """
    if isinstance(cmap, np.ndarray):
        return _resampled(cmap)
    values = getattr(cmap, "values", None)
    if isinstance(values, np.ndarray):  # a LookupTable of PyVista's
        return _resampled(np.asarray(values))
    from matplotlib import colormaps

    name = cmap or DEFAULT_CMAP
    known = colormaps[name] if isinstance(name, str) and name in colormaps else name
    if callable(known):
        # Rounded down, as PyVista does, so that all renderers have the same colours.
        return np.asarray(np.asarray(known(np.linspace(0, 1, ENTRIES))) * 255, dtype=np.uint8)
    import pyvista as pv

    return _resampled(np.asarray(pv.LookupTable(name, n_values=ENTRIES).values))


def _resampled(colours: AnyArray) -> Bytes:
    if colours.ndim != 2 or colours.shape[1] not in (3, 4) or not len(colours):
        msg = f"cmap has shape {colours.shape}; expected a name, or (N, 3) or (N, 4)"
        raise ValueError(msg)
    values = colours.astype(float) * (255.0 if colours.dtype.kind == "f" else 1.0)
    table = np.full((ENTRIES, 4), 255.0)
    table[:, : values.shape[1]] = values[np.arange(ENTRIES) * len(values) // ENTRIES]
    return np.asarray(np.rint(table.clip(0, 255)), dtype=np.uint8)
