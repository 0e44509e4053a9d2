"""Words and numbers of text files, counted without making an object of each."""

from __future__ import annotations

import re
from typing import BinaryIO

import numpy as np

CHUNK_BYTES = 1 << 20
#: Longest word that VTK reads at once.
WORD_LENGTH = 255
_WORD = re.compile(rb"\S{1,%d}" % WORD_LENGTH)
_BLANK = np.zeros(256, dtype=bool)
_BLANK[list(b" \t\n\v\f\r")] = True
_OF_NUMBERS = np.zeros(256, dtype=bool)
_OF_NUMBERS[list(b"0123456789+-.eEdDnNaAiIfFtTyY")] = True


class TextScanner:
    """One pass through a file of words, numbers and blocks of bytes, up to ``end`` in bytes."""

    def __init__(self, stream: BinaryIO, end: int) -> None:
        self._stream, self._end = stream, end
        self._buffer, self._at = b"", 0

    @property
    def left(self) -> int:
        """Bytes that are not read yet."""
        return max(self._end - self._stream.tell(), 0) + len(self._buffer) - self._at

    def word(self) -> bytes:
        """Return the next word, empty at the end."""
        while True:
            match = _WORD.search(self._buffer, self._at)
            if match is not None and match.end() < len(self._buffer):
                break
            if not self._more():
                break
        if match is None:
            self._at = len(self._buffer)
            return b""
        self._at = match.end()
        return match.group()

    def next_word(self) -> bytes:
        """Return the next word, and stay before it."""
        word = self.word()
        # The buffer holds the word that was just read.
        self._at -= len(word)
        return word

    def line(self) -> bytes | None:
        """Return the rest of the line without its end, ``None`` at the end of the file."""
        while (stop := self._buffer.find(b"\n", self._at)) < 0 and self._more():
            pass
        if stop < 0 and self._at == len(self._buffer):
            return None
        stop = len(self._buffer) if stop < 0 else stop
        line = self._buffer[self._at : stop]
        self._at = min(stop + 1, len(self._buffer))
        return line.removesuffix(b"\r")

    def skip(self, count: int) -> int:
        """Skip bytes, and return their number."""
        count = min(count, self.left)
        inside = min(count, len(self._buffer) - self._at)
        self._at += inside
        self._stream.seek(count - inside, 1)
        return count

    def read(self, count: int) -> bytes:
        """Return the next bytes, at most ``count``."""
        while len(self._buffer) - self._at < count and self._more():
            pass
        data = self._buffer[self._at : self._at + count]
        self._at += len(data)
        return data

    def numbers(self, most: int | None = None) -> int:
        """Skip numbers, at most ``most``, up to another word; return their count."""
        count = 0
        while most is None or count < most:
            if self._at == len(self._buffer) and not self._more():
                break
            part = np.frombuffer(self._buffer, np.uint8, offset=self._at)
            blank = _BLANK[part]
            stop = len(part)
            if not blank[-1] and self._stream.tell() < self._end:
                # The last word may continue in the next chunk.
                blanks = np.flatnonzero(blank)
                stop = int(blanks[-1]) + 1 if blanks.size else 0
                if not stop and len(part) <= WORD_LENGTH:
                    self._more()
                    continue
                stop = stop or len(part)
            starts = np.flatnonzero(~blank & np.concatenate([[True], blank[:-1]]))
            others = np.flatnonzero(~blank & ~_OF_NUMBERS[part])
            ended = bool(others.size) and int(others[0]) < stop
            if ended:
                stop = int(starts[np.searchsorted(starts, others[0], "right") - 1])
            found = int(np.searchsorted(starts, stop))
            if most is not None and count + found > most:
                found = most - count
                stop = int(starts[found])
            count += found
            self._at += stop
            if ended:
                break
        return count

    def _more(self) -> bool:
        """Read a chunk if there is one, and drop the bytes before the position."""
        room = min(CHUNK_BYTES, self._end - self._stream.tell())
        data = self._stream.read(max(room, 0))
        if data:
            self._buffer, self._at = self._buffer[self._at :] + data, 0
        return bool(data)
