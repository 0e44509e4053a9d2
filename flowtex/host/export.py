"""A flow as one file that needs no server: an HTML page, or a module for one.

The client, its style, the header and all arrays lie in the file. The header and the arrays are
gzipped and written in base64. A page's Content-Security-Policy allows only the script with its
digest, and no requests. A page of a pyramid may have the coarsest level and one moment alone, and
read the rest from a store, whose server its policy names. A page with a web map, of which the flow
is a layer, loads MapLibre and the map.
"""

from __future__ import annotations

import base64
import hashlib
import html
import json
import math
import re
import string
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np

from flowtex._util import __version__
from flowtex._util.arguments import checked_target
from flowtex._util.array_types import AnyArray
from flowtex._util.progress import track
from flowtex._util.whole_file import whole_file
from flowtex.errors import FieldError, notify
from flowtex.field.options import FieldOptions, accepts_options
from flowtex.host import still
from flowtex.host.view import (
    TileSource,
    WebView,
    asset,
    browser_options,
    client_script,
    first_parts,
    web_views,
)
from flowtex.pyramid.stored import StoredPyramid
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.rendering.webgl.protocol import Header, Parts, part_info, part_text, zipped
from flowtex.scene.array_arguments import takes_arrays
from flowtex.scene.options import Appearance, ViewOptions
from flowtex.textures.tiles.shared import shared_pyramid

#: Bytes of the tiles of a large surface, at most; all of a level are in a page, or none.
TILE_BYTES = 40_000_000
#: The same where a page has slices, as of triangles, which are ten times as large as velocities.
SLICE_BYTES = 15_000_000
#: Endings of the names of modules.
MODULES = (".mjs", ".js")
#: Suffixes of pages, modules and scenes.
SUFFIXES = (".html", ".htm", *MODULES, ".json")
#: Size of the preview picture.
PREVIEW = (480, 300)
#: Valid host names, which have no characters with a meaning in a page's policy.
HOST = re.compile(r"[A-Za-z0-9.-]+|\[[0-9A-Fa-f:.]+\]")
EXPECTED = (
    "expected the address from which a browser reads the store, such as "
    "'https://bucket.s3.eu-central-1.amazonaws.com/flow.zarr', or one relative to the page, such "
    "as './flow.zarr'"
)
#: Address from which pages load MapLibre.
MAPLIBRE = "https://unpkg.com/maplibre-gl@6.17.0/dist"
#: Files of MapLibre, the style last, with the digests that browsers compare.
MAPLIBRE_DIGESTS = {
    "maplibre-gl.mjs": "sha384-pghUwrZY2q/5xc+bZCYbeUP4JsNuZEmG8j+ZvzJMC1DOy3Rdj5AhRNThLRAiEjSb",
    "maplibre-gl-worker.mjs": (
        "sha384-3TQUOa/0LGT7Cx/33YaLIs5RPzqGBCUAlmA8ht2ofWIP6UugFoidHfikpRijBozF"
    ),
    "maplibre-gl.css": "sha384-S+OnE5M4U3Qc2nR0RgljGrVs06xqfRg8L7uFk/pOF5+sRuSDG4oKkqKZmFrx7w09",
}


@dataclass(frozen=True)
class Page:
    """A page that was written.

    Attributes
    ----------
    path
        The file.
    nbytes
        Its size.
    steps
        Number of time steps in it.

    Examples
    --------
    >>> import flowtex
    >>> page = flowtex.export(flowtex.examples.delta_wing_field(), "wing.html", samples=15)
    >>> page.path.name, page.steps, page.nbytes < 1_000_000
    ('wing.html', 1, True)
    """

    path: Path
    nbytes: int
    steps: int


@takes_arrays()
@accepts_options(FieldOptions, Appearance, ViewOptions)
def export(
    mesh: Any,
    path: str | Path,
    *,
    steps: int | None = None,
    title: str | None = None,
    store: str | None = None,
    basemap: str | Mapping[str, object] | None = None,
    **options: Any,
) -> Page:
    """Write a flow as one file that needs neither a server nor a network.

    The file is an HTML page or, if its name ends in ``.mjs`` or ``.js``, a module that other pages
    import. The module exports ``mount(element, settings, height)``, and the ``render`` of an
    anywidget module, which MyST's directive ``{anywidget}`` calls. A name that ends in ``.json``
    gives the scene alone, without a client: what ``flowtex-maplibre`` shows as a layer of a web map
    (``projection="mercator"``).

    With ``store`` the file contains only the coarsest level of a pyramid, and reads tiles and time
    steps from the pyramid in a bucket or on any web server.

    Parameters
    ----------
    mesh
        PyVista mesh, list of meshes in time, xarray dataset, :class:`~flowtex.FlowField`, path of a
        file, plain arrays by position, ``x, y, u, v`` as in ``plt.streamplot``, or a plotter with a
        flow texture, whose page also shows its other meshes and its labels.
    path
        File to write, such as ``"page.html"``, ``"flow.mjs"`` or ``"flow.json"``; an existing file
        is replaced when the new one is complete.
    steps
        Number of time steps to keep, evenly spaced, including the first and the last; all by
        default. A single step is drawn as a steady flow.
    title
        Title of the page; the name of the field by default.
    store
        Address at which browsers find the store ``mesh``, such as
        ``"https://bucket.s3.eu-central-1.amazonaws.com/flow.zarr"``, or relative to the file,
        ``"./flow.zarr"``. Everybody who opens the page must have permission to read it.
    basemap
        Style of a web map, of which the flow, in ``projection="mercator"``, is a layer: an address,
        such as ``"https://demotiles.maplibre.org/style.json"``, or a dictionary. Such a page loads
        MapLibre and the map from the network.
    {options}

    Returns
    -------
    Page

    Raises
    ------
    FieldError, SettingsError
        When the mesh, the store or a setting is invalid, or ``steps`` is not positive.
    OSError
        When the file cannot be written; an existing file stays unchanged.

    Examples
    --------
    >>> import flowtex
    >>> series = flowtex.examples.cylinder_series()
    >>> flowtex.export(series, "wake.html", steps=6, scalars="vorticity")  # doctest: +SKIP
    """
    path = checked_target(path)
    if path.suffix.lower() not in SUFFIXES:
        raise FieldError(
            f"path is {str(path)!r}; expected a name that ends in {', '.join(SUFFIXES)}"
        )
    with opened_views(mesh, steps=steps, **options) as (views, shown):
        return write_page(views, path, store=store, basemap=basemap, title=title, **shown)


@contextmanager
def opened_views(
    mesh: Any, *, steps: int | None = None, **options: Any
) -> Iterator[tuple[tuple[WebView, ...], dict[str, Any]]]:
    """Yield the views of a mesh, and how they are shown at first: camera and axes."""
    shown, arguments = browser_options(mesh, **options)
    views = web_views(shown, arguments, steps=steps)
    view = arguments.view
    try:
        camera = view.first_camera(views[0].field.surface).to_dict()
        yield views, {"camera": camera, "axes": view.axes}
    finally:
        for each in views:
            each.close()


def write_page(
    views: Sequence[WebView],
    path: str | Path,
    *,
    store: str | None = None,
    basemap: str | Mapping[str, object] | None = None,
    **options: Any,
) -> Page:
    """Write a view, or two side by side, as a page.

    ``store`` and ``basemap`` are as for :func:`export`, the options as for :func:`contents_of`.
    """
    path = checked_target(path)
    if basemap is not None:
        check_basemap(basemap, path, views)
    contents = contents_of(views, store, **options)
    suffix = path.suffix.lower()
    if suffix in MODULES:
        pieces = module_pieces
    else:
        pieces = page_pieces
    if basemap is not None:
        pieces = partial(map_pieces, basemap)
    elif suffix == ".json":
        pieces = scene_pieces
    with whole_file(path) as file:
        for text in pieces(contents):
            file.write(text.encode())
    return Page(path, path.stat().st_size, contents.steps)


def page_text(views: Sequence[WebView], *, store: str | None = None, **options: Any) -> str:
    """Return views as the text of a page; the arguments are as for :func:`write_page`."""
    return "".join(page_pieces(contents_of(views, store, **options)))


def _with_tiles(scene: ClientData, packed: PackedParts) -> ClientData:
    """Return a scene with as many finer levels as fit into a page, and pack its coarsest one."""
    pyramid = scene.pyramid
    if pyramid is None:
        return scene
    finest = pyramid.depth
    if scene.traced:
        room = float(TILE_BYTES)
    else:
        room = float(min(TILE_BYTES, SLICE_BYTES))
    coarse = replace(scene, finest=finest)
    size = packed.size(coarse.surface()) + scene.steps * packed.size(scene.step(0))
    size_by_node = size / math.prod(pyramid.shape(pyramid.depth))
    while finest:
        room -= size_by_node * math.prod(pyramid.shape(finest - 1))
        if room < 0:
            break
        finest -= 1
    if finest == pyramid.depth:
        pyramid = None
    return replace(scene, pyramid=pyramid, finest=finest)


class PackedParts:
    """Parts of a page that are packed once, although their size is needed before."""

    def __init__(self) -> None:
        self._packed: dict[str, tuple[Header, str]] = {}

    def size(self, parts: Parts) -> int:
        """Return the number of characters of parts in a page."""
        size = 0
        for name, part in parts.items():
            size += len(self.keep(part_info(name, part)["digest"], part)[1])
        return size

    def keep(self, digest: str, part: AnyArray) -> tuple[Header, str]:
        """Return how a part with a digest is packed, and its text, and keep both until taken."""
        if digest not in self._packed:
            self._packed[digest] = part_text(part)
        return self._packed[digest]

    def take(self, digest: str, part: AnyArray) -> tuple[Header, str]:
        """Return what was kept of a part, or pack it."""
        kept = self._packed.pop(digest, None)
        if kept is None:
            return part_text(part)
        return kept


@dataclass(frozen=True)
class Contents:
    """What a file has of views: headers, and parts, each packed when its turn comes."""

    view: WebView  #: The first one.
    headers: list[Header]
    parts: Iterator[tuple[int, Header, str]]
    steps: int
    time: float | None
    source: str  #: Source of the store in a page's policy; empty without a store.
    picture: bytes | None

    @property
    def title(self) -> str:
        """Title of a page as HTML."""
        return html.escape(self.headers[0]["name"] or "Flow")


def contents_of(
    views: Sequence[WebView],
    store: str | None = None,
    *,
    title: str | None = None,
    axes: str | None = None,
    time: float | None = None,
    picture: bytes | None = None,
    **shown: Any,
) -> Contents:
    """Return what a file has of views.

    ``axes`` is as for :class:`~flowtex.scene.options.ViewOptions`; camera, time and clock are as
    for :meth:`ClientData.header`. ``picture`` is a PNG or JPEG that is shown until the page has
    drawn, by default a preview. ``store`` is the address of the store from which tiles are read.
    """
    if store is None:
        source = ""
    else:
        source = source_of(store)
    headers = []
    scenes = []
    packed = PackedParts()
    for view in views:
        if store is None:
            stored = None
        else:
            stored = _stored(view)
        if stored is None:
            scene = _with_tiles(view.page_data(), packed)
        else:
            scene = linked_data(view, stored)
        header = scene.header(view.scene.settings, time=time, **shown)
        header["name"] = str(title or "") or header["name"]
        if axes is not None:
            header["axes"] = axes
        if stored is not None:
            header["store"] = store_header(stored, scene, store)
        if len(views) > 1:
            header["differs"] = list(views[1].own_settings)
        headers.append(header)
        scenes.append(scene)
    parts = _packed(scenes, time, packed, is_linked=store is not None)
    return Contents(views[0], headers, parts, scenes[0].steps, time, source, picture)


def page_pieces(contents: Contents) -> Iterator[str]:
    """Yield the text of a page piece by piece."""
    headers = contents.headers
    source = contents.source
    picture = contents.picture
    ground = headers[0]["background"]
    if picture is None:
        picture = still.preview_png(
            contents.view, PREVIEW, camera=headers[0]["camera"], time=contents.time, coarser=1
        )
    # A browser has its own colour for light and for dark pages.
    if ground is None:
        background = "Canvas"
    else:
        red, green, blue = np.multiply(255, ground)
        background = f"rgb({red:.0f} {green:.0f} {blue:.0f})"
    # Inline styles, and at most a store's server.
    allowed = "style-src 'unsafe-inline'; "
    opened = ""
    if source:
        allowed += f"connect-src {source}; "
        opened = "flowtexStore.open"
    client = f"\n{client_script(with_store=bool(source))}\nflowtex.openPage({opened});\n"
    look = string.Template(asset("page.css").read_text("utf-8")).substitute(background=background)
    yield from _page(
        "page.html",
        contents,
        map(_part_element, contents.parts),
        client,
        allowed=allowed + "img-src data: blob:",
        style=look,
        # Browsers recognise JPEG.
        preview="data:image/png;base64," + base64.b64encode(picture).decode(),
        headers=zipped(headers_text(headers).encode()),
    )


def module_pieces(contents: Contents) -> Iterator[str]:
    """Yield the text of a module piece by piece."""
    parts = (json_text(part) + ",\n" for part in contents.parts)
    store = ""
    if contents.source:
        store = ", flowtexStore.open"
    yield from _filled(
        "scene.mjs",
        parts,
        script=client_script(with_store=bool(contents.source)),
        headers=headers_text(contents.headers),
        store=store,
    )


def scene_pieces(contents: Contents) -> Iterator[str]:
    """Yield the JSON text of a scene in pieces."""
    yield f'{{"headers": {headers_text(contents.headers)}, "parts": ['
    separator = ""
    for packed in contents.parts:
        yield separator + json_text(packed)
        separator = ",\n"
    yield "]}\n"


def map_pieces(basemap: str | Mapping[str, object], contents: Contents) -> Iterator[str]:
    """Yield the text of the page of a web map in pieces."""
    links = []
    kinds = ('preload" as="fetch" data-module=""',) * 2 + ('stylesheet"',)
    for kind, (name, digest) in zip(kinds, MAPLIBRE_DIGESTS.items(), strict=True):
        links.append(
            f'<link rel="{kind} href="{MAPLIBRE}/{name}" integrity="{digest}" '
            'crossorigin="anonymous">'
        )
    anywhere = "'self' https: http: data: blob:"  # a style names servers of its own
    yield from _page(
        "map.html",
        contents,
        scene_pieces(contents),
        asset("map.mjs").read_text("utf-8"),
        # The page compares the digests of MapLibre, and runs copies from blob addresses.
        scripts=" blob:",
        allowed=f"worker-src data: blob:; style-src 'unsafe-inline' {MAPLIBRE}/; "
        f"connect-src {anywhere}; img-src {anywhere}",
        links="\n".join(links),
        layer=_inline(asset("maplibre.js").read_text("utf-8")),
        basemap=json_text(basemap),
    )


def _page(
    name: str,
    contents: Contents,
    parts: Iterator[str],
    script: str,
    *,
    allowed: str,
    scripts: str = "",
    **values: str,
) -> Iterator[str]:
    """Yield the text of a page whose policy allows one script, by its digest."""
    script = _inline(script)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    policy = (
        f"default-src 'none'; script-src 'sha256-{digest}'{scripts}; {allowed}; "
        "base-uri 'none'; form-action 'none'"
    )
    fixed = {"version": __version__, "title": contents.title, "policy": policy, "script": script}
    yield from _filled(name, parts, **fixed, **values)


def _inline(script: str) -> str:
    return script.replace("</script", r"<\/script").replace("<!--", r"<\!--")


def _filled(name: str, parts: Iterator[str], **values: str) -> Iterator[str]:
    """Yield a template with values in place of its names, and parts in the middle."""
    before, after = re.split(r"\$(?:parts|scene)\n", asset(name).read_text("utf-8"))
    yield string.Template(before).substitute(values)
    yield from parts
    yield string.Template(after).substitute(values)


def headers_text(headers: Sequence[Header]) -> str:
    """Return headers as JSON, and of the second what differs from the first."""
    first, *others = headers
    written = [first]
    for header in others:
        differing = {}
        for name, value in header.items():
            if value != first[name]:
                differing[name] = value
        written.append(differing)
    return json_text(written)


def _part_element(part: tuple[int, Header, str]) -> str:
    """Return the element of a page that contains a part of :func:`_packed`."""
    number, info, text = part
    attributes = f'data-view="{number}" data-part="{html.escape(json.dumps(info))}"'
    return f'<script type="text/plain" {attributes}>{text}</script>\n'


def json_text(value: object) -> str:
    """Return JSON in which nothing can end a script element."""
    text = json.dumps(value, allow_nan=False, separators=(",", ":"))
    return text.replace("<", r"\u003c").replace(">", r"\u003e").replace("&", r"\u0026")


def _packed(
    scenes: Sequence[ClientData], time: float | None, packed: PackedParts, *, is_linked: bool
) -> Iterator[tuple[int, Header, str]]:
    """Yield each part of a page: number of its scene, header entry, and text if it is new."""
    written: dict[str, Header] = {}
    for n, scene in enumerate(scenes):
        names: set[str] = set()
        parts: Iterator[Parts]
        if not is_linked:
            steps = track(range(scene.steps), scene.steps, "Packing time steps")
            tiles = TileSource(scene, budget=0).tiles()
            parts = chain([scene.surface()], map(scene.step, steps), tiles)
        elif time is None:
            parts = iter([first_parts(scene, scene.first_time)])
        else:
            parts = iter([first_parts(scene, time)])
        for name, array in chain.from_iterable(map(dict.items, parts)):
            if name in names:  # values of all times are parts of each step
                continue
            names.add(name)
            info = part_info(name, array)
            text = ""
            if info["digest"] not in written:
                written[info["digest"]], text = packed.take(info["digest"], array)
            yield n, info | written[info["digest"]], text


def source_of(store: str) -> str:
    """Return the source to which the policy of a page allows connections for its store.

    Raises
    ------
    FieldError
        When the address is unreadable, or contains a name, a password or a query.
    """
    if not isinstance(store, str):
        raise FieldError(f"store is {store!r}; expected an address, such as './flow.zarr'")
    parts = urlsplit(store)
    if parts.query or parts.fragment or "@" in parts.netloc:
        raise FieldError(
            "the address of the store contains a name, a password, a signature or another query, "
            "which everyone could read in the page; give the address alone, and grant read access "
            "to everyone who may see the page"
        )
    if not parts.scheme and not parts.netloc and re.match(r"[^/\\~\s]", store):
        return "'self'"
    try:
        host = parts.hostname or ""
        port = parts.port
    except ValueError:
        host = ""
        port = None
    if parts.scheme not in ("http", "https") or not HOST.fullmatch(host):
        if "://" in store:
            hint = "; s3:// and other object storage have such an address too"
        else:
            hint = ""
        raise FieldError(f"store is {store!r}; {EXPECTED}{hint}")
    if port:
        return f"{parts.scheme}://{host}:{port}"
    return f"{parts.scheme}://{host}"


def linked_data(view: WebView, stored: StoredPyramid) -> ClientData:
    """Return the data of a page for a view whose tiles are in a store."""
    data = view.page_data()
    if not stored.about.get("complete"):
        notify("the store is incomplete; missing tiles are shown coarse", UserWarning)
    traces = data.textures.store.streamlines
    if not stored.depth:
        return replace(data, pyramid=None, traces=traces)
    return replace(data, pyramid=stored, traces=traces)


def store_header(stored: StoredPyramid, scene: ClientData, address: str | None) -> Header:
    """Return the part of the header about the store."""
    about = stored.about
    return {
        "url": address,
        "format": about["format"],
        "fingerprint": about["fingerprint"],
        "parameter": about["parameter"],
        "lines": about["lines"],
        "depth": stored.depth,
        "derivesSpeed": "speed" not in about["scalars"],
        "steps": [scene.source(step) for step in range(scene.steps)],
    }


def _stored(view: WebView) -> StoredPyramid:
    """Return the store from which a page can read its tiles; raise a FieldError without one."""
    scene = view.scene
    pyramid = scene.pyramid
    if scene.settings.noise != "procedural":
        raise FieldError(
            f"store is given, but tiles cannot be drawn with noise {scene.settings.noise!r}; omit "
            "one of them"
        )
    pyramid = pyramid or shared_pyramid(scene.field, scene.settings.parameter, scene.lines)
    if not isinstance(pyramid, StoredPyramid):
        raise FieldError(
            "store is given, but the flow is not read from a flowtex store, and only such a "
            "store has tiles for browsers. Build it with `flowtex pyramid FILE -o flow.zarr` "
            "and export that, or omit store for a page with as many levels as fit"
        )
    about = pyramid.about
    if (pyramid.parameter, pyramid.lines) != (about["parameter"], about["lines"]):
        raise FieldError(
            f"the store has paths with parameter={about['parameter']!r} along {about['lines']}; "
            f"expected {pyramid.parameter!r} along {pyramid.lines}. Export with the settings of "
            "the store, or build another"
        )
    return pyramid


def check_basemap(basemap: object, path: Path, views: Sequence[WebView]) -> None:
    """Check that a web map has a style, and can show the views of a page.

    Parameters
    ----------
    basemap
        Address of a MapLibre style, or the style as a dictionary.
    path
        File of the page.
    views
        The views of the page.

    Raises
    ------
    FieldError
        When the path is no HTML page, the style is neither an address nor a dictionary with layers,
        the flow is not in Mercator's projection, or the page has two views.
    """
    if path.suffix.lower() not in (".html", ".htm"):
        raise FieldError(
            f"basemap is given, and path is {path.name!r}; expected a page, such as 'map.html'"
        )
    is_address = isinstance(basemap, str) and urlsplit(basemap).scheme in ("http", "https")
    if not is_address and not (isinstance(basemap, Mapping) and "layers" in basemap):
        raise FieldError(
            f"basemap is {basemap!r}; expected the address of a style of MapLibre, such as "
            "'https://demotiles.maplibre.org/style.json', or a style as a dictionary"
        )
    projection = views[0].scene.field.projection
    if projection is None or projection.family != "mercator":
        if projection is None:
            shown = "no map"
        else:
            shown = f"the map {projection.name!r}"
        raise FieldError(
            f"basemap is given, but the flow is on {shown}; web maps are in Mercator's projection: "
            "give projection='mercator', or build the store with it"
        )
    if len(views) > 1:
        raise FieldError("basemap is given, but beside makes two views; omit one of them")
