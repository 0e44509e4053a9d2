"""Slices computed before they are needed.

Tracing a step and laying it into texels takes longer than a frame. One thread does it for the
first picture while its mesh and its shaders are made, and then for the step that comes next in the
direction in which time goes.
"""

from __future__ import annotations

import contextvars
from concurrent.futures import Future, ThreadPoolExecutor

from flowtex._util.array_types import Halves
from flowtex.textures.texture_set import TextureSet


class LayerPrefetch:
    """Layers of a texture set by destination time, one of them computed before it is needed."""

    def __init__(self, textures: TextureSet) -> None:
        self._textures = textures
        self._pool: ThreadPoolExecutor | None = None
        self._ready: tuple[tuple[int, int | None], Future[Halves]] | None = None

    def prepare(self, step: int, lags: int | None = None) -> None:
        """Begin to compute the layers of a step, at so many lags; one that does not exist is none.

        It stops where work in this thread would, as :func:`flowtex._util.progress.stoppable` says.
        """
        if not 0 <= step < self._textures.store.steps:
            return
        if self._ready is not None and self._ready[0] == (step, lags):
            return
        if self._ready is not None:
            self._ready[1].cancel()
        if self._pool is None:
            self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="flowtex-prefetch")
        make = contextvars.copy_context().run
        self._ready = (step, lags), self._pool.submit(make, self._textures.layers, step, lags)

    def take(self, step: int, lags: int | None = None) -> Halves:
        """Layers of a step, (layers, H, W, 4): those that were prepared, or computed now."""
        ready = self._ready
        if ready is None or ready[0] != (step, lags):
            return self._textures.layers(step, lags)
        self._ready = None
        return ready[1].result()

    def close(self) -> None:
        """Stop the thread."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
        self._pool = self._ready = None
