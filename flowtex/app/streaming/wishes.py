"""What a page wants to see, and whether that is still so."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TypeVar

from flowtex._util.progress import Stopped, stoppable
from flowtex.app.controllers.library import Choice
from flowtex.field import FlowField
from flowtex.field.source import FlowSource
from flowtex.trace import SliceStore

__all__ = ["Found", "Wish"]

T = TypeVar("T")


@dataclass(eq=False)
class Wish:
    """Something that is to be opened.

    Attributes
    ----------
    name, choice
        What.
    then
        Called once it is shown.
    dropped
        Whether nobody wants to see anything of it any more.
    passed
        Whether something else is wanted by now. While a slider moves there is always something
        else: what is quick to make is shown even so, or nothing would be seen on the way.
    """

    name: str
    choice: Choice
    then: Callable[[], None] | None = None
    dropped: bool = False
    passed: bool = False

    @property
    def over(self) -> bool:
        """Whether it is not what is wanted."""
        return self.dropped or self.passed

    async def in_thread(self, worker: Executor, work: Callable[[], T], *, quick: bool) -> T:
        """Do some work for it off the event loop.

        Parameters
        ----------
        worker
            Where.
        work
            What.
        quick
            Whether it is finished, once it has begun, though something else is wanted by then.

        Raises
        ------
        Stopped
            When it is not wanted any more.
        """

        def unwanted() -> bool:
            return self.dropped if quick else self.over

        def guarded() -> T:
            if self.over:
                raise Stopped
            with stoppable(unwanted):
                return work()

        made = await asyncio.get_running_loop().run_in_executor(worker, guarded)
        if unwanted():
            raise Stopped
        return made


@dataclass(frozen=True, eq=False)
class Found:
    """What was read, and what of it is shown: all its nodes, or few."""

    name: str
    choice: Choice
    source: FlowSource
    field: FlowField
    shown: FlowField
    store: SliceStore | None = None

    @property
    def whole(self) -> bool:
        """Whether all nodes are shown."""
        return self.shown is self.field
