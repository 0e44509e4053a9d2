"""Feed of arrays to the client of a widget: coarse ones first, then all, then those it requests.

Threads do the long work. Some send parts of the current scene, which its source makes. Another
thread makes the next scene, such as the whole one after a coarse one, or the scene of new settings,
and replaces the current scene when the next one can be shown.
"""

from __future__ import annotations

import math
import threading
import time
import traceback
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from contextlib import suppress
from functools import partial
from typing import Any

from flowtex._util.array_types import AnyArray
from flowtex._util.forks import ProcessLock, ProcessSemaphore, renew_after_fork
from flowtex._util.progress import Stopped, has_threads, start
from flowtex.host import still
from flowtex.host.still import MakeCamera
from flowtex.host.view import TileSource, WebView, first_parts, in_pool
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.rendering.webgl.protocol import Header, Parts, part_buffer, part_info
from flowtex.scene.scene import Change
from flowtex.textures.tiles.pyramid import TileKey

#: A field of more nodes, at all times together, is shown coarse first.
LARGE_NODES = 60_000
#: Nodes of the coarse form of a steady field.
COARSE_STEADY = 6_000
#: Nodes of the coarse form of a field that varies, which takes longer to trace.
COARSE_VARYING = 2_500
#: Bytes that go in one message together.
MESSAGE_BYTES = 2_000_000
#: Seconds after which data without an acknowledgement are sent again.
RESEND_WAITS_S = (2.5, 4.0, 8.0, 16.0)
#: Seconds in which a client may request parts that are being sent, as the header comes first.
COMING_S = 2.0
#: Scenes that are made at once: thirty widgets would slow each other down.
_turns = ProcessSemaphore(2)


class Feed:
    """Arrays of a view on their way to a client.

    ``moment`` returns the time that is shown. ``announce`` is called with a new header, without
    settings and camera, before its arrays are sent; ``send`` with a message and its buffers.
    """

    def __init__(
        self,
        view: WebView,
        *,
        moment: Callable[[], float],
        announce: Callable[[Header], None],
        send: Callable[[Header, list[memoryview]], None],
    ) -> None:
        self.view = view
        self._moment = moment
        self._announce = announce
        self._send = send
        self._lock = ProcessLock()  # the source, and the order of messages
        self._building = ProcessLock()  # one scene is made after the other
        # Not held while anything is sent: a host may change the scene while it holds a lock of its
        # own, which sending takes as well.
        self._counting = ProcessLock()
        self._order = 0  # of the latest change
        self._live = self._closed = False
        #: Requests that a client waits for.
        self._requests: set[str] = set()
        #: Time until which steps that are being sent are not sent again, and these steps.
        self._coming: tuple[float, tuple[int, ...]] = (0.0, ())
        self._sent: dict[str, str] = {}
        #: Names of the time-independent parts of the scene; empty for the first scene.
        self._surface: list[str] = []
        #: Still of the scene, if it was asked for.
        self.still: Future[bytes] | None = None
        self._sending: Future[None] = Future()
        #: Whether nothing is left to be made.
        self.settled = threading.Event()
        self.acknowledged = threading.Event()
        self.source = TileSource(self._first())
        view.scene.observe(self._scene_changed)
        renew_after_fork(self)

    def renew(self) -> None:
        """Forget, in a forked process, the work of threads of the process before."""
        self.still = None
        self._sending = Future()
        self._sending.set_result(None)
        self.settled = threading.Event()
        self.settled.set()
        self.acknowledged = threading.Event()

    @property
    def header(self) -> Header:
        """Header of the present scene, without settings and camera."""
        state = {"generation": self.source.generation, "surface": self._surface}
        return {**self.source.scene.constants(), **state}

    def start(self) -> None:
        """Send what is shown first, without being asked, and then make the whole of it.

        Requests arrive only after the cell that shows a widget has ended.
        """
        self.ready()
        self._sending.add_done_callback(lambda _: self._build(partial(self._complete, 0)))
        if has_threads():
            start(self._send_again, "flowtex-resend")

    def draw(self, size: tuple[int, int], camera: MakeCamera, **look: Any) -> None:
        """Draw a still of the scene, once, after what is being sent."""
        sending = self._sending  # a later one may be behind the still in the pool

        def make() -> bytes:
            sending.result()
            return still.still_png(self.view, size, camera, data=self.source.scene, **look)

        self.still = self.still or in_pool(make, lambda: self._closed)

    def ready(self) -> None:
        """Answer a client that has no arrays yet."""
        self._expect(self.source.scene)
        self._sending = in_pool(lambda: self._guarded(self._send_first), lambda: self._closed)

    def _expect(self, scene: ClientData) -> None:
        """Remember that the parts of the present moment are being sent."""
        self._coming = (time.monotonic() + COMING_S, scene.moment(self._moment()))

    def load(self, request: str, key: TileKey | None, steps: Sequence[int], kind: str = "") -> None:
        """Answer a client that needs a tile, or the whole or marks of a kind, at time steps."""
        until, coming = self._coming
        if key is None and not kind and time.monotonic() < until and set(steps) <= set(coming):
            self._sending.add_done_callback(lambda _: self._end(request))
            return
        self._requests.add(request)
        source = self.source
        future = source.ask(key, steps, lambda: request not in self._requests, kind)
        future.add_done_callback(partial(self._answer, source.scene, request))

    def drop(self, request: str) -> None:
        """Cancel a request that a client no longer needs."""
        self._requests.discard(request)

    def _answer(self, scene: ClientData, request: str, future: Future[Parts]) -> None:
        """Send the parts that a client requested, or why there are none."""
        self._requests.discard(request)
        error = future.exception()
        if isinstance(error, Stopped) or self._closed:
            return
        if error is not None:
            traceback.print_exception(error)
            self._end(request, error=_words(error))
            return
        with self._lock:
            if scene is self.source.scene:
                self._live = True
                self._deliver(future.result(), again=True)
            self._end(request)

    def _end(self, request: str, **result: str) -> None:
        with self._lock:
            self._send({"kind": "loaded", "request": request, **result}, [])

    def _send_again(self) -> None:
        """Send again to a client that has not answered: it may not have been loaded yet."""
        for wait in RESEND_WAITS_S:
            if self.acknowledged.wait(wait):
                return
            if self._live:
                self.ready()

    def _scene_changed(self, affects: Change) -> None:
        """Send to the client what a change of the scene affects."""
        if affects == "uniform":
            return
        self.still = None
        if affects == "appearance":
            self._build(self._recolour)
            return
        with self._counting:
            self._order += 1
            order = self._order
            self.settled.clear()

        def change() -> None:
            if order != self._order:
                return
            if affects == "trace":
                self._replace(self._first(), order)
            else:
                self._replace(self.view.data(), order)

        self._build(change, partial(self._complete, order))

    def close(self) -> None:
        """Stop; a trace in progress ends and is not sent."""
        self._closed = True
        self.acknowledged.set()
        self.source.close()
        self.settled.set()

    def _first(self) -> ClientData:
        """Return the data that a client gets first, coarse ones of a large field."""
        field = self.view.field
        nodes = math.prod(self.view.shape)
        # The coarse form of triangles is the root of their tiles, which is sent first in any case.
        is_whole = self.view.scene.pyramid is None
        if field.triangles is not None or (is_whole and nodes * len(field.times) <= LARGE_NODES):
            return self.view.data()
        if field.steady:
            return self.view.coarse_data(COARSE_STEADY)
        return self.view.coarse_data(COARSE_VARYING)

    def _complete(self, order: int) -> None:
        """Send the full data where the client has coarse ones."""
        shape = self.source.scene.textures.geometry.shape
        if order == self._order and shape != self.view.shape:
            self._replace(self.view.data(), order)
        if order == self._order:
            self.settled.set()

    def _build(self, *jobs: Callable[[], None]) -> None:
        """Do jobs in a daemon thread: a long trace does not keep a kernel from ending."""

        def work() -> None:
            for job in jobs:
                with self._building, _turns:
                    self._guarded(job)

        start(work, "flowtex-build")

    def _guarded(self, job: Callable[[], None]) -> None:
        """Do a job; show its error in the browser instead of the picture, and in the log."""
        try:
            if not self._closed:
                job()
        except Exception as error:  # the caller is in another thread
            # Libraries refuse work while the interpreter ends.
            is_ending = not threading.main_thread().is_alive()
            if self._closed or is_ending:
                return
            traceback.print_exception(error)
            self.settled.set()
            with suppress(Exception):
                self._send({"kind": "error", "text": _words(error)}, [])

    def _replace(self, scene: ClientData, order: int) -> None:
        """Replace the scene that is sent, unless a later change has begun."""
        parts = first_parts(scene, self._moment())
        with self._lock:
            if order != self._order or self._closed:
                return
            if scene.traced != self.source.scene.traced:
                self._sent.clear()  # a client that traces makes some of the arrays itself
            self.source.close()
            self.source = TileSource(scene)
            self._surface = [name for name in parts if "/" not in name]
            # The client removes all other parts.
            for name in list(self._sent):
                if "/" not in name and name not in parts:
                    del self._sent[name]
            self._announce(self.header)
            if self._live:
                self._expect(scene)
                self._deliver(parts, again=False)

    def _recolour(self) -> None:
        """Send the colours of the scene, which keeps its flow."""
        scene = self.view.recoloured(self.source.scene)
        parts = first_parts(scene, self._moment())
        with self._lock:
            if self._closed:
                return
            self.source.scene = scene
            self._announce(self.header)
            if self._live:
                kept = ("flow/", "slices/", "extra/")
                colours = {}
                for n, part in parts.items():
                    if not n.startswith(kept):
                        colours[n] = part
                self._deliver(colours, again=False)

    def _send_first(self) -> None:
        """Send the parts of the present scene with which a client begins."""
        while True:
            scene = self.source.scene
            parts = first_parts(scene, self._moment())
            with self._lock:
                self._live = True
                if scene is self.source.scene:
                    self._deliver(parts, again=True)
                    return

    def _deliver(self, parts: Parts, *, again: bool) -> None:
        """Send arrays, the flow after its surface; those that a client has only when ``again``."""
        batch: list[tuple[Header, AnyArray]] = []
        size = 0
        for name, array in sorted(parts.items(), key=lambda item: ("/" in item[0], item[1].nbytes)):
            info = part_info(name, array)
            if not again and "/" not in name and self._sent.get(name) == info["digest"]:
                continue
            self._sent[name] = info["digest"]
            if batch and size + array.nbytes > MESSAGE_BYTES:
                self._post(batch)
                batch = []
                size = 0
            batch.append((info, array))
            size += array.nbytes
        self._post(batch)

    def _post(self, parts: Sequence[tuple[Header, AnyArray]]) -> None:
        """Send arrays in one message."""
        if self._closed or not parts:
            return
        infos = []
        buffers = []
        for info, array in parts:
            infos.append(info)
            buffers.append(part_buffer(array))
        message = {"kind": "parts", "generation": self.source.generation, "parts": infos}
        self._send(message, buffers)


def _words(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}"
