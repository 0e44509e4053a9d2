"""Context of the controllers of a page: the view, the state, and signals between them."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from flowtex._util.progress import Stopped, stoppable
from flowtex.app.controllers.library import Choice, Library
from flowtex.app.server.files import Routes
from flowtex.app.server.page import PageState, shortened
from flowtex.app.streaming.area import FlowArea
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.interpolation import steps_around
from flowtex.remedies import error_for_page
from flowtex.scene.fields import TracedFlow
from flowtex.scene.forms import FLAGS
from flowtex.settings import Settings, Signal
from flowtex.sources.open_source import FlowSource

#: The state of a page by name, as in :mod:`.serialization`.
State: TypeAlias = Mapping[str, Any]
_log = logging.getLogger(__name__)
#: Seconds after which the page says that something is being opened.
BUSY_DELAY_S = 0.3
#: Characters of a name in a message.
NAME_LENGTH = 80


class Context:
    """Objects that the controllers of a page share."""

    def __init__(self, state: PageState, area: FlowArea, library: Library) -> None:
        #: The state of the page, the view, and the flows that the page may open.
        self.state = state
        self.area = area
        self.library = library
        self.routes = Routes.of(state.server)  #: The files that the page may fetch.
        self.controllers: list[Controller] = []  #: All, in the order in which they were made.
        self.field_changed = Signal()  #: Signal after another flow is shown.
        area.failed.connect(self.complain)

    def complain(self, problem: object, controls: Mapping[str, str] | None = None) -> None:
        """Show an error on the page, with ``controls`` that it has for arguments."""
        text = error_for_page(str(problem), FLAGS, controls or {})
        self.state.send(problem=shortened(text))

    def show(self, field: FlowField, **keep: bool) -> None:
        """Show another flow; :meth:`Viewport.show` has the parameters."""
        playing = self.area.player.playing
        self.area.show(field, **keep)
        self.field_changed.emit()
        self.area.player.playing = playing


class Controller:
    """Base of the controllers of one group of controls: sets their state, and follows it."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.state = context.state
        self.area = context.area
        self.stream = context.area.stream
        self.viewport = context.area.viewport
        context.controllers.append(self)

    @property
    def settings(self) -> Settings:
        """Every setting, live."""
        return self.area.settings

    def describe(self) -> State:
        """Return a part of the page's state, named as in :mod:`.serialization`."""
        return {}

    def restore(self, saved: State) -> None:
        """Take over the part of a saved state that belongs to this controller."""

    def close(self) -> None:
        """End running tasks."""


@dataclass(eq=False)
class LoadRequest:
    """Request to open a flow, after which ``then`` is called."""

    name: str
    choice: Choice
    then: Callable[[], None] | None = None
    cancelled: bool = False  #: Whether its result is not to be shown.

    @property
    def is_link(self) -> bool:
        """Whether it is followed by the rest of a link's state."""
        return self.then is not None


@dataclass(frozen=True, eq=False)
class LoadedFlow:
    """A flow that was read, with the traces of its first picture."""

    name: str
    choice: Choice
    source: FlowSource  #: Kept here, because the library may drop it and it is slow to read again.
    field: FlowField
    traced: TracedFlow | None = None


class FlowOpener(Controller):
    """Base of controllers that open flows in a thread: the latest one that is requested."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.library = context.library
        self._request: LoadRequest | None = None
        self._opening: asyncio.Task[None] | None = None
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="flowtex opening")

    @property
    def is_opening(self) -> bool:
        """Whether a flow is being opened."""
        return self._opening is not None and not self._opening.done()

    def _begin(self, request: LoadRequest, *, follows: bool) -> None:
        """Open a flow instead of the one being opened, which may be shown if this one follows.

        While a slider moves, each request follows: without results on the way nothing would be
        seen.
        """
        if self._request is not None:
            self._request.cancelled |= not follows
        self._request = request
        self._opening = asyncio.ensure_future(self._announced(request))

    async def _open(self, request: LoadRequest) -> None:
        raise NotImplementedError

    def _fail(self) -> None:
        raise NotImplementedError

    def _controls_for(self, request: LoadRequest) -> Mapping[str, str]:
        """Return the controls by which another part of a requested flow can be chosen."""
        return {}

    def _is_latest(self, request: LoadRequest) -> bool:
        return request is self._request and not request.cancelled

    async def _announced(self, request: LoadRequest) -> None:
        """Open a flow, with its progress on the page, or the reason why it fails."""
        name = shortened(request.name, NAME_LENGTH)
        problem = ""

        async def show_busy() -> None:
            await asyncio.sleep(BUSY_DELAY_S)
            if self._is_latest(request):
                self.state.send(busy=f"Opening {name}")

        announcement = asyncio.create_task(show_busy())
        try:
            await self._open(request)
        except Stopped:
            pass
        except (FieldError, OSError) as error:
            problem = without_folder(str(error), request.name) or type(error).__name__
        except Exception as error:
            _log.exception("%s could not be opened", name)
            problem = f"{name} could not be opened: {str(error) or type(error).__name__}"
        finally:
            announcement.cancel()
            if self._is_latest(request):
                self.state.send(busy="")
        if problem and self._is_latest(request):
            self.context.complain(problem, self._controls_for(request))
            self._fail()

    async def _read(
        self, request: LoadRequest, time: Callable[[FlowField], float], *, nearest: bool = False
    ) -> LoadedFlow:
        """Read a flow, and trace it at a time, in a thread; ``Stopped`` if it is cancelled.

        Work that has begun is finished even if another flow was requested.
        """

        def read() -> LoadedFlow:
            if not self._is_latest(request):
                raise Stopped
            with stoppable(lambda: request.cancelled):
                choice = self.library.complete(request.name, request.choice, nearest=nearest)
                source = self.library.source(request.name)
                field = self.library.field(request.name, choice)
                traced = TracedFlow.of(field, self.settings)
                for step in sorted(set(steps_around(field.times, time(field))[:2])):
                    traced.store.at(step)
                return LoadedFlow(request.name, choice, source, field, traced.keep())

        flow = await asyncio.get_running_loop().run_in_executor(self._worker, read)
        if request.cancelled:
            raise Stopped
        return flow

    def close(self) -> None:
        """End running tasks."""
        if self._request is not None:
            self._request.cancelled = True
        if self._opening is not None:
            self._opening.cancel()
        self._worker.shutdown(wait=False, cancel_futures=True)


def without_folder(problem: str, name: str) -> str:
    """Return a message without the folder of the file, which is private to the server."""
    last = name.rsplit("/", 1)[-1]
    start = problem.find(f"/{last}:")
    if start >= 0 and ":" not in problem[:start]:
        return problem[start + 1 :]
    # Messages about several files name the first.
    path, colon, rest = problem.partition(": ")
    if Path(path).is_absolute():
        return f"{Path(path).name}{colon}{rest}"
    return problem
