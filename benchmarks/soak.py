"""An hour of use in a minute: ``python benchmarks/soak.py``.

The program runs by itself and is used through its own connection, as a page would: what the page
sends for a drag, a turn of the wheel, a point that is read, a setting or the button that plays.
How much memory, how many threads and processes it has more afterwards is printed.
"""

from __future__ import annotations

import argparse
import asyncio
import random
import re
import signal
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

import aiohttp
from rich.console import Console
from rich.table import Table

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))

from served import Link, Served, enter, start

WIDE, HIGH = 160, 120
#: The view in the text of the page, and what it calls by which name.
ELEMENT = re.compile(r"<flowtex-client [^/]*/>")
TRIGGER = re.compile(r"@?(\w+)=\"(?:trigger\(')?(trigger__\d+)")
#: Interactions before memory is first looked at: by then every kind of noise has been shown once.
WARM = 300


class User:
    """Somebody who uses a page, always in the same way."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self._view = link.key("painter").replace("painter", "view")
        # The names under which the page's view calls the server.
        texts = (value for value in link.state.values() if isinstance(value, str))
        element = next(found[0] for text in texts if (found := ELEMENT.search(text)))
        self._triggers = dict(TRIGGER.findall(element))
        self._chance = random.Random(20061205)
        self._playing = False
        self._settings: dict[str, Any] = {}
        self._camera: dict[str, Any] = {}

    async def sit_down(self) -> None:
        """Open the page and wait for the first full picture."""
        begun = await self._call("begin", "server")
        self._settings = begun["settings"]
        geometry = begun["scenes"][0]["header"]["geometry"]
        x, y, z = geometry["center"]
        away = geometry["extent"]
        self._camera = {"position": [x, y, z + away], "focal_point": [x, y, z], "up": [0, 1, 0]}
        self._camera |= {"parallel": True, "parallel_scale": away / 4, "view_angle": 30.0}
        size = {"w": WIDE, "h": HIGH, "p": 1}
        await self._link.call("trame.rca.size", self._view, "soak", size)
        await self.rest()

    async def rest(self) -> None:
        """Do nothing until the full picture is there."""
        await self._link.until(lambda: self._link.sharp)

    async def act(self) -> None:
        """Do one thing."""
        choices = (self._drag, self._drag, self._wheel, self._wheel, self._read)
        await self._chance.choice((*choices, self._setting, self._setting, self._play))()

    async def stop(self) -> None:
        """Play no more, and wait for the picture at rest."""
        await self._call("playing", 0, "soak")
        await self.rest()

    async def _call(self, name: str, *values: Any) -> Any:
        return await self._link.call("trame.trigger", self._triggers[name], list(values), {})

    async def _drag(self) -> None:
        for _ in range(2):
            move = self._chance.uniform(-0.1, 0.1) * self._camera["parallel_scale"]
            for point in ("position", "focal_point"):
                x, y, z = self._camera[point]
                self._camera[point] = [x + move, y, z]
            await self._call("camera", self._camera, "soak")

    async def _wheel(self) -> None:
        # As often out as in: nobody zooms into a billionth of a cell.
        self._camera["parallel_scale"] *= 1.25 ** self._chance.choice((-1, 1))
        await self._call("camera", self._camera, "soak")

    async def _read(self) -> None:
        place = [self._chance.uniform(-1, 1) for _ in range(2)]
        await self._call("read", 0, {"place": place, "path": self._chance.random() < 0.5})

    async def _setting(self) -> None:
        name, values = self._chance.choice(
            (
                ("contrast", (0.5, 1.0, 2.0)),
                ("samples", (5, 9, 13)),
                ("lod", (True, False)),
                ("kernel", ("box", "hann")),
                ("parameter", ("arclength", "time")),
            )
        )
        present = self._settings[name]
        wanted = self._chance.choice([value for value in values if value != present])
        self._settings[name] = wanted
        await self._call("setting", [name, wanted], "soak")

    async def _play(self) -> None:
        self._playing = not self._playing
        await self._call("playing", self._playing, "soak")


def memory(process: int) -> int:
    """Bytes that a process holds in memory; of what it shares, its part."""
    with suppress(OSError):
        text = Path(f"/proc/{process}/smaps_rollup").read_text(encoding="utf-8")
        return 1024 * int(text.partition("\nPss:")[2].split()[0])
    return 0


def threads(process: int) -> int:
    """Return the number of threads of a process."""
    with suppress(OSError):
        return len(list(Path(f"/proc/{process}/task").iterdir()))
    return 0


def children(process: int) -> list[int]:
    """Return the processes that a process has started."""
    found: list[int] = []
    for tasks in Path(f"/proc/{process}/task").glob("*/children"):
        with suppress(OSError):
            found += map(int, tasks.read_text(encoding="utf-8").split())
    return found


def descendants(process: int) -> list[int]:
    """Return the processes that a process has started, those that they started, and so on."""
    return [one for child in children(process) for one in (child, *descendants(child))]


def taken(process: int) -> tuple[int, int, int]:
    """Return memory, threads and the number of a process and of those that it started."""
    family = [process, *descendants(process)]
    return sum(map(memory, family)), sum(map(threads, family)), len(family)


async def use(served: Served, count: int) -> list[int]:
    """Use a page, and return how much more memory, threads and processes there are then."""
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
        before = taken(process)
        for _ in range(count):
            await user.act()
        await user.stop()
        if link.get("problem"):
            raise SystemExit(link.get("problem"))
        after = taken(process)
        await link.close()
    return [new - old for new, old in zip(after, before, strict=True)]


def main() -> None:
    """Use a page, and print what is left of that."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=600, help="of interactions")
    given = parser.parse_args()
    served = start("demo", "--example", "double_gyre", "--samples", "9")
    try:
        grown, more, processes = asyncio.run(use(served, given.count))
    finally:
        said = served.end(signal.SIGTERM)
    table = Table("interactions", "memory", "threads", "processes", "end", title="Use of one page")
    end = f"{served.process.returncode}{', with a traceback' * ('Traceback' in said)}"
    table.add_row(str(given.count), f"{grown / 1e6:+.1f} MB", f"{more:+d}", f"{processes:+d}", end)
    Console().print(table)


if __name__ == "__main__":
    main()
