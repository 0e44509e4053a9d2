"""Opening flows in a thread: requests, and their progress on the page."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Callable
from concurrent.futures import Executor
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from flowtex._util.progress import Stopped, stoppable
from flowtex.app.controllers.context import Context
from flowtex.app.controllers.library import Choice
from flowtex.app.server.validation import shortened
from flowtex.errors import FieldError

_log = logging.getLogger(__name__)

T = TypeVar("T")

#: Seconds after which the page says that something is being opened.
BUSY_DELAY_S = 0.3
#: Characters of a name in a message.
NAME_LENGTH = 80


@dataclass(eq=False)
class LoadRequest:
    """Request to open a flow, after which ``then`` is called."""

    name: str
    choice: Choice
    then: Callable[[], None] | None = None
    cancelled: bool = False  #: Whether its result is not to be shown.
    #: Whether another flow was requested since, as always while a slider moves. Results of quick
    #: work are shown nevertheless, or nothing would be seen on the way.
    superseded: bool = False

    @property
    def over(self) -> bool:
        """Whether it is not the latest request."""
        return self.cancelled or self.superseded

    async def in_thread(self, worker: Executor, work: Callable[[], T], *, quick: bool) -> T:
        """Do work for it in a thread; raises ``Stopped`` if the result is no longer wanted.

        Quick work that has begun is finished even if another flow was requested.
        """

        def unwanted() -> bool:
            return self.cancelled if quick else self.over

        def guarded() -> T:
            if self.over:
                raise Stopped
            with stoppable(unwanted):
                return work()

        result = await asyncio.get_running_loop().run_in_executor(worker, guarded)
        if unwanted():
            raise Stopped
        return result


@asynccontextmanager
async def announced(
    context: Context, request: LoadRequest, fail: Callable[[], None]
) -> AsyncIterator[None]:
    """Show progress on the page; if opening fails, show the reason and call ``fail``."""
    announcement = asyncio.create_task(_show_busy(context, request))
    name, problem = shortened(request.name, NAME_LENGTH), ""
    try:
        yield
    except Stopped:
        pass
    except (FieldError, OSError) as error:
        problem = without_folder(str(error), request.name) or type(error).__name__
    except Exception as error:
        _log.exception("%s could not be opened", name)
        problem = f"{name} could not be opened: {str(error) or type(error).__name__}"
    finally:
        announcement.cancel()
        if not request.over:
            context.state.send(busy="")
    if problem and not request.over:
        context.complain(problem)
        fail()


async def _show_busy(context: Context, request: LoadRequest) -> None:
    """Show the name of the flow being opened, after a short delay."""
    await asyncio.sleep(BUSY_DELAY_S)
    if not request.over:
        context.state.send(busy=f"Opening {shortened(request.name, NAME_LENGTH)}")


def without_folder(problem: str, name: str) -> str:
    """Return a message without the folder of the file, which is private to the server."""
    last = name.rsplit("/", 1)[-1]
    start = problem.find(f"/{last}:")
    if start >= 0 and ":" not in problem[:start]:
        return problem[start + 1 :]
    # Messages about several files name the first.
    path, colon, rest = problem.partition(": ")
    return f"{Path(path).name}{colon}{rest}" if Path(path).is_absolute() else problem
