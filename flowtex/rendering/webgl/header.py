"""Pieces of a scene's header, as plain Python for JSON, and numbers as the client takes them."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.first_look import FirstLook
from flowtex.settings import TABLE
from flowtex.textures import PaperTextures

__all__ = ["Colours", "camera_state", "half", "numbers", "paper_state", "table_state"]

Array = NDArray[Any]

#: Greatest number in half precision.
HALF_MAX = 65504.0


@dataclass(frozen=True, eq=False)
class Colours:
    """How the surface is coloured.

    Attributes
    ----------
    name, unit
        What it is coloured by, for the bar; ``None`` for a plain surface.
    values
        Nodal values, (T or 1, J, I).
    low, high
        Values at the ends of the colour map.
    table
        Colour map, (256, 4) uint8.
    plain, background
        Colours from 0 to 1 where there are no values, and behind the surface.
    lighting
        Whether the surface is lit.
    opacity
        How much of the background it hides, 0 to 1.
    bar
        Whether there is a legend.
    """

    name: str | None = None
    unit: str = ""
    values: NDArray[np.float64] | None = None
    low: float = 0.0
    high: float = 1.0
    table: NDArray[np.uint8] | None = None
    plain: tuple[float, float, float] = (0.63, 0.63, 0.63)
    background: tuple[float, float, float] = (1.0, 1.0, 1.0)
    lighting: bool = False
    opacity: float = 1.0
    bar: bool = True


def camera_state(look: FirstLook) -> dict[str, Any]:
    """Return a camera as the header has it: lists and numbers by name."""
    return {k: list(v) if isinstance(v, tuple) else v for k, v in asdict(look).items()}


def half(values: Array) -> NDArray[np.float16]:
    """Round to half precision; what is greater than its greatest number becomes that."""
    return np.ascontiguousarray(np.clip(values, -HALF_MAX, HALF_MAX), dtype="<f2")


def paper_state(paper: PaperTextures) -> dict[str, Any]:
    """Return what is to be known of the noise texture, or of the picture in its place."""
    height, width = paper.step.shape
    rows, columns = paper.noise.shape[:2]
    return {
        "size": [int(width), int(height)],
        "grain": float(paper.grain),
        "corrected": bool(paper.corrected),
        "deviations": numbers(paper.deviations),
        "repeat": [bool(r) for r in paper.repeat],
        "picture": bool(paper.picture),
        "pictureSize": [int(columns), int(rows)],
        "grey": paper.noise.ndim == 2,
        "alongI": numbers(paper.along_i),
        "alongJ": numbers(paper.along_j),
    }


def table_state() -> list[dict[str, Any]]:
    """Return the table of settings, for controls."""
    return [
        {
            **{k: getattr(row, k) for k in ("name", "default", "affects", "text", "low", "high")},
            "kind": row.kind.__name__,
            "choices": list(row.choices),
        }
        for row in TABLE.values()
    ]


def numbers(values: Any) -> list[float]:
    """Return an array as a flat list of Python's own numbers."""
    return [float(v) for v in np.asarray(values).ravel()]
