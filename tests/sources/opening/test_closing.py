"""Files are closed on request, and arrays that are not read yet stay valid."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from earth_data import winds

from flowtex import FlowField
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
