"""Views of a flow: pictures by the renderer in NumPy, what they should be, and the flow in them.

The renderer in NumPy is used and no graphics card, so that every machine measures the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from flowtex.field import FlowField
from flowtex.first_look import first_look
from flowtex.rendering.cpu import Camera, LookupMaker, Picture, render, shade
from flowtex.rendering.uniforms import ViewState
from flowtex.settings import Settings
from paper import measures
from paper.bench import Bench

__all__ = ["GREY", "Shot", "shoot", "tone"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Colour of a surface without scalars.
GREY = (0.627, 0.627, 0.627)
#: Pixels along an outline that are not judged, and the share of the greatest speed below which the
#: direction of the flow counts as unknown.
BORDER, SLOW = 10, 0.05


@dataclass(frozen=True, eq=False)
class Shot:
    """A field seen by a camera at one of its time steps."""

    bench: Bench
    field: FlowField
    camera: Camera
    step: int = 0

    def picture(
        self, lookup: LookupMaker | None = None, *, density: float = 1.0, **settings: Any
    ) -> Picture:
        """Draw it; ``lookup`` takes the place of the noise."""
        chosen = self.bench.settings(**settings)
        return render(
            self.bench.textures(self.field, chosen),
            chosen,
            self.camera,
            view=ViewState(density=density),
            steps=(self.step, self.step),
            lookup=lookup,
        )

    def reference(self, times: int, **settings: Any) -> Floats:
        """Draw it with ``times`` x ``times`` samples in a pixel, all of the pixel's own level.

        Returns
        -------
        numpy.ndarray
            Mean values, (H, W).
        """
        width, height = self.camera.size
        fine = replace(self, camera=replace(self.camera, size=(width * times, height * times)))
        return measures.blocks(fine.picture(density=times, **settings).value, times)

    @cached_property
    def _places(self) -> tuple[Bools, Floats, Floats]:
        """Pixels of the surface (H, W), their (i, j), (H, W, 2), and positions, (H, W, 3)."""
        surface = self.field.surface
        coverage = cover(surface, self.camera)
        rows, columns = surface.shape
        nodes = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1)
        nodal = np.concatenate([nodes, surface.points - surface.center], axis=-1)
        mixed, _, _ = coverage.mix(nodal.reshape(-1, 5))
        width, height = self.camera.size
        flat = np.full((height * width, 5), np.nan)
        flat[coverage.pixel] = mixed
        image = flat.reshape(height, width, 5)
        return ~np.isnan(image[..., 0]), image[..., :2], image[..., 2:] + surface.center

    @property
    def covered(self) -> Bools:
        """Pixels that show the surface, (H, W)."""
        return self._places[0]

    @property
    def index(self) -> Floats:
        """Position of each pixel in index space, (H, W, 2) as (i, j); NaN off the surface."""
        return self._places[1]

    @property
    def position(self) -> Floats:
        """Position of each pixel in the mesh's coordinates, (H, W, 3); NaN off the surface."""
        return self._places[2]

    @cached_property
    def flow(self) -> tuple[Floats, Floats]:
        """Velocity on the screen, to the right and up, (H, W) each; zero off the surface."""
        velocity = self.nodal(self.field.velocity[min(self.step, len(self.field.velocity) - 1)])
        position = np.nan_to_num(self.position)
        speed = float(np.sqrt(np.mean(self.field.speed**2))) or 1.0
        small = 1e-4 * self.field.surface.extent / speed
        origin = self.field.surface.center
        ends = [self._screen(at - origin, origin) for at in (position, position + small * velocity)]
        moved = np.where(self.covered[..., None], (ends[1] - ends[0]) / small, 0.0)
        return moved[..., 0], moved[..., 1]

    @cached_property
    def speed(self) -> Floats:
        """Speed at each pixel, (H, W), in the field's own units."""
        return self.nodal(self.field.speed[min(self.step, len(self.field.speed) - 1)])

    @cached_property
    def mask(self) -> Bools:
        """Pixels to judge: off the outline and the picture's border, and where something moves."""
        inside = np.pad(self.covered, 1)
        inside = ndimage.binary_erosion(inside, iterations=BORDER + 1)[1:-1, 1:-1]
        return np.asarray(inside & (self.speed > SLOW * self.field.speed.max()))

    def nodal(self, data: Floats) -> Floats:
        """Interpolate nodal data (J, I) or (J, I, C) to the pixels; zero off the surface."""
        i, j = np.moveaxis(np.nan_to_num(self.index), -1, 0)
        channels = data[..., None] if data.ndim == 2 else data
        found = [
            ndimage.map_coordinates(channels[..., c], [j, i], order=1, mode="nearest")
            for c in range(channels.shape[-1])
        ]
        result = np.stack(found, axis=-1) * self.covered[..., None]
        return np.asarray(result[..., 0] if data.ndim == 2 else result)

    def _screen(self, points: Floats, origin: Floats) -> Floats:
        """Pixels to the right and up, (..., 2), of points counted from an origin."""
        matrix = self.camera.matrix(origin)
        clip = points @ matrix[:, :3].T + matrix[:, 3]
        return np.asarray(clip[..., :2] / clip[..., 3:] * np.array(self.camera.size) / 2)

    def streaks(self, value: Floats) -> measures.Streaks:
        """Direction of the texture against the flow."""
        return measures.streaks(value, *self.flow, self.mask)

    def grain(self, value: Floats) -> measures.Grain:
        """Grain of the texture along the flow and across it."""
        return measures.grain(value, *self.flow, self.mask, self.bench.seed)


def shoot(
    bench: Bench,
    field: FlowField,
    size: tuple[int, int],
    *,
    zoom: float = 1.0,
    focus: tuple[float, ...] | None = None,
    step: int = 0,
) -> Shot:
    """Look at a field as ``flowtex.render`` does.

    Parameters
    ----------
    bench
        What is shared.
    field
        What to look at.
    size
        Width and height in pixels.
    zoom, focus, step
        How far in, on what point, and at which time step.
    """
    look = first_look(field, size[0] / size[1], zoom=zoom, focus=focus)
    camera = Camera(
        look.position,
        look.focal_point,
        look.up,
        size,
        parallel_scale=look.parallel_scale if look.parallel else None,
        view_angle=look.view_angle,
    )
    return Shot(bench, field, camera, step)


def tone(value: Floats, colour: Any = GREY, **settings: Any) -> NDArray[np.uint8]:
    """Turn values (H, W), NaN off the surface, into grey (H, W, 3); white where there is none."""
    inside = ~np.isnan(value)
    result = np.ones((*value.shape, 3))
    colours = np.broadcast_to(np.asarray(colour, dtype=float), result.shape)
    result[inside] = shade(colours[inside], value[inside], Settings(**settings))
    return np.asarray(np.rint(255 * result), dtype=np.uint8)
