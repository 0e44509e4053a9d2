"""Sphinx extension: pictures of the site that the reader turns and zooms.

What an example, a block of the directive ``live`` or a notebook shows with ``flowtex.show`` becomes
a scene in ``_static/scenes``, and on the page an element that the one client of the site makes
alive when it comes into sight. In MyST::

    ```{live}
    :title: An airfoil

    import flowtex

    flowtex.show(flowtex.examples.airfoil(), zoom=4)
    ```

The blocks of a page share their names; ``:hide:`` leaves out the code. With an argument it shows
again what an example has shown, ``{live} plot_airfoil``.
"""

from __future__ import annotations

import contextlib
import os
import shutil
from collections.abc import Mapping, Sequence
from functools import cached_property
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, ClassVar

import numpy as np
from docutils import nodes
from docutils.parsers.rst import directives
from embed import write_scene
from PIL import Image
from sphinx.util.docutils import SphinxDirective

import flowtex
from flowtex.field import FlowField
from flowtex.field.options import FieldOptions, accepts_options
from flowtex.host.export import page_text
from flowtex.host.view import WebView, asset, client_script, web_views
from flowtex.plotting.component import open_plotter, point_camera
from flowtex.scene.fields import read_field
from flowtex.scene.options import Appearance, Options, ViewOptions
from flowtex.scene.scene import make_scenes

#: Folder of the site's own files, told to the kernels of notebooks as well.
FOLDER = "FLOWTEX_SITE_STATIC"
#: Size of a still in pixels; a view is as wide as the text, and of this shape.
STILL = (1000, 500)
#: Size of a thumbnail in pixels, and how many times larger its grain is: cards show it smaller.
THUMBNAIL, THUMBNAIL_GRAIN = (480, 300), 1.6
#: Bytes of a scene, at most; of a series so many steps are kept as fit.
SCENE_BYTES = 1_400_000
#: Sections of the gallery, folders of docs/examples, in order.
SECTIONS = ("grids", "surfaces", "earth", "time", "looks", "classics")
HINT = (
    "Interactive: drag to pan, click then scroll to zoom, or press +, − and 0. Click the flow to "
    "trace a path."
)

#: What has been shown since the last block of an example.
shown: list[View] = []


class View:
    """A flow that was shown, as ``flowtex.show`` returns it in a notebook."""

    #: Sizes of its pictures, and how many times larger than usual the grain is in each.
    sizes: Sequence[tuple[tuple[int, int], float]] = ((STILL, 1.0), (THUMBNAIL, THUMBNAIL_GRAIN))
    time: float | None = None

    def __init__(self, mesh: Any, options: dict[str, Any], steps: int | None) -> None:
        arguments = Options.split(**options)
        self.mesh: FlowField = read_field(mesh, arguments.field)
        self.look = {k: v for k, v in options.items() if k not in vars(arguments.field)}
        self.views = _fitting(self.mesh, Options.split(**self.look), steps)
        view = arguments.view
        # Of a picture of everything nothing is cut off where the page is narrow.
        self.whole = view.zoom == 1 and view.focus is None and view.camera is None
        aspect = STILL[0] / STILL[1] / len(self.views)
        self.camera = view.first_camera(self.views[0].field.surface, aspect).to_dict()
        self.plays = self.views[0].scene.settings.motion != "off"

    @cached_property
    def pictures(self) -> list[Image.Image]:
        """Pictures of the sizes, without ground, so that they lie on light and dark pages."""
        options = Options.split(**{**self.look, "show_scalar_bar": False})
        drawing: dict[str, Any] = {"labels": False, "off_screen": True, "lighting": "light kit"}
        scenes = make_scenes(self.mesh, options)
        plotter, handles = open_plotter(scenes, options.view, STILL, outline_samples=4, **drawing)
        try:
            result = []
            for size, coarser in self.sizes:
                plotter.window_size = list(size)
                for handle in handles:
                    handle.settings.grain *= coarser
                    if self.time is not None:
                        handle.time = self.time
                point_camera(plotter, handles[0].scene.whole.surface, options.view)
                result.append(_without_ground(plotter))
        finally:
            plotter.close()
        return result

    def write(self, name: str) -> None:
        """Write the scene and its still."""
        folder = Path(os.environ[FOLDER]) / "scenes"
        folder.mkdir(parents=True, exist_ok=True)
        write_scene(folder, name, self.views, camera=self.camera)
        self.pictures[0].save(folder / f"{name}.webp", quality=75, method=6)

    @property
    def flags(self) -> tuple[str, ...]:
        """What of it the page has to know."""
        kinds = {"whole": self.whole, "plays": self.plays, "pair": len(self.views) > 1}
        return tuple(kind for kind, holds in kinds.items() if holds)


def _without_ground(plotter: Any) -> Image.Image:
    """Return what a plotter shows, transparent where there is nothing."""
    shots = []
    for ground in ("white", "black"):
        plotter.set_background(ground, all_renderers=True)
        plotter.render()
        shots.append(np.asarray(plotter.screenshot(return_img=True))[..., :3].astype(float))
    white, black = shots
    alpha = np.clip(255 - (white - black).max(axis=-1, keepdims=True), 0, 255)
    colour = np.clip(255 * black / np.maximum(alpha, 1), 0, 255)
    return Image.fromarray(np.concatenate([colour, alpha], axis=-1).round().astype(np.uint8))


def _fitting(field: FlowField, options: Options, steps: int | None) -> tuple[WebView, ...]:
    """Return views with as many time steps as there is room for, unless their number is given."""
    views = web_views(field, options, steps=steps)
    if steps is not None or len(field.times) == 1:
        return views
    one, all_of_them = (
        len(page_text(some)) - len(client_script())  # which all scenes of the site share
        for some in (web_views(field, options, steps=1), views)
    )
    step = (all_of_them - one) / (len(field.times) - 1)
    fitting = 1 + int((SCENE_BYTES - one) / step)
    return web_views(field, options, steps=max(fitting, 2))


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
            # The first one becomes the thumbnail.
            view.pictures[1].quantize(256).save(picture)
            name = scene_name(Path(block_vars["src_file"]).stem, picture.stem[-3:])
            view.write(name)
            flags = "".join(f"   :{flag}:\n" for flag in view.flags)
            texts.append(f"\n.. live:: {name}\n{flags}\n\n")
        shown.clear()
        return "".join(texts)


def scene_name(source: str, number: str) -> str:
    """Return the name of the scene that a source has shown as its n-th."""
    return source if int(number) == 1 else f"{source}_{int(number)}"


def reset(gallery_conf: Any, name: str) -> None:
    """Begin an example with nothing shown."""
    del gallery_conf, name
    shown.clear()


class LiveNode(nodes.General, nodes.Element):  # type: ignore[misc]
    """A live view on a page."""


class Live(SphinxDirective):
    """Shows what its code shows, or a scene that there is already."""

    has_content = True
    optional_arguments = 1
    option_spec: ClassVar[dict[str, Any]] = {
        "title": directives.unchanged,
        "hide": directives.flag,
        "whole": directives.flag,
        "plays": directives.flag,
        "pair": directives.flag,
    }

    def run(self) -> list[nodes.Node]:
        """Run the code and return it and what it has shown."""
        if self.arguments:
            flags = [flag for flag in ("whole", "plays", "pair") if flag in self.options]
            return [self._node(self.arguments[0], tuple(flags))]
        code = "\n".join(self.content)
        names = self.env.temp_data.setdefault("live_names", {"__name__": "__main__"})
        with TemporaryDirectory() as folder, contextlib.chdir(folder):  # for what it writes
            exec(compile(code, self.get_location(), "exec"), names)
        block = nodes.literal_block(code, code, language="python")
        result: list[nodes.Node] = [] if "hide" in self.options else [block]
        for view in shown:
            number = self.env.temp_data["live_count"] = self.env.temp_data.get("live_count", 0) + 1
            name = scene_name(self.env.docname.replace("/", "_"), str(number))
            view.write(name)
            result.append(self._node(name, view.flags))
        shown.clear()
        return result

    def _node(self, name: str, flags: tuple[str, ...]) -> nodes.Node:
        return LiveNode(scene=name, flags=flags, title=self.options.get("title", ""))


def html(scene: Mapping[str, Any], title: str, folders: int) -> str:
    """Return the element of a scene, on a page so many folders below the top."""
    path = f"{'../' * folders}_static/scenes/{scene['scene']}"
    flags = "".join(f" data-{flag}" for flag in scene["flags"])
    return (
        f'<div class="flowtex-live" data-scene="{path}.js" data-label="{escape(title)}"{flags}>'
        f'<img src="{path}.webp" alt="{escape(title)}"></div>'
    )


def visit_live(writer: Any, node: LiveNode) -> None:
    """Write the element of a scene; the first one of a page says what can be done with it."""
    page = writer.builder.current_docname
    folders = writer.builder.get_target_uri(page).count("/")
    title = node["title"] or writer.builder.env.titles[page].astext()
    writer.body.append(f'<figure class="flowtex-figure">{html(node, title, folders)}')
    if next(iter(node.document.findall(LiveNode))) is node:
        writer.body.append(f"<figcaption>{HINT}</figcaption>")
    writer.body.append("</figure>\n")
    raise nodes.SkipNode


def _begin(app: Any) -> None:
    folder = Path(app.outdir) / "_static"
    os.environ[FOLDER] = str(folder)
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(asset("core.js"), folder / "flowtex-live.js")
    flowtex.show = show  # type: ignore[assignment]


def setup(app: Any) -> dict[str, Any]:
    """Register with Sphinx."""
    app.connect("builder-inited", _begin, priority=1)  # before the examples run
    app.add_node(LiveNode, html=(visit_live, None))
    app.add_directive("live", Live)
    app.add_js_file("flowtex-live.js", loading_method="defer")
    return {"parallel_read_safe": True, "parallel_write_safe": True}
