"""Library of the flows that a page may open, by name.

A page sends names, never paths. They are looked up among the files that were found when the library
was made or listed again, so no other file can be opened. Open files and their flows are shared by
all pages of a server. Each file is open in a separate process, which may crash; a file that has
changed is opened again on request.
"""

from __future__ import annotations

import fnmatch
import os
import threading
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from flowtex._util.arguments import are_paths, checked_source
from flowtex._util.cache import ByteCache, WeakCache
from flowtex.app.server.page import shortened
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.formula.make import is_line, line_field
from flowtex.field.options import FieldOptions
from flowtex.pyramid import open_store
from flowtex.pyramid.source import has_parts
from flowtex.remedies import error_for_page
from flowtex.scene.fields import read_field
from flowtex.scene.forms import FLAGS
from flowtex.sources.datasets import is_dataset
from flowtex.sources.inspection.foam_files import ENDINGS as FOAM
from flowtex.sources.inspection.foam_files import case_of
from flowtex.sources.meshes.plot3d import SURFACE_SUFFIXES as WITHOUT_VECTORS
from flowtex.sources.open_source import DatasetSource, FlowSource, MeshSource
from flowtex.sources.opening.dataset_files import COMMON, common_name, is_dataset_file
from flowtex.sources.opening.dataset_files import SUFFIXES as EARTH_SUFFIXES
from flowtex.sources.plain_arrays import are_labelled, is_plain
from flowtex.sources.read_files import Identity, file_identity, members_of
from flowtex.sources.remote import open_remote, prepare_readers

#: Endings of files that a folder is searched for.
SUFFIXES = frozenset(
    [
        *(".vts", ".vtr", ".vti", ".vtk", ".vtu", ".vtp", ".vtm", ".vtmb", ".pvd", ".pvts"),
        *(".pvtr", ".pvti", ".pvtu", ".pvtp", ".xyz", ".x", ".g", ".case", ".cgns", ".vtkhdf"),
        *FOAM,
        *(".e", ".ex2", ".exii", ".exo", ".stl", ".ply", ".obj", ".msh", ".med", ".xdmf", ".xmf"),
        *EARTH_SUFFIXES,
    ]
).difference(COMMON)
ENDINGS = " ".join(sorted(SUFFIXES))  #: The same as text.
#: Depth to which a folder is searched.
FOLDER_DEPTH = 4
#: Most files of a folder that are listed.
MOST_FILES = 500
MOST_REASONS = 3  #: Most files that cannot be drawn, in the error of a folder without a flow.
REASON_LENGTH = 200  #: Most characters of the reason why a file cannot be drawn.
#: Most files that stay open.
MOST_SOURCES = 4
#: Most bytes of the files that stay open.
SOURCE_BYTES = 2_000_000_000

Opener = Callable[[], FlowSource]
#: Zoom, and the point of the mesh to look at.
Look = tuple[float, tuple[float, ...] | None]


@dataclass(frozen=True)
class Choice:
    """The part of a file to show; empty values are chosen automatically.

    Examples
    --------
    >>> from flowtex.app import Choice
    >>> Choice(plane="k=20")
    Choice(vectors='', plane='k=20', block='')
    """

    vectors: str = ""
    plane: str = ""
    block: str = ""


class Library:
    """The flows that a page can open, by name.

    Parameters
    ----------
    openers
        Functions that open the flows, by name.
    folder
        A folder that is searched for further flows.
    looks
        Initial zoom and focus of flows, by name; the others are first shown as a whole.
    typed
        Whether users may type formulas, which are the names of their flows.

    Raises
    ------
    FieldError
        When there are no flows to open.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.app import Choice, Library
    >>> library = Library.of(flowtex.examples.airfoil_field(), flowtex.examples.vortex_field())
    >>> len(library.names)
    2
    >>> library.field(library.names[0], Choice()).shape
    (65, 193)
    """

    def __init__(
        self,
        openers: Mapping[str, Opener],
        folder: Path | None = None,
        looks: Mapping[str, Look] | None = None,
        *,
        typed: bool = False,
    ) -> None:
        self.typed = typed
        self._named = dict(openers)
        self._looks = dict(looks or {})
        if folder is None:
            self._folder = None
        else:
            self._folder = checked_source(folder)
        #: Flows that a branch has for itself, and all that could be opened when last listed.
        self._own: dict[str, Opener] = {}
        self._openers: dict[str, Opener] = {}
        # Branches have these in common.
        self._sources: ByteCache[Opener, FlowSource] = ByteCache(
            SOURCE_BYTES, max_count=MOST_SOURCES
        )
        self._fields: WeakCache[FlowField] = WeakCache()
        #: Reasons why files could not be drawn, with their identities at that time.
        self._faults: dict[Opener, tuple[Identity, str]] = {}
        #: Files of the folder that were not drawable when it was last searched, with the reasons.
        self.unshown: dict[str, str] = {}
        self._making: defaultdict[Opener, threading.Lock] = defaultdict(threading.Lock)
        has_files = any(isinstance(opener, _Files) for opener in openers.values())
        if has_files or self._folder is not None:
            prepare_readers()
        if not self.names:
            raise FieldError(_nothing_found(folder, self.unshown))

    def branch(self) -> Library:
        """Return a library of the same flows, to which a page can add its own."""
        other = copy(self)
        other._own = {}
        return other

    def add(self, name: str, path: Path) -> str:
        """Add a file to this branch; return the name by which it can be opened."""
        name = _free(name, self.names)
        self._own[name] = self._openers[name] = _Files((path,))
        return name

    @classmethod
    def of(cls, *flows: Any, folder: str | Path | None = None, **options: Any) -> Library:
        """Make a library of fields, meshes, datasets, arrays, files, or one folder.

        A list of paths is one flow whose files belong together.

        ``options`` are arguments of :meth:`flowtex.FlowField.from_pyvista` for meshes.

        Raises
        ------
        FieldError
            When a path does not exist, or a mesh does not contain a flow.
        """
        if len(flows) == 1 and isinstance(flows[0], Library):
            return flows[0]
        if len(flows) == 1 and isinstance(flows[0], (str, Path)):
            path = Path(flows[0])
            if path.is_dir() and not is_dataset_file(path) and case_of(path) is None:
                return cls({}, path)
        openers: dict[str, Opener] = {}
        for flow in flows:
            if isinstance(flow, (list, tuple)):
                items = flow
            else:
                items = (flow,)
            if items and are_paths(items):
                paths = tuple(map(Path, items))
                if len(paths) == 1:
                    name = paths[0].name
                else:
                    name = common_name(paths)
                openers[_free(name, openers)] = _Files(paths)
                continue
            if isinstance(flow, FlowSource):
                source = flow
            else:
                source = _source_of(flow, options)
            openers[_free(source.name or "flow", openers)] = _constant(source)
        if folder is not None:
            folder = Path(folder)
        return cls(openers, folder)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all flows that may be opened; the folder is searched again."""
        found: dict[str, Opener] = {}
        self.unshown = {}
        if self._folder is not None:
            for name, path in find_files(self._folder):
                reason = _reason_by_ending(path)
                if reason:
                    self.unshown[name] = reason
                else:
                    found[name] = _Files((path,))
        self._openers = {**self._named, **found, **self._own}
        for name, opener in self._openers.items():
            reason = self._fault(opener)
            if reason:
                self.unshown[name] = reason
        return tuple(self._openers)

    def may_open(self, name: str) -> bool:
        """Return whether a name, when last listed, was one that may be opened."""
        return name in self._openers

    def _fault(self, opener: Opener) -> str:
        """Return why a file could not be drawn; empty if it was not tried, or changed since."""
        if opener not in self._faults:
            return ""
        identity, reason = self._faults[opener]
        if identity == _identity(opener):
            return reason
        return ""

    @contextmanager
    def _noting_fault(self, opener: Opener) -> Iterator[None]:
        """Note why a file cannot be drawn."""
        identity = _identity(opener)
        try:
            yield
        except (FieldError, OSError) as error:
            if isinstance(opener, _Files):
                self._faults[opener] = identity, reason_text(error, opener.paths)
            raise

    def source(self, name: str) -> FlowSource:
        """Return a source, and open it if it is not open or its file has changed.

        Raises
        ------
        FieldError
            When the name is unknown, or the source cannot be read.
        """
        opener = self._opener(name)
        with self._noting_fault(opener):
            return self._sources.get(
                opener,
                opener,
                lambda source: source.alive and source.identity == _identity(opener),
            )

    def _opener(self, name: str) -> Opener:
        """Return the function that opens a flow by its name."""
        opener = self._openers.get(name)
        if opener is None and self._is_line(name):
            return _Line(name)
        if opener is None:
            label = repr(shortened(name, 80))
            raise FieldError(f"the file {label} is not among those that may be opened here")
        return opener

    def _is_line(self, name: str) -> bool:
        return self.typed and is_line(name)

    def is_file(self, name: str) -> bool:
        """Return whether a name belongs to a file."""
        opener = self._openers.get(name)
        return isinstance(opener, _Files) or (opener is None and not self._is_line(name))

    def look(self, name: str) -> Look:
        """Return the initial zoom and focus of a flow."""
        return self._looks.get(name, (1.0, None))

    def complete(self, name: str, choice: Choice, *, nearest: bool = False) -> Choice:
        """Complete a choice with the middle plane and the first array of vectors.

        With ``nearest`` only those parts of it are used that the file has.
        """
        source = self.source(name)
        block = choice.block
        vectors = choice.vectors
        plane = choice.plane
        if nearest and block not in source.blocks:
            block = ""
        block = block or next(iter(source.blocks), "")
        part = source.part(block or None)
        if nearest:
            if vectors not in part.vectors:
                vectors = ""
            if part.plane_number(plane) is None:
                plane = ""
        vectors = vectors or next(iter(part.vectors), "")
        return Choice(vectors, plane or part.default_plane, block)

    def field(self, name: str, choice: Choice) -> FlowField:
        """Return a flow, and make it if necessary; nothing is traced.

        Raises
        ------
        FieldError
            When the file does not exist, or the choice does not contain a flow.
        """
        opener = self._opener(name)

        def make() -> FlowField:
            source = self.source(name)
            with self._making[opener]:
                return source.field(choice.vectors or None, choice.plane, choice.block or None)

        key = (opener, choice, _identity(opener))
        if choice != self.complete(name, Choice()):  # another choice may be drawn
            return self._fields.get(key, make)
        with self._noting_fault(opener):
            field = self._fields.get(key, make)
        self._faults.pop(opener, None)
        return field


def _source_of(flow: Any, options: dict[str, Any]) -> FlowSource:
    """Return the source of a dataset, arrays, a field or a mesh."""
    given = {}
    for name, value in options.items():
        if value is not None:
            given[name] = value
    if are_labelled(flow) or (is_plain(flow) and not is_dataset(flow)):
        return MeshSource(read_field(flow, FieldOptions.of(**given)))
    if is_dataset(flow) and not given:
        return DatasetSource(flow)
    if isinstance(flow, FlowField) or not given:
        return MeshSource(flow)
    return MeshSource(read_field(flow, FieldOptions.of(**given)))


def _constant(source: FlowSource) -> Opener:
    return lambda: source


@dataclass(frozen=True)
class _Files:
    """Opener of a file, or of several that belong together, in a separate process."""

    paths: tuple[Path, ...]

    def __call__(self) -> FlowSource:
        if not self._is_store:
            return open_remote(self.paths)
        # Only the parts of a pyramid that are drawn are read, with checks.
        identity = self.identity
        source = MeshSource(open_store(self.paths[0]), name=self.paths[0].stem)
        source.identity = identity
        return source

    @property
    def identity(self) -> Identity:
        if self._is_store:
            return file_identity([self.paths[0] / "zarr.json"])
        return file_identity(self.paths)

    @property
    def _is_store(self) -> bool:
        return len(self.paths) == 1 and has_parts(self.paths[0])


@dataclass(frozen=True)
class _Line:
    text: str

    def __call__(self) -> FlowSource:
        return MeshSource(line_field(self.text))


def _identity(opener: Opener) -> Identity:
    if isinstance(opener, _Files):
        return opener.identity
    return ()


def reason_text(error: Exception, paths: Iterable[Path]) -> str:
    """Return an error about files as a reason to show beside their name: without their folders.

    Parameters
    ----------
    error
        The error of reading the files.
    paths
        Their paths, which are private to the server.

    Returns
    -------
    str
        The reason, of one line and at most ``REASON_LENGTH`` characters.
    """
    text = " ".join(str(error).split()) or type(error).__name__
    for path in paths:
        for place in (path, path.resolve()):
            text = text.replace(f"{place.parent}{os.sep}", "")
        text = text.removeprefix(f"{path.name}: ")
    if isinstance(error, OSError) and error.strerror:
        text = error.strerror
    return shortened(error_for_page(text, FLAGS, {}), REASON_LENGTH)


def _reason_by_ending(path: Path) -> str:
    """Return why a file cannot be drawn, by its ending; empty if it may be."""
    beside = path.with_suffix(".npy")
    if path.suffix.lower() in WITHOUT_VECTORS and not beside.exists():
        return f"a surface without vectors; put them into {beside.name}, one row for each point"
    return ""


def _nothing_found(folder: object, unshown: Mapping[str, str]) -> str:
    """Return the error of a folder without a flow."""
    text = f"{folder}: the folder has no file that can be opened; expected {ENDINGS}"
    reasons = []
    for name, reason in list(unshown.items())[:MOST_REASONS]:
        reasons.append(f"{name}: {reason}")
    return ". ".join([text, *reasons])


def _free(name: str, taken: Iterable[str]) -> str:
    free = name
    number = 1
    while free in taken:
        number += 1
        free = f"{name} ({number})"
    return free


def find_files(folder: Path) -> list[tuple[str, Path]]:
    """Find files below a folder, except those outside of it to which links lead."""
    from flowtex.sources.meshes.plot3d import find_grid

    files: list[tuple[str, Path]] = []
    for parent, folders, names in os.walk(folder):
        here = Path(parent)
        stores = []
        for n in folders:
            if is_dataset_file(here / n) and not (here / n).is_symlink():
                stores.append(n)
        depth = len(here.relative_to(folder).parts)
        hidden = set(fnmatch.filter((*folders, *names), ".*"))
        searched = set()
        if depth < FOLDER_DEPTH:
            searched = set(folders) - {*stores, *hidden}
        folders[:] = sorted(searched)
        for name in sorted({*stores, *names} - hidden):
            path = here / name
            real = Path(os.path.realpath(path))
            is_known = path.suffix.lower() in SUFFIXES | {".bin"} and path.is_file()
            if real.is_relative_to(folder) and (is_known or path.name in stores):
                files.append((path.relative_to(folder).as_posix(), path))
        if len(files) >= MOST_FILES:
            break
    files = files[:MOST_FILES]
    members: set[Path] = set()
    for _, path in files:
        members.update(members_of(path))
        # The solution of a PLOT3D pair is opened along with its grid.
        if path.suffix.lower() == ".bin" and find_grid(path) not in (None, path):
            members.add(path)
    return [(name, path) for name, path in files if path not in members]
