"""Messages of a page put together from their pieces, within limits.

wslink sets room for a whole message aside when its first piece says how long it will be, up to
4 GB, and as many messages as a page begins. Nothing that this page sends is larger than a picture.
"""

from __future__ import annotations

from typing import Any

from wslink.chunking import UnChunker

__all__ = ["LONGEST", "Messages"]

#: Bytes of a message, and messages that a page may begin before it ends one.
LONGEST, MOST = 16_000_000, 4


class Messages(UnChunker):
    """What makes messages of pieces, for one connection."""

    def set_max_message_size(self, size: int) -> None:
        """Allow messages of so many bytes, or as many as any may have."""
        super().set_max_message_size(min(size, LONGEST))

    def process_chunk(self, chunk: bytes) -> Any:
        """Take a piece; return the message when it is the last one.

        Raises
        ------
        ValueError
            When the message, or all that have begun, are larger than they may be.
        """
        message = super().process_chunk(chunk)
        if len(self.pending_messages) > MOST:
            self.release_pending_messages()
            msg = f"more than {MOST} messages were begun at a time; expected one to end first"
            raise ValueError(msg)
        return message
