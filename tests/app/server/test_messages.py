"""What of a page's messages comes to trame, and what of trame's errors to the page."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip("trame_rca")

import msgpack
from wslink.chunking import generate_chunks

from flowtex.app.server.sessions.local import MESSAGE_BYTES, LimitedMessages


def taken(message: Any) -> Any:
    """Return what is left of a message."""
    messages = LimitedMessages({"one", "two"}, {"view"})
    messages.set_max_message_size(10_000)
    (chunk,) = generate_chunks(msgpack.packb(message), 10_000)
    return messages.process_chunk(chunk)


def test_a_message_has_an_end() -> None:
    messages = LimitedMessages()
    messages.set_max_message_size(4 * 2**30)
    whole = msgpack.packb({"id": 1, "content": b"x" * 1000})
    found = [messages.process_chunk(chunk) for chunk in generate_chunks(whole, 300)]
    assert found[-1]["id"] == 1 and not any(found[:-1])
    head = (7).to_bytes(4, "little") + bytes(4)
    with pytest.raises(ValueError, match="exceeds"):
        messages.process_chunk(head + (MESSAGE_BYTES + 1).to_bytes(4, "little"))
    with pytest.raises(ValueError, match="are incomplete"):
        for number in range(10):
            begun = number.to_bytes(4, "little") + bytes(4) + (99).to_bytes(4, "little")
            messages.process_chunk(begun)
    assert not messages.pending_messages


@pytest.mark.parametrize("by_name", [False, True])
def test_values_that_nobody_declared_are_dropped(*, by_name: bool) -> None:
    changes: list[Any] = [
        *({"key": key, "value": 1} for key in ("one", "new", "two", 3, ["one"], None)),
        *("one", None, {}, {"value": 1}),
    ]
    update: dict[str, Any] = {"id": "a", "method": "trame.state.update"}
    update |= {"args": [], "kwargs": {"changes": changes}} if by_name else {"args": [changes]}
    left = taken(update)
    known = [{"key": "one", "value": 1}, {"key": "two", "value": 1}]
    assert left["args"] == [[] if by_name else known] and not left["kwargs"]
    others: list[Any] = [None, 1, "one", {}, [1]]
    for junk in others:
        assert taken({**update, "args": [junk]})["args"] == [[]]


@pytest.mark.parametrize(
    ("method", "known", "unknown"),
    [
        ("trame.rca.size", ["view", "x", {}], ["other", "x", {}]),
        ("trame.rca.event", ["view", "x", {}], [["view"], "x", {}]),
        ("trame.lifecycle.update", ["client_mounted"], ["x" * 99]),
        ("trame.lifecycle.update", ["client_exited"], []),
        ("trame.trigger", ["trigger", [], {}], ["\x1b[31m", [], {}]),
        ("trame.trigger", ["trigger", [1], {}], [["trigger"], [], {}]),
        ("trame.trigger", ["trigger__1", [], {}], ["x" * 101, [], {}]),
    ],
)
def test_names_that_nobody_declared_are_dropped(
    method: str, known: list[Any], unknown: list[Any]
) -> None:
    assert taken({"method": method, "args": known})["args"] == known
    assert taken({"method": method, "args": unknown}) is None
    assert taken({"method": method, "kwargs": {"area_name": "other", "name": "x"}}) is None
