"""Sphinx extension: links of the pages are those of files, as the forge shows them.

Those that lead out of ``docs`` lead to the repository, but for notebooks that the site has as
lessons; for ``gallery.md`` it has a gallery of its own.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

LINK = re.compile(r"(\]\()((?:\.\./)+[^)#\s]*|gallery\.md)")


def _of_the_site(app: Any, name: str, text: list[str]) -> None:
    """Have links lead to what is on the site, or to the repository."""
    top = Path(app.srcdir)
    moved = {top / "gallery.md": top / "gallery" / "index"}
    for lesson in app.config.lessons_notebooks:
        file = f"{lesson}.ipynb"
        moved[top.parent / "notebooks" / file] = top / "lessons" / file

    def address(link: re.Match[str]) -> str:
        here = top / Path(name).parent
        path = Path(os.path.normpath(here / link[2]))
        if path in moved:
            return link[1] + Path(os.path.relpath(moved[path], here)).as_posix()
        if path.is_relative_to(top) or not path.exists():
            return link[0]  # one that leads nowhere is told by MyST
        kind = "tree" if path.is_dir() else "blob"
        place = path.relative_to(top.parent).as_posix()
        return f"{link[1]}{app.config.repository}/{kind}/main/{place}"

    text[0] = LINK.sub(address, text[0])


def setup(app: Any) -> dict[str, Any]:
    """Register with Sphinx."""
    app.add_config_value("repository", "", "env")
    app.connect("source-read", _of_the_site)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
