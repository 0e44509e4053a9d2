"""Pages that load more: the tiles of a store, or a web map of which the flow is a layer.

The page of a store has the root of its pyramid. MapLibre and the map come from elsewhere.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from urllib.parse import urlsplit

from flowtex._util.notices import notify
from flowtex.errors import FieldError
from flowtex.pyramid.stored import StoredPyramid
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.rendering.webgl.protocol import Header, Parts
from flowtex.textures.tiles.shared import shared_pyramid
from flowtex.web.view import WebView

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
class StoreLink:
    """Where a page finds its store."""

    address: str  #: A URL, whole or from the page on.
    source: str  #: Source to which the page's policy allows connections.

    @classmethod
    def of(cls, text: str) -> StoreLink:
        """Return the link of an address; a FieldError if it is unreadable or contains secrets."""
        if not isinstance(text, str):
            msg = f"store is {text!r}; expected an address, such as './flow.zarr'"
            raise FieldError(msg)
        parts = urlsplit(text)
        if parts.query or parts.fragment or "@" in parts.netloc:
            msg = (
                "the address of the store contains a name, a password, a signature or another "
                "query, which everyone could read in the page; give the address alone, and grant "
                "read access to everyone who may see the page"
            )
            raise FieldError(msg)
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
            msg = f"store is {text!r}; {EXPECTED}{hint}"
            raise FieldError(msg)
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


def first_parts(scene: ClientData, time: float | None) -> Parts:
    """Return the arrays with which a page begins: the surface, and one moment."""
    parts = scene.surface()
    for step in scene.moment(float(scene.times[0] if time is None else time)):
        parts |= scene.values(step, shown=True)
        step_parts = scene.step(step)
        parts |= {name: step_parts[name] for name in step_parts if not name.startswith("scalars/")}
    return parts


def _stored(view: WebView) -> StoredPyramid:
    """Return the pyramid in a store that a view shows."""
    scene = view.scene
    pyramid = scene.pyramid
    if scene.settings.noise != "procedural":
        msg = (
            f"store is given, but tiles cannot be drawn with noise {scene.settings.noise!r}; omit "
            "one of them"
        )
        raise FieldError(msg)
    pyramid = pyramid or shared_pyramid(scene.field, scene.settings.parameter, scene.lines)
    if not isinstance(pyramid, StoredPyramid) or "fingerprint" not in pyramid.about:
        place = pyramid.about["place"] if isinstance(pyramid, StoredPyramid) else "FILE"
        msg = (
            "store is given, but the flow is not read from a flowtex store, and only such a "
            f"store has tiles for browsers. Build it with `flowtex pyramid {place} -o flow.zarr` "
            "and export that, or omit store for a page with as many levels as fit"
        )
        raise FieldError(msg)
    about = pyramid.about
    if (pyramid.parameter, pyramid.lines) != (about["parameter"], about["lines"]):
        msg = (
            f"the store has paths with parameter={about['parameter']!r} along {about['lines']}; "
            f"expected {pyramid.parameter!r} along {pyramid.lines}. Export with the settings of "
            "the store, or build another"
        )
        raise FieldError(msg)
    return pyramid


def check_basemap(basemap: object, path: Path, views: Sequence[WebView]) -> None:
    """Raise a FieldError when a map has no style, or cannot show the views of a page."""
    if path.suffix.lower() not in (".html", ".htm"):
        msg = f"basemap is given, and path is {path.name!r}; expected a page, such as 'map.html'"
        raise FieldError(msg)
    is_address = isinstance(basemap, str) and urlsplit(basemap).scheme in ("http", "https")
    if not is_address and not (isinstance(basemap, Mapping) and "layers" in basemap):
        msg = (
            f"basemap is {basemap!r}; expected the address of a style of MapLibre, such as "
            "'https://demotiles.maplibre.org/style.json', or a style as a dictionary"
        )
        raise FieldError(msg)
    projection = views[0].scene.field.projection
    if projection is None or projection.family != "mercator":
        shown = "no map" if projection is None else f"the map {projection.name!r}"
        msg = (
            f"basemap is given, but the flow is on {shown}; web maps are in Mercator's projection: "
            "give projection='mercator', or build the store with it"
        )
        raise FieldError(msg)
    if len(views) > 1:
        msg = "basemap is given, but beside makes two views; omit one of them"
        raise FieldError(msg)
