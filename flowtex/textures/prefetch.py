"""The next slices of a field that varies, computed while the present ones are shown.

Tracing a step and laying it into texels takes longer than a frame. One thread does it for the
step that comes next in the direction in which time goes.
"""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor

from flowtex._util.array_types import Floats32
from flowtex.textures.texture_set import TextureSet


class LayerPrefetch:
    """Layers of a texture set by destination time, one of them computed before it is needed."""

    def __init__(self, textures: TextureSet) -> None:
        self._textures = textures
        self._pool: ThreadPoolExecutor | None = None
        self._ready: tuple[int, Future[Floats32]] | None = None

    def prepare(self, step: int) -> None:
        """Begin to compute the layers of a step; one that does not exist is none."""
        if not 0 <= step < self._textures.store.steps:
            return
        if self._ready is not None and self._ready[0] == step:
            return
        if self._ready is not None:
            self._ready[1].cancel()
        if self._pool is None:
            self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="flowtex-prefetch")
        self._ready = (step, self._pool.submit(self._textures.layers, step))

    def take(self, step: int) -> Floats32:
        """Layers of a step, (layers, H, W, 4): those that were prepared, or computed now."""
        ready = self._ready
        if ready is None or ready[0] != step:
            return self._textures.layers(step)
        self._ready = None
        return ready[1].result()

    def close(self) -> None:
        """Stop the thread."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
        self._pool = self._ready = None
