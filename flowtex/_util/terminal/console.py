"""Output to a terminal, in which names and attributes of data are plain text."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, Any

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
