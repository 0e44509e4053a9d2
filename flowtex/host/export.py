"""A flow as one file that needs no server: an HTML page, or a module for one.

The client, its style, the header and all arrays lie in the file. The header and the arrays are
gzipped, the arrays with bytes of equal significance side by side, where slopes are similar, and
written in base64. A page's Content-Security-Policy allows only the script with its digest, and no
requests.

A page of a pyramid in a store may have the coarsest level and one moment alone, and read the rest
from the store: its policy names the server of the store. A page with a web map, of which the flow
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
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from flowtex._util import __version__
from flowtex._util.arguments import checked_target
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
from flowtex.scene.options import Appearance, ViewOptions
from flowtex.textures.tiles.shared import shared_pyramid

#: Size of slices and of values after packing, over that before, base64 included.
PACKED_SHARE, VALUES_SHARE = 0.45, 0.75
#: Bytes of the tiles of a large surface, at most; all of a level are in a page, or none.
TILE_BYTES = 40_000_000
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
        file, or a plotter with a flow texture, whose page also shows its other meshes and its
        labels.
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
    shown, arguments = browser_options(mesh, **options)
    views = web_views(shown, arguments, steps=steps)
    try:
        camera = arguments.view.first_camera(views[0].field.surface).to_dict()
        shown = {"camera": camera, "title": title, "axes": arguments.view.axes}
        return write_page(views, path, store=store, basemap=basemap, **shown)
    finally:
        for view in views:
            view.close()


def write_page(
    views: Sequence[WebView],
    path: str | Path,
    *,
    store: str | None = None,
    basemap: str | Mapping[str, object] | None = None,
    **options: Any,
) -> Page:
    """Write a view, or two side by side, as a page.

    ``store`` and ``basemap`` are those of :func:`export`, the options those of :func:`contents_of`.
    """
    path = checked_target(path)
    if basemap is not None:
        check_basemap(basemap, path, views)
    contents = contents_of(views, store, **options)
    suffix = path.suffix.lower()
    pieces = module_pieces if suffix in MODULES else page_pieces
    if basemap is not None:
        pieces = partial(map_pieces, basemap)
    elif suffix == ".json":
        pieces = scene_pieces
    with whole_file(path) as file:
        file.writelines(text.encode() for text in pieces(contents))
    return Page(path, path.stat().st_size, contents.steps)


def page_text(views: Sequence[WebView], *, store: str | None = None, **options: Any) -> str:
    """Return views as the text of a page; the arguments are those of :func:`write_page`."""
    return "".join(page_pieces(contents_of(views, store, **options)))


def page_data(views: Sequence[WebView]) -> list[ClientData]:
    """Return the data of views in a page, with as many levels of tiles as fit."""
    scenes = []
    for view in views:
        scene = view.page_data()
        pyramid, finest = scene.pyramid, 0
        if pyramid is not None:
            finest, room = pyramid.depth, float(TILE_BYTES)
            root = _arrays_bytes(scene) / math.prod(pyramid.shape(pyramid.depth))
            while finest and (room := room - root * math.prod(pyramid.shape(finest - 1))) >= 0:
                finest -= 1
            pyramid = pyramid if finest < pyramid.depth else None
        scenes.append(replace(scene, pyramid=pyramid, finest=finest))
    return scenes


def _arrays_bytes(scene: ClientData) -> float:
    """Estimate the packed bytes of the arrays of a scene without tiles; no slices are made."""
    surface = _packed_bytes(scene.surface())
    if scene.traced:
        return surface + scene.steps * _packed_bytes(scene.step(0))
    values = VALUES_SHARE * scene.nbytes_of_values
    return surface + scene.steps * (PACKED_SHARE * scene.nbytes_of_step + values)


def _packed_bytes(parts: Parts) -> int:
    return sum(len(part_text(part)[1]) for part in parts.values())


@dataclass(frozen=True)
class Contents:
    """What a file has of views: headers, and parts, each packed when its turn comes."""

    view: WebView  #: The first one.
    headers: list[Header]
    parts: Iterator[tuple[int, Header, str]]
    steps: int
    title: str
    time: float | None
    link: StoreLink | None
    picture: bytes | None


def contents_of(
    views: Sequence[WebView],
    store: str | None,
    *,
    title: str | None = None,
    axes: str | None = None,
    time: float | None = None,
    picture: bytes | None = None,
    **shown: Any,
) -> Contents:
    """Return what a file has of views.

    ``axes`` is that of :class:`~flowtex.scene.options.ViewOptions`. Camera, time and clock are
    those of :meth:`ClientData.header`; ``picture`` is a PNG or JPEG that is shown until the page
    has drawn, by default a preview. ``store`` is the address of the store that has the rest.
    """
    link = None if store is None else StoreLink.of(store)
    scenes = page_data(views) if link is None else [linked_data(view) for view in views]
    headers = []
    for view, scene in zip(views, scenes, strict=True):
        header = scene.header(view.scene.settings, time=time, **shown)
        header["name"] = str(title or "") or header["name"]
        if axes is not None:
            header["axes"] = axes
        if link is not None:
            header["store"] = store_header(view, scene, link)
        if len(views) > 1:
            header["differs"] = list(views[1].own_settings)
        headers.append(header)
    name, parts = headers[0]["name"] or "Flow", _packed(scenes, link, time)
    return Contents(views[0], headers, parts, scenes[0].steps, name, time, link, picture)


def page_pieces(contents: Contents) -> Iterator[str]:
    """Yield the text of a page piece by piece."""
    parts = (
        f'<script type="text/plain" data-view="{n}" data-part="{html.escape(json.dumps(info))}">'
        f"{text}</script>\n"
        for n, info, text in contents.parts
    )
    yield from _filled("page.html", parts, _values(contents))


def module_pieces(contents: Contents) -> Iterator[str]:
    """Yield the text of a module piece by piece."""
    values = {
        "script": client_script(with_store=contents.link is not None),
        "headers": headers_text(contents.headers),
        "store": "" if contents.link is None else ", flowtexStore.open",
    }
    yield from _filled("scene.mjs", (json_text(part) + ",\n" for part in contents.parts), values)


def scene_pieces(contents: Contents) -> Iterator[str]:
    """Yield the JSON text of a scene in pieces."""
    yield f'{{"headers": {headers_text(contents.headers)}, "parts": ['
    for n, packed in enumerate(contents.parts):
        yield (",\n" if n else "") + json_text(packed)
    yield "]}\n"


def map_pieces(basemap: str | Mapping[str, object], contents: Contents) -> Iterator[str]:
    """Yield the text of the page of a web map in pieces."""
    layer = asset("maplibre.js").read_text("utf-8")
    values = {
        "version": __version__,
        "title": html.escape(contents.title),
        "maplibre": MAPLIBRE,
        "script": layer.replace("</script", r"<\/script").replace("<!--", r"<\!--"),
        "style": json.dumps(basemap, allow_nan=False).replace("<", r"\u003c"),
    }
    yield from _filled("map.html", scene_pieces(contents), values)


def _filled(name: str, parts: Iterator[str], values: Mapping[str, str]) -> Iterator[str]:
    """Yield the text of a template with these parts, where it has a line for them."""
    before, after = re.split(r"\$(?:parts|scene)\n", asset(name).read_text("utf-8"))
    yield string.Template(before).substitute(values)
    yield from parts
    yield string.Template(after).substitute(values)


def headers_text(headers: Sequence[Header]) -> str:
    """Return headers as JSON, and of the second what differs from the first."""
    first, *others = headers
    return json_text([first, *({n: v for n, v in h.items() if v != first[n]} for h in others)])


def _values(contents: Contents) -> dict[str, str]:
    """Return the values of the placeholders in the page's template."""
    headers, link, picture = contents.headers, contents.link, contents.picture
    ground = headers[0]["background"]
    if picture is None:
        picture = still.preview_png(
            contents.view, PREVIEW, camera=headers[0]["camera"], time=contents.time, coarser=1
        )
    # A browser has its own colour for light and for dark pages.
    background = (
        "Canvas" if ground is None else f"rgb({' '.join(f'{255 * c:.0f}' for c in ground)})"
    )
    opened = "" if link is None else "flowtexStore.open"
    client = f"{client_script(with_store=link is not None)}\nflowtex.openPage({opened});\n"
    script = "\n" + client.replace("</script", r"<\/script").replace("<!--", r"<\!--")
    # One script by its digest, inline styles, and at most a store's server.
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    policy = (
        f"default-src 'none'; script-src 'sha256-{digest}'; style-src 'unsafe-inline'; "
        + ("" if link is None else f"connect-src {link.source}; ")
        + "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )
    look = string.Template(asset("page.css").read_text("utf-8")).substitute(background=background)
    return {
        "policy": policy,
        "version": __version__,
        "title": html.escape(contents.title),
        "style": look,
        # Browsers recognise JPEG.
        "preview": "data:image/png;base64," + base64.b64encode(picture).decode(),
        "headers": zipped(headers_text(headers).encode()),
        "script": script,
    }


def json_text(value: object) -> str:
    """Return JSON in which nothing can end a script element."""
    text = json.dumps(value, allow_nan=False, separators=(",", ":"))
    return text.replace("<", r"\u003c").replace(">", r"\u003e").replace("&", r"\u0026")


def _packed(
    scenes: Sequence[ClientData], link: StoreLink | None, time: float | None
) -> Iterator[tuple[int, Header, str]]:
    """Yield view, description and text of the parts of all views; equal arrays once."""
    written: dict[str, Header] = {}
    for n, scene in enumerate(scenes):
        names: set[str] = set()
        if link is None:
            steps = track(range(scene.steps), scene.steps, "Packing time steps")
            tiles = TileSource(scene, budget=0).tiles()
            parts = chain([scene.surface()], map(scene.step, steps), tiles)
        else:
            parts = chain([first_parts(scene, scene.times[0] if time is None else time)])
        for name, array in chain.from_iterable(part.items() for part in parts):
            if name in names:  # values of all times are parts of each step
                continue
            names.add(name)
            info, text = part_info(name, array), ""
            if info["digest"] not in written:
                written[info["digest"]], text = part_text(array)
            yield n, info | written[info["digest"]], text


@dataclass(frozen=True)
class StoreLink:
    """Where a page finds its store."""

    address: str  #: A URL, whole or from the page on.
    source: str  #: Source to which the page's policy allows connections.

    @classmethod
    def of(cls, text: str) -> StoreLink:
        """Return the link of an address; a FieldError if it is unreadable or contains secrets."""
        if not isinstance(text, str):
            raise FieldError(f"store is {text!r}; expected an address, such as './flow.zarr'")
        parts = urlsplit(text)
        if parts.query or parts.fragment or "@" in parts.netloc:
            raise FieldError(
                "the address of the store contains a name, a password, a signature or another "
                "query, which everyone could read in the page; give the address alone, and grant "
                "read access to everyone who may see the page"
            )
        if not parts.scheme and not parts.netloc and re.match(r"[^/\\~\s]", text):
            return cls(text, "'self'")
        try:
            host, port = parts.hostname or "", parts.port
        except ValueError:
            host, port = "", None
        if parts.scheme not in ("http", "https") or not HOST.fullmatch(host):
            hint = (
                "; s3:// and other object storage have such an address too" if "://" in text else ""
            )
            raise FieldError(f"store is {text!r}; {EXPECTED}{hint}")
        return cls(text, f"{parts.scheme}://{host}" + (f":{port}" if port else ""))


def linked_data(view: WebView) -> ClientData:
    """Return the data of a page for a view whose tiles are in a store, which must be the same."""
    stored, data = _stored(view), view.page_data()
    if not stored.about.get("complete"):
        notify("the store is incomplete; missing tiles are shown coarse", UserWarning)
    return replace(
        data, pyramid=stored if stored.depth else None, traces=data.textures.store.streamlines
    )


def store_header(view: WebView, scene: ClientData, link: StoreLink) -> Header:
    """Return the part of the header about the store."""
    stored = _stored(view)
    return {
        "url": link.address,
        **{name: stored.about[name] for name in ("format", "fingerprint", "parameter", "lines")},
        "depth": stored.depth,
        "derivesSpeed": "speed" not in stored.about["scalars"],
        "steps": [scene.source(step) for step in range(scene.steps)],
    }


def _stored(view: WebView) -> StoredPyramid:
    scene = view.scene
    pyramid = scene.pyramid
    if scene.settings.noise != "procedural":
        raise FieldError(
            f"store is given, but tiles cannot be drawn with noise {scene.settings.noise!r}; omit "
            "one of them"
        )
    pyramid = pyramid or shared_pyramid(scene.field, scene.settings.parameter, scene.lines)
    if not isinstance(pyramid, StoredPyramid) or "fingerprint" not in pyramid.about:
        place = pyramid.about["place"] if isinstance(pyramid, StoredPyramid) else "FILE"
        raise FieldError(
            "store is given, but the flow is not read from a flowtex store, and only such a "
            f"store has tiles for browsers. Build it with `flowtex pyramid {place} -o flow.zarr` "
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
    """Raise a FieldError when a map has no style, or cannot show the views of a page."""
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
        shown = "no map" if projection is None else f"the map {projection.name!r}"
        raise FieldError(
            f"basemap is given, but the flow is on {shown}; web maps are in Mercator's projection: "
            "give projection='mercator', or build the store with it"
        )
    if len(views) > 1:
        raise FieldError("basemap is given, but beside makes two views; omit one of them")
