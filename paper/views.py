"""Views of a flow: pictures by the renderer in NumPy, what they should be, and the flow in them.

The renderer in NumPy is used and no graphics card, so that every machine measures the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy import ndimage

from flowtex import quality
from flowtex._util.array_types import Bools, Bytes, Floats
from flowtex.field import FlowField
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.raster import cover
from flowtex.rendering.cpu.render import Picture, render
from flowtex.rendering.cpu.shade import shade
from flowtex.rendering.cpu.texture import LookupMaker
from flowtex.rendering.uniforms import ViewState
from flowtex.settings import Settings
from paper.bench import Bench
from paper.blocks import block_means

#: Colour of a surface without scalars.
SURFACE_GREY = (0.627, 0.627, 0.627)
#: Pixels along an outline that are not judged, and the share of the greatest speed below which the
#: direction of the flow counts as unknown.
BORDER_PIXELS, SLOW_SHARE = 10, 0.05
#: Views of the wing: where the camera stands, what it looks at from afar and close up, and half
#: the height that it sees.
WING_EYE, WING_WHOLE, WING_NEAR = (0.25, -1.0, 1.5), (0.56, 0.0, 0.0), (0.78, -0.16, 0.03)
WING_HALF_HEIGHT = 0.43


@dataclass(frozen=True, eq=False)
class View:
    """A field seen by a camera at one of its time steps."""

    bench: Bench
    field: FlowField
    camera: Camera
    #: Width and height of the picture in pixels.
    size: tuple[int, int]
    step: int = 0

    def picture(
        self, lookup: LookupMaker | None = None, *, density: float = 1.0, **settings: Any
    ) -> Picture:
        """Draw it; ``lookup`` takes the place of the noise."""
        textures = self.bench.textures(self.field, **settings)
        return render(
            textures,
            self.bench.settings(**settings),
            self.camera,
            self.size,
            view=ViewState(density=density),
            steps=(self.step, self.step),
            lookup=lookup or self.bench.lookup(textures),
        )

    def reference(self, times: int, **settings: Any) -> Floats:
        """Draw it with ``times`` x ``times`` samples in a pixel, all of the pixel's own level.

        Returns
        -------
        numpy.ndarray
            Mean values, (H, W).
        """
        width, height = self.size
        fine = replace(self, size=(width * times, height * times))
        return block_means(fine.picture(density=times, **settings).value, times)

    @cached_property
    def _surface(self) -> tuple[Bools, Floats, Floats]:
        """Pixels of the surface (H, W), their (i, j), (H, W, 2), and positions, (H, W, 3)."""
        surface = self.field.surface
        coverage = cover(surface, self.camera, self.size)
        rows, columns = surface.shape
        nodes = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1)
        nodal = np.concatenate([nodes, surface.points - surface.center], axis=-1)
        mixed, _, _ = coverage.mix(nodal.reshape(-1, 5))
        width, height = self.size
        flat = np.full((height * width, 5), np.nan)
        flat[coverage.pixel] = mixed
        image = flat.reshape(height, width, 5)
        return ~np.isnan(image[..., 0]), image[..., :2], image[..., 2:] + surface.center

    @property
    def covered(self) -> Bools:
        """Pixels that show the surface, (H, W)."""
        return self._surface[0]

    @property
    def index(self) -> Floats:
        """Position of each pixel in index space, (H, W, 2) as (i, j); NaN off the surface."""
        return self._surface[1]

    @property
    def position(self) -> Floats:
        """Position of each pixel in the mesh's coordinates, (H, W, 3); NaN off the surface."""
        return self._surface[2]

    @cached_property
    def flow(self) -> tuple[Floats, Floats]:
        """Velocity on the screen, to the right and up, (H, W) each; zero off the surface."""
        velocity = self.nodal(self.field.velocity[min(self.step, len(self.field.velocity) - 1)])
        position = np.nan_to_num(self.position)
        speed = float(np.sqrt(np.mean(self.field.speed**2))) or 1.0
        small = 1e-4 * self.field.surface.extent / speed
        origin = self.field.surface.center
        ends = [self._screen(at - origin, origin) for at in (position, position + small * velocity)]
        on_screen = np.where(self.covered[..., None], (ends[1] - ends[0]) / small, 0.0)
        return on_screen[..., 0], on_screen[..., 1]

    @cached_property
    def speed(self) -> Floats:
        """Speed at each pixel, (H, W), in the field's own units."""
        return self.nodal(self.field.speed[min(self.step, len(self.field.speed) - 1)])

    @cached_property
    def mask(self) -> Bools:
        """Pixels to judge: off the outline and the picture's border, and where something moves."""
        inside = np.pad(self.covered, 1)
        inside = ndimage.binary_erosion(inside, iterations=BORDER_PIXELS + 1)[1:-1, 1:-1]
        return np.asarray(inside & (self.speed > SLOW_SHARE * self.field.speed.max()))

    def nodal(self, data: Floats) -> Floats:
        """Interpolate nodal data (J, I) or (J, I, C) to the pixels; zero off the surface."""
        i, j = np.moveaxis(np.nan_to_num(self.index), -1, 0)
        channels = data[..., None] if data.ndim == 2 else data
        at_pixels = [
            ndimage.map_coordinates(channels[..., c], [j, i], order=1, mode="nearest")
            for c in range(channels.shape[-1])
        ]
        result = np.stack(at_pixels, axis=-1) * self.covered[..., None]
        return np.asarray(result[..., 0] if data.ndim == 2 else result)

    def _screen(self, points: Floats, origin: Floats) -> Floats:
        """Pixels to the right and up, (..., 2), of points counted from an origin."""
        matrix = self.camera.matrix(self.size[0] / self.size[1], origin)
        clip = points @ matrix[:, :3].T + matrix[:, 3]
        return np.asarray(clip[..., :2] / clip[..., 3:] * np.array(self.size) / 2)

    def streaks(self, value: Floats) -> quality.Alignment:
        """Direction of the texture against the flow."""
        return quality.alignment(value, *self.flow, self.mask)

    def grain(self, value: Floats) -> quality.Grain:
        """Grain of the texture along the flow and across it."""
        return quality.grain(value, *self.flow, self.mask, seed=self.bench.seed)


def view_of(
    bench: Bench,
    field: FlowField,
    size: tuple[int, int],
    *,
    zoom: float = 1.0,
    focus: tuple[float, ...] | None = None,
    step: int = 0,
) -> View:
    """Look at a field as ``flowtex.render`` does.

    Parameters
    ----------
    bench
        Scale, seed and shared textures of the run.
    field
        What to look at.
    size
        Width and height in pixels.
    zoom, focus, step
        How far in, on what point, and at which time step.
    """
    camera = Camera.fit(field.surface, size[0] / size[1], zoom=zoom, focus=focus)
    return View(bench, field, camera, size, step)


def wing_view(bench: Bench, size: tuple[int, int], zoom: float) -> View:
    """Look at the wing from above and aside; closer, at the flow beside its left edge."""
    at = WING_NEAR if zoom > 1 else WING_WHOLE
    eye = tuple(e - w + a for e, w, a in zip(WING_EYE, WING_WHOLE, at, strict=True))
    scale = WING_HALF_HEIGHT * max(1.0, 1.45 * size[1] / size[0]) / zoom
    position = (eye[0], eye[1], eye[2])
    camera = Camera(position, at, (0.0, 0.0, 1.0), parallel=True, parallel_scale=scale)
    return View(bench, bench.shuttle, camera, size)


def grey(value: Floats, colour: Any = SURFACE_GREY, **settings: Any) -> Bytes:
    """Turn values (H, W), NaN off the surface, into grey (H, W, 3); white where there is none."""
    inside = ~np.isnan(value)
    result = np.ones((*value.shape, 3))
    colours = np.broadcast_to(np.asarray(colour, dtype=float), result.shape)
    result[inside] = shade(colours[inside], value[inside], Settings(**settings))
    return np.asarray(np.rint(255 * result), dtype=np.uint8)
