"""What a scene is coloured by, and the range of it."""

from __future__ import annotations

from typing import Any

import numpy as np

from flowtex.app.streaming.pane import Pane
from flowtex.field import FlowField
from flowtex.plotting.handle import FlowHandle

__all__ = ["Coloured"]

#: Entries of a colour map.
ENTRIES = 256


class Coloured:
    """Colours of a scene, which has panes and a first texture.

    Attributes
    ----------
    colour, cmap
        Name of what the surface is coloured by, empty for nothing, and of the colour map.
    plain
        Colour of the surface where it is coloured by nothing.
    panes
        The views beside each other.
    """

    colour: str
    cmap: Any
    plain: Any
    panes: list[Pane]
    _clims: dict[str, tuple[float, float]]

    @property
    def handle(self) -> FlowHandle:
        """The texture of the first pane."""
        return self.panes[0].handle

    @property
    def field(self) -> FlowField:
        """The flow."""
        return self.handle.field

    @property
    def colours(self) -> tuple[str, ...]:
        """Names of what the surface can be coloured by."""
        return tuple(dict.fromkeys(("speed", *self.field.scalars)))

    def colour_by(
        self,
        name: str,
        *,
        cmap: str | None = None,
        clim: tuple[float, float] | None = None,
    ) -> None:
        """Colour by a scalar, or plainly for an empty name.

        Parameters
        ----------
        name
            One of :attr:`colours`, or empty.
        cmap
            Another colour map.
        clim
            Values at the ends of the colour map; kept for this scalar.
        """
        import pyvista as pv

        self.colour = name
        self.cmap = cmap or self.cmap
        if clim is not None:
            self._clims[name] = (float(clim[0]), float(clim[1]))
        self._table = pv.LookupTable(self.cmap, n_values=ENTRIES)
        self._table.scalar_range = self.colour_range
        for pane in self.panes:
            pane.colour_by(name, self._table, self.colour_range, self.plain)

    def forget_range(self) -> None:
        """Let the colours go from the least value to the greatest again."""
        self._clims.pop(self.colour, None)
        self.colour_by(self.colour)

    @property
    def colour_range(self) -> tuple[float, float]:
        """Values at the ends of the colour bar."""
        if not self.colour:
            return 0.0, 1.0
        return self._clims.get(self.colour) or self.handle.scene.scalar_range(self.colour)

    @property
    def chosen_range(self) -> tuple[float, float] | None:
        """The same, where somebody has chosen them."""
        return self._clims.get(self.colour)

    def colour_stops(self, count: int = 17) -> list[str]:
        """Colours along the bar, from low to high, as ``#rrggbb``."""
        colours = [self._table.map_value(v) for v in np.linspace(*self.colour_range, count)]
        return ["#" + "".join(f"{round(255 * c):02x}" for c in rgb[:3]) for rgb in colours]
