"""Sphinx extension: pictures of the site that the reader turns and zooms.

What an example or a notebook shows with ``flowtex.show`` becomes a scene in ``_static/scenes``, and
on the page an element that the one client of the site makes alive when it comes into sight.
"""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Any

from PIL import Image

import flowtex
from flowtex.options import Appearance, FieldOptions, Options, ViewOptions, accepts_options
from flowtex.web.assets import asset
from flowtex.web.embed import scene_script
from flowtex.web.view import web_views

#: Folder of the site's own files, told to the kernels of notebooks as well.
FOLDER = "FLOWTEX_SITE_STATIC"
#: Size of a still in pixels; a view is as wide as the text, and of this shape.
STILL = (960, 480)

#: What has been shown since the last block of an example.
shown: list[View] = []


class View:
    """A flow that was shown, as ``flowtex.show`` returns it in a notebook."""

    def __init__(self, mesh: Any, options: dict[str, Any], steps: int | None) -> None:
        self.still = Image.fromarray(flowtex.render(mesh, size=STILL, **options))
        arguments = Options.split(**options)
        self.views = web_views(mesh, arguments, steps=steps)
        view = arguments.view
        surface = self.views[0].field.surface
        self.camera = view.first_camera(surface, STILL[0] / STILL[1]).to_dict()

    def write(self, name: str) -> None:
        """Write the scene and its still."""
        folder = Path(os.environ[FOLDER]) / "scenes"
        folder.mkdir(parents=True, exist_ok=True)
        with (folder / f"{name}.js").open("w", encoding="utf-8", newline="\n") as file:
            file.writelines(scene_script(name, self.views, camera=self.camera))
        self.still.save(folder / f"{name}.jpg", quality=88)

    def html(self, name: str, folders: int = 1) -> str:
        """Return the element of a scene, on a page so many folders below the top."""
        scenes = f"{'../' * folders}_static/scenes"
        return (
            f'<div class="flowtex-live" data-scene="{scenes}/{name}.js">'
            f'<img src="{scenes}/{name}.jpg" alt="A still of the live view" loading="lazy"></div>'
        )


@accepts_options(FieldOptions, Appearance, ViewOptions)
def show(mesh: Any, *, size: Any = None, steps: int | None = None, **options: Any) -> View:
    """Show a flow on the site; see :func:`flowtex.show`."""
    del size
    view = View(mesh, options, steps)
    shown.append(view)
    return view


class Scraper:
    """Takes what an example shows, for sphinx-gallery."""

    def __repr__(self) -> str:
        return "flowtex"

    def __call__(self, block: Any, block_vars: dict[str, Any], gallery_conf: Any) -> str:
        """Return the text of the views that a block has shown."""
        del block, gallery_conf
        texts = []
        for view in shown:
            picture = Path(next(block_vars["image_path_iterator"]))
            picture.parent.mkdir(parents=True, exist_ok=True)
            view.still.save(picture)
            view.write(picture.stem)
            texts.append(f"\n.. raw:: html\n\n    {view.html(picture.stem)}\n\n")
        shown.clear()
        return "".join(texts)


def reset(gallery_conf: Any, name: str) -> None:
    """Begin an example with nothing shown."""
    del gallery_conf, name
    shown.clear()


def _begin(app: Any) -> None:
    folder = Path(app.outdir) / "_static"
    os.environ[FOLDER] = str(folder)
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(asset("live.js"), folder / "flowtex-live.js")
    flowtex.show = show  # type: ignore[assignment]


def setup(app: Any) -> dict[str, Any]:
    """Register with Sphinx."""
    app.connect("builder-inited", _begin, priority=1)  # before the examples run
    app.add_js_file("flowtex-live.js", loading_method="defer")
    return {"parallel_read_safe": True, "parallel_write_safe": True}
