"""Files that a page may fetch, each under a token that cannot be guessed.

They lie in a temporary folder that its owner alone can read, and go when they have lain for a
while, when they take too much room, when the page closes, and when the program ends.
"""

from __future__ import annotations

import mimetypes
import secrets
import shutil
import tempfile
import time
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

__all__ = ["Download", "Downloads"]

#: Seconds that a file waits to be fetched, and bytes of all files together, at most.
LIFETIME, MOST_BYTES = 1800.0, 2_000_000_000
#: Characters of a name, at most.
LONGEST_NAME = 120


@dataclass(frozen=True)
class Download:
    """A file that a page may fetch.

    Attributes
    ----------
    path
        Where it lies.
    name
        What it is called for who fetches it.
    """

    path: Path
    name: str

    @property
    def headers(self) -> dict[str, str]:
        """Headers of the answer that brings it."""
        kind = mimetypes.guess_type(self.name)[0] or "application/octet-stream"
        return {
            "Content-Type": kind,
            "Content-Disposition": f"attachment; filename*=UTF-8''{quote(self.name, safe='')}",
            "Cache-Control": "no-store",
        }


class Downloads:
    """The files of one page.

    Parameters
    ----------
    lifetime
        Seconds after which a file goes that nobody has asked for.
    clock
        Tells the time in seconds.

    Attributes
    ----------
    folder
        Where the files lie.
    """

    def __init__(
        self, lifetime: float = LIFETIME, clock: Callable[[], float] = time.monotonic
    ) -> None:
        # mkdtemp lets nobody else in.
        self.folder = Path(tempfile.mkdtemp(prefix="flowtex-"))
        self._end = weakref.finalize(self, shutil.rmtree, self.folder, ignore_errors=True)
        self._lifetime, self._clock = lifetime, clock
        self._files: dict[str, tuple[Download, float]] = {}

    def __len__(self) -> int:
        """Count the files that can be fetched."""
        return len(self._files)

    def place(self, name: str) -> Path:
        """Return where a file of this name can be written, in a folder of its own.

        Raises
        ------
        OSError
            When there is no room, or the files have been closed.
        """
        return Path(tempfile.mkdtemp(dir=self.folder)) / _plain(name)

    def add(self, path: Path, name: str) -> str:
        """Give a file out; return its token.

        Parameters
        ----------
        path
            A file in :attr:`folder`, from :meth:`place`.
        name
            What it is called for who fetches it.

        Raises
        ------
        ValueError
            When the file lies elsewhere.
        """
        if not path.resolve().is_relative_to(self.folder.resolve()):
            msg = f"{path} lies outside {self.folder}; expected a file from place()"
            raise ValueError(msg)
        self.expire()
        token = secrets.token_urlsafe(24)
        self._files[token] = (Download(path, _plain(name)), self._clock())
        return token

    def get(self, token: str) -> Download | None:
        """Return the file of a token; ``None`` where there is none, or none any more."""
        self.expire()
        found = self._files.get(token)
        if found is None or not found[0].path.is_file():
            return None
        self._files[token] = (found[0], self._clock())
        return found[0]

    def expire(self) -> None:
        """Remove what has lain too long, and the oldest where all take too much room."""
        limit = self._clock() - self._lifetime
        for token in [t for t, (_, asked) in self._files.items() if asked < limit]:
            self.remove(token)
        sizes = {token: _size(file.path) for token, (file, _) in self._files.items()}
        for token in sorted(sizes, key=lambda t: self._files[t][1])[:-1]:
            if sum(sizes.values()) <= MOST_BYTES:
                break
            self.remove(token)
            del sizes[token]

    def remove(self, token: str) -> None:
        """Remove a file; where there is none of that token there is nothing to do."""
        file, _ = self._files.pop(token, (None, 0.0))
        if file is not None:
            shutil.rmtree(file.path.parent, ignore_errors=True)

    def close(self) -> None:
        """Remove all files; nothing can be added any more."""
        self._files.clear()
        self._end()


def _size(path: Path) -> int:
    return path.stat().st_size if path.is_file() else 0


def _plain(name: str) -> str:
    """Return a name with which no folder can be left, and which every system takes."""
    kept = "".join(c if c.isalnum() or c in " ._-" else "_" for c in name).strip(" .")
    stem, dot, suffix = kept.rpartition(".")
    return f"{stem[:LONGEST_NAME]}{dot}{suffix[:20]}" if stem else (kept[:LONGEST_NAME] or "flow")
