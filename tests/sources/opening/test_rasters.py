"""Rasters that are refused, with the reason."""

from __future__ import annotations

import warnings
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.errors import FieldError

pytest.importorskip("rioxarray")


def test_image_without_positions_raises(tmp_path: Path) -> None:
    rasterio = import_module("rasterio")
    form = {"driver": "GTiff", "dtype": "uint8", "count": 1, "height": 4, "width": 5}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with rasterio.open(tmp_path / "photo.tif", "w", **form) as file:
            file.write(np.zeros((1, 4, 5), "u1"))
    with pytest.raises(FieldError, match=r"photo.tif: the raster has no positions.*optical_flow"):
        FlowField.from_file(tmp_path / "photo.tif")


def test_other_format_with_the_ending_of_a_raster_raises(tmp_path: Path) -> None:
    """A virtual raster, which GDAL knows by its content, would name other files and addresses."""
    path = tmp_path / "virtual.tif"
    path.write_text('<VRTDataset rasterXSize="2" rasterYSize="2"></VRTDataset>')
    with pytest.raises(FieldError, match=r"virtual.tif: .*not recognized as being in a supported"):
        FlowField.from_file(path)


def test_missing_package_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(import_module("sys").modules, "rioxarray", None)
    path = tmp_path / "velocity.tif"
    path.write_bytes(b"II*\0")
    with pytest.raises(FieldError, match="GeoTIFF needs rioxarray; install it with python -m pip"):
        FlowField.from_file(path)
