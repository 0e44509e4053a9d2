"""A flow as the client in the browser takes it: a header in JSON, and arrays.

::

    TextureSet, Settings, Colours --> Scene --header()-----------> JSON, with the shaders' text
                                        +----surface(), step(k)--> named arrays, little endian

The header has the numbers from which the client computes the uniforms itself, so that it answers
a slider without asking; see :mod:`flowtex.rendering.uniforms` for what they are. Arrays come in
the smallest type that does: slopes in half precision, as on every graphics card, normals in eight
bits. Positions and scalars keep single precision.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex._version import __version__
from flowtex.field.interpolation import steps_around
from flowtex.first_look import first_look
from flowtex.rendering.shaders import shader_text
from flowtex.rendering.uniforms import variants
from flowtex.rendering.webgl.header import (
    Colours,
    camera_state,
    half,
    numbers,
    paper_state,
    table_state,
)
from flowtex.rendering.webgl.packing import Packing, packing_of
from flowtex.settings import Settings
from flowtex.textures import TextureSet

__all__ = ["FORMAT", "Scene"]

Array = NDArray[Any]
Parts = dict[str, Array]

#: Number of the form of header and parts; a client refuses one that it does not know.
FORMAT = 1
#: Shaders of the client, by the name under which the header has their text.
SHADERS = {
    "vertex": "webgl2/vertex.glsl",
    "fragment": "webgl2/fragment.glsl",
    "pick": "webgl2/pick.glsl",
}


@dataclass(frozen=True, eq=False)
class Scene:
    """A flow, its colours and a camera, ready to be handed over.

    Attributes
    ----------
    textures
        What to draw.
    colours
        In which colours.
    kept
        Destination times that are handed over, increasing; all of them when empty.
    """

    textures: TextureSet
    colours: Colours = field(default_factory=Colours)
    kept: tuple[int, ...] = ()

    @cached_property
    def packing(self) -> Packing:
        """The slices, packed."""
        return packing_of(self.textures)

    @property
    def steps(self) -> int:
        """Number of destination times that are handed over."""
        return len(self.kept) or self.textures.store.steps

    @property
    def times(self) -> NDArray[np.float64]:
        """Destination times, (steps,), in the field's own unit."""
        times = self.textures.geometry.field.times
        return times[list(self.kept)] if self.kept else times

    def first_look(self, size: tuple[int, int] = (3, 2)) -> dict[str, Any]:
        """Camera that shows the whole surface in a picture of a size, as the header has it."""
        return camera_state(first_look(self.textures.geometry.field, size[0] / size[1]))

    def header(
        self,
        settings: Settings,
        *,
        camera: Mapping[str, Any] | None = None,
        time: float | None = None,
        clock: float = 0.0,
    ) -> dict[str, Any]:
        """Return all that is no array; plain Python, for JSON.

        Parameters
        ----------
        settings
            How to draw.
        camera
            From where; the whole surface by default.
        time
            Time that is shown, in the field's own unit; the last one by default.
        clock
            Clock of the streaming of a steady flow, in seconds.
        """
        return {
            **self.constants(),
            "settings": dict(settings),
            "camera": dict(camera) if camera is not None else self.first_look(),
            "time": float(self.times[-1] if time is None else time),
            "clock": float(clock),
        }

    def constants(self) -> dict[str, Any]:
        """Return what of the header changes only with the textures or the colours."""
        textures, colours = self.textures, self.colours
        variant = sorted(variants(textures, unsteady=self.steps > 1))
        return {
            "format": FORMAT,
            "version": __version__,
            "name": textures.geometry.field.name,
            "variant": variant,
            "shaders": dict(_shaders(tuple(variant))),
            "geometry": self._geometry(),
            "slices": self._slices(),
            "scalars": {
                "name": colours.name,
                "low": float(colours.low),
                "high": float(colours.high),
                "steps": 1 if self._values is None else len(self._values),
                "unit": colours.unit,
                "bar": bool(colours.bar),
            },
            "colour": [float(c) for c in colours.plain],
            "background": [float(c) for c in colours.background],
            "lighting": bool(colours.lighting),
            "opacity": float(colours.opacity),
            "paper": None if textures.paper is None else paper_state(textures.paper),
            "table": table_state(),
        }

    def surface(self) -> Parts:
        """Return the arrays that are the same at all times, the smallest first."""
        geometry, colours = self.textures.geometry, self.colours
        parts: Parts = {}
        if colours.name is not None and colours.table is not None:
            parts["cmap"] = np.ascontiguousarray(colours.table, np.uint8)
        if not geometry.field.surface.cells.all():
            parts["cells"] = geometry.field.surface.cells.astype(np.uint8)
        if not geometry.planar:
            parts["normal"] = np.rint(geometry.normal * 32767).astype(np.int16)
        parts["position"] = np.ascontiguousarray(geometry.position, "<f4")
        if self.textures.paper is not None:
            parts["step"] = half(self.textures.paper.step)
            parts["noise"] = half(self.textures.paper.noise)
        return parts

    def step(self, step: int) -> Parts:
        """Return the arrays of one destination time, the smallest first.

        What is not yet traced is traced.

        Raises
        ------
        IndexError
            When there is no such step.
        """
        if not 0 <= step < self.steps:
            msg = f"time step {step} does not exist: expected 0 to {self.steps - 1}"
            raise IndexError(msg)
        values = self._values
        parts: Parts = {}
        if values is not None and step < len(values):
            parts[f"scalars/{step}"] = np.ascontiguousarray(values[step], "<f4")
        slopes, parts[f"extra/{step}"] = self.packing.step(self.source(step))
        parts[f"slices/{step}"] = slopes
        return parts

    def source(self, step: int) -> int:
        """Return the field's own number of a step that is handed over."""
        return self.kept[step] if self.kept else step

    def moment(self, time: float) -> tuple[int, ...]:
        """Return the steps that are needed to show a time, one or two."""
        before, after, _ = steps_around(self.times, time)
        return (before,) if before == after else (before, after)

    @property
    def nbytes_of_step(self) -> int:
        """Bytes of the arrays of one destination time, known before anything is traced."""
        geometry = self.textures.geometry
        texels = geometry.rows.size * geometry.columns.size
        nodes = geometry.field.valid.size
        numbers = self.textures.count * self.packing.channels + len(self.packing.extra)
        return 2 * texels * numbers + (4 * nodes if self.colours.values is not None else 0)

    @property
    def _values(self) -> NDArray[np.float64] | None:
        """Nodal values of the colours at the times that are handed over, (steps or 1, J, I)."""
        values = self.colours.values
        if values is None or not self.kept or len(values) == 1:
            return values
        return values[list(self.kept)]

    def _geometry(self) -> dict[str, Any]:
        geometry = self.textures.geometry
        return {
            "shape": [int(n) for n in geometry.field.shape],
            "rows": {"before": int(geometry.rows.before), "size": int(geometry.rows.size)},
            "columns": {"before": int(geometry.columns.before), "size": int(geometry.columns.size)},
            "levels": int(geometry.levels),
            "planar": geometry.planar,
            "extent": float(geometry.extent),
            "center": numbers(geometry.center),
            "frame": numbers(geometry.frame.ravel()),
            "periodic": [bool(p) for p in geometry.field.periodic],
        }

    def _slices(self) -> dict[str, Any]:
        textures = self.textures
        return {
            "count": int(textures.count),
            "channels": self.packing.channels,
            "extra": self.packing.extra,
            "lags": numbers(textures.lags),
            "sides": int(textures.sides),
            "unit": float(textures.unit),
            "pace": float(textures.pace),
            "steps": int(self.steps),
            "times": numbers(self.times),
            "timeUnit": textures.geometry.field.time_unit,
            "signFree": bool(textures.geometry.field.sign_free),
        }


@cache
def _shaders(variant: tuple[str, ...]) -> dict[str, str]:
    return {key: shader_text(name, variant) for key, name in SHADERS.items()}
