"""The views over which all renderers must draw the same picture.

How near they come. All get the same half-precision textures and the same uniforms, and the
renderer in NumPy, in double precision, judges the others. What is left is single precision along
the path, eight bits at the end, and at the greatest zooms the position of a pixel in its cell: 0.02
to 0.55 of a step of 8 bits, root mean square, while two hundredths more of a setting make nearly a
whole step. Few pixels differ by more than 8 steps: those where two nearly equal numbers decide,
such as the lag at which a path ends.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from functools import cache, partial
from typing import Any

import numpy as np
from flows import (
    across,
    arched,
    dense_gyre,
    fan,
    folded,
    fountain,
    gyre,
    holed,
    lines,
    rippled,
    scattered_fountain,
    scattered_gyre,
    scattered_holed,
    scattered_swinging,
    screw,
    swinging,
    torus,
    uncertain,
)

from flowtex import FlowField
from flowtex._util.array_types import Bytes, Floats
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.render import render
from flowtex.rendering.uniforms import ViewState
from flowtex.scene.options import Appearance
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

#: Root mean square in steps of 8 bits, and share of pixels that differ by more than 8 of them.
ROOT, SHARE = 0.6, 0.001
SIZE = (180, 120)  #: One and a half times as wide as high: what the client widens no camera for.
SMALL = (150, 100)  #: Of the pictures by NumPy, which takes tenths of a second for each.
COLOUR, GROUND = (0.6, 0.6, 0.6), (1.0, 0.0, 0.0)


def straight(zoom: float, focus: tuple[float, float] = (0.63, 0.37)) -> Camera:
    """See a part of a plane without perspective."""
    x, y = focus
    return Camera((x, y, 5.0), (x, y, 0.0), (0, 1, 0), parallel=True, parallel_scale=0.9 / zoom)


WHOLE, MIDDLE = straight(1, (1.0, 0.5)), straight(1, (0.0, 0.0))
SOURCE = straight(1.6, (0.3, 0.25))
TILTED = Camera((1.9, -0.9, 1.1), (0.9, 0.45, 0.0), (0, 0, 1))
GRAZING = Camera((1.0, -0.3, 0.2), (1.0, 0.5, 0.0), (0, 0, 1))
CORNER = Camera((3.4, -2.9, 2.5), (0.0, 0.0, 0.0), (0, 0, 1))
ASIDE = Camera((2.4, -1.9, 1.5), (0.0, 0.0, 0.0), (0, 0, 1))

IMAGE = np.zeros((30, 50, 4))
IMAGE[..., :2] = np.moveaxis(np.indices((30, 50)), 0, -1) / 50
IMAGE[5:25, 10:40, 3] = 1.0

LAID: dict[str, Any] = {"noise": "image", "strength": 1.0}
TEXTURE: dict[str, Any] = {"noise": "texture", "resolution": 256}
MOTION = {"motion": "speed"}
#: A seed without a bright grain in the corner, where the flow rests and rounding decides.
STREAKLETS: dict[str, Any] = {"texture": "streaklets", "seed": 1}


@dataclasses.dataclass(frozen=True, eq=False)
class View:
    """A field, from where it is seen, and how it is drawn."""

    field: Callable[[], FlowField] = gyre
    camera: Camera = WHOLE
    settings: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    time: float | None = None
    clock: float = 0.0

    @property
    def image(self) -> Floats | None:
        """What is laid on the surface."""
        return IMAGE if self.settings.get("noise") == "image" else None

    def made(self) -> Scene:
        """Make the flow with its settings, at its time."""
        settings = Settings(**{"samples": 11, **self.settings})
        shown = Scene(self.field(), settings, Appearance.of(image=self.image))
        if self.time is not None:
            shown.time = self.time
        return shown


@cache
def uncertain_gyre() -> FlowField:
    """Return the vortices, the one at the right less well known."""
    return uncertain(gyre())


@cache
def half_still(steps: int = 1) -> FlowField:
    """Return a flow that is slow or fast at the right, and zero or rounding at the left."""
    x, y = np.meshgrid(np.linspace(0, 2, 61), np.linspace(0, 1, 31))
    speed = np.where(x < 1, 1e-18, np.where(y < 0.5, 1e-4, 1.0))
    velocity = speed[..., None] * np.stack([0.5 + 0 * x, np.cos(6 * x)], axis=-1)
    velocity[y > 0.5] *= velocity[y > 0.5] > 1e-9
    points = np.stack([x, y], axis=-1)
    if steps > 1:
        return FlowField.from_arrays(
            points, velocity * np.arange(1, steps + 1)[:, None, None, None]
        )
    return FlowField.from_arrays(points, velocity)


#: Each is another part of the shaders, or of what they are given.
VIEWS: dict[str, View] = {
    "whole": View(),
    "zoom 4096": View(camera=straight(4096)),
    "many cells in a pixel": View(dense_gyre),
    "many samples": View(camera=straight(4), settings={"samples": 49, "spacing": 1.2}),
    "tilted": View(camera=TILTED),
    "grazing": View(camera=GRAZING),
    "curved": View(torus, ASIDE),
    "holes": View(holed, MIDDLE),
    "levels": View(camera=TILTED, settings={"show_level": True}),
    "no lod": View(settings={"lod": False, "resolution": 128}),
    "box": View(camera=straight(4), settings={"kernel": "box"}),
    "one-sided": View(camera=straight(4), settings={"two_sided": False, "kernel": "ramp"}),
    "by time": View(camera=straight(4), settings={"parameter": "time"}),
    "fixed grain": View(camera=straight(2), settings={"fixed_grain": True, "resolution": 128}),
    "streaming": View(camera=straight(2), settings=MOTION, clock=1.7),
    "streaklets": View(camera=straight(4), settings=STREAKLETS),
    "streaklets, curved": View(torus, ASIDE, STREAKLETS),
    "streaklets, streaming": View(camera=straight(2), settings=STREAKLETS | MOTION, clock=1.7),
    "streaklets, source": View(fountain, SOURCE, STREAKLETS),
    "streaklets, near a source": View(
        fountain, straight(16, (0.3, 0.25)), STREAKLETS | MOTION, clock=1.7
    ),
    "streaklets, near triangles": View(scattered_fountain, straight(16, (0.3, 0.25)), STREAKLETS),
    "between two steps": View(swinging, MIDDLE, {"lines": "pathlines"}, time=0.55),
    "between two steps, moving": View(
        swinging, MIDDLE, {"lines": "pathlines", "motion": "speed"}, time=0.55
    ),
    "streamlines": View(swinging, MIDDLE, {"lines": "streamlines"}, time=0.55),
    # At this moment the centre is within a cell.
    "streamlines, near": View(
        swinging, straight(16, (0.11, 0.32)), {"lines": "streamlines"}, time=0.55
    ),
    "half still": View(half_still),
    "half still, streaming": View(half_still, straight(2, (1.006, 0.5)), MOTION, clock=1.7),
    "half still, between two steps": View(partial(half_still, steps=3), time=0.55),
    "without a sign": View(lines, MIDDLE),
    "centre": View(camera=straight(64, (0.5, 0.5))),
    "centre, streaming": View(camera=straight(8, (0.5, 0.5)), settings=MOTION, clock=1.7),
    "triangles": View(scattered_gyre),
    "triangles, grazing": View(scattered_gyre, GRAZING),
    "triangles, centre": View(scattered_gyre, straight(64, (0.5, 0.5))),
    "triangles, thin": View(fan, straight(3, (0.0, 0.1))),
    "triangles, curved": View(rippled, ASIDE),
    "triangles, sharp edge": View(folded, ASIDE),
    "triangles, beside a sharp edge": View(screw, ASIDE),
    "triangles, across the flow": View(across, CORNER),
    "triangles, noise across the flow": View(partial(across, 0.01), CORNER),
    "noise across the flow": View(arched, CORNER),
    "triangles, holes": View(scattered_holed, MIDDLE),
    "triangles, between two steps": View(
        scattered_swinging, MIDDLE, {"lines": "pathlines"}, time=0.55
    ),
    "uncertain": View(uncertain_gyre),
    "uncertain, streaklets": View(uncertain_gyre, straight(2), STREAKLETS | MOTION, clock=1.7),
    "uncertain, centre": View(uncertain_gyre, straight(64, (0.5, 0.5))),
    "uncertain, between two steps": View(
        lambda: uncertain(swinging()), MIDDLE, {"lines": "pathlines"}, time=0.55
    ),
    "noise texture": View(settings=TEXTURE),
    "noise texture, near": View(camera=straight(32), settings=TEXTURE),
    "noise texture, tilted": View(camera=TILTED, settings=TEXTURE | {"samples": 49}),
    "noise texture, curved": View(torus, ASIDE, TEXTURE | {"grain": 1.0}),
    "noise texture, no lod": View(settings=TEXTURE | {"lod": False, "resolution": 64}),
    "noise texture in time": View(swinging, MIDDLE, TEXTURE | {"fade": 0.5}, time=0.55),
    "uncertain, noise texture": View(uncertain_gyre, settings=TEXTURE),
    "uncertain, image": View(uncertain_gyre, settings=LAID),
    "fading": View(settings={"fade": 0.9}),
    "image": View(settings=LAID | {"tiles": 3}),
    "image, mixed": View(camera=TILTED, settings=LAID | {"strength": 0.5}),
    "image, curved": View(torus, ASIDE, LAID),
    "image, no lod": View(settings=LAID | {"lod": False, "kernel": "box"}),
    "image in time": View(swinging, MIDDLE, LAID, time=0.55),
}


#: Deeper than VTK comes to: the positions that it passes on are single, half a pixel here.
DEEP: dict[str, View] = {
    "zoom 1e5": View(camera=straight(1e5)),
    "triangles, zoom 1e5": View(scattered_gyre, straight(1e5)),
}


@cache
def judged(name: str) -> tuple[Scene, Bytes]:
    """Return a view and its picture by NumPy, (H, W, 3)."""
    view = (VIEWS | DEEP)[name]
    shown = view.made()
    before, after, between = shown.moment
    state = ViewState(between=between, still=True, clock=view.clock)
    steps = (before, after)
    drawn = render(shown.textures, shown.settings, view.camera, SMALL, view=state, steps=steps)
    return shown, drawn.rgb(COLOUR, background=GROUND)


def difference(theirs: Bytes, ours: Bytes) -> tuple[float, float, int]:
    """Root mean square, share beyond 8 steps, and pixels that only one of them covers."""
    ground = np.rint(255 * np.array(GROUND))
    covered = [(p != ground).any(axis=-1) for p in (theirs, ours)]
    off = (theirs.astype(float) - ours)[covered[0] & covered[1]]
    root = float(np.sqrt(np.mean(off**2)))
    return root, float(np.mean(np.abs(off) > 8)), int((covered[0] != covered[1]).sum())
