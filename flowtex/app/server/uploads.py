"""Files that a page sends, to be opened by itself alone.

Only formats are taken that lie in one file: others name further files, and would open any that the
server can read. A name serves to be shown, and for its ending; where the file lies is decided here.
"""

from __future__ import annotations

import shutil
from collections.abc import AsyncIterable, Callable
from pathlib import Path

from flowtex._util.temporary import TemporaryFolder
from flowtex.app.server.files import Routes, plain_name
from flowtex.errors import FieldError

__all__ = ["UPLOAD_SUFFIXES", "Uploads"]

#: Endings of files that are taken.
UPLOAD_SUFFIXES = (
    *(".vts", ".vtr", ".vti", ".vtk", ".vtu", ".vtp"),
    *(".nc", ".grib", ".grb", ".json"),
)
#: Bytes of a file, and files of a page, at most.
UPLOAD_BYTES, MOST_UPLOADS = 200_000_000, 8


class Uploads:
    """The files that one page has sent, in a folder that goes with it.

    Parameters
    ----------
    routes
        Where they are taken.
    arrived
        Called with the name and the path of each.
    """

    def __init__(self, routes: Routes, arrived: Callable[[str, Path], None]) -> None:
        self._arrived = arrived
        self._count = 0
        self._folder = TemporaryFolder()
        self.folder = self._folder.path
        self.address = routes.take("upload", self.receive)

    async def receive(self, name: str, content: AsyncIterable[bytes]) -> None:
        """Write a file, and tell of it.

        Raises
        ------
        FieldError
            When it is not of a format that is taken, too large, or one too many.
        """
        name = plain_name(name.replace("\\", "/").rsplit("/", 1)[-1])
        if Path(name).suffix.lower() not in UPLOAD_SUFFIXES:
            endings = ", ".join(UPLOAD_SUFFIXES)
            msg = f"{name}: expected one file of a mesh or of the Earth, {endings}"
            raise FieldError(msg)
        if self._count >= MOST_UPLOADS:
            msg = f"{name}: {MOST_UPLOADS} files were sent already; open the page anew for more"
            raise FieldError(msg)
        self._count += 1
        path = self._folder.new_folder() / name
        try:
            await self._write(path, content)
        except BaseException:
            self._count -= 1
            shutil.rmtree(path.parent, ignore_errors=True)
            raise
        self._arrived(name, path)

    async def _write(self, path: Path, content: AsyncIterable[bytes]) -> None:
        size = 0
        with path.open("wb") as file:
            async for part in content:
                size += len(part)
                if size > UPLOAD_BYTES:
                    msg = f"{path.name}: expected {UPLOAD_BYTES / 1e6:g} MB at most"
                    raise FieldError(msg)
                file.write(part)

    def close(self) -> None:
        """Remove all files."""
        self._folder.close()
