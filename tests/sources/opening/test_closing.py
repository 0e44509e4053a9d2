"""Files are closed on request, and arrays that are not read yet stay valid."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from earth_data import winds

from flowtex import FlowField
from flowtex.sources.open_source import open_source
from flowtex.sources.opening.dataset_files import as_datasets, open_datasets

pytestmark = [
    pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice"),
    pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="needs /proc"),
]


def is_open(path: Path) -> bool:
    links = list(Path("/proc/self/fd").iterdir())
    return path in [link.readlink() for link in links if link.is_symlink()]


def data() -> xr.Dataset:
    ds = winds(np.arange(0.0, 40, 2), np.arange(-20.0, 21, 2))
    times = np.arange("2024-01-01", "2024-01-04", dtype="M8[D]").astype("M8[ns]")
    return xr.concat([ds, ds, ds], xr.Variable("time", times), data_vars="all")


@pytest.mark.parametrize("engine", ["netcdf4", "scipy"])
def test_files_are_closed_and_read_again(tmp_path: Path, engine: Any) -> None:
    path = tmp_path / "run.nc"
    ds = data()
    ds.to_netcdf(path, engine=engine)
    opened = as_datasets(open_datasets([path]))
    field = FlowField.from_xarray(opened, globe=True)
    for step in (0, 2, 1):
        opened.close()
        assert not is_open(path)
        drawn = np.linalg.norm(np.asarray(field.velocity[step]), axis=-1)
        assert np.allclose(drawn[:, :20], np.hypot(ds.u, ds.v)[step])
    later = opened[0].chunk(time=1)
    opened.close()
    assert np.allclose(later.u.mean(), ds.u.mean())
    opened.close()
    assert not is_open(path)


def test_groups_and_series_are_closed(tmp_path: Path) -> None:
    tree = tmp_path / "tree.nc"
    xr.DataTree.from_dict({"/ocean": data()}).to_netcdf(tree)
    steps = [tmp_path / f"run_{n}.nc" for n in range(3)]
    for n, path in enumerate(steps):
        data().isel(time=[n]).to_netcdf(path)
    for paths in ([tree], [tree / "ocean"], steps):
        opened = as_datasets(open_datasets(paths))
        opened.close()
        assert opened[0]["u"].isel(time=1).values.any()
        assert any(map(is_open, (tree, *steps)))
        opened.close()
        assert not any(map(is_open, (tree, *steps)))


def test_source_closes_its_file(tmp_path: Path) -> None:
    data().to_netcdf(tmp_path / "run.nc")
    source = open_source(tmp_path / "run.nc")
    assert not is_open(tmp_path / "run.nc")
    source.field()
    assert not is_open(tmp_path / "run.nc")


def test_open_file_is_not_locked(tmp_path: Path) -> None:
    data().to_netcdf(tmp_path / "run.nc")
    reading = """
import sys, h5py
from pathlib import Path
from flowtex.sources.opening.dataset_files import open_datasets
from flowtex.sources.reader_errors import errors_of_file
with errors_of_file(sys.argv[1]):
    opened = open_datasets([Path(sys.argv[1])])
opened[0].u.values
assert "netCDF4" in sys.modules
print("open", flush=True)
input()
"""
    reader = subprocess.Popen(
        [sys.executable, "-c", reading, tmp_path / "run.nc"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert reader.stdout is not None and reader.stdout.readline() == "open\n"
        import h5py

        with h5py.File(tmp_path / "run.nc", "r+", locking=True) as file:
            file.attrs["history"] = "written meanwhile"
    finally:
        reader.communicate("\n")


@pytest.mark.parametrize("options", [{}, {"globe": True}, {"uncertainty": "time"}])
def test_a_field_of_a_file_is_pickled_and_copied(tmp_path: Path, options: Any) -> None:
    data().to_netcdf(tmp_path / "run.nc")
    field = FlowField.from_file(tmp_path / "run.nc", **options).with_derived("vorticity")
    speeds = np.asarray(field.speed)
    for other in (pickle.loads(pickle.dumps(field)), copy.deepcopy(field)):
        assert type(other.velocity) is type(field.velocity)
        np.testing.assert_array_equal(other.velocity, field.velocity)
        np.testing.assert_array_equal(other.speed, speeds)
        for name, steps in field.scalars.items():
            # Sums of matrix products depend on where arrays lie in memory.
            largest = np.abs(steps).max()
            np.testing.assert_allclose(other.scalars[name], steps, rtol=0, atol=1e-12 * largest)
    assert not is_open(tmp_path / "run.nc")


def test_a_field_of_a_store_is_opened_again(tmp_path: Path) -> None:
    from flowtex.pyramid import build, open_store
    from flowtex.textures.tiles.shared import has_pyramid

    build(data(), tmp_path / "run.zarr", progress=False, globe=True)
    field = open_store(tmp_path / "run.zarr")
    for other in (pickle.loads(pickle.dumps(field)), copy.deepcopy(field)):
        assert has_pyramid(other)
        np.testing.assert_array_equal(other.velocity, field.velocity)
