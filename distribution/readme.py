"""The README for PyPI, where relative links lead nowhere: they become those of the tag."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

RELATIVE_LINK = re.compile(r"\]\((?!https?://|#)([^)\s]+)\)")
PICTURES = (".gif", ".jpg", ".png", ".svg", ".webp")


class Readme(MetadataHookInterface):
    """Sets the readme of the package."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Read the README, and make its links absolute."""
        repository, tag = metadata["urls"]["Repository"], f"v{metadata['version']}"

        def absolute(match: re.Match[str]) -> str:
            kind = "raw" if match[1].endswith(PICTURES) else "blob"
            return f"]({repository}/{kind}/{tag}/{match[1]})"

        text = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        metadata["readme"] = {
            "content-type": "text/markdown",
            "text": RELATIVE_LINK.sub(absolute, text),
        }
