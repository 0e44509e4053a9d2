"""Temporary folders, which a process that is killed leaves to the next one to remove.

A file or folder in use is locked by its process, and the system unlocks it when the process ends,
however it ends: what is not locked is stale. Windows has no such locks; there only a process that
ends by itself removes its temporary folders.
"""

from __future__ import annotations

import os
import re
import shutil
import tempfile
import weakref
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

try:
    import fcntl
except ModuleNotFoundError:  # Windows
    fcntl = None  # type: ignore[assignment]

PREFIX, SUFFIX = "flowtex-", ".tmp"
NAME = re.compile(r"flowtex-\w{8}\.tmp")


def claim(descriptor: int, path: Path) -> bool:
    """Lock a new file or folder; return whether it is still at its path."""
    if fcntl is None:
        return True
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:  # another process removes it
        return False
    except OSError:  # a file system without locks, where nothing is taken for stale
        return True
    with suppress(FileNotFoundError):
        return os.path.samestat(os.fstat(descriptor), path.lstat())
    return False


def remove_stale(paths: Iterable[Path], remove: Callable[[Path], object]) -> None:
    """Remove files and folders of this user that no process has locked."""
    if fcntl is None:
        return
    for path in paths:
        with suppress(OSError):  # in use, of another user, or removed by another process
            if path.lstat().st_uid != os.getuid():
                continue
            descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                remove(path)
            finally:
                os.close(descriptor)


def remove_stale_folders() -> None:
    """Remove the temporary folders of processes that were killed."""
    parent = Path(tempfile.gettempdir())
    remove_stale((p for p in parent.iterdir() if NAME.fullmatch(p.name)), shutil.rmtree)


class TemporaryFolder:
    """A private folder, removed by :meth:`close` or with this object; it removes stale ones."""

    def __init__(self) -> None:
        remove_stale_folders()
        descriptor = None
        while descriptor is None:
            self.path = Path(tempfile.mkdtemp(SUFFIX, PREFIX))
            descriptor = _open(self.path)
        self._end = weakref.finalize(self, _remove, self.path, descriptor, os.getpid())
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


def _open(path: Path) -> int | None:
    """Open and lock a new folder; ``None`` when another process took it for stale before."""
    if fcntl is None:
        return -1
    try:
        descriptor = os.open(path, os.O_RDONLY)
    except FileNotFoundError:
        return None
    if claim(descriptor, path):
        return descriptor
    os.close(descriptor)
    return None


def _remove(path: Path, descriptor: int, owner: int) -> None:
    if os.getpid() != owner:  # a fork of the owner
        return
    shutil.rmtree(path, ignore_errors=True)
    if descriptor >= 0:
        os.close(descriptor)
