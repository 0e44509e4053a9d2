"""Checks of the messages of a page before trame receives them, and of its error messages.

wslink reserves room for a whole message when its first piece announces a length of up to 4 GB, so
messages are limited: nothing that the page sends is larger than a picture. trame keeps whatever a
page puts into the state, prints the names of areas and triggers that it does not know, and
answers an error with its traceback; all this is prevented here.
"""

from __future__ import annotations

import logging
from collections.abc import Container
from typing import Any

from wslink.chunking import UnChunker

from flowtex.app.server.validation import name_among

#: Bytes of a message, and messages that a page may begin before it ends one.
MESSAGE_BYTES, OPEN_MESSAGES = 16_000_000, 4
#: Methods of trame that no page of ours calls.
UNUSED = ("application.exit", "application.exit.later", "trame.rca.push", "trame.rca.drop")
#: Events of a page.
EVENTS = ("client_connected", "client_mounted", "client_unmounted", "client_exited")

#: Characters of the name of a trigger.
NAME_LENGTH = 100

_log = logging.getLogger(__name__)


class LimitedMessages(UnChunker):
    """The messages of one connection, joined from their pieces, within limits.

    ``declared`` are the names of the state's values, to which a page cannot add others, and
    ``areas`` the names of its views.
    """

    def __init__(self, declared: Container[str] = (), areas: Container[str] = ()) -> None:
        super().__init__()
        self._declared, self._areas = declared, areas

    def set_max_message_size(self, size: int) -> None:
        """Limit messages to this many bytes, and to the general limit."""
        super().set_max_message_size(min(size, MESSAGE_BYTES))

    def process_chunk(self, chunk: bytes) -> Any:
        """Add a piece; return the message when it is the last one.

        Raises a ValueError when a message is too long or malformed, or too many are incomplete.
        """
        message = super().process_chunk(chunk)
        if len(self.pending_messages) > OPEN_MESSAGES:
            self.release_pending_messages()
            msg = (
                f"more than {OPEN_MESSAGES} messages are incomplete; expected one of them to end "
                "first"
            )
            raise ValueError(msg)
        return self._checked(message) if isinstance(message, dict) else message

    def _checked(self, message: dict[str, Any]) -> dict[str, Any] | None:
        """Return a message without its invalid parts; ``None`` if it is refused as a whole."""
        method, args = message.get("method"), message.get("args")
        first = args[0] if isinstance(args, list) and args else None
        if method == "trame.state.update":
            changes = [c for c in first if isinstance(c, dict)] if isinstance(first, list) else []
            declared = [c for c in changes if name_among(c.get("key"), self._declared)]
            return {**message, "args": [declared], "kwargs": {}}
        if method == "trame.lifecycle.update":
            return {**message, "kwargs": {}} if name_among(first, EVENTS) else None
        if method == "trame.trigger" and not _is_plain_name(first):
            return None
        if isinstance(method, str) and method.startswith("trame.rca."):
            return {**message, "kwargs": {}} if name_among(first, self._areas) else None
        return message


def _is_plain_name(name: object) -> bool:
    """Return whether a name is safe in a log, to which trame writes unknown triggers."""
    return isinstance(name, str) and len(name) <= NAME_LENGTH and name.isidentifier()


def restrict(endpoint: Any) -> None:
    """Remove unused methods from a wslink endpoint, and tracebacks from its errors."""
    for name in UNUSED:
        endpoint.functionMap.pop(name, None)
    send = endpoint.sendWrappedError

    async def send_error(
        rpcid: Any, code: int, message: str, data: Any = None, client_id: Any = None
    ) -> None:
        if isinstance(data, dict):
            _log.error("%s failed\n%s", data.get("method"), data.get("trace"))
        await send(rpcid, code, message, client_id=client_id)

    endpoint.sendWrappedError = send_error
    # It logs the same in three pieces, in spite of disable_logging.
    logging.getLogger("wslink.protocol").disabled = True
