"""Pyramids built by workers of a cluster that have nothing in common but the store."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex._util.array_types import AnyArray
from flowtex.pyramid import PyramidError, build, open_store, workers
from flowtex.pyramid.places import store_at
from flowtex.pyramid.workers import OWN_BYTES, TILE_BYTES
from flowtex.tiles import TileKey, shared_pyramid

distributed = pytest.importorskip("distributed")
zarr = pytest.importorskip("zarr")


@pytest.fixture(autouse=True)
def _small_roots(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.tiles.pyramid.ROOT_NODES", 40_000)


def flow(path: Path, rows: int = 520, columns: int = 1030) -> Path:
    """A dataset in a store of its own, which workers open themselves."""
    xr = pytest.importorskip("xarray")
    y, x = np.mgrid[0:rows, 0:columns].astype("f4") / 100
    land = np.hypot(x - 3, y - 2) < 0.7
    parts = {"u": ("x", np.cos(2 * y) + 0.3), "v": ("y", np.sin(3 * x))}
    variables = {}
    for name, (axis, values) in parts.items():
        words = {"standard_name": f"sea_water_{axis}_velocity", "units": "m/s"}
        variables[name] = (("y", "x"), np.where(land, np.nan, values), words)
    coords = {"x": ("x", x[0], {"units": "m"}), "y": ("y", y[:, 0], {"units": "m"})}
    xr.Dataset(variables, coords).chunk(x=256, y=256).to_zarr(path, zarr_format=2)
    return path


def contents(place: Any) -> dict[str, AnyArray]:
    members = zarr.open_group(store_at(place), mode="r").members(max_depth=None)
    return {name: np.asarray(a[:]) for name, a in members if isinstance(a, zarr.Array)}


def assert_same(one: Any, other: Any) -> None:
    first, second = contents(one), contents(other)
    assert first.keys() == second.keys()
    for name, values in first.items():
        assert values.tobytes() == second[name].tobytes(), name


class Cluster:
    """A scheduler and workers as processes of their own, each in a folder of its own."""

    def __init__(self, folder: Path, environment: dict[str, str], *, count: int = 2) -> None:
        self.folder, self.environment = folder, {**os.environ, **environment}
        self.environment["PYTHONPATH"] = str(Path(__file__).resolve().parents[2])
        self.processes: list[subprocess.Popen[bytes]] = []
        told = folder / "scheduler.json"
        self.start(
            "scheduler",
            "--host",
            "127.0.0.1",
            "--port",
            "0",
            "--no-dashboard",
            "--scheduler-file",
            str(told),
        )
        while not told.exists() or not told.read_text():
            assert self.processes[0].poll() is None
        self.address: str = json.loads(told.read_text())["address"]
        for _ in range(count):
            self.start("worker", self.address, "--nthreads", "1", "--no-dashboard", "--no-nanny")

    def start(self, *words: str) -> None:
        """Start one more process."""
        here = self.folder / f"process{len(self.processes)}"
        here.mkdir()
        log = (here / "log.txt").open("wb")
        program = [sys.executable, "-m", "distributed.cli.dask_" + words[0], *words[1:]]
        self.processes.append(
            subprocess.Popen(program, cwd=here, env=self.environment, stdout=log, stderr=log)
        )
        log.close()

    def close(self) -> None:
        for process in self.processes[::-1]:
            process.kill()
            process.wait()


@pytest.fixture
def s3(monkeypatch: pytest.MonkeyPatch) -> Iterator[dict[str, str]]:
    """Object storage as a server of its own, told by the environment."""
    server = pytest.importorskip("moto.server").ThreadedMotoServer(port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    environment = {
        "AWS_ENDPOINT_URL": f"http://{host}:{port}",
        "AWS_ALLOW_HTTP": "true",
        "AWS_ACCESS_KEY_ID": "nobody",
        "AWS_SECRET_ACCESS_KEY": "nothing",
        "AWS_REGION": "us-east-1",
        "AWS_VIRTUAL_HOSTED_STYLE_REQUEST": "false",
    }
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    import urllib.request

    urllib.request.urlopen(
        urllib.request.Request(f"{environment['AWS_ENDPOINT_URL']}/flows", method="PUT")
    ).close()
    yield environment
    server.stop()


@pytest.mark.slow
def test_workers_build_what_threads_build_though_one_is_killed(
    tmp_path: Path, s3: dict[str, str]
) -> None:
    data = flow(tmp_path / "data.zarr")
    build(data, tmp_path / "threads.zarr", levels="all", progress=False)
    cluster = Cluster(tmp_path, s3)
    try:
        with distributed.Client(cluster.address) as client:
            client.wait_for_workers(2)
            killed: list[subprocess.Popen[bytes]] = []

            def kill(event: Any) -> None:
                del event
                if not killed:
                    killed.append(cluster.processes[-1])
                    killed[0].kill()

            client.subscribe_topic("tile", kill)
            place = "s3://flows/deep/flow.zarr"
            client.run(_tell_first_tile)
            before = client.run(_peak)
            built = build(data, place, levels="all", scheduler=client, progress=False)
            assert killed and killed[0].poll() is not None
            (grown,) = (peak - before[name] for name, peak in client.run(_peak).items())
            assert grown < OWN_BYTES + TILE_BYTES
        assert built.place == place
        again = build(data, place, levels="all", scheduler=cluster.address, progress=False)
        assert (again.made, again.kept) == (0, built.made)
    finally:
        cluster.close()
    assert_same(place, tmp_path / "threads.zarr")
    root = open_store(place)
    assert shared_pyramid(root, "arclength").tile(TileKey(0, 1, 2), [0]) is not None


@pytest.mark.slow
def test_a_cluster_builds_a_field_that_who_builds_holds(tmp_path: Path) -> None:
    y, x = np.mgrid[0:300, 0:400].astype(float) / 100
    velocity = np.stack([np.cos(2 * y), np.sin(3 * x)], axis=-1)
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), velocity, periodic="")
    build(field, tmp_path / "threads.zarr", progress=False)
    cluster = Cluster(tmp_path, {}, count=1)
    try:
        build(field, tmp_path / "cluster.zarr", scheduler=cluster.address, progress=False)
    finally:
        cluster.close()
    assert_same(tmp_path / "cluster.zarr", tmp_path / "threads.zarr")


def test_workers_with_little_memory_are_told() -> None:
    class Client:
        def scheduler_info(self, **_: int) -> dict[str, Any]:
            workers = {
                "tcp://a:1": {"memory_limit": 8_000_000_000, "nthreads": 2},
                "tcp://b:2": {"memory_limit": 3_000_000_000, "nthreads": 2},
                "tcp://c:3": {"memory_limit": 0, "nthreads": 2},
            }
            return {"workers": workers}

    with pytest.warns(UserWarning, match=r"1 of 3 workers .* tcp://b:2 has 3 GB, .* need 3.5 GB"):
        workers.Cluster(Client())


def test_what_holds_its_data_is_not_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "MOST_SENT", 10_000)
    assert workers._packed(np.zeros(9_000, np.uint8)) is not None
    assert workers._packed(np.zeros(11_000, np.uint8)) is None
    with pytest.raises(PyramidError, match="cannot be sent to the workers"):
        workers._packed(n for n in range(3))


def _peak() -> int:
    """Return the most memory that a process has had."""
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def _tell_first_tile() -> None:
    """Tell, on a worker, that it traces a tile."""
    from distributed import get_worker

    from flowtex.textures import TextureSet

    layers = TextureSet.layers

    def told(self: TextureSet, step: int = 0) -> Any:
        get_worker().log_event("tile", {})
        return layers(self, step)

    TextureSet.layers = told  # type: ignore[method-assign]
