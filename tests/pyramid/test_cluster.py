"""Pyramids built by workers of a cluster that have nothing in common but the store."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cluster import Cluster, ObjectStorage, digests
from small_tiles import shrink
from waiting import PATIENCE_S

from flowtex.pyramid import PyramidError, build, open_store, tasks
from flowtex.pyramid.places import store_at
from flowtex.textures.tiles.pyramid import TileKey
from flowtex.textures.tiles.shared import shared_pyramid

distributed = pytest.importorskip("distributed")
xr = pytest.importorskip("xarray")
pytest.importorskip("zarr")

ROOT_NODES = 2_500  #: Nodes of the coarsest level, here and on the workers.


@pytest.fixture
def storage(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[ObjectStorage]:
    """Object storage as its own server, told by the environment."""
    pytest.importorskip("moto")
    server = ObjectStorage(tmp_path / "s3")
    for name, value in server.environment.items():
        monkeypatch.setenv(name, value)
    yield server
    server.close()


def flow(rows: int = 128, columns: int = 256) -> Any:
    """A dataset of waves of many lengths around an island."""
    y, x = (np.arange(n) / 25 for n in (rows, columns))
    u, v = np.full((2, rows, columns), 0.3)
    for k in (0.5, 2, 7, 23):
        u += np.cos(k * y)[:, None] / k**0.2
        v += np.sin(k * x) / k**0.2
    u[np.hypot(x - 4, y[:, None] - 2.5) < 1] = np.nan
    words: list[dict[str, str]] = [
        {"standard_name": f"sea_water_{axis}_velocity", "units": "m s-1"} for axis in "xy"
    ]
    dims = ("y", "x")
    data = {"u": (dims, u.astype("f4"), words[0]), "v": (dims, v.astype("f4"), words[1])}
    return xr.Dataset(data, {"x": x, "y": y}).chunk(y=32, x=64)


@pytest.mark.slow
@pytest.mark.usefixtures("small_tiles")
def test_workers_build_what_threads_build_though_one_is_killed(
    tmp_path: Path, storage: ObjectStorage, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", ROOT_NODES)
    source, place = "s3://flows/source.zarr", "s3://flows/deep/flow.zarr"
    flow().to_zarr(store_at(source, read_only=False), consolidated=False)
    data = xr.open_zarr(store_at(source), consolidated=False)
    build(data, tmp_path / "threads.zarr", progress=False)
    cluster = Cluster(tmp_path / "cluster", storage.environment, memory="2500MB")
    try:
        with distributed.Client(cluster.address) as client:
            client.wait_for_workers(2)
            lost = cluster.workers[0]
            lost_name = _name_of(client, lost.pid)

            def kill(event: Any) -> None:
                if event[1]["worker"] == lost_name:
                    lost.kill()

            client.subscribe_topic("tile", kill)
            client.run(shrink)
            client.run(_small_roots)
            client.run(_tell_tiles)
            built = build(data, place, scheduler=client, progress=False)
            assert lost.wait(PATIENCE_S) != 0
        assert built.place == place
        again = build(data, place, scheduler=cluster.address, progress=False)
        assert (again.made, again.kept) == (0, built.made)
    finally:
        cluster.close()
    one, other = digests(place), digests(tmp_path / "threads.zarr")
    assert one.keys() == other.keys() and len(one) > 30
    assert [name for name in one if one[name] != other[name]] == []
    # One of the finest, which are made from the store when they are requested.
    tiles = []
    for store in (place, tmp_path / "threads.zarr"):
        tile = shared_pyramid(open_store(store), "arclength").tile(TileKey(0, 1, 2), [0])
        assert tile is not None
        tiles.append(tile.layers())
    np.testing.assert_array_equal(tiles[0], tiles[1])


def test_unserializable_source_raises() -> None:
    with pytest.raises(PyramidError, match="cannot be sent to workers"):
        tasks._packed(n for n in range(3))


def _name_of(client: Any, pid: int) -> str:
    (name,) = (name for name, its in client.run(_pid).items() if its == pid)
    return str(name)


def _pid() -> int:
    import os

    return os.getpid()


def _small_roots() -> None:
    from flowtex.textures.tiles import grid_levels

    grid_levels.ROOT_NODES = ROOT_NODES


def _tell_tiles() -> None:
    """Tell, on a worker, that it makes tiles."""
    from distributed import get_worker

    module: Any = tasks
    write = module.write_tile

    def told(*given: Any) -> None:
        get_worker().log_event("tile", {"worker": get_worker().address})
        write(*given)

    module.write_tile = told
