"""A store that is handed on: what it has not is made, once, and only while somebody waits."""

from __future__ import annotations

import asyncio
import shutil
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from waiting import PATIENCE_S, until

from flowtex import FlowField
from flowtex.pyramid import PyramidError, build, open_store
from flowtex.pyramid.layout import read_header
from flowtex.pyramid.places import ReadFault
from flowtex.pyramid.served import ServedStore
from flowtex.tiles import TileKey, shared_pyramid

zarr = pytest.importorskip("zarr")

TILE = "0/traces/c/{step}/1/0/0/0/0/0"


def flow(steps: int = 1) -> FlowField:
    y, x = np.mgrid[0:100, 0:23].astype(float) / 25
    velocity = np.stack(
        [np.stack([np.cos(3 * y + t) + 0.3, np.sin(4 * x)], axis=-1) for t in range(steps)]
    )
    return FlowField.from_arrays(
        np.stack([x, y], axis=-1), velocity, times=np.arange(steps) / 10, periodic=""
    )


@pytest.fixture(autouse=True, scope="module")
def _small_roots(small_tiles: None) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.tiles.pyramid.ROOT_NODES", 250)
        yield


@pytest.fixture(scope="module")
def coarse(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store to read, without its finest tiles."""
    return built(tmp_path_factory.mktemp("coarse") / "a.zarr")


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store to read, with all its tiles."""
    return built(tmp_path_factory.mktemp("whole") / "b.zarr", levels="all")


def built(place: Path, **options: Any) -> Path:
    build(flow(options.pop("steps", 1)), place, progress=False, **options)
    return place


def test_what_is_made_is_what_the_builder_makes(tmp_path: Path, coarse: Path, whole: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in coarse.rglob("*")}

    async def copy() -> None:
        served = ServedStore(coarse)
        for path in whole.rglob("*"):
            if not path.is_file():
                continue
            name = path.relative_to(whole).as_posix()
            piece = await served.get(name)
            target = tmp_path / "copy.zarr" / name
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(piece.body)
        served.close()

    asyncio.run(copy())
    places = (tmp_path / "copy.zarr", whole)
    one, other = map(open_store, places)
    for row in (0, 1):
        both = [shared_pyramid(f, "arclength").tile(TileKey(0, row, 0), [0]) for f in (one, other)]
        layers = [tile.layers(0) for tile in both if tile is not None]
        np.testing.assert_array_equal(layers[0], layers[1])
    groups = [zarr.open_group(place, mode="r")["0"] for place in places]
    for name in ("values", "surface"):
        np.testing.assert_array_equal(groups[0][name][:], groups[1][name][:])
    # The store itself is only read.
    assert {path: path.stat().st_mtime_ns for path in coarse.rglob("*")} == before


def test_times_of_a_tile_have_one_halo(tmp_path: Path) -> None:
    place = built(tmp_path / "a.zarr", steps=3)

    async def spares() -> list[int]:
        served = ServedStore(place)
        for step in range(3):
            await served.get(TILE.format(step=step), slice(0, 1))
        group = served._group["0/traces"]
        headers = [read_header(group[step, 1, 0][0]) for step in range(3)]
        served.close()
        return [header["spare"] for header in headers if header is not None]

    found = asyncio.run(spares())
    assert len(found) == 3 and len(set(found)) == 1


def uneven() -> FlowField:
    """Cells that are smaller on both sides of a tile; paths go there at the last time alone."""
    sides = np.repeat([0.0025, 0.01, 0.0025], [64, 64, 50])
    x, y = np.meshgrid(np.append(0, np.cumsum(sides)), np.arange(8) / 100)
    along = np.array([[0.0, 1.0], [0.0, 1.0], [1.0, 0.0]])
    velocity = np.broadcast_to(along[:, None, None], (3, *x.shape, 2))
    return FlowField.from_arrays(
        np.stack([x, y], axis=-1), velocity, times=np.arange(3.0), periodic=""
    )


@pytest.mark.parametrize(("levels", "spare"), [("coarse", 1), ("all", 2)])
def test_a_tile_that_is_traced_again_keeps_its_halo(
    tmp_path: Path, levels: str, spare: int
) -> None:
    """By it paths are measured; a store that has the tile at other times tells it."""
    place, name = tmp_path / "a.zarr", "0/traces/c/{step}/0/1/0/0/0/0"
    build(uneven(), place, levels=levels, lines="streamlines", progress=False)
    for step in (0, 2):
        (place / name.format(step=step)).unlink(missing_ok=True)

    async def told() -> list[dict[str, Any]]:
        served, found = ServedStore(place), []
        for step in (0, 2):
            served._tiles.clear()
            await served.get(name.format(step=step), slice(0, 1))
            found.append(read_header(served._group["0/traces"][step, 0, 1][0]) or {})
        served.close()
        return found

    first, last = asyncio.run(told())
    assert (first["spare"], last["spare"]) == (spare, spare)
    assert first["unit"] == last["unit"]


NO_NAMES = [
    *("", "..", "../a.zarr/zarr.json", "/etc/passwd", "0", "0/traces", "0/traces/c", "c/0"),
    *("0/velocity/c/0/0", "0/velocity/c/0/0/0/0/0", "0/velocity/c/0/0/0/-1", "0/nothing/c/0"),
    *("0/velocity/c/0/0/../0", "0/velocity/c/0/0/0/٣", "0/velocity/c/0/7/0/0"),
    *("0/traces/c/0/9/0/0/0/0/0", "0/traces/c/5/0/0/0/0/0/0", "9/zarr.json"),
    f"0/velocity/c/0/0/0/{'1' * 5000}",
]


def test_no_name_leads_elsewhere(coarse: Path) -> None:
    served = ServedStore(coarse)
    for name in NO_NAMES:
        with pytest.raises(LookupError):
            asyncio.run(served.get(name))
    served.close()


def test_a_tile_is_made_once_for_all_who_wait_and_for_nobody_not_at_all(
    coarse: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import flowtex.pyramid.served as module
    from flowtex.pyramid.tasks import trace_tile

    made: list[TileKey] = []
    begun, go_on = threading.Event(), threading.Event()

    def slow(pyramid: Any, key: TileKey, steps: Any) -> Any:
        made.append(key)
        begun.set()
        go_on.wait(PATIENCE_S)
        return trace_tile(pyramid, key, steps)

    monkeypatch.setattr(module, "trace_tile", slow)
    monkeypatch.setattr(module, "MOST_THREADS", 1)
    served = ServedStore(coarse)
    name, other = TILE.format(step=0), TILE.format(step=0).replace("/1/0/", "/0/0/", 1)

    async def ask() -> None:
        first = [asyncio.create_task(served.get(name, slice(-9, None))) for _ in range(5)]
        await asyncio.to_thread(begun.wait, PATIENCE_S)
        second = asyncio.create_task(served.get(other))
        await until(lambda: len(served._jobs) == 2)
        second.cancel()  # before its turn
        first[0].cancel()
        await until(lambda: second.done() and first[0].done())
        go_on.set()
        pieces = await asyncio.gather(*first[1:])
        assert len({piece.body for piece in pieces}) == 1
        assert served._jobs == {}

    asyncio.run(ask())
    assert made == [TileKey(0, 1, 0)]
    served.close()


def test_what_was_used_longest_ago_makes_room(
    coarse: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import flowtex.pyramid.served as module

    monkeypatch.setattr(module, "MADE_BYTES", 1)
    served = ServedStore(coarse)
    folder = served._folder

    async def ask() -> None:
        for row in (0, 1, 0):
            name = TILE.format(step=0).replace("/1/0/", f"/{row}/0/", 1)
            assert (await served.get(name, slice(0, 4))).size > 1000
            assert {p.parts[-6] for p in folder.glob("0/traces/c/0/*/*/0/0/0/0")} == {str(row)}

    asyncio.run(ask())
    served.close()
    assert not folder.exists()


def test_parts_and_faults(tmp_path: Path, coarse: Path) -> None:
    place = Path(shutil.copytree(coarse, tmp_path / "a.zarr"))
    served, name = ServedStore(place), "1/velocity/c/0/0/0/0"
    whole = (place / name).read_bytes()

    async def ask() -> None:
        for asked in (slice(None), slice(3, 9), slice(5, None), slice(-7, None), slice(0, 10**12)):
            piece = await served.get(name, asked)
            assert piece.body == whole[asked] and piece.size == len(whole)
            assert piece.first == asked.indices(len(whole))[0]
        for asked in (slice(len(whole), None), slice(10**12, 10**13)):
            with pytest.raises(IndexError) as caught:
                await served.get(name, asked)
            assert caught.value.args == (len(whole),)
        (place / name).unlink()
        with pytest.raises(LookupError):
            await served.get(name)
        # Without its nodes a tile is not made.
        with pytest.raises((PyramidError, ReadFault)):
            for file in (place / "0/velocity/c").rglob("*"):
                if file.is_file():
                    file.write_bytes(b"torn")
            await served.get(TILE.format(step=0))

    asyncio.run(ask())
    served.close()


def test_a_tile_that_was_lost_is_made_again(tmp_path: Path, whole: Path) -> None:
    place = Path(shutil.copytree(whole, tmp_path / "a.zarr"))
    lost = place / TILE.format(step=0)
    size = lost.stat().st_size
    lost.unlink()
    served = ServedStore(place)
    assert abs(asyncio.run(served.get(TILE.format(step=0))).size - size) < 0.01 * size
    served.close()


@pytest.mark.parametrize(
    "name",
    [
        *("0/traces/c/0/1/0/1/0/0/0", "0/traces/c/0/1/0/0/0/0/1", "0/traces/c/0/2/0/0/0/0/0"),
        *("0/values/c/0/1/0/9/0/0", "0/surface/c/1/0/1", "0/surface/c/01/0/0"),
        *("0/velocity/c/0/0/1/0", "0/velocity/c/1/0/0/0", "0/nothing/c/0", "0/traces/c/x"),
    ],
)
def test_what_a_store_cannot_have_is_not_traced(
    coarse: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    traced: list[Any] = []
    monkeypatch.setattr(ServedStore, "_make", lambda *given: traced.append(given))
    served = ServedStore(coarse)
    with pytest.raises(LookupError):
        asyncio.run(served.get(name))
    served.close()
    assert traced == []
