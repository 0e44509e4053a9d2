"""Pyramids of what an ocean model and satellites have: pictures are those of the files."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import flowtex
from flowtex import FlowField
from flowtex.pyramid import build, open_store
from flowtex.sources.notices import DatasetNotice
from flowtex.textures.tiles.shared import has_pyramid, shared_pyramid

xr = pytest.importorskip("xarray")
pytest.importorskip("cf_xarray")
pytest.importorskip("zarr")

FILES = {
    "nemo": [f"nemo_orca025_{name}.nc" for name in ("U", "V", "coordinates")],
    "globcurrent": [f"globcurrent_200201{day:02d}.nc" for day in range(1, 4)],
}
#: A part of what a file has is enough.
PART = {"y": slice(50, 100), "x": slice(40, 90), "depthu": slice(2), "depthv": slice(2)}
PART |= {"lat": slice(36), "lon": slice(50)}


@pytest.mark.parametrize("name", FILES)
def test_pictures_are_those_of_the_files(
    name: str, data_dir: Path, tmp_path: Path, opengl: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The files are small, so that there would be no levels.
    monkeypatch.setattr("flowtex.textures.tiles.pyramid.ROOT_NODES", 1000)
    files = [tmp_path / file for file in FILES[name]]
    for file in files:
        with xr.open_dataset(data_dir / file.name, decode_cf=False) as whole:
            whole.isel(PART, missing_dims="ignore").to_netcdf(file)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DatasetNotice)
        field = FlowField.from_file(files)
        build(field, tmp_path / "flow.zarr", progress=False)
    store = open_store(tmp_path / "flow.zarr")
    assert has_pyramid(store) and shared_pyramid(store, "arclength").depth >= 1
    assert store.start == field.start and store.projection == field.projection
    np.testing.assert_array_equal(store.times, field.times)
    sea = field.points[field.valid]
    # The node of the sea that is nearest to its middle.
    focus = tuple(sea[np.linalg.norm(sea - sea.mean(axis=0), axis=1).argmin()])
    for zoom, time in ((1.0, field.times[0]), (30.0, field.times[-1])):
        options: dict[str, Any] = {"zoom": zoom, "focus": focus, "size": (200, 140), "samples": 9}
        if not field.steady:
            options["time"] = float(time)
        pictures = [flowtex.render(one, **options) for one in (field, tmp_path / "flow.zarr")]
        # Velocities have 13 bits in a store, and where paths end a little more or less is seen.
        away = np.abs(pictures[0].astype(int) - pictures[1])
        assert away.mean() < 0.02 and (away > 3).mean() < 5e-4
        assert pictures[0].std() > 10
