"""What the writers of movies share: a file that is there whole or not at all."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from flowtex._util.progress import Stopped
from flowtex._util.whole_file import WholeFile
from flowtex.offscreen.moments import MovieError

__all__ = ["MovieWriter", "Pixels", "Size"]

Pixels = NDArray[np.uint8]
Size = tuple[int, int]

#: Longest side of a picture, in pixels.
LONGEST_SIDE = 16_384


def _never() -> bool:
    return False


class MovieWriter:
    """Takes pictures and makes a file of them.

    Parameters
    ----------
    path
        File to write.
    size
        Width and height in pixels.
    fps
        Frames in a second.
    quality
        1 to 100.

    Raises
    ------
    OSError
        When there is no such folder, or no right to write there.
    """

    def __init__(self, path: Path, size: Size, fps: float, quality: int) -> None:
        self._size, self._fps, self._quality = size, fps, quality
        self._file = WholeFile(path)
        try:
            self._begin(self._file.part)
        except BaseException:
            self._file.drop()
            raise

    @classmethod
    def fault(cls, size: Size, fps: float) -> str:
        """Say why such a movie cannot be written and what can; empty when it can be."""
        del fps
        if all(1 <= side <= LONGEST_SIDE for side in size):
            return ""
        shown = f"size is {size[0]} x {size[1]}"
        return f"{shown}; expected 1 to {LONGEST_SIDE} pixels along each side"

    @classmethod
    def need(cls) -> None:
        """Refuse to begin where what writes the file is not installed.

        Raises
        ------
        ModuleNotFoundError
            The text names the command that installs it.
        """

    def add(self, picture: Pixels) -> None:
        """Take the next picture, (H, W, 3) uint8.

        Raises
        ------
        MovieError
            When its size is not that of the movie.
        """
        height, width = picture.shape[:2]
        if (width, height) != self._size:
            wanted = f"{self._size[0]} x {self._size[1]}"
            msg = f"a picture is {width} x {height}; expected {wanted}, the size of the movie"
            raise MovieError(msg)
        self._add(picture)

    def finish(self, unwanted: Callable[[], bool] = _never) -> None:
        """Write what is left to write, and put the file in its place.

        Raises
        ------
        Stopped
            When ``unwanted()`` became true before.
        """
        self._finish(unwanted)
        if unwanted():
            raise Stopped
        self._file.keep()

    def abandon(self) -> None:
        """Leave nothing behind; after :meth:`finish` there is nothing to do."""
        self._close()
        self._file.drop()

    def _begin(self, part: Path) -> None:
        raise NotImplementedError

    def _add(self, picture: Pixels) -> None:
        raise NotImplementedError

    def _finish(self, unwanted: Callable[[], bool]) -> None:
        raise NotImplementedError

    def _close(self) -> None:
        raise NotImplementedError
