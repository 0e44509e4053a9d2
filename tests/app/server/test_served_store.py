"""A store that is passed on: its own objects, and nothing else."""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("zarr")
pytest.importorskip("aiohttp")

from flowtex import FlowField
from flowtex.app.server.store_site import ServedStore
from flowtex.errors import FieldError
from flowtex.pyramid import build

TILE = "0/velocity/c/0/0/0/0"


def flow() -> FlowField:
    y, x = np.mgrid[0:100, 0:23].astype(float) / 25
    velocity = np.stack([np.cos(3 * y) + 0.3, np.sin(4 * x)], axis=-1)
    return FlowField.from_arrays(np.stack([x, y], axis=-1), velocity, periodic="")


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory, small_tiles: None) -> Iterator[Path]:
    place = tmp_path_factory.mktemp("store") / "a.zarr"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.textures.tiles.pyramid.ROOT_NODES", 250)
        build(flow(), place, progress=False)
        yield place


def test_all_objects_are_handed_on(store: Path) -> None:
    served = ServedStore(store)
    for path in store.rglob("*"):
        # Those of ranges are for who builds.
        if path.is_file() and "samples" not in path.parts:
            name = path.relative_to(store).as_posix()
            assert asyncio.run(served.get(name)) == path.read_bytes()
    (store / name).rename(store / "away")
    with pytest.raises(LookupError):
        asyncio.run(served.get(name))
    (store / "away").rename(store / name)


def test_links_out_of_a_store_are_not_followed(store: Path, tmp_path: Path) -> None:
    place, secret = tmp_path / "a.zarr", tmp_path / "secret"
    shutil.copytree(store, place)
    secret.write_bytes(b"secret")
    served = ServedStore(place)
    (place / TILE).unlink()
    (place / TILE).symlink_to(secret)
    with pytest.raises(LookupError):
        asyncio.run(served.get(TILE))
    with pytest.raises(FieldError, match=r"0 is a link to .*secret, outside of the store; put a c"):
        ServedStore(place)
    (place / TILE).unlink()
    (place / TILE).symlink_to(store / TILE)
    secret.unlink()
    secret.symlink_to(store)
    assert asyncio.run(ServedStore(secret).get(TILE)) == (store / TILE).read_bytes()


NO_NAMES = [
    *("", "..", "../a.zarr/zarr.json", "/etc/passwd", "0", "0/flow", "0/flow/c", "c/0"),
    *("0/velocity/c/0/0", "0/velocity/c/0/0/0/0/0", "0/velocity/c/0/0/0/-1", "0/nothing/c/0"),
    *("0/velocity/c/0/0/../0", "0/velocity/c/0/0/0/٣", "0/velocity/c/0/7/0/0"),
    *("0/flow/c/0/9/0/0", "0/flow/c/5/0/0/0", "9/zarr.json", "building.json"),
    f"0/velocity/c/0/0/0/{'1' * 5000}",
]


def test_no_name_leads_elsewhere(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    served = ServedStore(store)
    monkeypatch.setattr(served, "_reads", None)  # nothing is looked for
    for name in NO_NAMES:
        with pytest.raises(LookupError):
            asyncio.run(served.get(name))
