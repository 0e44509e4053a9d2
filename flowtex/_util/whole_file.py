"""Files for users, which replace the old ones once they are complete, and temporary folders.

All code that writes a file for a user writes it here. The new file lies beside the old one until it
is complete and on the disk. A process locks its temporary folders, and the system unlocks them when
the process ends. The next process that needs a folder removes unlocked ones. Windows has no such
locks.
"""

from __future__ import annotations

import errno
import io
import os
import re
import secrets
import shutil
import stat
import tempfile
import weakref
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import IO

from flowtex._util.arguments import checked_path

try:
    import fcntl
except ModuleNotFoundError:  # Windows
    fcntl = None  # type: ignore[assignment]

NAME = re.compile(r"flowtex-\w{8}\.tmp")  #: Names of temporary folders.
STEM_LENGTH = 40  #: Greatest length of the file's name in the name of its part.


def remove_stale_folders() -> None:
    """Remove temporary folders of this user that no process has locked."""
    if fcntl is None:
        return
    for path in Path(tempfile.gettempdir()).iterdir():
        with suppress(OSError):  # in use, of another user, or removed by another process
            if not NAME.fullmatch(path.name) or path.lstat().st_uid != os.getuid():
                continue
            descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(path)
            finally:
                os.close(descriptor)


class TemporaryFolder:
    """A private folder, removed by :meth:`close` or with this object; it removes stale ones."""

    def __init__(self) -> None:
        remove_stale_folders()
        new = Path(tempfile.mkdtemp(prefix="flowtex-new-"))
        self.path = new.with_name(f"flowtex-{secrets.token_hex(4)}.tmp")
        descriptor = -1
        if fcntl is not None:
            descriptor = os.open(new, os.O_RDONLY)
            with suppress(OSError):  # a file system without locks, where nothing is taken for stale
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        new.rename(self.path)  # locked before another process can take it for stale
        self._end = weakref.finalize(self, _remove_folder, self.path, descriptor, os.getpid())
        _folders.add(self)

    def new_folder(self) -> Path:
        """Make a folder in it, under a new name."""
        return Path(tempfile.mkdtemp(dir=self.path))

    def close(self) -> None:
        """Remove the folder and its content."""
        self._end()


_folders: weakref.WeakSet[TemporaryFolder] = weakref.WeakSet()


def remove_folders() -> None:
    """Remove all temporary folders of this process, which is about to end without a clean-up."""
    for folder in list(_folders):
        folder.close()


def _remove_folder(path: Path, descriptor: int, owner: int) -> None:
    if os.getpid() != owner:  # a fork of the owner
        return
    shutil.rmtree(path, ignore_errors=True)
    if descriptor >= 0:
        os.close(descriptor)


class WholeFile:
    """A new file that replaces ``path`` once it is complete.

    A symbolic link is followed, and mode and owner are kept. ``part`` is the path of the new file,
    for libraries that open files by name; ``file`` is that file, empty and open for reading and
    writing. Raises an OSError when ``path`` is not a regular file or cannot be written.
    """

    def __init__(self, path: str | Path) -> None:
        self._target = target = Path(os.path.realpath(checked_path("path", path)))
        old = _old_file(target)
        name = f".{target.stem[:STEM_LENGTH]}.{secrets.token_hex(4)}.part{target.suffix}"
        self.part = target.with_name(name)
        # Before the file exists: a signal may come between any two lines.
        opened: list[io.FileIO] = []
        self._end = weakref.finalize(self, _remove, self.part, opened, os.getpid())
        # The system applies the umask to the mode.
        opener = partial(os.open, mode=0o666 if old is None else 0o600)
        try:
            self._raw = io.FileIO(str(self.part), "x+", opener=opener)
        except OSError as error:
            error.filename = str(path)
            raise
        opened.append(self._raw)
        if old is not None:
            with suppress(OSError, AttributeError):  # without the right to, and on Windows
                os.chown(self.part, old.st_uid, old.st_gid)
            self.part.chmod(stat.S_IMODE(old.st_mode) & 0o777)
        self.file: IO[bytes] = _File(self._raw)

    def keep(self) -> None:
        """Replace the old file by the new one."""
        self.file.flush()
        os.fsync(self._raw.fileno())
        if os.name == "nt":  # Windows does not move a file that is open
            self.file.close()
        self.part.replace(self._target)
        self._end.detach()
        self.file.close()

    def drop(self) -> None:
        """Remove the new file; after :meth:`keep` this does nothing."""
        self._end()


class _File(io.BufferedRandom):
    """A file without a descriptor, to which Pillow would write without noticing a short write."""

    def fileno(self) -> int:
        raise io.UnsupportedOperation


@contextmanager
def whole_file(path: str | Path) -> Iterator[IO[bytes]]:
    """Open a :class:`WholeFile` for writing; it replaces ``path`` unless an error is raised."""
    new = WholeFile(path)
    try:
        yield new.file
        new.keep()
    finally:
        new.drop()


def _old_file(target: Path) -> os.stat_result | None:
    """Return the status of the file to replace; refuse a file that must not be replaced."""
    try:
        old = target.stat()
    except FileNotFoundError:
        return None
    if stat.S_ISDIR(old.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(target))
    if not stat.S_ISREG(old.st_mode):
        raise OSError(errno.EINVAL, "not a regular file", str(target))
    if not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(target))
    return old


def _remove(part: Path, opened: list[io.FileIO], owner: int) -> None:
    if os.getpid() != owner:  # a fork of the owner
        return
    for raw in opened:
        raw.close()  # without what is buffered
    with suppress(OSError):
        part.unlink()
