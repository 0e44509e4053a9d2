"""What is in an exported page, as a browser reads it."""

from __future__ import annotations

import base64
import gzip
import html.parser
import json
from typing import Any

from numpy.typing import NDArray
from packed import unpacked


class Reader(html.parser.HTMLParser):
    """Reads a page as a browser does: elements, and the text of each script."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.addresses: list[str] = []
        self.policy = self.title = ""
        self.scripts: list[tuple[dict[str, str | None], str]] = []
        self._in = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.tags.append(tag)
        self._in = tag
        self.addresses += [v or "" for k, v in attrs if k in ("src", "href")]
        if given.get("http-equiv") == "Content-Security-Policy":
            self.policy = given["content"] or ""
        if tag == "script":
            self.scripts.append((given, ""))

    def handle_endtag(self, tag: str) -> None:
        self._in = ""

    def handle_data(self, data: str) -> None:
        if self._in == "title":
            self.title += data
        if self._in == "script":
            attributes, text = self.scripts[-1]
            self.scripts[-1] = (attributes, text + data)

    def header(self) -> dict[str, Any]:
        (text,) = [text for given, text in self.scripts if given.get("id") == "headers"]
        return dict(json.loads(gzip.decompress(base64.b64decode(text)))[0])

    def parts(self) -> dict[str, NDArray[Any]]:
        """Parts of the first view."""
        result: dict[str, NDArray[Any]] = {}
        by_digest: dict[str, NDArray[Any]] = {}
        for given, text in self.scripts:
            if given.get("data-view") != "0":
                continue
            info = json.loads(given["data-part"] or "")
            if text:
                by_digest[info["digest"]] = unpacked(info, text)
            result[info["name"]] = by_digest[info["digest"]]
        return result

    def names(self) -> list[str]:
        """Names of the parts of all views."""
        found = (given.get("data-part") for given, _ in self.scripts)
        return [json.loads(text)["name"] for text in found if text]
