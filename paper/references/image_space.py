"""Texture advection in the image, frame upon frame.

J. van Wijk, "Image based flow visualization on curved surfaces", Proceedings of IEEE
Visualization 2003, pp. 123-131 (IBFVS); R. Laramee, B. Jobard and H. Hauser, "Image space based
visualization of unsteady flow on surfaces", the same, pp. 131-138 (ISA).

The velocity is projected to the image with the surface, as in ISA. Every frame is the one before,
carried along by that velocity, with a little fresh noise blended in:

    F(x, n) = (1 - blend) F(x - v(x), n - 1) + blend G(x, n)

where each grain of the noise G blinks with its own phase, as in IBFVS. G lies on the pixels: its
grains have one size however far away the surface is, and stay where they are when the surface
moves. What F has gathered under one view is still in it under the next, and only fades with
(1 - blend)^n: after a move the streaks are wrong, and come right over several frames. Beside the
surface there is noise alone, and it is carried onto the surface where the flow comes in.

Left out: shading, which is the caller's; the blending of overlaid images; edges, so that what
lies in front streaks onto what lies behind it; and time-varying flow.
"""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from flowtex._util.array_types import Floats
from flowtex.errors import raise_faults
from flowtex.field import FlowField
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.raster import cover

#: Frames in which a grain of the noise blinks once.
BLINK_FRAMES = 24


class ImageSpace:
    """A sequence of frames.

    Parameters
    ----------
    camera
        From where; :meth:`look` moves it.
    size
        Width and height of the frames in pixels.
    field
        The flow.
    blend
        Share of fresh noise in a frame. Streaks are about ``pixels / blend`` long.
    pixels
        Way of the flow from one frame to the next in pixels: everywhere with ``even``, else
        where it is fastest in the image.
    even
        Whether slow flow makes streaks as long as fast flow does.
    grain
        Width of a grain of the noise in pixels.
    seed
        Number of the noise.
    step
        Which time step.

    Raises
    ------
    ValueError
        When a number is out of range; all faults are listed.
    """

    def __init__(
        self,
        camera: Camera,
        size: tuple[int, int],
        field: FlowField,
        *,
        blend: float = 0.1,
        pixels: float = 2.0,
        even: bool = True,
        grain: float = 1.0,
        seed: int = 0,
        step: int = 0,
    ) -> None:
        ranges = (("blend", blend, 1.0), ("pixels", pixels, np.inf), ("grain", grain, np.inf))
        raise_faults(
            [
                f"{name} is {value!r}; expected more than 0 and at most {most:g}"
                for name, value, most in ranges
                if not 0 < value <= most
            ]
        )
        self._field, self._blend, self._pixels, self._even = field, blend, pixels, even
        self._velocity = _along_surface(field, step)
        self.size = width, height = size
        texels = [int(np.ceil(n / grain)) + 1 for n in (height, width)]
        self._phase = np.random.default_rng(seed).random(texels)
        self._lattice = np.indices((height, width)) / grain
        self._count = 0
        # As strong as frames that share no sample come to be, so that nothing has to fade first.
        self._first = float(np.sqrt(blend / (2 - blend)))
        self._picture = self._first * self._noise(0)
        self.look(camera)

    def look(self, camera: Camera) -> None:
        """Move the camera; the frame that is advected stays what it is."""
        self.camera = camera
        #: Way of the flow in a frame, to the right and down in pixels, (H, W, 2); NaN outside.
        self.way: Floats = self._projected(camera)

    def frame(self) -> Floats:
        """Advect the last frame by one step and return the next.

        Returns
        -------
        numpy.ndarray
            (H, W), row 0 at the top, of mean zero; NaN where there is no surface.
        """
        covered = ~np.isnan(self.way[..., 0])
        self._count += 1
        fresh = self._noise(self._count)
        rows, columns = np.nonzero(covered)
        way = self.way[covered]
        at = np.stack([rows - way[:, 1], columns - way[:, 0]])
        carried = ndimage.map_coordinates(self._picture, at, order=1, mode="nearest")
        self._picture = self._first * fresh
        self._picture[covered] = carried + self._blend * (fresh[covered] - carried)
        return np.where(covered, self._picture, np.nan)

    def frames(self, count: int) -> Floats:
        """Advect ``count`` steps and return the last frame, (H, W)."""
        for _ in range(count - 1):
            self.frame()
        return self.frame()

    def _noise(self, count: int) -> Floats:
        """Grains at one moment of their blinking, (H, W), of deviation one."""
        lit = np.sqrt(2.0) * np.cos(2 * np.pi * (count / BLINK_FRAMES + self._phase))
        return np.asarray(ndimage.map_coordinates(lit, self._lattice, order=1))

    def _projected(self, camera: Camera) -> Floats:
        """Way of the flow in a frame under a camera, (H, W, 2)."""
        surface = self._field.surface
        nodal = np.concatenate([surface.points - surface.center, self._velocity], axis=-1)
        coverage = cover(surface, camera, self.size)
        mixed, _, _ = coverage.mix(nodal.reshape(-1, 6))
        matrix = camera.matrix(self.size[0] / self.size[1], surface.center)
        clip = mixed[:, :3] @ matrix[:, :3].T + matrix[:, 3]
        change = mixed[:, 3:] @ matrix[:, :3].T
        w = clip[:, 3:]
        way = (change[:, :2] - clip[:, :2] / w * change[:, 3:]) / w
        way *= 0.5 * np.array(self.size) * [1, -1]
        length = np.linalg.norm(way, axis=-1, keepdims=True)
        fastest = length.max(initial=0.0)
        scale = length if self._even else fastest
        way *= self._pixels / np.where(length > 1e-9 * fastest, scale, np.inf)
        width, height = self.size
        picture = np.full((height * width, 2), np.nan)
        picture[coverage.pixel] = way
        return picture.reshape(height, width, 2)


def _along_surface(field: FlowField, step: int) -> Floats:
    """Velocity along the surface at the nodes, (J, I, 3)."""
    p_i, p_j = field.surface.tangents
    u = field.index_velocity.components[step]
    return np.asarray(u[..., :1] * p_i + u[..., 1:] * p_j)
