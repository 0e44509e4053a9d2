"""A field larger than a machine, as a pyramid: ``python benchmarks/pyramid.py``.

An ocean that is made by code is written to object storage, part after part. A Dask scheduler and
two workers, their own processes with nothing in common but that storage, build its pyramid there.
Half-way one worker is killed and another one is started. Measured are time, processor time, memory,
requests and bytes of all who take part, then pictures and a browser that read the store.

Some tiles are then taken away and made again undisturbed, and have to be the same, bit for bit;
``--verify all`` builds a second time and compares all objects. Up to some millions of nodes
pictures are compared with those of the field in memory. Figures are kept in
``benchmarks/pyramid.json``; with ``--docs`` the tables of ``docs/scale.md`` are written from them.
The full size wants some 30 GB of disk, under ``--folder``.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import platform
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from browsing import browsed
from ocean import ocean
from planning import RESULTS, tables, write_docs
from rich.console import Console

import flowtex

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from cluster import Cluster, ObjectStorage, Request, digests

SOURCE, STORE, SECOND = (f"s3://flows/{name}.zarr" for name in ("source", "flow", "second"))
ZOOMS = tuple(2**n for n in range(11))
#: A place in the ocean, in metres on the map, and pixels of a picture.
FOCUS, SIZE = (2.2e6, 0.4e6), (1000, 600)
#: Most nodes of a field that is held in memory whole, to compare pictures.
MOST_IN_MEMORY = 9_000_000
#: Tasks that do nothing, by which the scheduler is judged.
EMPTY_TASKS = 2000
#: Tiles that are made again to see whether they are the same.
MADE_AGAIN = 32
#: Seconds between two looks at what the processes take.
INTERVAL_S = 0.2


def peak_memory(pid: int | str = "self") -> int:
    """Return the most memory that a process has had, in bytes; on Linux alone."""
    status = Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    return 1024 * int(status.partition("VmHWM:")[2].split()[0])


class Watched:
    """Most memory, and processor time, of processes that come and go."""

    def __init__(self) -> None:
        self._processes: dict[str, int] = {}
        self.peaks: dict[str, int] = {}
        self.seconds: dict[str, float] = {}

    def add(self, name: str, pid: int) -> None:
        """Watch a process; what it has taken so far counts for its memory alone."""
        self._processes[name] = pid
        self.look()

    def look(self) -> None:
        """Look at those that are still there."""
        import psutil

        for name, pid in list(self._processes.items()):
            try:
                times = psutil.Process(pid).cpu_times()
                self.peaks[name] = peak_memory(pid)
            except (psutil.Error, OSError, IndexError):
                del self._processes[name]
            else:
                self.seconds[name] = times.user + times.system


def alone() -> ProcessPoolExecutor:
    """Return its own process in which to do something."""
    return ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn"))


def traffic(requests: Iterable[Request]) -> dict[str, Any]:
    """Return bytes and numbers of requests, by what they were about."""
    requests = list(requests)
    read, written, counts = Counter[str](), Counter[str](), Counter[str]()
    for request in requests:
        kind = _kind_of(request.path)
        read[kind] += request.sent if request.method == "GET" else 0
        written[kind] += request.received
        counts[request.method if request.path.count("/") > 2 else "LIST"] += 1
    each_second = Counter(int(request.at) for request in requests)
    return {
        "read": dict(read),
        "written": dict(written),
        "requests": dict(counts),
        "most_requests_a_second": max(each_second.values(), default=0),
    }


def _kind_of(path: str) -> str:
    if "/source.zarr/" in path:
        return "source"
    if any(f"/{kind}/" in path for kind in ("flow", "surface", "values")):
        return "tiles"
    return "nodes" if "/c/" in path else "metadata"


def write_source(columns: int, rows: int) -> None:
    """Write the ocean, as many parts at once as there are cores."""
    from flowtex.pyramid.places import store_at

    ocean(columns, rows).to_zarr(store_at(SOURCE, read_only=False), consolidated=False)


def source() -> Any:
    """Open the ocean, without reading it."""
    import xarray as xr

    from flowtex.pyramid.places import store_at

    return xr.open_zarr(store_at(SOURCE), consolidated=False)


def build(place: str, scheduler: str) -> dict[str, Any]:
    """Build the pyramid, as whoever calls does."""
    built = flowtex.pyramid.build(
        source(), place, scheduler=scheduler, progress=sys.stderr.isatty()
    )
    return asdict(built) | {"peak": peak_memory(), "cpu_seconds": time.process_time()}


def most_tiles(place: str) -> int:
    """Return how many files of the flow a store has once it is built."""
    import zarr

    from flowtex.pyramid.places import store_at

    members = zarr.open_group(store_at(place), mode="r").members(max_depth=None)
    return sum(int(np.prod(array.shape[:3])) for name, array in members if name.endswith("/flow"))


def measured_build(
    storage: ObjectStorage, folder: Path, place: str, chosen: Any, *, disturbed: bool
) -> dict[str, Any]:
    """Build in a cluster, and return what it took."""
    cluster = Cluster(folder, storage.environment, memory=chosen.memory)
    watched = Watched()
    try:
        with alone() as pool:
            _wait_for(cluster.address, len(cluster.workers))
            for number, worker in enumerate(cluster.workers):
                watched.add(f"worker {number}", worker.pid)
            watched.add("scheduler", cluster.scheduler.pid)
            watched.add("object storage", storage.process.pid)
            before = dict(watched.seconds)
            storage.requests()
            start = time.perf_counter()
            future = pool.submit(build, place, cluster.address)
            requests, killed_at = _followed(
                future, storage, cluster, watched, place, disturbed=disturbed
            )
            seconds, called = time.perf_counter() - start, future.result()
            overheads = measured_overheads(cluster, watched)
        taken = {name: s - before.get(name, 0.0) for name, s in watched.seconds.items()}
        return {
            "seconds": seconds,
            "made": called["made"],
            "depth": called["depth"],
            "tiles": most_tiles(place),
            "killed_at_tile": killed_at,
            "worker_cpu_seconds": sum(s for name, s in taken.items() if name.startswith("worker")),
            "caller_cpu_seconds": called["cpu_seconds"],
            "scheduler_cpu_seconds": taken["scheduler"],
            "storage_cpu_seconds": taken["object storage"],
            **overheads,
            "peaks": {**watched.peaks, "caller": called["peak"]},
            **traffic(requests),
        }
    finally:
        cluster.close()


def measured_overheads(cluster: Cluster, watched: Watched) -> dict[str, float]:
    """Return what tasks that do nothing take of the scheduler and of the caller, in seconds each.

    What the processes take meanwhile for being there is part of it.
    """
    import distributed

    with distributed.Client(cluster.address) as client:
        client.submit(int).result()
        watched.look()
        before, own = watched.seconds["scheduler"], time.process_time()
        futures = client.map(int, range(EMPTY_TASKS), pure=False)
        for future in distributed.as_completed(futures):
            future.release()
        watched.look()
    return {
        "scheduler_seconds_a_task": (watched.seconds["scheduler"] - before) / EMPTY_TASKS,
        "caller_seconds_a_task": (time.process_time() - own) / EMPTY_TASKS,
    }


def _wait_for(address: str, workers: int) -> None:
    import distributed

    with distributed.Client(address) as client:
        client.wait_for_workers(workers, timeout=60)


def _followed(
    future: Future[Any],
    storage: ObjectStorage,
    cluster: Cluster,
    watched: Watched,
    place: str,
    *,
    disturbed: bool,
) -> tuple[list[Request], int | None]:
    """Watch a build to its end, killing a worker half-way and starting another one."""
    requests: list[Request] = []
    tiles, half, killed = 0, 0, None
    while not future.done():
        time.sleep(INTERVAL_S)
        watched.look()
        new = storage.requests()
        requests += new
        tiles += len({r.path for r in new if r.method != "GET" and "/flow/c/" in r.path})
        if disturbed and killed is None and tiles:
            half = half or most_tiles(place) // 2
            if tiles >= half:
                cluster.workers[0].kill()
                killed = tiles
                watched.add("worker 2", cluster.add_worker().pid)
    watched.look()
    return requests + storage.requests(), killed


def made_again(place: str) -> bool:
    """Take some tiles away, build what is missing, and return whether they are what they were."""
    import obstore
    from obstore.store import from_url

    tiles = [name for name in contents(place) if "/flow/c/" in f"/{name}"]
    some = list(np.random.default_rng(16).choice(tiles, min(MADE_AGAIN, len(tiles)), replace=False))
    before = digests(place, some)
    obstore.delete(from_url(place), some)
    made = flowtex.pyramid.build(source(), place, progress=False).made
    return made == len(some) and digests(place, some) == before


def contents(place: str) -> dict[str, int]:
    """Return the sizes of all objects of a store."""
    import obstore
    from obstore.store import from_url

    listed = obstore.list(from_url(place))
    return {entry["path"]: entry["size"] for some in listed for entry in some}


def picture(place: str, zoom: float) -> tuple[float, Any]:
    """Draw a picture from the store, which is opened again, and return its seconds."""
    start = time.perf_counter()
    pixels = flowtex.render(place, **_view(zoom))
    return time.perf_counter() - start, pixels


def pictures_in_memory(zooms: Iterable[float]) -> list[Any]:
    """Draw the pictures of the whole field in memory."""
    field = flowtex.FlowField.from_xarray(source().load())
    return [flowtex.render(field, **_view(zoom)) for zoom in zooms]


def _view(zoom: float) -> dict[str, Any]:
    return {"zoom": zoom, "focus": FOCUS, "size": SIZE, "cmap": "viridis", "clim": "robust"}


def _ready() -> None:
    """Load what draws."""
    flowtex.render(flowtex.examples.double_gyre_field(), size=(100, 60))


def measured_pictures(storage: ObjectStorage, nodes: int, album: Path) -> list[dict[str, Any]]:
    """Draw the store at all zooms, and hold it against the field in memory where that fits."""
    from PIL import Image

    rows, drawn = [], []
    with alone() as pool:
        pool.submit(_ready).result()
        for zoom in ZOOMS:
            storage.requests()
            seconds, pixels = pool.submit(picture, STORE, zoom).result()
            got = traffic(storage.requests())
            rows.append(
                {
                    "zoom": zoom,
                    "seconds": seconds,
                    "bytes": sum(got["read"].values()),
                    "requests": sum(got["requests"].values()),
                }
            )
            drawn.append(pixels)
            Image.fromarray(pixels).save(album / f"zoom_{zoom}.png")
    if nodes <= MOST_IN_MEMORY:
        with alone() as pool:
            others = pool.submit(pictures_in_memory, ZOOMS).result()
        for row, one, other in zip(rows, drawn, others, strict=True):
            off = one.astype(float) - other
            row["rms"], row["most"] = float(np.sqrt(np.mean(off**2))), float(np.abs(off).max())
    return rows


def machine() -> str:
    """Return words for what this runs on."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return (
        f"{os.cpu_count()} cores, {memory / 1e9:.0f} GB, {platform.system()}, "
        f"Python {platform.python_version()}"
    )


def measured(chosen: Any, folder: Path, say: Callable[[str], None]) -> dict[str, Any]:
    """Run all of it."""
    columns, rows = map(int, chosen.size.split("x"))
    album = Path(chosen.album)
    album.mkdir(parents=True, exist_ok=True)
    storage = ObjectStorage(folder / "s3")
    os.environ.update(storage.environment)
    result: dict[str, Any] = {
        "size": [columns, rows],
        "memory": chosen.memory,
        "machine": machine(),
        "version": flowtex.__version__,
    }
    try:
        start = time.perf_counter()
        with alone() as pool:
            pool.submit(write_source, columns, rows).result()
        result["source"] = {
            "seconds": time.perf_counter() - start,
            "bytes": sum(contents(SOURCE).values()),
        }
        say(f"source: {result['source']}")
        result["build"] = measured_build(storage, folder / "one", STORE, chosen, disturbed=True)
        sizes = contents(STORE)
        result["store"] = {"objects": len(sizes), "bytes": sum(sizes.values())}
        tiles = [size for name, size in sizes.items() if "/flow/c/" in f"/{name}"]
        result["store"] |= {"tile_bytes": float(np.mean(tiles)), "largest": max(sizes.values())}
        say(f"build: {result['build']}\nstore: {result['store']}")
        if chosen.verify == "some":
            with alone() as pool:
                result["same"] = pool.submit(made_again, STORE).result()
            result["compared"] = min(MADE_AGAIN, len(tiles))
            say(f"{result['compared']} tiles made again, the same: {result['same']}")
        else:
            again = measured_build(storage, folder / "two", SECOND, chosen, disturbed=False)
            result["undisturbed"] = again
            result["same"] = digests(STORE) == digests(SECOND)
            result["compared"] = len(sizes)
            say(f"undisturbed: {again}\nthe same, bit for bit: {result['same']}")
        result["pictures"] = measured_pictures(storage, columns * rows, album)
        say(f"pictures: {result['pictures']}")
        if chosen.browser:
            result["browser"] = browsed(storage, STORE, (columns, rows), folder, album, traffic)
            say(f"browser: {result['browser']}")
    finally:
        storage.close()
    return result


def main() -> None:
    """Measure, keep the figures, and print them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", default="16384x8192", help="nodes along both axes")
    parser.add_argument("--memory", default="2500MB", help="memory of a worker")
    parser.add_argument("--verify", default="some", choices=("some", "all"), help="objects")
    parser.add_argument("--no-browser", dest="browser", action="store_false")
    parser.add_argument("--folder", default=None, help="where there is room on a disk")
    parser.add_argument("--album", default="out/pyramid", help="folder of the pictures")
    parser.add_argument("--docs", action="store_true", help="write docs/scale.md's tables")
    parser.add_argument("--only-tables", action="store_true", help="from what was kept")
    chosen = parser.parse_args()
    console = Console(highlight=False)
    if not chosen.only_tables:
        with tempfile.TemporaryDirectory(dir=chosen.folder) as folder:
            result = measured(chosen, Path(folder), lambda text: console.print(text, style="dim"))
        kept = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
        kept[chosen.size] = result
        RESULTS.write_text(json.dumps(kept, indent=1, sort_keys=True) + "\n")
    kept = json.loads(RESULTS.read_text())
    for text in tables(kept).values():
        console.print(text, soft_wrap=True)
    if chosen.docs:
        write_docs(kept)


if __name__ == "__main__":
    main()
