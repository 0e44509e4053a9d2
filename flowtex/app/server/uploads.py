"""Files that a page uploads, for itself alone.

Only formats of a single file are accepted: others refer to further files, and could open any that
the server can read. The name is used for display and for its ending; the path is chosen here.
"""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import AsyncIterable, Callable
from pathlib import Path

from flowtex._util.temporary import TemporaryFolder
from flowtex.app.server.files import Routes, plain_name
from flowtex.errors import FieldError
from flowtex.sources.remote import prepare_readers

#: Endings of files that are accepted.
UPLOAD_SUFFIXES = (
    *(".vts", ".vtr", ".vti", ".vtk", ".vtu", ".vtp"),
    *(".nc", ".grib", ".grb", ".json"),
)
#: Bytes of a file, and files of a page, at most.
UPLOAD_BYTES, MOST_UPLOADS = 200_000_000, 8


class Uploads:
    """The files that one page has uploaded, in a folder that is removed with it.

    ``arrived`` is called with the name and the path of each.
    """

    def __init__(self, routes: Routes, arrived: Callable[[str, Path], None]) -> None:
        self._arrived = arrived
        self._folder = TemporaryFolder()
        self.folder = self._folder.path
        self.address = routes.take("upload", self.receive)

    async def receive(self, name: str, content: AsyncIterable[bytes]) -> None:
        """Write a file, and report it.

        Raises a FieldError when its format is not accepted, it is too large, or there are too many.
        """
        name = plain_name(name.replace("\\", "/").rsplit("/", 1)[-1])
        if Path(name).suffix.lower() not in UPLOAD_SUFFIXES:
            endings = ", ".join(UPLOAD_SUFFIXES)
            msg = f"{name}: this format cannot be uploaded; expected one of {endings}"
            raise FieldError(msg)
        if len(list(self.folder.glob("*"))) >= MOST_UPLOADS:
            msg = (
                f"{name}: {MOST_UPLOADS} files have been uploaded already; reload the page to "
                "upload more"
            )
            raise FieldError(msg)
        prepare_readers()
        try:
            path = await self._write(name, content)
        except OSError as error:
            msg = f"{name}: cannot be stored on the server ({error.strerror or error})"
            raise FieldError(msg) from error
        self._arrived(name, path)

    async def _write(self, name: str, content: AsyncIterable[bytes]) -> Path:
        """Write a file into its own folder, which is removed after an error."""
        path = self._folder.new_folder() / name
        size = 0
        try:
            with path.open("wb") as file:
                async for part in content:
                    size += len(part)
                    if size > UPLOAD_BYTES:
                        msg = (
                            f"{name}: the file is too large; expected {UPLOAD_BYTES / 1e6:g} MB "
                            "at most"
                        )
                        raise FieldError(msg)
                    await asyncio.to_thread(file.write, part)
        except BaseException:
            shutil.rmtree(path.parent, ignore_errors=True)
            raise
        return path

    def close(self) -> None:
        """Remove all files."""
        self._folder.close()
