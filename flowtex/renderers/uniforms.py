"""The numbers that a shader is given, whoever compiles it.

One function turns a texture set, the settings and the state of the view into the uniforms that
``shaders/common/uniforms.glsl`` declares. A renderer only hands them over.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.settings import Settings
from flowtex.textures import TextureSet

__all__ = ["ViewState", "finest_cell", "uniforms", "variants"]

#: Octaves between the finest cell of the noise and the extent of the surface.
OCTAVES = 30
#: The origin of the noise keeps this many octaves clear, so that single precision holds it.
SNAP = 9
#: Length of one turn of a streaming grain, in pixels.
WAVE = 30.0

KERNELS = ("hann", "box", "ramp")


@dataclass
class ViewState:
    """What changes from frame to frame.

    Attributes
    ----------
    focus
        Point of the mesh that the view looks at, (3,), in the mesh's own coordinates.
    between
        How far the time has come from one destination time of the slices to the next, 0 to 1.
    clock
        Clock of the animation, in seconds.
    """

    focus: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    between: float = 0.0
    clock: float = 0.0


def variants(textures: TextureSet, *, unsteady: bool) -> frozenset[str]:
    """Names of the shader's variant for a texture set."""
    chosen = set()
    if textures.space == "parameter":
        chosen.add("FLOWTEX_PAPER")
    if textures.geometry.planar:
        chosen.add("FLOWTEX_PLANAR")
    if unsteady:
        chosen.add("FLOWTEX_UNSTEADY")
    return frozenset(chosen)


def finest_cell(extent: float) -> float:
    """Width of a cell of the noise's finest octave: a power of two, so that it is exact."""
    return float(2.0 ** (np.floor(np.log2(extent)) - OCTAVES))


def uniforms(textures: TextureSet, settings: Settings, view: ViewState) -> dict[str, Any]:
    """Values by name: bool, int, float, tuples of float, or lists for arrays."""
    geometry = textures.geometry
    finest = finest_cell(geometry.extent)
    cell = _origin_cell(geometry.frame @ (view.focus - geometry.center), finest)
    sides = textures.sides if settings.two_sided else 1
    values: dict[str, Any] = {
        "u_between": float(view.between),
        "u_slicesSize": (float(geometry.columns.size), float(geometry.rows.size)),
        "u_deepest": float(geometry.levels),
        "u_lags": [float(lag) for lag in textures.lags],
        "u_lagCount": len(textures.lags),
        "u_sides": sides,
        "u_unit": textures.unit,
        "u_samples": settings.samples,
        "u_spacing": settings.spacing,
        "u_grain": settings.grain,
        "u_kernel": KERNELS.index(settings.kernel),
        "u_lod": settings.lod,
        "u_contrast": settings.contrast,
        "u_strength": settings.strength,
        "u_seed": settings.seed,
        "u_turn": settings.rate * view.clock % 1.0 if settings.animate else 0.0,
        "u_wave": 1.0 / WAVE if settings.animate else 0.0,
        "u_noiseOrigin": tuple(float(c * finest) for c in cell),
        "u_noiseOriginCell": tuple(float(c) for c in cell),
        "u_noiseFinest": finest,
        "u_texel": geometry.extent / settings.resolution,
    }
    if textures.paper is not None:
        height, width = textures.paper.noise.shape
        values["u_noiseSize"] = (float(width), float(height))
        values["u_noiseCorrected"] = textures.paper.corrected
    return values


def _origin_cell(focus: NDArray[np.float64], finest: float) -> NDArray[np.int64]:
    """Lattice point near the focus, in cells of the finest octave, that a float holds exactly."""
    coarse = 2**SNAP
    limit = 2 ** (OCTAVES - SNAP) - 1
    cell = np.clip(np.rint(focus / finest / coarse), -limit, limit)
    return np.asarray(cell * coarse, dtype=np.int64)
