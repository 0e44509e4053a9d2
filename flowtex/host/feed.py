"""Feed of arrays to a client: coarse ones first, then all, then those that it requests.

Two workers do the long work. One sends the parts of the current scene; the other makes the next
scene, the whole one after a coarse one or that of new settings, and replaces the current one when
the new one can be shown. The scene's source makes the parts that a client requests.
"""

from __future__ import annotations

import heapq
import itertools
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
from flowtex._util.progress import Stopped, has_threads, start
from flowtex.host import still
from flowtex.host.still import MakeCamera
from flowtex.host.view import TileSource, WebView
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.rendering.webgl.protocol import Header, Parts, part_buffer, part_info
from flowtex.scene.scene import Change
from flowtex.textures.tiles.pyramid import TileKey

#: A field of more nodes, at all times together, is shown coarse first.
LARGE_NODES = 60_000
#: Nodes of the coarse form of a steady field, and of one that varies, which takes longer to trace.
COARSE_STEADY, COARSE_VARYING = 6_000, 2_500
#: A field that the client traces is sent whole if the moment shown has at most so many nodes.
VERY_LARGE_NODES = 600_000
#: Bytes that go in one message together.
MESSAGE_BYTES = 2_000_000
#: Seconds after which data without an acknowledgement are sent again.
RESEND_WAITS_S = (2.5, 4.0, 8.0, 16.0)
#: Seconds in which a client may request parts that are being sent, as the header comes first.
COMING_S = 2.0
#: Sends a message with its buffers.
Send = Callable[[Header, list[memoryview]], None]
Job = Callable[[], None]


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
        send: Send,
    ) -> None:
        self._view = view
        self._moment, self._announce, self._send = moment, announce, send
        self._lock = threading.RLock()  # scene and generation, and the order of messages
        self._generation = self._order = 0
        self._live = self._closed = self._drawing = False
        #: Requests that a client waits for.
        self._requests: set[str] = set()
        #: Time until which steps that are being sent are not sent again, and these steps.
        self._coming: tuple[float, tuple[int, ...]] = (0.0, ())
        self._sent: dict[str, str] = {}
        #: Names of the time-independent parts of the scene; empty for the first scene.
        self._surface: list[str] = []
        self.picture: bytes | None = None
        self.pictured, self.settled = threading.Event(), threading.Event()
        self.scene = self._first()
        self.acknowledged = False
        self._timer = self._resend_timer(RESEND_WAITS_S)
        self._answers = Worker(_answer_turns, "flowtex-answer", self._failed)
        self._builds = Worker(_build_turns, "flowtex-build", self._failed)
        self._source = TileSource(self.scene)
        view.scene.observe(self._scene_changed)

    @property
    def header(self) -> Header:
        """Header of the present scene, without settings and camera."""
        state = {"generation": self._generation, "surface": self._surface}
        return {**self.scene.constants(), **state}

    def start(self) -> None:
        """Send what is shown first, without being asked, and then make the whole of it.

        Requests arrive only after the cell that shows a widget has ended.
        """
        self.ready(urgency=2)
        self._answers.do(self._refine)
        if has_threads():
            self._timer.start()

    def draw(self, size: tuple[int, int], camera: MakeCamera, **look: Any) -> None:
        """Draw a still, once, as soon as there is time; ``pictured`` tells when."""

        def make() -> None:
            with suppress(Exception):  # an error does no harm
                self.picture = still.still_png(self._view, size, camera, data=self.scene, **look)
            self.pictured.set()

        if not self._drawing:
            self._drawing = True
            self._answers.do(make, urgency=1)

    def ready(self, urgency: int = 1) -> None:
        """Answer a client that has no arrays yet."""
        self._expect(self.scene)
        self._answers.do(lambda: self._send_parts(self._first_parts), urgency=urgency)

    def _expect(self, scene: ClientData) -> None:
        """Remember that the parts of the present moment are being sent."""
        self._coming = (time.monotonic() + COMING_S, scene.moment(self._moment()))

    def load(self, request: str, key: TileKey | None, steps: Sequence[int], kind: str = "") -> None:
        """Answer a client that needs a tile, or the whole or marks of a kind, at time steps."""
        until, coming = self._coming
        if key is None and not kind and time.monotonic() < until and set(steps) <= set(coming):
            self._answers.do(lambda: self._end(request))  # after what is being sent
            return
        self._requests.add(request)
        source = self._source
        future = source.ask(key, steps, lambda: request not in self._requests, kind)
        future.add_done_callback(partial(self._answer, source.scene, request))

    def drop(self, request: str) -> None:
        """Cancel a request that a client no longer needs."""
        self._requests.discard(request)

    def _answer(self, scene: ClientData, request: str, future: Future[Parts]) -> None:
        """Send the parts made of a scene, or the error."""
        self._requests.discard(request)
        error = future.exception()
        if isinstance(error, Stopped) or self._closed:
            return
        if error is not None:
            traceback.print_exception(error)
            self._end(request, error=_words(error))
            return
        with self._lock:
            if scene is self.scene:
                self._live = True
                self._deliver(future.result(), again=True)
            self._end(request)

    def _end(self, request: str, **result: str) -> None:
        with self._lock:
            self._send({"kind": "loaded", "request": request, **result}, [])

    def _resend_timer(self, waits: tuple[float, ...]) -> threading.Timer:
        timer = threading.Timer(waits[0], self._send_again, [waits[1:]])
        timer.daemon = True
        return timer

    def _send_again(self, waits: tuple[float, ...]) -> None:
        """Send again to a client that has not answered: it may not have been loaded yet."""
        if self.acknowledged or self._closed:
            return
        if self._live:
            self.ready()
        if waits:
            self._timer = self._resend_timer(waits)
            self._timer.start()

    def _scene_changed(self, affects: Change) -> None:
        """Make the textures again, and the traces if need be."""
        if affects == "uniform":
            return
        self.picture, self._drawing = None, False
        self.pictured.clear()
        if affects == "appearance":
            self._builds.do(self._recolour, urgency=2)
            return
        with self._lock:
            self._order += 1
            order = self._order
            self.settled.clear()

        def change() -> None:
            if order == self._order:
                self._replace(self._first() if affects == "trace" else self._view.data())

        self._builds.do(change, urgency=2)
        self._refine()

    def close(self) -> None:
        """Stop; a trace in progress ends and is not sent."""
        self._closed = True
        self._timer.cancel()
        self._answers.close()
        self._source.close()
        self._builds.close()
        for event in (self.pictured, self.settled):
            event.set()

    def _first(self) -> ClientData:
        """Return the scene to begin with: a coarse one of a large field."""
        field, nodes = self._view.field, math.prod(self._view.shape)
        # The coarse form of triangles is the root of their tiles, which is sent first in any case.
        is_whole = self._view.scene.pyramid is None
        if field.triangles is not None or (is_whole and nodes * len(field.times) <= LARGE_NODES):
            return self._view.data()
        if is_whole and nodes <= LARGE_NODES:
            # Where the client traces, no more times are sent than the paths lead through.
            data = self._view.data()
            steps = len(data.moment(self._moment()))
            if data.traced and steps * nodes <= VERY_LARGE_NODES:
                return data
        return self._view.coarse_data(COARSE_STEADY if field.steady else COARSE_VARYING)

    def _refine(self) -> None:
        order = self._order

        def complete() -> None:
            shape = self.scene.textures.geometry.shape
            if order == self._order and shape != self._view.shape:
                self._replace(self._view.data(), order)
            if order == self._order:
                self.settled.set()

        self._builds.do(complete)

    def _replace(self, scene: ClientData, order: int | None = None) -> None:
        """Replace the scene; with ``order`` only if that is still the latest."""
        parts = self._first_parts(scene)
        with self._lock:
            if order not in (None, self._order) or self._closed:
                return
            if scene.traced != self.scene.traced:
                self._sent.clear()  # a client that traces makes some of the arrays itself
            self.scene = scene
            self._source.close()
            self._source = TileSource(scene)
            self._generation += 1
            self._surface = [name for name in parts if "/" not in name]
            # The client removes all other parts.
            kept = [name for name in self._sent if "/" in name or name in parts]
            self._sent = {name: self._sent[name] for name in kept}
            self._announce(self.header)
            if self._live:
                self._expect(scene)
                self._deliver(parts, again=False)

    def _recolour(self) -> None:
        """Send the current colours: the header, and the arrays that differ."""
        scene = self._view.recoloured(self.scene)
        parts = self._first_parts(scene)
        with self._lock:
            if self._closed:
                return
            self.scene = self._source.scene = scene
            self._announce(self.header)
            if self._live:
                kept = ("flow/", "slices/", "extra/")
                colours = {n: part for n, part in parts.items() if not n.startswith(kept)}
                self._deliver(colours, again=False)

    def _first_parts(self, scene: ClientData) -> Parts:
        parts = scene.surface()
        for step in scene.moment(self._moment()):
            parts |= scene.step(step)
        return parts

    def _send_parts(self, parts_of: Callable[[ClientData], Parts]) -> None:
        """Send parts of the current scene, also when it is replaced while they are made."""
        while True:
            scene = self.scene
            parts = parts_of(scene)
            with self._lock:
                self._live = True
                if scene is self.scene:
                    self._deliver(parts, again=True)
                    return

    def _deliver(self, parts: Parts, *, again: bool) -> None:
        """Send arrays, the flow after its surface; those that a client has only when ``again``."""
        batch: list[tuple[Header, AnyArray]] = []
        for name, array in sorted(parts.items(), key=lambda item: ("/" in item[0], item[1].nbytes)):
            info = part_info(name, array)
            if not again and "/" not in name and self._sent.get(name) == info["digest"]:
                continue
            self._sent[name] = info["digest"]
            if batch and sum(a.nbytes for _, a in batch) + array.nbytes > MESSAGE_BYTES:
                self._post(batch)
                batch = []
            batch.append((info, array))
        self._post(batch)

    def _post(self, parts: Sequence[tuple[Header, AnyArray]]) -> None:
        if self._closed or not parts:
            return
        infos = [info for info, _ in parts]
        buffers = [part_buffer(array) for _, array in parts]
        self._send({"kind": "parts", "generation": self._generation, "parts": infos}, buffers)

    def _failed(self, error: Exception) -> None:
        """Show the error in the browser instead of the picture, and in the kernel's log."""
        traceback.print_exception(error)
        self.settled.set()
        with suppress(Exception):
            self._send({"kind": "error", "text": _words(error)}, [])


def _words(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}"


class Worker:
    """Jobs of a widget, done one after the other, the urgent ones first.

    At most as many workers as ``turns`` allow do a job at once: thirty widgets would slow each
    other down. A thread exists while there is work, and is a daemon, so that a long trace does not
    keep a kernel from ending. ``failed`` is called with an error that a job raised; the next job is
    done all the same.
    """

    def __init__(
        self, turns: threading.Semaphore, name: str, failed: Callable[[Exception], None]
    ) -> None:
        self._turns, self._name, self._failed = turns, name, failed
        # Garbage collection may close a widget in a thread that holds the lock.
        self._lock = threading.RLock()
        self._count = itertools.count()
        self._jobs: list[tuple[int, int, Job]] = []
        self.busy = False  #: Whether something is being done, or waits.
        self._closed = False

    def do(self, job: Job, *, urgency: int = 0) -> None:
        """Do a job after all that are as urgent or more so."""
        with self._lock:
            if self._closed:
                return
            heapq.heappush(self._jobs, (-urgency, next(self._count), job))
            if self.busy:
                return
            self.busy = True
        start(self._work, self._name)

    def close(self) -> None:
        """Begin no other job."""
        self._closed = True
        self._jobs.clear()

    def _work(self) -> None:
        while True:
            with self._turns:
                with self._lock:
                    try:
                        job = heapq.heappop(self._jobs)[2]
                    except IndexError:
                        self.busy = False
                        return
                try:
                    job()
                except Exception as error:  # the caller is in another thread
                    if not self._closed:
                        self._failed(error)
                del job


#: More workers answer than there are processors, as one may be tracing for long.
_answer_turns, _build_turns = threading.Semaphore(4), threading.Semaphore(2)
