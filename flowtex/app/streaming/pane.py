"""One of the views that a page shows beside each other."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.app.streaming.canvas import Rect
from flowtex.field import FlowField
from flowtex.plotting.handle import FlowHandle

__all__ = ["COLOUR", "Pane"]

#: Point array that holds the colours.
COLOUR = "flowtex colour"

Pixels = NDArray[np.uint8]


class Pane:
    """A texture of the scene with settings of its own, and the pictures of it.

    Parameters
    ----------
    handle
        The texture on the scene's plotter.
    draw
        Draws what is visible: width, height and part, as :meth:`Canvas.draw` has them.
    size
        Tells width and height of a whole picture, in pixels.
    plane_view
        Tells the map from the surface's plane to the view.
    """

    def __init__(
        self,
        handle: FlowHandle,
        draw: Callable[[Pane, int, int, Rect | None], Pixels],
        size: Callable[[], tuple[int, int]],
        plane_view: Callable[[], NDArray[np.float64] | None],
    ) -> None:
        self.handle = handle
        self.plane_view = plane_view
        self._draw = draw
        self._size = size
        self._mapper = handle.actor.mapper

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of a whole picture, in pixels."""
        return self._size()

    @property
    def field(self) -> FlowField:
        """The flow."""
        return self.handle.field

    @property
    def mesh(self) -> Any:
        """The surface, as PyVista's mesh."""
        return self._mapper.dataset

    def draw(self, width: int, height: int, part: Rect | None = None) -> Pixels:
        """Draw this pane alone, as :meth:`Canvas.draw` does."""
        return self._draw(self, width, height, part)

    def show(self, *, visible: bool) -> None:
        """Take part in what is drawn, or not."""
        self.handle.actor.SetVisibility(visible)

    def colour_by(self, name: str, table: Any, span: tuple[float, float], plain: Any) -> None:
        """Colour by a scalar with a lookup table, or plainly for an empty name."""
        self._mapper.scalar_visibility = bool(name)
        if not name:
            self.handle.actor.prop.color = plain
            return
        self._mapper.SetLookupTable(table)
        self._mapper.scalar_range = span
        self._mapper.SelectColorArray(COLOUR)
        self.write_colours(name)

    def write_colours(self, name: str) -> None:
        """Put the scalar's values at the time that is shown on the nodes."""
        self.mesh.point_data[COLOUR] = self.handle.scene.scalar(name).ravel()
