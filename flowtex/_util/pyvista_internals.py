"""What flowtex needs of PyVista that its public interface lacks, in one place.

- Which mappers share a scalar bar, and the range that the bar has stored: PyVista joins the ranges
  of meshes with the same title, and has no function that lists them.
- All open plotters: before a fork, also plotters without a flow have to free their contexts.
- The backend that a caller of ``plotter.show`` has named: PyVista calls a backend without saying
  whether the user or the theme has chosen it, or it was found by itself.

All else comes from the public names of ``pyvista``. Here no module of PyVista is imported unless
it is loaded already, as a process without plotters needs none.
"""

from __future__ import annotations

import sys
from typing import Any


def mappers_of_bar(bars: Any, key: str | None) -> list[Any]:
    """Return the mappers that share a scalar bar; the list is PyVista's own.

    Parameters
    ----------
    bars
        ``plotter.scalar_bars`` of a plotter.
    key
        Title of the bar.
    """
    mappers: list[Any] = bars._scalar_bar_mappers.get(key, [])
    return mappers


def set_range_of_bar(bars: Any, key: str | None, limits: tuple[float, float]) -> None:
    """Store the limits of a scalar bar, with which PyVista joins those of later meshes."""
    bars._scalar_bar_ranges[key] = limits


def open_plotters() -> list[Any]:
    """Return the plotters of this process that are open."""
    plotting = sys.modules.get("pyvista.plotting.plotter")
    if plotting is None:
        return []
    return list(plotting._ALL_PLOTTERS.values())


def abandon(plotter: Any) -> None:
    """Let a plotter forget its window without freeing it, as if it had been closed."""
    plotter.ren_win = None
    plotter._closed = True


def named_backend(default: str) -> str | None:
    """Return the Jupyter backend that the caller of ``plotter.show`` has named.

    Parameters
    ----------
    default
        The result without a ``plotter.show`` among the callers.

    Returns
    -------
    str | None
        The name in lower case; ``None`` if neither the user nor the theme has chosen a backend.
    """
    frame = sys._getframe(1)
    while (caller := frame.f_back) is not None:
        frame = caller
        if frame.f_code.co_name == "show" and "jupyter_backend" in frame.f_locals:
            named = frame.f_locals["jupyter_backend"]
            if named is None:
                return None
            return str(named).lower()
    return default
