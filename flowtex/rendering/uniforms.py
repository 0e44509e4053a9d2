"""The uniforms of the shaders, for all renderers.

One function turns a texture set, the settings and the state of the view into the uniforms that
``shaders/common/uniforms.glsl`` declares. A renderer only passes them on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.rendering.arrow_seeds import seed_limits
from flowtex.rendering.shaders import KERNELS, MEAN_VALUES, const
from flowtex.settings import Settings
from flowtex.textures.images import ImageTextures
from flowtex.textures.noise_textures import NoiseTextures
from flowtex.textures.texture_set import TextureSet

#: Uniforms by name: bool, int, float, tuples of float, or lists for arrays.
Values: TypeAlias = Mapping[str, Any]

NOISE_DOUBLINGS = 30  #: Doublings from the finest cell of the noise to the extent of the surface.
CLEAR_DOUBLINGS = 9  #: Finest doublings at which the origin of the noise is zero.
WAVE_PIXELS = 96.0  #: Pixels of flow in one turn of a grain, up to twice as many.
CLOCK_STEP = 2.0**-12  #: Step of the coarse part of the clock, exact times a power of two.
MOST_TURNS = 2.0**12  #: End of the clock in base periods.

EVEN_RADII = 2.5  #: Standard deviations of the Gaussian of a local mean at which its blur ends.

ARROW_PIECES = 12  #: Pieces of an arrow.
ARROW_LEAST = 0.85  #: Least distance of two arrows over the mean one.
ARROW_MOST_DENSE = 8.0  #: Least distance of two arrows in pixels.

ANCHOR_RANGE = 8.0  #: Heights of the view from the anchor of positions, at most.


@dataclass
class ViewState:
    """State of the view, which changes from frame to frame."""

    #: Point of the mesh that the view looks at, (3,), in the mesh's own coordinates.
    focus: Floats = field(default_factory=lambda: np.zeros(3))
    #: Point of the surface's frame that positions are counted from, (3,).
    anchor: Floats = field(default_factory=lambda: np.zeros(3))
    #: The eye in the mesh's own coordinates and 1, or the direction to it and 0 where all rays
    #: are parallel, (4,).
    eye: Floats = field(default_factory=lambda: np.array([0.0, 0.0, 1.0, 0.0]))
    between: float = 0.0  #: Share of the way to the next destination time, 0 to 1.
    time: float = 0.0  #: Time that is shown of a field that varies, in its own unit.
    still: bool = False  #: Whether grains of a field that varies stand still.
    clock: float = 0.0  #: Clock of the streaming of a steady flow, in seconds.
    density: float = 1.0  #: Drawn pixels, along a side, for one pixel of the settings.
    pixel: float = 0.0  #: Length of a pixel at the focus; 0 is as near as possible.


def variants(
    textures: TextureSet,
    *,
    unsteady: bool | None = None,
    moving: bool = False,
    near: bool = False,
    sparse: bool = False,
) -> frozenset[str]:
    """Return the names of the shader's variant for a texture set and what is seen of it."""
    flow = textures.geometry.field
    conditions = {
        "FLOWTEX_SPARSE": sparse,
        "FLOWTEX_MOVING": moving,
        "FLOWTEX_CELLS": near,
        "FLOWTEX_IMAGE": textures.image is not None,
        "FLOWTEX_PAINTED": textures.image is not None and not textures.image.is_noise,
        "FLOWTEX_PLANAR": textures.geometry.planar,
        "FLOWTEX_SIGNFREE": flow.sign_free,
        "FLOWTEX_TRIANGLES": flow.triangles is not None,
        "FLOWTEX_UNCERTAIN": flow.uncertainty,
        "FLOWTEX_UNSTEADY": textures.store.steps > 1 if unsteady is None else unsteady,
    }
    return frozenset(name for name, holds in conditions.items() if holds)


def client_constants() -> dict[str, Any]:
    """Return the numbers by which a client computes the uniforms itself, for JSON."""
    return {
        "noiseDoublings": NOISE_DOUBLINGS,
        "clearDoublings": CLEAR_DOUBLINGS,
        "wavePixels": WAVE_PIXELS,
        "clockStep": CLOCK_STEP,
        "mostTurns": MOST_TURNS,
        "kernels": list(KERNELS),
        "anchorRange": ANCHOR_RANGE,
        "arrows": {
            "pieces": ARROW_PIECES,
            "least": ARROW_LEAST,
            "mostDense": ARROW_MOST_DENSE,
            **seed_limits(),
        },
        "farCells": const.FAR_CELLS,
        "even": {"sigma": const.EVEN_SIGMA, "radii": EVEN_RADII},
        "shading": {
            "toCones": const.TO_CONES.ravel().tolist(),
            "toLab": const.TO_LAB.ravel().tolist(),
            "fromLab": const.FROM_LAB.ravel().tolist(),
            "fromCones": const.FROM_CONES.ravel().tolist(),
            "base": [const.BASE_DARK, const.BASE_LIGHT],
            "tone": [const.TONE_RANGE, const.TONE_SLOPE],
            "values": MEAN_VALUES.tolist(),
        },
    }


def uniforms(textures: TextureSet, settings: Settings, view: ViewState) -> dict[str, Any]:
    """Return the uniforms by name, and ``moving``, ``near`` and ``sparse`` for the variant."""
    geometry = textures.geometry
    # A power of two, so that it is exact.
    finest = float(2.0 ** (np.floor(np.log2(geometry.extent)) - NOISE_DOUBLINGS))
    sides, kernel = _direction(textures, settings)
    moving = is_moving(textures, settings, view)
    sparse = is_sparse(textures, settings)
    eye = geometry.frame @ (view.eye[:3] - view.eye[3] * geometry.center)
    eye -= view.eye[3] * view.anchor
    values: dict[str, Any] = {
        "u_eye": (*(float(c) for c in eye), float(view.eye[3])),
        "u_between": float(view.between),
        "u_slicesSize": (float(geometry.size[1]), float(geometry.size[0])),
        "u_deepest": float(geometry.levels),
        "u_lags": [float(lag) for lag in textures.lags],
        "u_lagCount": len(textures.lags),
        "u_rateLayer": textures.count - 1,
        "u_cell": textures.cell,
        "u_sides": sides,
        "u_unit": textures.unit,
        "u_samples": 2 * settings.samples - 1 if moving else settings.samples,
        "u_spacing": settings.spacing,
        "u_grain": settings.grain * view.density,
        "u_kernel": KERNELS.index(kernel),
        "u_lod": settings.lod,
        "u_contrast": settings.contrast,
        "u_strength": settings.strength,
        "u_even": is_even(textures, settings),
        # Layer 2 of a node that points against others is one without the speed.
        "u_fade": 0.0 if geometry.field.sign_free else settings.fade,
        "u_seed": settings.seed,
        "u_showLevel": settings.show_level,
        "u_fixed": settings.fixed_grain,
        "moving": moving,
        "near": is_near(textures, settings, view),
        "sparse": sparse,
        **_motion(textures, settings, view),
        **_noise_origin(geometry.local(view.focus), finest, view.anchor),
        "u_noiseFinest": finest,
        "u_texel": geometry.extent / settings.resolution,
        "u_apart": arrow_distance(settings) * view.density,
        "u_bySpeed": settings.arrow_length == "speed",
        "u_arrowSides": textures.sides,
        "u_pieces": ARROW_PIECES,
    }
    if textures.image is not None:
        values |= _image(textures.image, settings, view.density)
    return values


def is_moving(textures: TextureSet, settings: Settings, view: ViewState) -> bool:
    """Return whether grains change in time: in a field that varies, or streaming by the clock."""
    if textures.image is not None:
        return False
    streams = settings.motion != "off" and not textures.geometry.field.sign_free
    return streams or (textures.store.steps > 1 and not view.still)


def is_sparse(textures: TextureSet, settings: Settings) -> bool:
    """Return whether the texture consists of streaklets, which an image cannot."""
    return settings.texture == "streaklets" and textures.image is None


def is_even(textures: TextureSet, settings: Settings) -> bool:
    """Return whether the texture's local mean is subtracted, where grains fit the pixels."""
    fits = settings.lod and not settings.fixed_grain
    return fits and textures.image is None and not is_sparse(textures, settings)


def has_arrows(textures: TextureSet, settings: Settings) -> bool:
    """Return whether arrows are drawn, which sign-free fields and images lack."""
    signed = not textures.geometry.field.sign_free
    return settings.arrows > 0 and signed and textures.image is None


def arrow_distance(settings: Settings) -> float:
    """Return the least distance of arrows, in pixels of the settings."""
    return ARROW_LEAST * max(settings.arrows, ARROW_MOST_DENSE)


def is_near(textures: TextureSet, settings: Settings, view: ViewState) -> bool:
    """Return whether a path may be so short that it stays in a cell where the flow turns."""
    near = view.pixel
    geometry = textures.geometry
    if view.eye[3]:
        to_focus = float(np.linalg.norm(view.eye[:3] - view.focus))
        away = float(np.linalg.norm(view.eye[:3] - geometry.center)) - 0.5 * geometry.extent
        near *= max(away, 0.0) / to_focus
    side = settings.samples // 2 * _distance(textures, settings, view, near)
    return bool(side < const.FAR_CELLS * textures.critical_cell)


def _distance(textures: TextureSet, settings: Settings, view: ViewState, pixel: float) -> float:
    grain = pixel * settings.grain * view.density
    extent = textures.geometry.extent
    if not settings.lod:
        grain = extent / settings.resolution
    elif settings.fixed_grain:
        grain = max(grain, extent / settings.resolution)
    return grain * settings.spacing


def _direction(textures: TextureSet, settings: Settings) -> tuple[int, str]:
    """Return the sides of the paths, and a kernel: symmetric where the field has no sign."""
    if is_sparse(textures, settings):
        return textures.sides, "hann" if textures.geometry.field.sign_free else "ramp"
    if textures.geometry.field.sign_free:
        return textures.sides, "hann" if settings.kernel == "ramp" else settings.kernel
    return textures.sides if settings.two_sided else 1, settings.kernel


def _motion(textures: TextureSet, settings: Settings, view: ViewState) -> Values:
    """Return the motion of grains: by the time of a field that varies, or by the clock."""
    store = textures.store
    if store.steps > 1:
        # About the time in which the flow crosses the surface, a whole share of the series, so that
        # a periodic one has no seam.
        first = float(store.field.times[0])
        last = float(store.field.times[-1])
        rounds = (last - first) * textures.typical_speed / textures.geometry.extent
        period = (last - first) / (np.floor(rounds + 0.5) or rounds)
        # Whole turns count for nothing, and single precision holds no more.
        turns = (view.time - first) / period % MOST_TURNS
        travel = textures.typical_speed * period
        pixels = False
        by_speed = True
    else:
        turns = view.clock / settings.period % MOST_TURNS
        travel = settings.speed * settings.period
        pixels = settings.speed_in == "pixels"
        by_speed = settings.motion == "speed"
    coarse = float(np.floor(turns / CLOCK_STEP) * CLOCK_STEP)
    return {
        "u_clock": (coarse, float(turns - coarse)),
        "u_travel": float(travel) * (view.density if pixels else 1.0),
        "u_travelInPixels": pixels,
        "u_travelBySpeed": by_speed,
        "u_wave": WAVE_PIXELS * view.density,
    }


def _noise_origin(focus: Floats, finest: float, anchor: Floats) -> Values:
    """Return the uniforms of the noise's origin, a point of its lattices near the focus.

    Octaves of the noise are sqrt(2) apart. Even ones have cells of ``finest`` times powers of two,
    odd ones sqrt(2) times as wide. The origin is given as a length from ``anchor``, to which
    positions in shaders are relative, and in cells of octaves 0 and 1: a multiple of ``coarse``,
    which coarser octaves divide without a rest, and for octave 1 what is left.
    """
    coarse = 2**CLEAR_DOUBLINGS
    limit = 2 ** (NOISE_DOUBLINGS - CLEAR_DOUBLINGS) - 1
    even = np.clip(np.rint(focus / finest / coarse), -limit, limit) * coarse + 0.0
    odd = even / np.sqrt(2.0)
    odd_cell = np.floor(odd / coarse) * coarse
    return {
        "u_noiseOrigin": tuple(float(c) for c in even * finest - anchor),
        "u_noiseOriginEven": tuple(float(c) for c in even),
        "u_noiseOriginOdd": tuple(float(c) for c in odd_cell),
        "u_noiseRestOdd": tuple(float(c) for c in odd - odd_cell),
    }


def _image(image: ImageTextures, settings: Settings, density: float) -> Values:
    """Return the uniforms of an image, or of noise that is a texture, by name."""
    height, width = image.step.shape
    rows, columns = image.texels.shape[:2]
    if isinstance(image, NoiseTextures):
        # A texel of the level that is drawn is a grain.
        texels = density * settings.grain
        tiles = 1
    else:
        texels = density * settings.tiles
        tiles = settings.tiles
    values: dict[str, Any] = {
        "u_stepSize": (float(width * density), float(height * density)),
        "u_imageSize": (float(columns * texels), float(rows * texels)),
        "u_imageRound": (float(image.repeat[1]), float(image.repeat[0])),
        "u_tiles": float(tiles),
    }
    if isinstance(image, NoiseTextures):
        values["u_noiseDeviations"] = image.deviations
    return values
