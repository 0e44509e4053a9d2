"""Rasters with the flow in bands: of glaciers, in m/yr, on a map of the pole."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pyproj
from known_flow import Truth, in_plane, plane, wind
from supported import Made, supported

KIND = "Rasters"
POLAR = "EPSG:3413"
YEAR = 365.25 * 86400
MISSING = -32767.0


def write(path: Path, bands: list[Any], names: tuple[str, ...], unit: str = "m/yr") -> None:
    """Write bands (J, I) with cells of 5 km, of which the numbers have a scale of 0.5."""
    rasterio = import_module("rasterio")
    stack = np.stack(bands)
    form = {"driver": "GTiff", "dtype": "float32", "count": len(bands), "nodata": MISSING}
    size = {"height": stack.shape[1], "width": stack.shape[2]}
    corner = rasterio.Affine(5000, 0, -200000, 0, -5000, -2000000)
    with rasterio.open(path, "w", **form, **size, crs=POLAR, transform=corner) as file:
        numbers = np.where(np.isnan(stack), MISSING, stack / 0.5)
        file.write(numbers.astype("f4"))
        file.scales = [0.5] * len(bands)
        file.units = [unit] * len(bands)
        for number, name in enumerate(names, start=1):
            file.set_band_description(number, name)


def glacier() -> tuple[Any, Any, Truth]:
    """Return components along x and y of a map in m/yr, with a gap, and the truth."""
    x, y = -197500 + 5000.0 * np.arange(12), -2002500 - 5000.0 * np.arange(9)
    across, upward = np.meshgrid(x, y)
    lon, lat = pyproj.Transformer.from_crs(POLAR, 4326, always_xy=True).transform(across, upward)
    east, north = (part * 1e-5 for part in wind(lon, lat))
    # On this map, longitude 45 W points down, and others are turned by their distance from it.
    turn = np.radians(lon + 45)
    vx = YEAR * (east * np.cos(turn) - north * np.sin(turn))
    vy = YEAR * (east * np.sin(turn) + north * np.cos(turn))
    vx[2, 3] = np.nan
    kept = ~np.isnan(vx)
    places = np.stack([lon[kept], lat[kept]], axis=-1)
    return vx, vy, Truth(places, scale=1e-5, tolerance=2e-3)


@supported(
    KIND,
    "GeoTIFF with two bands",
    'flowtex.show("velocity.tif")',
    "descriptions name the bands; CRS, missing data, scale and unit as declared",
    "rioxarray",
)
def two_bands(folder: Path) -> Made:
    vx, vy, truth = glacier()
    write(folder / "velocity.tif", [vx, vy], ("vx", "vy"))
    return {}, truth


@supported(
    KIND,
    "GeoTIFFs of one component each",
    'flowtex.show(["ice_vx_v1.tif", "ice_vy_v1.tif"])',
    "names of files tell the components; in the shell `flowtex show ice_vx_v1.tif ice_vy_v1.tif`",
    "rioxarray",
)
def two_files(folder: Path) -> Made:
    vx, vy, truth = glacier()
    write(folder / "ice_vx_v1.tif", [vx], ())
    write(folder / "ice_vy_v1.tif", [vy], ())
    return {}, truth


@supported(
    KIND,
    "GeoTIFF whose bands have no names",
    'flowtex.show("bands.tif")',
    "band 1 along x, band 2 along y, which a notice reports",
    "rioxarray",
)
def unnamed_bands(folder: Path) -> Made:
    vx, vy, truth = glacier()
    write(folder / "bands.tif", [vx, vy], ())
    return {}, truth


@supported(
    KIND,
    "grids of Esri, one for each component",
    'flowtex.show(["current_u.asc", "current_v.asc"])',
    "names of files tell the components; in the shell `flowtex show current_u.asc current_v.asc`",
    "rioxarray",
)
def grids_of_esri(folder: Path) -> Made:
    x, y = 0.05 + 0.1 * np.arange(10), 0.15 + 0.1 * np.arange(8)
    across, upward = np.meshgrid(x, y)
    for name, values in zip("uv", plane(across, upward), strict=True):
        head = "ncols 10\nnrows 8\nxllcorner 0\nyllcorner 0.1\ncellsize 0.1\nNODATA_value -99\n"
        rows = [" ".join(f"{value:.9g}" for value in row) for row in values[::-1]]
        (folder / f"current_{name}.asc").write_text(head + "\n".join(rows) + "\n")
    return {}, in_plane(x, y)
