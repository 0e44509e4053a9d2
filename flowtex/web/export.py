"""A flow as one HTML file that draws without a server and without a network.

The client, its style, the header and all arrays lie in the file. Arrays are gzipped with the
bytes of equal significance side by side, which is where slopes resemble one another, and written
in base64. A Content-Security-Policy lets nothing run but the two texts whose digests it names,
and lets nothing be fetched.
"""

from __future__ import annotations

import base64
import gzip
import hashlib
import html
import json
import string
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex._util.cache import digest
from flowtex._util.progress import track
from flowtex._util.whole_file import whole_file
from flowtex._version import __version__
from flowtex.options import Appearance, FieldOptions, Options, ViewOptions, accepts_options
from flowtex.rendering.webgl import Scene, asset
from flowtex.web import preview
from flowtex.web.view import WebView, web_views

__all__ = ["Page", "estimate", "export", "page_text", "write_page"]

#: Size of an average part after packing, over that before, base64 included.
PACKED = 0.62
#: Bytes of the client, its shaders and the header, about.
AROUND = 200_000
#: Line of page.js that has no place in a page, where client.js stands before it.
IMPORT = 'import { mountPage } from "./client.js";\n'
#: Size of the preview picture.
PREVIEW = (480, 300)


@dataclass(frozen=True)
class Page:
    """What was written.

    Attributes
    ----------
    path
        The file.
    nbytes
        Its size.
    estimated
        The size that was estimated beforehand.
    steps
        Number of time steps in it.
    """

    path: Path
    nbytes: int
    estimated: int
    steps: int


@accepts_options(FieldOptions, Appearance, ViewOptions)
def export(
    mesh: Any,
    path: str | Path,
    *,
    steps: int | None = None,
    title: str | None = None,
    announce: Callable[[int, int], None] | None = None,
    **options: Any,
) -> Page:
    """Write a flow as one HTML file that needs no server and no network.

    Parameters
    ----------
    mesh
        What ``plotter.flowtex.add`` takes.
    path
        File to write; one that is there already is replaced, once the new one is whole.
    steps
        Number of time steps to keep, evenly chosen with the first and the last among them; all
        of them by default. One step alone is drawn as a steady flow.
    title
        Title of the page; the name of the field by default.
    announce
        Called with the estimated size in bytes and the number of steps before the work begins.
    {options}
    **settings
        Any setting of :class:`~flowtex.Settings`, such as ``samples=25``.

    Returns
    -------
    Page

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
    ValueError
        When ``steps`` is not positive.
    OSError
        When the file cannot be written; what was there before is left as it was.
    """
    arguments = Options.split(**options)
    views = web_views(mesh, arguments, steps=steps)
    try:
        camera = views[0].camera(arguments.view).to_dict()
        return write_page(views, path, camera=camera, title=title, announce=announce)
    finally:
        for view in views:
            view.close()


def write_page(
    views: Sequence[WebView],
    path: str | Path,
    *,
    camera: dict[str, Any] | None = None,
    time: float | None = None,
    clock: float = 0.0,
    title: str | None = None,
    picture: bytes | None = None,
    announce: Callable[[int, int], None] | None = None,
) -> Page:
    """Write a view, or two beside each other, as a page; :func:`export` has the parameters."""
    path = Path(path)
    scenes = [view.data() for view in views]
    estimated = estimate(scenes)
    if announce is not None:
        announce(estimated, scenes[0].steps)
    pieces = _pieces(views, scenes, camera, time, clock, title, picture)
    return Page(path, _write(path, pieces), estimated, scenes[0].steps)


def page_text(
    views: Sequence[WebView],
    *,
    camera: dict[str, Any] | None = None,
    time: float | None = None,
    clock: float = 0.0,
    title: str | None = None,
    picture: bytes | None = None,
) -> str:
    """Return a view, or two, as the text of a page; :func:`export` has the parameters."""
    scenes = [view.data() for view in views]
    return "".join(_pieces(views, scenes, camera, time, clock, title, picture))


def estimate(scenes: Sequence[Scene]) -> int:
    """Bytes that a page is going to have, about; textures of both views count once."""
    size = 0
    for n, scene in enumerate(scenes):
        if n and scene.textures is scenes[0].textures:
            break
        arrays = sum(part.nbytes for part in scene.surface().values())
        size += arrays + scene.steps * scene.nbytes_of_step
    return AROUND + int(PACKED * size)


def _pieces(
    views: Sequence[WebView],
    scenes: Sequence[Scene],
    camera: dict[str, Any] | None,
    time: float | None,
    clock: float,
    title: str | None,
    picture: bytes | None,
) -> Iterator[str]:
    """Give the text of a page piece by piece; each array is packed when it is reached."""
    header, *others = (
        scene.header(view.scene.settings, camera=camera, time=time, clock=clock)
        for view, scene in zip(views, scenes, strict=True)
    )
    for view, other in zip(views[1:], others, strict=True):
        other["differs"] = header["differs"] = list(view.own_settings)
        header["beside"] = other
    if picture is None:
        picture = preview.preview_png(
            views[0], PREVIEW, camera=header["camera"], time=time, coarser=1
        )
    before, after = asset("page.html").read_text("utf-8").split("$parts\n")
    values = _values(header, title or header["name"] or "Flow", picture)
    yield string.Template(before).substitute(values)
    written: dict[bytes, str] = {}
    for name, array in _all_parts(scenes):
        same = written.setdefault(digest(array), name)
        yield _element(name, array) if same == name else _reference(name, same)
    yield string.Template(after).substitute(values)


def _values(header: dict[str, Any], title: str, picture: bytes) -> dict[str, str]:
    """Return what the page's template asks for."""
    background = "#" + "".join(f"{round(255 * c):02x}" for c in header["background"])
    page = asset("page.js").read_text("utf-8").replace(IMPORT, "")
    client = asset("client.js").read_text("utf-8") + "\n" + page
    script = "\n" + client.replace("</script", r"<\/script").replace("<!--", r"<\!--")
    look = string.Template(asset("page.css").read_text("utf-8")).substitute(background=background)
    return {
        "policy": _policy(script),
        "version": __version__,
        "title": html.escape(title),
        "style": look,
        "preview": "data:image/png;base64," + base64.b64encode(picture).decode(),
        "header": _json(header),
        "script": script,
    }


def _policy(script: str) -> str:
    """Allow the one script by its digest, styles of the page's own, and nothing from outside."""
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    return (
        f"default-src 'none'; script-src 'sha256-{digest}'; style-src 'unsafe-inline'; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )


def _json(value: Any) -> str:
    """Return JSON in which nothing can end a script element."""
    text = json.dumps(value, allow_nan=False, separators=(",", ":"))
    return text.replace("<", r"\u003c").replace(">", r"\u003e").replace("&", r"\u0026")


def _element(name: str, array: NDArray[Any]) -> str:
    """Return a part as an element of the page."""
    numbers = np.ascontiguousarray(array)
    # As many bytes as the array has, those of one significance side by side.
    planes = numbers.reshape(-1).view(np.uint8).reshape(-1, numbers.itemsize).T
    packed = base64.b64encode(gzip.compress(planes.tobytes(), 9, mtime=0)).decode()
    shape = " ".join(map(str, array.shape))
    return (
        f'<script type="text/plain" data-part="{html.escape(name)}" data-dtype="{array.dtype}" '
        f'data-shape="{shape}" data-bytes="{array.itemsize}">{packed}</script>\n'
    )


def _reference(name: str, same: str) -> str:
    """Return an element for a part that is the same as another one."""
    return (
        f'<script type="text/plain" data-part="{html.escape(name)}" '
        f'data-same="{html.escape(same)}"></script>\n'
    )


def _all_parts(scenes: Sequence[Scene]) -> Iterator[tuple[str, NDArray[Any]]]:
    for scene, before in zip(scenes, ("", "beside:"), strict=False):
        for name, array in scene.surface().items():
            yield before + name, array
        for step in track(range(scene.steps), scene.steps, "Packing time steps"):
            for name, array in scene.step(step).items():
                yield before + name, array


def _write(path: Path, text: Iterator[str]) -> int:
    """Write a file that is there whole or not at all; return its size."""
    with whole_file(path) as part, part.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(text)
    return path.stat().st_size
