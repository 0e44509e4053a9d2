"""A drill of everything that goes wrong at once: ``python benchmarks/drill.py --minutes 60``.

Thirty people use pages of one server. Meanwhile others send it files that are broken, one a
second, each of which their own page opens; hold hundreds of half-sent requests; fill the disk
for a while; and kill the processes that the server has started. A table tells what became of the
thirty, of memory and of the temporary folder. The status is 1 when one of them lost the page, or
something is left. A disk is filled only where a file system may be mounted, as root.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import aiohttp
from rich.console import Console
from rich.table import Table
from soak import HIGH, WIDE, User, children, descendants, memory, threads

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))
sys.path.append(str(Path(__file__).resolve().parents[1] / "tests" / "hostile"))

from lying_files import grib2, image, legacy, netcdf_header, vtu, winds
from served import Link, Served, enter, start

from flowtex import examples

#: Seconds for any answer of a server that is busy with all this.
PATIENCE_S = 600.0
#: Bytes of the temporary folder, and files that a page may send.
FOLDER_BYTES, FILES_OF_A_PAGE = 256_000_000, 8
#: Half-sent requests that are held, and seconds after which each is given up.
SLOW_CLIENTS, SLOW_S = 700, 60.0
#: Seconds between two acts of a person, between two killed processes, and rows of the table.
ACT_S, KILL_S, ROWS = (2.0, 10.0), 15.0, 6
#: In the command of what reads files, and of the process that it is forked from.
READER = "flowtex.sources.remote"
#: What the table counts.
COUNTED = ("taken", "refused", "killed", "slow")
#: Part of the time after which the disk is full, and for which it is.
FULL_FROM, FULL_FOR = 0.4, 0.1


def broken_files(chance: random.Random) -> Iterator[tuple[str, bytes]]:
    """Yield names and bytes of files: some declare too much, some are cut, in some bytes differ."""
    mesh = examples.double_gyre(0.0)
    whole: dict[str, bytes] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name in ("gyre.vts", "gyre.vtk", "gyre.vtu"):
            path = Path(folder) / name
            (mesh.cast_to_unstructured_grid() if name.endswith("u") else mesh).save(path)
            whole[name] = path.read_bytes()
    lying = {
        **{"a.vtu": vtu(10**12), "b.vti": image("0 9999 0 9999 0 9999")},
        **{"c.vtk": legacy("DIMENSIONS 99999 99999 9"), "d.json": winds(10**6, 10**6)},
        **{"e.nc": netcdf_header(5, 2**60), "f.grib": grib2(2**31 - 1)},
    }
    while True:
        name = chance.choice([*whole, *lying])
        content = bytearray(whole.get(name) or lying[name])
        if name in whole and chance.random() < 0.5:
            del content[chance.randrange(len(content)) :]
        elif name in whole:
            for _ in range(chance.randrange(1, 20)):
                content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
        yield name, bytes(content)


def command(process: int) -> str:
    """Return the command of a process."""
    with contextlib.suppress(OSError):
        return Path(f"/proc/{process}/cmdline").read_text(encoding="utf-8", errors="replace")
    return ""


class Log:
    """What the server writes, read so that it never waits."""

    def __init__(self, served: Served) -> None:
        self.size = self.tracebacks = 0
        self._lines = served.process.stdout
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self) -> None:
        for line in self._lines or ():
            self.size += len(line)
            self.tracebacks += line.startswith("Traceback")


class Drill:
    """All that continues at once, and what is counted of it."""

    def __init__(self, served: Served, seconds: float, folder: Path, *, full: bool) -> None:
        self.served, self.folder, self.full = served, folder, full
        self.seconds = seconds
        self.counts: Counter[str] = Counter()
        self.lost: list[str] = []
        self.pages = 0
        self._began = time.monotonic()
        self._chance = random.Random(20061205)
        self.table = Table(title="The drill")
        for name in ("minute", "pages", "server MB", "others MB", "threads", "folder MB", *COUNTED):
            self.table.add_column(name, justify="right")

    @property
    def over(self) -> bool:
        """Whether the time is up."""
        return time.monotonic() - self._began > self.seconds

    async def run(self, people: int) -> None:
        """Let everything happen until the time is up."""
        async with aiohttp.ClientSession(connector=aiohttp.TCPConnector(limit=0)) as http:
            ready = [asyncio.Event() for _ in range(people)]
            sitting = [asyncio.create_task(self._sit(http, event)) for event in ready]
            await asyncio.gather(*(event.wait() for event in ready))
            self._began = time.monotonic()
            others = [self._send_files(http), self._kill(), self._fill(), self._note()]
            others += [self._be_slow() for _ in range(SLOW_CLIENTS)]
            tasks = [asyncio.create_task(work) for work in others]
            await asyncio.gather(*sitting)
            for task in tasks:
                task.cancel()
            for result in await asyncio.gather(*tasks, return_exceptions=True):
                if isinstance(result, Exception):
                    self.lost.append(f"the drill itself: {result!r}")

    async def _sit(self, http: aiohttp.ClientSession, ready: asyncio.Event) -> None:
        """Use a page until the end."""
        try:
            link = await self._open(http)
            user = User(link)
            await user.sit_down()
            self.pages += 1
            ready.set()
            while not self.over:
                await asyncio.sleep(self._chance.uniform(*ACT_S))
                await user.act()
            await link.call("trame.state.get")
            await link.close()
        except Exception as error:
            self.lost.append(f"{type(error).__name__}: {error}")
            self.pages -= ready.is_set()
            ready.set()

    async def _open(self, http: aiohttp.ClientSession) -> Link:
        status, said = await enter(http, self.served.bare, self.served.secret)
        if status != 200:
            raise ConnectionError(str(said))
        return await Link.open(http, self.served.bare, said["session"], self.served.secret)

    async def _send_files(self, http: aiohttp.ClientSession) -> None:
        """Send broken files, a few from each page."""
        files = broken_files(self._chance)
        while True:
            try:
                link = await self._open(http)
                view = link.key("painter").replace("painter", "view")
                await link.call("trame.rca.size", view, "drill", {"w": WIDE, "h": HIGH, "p": 1})
                for _ in range(FILES_OF_A_PAGE):
                    name, content = next(files)
                    address = f"{self.served.bare}{link.get('upload')}"
                    async with http.post(address, params={"name": name}, data=content) as answer:
                        taken = {200: "taken", 400: "refused"}
                        self.counts[taken.get(answer.status, str(answer.status))] += 1
                    await asyncio.sleep(1)
                await link.close()
            except (aiohttp.ClientError, OSError, RuntimeError, TimeoutError) as error:
                self.counts[f"senders: {type(error).__name__}"] += 1
                await asyncio.sleep(1)

    async def _be_slow(self) -> None:
        """Hold half-sent requests, one after the other."""
        while True:
            await asyncio.sleep(self._chance.uniform(0, SLOW_S))
            with contextlib.suppress(OSError):
                reader, writer = await asyncio.open_connection(*self.served.place)
                self.counts["slow"] += 1
                try:
                    writer.write(b"GET / HTTP/1.1\r\nHost: localhost\r\nX-Slow: ")
                    with contextlib.suppress(TimeoutError):
                        await asyncio.wait_for(reader.read(), SLOW_S)
                finally:
                    writer.close()

    async def _kill(self) -> None:
        """Kill processes that the server has started, but for the sessions."""
        process = self.served.process.pid
        while True:
            await asyncio.sleep(KILL_S)
            found = [child for child in descendants(process) if READER in command(child)]
            # What sessions are forked from is started again, and they live on.
            if found := found + children(process):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(self._chance.choice(found), signal.SIGKILL)
                    self.counts["killed"] += 1

    async def _fill(self) -> None:
        """Fill the disk for a while."""
        if not self.full:
            return
        await asyncio.sleep(FULL_FROM * self.seconds)
        rest = self.folder / "rest"
        with contextlib.suppress(OSError), rest.open("wb", buffering=0) as file:
            while file.write(bytes(1 << 20)):
                await asyncio.sleep(0)
        await asyncio.sleep(FULL_FOR * self.seconds)
        rest.unlink()

    async def _note(self) -> None:
        """Add a row to the table now and then."""
        for row in range(ROWS + 1):
            wait = self._began + row * self.seconds / ROWS - time.monotonic()
            await asyncio.sleep(max(0.0, wait))
            self.note()

    def note(self) -> None:
        """Add a row to the table."""
        process = self.served.process.pid
        others = 0
        for child in descendants(process):
            with contextlib.suppress(OSError):
                others += memory(child)
        figures = (
            *(f"{(time.monotonic() - self._began) / 60:.1f}", f"{self.pages}"),
            *(f"{memory(process) / 1e6:.0f}", f"{others / 1e6:.0f}", f"{threads(process)}"),
            f"{size(self.folder) / 1e6:.1f}",
        )
        self.table.add_row(*figures, *(f"{self.counts[name]:,}" for name in COUNTED))


def size(folder: Path) -> int:
    """Return the bytes of all files of a folder."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


@contextlib.contextmanager
def small_disk() -> Iterator[tuple[Path, bool]]:
    """Make a folder, a file system of its own where that can be; tells whether it is one."""
    folder = Path(tempfile.mkdtemp(prefix="drill-"))
    words = ["mount", "-t", "tmpfs", "-o", f"size={FOLDER_BYTES}", "tmpfs", str(folder)]
    mounted = False
    with contextlib.suppress(OSError):
        mounted = subprocess.run(words, capture_output=True, check=False).returncode == 0
    try:
        yield folder, mounted
    finally:
        if mounted:
            subprocess.run(["umount", "--lazy", str(folder)], check=True)
        shutil.rmtree(folder)


def main() -> int:
    """Hold the drill, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--people", type=int, default=30)
    given = parser.parse_args()
    sys.modules["served"].PATIENCE_S = PATIENCE_S  # type: ignore[attr-defined]
    most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    # The drill has as many connections as all others together; the server keeps to what is usual.
    with small_disk() as (folder, mounted):
        os.environ["TMPDIR"] = str(folder)
        limit = str(given.people + 10)
        served = start("demo", "--example", "double_gyre", "--samples", "9", "--limit", limit)
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
        try:
            log = Log(served)
            drill = Drill(served, 60 * given.minutes, folder, full=mounted)
            asyncio.run(drill.run(given.people))
            drill.note()
        finally:
            served.process.send_signal(signal.SIGTERM)
            status = served.process.wait(PATIENCE_S)
        left = sorted(path.name for path in folder.iterdir())
    console = Console()
    console.print(drill.table)
    console.print(
        f"{'full disk' if mounted else 'no full disk: mounting takes root'}; the server ended with "
        f"{status}, wrote {log.size / 1e3:.1f} kB and {log.tracebacks} tracebacks; pages lost: "
        f"{len(drill.lost)}; left in the temporary folder: {len(left)}"
    )
    others = [f"{name}: {n}" for name, n in drill.counts.items() if name not in COUNTED]
    for fault in [*drill.lost, *left, *others]:
        console.print(fault, markup=False)
    return int(bool(drill.lost or left))


if __name__ == "__main__":
    sys.exit(main())
