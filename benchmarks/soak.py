"""An hour of use in a minute: ``python benchmarks/soak.py``.

The program runs by itself and is used through its own connection, as a page would: what the page
sends for a drag, a turn of the wheel, a move of the pointer, a setting or the button that plays.
How much memory, how many threads and processes it has more afterwards is printed.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import signal
import sys
from pathlib import Path
from typing import Any

import aiohttp
from rich.console import Console
from rich.table import Table

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))

from served import Link, Served, enter, start

WIDE, HIGH = 160, 120
#: Interactions before memory is first looked at: by then every kind of noise has been shown once.
WARM = 300


class User:
    """Somebody who uses a page, always in the same way."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self._view = link.key("picture").replace("picture", "view")
        self._chance = random.Random(20061205)
        self._playing = False

    async def sit_down(self) -> None:
        """Open the page and wait for the first full picture."""
        size = {"w": WIDE, "h": HIGH, "p": 1}
        await self._link.call("trame.rca.size", self._view, "soak", size)
        await self.rest()

    async def rest(self) -> None:
        """Do nothing until the full picture is there."""
        await self._link.until(
            lambda: self._link.pictures > 0 and self._link.get("picture") == "sharp"
        )

    async def act(self) -> None:
        """Do one thing."""
        choices = (self._drag, self._drag, self._wheel, self._wheel, self._hover)
        await self._chance.choice((*choices, self._setting, self._setting, self._play))()

    async def stop(self) -> None:
        """Play no more, and wait for the picture at rest."""
        await self._link.set(playing=False)
        await self._link.call("trame.rca.event", self._view, "soak", self._at("MouseMove"))
        await self.rest()

    def _at(self, kind: str, **more: Any) -> dict[str, Any]:
        x, y = self._chance.randrange(WIDE), self._chance.randrange(HIGH)
        return {"type": kind, "w": WIDE, "h": HIGH, "x": x, "y": y, **more}

    async def _send(self, *kinds: str, **more: Any) -> None:
        for kind in kinds:
            event = self._at(kind, **more)
            await self._link.call("trame.rca.event", self._view, "soak", event)

    async def _drag(self) -> None:
        await self._send("LeftButtonPress", "MouseMove", "MouseMove", "LeftButtonRelease")

    async def _wheel(self) -> None:
        # As often out as in: nobody zooms into a billionth of a cell.
        turn = self._chance.choice((-1.0, 1.0))
        await self._send("StartMouseWheel", "MouseWheel", "EndMouseWheel", spinY=turn)

    async def _hover(self) -> None:
        await self._send("MouseMove", "MouseMove")

    async def _setting(self) -> None:
        name, values = self._chance.choice(
            (
                ("contrast", (0.5, 1.0, 2.0)),
                ("samples", (5, 9, 13)),
                ("lod", (True, False)),
                ("kernel", ("box", "hann")),
                ("noise", ("procedural", "texture", "spots", "checkerboard")),
            )
        )
        present = self._link.get(f"set_{name}")
        wanted = self._chance.choice([value for value in values if value != present])
        await self._link.set(**{f"set_{name}": wanted})

    async def _play(self) -> None:
        self._playing = not self._playing
        await self._link.set(playing=self._playing)


def memory(process: int) -> int:
    """Bytes that a process holds in memory."""
    pages = int(Path(f"/proc/{process}/statm").read_text(encoding="utf-8").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def threads(process: int) -> int:
    """Return the number of threads of a process."""
    return len(list(Path(f"/proc/{process}/task").iterdir()))


def children(process: int) -> list[str]:
    """Return the processes that a process has started."""
    found = Path(f"/proc/{process}/task/{process}/children").read_text(encoding="utf-8")
    return found.split()


async def use(served: Served, count: int) -> tuple[int, int]:
    """Use a page, and return the growth of memory and of the number of threads."""
    process = served.process.pid
    async with aiohttp.ClientSession() as http:
        status, said = await enter(http, served.bare, served.secret)
        if status != 200:
            raise SystemExit(str(said))
        link = await Link.open(http, served.bare, said["session"], served.secret)
        user = User(link)
        await user.sit_down()
        for _ in range(WARM):
            await user.act()
        await user.stop()
        before = memory(process), threads(process)
        for _ in range(count):
            await user.act()
        await user.stop()
        if link.get("problem"):
            raise SystemExit(link.get("problem"))
        after = memory(process), threads(process)
        await link.close()
    return after[0] - before[0], after[1] - before[1]


def main() -> None:
    """Use a page, and print what is left of that."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=600, help="of interactions")
    given = parser.parse_args()
    served = start("demo", "--example", "double_gyre", "--samples", "9")
    try:
        grown, more = asyncio.run(use(served, given.count))
        left = children(served.process.pid)
    finally:
        said = served.end(signal.SIGTERM)
    table = Table("interactions", "memory", "threads", "processes", "end", title="Use of one page")
    end = f"{served.process.returncode}{', with a traceback' * ('Traceback' in said)}"
    table.add_row(str(given.count), f"{grown / 1e6:+.1f} MB", f"{more:+d}", str(len(left)), end)
    Console().print(table)


if __name__ == "__main__":
    main()
