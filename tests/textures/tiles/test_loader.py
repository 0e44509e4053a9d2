"""Tiles on their way: in order, given up when nobody wants them, told when they fail."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from waiting import wait_until

from flowtex._util.progress import check
from flowtex.textures.tiles.loader import GRACE_S, RETRY_S, TileLoader
from flowtex.textures.tiles.pyramid import TileKey

KEYS = [TileKey(0, 0, n) for n in range(8)]


class Textures:
    """Textures that take as long as they are told."""

    def __init__(self, key: TileKey, source: Source) -> None:
        self.key, self.source = key, source
        self.count, self.store = 1, self
        self.geometry: Any = self
        self.field = self
        self.size, self.valid = (4, 4), np.ones(4)

    def forget(self) -> None:
        """Nothing is kept."""

    def layers(self, step: int) -> Any:
        self.source.began.append((self.key, step))
        with Source.lock:
            Source.now += 1
            Source.most = max(Source.most, Source.now)
        try:
            while not self.source.go.wait(0.01):
                check()
        finally:
            with Source.lock:
                Source.now -= 1
        if self.key == self.source.broken:
            msg = "no such data"
            raise OSError(msg)
        return np.full((1, 4, 4, 4), step, np.float32)


class Source:
    """A pyramid of such, and how many of all are made at once, and were at most."""

    lock = threading.Lock()
    now = most = 0

    def __init__(self, broken: TileKey | None = None, together: int = 1) -> None:
        self.broken, self.together, self.go = broken, together, threading.Event()
        self.began: list[tuple[TileKey, int]] = []

    def groups(self, keys: Sequence[TileKey]) -> list[list[TileKey]]:
        return [[*keys[n : n + self.together]] for n in range(0, len(keys), self.together)]

    def tiles(self, keys: Sequence[TileKey], steps: Sequence[int]) -> Any:
        del steps
        return {key: Textures(key, self) for key in keys}


@pytest.mark.threads
def test_a_tile_is_there_once_it_is_made() -> None:
    source: Any = Source()
    told: list[int] = []
    loader = TileLoader(
        source, prepare=lambda textures: vars(textures)["key"], notify=lambda: told.append(1)
    )
    loader.request(KEYS[:2], [0, 1])
    assert loader.busy
    assert loader.get(KEYS[0], [0]) is None
    source.go.set()
    loader.wait()
    tile = loader.get(KEYS[0], [0, 1])
    assert tile is not None
    assert tile.prepared == KEYS[0]
    assert (tile.take(1) == 1).all()
    assert (tile.take(1) == 1).all()  # made again, since it was sent
    assert len(told) == 2
    assert not loader.busy
    loader.close()


@pytest.mark.threads
def test_what_nobody_wants_is_given_up() -> None:
    source: Any = Source()
    now = [0.0]
    loader = TileLoader(source, clock=lambda: now[0])
    loader.request(KEYS, [0])
    now[0] = GRACE_S + 0.1
    loader.request(KEYS[-1:], [0])
    source.go.set()
    loader.wait()
    assert loader.get(KEYS[-1], [0]) is not None
    assert sum(loader.get(key, [0]) is not None for key in KEYS) <= 1 + 4
    assert len(source.began) < len(KEYS)
    loader.close()


@pytest.mark.parametrize("together", [1, 3])
def test_a_failure_is_told_and_tried_again_later(together: int) -> None:
    source: Any = Source(broken=KEYS[1], together=together)
    source.go.set()
    now = [0.0]
    loader = TileLoader(source, clock=lambda: now[0])
    loader.request(KEYS[:3], [0])
    loader.wait()
    loader.request(KEYS[:3], [0])
    assert not loader.busy
    assert loader.get(KEYS[0], [0]) is not None
    assert loader.get(KEYS[1], [0]) is None
    assert isinstance(loader.errors[KEYS[1]], OSError)
    assert source.began.count((KEYS[1], 0)) == (1 if together == 1 else 2)
    before = len(source.began)
    loader.request(KEYS[:3], [0])
    assert len(source.began) == before
    # The network is there again.
    source.broken = None
    now[0] += RETRY_S + 1
    loader.request(KEYS[:3], [0])
    loader.wait()
    assert loader.get(KEYS[1], [0]) is not None and not loader.errors
    loader.close()


def test_tiles_fit_into_their_memory() -> None:
    source: Any = Source()
    source.go.set()
    loader = TileLoader(source, budget=10_000)
    for key in KEYS:
        loader.request([key], [0])
        loader.wait()
    kept = [key for key in KEYS if loader.keeps(key)]
    assert kept == KEYS[-2:]
    loader.close()


@pytest.mark.threads
def test_what_is_asked_for_now_comes_before_what_was(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.loader.MOST_THREADS", 1)
    source: Any = Source()
    loader = TileLoader(source)
    loader.request(KEYS[:4], [0])
    wait_until(lambda: source.began)
    loader.request(KEYS[6:], [0])
    source.go.set()
    loader.wait()
    assert [key for key, _ in source.began] == [KEYS[0], *KEYS[6:], *KEYS[1:4]]
    loader.close()
