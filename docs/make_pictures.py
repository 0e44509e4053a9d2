"""Draw the pictures of the README and of ``docs/gallery.md``: ``make gallery``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

import flowtex

FOLDER = Path(__file__).parent / "pictures"
Picture = NDArray[np.uint8]


def wake() -> Picture:
    """Draw vortex shedding behind a cylinder, the README's picture."""
    return flowtex.render(
        flowtex.examples.cylinder_field(), size=(1200, 420), zoom=3.6, focus=(4.2, 0.0)
    )


def zooms() -> Picture:
    """Draw the nose of an airfoil from afar and from near."""
    field = flowtex.examples.airfoil_field()
    nose = field.points[np.unravel_index(np.argmax(field.speed[0]), field.shape)][:2]
    middle = tuple(field.surface.center[:2])
    views = [(1.0, middle), (8.0, nose), (64.0, nose)]
    return _row([flowtex.render(field, size=(400, 400), zoom=z, focus=tuple(p)) for z, p in views])


def vortices() -> Picture:
    """Draw decaying turbulence at two moments."""
    field = flowtex.examples.vortex_field()
    times = [field.times[10], field.times[-1]]
    return _row(
        [flowtex.render(field, size=(600, 600), time=float(t), cmap="magma") for t in times]
    )


def level_of_detail() -> Picture:
    """Draw the airfoil with level of detail, and without it."""
    field = flowtex.examples.airfoil_field()
    common: dict[str, Any] = {"size": (600, 480), "zoom": 0.8, "scalars": False}
    with_it = flowtex.render(field, **common)
    without = flowtex.render(field, **common, lod=False, resolution=4096)
    return _row([with_it, without])


def correction() -> Picture:
    """Draw the paper's noise texture with the correction of its distribution, and without."""
    field = flowtex.examples.airfoil_field()
    common: dict[str, Any] = {"size": (600, 480), "zoom": 5, "scalars": False, "noise": "texture"}
    return _row(
        [flowtex.render(field, **common, noise_correction=corrected) for corrected in (True, False)]
    )


def sphere() -> Picture:
    """Draw a wind on a sphere, whose seam and poles do not show."""
    longitude, latitude = np.meshgrid(np.linspace(0, 360, 181), np.linspace(-89, 89, 90))
    a, b = np.radians(longitude), np.radians(latitude)
    east = np.stack([-np.sin(a), np.cos(a), 0 * a], axis=-1)
    north = np.stack([-np.sin(b) * np.cos(a), -np.sin(b) * np.sin(a), np.cos(b)], axis=-1)
    points = np.stack([np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)], axis=-1)
    u = np.cos(b) + 0.8 * np.sin(3 * b) * np.cos(2 * a)
    v = 0.7 * np.cos(b) * np.sin(4 * a + 2 * b)
    field = flowtex.FlowField.from_arrays(points, u[..., None] * east + v[..., None] * north)
    return flowtex.render(field, size=(600, 600), zoom=1.5, cmap="turbo", background="#10131a")


def gyre() -> Picture:
    """Draw the double gyre in grey, for print."""
    return flowtex.render(
        flowtex.examples.double_gyre_field(), size=(1200, 620), scalars=False, color="#909090"
    )


PICTURES: dict[str, Callable[[], Picture]] = {
    f.__name__: f for f in (wake, zooms, vortices, level_of_detail, correction, sphere, gyre)
}


def _row(pictures: list[Picture], gap: int = 8) -> Picture:
    """Put pictures side by side."""
    white = np.full((pictures[0].shape[0], gap, 3), 255, np.uint8)
    parts = [part for picture in pictures for part in (picture, white)]
    return np.concatenate(parts[:-1], axis=1)


def main() -> None:
    """Draw every picture into ``docs/pictures``."""
    from rich.progress import track

    FOLDER.mkdir(exist_ok=True)
    for name in track(PICTURES, "Drawing the gallery"):
        Image.fromarray(PICTURES[name]()).save(FOLDER / f"{name}.jpg", quality=84, optimize=True)


if __name__ == "__main__":
    main()
