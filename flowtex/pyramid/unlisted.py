"""Stores on web servers that list no files, without consolidated metadata.

The entries of such a store are found by their names: levels that its attributes list, the
components of the velocity, and the dimensions and coordinates that arrays name.
"""

from __future__ import annotations

import json
from collections.abc import AsyncIterator, Iterable, Iterator
from typing import Any

from zarr.abc.store import Store
from zarr.buffer import default_buffer_prototype
from zarr.storage import WrapperStore

from flowtex.pyramid.places import is_refused

#: Names of components that are tried if none are given.
USUAL_NAMES = ("u", "v", "u10", "v10", "uo", "vo", "water_u", "water_v", "U", "V", "ugos", "vgos")
MOST_NAMES = 200  #: Most names that are tried in one group.
GROUPS = ("zarr.json", ".zgroup")  #: Documents of groups.
ARRAYS = ("zarr.json", ".zarray")  #: Documents of arrays.


class UnlistedStore(WrapperStore[Store]):
    """A store of Zarr's whose entries are found by their names where it cannot be listed."""

    def __init__(self, store: Store, names: Iterable[str] = ()) -> None:
        super().__init__(store)
        self._names = tuple(names) or USUAL_NAMES
        self.was_listed = True  #: Whether the server has listed its files.
        self._found: dict[str, list[str]] = {}  # names of entries by the path of their group

    async def list_dir(self, prefix: str) -> AsyncIterator[str]:
        """Yield the names of the entries of a group."""
        if prefix not in self._found:
            self._found[prefix] = await self._names_in(prefix)
        for name in self._found[prefix]:
            yield name

    async def _names_in(self, prefix: str) -> list[str]:
        """Return the names of the entries of a group; after one failure no list is requested."""
        if self.was_listed:
            try:
                return [name async for name in self._store.list_dir(prefix)]
            except Exception:  # each server answers in its own way
                self.was_listed = False
        return await self._find(prefix)

    async def _find(self, prefix: str) -> list[str]:
        """Return the names of entries that exist, of those that the documents of a group name."""
        attributes = await self._attributes(prefix)
        found = []
        for name in levels_of(attributes):
            if await self._exists(prefix, name, GROUPS):
                found.append(name)
        waiting = list(self._names)
        tried: set[str] = set()
        while waiting and len(tried) < MOST_NAMES:
            name = waiting.pop()
            if name in tried:
                continue
            tried.add(name)
            if await self._exists(prefix, name, ARRAYS):
                found.append(name)
                waiting += await self._named_by(_joined(prefix, name))
        return list(dict.fromkeys(found))

    async def _named_by(self, path: str) -> list[str]:
        """Return the names of the dimensions and coordinates of an array."""
        document = await self._document(_joined(path, "zarr.json"))
        attributes = await self._attributes(path)
        names = [document.get("dimension_names"), attributes.get("_ARRAY_DIMENSIONS")]
        coordinates = attributes.get("coordinates")
        if isinstance(coordinates, str):
            names.append(coordinates.split())
        found = []
        for each in names:
            if isinstance(each, list):
                found += [name for name in each if is_name(name)]
        return found

    async def _attributes(self, path: str) -> dict[str, Any]:
        """Return the attributes of a group or an array, of either format."""
        document = await self._document(_joined(path, "zarr.json"))
        attributes = document.get("attributes")
        if not isinstance(attributes, dict):
            attributes = await self._document(_joined(path, ".zattrs"))
        return attributes

    async def _exists(self, prefix: str, name: str, documents: Iterable[str]) -> bool:
        """Return whether one of these documents of an entry exists."""
        for document in documents:
            if await self._document(_joined(_joined(prefix, name), document)):
                return True
        return False

    async def _document(self, key: str) -> dict[str, Any]:
        """Return a document, or an empty one if the server has none."""
        try:
            data = await self._store.get(key, default_buffer_prototype())
        except Exception as error:
            if not is_refused(error):  # as some servers answer where an object is missing
                raise
            data = None
        if data is None:
            return {}
        try:
            document = json.loads(data.to_bytes())
        except (ValueError, RecursionError):
            return {}
        if isinstance(document, dict):
            return document
        return {}


def levels_of(attributes: dict[str, Any]) -> Iterator[str]:
    """Yield the names of the levels of resolution that the attributes of a group list."""
    multiscales = attributes.get("multiscales")
    if isinstance(multiscales, dict):
        multiscales = [multiscales]
    if not isinstance(multiscales, list):
        return
    for scale in multiscales[:MOST_NAMES]:
        if not isinstance(scale, dict):
            continue
        # The keys of OME-Zarr and of GeoZarr.
        for key, name in (("datasets", "path"), ("layout", "asset")):
            levels = scale.get(key)
            if not isinstance(levels, list):
                continue
            for level in levels[:MOST_NAMES]:
                if isinstance(level, dict) and is_name(level.get(name)):
                    yield level[name]


def is_name(value: object) -> bool:
    """Return whether a value is the name of an entry of a group."""
    return isinstance(value, str) and 0 < len(value) < MOST_NAMES and not set(value) & {"/", "\\"}


def _joined(prefix: str, name: str) -> str:
    """Return the path of an entry of a group."""
    if prefix:
        return f"{prefix}/{name}"
    return name
