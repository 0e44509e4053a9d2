"""Sends a client its arrays: coarse ones first, then all, then what it asks for.

Two threads do all that takes time. One answers the client from the scene that there is; the other
makes the next scene, the whole one after a coarse one or that of new settings, and puts it in the
place of the first when it can be shown.
"""

from __future__ import annotations

import hashlib
import threading
import traceback
from collections import OrderedDict
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex import preview
from flowtex.renderers.webgl import Scene
from flowtex.staging import Stage
from flowtex.widget.worker import Worker

__all__ = ["Feed"]

Parts = dict[str, NDArray[Any]]

#: A field of more nodes, at all times together, is shown coarse first.
LARGE = 60_000
#: Nodes of the coarse form of a steady field, and of one that varies, which takes longer to trace.
COARSE_STEADY, COARSE_VARYING = 6_000, 2_500
#: Bytes that go in one message together.
TOGETHER = 2_000_000
#: Steps whose arrays are kept, for another client of the same widget.
KEPT_STEPS = 2
#: Seconds for which the whole scene waits until the coarse one can be seen.
HEAD_START = 3.0


class Feed:
    """Arrays of a stage on their way to a client.

    Parameters
    ----------
    stage
        What is shown.
    moment
        Tells the time that is shown.
    announce
        Given a new header, without settings and camera, before its arrays are sent.
    send
        Given a message and its buffers.
    """

    def __init__(
        self,
        stage: Stage,
        *,
        moment: Callable[[], float],
        announce: Callable[[dict[str, Any]], None],
        send: Callable[[dict[str, Any], list[memoryview]], None],
    ) -> None:
        self._stage = stage
        self._moment, self._announce, self._send = moment, announce, send
        self._lock = threading.RLock()  # scene and generation, and the order of messages
        self._generation = self._order = 0
        self._live = self._closed = False
        self._asked: set[int] = set()
        self._sent: dict[str, bytes] = {}
        self._steps: OrderedDict[int, Parts] = OrderedDict()
        self.picture: bytes | None = None
        self.pictured, self.settled = threading.Event(), threading.Event()
        self.scene = self._first()
        self._answers = Worker("flowtex-answers", self._failed)
        self._makes = Worker("flowtex-makes", self._failed)

    @property
    def header(self) -> dict[str, Any]:
        """Header of the present scene, without settings and camera."""
        return {**self.scene.constants(), "generation": self._generation}

    def start(self, size: tuple[int, int], camera: dict[str, Any]) -> None:
        """Begin to work; a small picture of that size is drawn as soon as there is time."""
        self._answers.do(self._prepare, urgency=2)
        self._answers.do(lambda: self._draw(size, camera))
        self._makes.do(lambda: (self.pictured.wait(HEAD_START), None)[1])
        self._refine()

    def ready(self) -> None:
        """Answer a client that has nothing yet."""
        self._answers.do(self._send_all, urgency=1)

    def need(self, step: int) -> None:
        """Answer a client that needs a step."""
        if step in self._asked or not 0 <= step < self.scene.steps:
            return
        self._asked.add(step)
        self._answers.do(lambda: self._send_step(step), urgency=1)

    def restart(self, *, traces: bool) -> None:
        """Follow new settings: make the textures again, and the traces if need be."""
        with self._lock:
            self._order += 1
            order = self._order
            self.settled.clear()

        def change() -> None:
            if order == self._order:
                self._replace(self._first() if traces else self._stage.scene())

        self._makes.do(change)
        self._refine()

    def close(self) -> None:
        """Stop; a trace that is being made comes to its end unheard."""
        self._closed = True
        self._answers.close()
        self._makes.close()
        for event in (self.pictured, self.settled):
            event.set()

    def _first(self) -> Scene:
        """Return the scene to begin with: a coarse one of a large field."""
        field = self._stage.field
        if field.valid.size * len(field.times) <= LARGE:
            return self._stage.scene()
        return self._stage.coarse_scene(COARSE_STEADY if field.steady else COARSE_VARYING)

    def _refine(self) -> None:
        """Replace a coarse scene by the whole one."""
        order = self._order

        def change() -> None:
            if order != self._order:
                return
            if self.scene.textures.geometry.field.shape != self._stage.field.shape:
                self._replace(self._stage.scene())
            if order == self._order:
                self.settled.set()

        self._makes.do(change)

    def _replace(self, scene: Scene) -> None:
        """Put a scene in the place of the present one, once it can be shown."""
        order = self._order
        steps = {step: scene.step(step) for step in scene.moment(self._moment())}
        with self._lock:
            if order != self._order or self._closed:
                return
            self.scene, self._steps = scene, OrderedDict(steps)
            self._generation += 1
            self._announce(self.header)
            if self._live:
                self._deliver({**scene.surface(), **_merged(steps)}, again=False)

    def _prepare(self) -> None:
        """Trace and pack what shows the present moment."""
        scene = self.scene
        for step in scene.moment(self._moment()):
            self._parts_of(scene, step)

    def _parts_of(self, scene: Scene, step: int) -> Parts:
        with self._lock:
            if scene is self.scene and step in self._steps:
                self._steps.move_to_end(step)
                return self._steps[step]
        made = scene.step(step)
        with self._lock:
            if scene is self.scene:
                self._steps[step] = made
                while len(self._steps) > KEPT_STEPS:
                    self._steps.popitem(last=False)
        return made

    def _send_all(self) -> None:
        scene = self.scene
        steps = {step: self._parts_of(scene, step) for step in scene.moment(self._moment())}
        with self._lock:
            self._live = True
            if scene is not self.scene:  # replaced meanwhile, and not sent, as nobody had asked
                scene, steps = self.scene, dict(self._steps)
            self._deliver({**scene.surface(), **_merged(steps)}, again=True)

    def _send_step(self, step: int) -> None:
        self._asked.discard(step)
        scene = self.scene
        if step >= scene.steps:
            return
        parts = self._parts_of(scene, step)
        with self._lock:
            if scene is self.scene:
                self._deliver(parts, again=True)
                return
        self._send_step(step)

    def _deliver(self, parts: Parts, *, again: bool) -> None:
        """Send arrays, the small ones first; those that a client has only when ``again``."""
        batch: Parts = {}
        for name, array in sorted(parts.items(), key=lambda item: item[1].nbytes):
            digest = hashlib.blake2b(np.ascontiguousarray(array).data, digest_size=16).digest()
            if not again and "/" not in name and self._sent.get(name) == digest:
                continue
            self._sent[name] = digest
            if batch and sum(a.nbytes for a in batch.values()) + array.nbytes > TOGETHER:
                self._post(batch)
                batch = {}
            batch[name] = array
        if batch:
            self._post(batch)

    def _post(self, parts: Parts) -> None:
        if self._closed:
            return
        arrays = [np.ascontiguousarray(array) for array in parts.values()]
        message = {
            "kind": "parts",
            "generation": self._generation,
            "names": list(parts),
            "dtypes": [array.dtype.name for array in arrays],
            "shapes": [list(array.shape) for array in arrays],
        }
        self._send(message, [array.reshape(-1).view(np.uint8).data for array in arrays])

    def _draw(self, size: tuple[int, int], camera: dict[str, Any]) -> None:
        """Draw the small picture, which nothing depends on."""
        with suppress(Exception):
            self.picture = preview.preview_png(
                self._stage, size, camera=camera, time=self._moment(), scene=self.scene
            )
        self.pictured.set()

    def _failed(self, error: Exception) -> None:
        """Tell in the browser, where the picture would have been, and in the kernel's log."""
        traceback.print_exception(error)
        self.settled.set()
        with suppress(Exception):
            self._send({"kind": "error", "text": f"{type(error).__name__}: {error}"}, [])


def _merged(steps: dict[int, Parts]) -> Parts:
    return {name: array for parts in steps.values() for name, array in parts.items()}
