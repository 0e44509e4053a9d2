"""How a flow travels to a browser: the host requests parts by name from one source.

::

    parts(None, ())          the parts of the whole surface that are the same at all times
    parts(None, (3,))        the flow and the values of the whole at a time step
    parts(key, (3, 4))       a tile: its header and surface, and its flow and values at two steps
    parts(None, (3,), kind)  marks of a kind at a time step: critical points, or separatrices

A widget sends them in messages, the application as files, and an exported page holds them;
``client/src/sources`` is the other side. A store has the same parts in its own files, which
:mod:`flowtex.pyramid.tasks` writes and a browser reads without a server.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial

from flowtex._util.cache import ByteCache
from flowtex._util.progress import check, stoppable, track
from flowtex._util.threads import pool
from flowtex.field.derived import steps_of
from flowtex.rendering.webgl import ClientData, Packing, packing_of, tile_parts
from flowtex.rendering.webgl.protocol import Parts
from flowtex.textures import TextureSet
from flowtex.textures.tiles import TileKey

#: Memory of the tiles that are kept to be sent again, and of a node of them, in bytes.
BUDGET_BYTES, NODE_BYTES = 400_000_000, 200
#: Parts that are made at once, for all browsers together.
MOST_THREADS = max(os.cpu_count() or 1, 4)

_pool = pool(MOST_THREADS, "flowtex-tile")
#: Marks take seconds, for which no tile has to wait.
_marks_pool = pool(1, "flowtex-marks")


@dataclass(frozen=True, eq=False)
class _Tile:
    """Textures of a tile, ``None`` if nothing of it is drawn, and their packed slices if any."""

    textures: TextureSet | None
    packing: Packing | None

    @property
    def nbytes(self) -> int:
        nodes = 0 if self.textures is None else self.textures.geometry.field.valid.size
        return NODE_BYTES * nodes + (0 if self.packing is None else self.packing.nbytes)


class TileSource:
    """Source of the parts of a scene; those of tiles are made on request.

    ``scene`` may be replaced at any time by the same scene in other colours. All methods may be
    called from any thread.
    """

    def __init__(self, scene: ClientData, budget: int = BUDGET_BYTES) -> None:
        self.scene = scene
        self._tiles: ByteCache[TileKey, _Tile] = ByteCache(budget)
        self._is_closed = False

    def parts(self, key: TileKey | None, steps: Sequence[int], kind: str = "") -> Parts:
        """Return the parts of a tile at time steps, or of the whole; see the module's text.

        Raises a LookupError if the tile or step does not exist.
        """
        if kind:
            return {n: part for step in steps for n, part in self.scene.mark(kind, step).items()}
        if key is None:
            scene = self.scene
            parts = {} if steps else scene.surface()
            return parts | {n: part for step in steps for n, part in scene.step(step).items()}
        tile = self.tile(key, steps)
        parts = tile_parts(key, tile, *steps)
        if tile is not None:
            tile.textures.forget()
        return parts

    def tile(self, key: TileKey, steps: Sequence[int]) -> ClientData | None:
        """Return a tile as it is sent, or ``None`` where nothing of it is drawn."""
        scene = self.scene
        textures = self._tiles.get(key, lambda: _made(scene, key, steps)).textures
        if textures is None:
            return None
        return scene.tile(textures, partial(steps_of, textures.geometry.field))

    def ask(
        self,
        key: TileKey | None,
        steps: Sequence[int],
        is_over: Callable[[], bool] = lambda: False,
        kind: str = "",
    ) -> Future[Parts]:
        """Make parts in a thread.

        Once it ``is_over``, or the source is closed, the future fails with
        :class:`~flowtex._util.progress.Stopped`.
        """

        def make() -> Parts:
            with stoppable(lambda: self._is_closed or is_over()):
                check()
                return self.parts(key, steps, kind)

        return (_marks_pool if kind else _pool).submit(make)

    def tiles(self) -> Iterator[Parts]:
        """Yield the parts of all tiles that are sent without a request, coarse ones first."""
        scene, steps = self.scene, range(self.scene.steps)
        keys: list[TileKey] = []
        level = [] if scene.pyramid is None else scene.pyramid.children(None)
        while scene.pyramid is not None and level and level[0].level >= scene.finest:
            keys += level
            level = [child for key in level for child in scene.pyramid.children(key)]
        starts = range(0, len(keys), MOST_THREADS)
        for n in track(starts, len(starts), "Packing tiles"):
            futures = [self.ask(key, steps) for key in keys[n : n + MOST_THREADS]]
            yield from (future.result() for future in futures)

    def close(self) -> None:
        """Stop making parts."""
        self._is_closed = True
        self._tiles.clear()


def _made(scene: ClientData, key: TileKey, steps: Sequence[int]) -> _Tile:
    """Return a tile; slices that are sent have a halo large enough for these steps."""
    if scene.pyramid is None:
        msg = f"tile {tuple(key)} does not exist: the surface is sent as a whole"
        raise LookupError(msg)
    if scene.traced:
        return _Tile(scene.pyramid.textures(key), None)
    textures = scene.pyramid.tile(key, [scene.source(step) for step in steps])
    return _Tile(textures, None if textures is None else packing_of(textures))
