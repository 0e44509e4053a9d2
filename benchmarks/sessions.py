"""What a page more costs a server: ``python benchmarks/sessions.py --pages 12``.

Pages of ``flowtex demo`` are opened one after the other, each its own process where the system
forks. Printed are the seconds from the first request to the connection, and to the first full
picture of VTK's, and the memory that each page adds once it is at rest.
"""

from __future__ import annotations

import argparse
import asyncio
import signal
import statistics
import sys
import time
from pathlib import Path

import aiohttp
from rich.console import Console
from rich.table import Table
from soak import User, taken

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))

from served import Link, Served, enter, start


async def use(served: Served, pages: int) -> list[tuple[float, float, float]]:
    """Open pages; return two times and the bytes that each page added."""
    found: list[tuple[float, float, float]] = []
    links: list[Link] = []
    async with aiohttp.ClientSession() as http:
        for _ in range(pages):
            before, began = taken(served.process.pid)[0], time.perf_counter()
            status, said = await enter(http, served.bare, served.secret)
            if status != 200:
                raise SystemExit(said["words"])
            links.append(await Link.open(http, served.bare, said["session"], served.secret))
            opened = time.perf_counter() - began
            await User(links[-1]).sit_down()
            drawn = time.perf_counter() - began
            found.append((opened, drawn, taken(served.process.pid)[0] - before))
        for link in links:
            await link.close()
    return found


def main() -> None:
    """Open pages, and print what they cost."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pages", type=int, default=12)
    pages = parser.parse_args().pages
    served = start("demo", "--limit", str(pages))
    try:
        found = asyncio.run(use(served, pages))
    finally:
        served.end(signal.SIGTERM)
    table = Table("", "open, s", "first picture, s", "memory, MB", title=f"{pages} pages")
    for name, rows in (("first", found[:1]), ("each other", found[1:])):
        opened, drawn, grown = (statistics.median(column) for column in zip(*rows, strict=True))
        table.add_row(name, f"{opened:.2f}", f"{drawn:.2f}", f"{grown / 1e6:.0f}")
    Console().print(table)


if __name__ == "__main__":
    main()
