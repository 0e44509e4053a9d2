"""What a page may open: the files it was given, by name.

From the page comes a name, never a path. Names are looked up among those of the files that were
found when the library was made or looked through again, so nothing outside them can be opened.
Files that are open, and the flows made from them, are kept for all pages of a server.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, TypeVar

from flowtex.app.controllers.folders import SUFFIXES, search
from flowtex.app.server.untrusted import shortened
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.source import FlowSource
from flowtex.settings import Settings
from flowtex.trace import SliceStore, shared_store

__all__ = ["Choice", "Library", "Opened"]

#: Files, and flows, that are kept open at most, and bytes of each of the two together; what was
#: asked for last is always kept.
SOURCES, FLOWS = 4, 12
SOURCE_BYTES, FLOW_BYTES = 2_000_000_000, 1_000_000_000

T = TypeVar("T", bound="_Sized")
Open = Callable[[], FlowSource]


@dataclass(frozen=True)
class Choice:
    """What is shown of a file.

    Attributes
    ----------
    vectors, plane, block
        As for :meth:`FlowSource.field`; empty for what that chooses by itself.
    """

    vectors: str = ""
    plane: str = ""
    block: str = ""


@dataclass(frozen=True)
class Opened:
    """A flow, with its traces so that they stay."""

    field: FlowField
    store: SliceStore | None = None

    @property
    def nbytes(self) -> int:
        """Bytes that are in memory for it."""
        return self.field.nbytes + (0 if self.store is None else self.store.nbytes)


#: How far in, and on what point of the mesh.
Look = tuple[float, tuple[float, ...] | None]


class _Sized(Protocol):
    @property
    def nbytes(self) -> int: ...


class Library:
    """Names of flows, and how each is opened.

    Parameters
    ----------
    entries
        What opens each, by name.
    folder
        A folder that is looked through for more.
    files
        Which of the entries are files.
    python
        Expressions of Python that make the entries' fields, by name, as far as they are known.
    looks
        How far in, and on what point, some of them are first seen; the others as a whole.

    Raises
    ------
    FieldError
        When there is nothing to open.
    """

    def __init__(
        self,
        entries: Mapping[str, Open],
        folder: Path | None = None,
        files: Iterable[str] = (),
        python: Mapping[str, str] | None = None,
        looks: Mapping[str, Look] | None = None,
    ) -> None:
        self._entries = dict(entries)
        self._files = frozenset(files)
        self._python = dict(python or {})
        self._looks = dict(looks or {})
        self._folder = None if folder is None else folder.resolve()
        self._sources: OrderedDict[str, FlowSource] = OrderedDict()
        self._flows: OrderedDict[tuple[str, Choice], Opened] = OrderedDict()
        self._lock = threading.RLock()
        self._gates: dict[str, threading.RLock] = {}
        if not self.names:
            endings = " ".join(sorted(SUFFIXES))
            msg = f"{folder}: there is no file in it that can be opened; expected {endings}"
            raise FieldError(msg)

    @classmethod
    def of(cls, *flows: Any, folder: str | Path | None = None, **options: Any) -> Library:
        """Make a library of whatever can be shown.

        Parameters
        ----------
        *flows
            Fields, meshes, paths of files, or one folder.
        folder
            A folder that is looked through for more.
        **options
            Arguments of :meth:`FlowField.from_pyvista` for meshes.

        Raises
        ------
        FieldError
            When a path leads nowhere, or a mesh makes no field.
        """
        if len(flows) == 1 and isinstance(flows[0], Library):
            return flows[0]
        if len(flows) == 1 and isinstance(flows[0], (str, Path)) and Path(flows[0]).is_dir():
            return cls({}, Path(flows[0]))
        entries: dict[str, Open] = {}
        files: list[str] = []
        for flow in flows:
            if isinstance(flow, (str, Path)):
                files.append(_free(Path(flow).name, entries))
                entries[files[-1]] = _opener(Path(flow))
                continue
            source = flow if isinstance(flow, FlowSource) else _made(flow, options)
            entries[_free(source.name or "flow", entries)] = _given(source)
        return cls(entries, None if folder is None else Path(folder), files)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all that can be opened; a folder is looked through anew."""
        found = dict(self._entries)
        if self._folder is not None:
            found |= {name: _opener(path) for name, path in search(self._folder)}
        self._found = found
        return tuple(found)

    def source(self, name: str) -> FlowSource:
        """Open one, or return it when it is open.

        Raises
        ------
        FieldError
            When there is none of that name, or it cannot be read.
        """
        with self._gate(name):
            with self._lock:
                if name in self._sources:
                    self._sources.move_to_end(name)
                    return self._sources[name]
            source = self._found[name]()
            with self._lock:
                self._sources[name] = source
                _trim(self._sources, SOURCES, SOURCE_BYTES)
            return source

    def _gate(self, name: str) -> threading.RLock:
        """Lock of one file: who opens a large one keeps nobody from the others.

        Raises
        ------
        FieldError
            When there is none of that name.
        """
        with self._lock:
            if name not in self._found:
                msg = (
                    f"there is no file {shortened(name, 80)!r} among those that may be opened here"
                )
                raise FieldError(msg)
            return self._gates.setdefault(name, threading.RLock())

    def is_file(self, name: str) -> bool:
        """Whether a name is that of a file."""
        return name in self._files or name not in self._entries

    def look(self, name: str) -> Look:
        """Return how far in, and on what point of the mesh, a flow is first seen."""
        return self._looks.get(name, (1.0, None))

    def python(self, name: str) -> str | None:
        """Return the expression that makes a flow, or ``None`` for what comes from a file."""
        if self.is_file(name):
            return None
        return self._python.get(name, "...  # the mesh or the field that was given")

    def complete(self, name: str, choice: Choice) -> Choice:
        """Fill in what is not chosen: the middle plane, the first array that may be the velocity.

        Raises
        ------
        FieldError
            As :meth:`source`.
        """
        source = self.source(name)
        block = choice.block or (source.blocks[0] if source.blocks else "")
        part = source.part(block or None)
        plane = choice.plane
        if not plane and part.planes:
            plane = f"k={part.planes['k'] // 2}"
        vectors = choice.vectors or (part.vectors[0] if part.vectors else "")
        return Choice(vectors, plane, block)

    def field(self, name: str, choice: Choice) -> FlowField:
        """Make a flow, or return it when it is at hand; nothing is traced.

        Raises
        ------
        FieldError
            When there is no such file, or what is chosen of it makes no flow.
        """
        known = self._flows.get((name, choice))
        if known is not None:
            return known.field
        with self._gate(name):
            return self.source(name).field(
                vectors=choice.vectors or None,
                plane=choice.plane or None,
                block=choice.block or None,
            )

    def trace(self, name: str, choice: Choice, field: FlowField, settings: Settings) -> Opened:
        """Make ready what the first picture of a flow needs, and keep it.

        Raises
        ------
        Stopped
            When that is not wanted any more, see :func:`flowtex._util.progress.stoppable`.
        """
        known = self._flows.get((name, choice))
        if known is not None and known.field is field and known.store is not None:
            with self._lock:
                if (name, choice) in self._flows:
                    self._flows.move_to_end((name, choice))
            return known
        store = shared_store(field, settings.parameter)
        store.at(len(field.times) - 1)
        opened = Opened(field, store)
        with self._lock:
            self._flows[name, choice] = opened
            self._flows.move_to_end((name, choice))
            _trim(self._flows, FLOWS, FLOW_BYTES)
        return opened


def _trim(kept: OrderedDict[Any, T], count: int, nbytes: int) -> None:
    """Let go of what was asked for longest ago, until few enough are left, and small enough."""
    while len(kept) > 1 and (
        len(kept) > count or sum(one.nbytes for one in kept.values()) > nbytes
    ):
        kept.popitem(last=False)


def _made(flow: Any, options: dict[str, Any]) -> FlowSource:
    """Take a mesh as it is where nothing is chosen about it, else the field that is meant."""
    given = {key: value for key, value in options.items() if value is not None}
    if isinstance(flow, FlowField) or not given:
        return FlowSource(flow)
    return FlowSource(FlowField.from_pyvista(flow, **given))


def _given(source: FlowSource) -> Open:
    return lambda: source


def _opener(path: Path) -> Open:
    return lambda: FlowSource.from_file(path)


def _free(name: str, taken: Iterable[str]) -> str:
    """Return a name that is not taken yet."""
    found, number = name, 1
    while found in taken:
        number += 1
        found = f"{name} ({number})"
    return found
