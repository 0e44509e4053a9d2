"""Sphinx extension: links of the pages to files outside of ``docs``, which only the forge shows."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

LINK = re.compile(r"(\]\()((?:\.\./)+[^)#\s]*)")


def _to_repository(app: Any, name: str, text: list[str]) -> None:
    """Have links that lead out of ``docs`` lead to the repository."""
    top = Path(app.srcdir)

    def address(link: re.Match[str]) -> str:
        path = Path(os.path.normpath(top / Path(name).parent / link[2]))
        if path.is_relative_to(top) or not path.exists():
            return link[0]  # one that leads nowhere is told by MyST
        kind = "tree" if path.is_dir() else "blob"
        place = path.relative_to(top.parent).as_posix()
        return f"{link[1]}{app.config.repository}/{kind}/main/{place}"

    text[0] = LINK.sub(address, text[0])


def setup(app: Any) -> dict[str, Any]:
    """Register with Sphinx."""
    app.add_config_value("repository", "", "env")
    app.connect("source-read", _to_repository)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
