"""Real surfaces with a joined line of nodes, and what a picture shows across it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

import flowtex
from flowtex.plotting.component import point_camera
from flowtex.rendering.camera import read_camera
from flowtex.rendering.cpu.render import render
from flowtex.scene.options import ViewOptions
from flowtex.textures.texture_set import TextureSet
from flowtex.trace.store import SliceStore

Floats = NDArray[np.float64]
Seam = tuple[flowtex.FlowField, dict[str, dict[str, Any]]]

#: Lines on each side that the joined one is compared with.
BESIDE = 6


def seams() -> dict[str, Seam]:
    """Give the surfaces by name, each with views by name; none where the data is not there."""
    folder = Path(os.environ.get("FLOWTEX_DATA", ""))
    if not (folder / "postxyz.bin").is_file():
        return {}
    post = flowtex.FlowField.from_file(folder / "postxyz.bin", plane="k=20")
    joined = post.points[0]  # the first line of nodes, and the last
    at = {
        f"zoom {z}": {"zoom": float(z), "focus": tuple(joined[row])}
        for z, row in ((4, 20), (24, 10))
    }
    found: dict[str, Seam] = {"post, k = 20": (post, at)}
    if (folder / "eraint_uvz.nc").is_file():
        up = (0.0, 0.0, 1.0)
        views = {
            "180 degrees": {"camera": [(-3.9, 0.0, 0.0), (0.0, 0.0, 0.0), up]},
            "near": {"camera": [(-1.5, 0.0, 0.4), (-1.0, 0.0, 0.2), up]},
            "north pole": {"camera": [(-0.3, 0.0, 1.9), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)]},
        }
        found["wind on a sphere"] = (globe(folder / "eraint_uvz.nc"), views)
    return found


def globe(path: Path) -> flowtex.FlowField:
    """Drape the wind of a month at 500 hPa over a sphere of radius 1."""
    import netCDF4

    with netCDF4.Dataset(path) as data:
        data.set_auto_mask(False)
        u, v = (np.asarray(data[name][0, 1], dtype=float) for name in "uv")
        b, a = np.meshgrid(
            np.radians(data["latitude"][:]), np.radians(data["longitude"][:]), indexing="ij"
        )
    points = np.stack([np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)], axis=-1)
    east = np.stack([-np.sin(a), np.cos(a), 0 * a], axis=-1)
    north = np.stack([-np.sin(b) * np.cos(a), -np.sin(b) * np.sin(a), np.cos(b)], axis=-1)
    return flowtex.FlowField.from_arrays(points, u[..., None] * east + v[..., None] * north)


def across_lines(
    field: flowtex.FlowField, picture: NDArray[Any], options: Any, size: tuple[int, int]
) -> dict[str, float]:
    """Mean change from pixel to pixel across the joined line, and across those beside it."""
    axis_around = field.periodic.index(True)
    i = _lines(field, options, size, axis_around)
    around = field.shape[axis_around] - 1
    grey = np.asarray(picture, dtype=float).mean(axis=-1)
    changes: dict[int, list[float]] = {}
    for axis in (0, 1):
        here, there = (np.take(i, np.arange(n, i.shape[axis] - 1 + n), axis) for n in (0, 1))
        change = np.abs(np.diff(grey, axis=axis))
        with np.errstate(invalid="ignore"):
            line = np.floor(np.maximum(here, there)) % around
            crossed = np.floor(here) != np.floor(there)
            near = np.abs(here - there) < 1
            wrapped = np.abs(here - there) > around - 1
        line = np.where(wrapped, 0, line)
        for number in (n % around for n in range(-BESIDE, BESIDE + 1)):
            chosen = crossed & (near | wrapped) & (line == number)
            changes.setdefault(number, []).extend(change[chosen])
    beside = [float(np.mean(values)) for n, values in changes.items() if n and len(values) > 20]
    joined = float(np.mean(changes[0])) if changes[0] else float("nan")
    return {
        "joined": joined,
        "beside, mean": float(np.mean(beside)),
        "beside, most": float(np.max(beside)),
        "pixels": float(len(changes[0])),
    }


def _lines(field: flowtex.FlowField, options: Any, size: tuple[int, int], axis: int) -> Floats:
    """Index along an axis of what each pixel shows, (H, W), from the renderer in NumPy."""
    settings = flowtex.Settings(samples=1)
    textures = TextureSet.build(SliceStore(field))
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(size))
    if "camera" in options:
        plotter.camera_position = options["camera"]
        plotter.camera.parallel_projection = False
    else:
        point_camera(
            plotter, field.surface, ViewOptions(zoom=options["zoom"], focus=options["focus"])
        )
    seen = render(textures, settings, read_camera(plotter.camera), size)
    plotter.close()
    lines = (textures.geometry.rows, textures.geometry.columns)[axis]
    return np.asarray(seen.coordinate[..., 1 - axis] * lines.size - 0.5 - lines.before)
