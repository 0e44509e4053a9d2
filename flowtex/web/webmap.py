"""Pages with a web map, of which the flow is a layer. MapLibre and the map come from elsewhere."""

from __future__ import annotations

import html
import json
import string
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from urllib.parse import urlsplit

from flowtex._util import __version__
from flowtex.errors import FieldError
from flowtex.web.assets import asset
from flowtex.web.view import WebView

#: Address from which pages load MapLibre.
MAPLIBRE = "https://unpkg.com/maplibre-gl@6.17.0/dist"


def layer_script() -> str:
    """Return the layer as the text of a module."""
    return asset("maplibre.js").read_text("utf-8")


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


def map_pieces(
    scene: Iterator[str], basemap: str | Mapping[str, object], title: str
) -> Iterator[str]:
    """Yield the text of a page piece by piece, from the pieces of a scene in JSON."""
    before, after = asset("map.html").read_text("utf-8").split("$scene\n")
    style = json.dumps(basemap, allow_nan=False).replace("<", r"\u003c")
    values = {
        "version": __version__,
        "title": html.escape(title),
        "maplibre": MAPLIBRE,
        "script": layer_script().replace("</script", r"<\/script").replace("<!--", r"<\!--"),
        "style": style,
    }
    yield string.Template(before).substitute(values)
    yield from scene
    yield string.Template(after).substitute(values)
