"""A loader of tiles: made in threads, coarse ones first, within a memory budget.

A renderer requests the tiles of a view, the most important ones first, and draws those that are
ready. Tiles that no view requests any more are cancelled if unfinished, and dropped when memory
is short.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future, wait
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from flowtex._util.array_types import Halves
from flowtex._util.cache import ByteCache
from flowtex._util.forks import ProcessLock, renew_after_fork
from flowtex._util.progress import Stopped, pool, stoppable
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.pyramid import Pyramid, TileKey
from flowtex.textures.triangle_geometry import TriangleGeometry

#: Memory of the tiles that are kept, in bytes.
BUDGET_BYTES = 1_000_000_000
#: Memory of a texel: four numbers of half precision.
TEXEL_BYTES = 8
#: Memory of a node beside its texels.
NODE_BYTES = 300
#: Memory of a triangle that has its own vertices.
TRIANGLE_BYTES = 250
#: Most tiles that are made at once for one view.
MOST_THREADS = 4
#: Seconds before the last request within which a tile must have been requested, or it is dropped.
GRACE_S = 2.0
#: Seconds after which a tile that failed may be requested again.
RETRY_S = 10.0


@dataclass(eq=False)
class Tile:
    """One tile with the layers of the destination times that were requested."""

    key: TileKey
    textures: TextureSet | None  #: ``None`` where nothing is drawn.
    prepared: Any = None  #: Data that the renderer has prepared.
    layers: dict[int, Halves | None] = field(default_factory=dict)

    @property
    def nbytes(self) -> int:
        """Memory of the tile, on the graphics card or before its transfer."""
        if self.textures is None:
            return 0
        rows, columns = self.textures.geometry.size
        layers = self.textures.count * max(len(self.layers), 1)
        memory = rows * columns * (TEXEL_BYTES * layers + NODE_BYTES)
        if isinstance(self.textures.geometry, TriangleGeometry):
            memory += len(self.textures.geometry.triangles) * TRIANGLE_BYTES
        return memory

    def make(self, step: int) -> Halves:
        """Make the layers of a destination time."""
        if self.textures is None:
            return np.empty((0, 0, 0, 4), np.float16)
        return self.textures.layers(step)

    def take(self, step: int) -> Halves:
        """Return the layers of a destination time, without keeping them."""
        layers = self.layers.get(step)
        self.layers[step] = None
        if layers is None:
            return self.make(step)
        return layers


class TileLoader:
    """Makes tiles of a pyramid in threads.

    ``prepare`` is called in a thread, and returns the data beside the layers that drawing textures
    needs. ``notify`` is called in a thread whenever a tile has become ready or has failed. Errors
    are kept in ``errors`` by tile; a tile that failed is tried again when it is requested some
    seconds later, as the reason may be a network. ``clock`` returns seconds.
    """

    def __init__(
        self,
        pyramid: Pyramid,
        *,
        prepare: Callable[[TextureSet], Any] = lambda textures: None,
        notify: Callable[[], None] = lambda: None,
        budget: int = BUDGET_BYTES,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.pyramid = pyramid
        self.errors: dict[TileKey, Exception] = {}
        self._failed: dict[TileKey, float] = {}
        self._prepare = prepare
        self._notify = notify
        self._clock = clock
        self._tiles: ByteCache[TileKey, Tile] = ByteCache(budget)
        #: Times of the last request of each tile, and of any.
        self._requests: dict[TileKey, float] = {}
        self._latest = 0.0
        self._running: dict[tuple[TileKey, int], Future[None]] = {}
        self._lock = ProcessLock()
        self._pool: Executor | None = None
        renew_after_fork(self)

    def renew(self) -> None:
        """Forget, in a forked process, the tiles that threads of the process before make."""
        self._running.clear()

    def keeps(self, key: TileKey) -> bool:
        """Return whether a tile is in memory."""
        return key in self._tiles

    def get(self, key: TileKey, steps: Sequence[int]) -> Tile | None:
        """Return a tile that has the layers of these destination times, or ``None``."""
        tile = self._tiles.peek(key)
        ready = tile is not None and all(step in tile.layers for step in steps)
        if ready:
            return tile
        return None

    def has_failed(self, key: TileKey) -> bool:
        """Return whether a tile failed recently; errors of earlier failures are dropped."""
        if self._failed.get(key, np.inf) < self._clock() - RETRY_S:
            self._failed.pop(key, None)
            self.errors.pop(key, None)
        return key in self.errors

    def request(self, keys: Sequence[TileKey], steps: Sequence[int]) -> None:
        """Request tiles in this order, and drop those without a recent request."""
        self._latest = self._clock()
        with self._lock:
            # Tiles that have not begun wait behind those requested now.
            later = [job for job, future in self._running.items() if future.cancel()]
            for job in later:
                del self._running[job]
            for key in keys:
                self._requests[key] = self._latest
            jobs: dict[tuple[int, ...], list[TileKey]] = {}
            for key in dict.fromkeys([*keys, *(key for key, _ in later)]):
                asked = {*(steps if key in keys else ()), *(n for k, n in later if k == key)}
                if missing := tuple(step for step in sorted(asked) if self._is_missing(key, step)):
                    jobs.setdefault(missing, []).append(key)
            for missing, group in jobs.items():
                self._submit(group, missing)

    def _is_missing(self, key: TileKey, step: int) -> bool:
        """Return whether a tile is requested, but neither in memory nor on its way nor failed."""
        is_pending = self.get(key, [step]) is not None or (key, step) in self._running
        return self._is_requested(key) and not is_pending and not self.has_failed(key)

    def _submit(self, keys: Sequence[TileKey], steps: Sequence[int]) -> None:
        if self._pool is None:
            self._pool = pool(min(os.cpu_count() or 1, MOST_THREADS), "flowtex-tile")
        for group in self.pyramid.groups(keys):
            future = self._pool.submit(self._make, group, steps)
            if not future.done():  # a thread waits for the lock before it ends
                self._running |= {(key, step): future for key in group for step in steps}

    @property
    def busy(self) -> bool:
        """Whether requested tiles are being made."""
        with self._lock:
            return any(self._is_requested(key) for key, _ in self._running)

    def wait(self) -> None:
        """Wait for the tiles that were requested."""
        while True:
            with self._lock:
                futures = []
                for (key, _), f in self._running.items():
                    if self._is_requested(key):
                        futures.append(f)
            if not futures:
                return
            wait(futures)  # some may have been submitted again by now

    def close(self) -> None:
        """Stop, without waiting for unfinished tiles."""
        self._requests.clear()
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
        self._pool = None
        self._tiles.clear()

    def _is_requested(self, key: TileKey) -> bool:
        return self._requests.get(key, -np.inf) > self._latest - GRACE_S

    def _make(self, keys: Sequence[TileKey], steps: Sequence[int]) -> None:
        tiles: dict[TileKey, Tile] = {}
        try:
            with stoppable(lambda: not any(map(self._is_requested, keys))):
                tiles = {key: tile for key in keys if (tile := self._tiles.peek(key))}
                if fresh := [key for key in keys if key not in tiles]:
                    for key, textures in self.pyramid.tiles(fresh, steps).items():
                        tiles[key] = Tile(key, textures, textures and self._prepare(textures))
                for tile in tiles.values():
                    for step in steps:
                        tile.layers[step] = tile.make(step)
                    self._tiles.put(tile.key, tile)  # to count its new size
        except Stopped:
            pass
        except Exception as error:
            if len(keys) > 1:  # the others may be without fault
                for key in keys:
                    self._make([key], steps)
                return
            self.errors[keys[0]], self._failed[keys[0]] = error, self._clock()
        finally:
            for tile in tiles.values():
                if tile.textures is not None:
                    tile.textures.forget()
            with self._lock:
                for key in keys:
                    for step in steps:
                        self._running.pop((key, step), None)
            self._notify()
