"""Sphinx extension: the notebooks as pages of the site, run when it is built.

They are copied into ``docs/lessons``. What their widgets show becomes a live view, as of examples:
a start-up file of the kernels, in a folder of IPython's that is the build's own, sees to it.
"""

from __future__ import annotations

import hashlib
import os
import shutil
from pathlib import Path
from typing import Any

import live

from flowtex.rendering.diagnostics import prefer_headless

HERE = Path(__file__).resolve().parent
NOTEBOOKS = HERE.parent / "notebooks"
PAGES = HERE / "lessons"

STARTUP = """\
import sys

sys.path[:0] = {paths}
import lessons

lessons.in_kernel()
"""


class WidgetView(live.View):
    """What a widget shows, of the mesh and with the options that it was made with."""

    sizes = ((live.STILL, 1.0),)

    def __init__(self, widget: Any, mesh: Any, options: dict[str, Any]) -> None:
        chosen = {**options, **dict(widget.settings)}
        self.mesh, self.look = mesh, {**chosen, "camera": dict(widget.camera)}
        self.time = widget.time
        self.views = widget._views
        self.camera = dict(widget.camera)
        self.whole = self.plays = False
        what = repr(sorted(chosen.items(), key=str)).encode() + self.pictures[0].tobytes()
        self.name = f"view_{hashlib.sha256(what).hexdigest()[:12]}"

    def _repr_html_(self) -> str:
        """Write the scene, and return its element for a page in the folder that is worked in."""
        self.write(self.name)
        folders = len(Path.cwd().relative_to(HERE).parts)
        return live.html({"scene": self.name, "flags": self.flags}, "Flow texture", folders)


def in_kernel() -> None:
    """Show widgets as the site does."""
    from IPython.display import display

    from flowtex import FlowWidget
    from flowtex.host import cell as widgets

    make = FlowWidget.__init__
    given: dict[int, Any] = {}

    def remember(self: Any, mesh: Any, **options: Any) -> None:
        make(self, mesh, **options)
        given[id(self)] = (mesh, {n: v for n, v in options.items() if n not in ("size", "bar")})

    def show(shown: Any) -> None:
        for widget in widgets._displayed_in(shown):
            display(WidgetView(widget, *given[id(widget)]))

    FlowWidget.__init__ = remember
    widgets._display = show


def _begin(app: Any) -> None:
    PAGES.mkdir(exist_ok=True)
    for notebook in app.config.lessons_notebooks:
        shutil.copyfile(NOTEBOOKS / f"{notebook}.ipynb", PAGES / f"{notebook}.ipynb")
    profile = Path(app.doctreedir) / "ipython"
    startup = profile / "profile_default" / "startup" / "site.py"
    startup.parent.mkdir(parents=True, exist_ok=True)
    paths = [str(HERE), str(HERE.parent)]
    startup.write_text(STARTUP.format(paths=paths), encoding="utf-8")
    prefer_headless()  # the kernels as well: VTK's warnings would be on the pages
    os.environ["IPYTHONDIR"] = str(profile)
    os.environ["MATPLOTLIBRC"] = str(HERE / "matplotlibrc")


def setup(app: Any) -> dict[str, Any]:
    """Register with Sphinx."""
    app.add_config_value("lessons_notebooks", [], "env")
    app.connect("builder-inited", _begin, priority=2)  # after live.py has named the folder
    return {"parallel_read_safe": True, "parallel_write_safe": True}
