"""Rasters that are refused, with the reason."""

from __future__ import annotations

import subprocess
import sys
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


def test_text_that_is_no_grid_raises(tmp_path: Path) -> None:
    path = tmp_path / "current_u.asc"
    path.write_text("x y u v\n0 0 1 1\n")
    with pytest.raises(FieldError, match=r"begins with b'x y u'; expected a grid of Esri.*\.txt"):
        FlowField.from_file(path)


def test_process_that_reads_a_raster_ends_without_a_word(tmp_path: Path) -> None:
    rasterio = import_module("rasterio")
    form = {"driver": "GTiff", "dtype": "float32", "count": 2, "height": 4, "width": 5}
    corner = rasterio.Affine(2, 0, 10, 0, -2, 10)
    with rasterio.open(tmp_path / "velocity.tif", "w", **form, transform=corner) as file:
        file.write(np.arange(40, dtype="f4").reshape(2, 4, 5))
    code = "import sys, flowtex.cli.commands as c; sys.exit(c.main(['info', sys.argv[1]]))"
    command = [sys.executable, "-c", code, str(tmp_path / "velocity.tif")]
    ended = subprocess.run(command, capture_output=True, text=True, check=True)
    assert ended.stderr == ""
