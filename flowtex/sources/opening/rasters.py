"""Rasters as datasets: two bands of one file, or one band of each of two files.

They are GeoTIFF, or grids of Esri in text.
"""

from __future__ import annotations

import gc
import re
from pathlib import Path
from typing import TYPE_CHECKING

from flowtex._util.memory import check_memory
from flowtex.errors import FieldError, import_package
from flowtex.sources.notices import NOTE

if TYPE_CHECKING:
    import xarray as xr

#: Drivers of GDAL by the ending of a file: of GeoTIFF, and of the text grids of Esri.
DRIVERS = {".tif": "GTiff", ".tiff": "GTiff", ".asc": "AAIGrid"}
GRID_BEGIN = b"ncols"  #: The first word of a grid of Esri.
#: Parts of names of files that tell the components, as in ``greenland_vx_v1.tif``.
COMPONENT = re.compile(r"(?<![a-z])(v[xy]|u[xy]|[uv]o?)(?![a-z0-9])", re.IGNORECASE)


def read_raster(path: Path) -> xr.Dataset:
    """Return a variable for each band, with its unit, scale and offset; NaN where data are missing.

    A band is named by its description, and the only band of a file by the name of the file.

    Parameters
    ----------
    path
        The file of one raster.

    Raises
    ------
    ModuleNotFoundError
        If rioxarray is not installed.
    FieldError
        If the raster has no positions.
    """
    rioxarray = import_package("rioxarray", "a raster such as GeoTIFF")
    # Other formats, which GDAL would know by their content, name further files and addresses.
    driver = DRIVERS[path.suffix.lower()]
    if driver == "AAIGrid":
        _check_grid(path)
    options = {"band_as_variable": True, "mask_and_scale": True, "driver": driver}
    with rioxarray.open_rasterio(path, **options) as bands:
        check_memory(bands.nbytes, "the raster")
        ds: xr.Dataset = bands.load()
    del bands
    # Files of rasterio are in a cycle; one that is left when Python ends prints an error.
    gc.collect()
    if ds.rio.transform().is_identity:
        raise FieldError(
            "the raster has no positions, as images have none; expected a GeoTIFF. The flow "
            "between two images is v, u = skimage.registration.optical_flow_tvl1(first, second)"
        )
    names = _names(ds, path)
    if not names and len(ds.data_vars) == 2:
        names = {"band_1": "vx", "band_2": "vy"}
        ds.encoding[NOTE] = (
            "the bands have no names; band 1 is taken as the component along x, and band 2 as "
            "that along y. To exchange them: vectors='vy,vx'"
        )
    ds = ds.rename_vars(names)
    for name in ("vx", "vy"):
        if name in ds:  # files of glaciers often have no unit, by which a velocity is known
            ds[name].attrs.setdefault("long_name", f"{name[1]} velocity")
    return ds


def _check_grid(path: Path) -> None:
    """Raise a FieldError unless a file is text that begins as those of Esri do."""
    with path.open("rb") as file:
        head = file.read(len(GRID_BEGIN)).lower()
    if head != GRID_BEGIN:
        raise FieldError(
            f"the file begins with {head!r}; expected a grid of Esri, which begins with ncols. For "
            "a table of columns use the ending .txt"
        )


def _names(ds: xr.Dataset, path: Path) -> dict[str, str]:
    """Return names of bands by their descriptions, or that of the file for a single band."""
    names: dict[str, str] = {}
    for band, array in ds.data_vars.items():
        described = re.sub(r"\W+", "_", str(array.attrs.get("long_name", "")).strip())
        if described and described not in names.values():
            names[str(band)] = described
    if not names and len(ds.data_vars) == 1:
        found = COMPONENT.search(path.stem)
        if found is not None:
            return {"band_1": found[0]}
        return {"band_1": path.stem}
    return names
