"""Files that are there whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

__all__ = ["WholeFile", "whole_file"]


class WholeFile:
    """A temporary file beside another, whose place it takes when it is whole.

    Parameters
    ----------
    path
        File that there shall be.

    Attributes
    ----------
    part
        The temporary file, which ends as ``path`` does and is empty to begin with.

    Raises
    ------
    OSError
        When there is no such folder, or no right to write there.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        handle, name = tempfile.mkstemp(
            dir=path.parent, prefix=f".{path.stem}.", suffix=f".part{path.suffix}"
        )
        os.close(handle)
        self.part = Path(name)

    def keep(self) -> None:
        """Put the temporary file in its place."""
        # It is for its owner alone so far; here it gets the rights of any new file.
        mask = os.umask(0)
        os.umask(mask)
        self.part.chmod(0o666 & ~mask)
        self.part.replace(self._path)

    def drop(self) -> None:
        """Leave nothing behind; after :meth:`keep` there is nothing to do."""
        with suppress(OSError):
            self.part.unlink()


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Give the temporary file of a :class:`WholeFile`; after an error nothing is left of it."""
    file = WholeFile(path)
    try:
        yield file.part
        file.keep()
    finally:
        file.drop()
