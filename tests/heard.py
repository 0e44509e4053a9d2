"""What the client of a notebook widget would have received, and what it asks for."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from waiting import PATIENCE_S

from flowtex.host.flow_widget import FlowWidget
from flowtex.rendering.webgl.protocol import Header


def names_of(message: Header) -> list[str]:
    """Names of the parts that a message describes."""
    return [info["name"] for info in message.get("parts", ())]


class Heard:
    """Messages to a widget's client, and arrays by name."""

    def __init__(self, widget: FlowWidget, monkeypatch: pytest.MonkeyPatch) -> None:
        self.widget = widget
        self.messages: list[Header] = []
        self.arrays: dict[str, np.ndarray[Any, Any]] = {}
        #: Names of arrays, requests that have been answered, and errors, as they came.
        self.order: list[str] = []
        self.loaded: list[str] = []
        self.errors: list[str] = []
        self._came = threading.Condition()
        monkeypatch.setattr(type(widget), "send", self._send, raising=False)

    def _send(self, content: Header, buffers: Any = None) -> None:
        with self._came:
            self.messages.append({**content, "header": self.header["generation"]})
            self.order += names_of(content)
            for info, data in zip(content.get("parts", ()), buffers, strict=True):
                array = np.frombuffer(data, info["dtype"]).reshape(info["shape"])
                self.arrays[info["name"]] = array
            self.loaded += [content["request"]] if content["kind"] == "loaded" else []
            self.errors += [content[name] for name in ("error", "text") if name in content]
            self._came.notify_all()

    @property
    def header(self) -> Header:
        """Header of the first view."""
        header: Header = self.widget._header
        return header

    def say(self, **message: Any) -> None:
        """Send a message to the widget, as its client does."""
        self.widget._handle_custom_msg(message, [])

    def ask(self, request: str, key: tuple[int, int, int] | None, *steps: int) -> None:
        """Ask for a tile, or for the whole, at some steps."""
        self.say(kind="load", request=request, key=key and list(key), steps=list(steps), view=0)

    def load(self, key: tuple[int, int, int] | None, *steps: int) -> None:
        """Ask for a tile, and wait for all of it."""
        request = f"load {len(self.loaded)}"
        self.ask(request, key, *steps)
        self.wait(lambda: request in self.loaded)

    def wait(self, ready: Callable[[], bool]) -> None:
        """Wait until something is there."""
        with self._came:
            assert self._came.wait_for(ready, timeout=PATIENCE_S), self.messages

    def settle(self) -> None:
        """Wait until the widget has sent all that it sends by itself, and forget the messages."""
        self.say(kind="ready")
        self.ask("settled", None, 0)
        self.wait(lambda: "settled" in self.loaded)
        assert all(feed.settled.wait(PATIENCE_S) for feed in self.widget._feeds)
        self.messages.clear()
