"""The terminal: output in which names of data are plain text, and signals that end the program."""

from __future__ import annotations

import os
import re
import signal
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from types import FrameType
from typing import TYPE_CHECKING, Any

from flowtex._util.command import note_end

if TYPE_CHECKING:
    from rich.console import Console
    from rich.segment import Segment
    from rich.text import Text

#: Characters that move the cursor, colour, ring, or turn the direction of writing, and halves of
#: characters; a line may end, and have tabs.
_CONTROLS = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]"
)


def plain_text(text: str) -> str:
    r"""Return a text with control characters as Python writes them, such as ``\x1b``."""
    return _CONTROLS.sub(lambda match: ascii(match.group())[1:-1], text)


def terminal(*, stderr: bool = False) -> Console:
    """Return rich's console on stdout or stderr, for which no text is mark-up."""
    return _console_class()(stderr=stderr, markup=False, emoji=False, highlight=False)


@cache
def _console_class() -> type[Console]:
    from rich.console import Console
    from rich.segment import Segment

    class PlainConsole(Console):
        """A console that removes control characters, also inside of tables and bars."""

        def render_str(self, text: str, **options: Any) -> Text:
            return super().render_str(plain_text(text), **options)

        def render(self, *arguments: Any, **options: Any) -> Iterator[Segment]:
            for segment in super().render(*arguments, **options):
                if segment.control:
                    yield segment
                else:
                    yield Segment(plain_text(segment.text), segment.style)

    return PlainConsole


#: Windows has no SIGHUP.
SIGNALS = tuple(s for s in signal.Signals if s.name in ("SIGTERM", "SIGHUP"))


class Ended(SystemExit):
    """A signal has asked the program to end; uncaught, it ends with the code of that signal."""

    code: int

    def __init__(self, number: int) -> None:
        super().__init__(128 + number)


def announce_end(number: int) -> None:
    """Print the name of a signal at once: VTK exits where its error passes through.

    Whoever presses Ctrl-C knows.
    """
    if number == signal.SIGINT:
        return
    with suppress(OSError):  # the terminal may be gone
        os.write(2, f"flowtex: ended by {signal.Signals(number).name}\n".encode())


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Raise :class:`Ended` on the first signal, also after Ctrl-C.

    Where a KeyboardInterrupt passes through a callback of VTK, the program ends with the code 1;
    where this error does, with the code of the signal.

    So incomplete files and temporary folders are removed. A later signal does not interrupt the
    end. If a callback of a library swallowed the error, a later signal raises it again. A signal
    that the program ignores, as under nohup, is still ignored.
    """
    received: list[int] = []
    # Python tests the folder once with a file, which a signal in between would leave there.
    tempfile.gettempdir()

    def end(number: int, frame: FrameType | None) -> None:
        if not received:
            received.append(number)
            announce_end(number)
            note_end(128 + number, frame)
        elif _is_handled(Ended, sys.exception()):
            return
        raise Ended(received[0])

    before = {}
    if threading.current_thread() is threading.main_thread():
        for signum in (signal.SIGINT, *SIGNALS):
            handler = signal.getsignal(signum)
            if handler not in (signal.SIG_IGN, None):
                before[signum] = handler
    for signum in before:
        signal.signal(signum, end)
    try:
        yield
    except Exception as error:
        if not received:
            raise
        raise Ended(received[0]) from error  # such as a terminal that cannot be written to
    finally:
        for signum, handler in before.items():
            signal.signal(signum, handler)


@contextmanager
def usual_interrupts() -> Iterator[None]:
    """Let Ctrl-C raise a KeyboardInterrupt inside a ``with`` block.

    Only with this handler of Python's own does ``asyncio.run`` cancel its task on Ctrl-C. Ctrl-C
    stays ignored where it is, as in a background job.
    """
    before = signal.getsignal(signal.SIGINT)
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or before in (signal.SIG_IGN, None):
        yield
        return
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _is_handled(kind: type[BaseException], error: BaseException | None) -> bool:
    """Return whether an error, or one during whose handling it was raised, is of a kind."""
    while error is not None and not isinstance(error, kind):
        error = error.__context__
    return error is not None
