"""Tiles of a large surface on their way to a client: what its view asks for, once it is made."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from itertools import product

from flowtex.rendering.webgl import ClientData
from flowtex.rendering.webgl.protocol import Parts
from flowtex.tiles import TileKey, TileLoader
from flowtex.web.tiles import packed_tile, tile_loader
from flowtex.widget.worker import Worker

__all__ = ["TileFeed"]

#: Memory of the tiles that are kept to be sent again, in bytes.
BUDGET_BYTES = 400_000_000

Job = tuple[TileKey, int]


class TileFeed:
    """Tiles of the scene that is shown.

    ``send`` is called with the scene, the arrays of a tile, and the number of what is sent. A
    client tells the last number that it has seen: what was sent since then is on its way, and what
    was sent before and is asked for again has been dropped there.
    """

    def __init__(
        self, worker: Worker, send: Callable[[ClientData, Parts, int], None], scene: ClientData
    ) -> None:
        self._worker, self._send = worker, send
        self._lock = threading.Lock()
        self._loader: TileLoader | None = None
        self._wanted: list[Job] = []
        self._sent: dict[Job, int] = {}
        self._count = 0
        self.show(scene)

    def show(self, scene: ClientData) -> None:
        """Send tiles of another scene from now on."""
        with self._lock:
            self.close()
            self._scene = scene
            self.forget()
            if scene.pyramid is not None:
                self._loader = tile_loader(
                    scene,
                    scene.pyramid,
                    notify=lambda: self._worker.do(self._send_ready, urgency=1),
                    budget=BUDGET_BYTES,
                )

    def recolour(self, scene: ClientData) -> None:
        """Send the same tiles in other colours from now on; what is on its way has the old ones."""
        with self._lock:
            self._scene, self._sent = scene, {}
        self._worker.do(self._send_ready, urgency=1)

    def forget(self) -> None:
        """Begin anew with a client that has nothing."""
        self._wanted, self._sent = [], {}

    def request(self, keys: Sequence[TileKey], steps: Sequence[int], seen: int) -> None:
        """Answer a client that needs tiles, in this order, and no others that it asked for."""
        scene, loader = self._scene, self._loader
        steps = [step for step in steps if 0 <= step < scene.steps]
        if loader is None:
            return
        with self._lock:
            self._wanted = [
                job
                for job in product(keys, steps)
                if self._sent.get(job, 0) <= seen and not loader.has_failed(job[0])
            ]
            loader.request(keys, [scene.source(step) for step in steps])
        self._worker.do(self._send_ready, urgency=1)

    def close(self) -> None:
        """Stop; what is being made is not sent."""
        if self._loader is not None:
            self._loader.close()
        self._loader = None

    def _send_ready(self) -> None:
        """Send what is wanted and made, and tell what has gone wrong."""
        scene, loader = self._scene, self._loader
        if loader is None:
            return
        for job in list(self._wanted):
            key, step = job
            tile = loader.get(key, [scene.source(step)])
            failed = loader.errors.get(key)
            if tile is None and failed is None:
                continue
            with self._lock:
                if job not in self._wanted or scene is not self._scene:
                    continue
                self._wanted.remove(job)
                self._count += 1
                self._sent[job] = self._count
                number = self._count
            if failed is not None:
                raise failed
            if tile is not None:
                self._send(scene, packed_tile(scene, tile, [step]), number)
