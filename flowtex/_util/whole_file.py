"""Files that are written as a whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

__all__ = ["WholeFile", "whole_file"]


class WholeFile:
    """A temporary file that replaces another, ``path``, once it is complete.

    The temporary file, ``part``, ends as ``path`` does and is empty to begin with. An OSError says
    that there is no such folder, or no right to write there.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        handle, name = tempfile.mkstemp(
            dir=path.parent, prefix=f".{path.stem}.", suffix=f".part{path.suffix}"
        )
        os.close(handle)
        self.part = Path(name)

    def keep(self) -> None:
        """Replace the file by the temporary one."""
        # Temporary files are readable by their owner alone; this one gets the rights of any file.
        mask = os.umask(0)
        os.umask(mask)
        self.part.chmod(0o666 & ~mask)
        self.part.replace(self._path)

    def drop(self) -> None:
        """Delete the temporary file, if :meth:`keep` was not called."""
        with suppress(OSError):
            self.part.unlink()


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yield the path of a :class:`WholeFile`, which is deleted after an error."""
    file = WholeFile(path)
    try:
        yield file.part
        file.keep()
    finally:
        file.drop()
