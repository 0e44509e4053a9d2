"""A scene as it is sent to a browser: header and arrays for the client, and its own files."""

from __future__ import annotations

import itertools
import os
import sys
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from flowtex._util.arguments import checked_count
from flowtex._util.cache import ByteCache
from flowtex._util.colours import ENTRIES, rgb
from flowtex._util.progress import check, pool, stoppable, track
from flowtex.field import FlowField
from flowtex.field.derived.quantities import steps_of
from flowtex.rendering.webgl.bodies import Bodies
from flowtex.rendering.webgl.client_data import ClientData, Colours, tile_parts
from flowtex.rendering.webgl.marks import MARK_PARTS, Marks
from flowtex.rendering.webgl.protocol import Header, Parts
from flowtex.rendering.webgl.velocity import Packing, packing_of
from flowtex.scene.options import EARTH_LINES, Options, coast_of, default_cmap, is_drawn
from flowtex.scene.scene import Scene, make_scenes
from flowtex.settings import TABLE
from flowtex.sources.notices import notify_section
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.pyramid import Pyramid, TileKey

T = TypeVar("T")

#: Memory of the tiles that are kept to be sent again, in bytes.
BUDGET_BYTES = 400_000_000
#: Memory of a node of a tile, in bytes.
NODE_BYTES = 200
#: Groups of parts that are requested by name: for controls and legend, and for other colours.
PART_GROUPS = {
    "controls": ("cmap", "maps", "lonlat", "coastlines", "graticule"),
    "colours": ("cmap", "maps"),
}
#: Fields of the appearance that can be chosen in a browser.
CHOSEN = ("scalars", "cmap", "clim", "log_scale", "opacity", "coastlines", "graticule")
#: Directions whose farthest nodes represent the whole surface.
DIRECTIONS = 400
#: Parts that are made at once, for all browsers together.
MOST_THREADS = max(os.cpu_count() or 1, 4)
_pool = pool(MOST_THREADS, "flowtex-tile")
#: Marks take seconds, for which no tile has to wait.
_marks_pool = pool(1, "flowtex-marks")
_generations = itertools.count(1)


class WebView:
    """A scene for a client in a browser.

    ``steps`` time steps are sent, evenly spaced including the first and the last; paths are traced
    through all of them. ``own`` names the settings and the fields of the appearance in which this
    view differs from the one beside it. ``bodies`` are drawn with the
    flow.
    """

    def __init__(
        self,
        scene: Scene,
        *,
        background: Any | None = None,
        steps: int | None = None,
        own: Collection[str] = (),
        bodies: Bodies | None = None,
    ) -> None:
        self.scene = scene
        self._bodies = bodies
        self.own = tuple(own)
        self.own_settings = tuple(name for name in own if name in TABLE)
        self._times = even_steps(len(scene.field.times), steps)
        if background is None:
            self._background = None
        else:
            self._background = rgb(background)

    @property
    def field(self) -> FlowField:
        """The flow."""
        return self.scene.field

    def data(self) -> ClientData:
        """Return the data for the client; makes noise textures, and traces nothing."""
        return self._data(self.scene, self.scene.pyramid)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of nodes of what is sent."""
        pyramid = self.scene.pyramid
        if pyramid is None:
            return self.field.shape
        return pyramid.shape(pyramid.depth)

    def page_data(self) -> ClientData:
        """Return the same with the values of all scalars, for pages without a server."""
        data = self.data()
        names = self.scene.scalar_names
        others = []
        for n, name in enumerate(names):
            if name != self.scene.scalar_name:
                others.append((n, self.scene.scalar_steps(name, data.field)))
        colours = replace(data.colours, others=tuple(others))
        settings = self.scene.settings
        # A client finds the structure of a formula itself.
        is_whole = data.formula is not None
        kinds = []
        for name, kind in MARK_PARTS.items():
            is_drawn = is_whole or getattr(settings, name)
            if is_drawn and data.marks and kind in data.marks.kinds:
                kinds.append(kind)
        marks = None
        if data.marks and kinds:
            marks = replace(data.marks, kinds=tuple(kinds), carried=True)
        return replace(data.recoloured(colours), marks=marks)

    def coarse_data(self, nodes: int) -> ClientData:
        """Return the same with at most this many nodes, for a first picture."""
        return self._data(self.scene.coarsened(nodes))

    def _data(self, scene: Scene, pyramid: Pyramid | None = None) -> ClientData:
        """Return the data of a scene for clients; marks are found when they are requested."""
        textures = scene.textures
        colours = colours_of(self.scene, textures.geometry.field, self._background)
        marks = None
        if not self.field.sign_free:  # found when they are requested
            is_flat = self.field.surface.frame is not None
            kinds = list(MARK_PARTS.values())
            if not is_flat:
                kinds.remove("nullclines")
            marks = Marks(self.scene.structure, tuple(kinds))
        return ClientData(
            textures, colours, self._times, pyramid, traces=True, bodies=self._bodies, marks=marks
        )

    def show(self, field: FlowField) -> None:
        """Show another flow in the same way; raises what :meth:`Scene.showing` does."""
        before = self.scene
        self.scene = self.scene.showing(field, keep_range=False)
        self.scene.follow(before)

    def recoloured(self, data: ClientData) -> ClientData:
        """Return the data of the client with the current colours."""
        return data.recoloured(colours_of(self.scene, data.field, self._background))

    def close(self) -> None:
        """Stop following the settings."""
        self.scene.close()


def colours_of(
    scene: Scene, field: FlowField, background: tuple[float, float, float] | None
) -> Colours:
    """Return the colours of a scene on its field, or on a coarser form of it."""
    look = scene.appearance
    name = scene.scalar_name
    of_scalar: dict[str, Any] = {}
    if name is not None:
        of_scalar["unit"] = scene.field.unit_of(name)
        of_scalar["number"] = scene.scalar_names.index(name)
        of_scalar["values"] = scene.scalar_steps(name, field)
        of_scalar["label"] = scene.whole.label_of(name)
    cmap = ""
    if isinstance(look.cmap, str):
        cmap = look.cmap
    opacity = 0.0
    if look.visible:
        opacity = float(look.opacity)
    land = None
    if look.land is not None:
        land = rgb(look.land)
    return Colours(
        name=name,
        **of_scalar,
        choices=choices_of(scene),
        cmap=cmap,
        auto=look.clim is None and look.norm is None,
        flat=name in scene.field.on_cells,
        scale=scene.colour_scale,
        entries=look.n_colors or ENTRIES,
        flip=look.flip_scalars,
        plain=rgb(look.color),
        background=background,
        lighting=scene.is_lit,
        opacity=opacity,
        bar=scene.has_bar,
        coastlines=is_drawn(look.coastlines),
        coast=coast_of(look),
        graticule=look.graticule is not False,
        land=land,
    )


def is_choice(name: object, value: object) -> bool:
    """Return whether a browser may set a field of the appearance to a value: it names no files."""
    return name in CHOSEN and (name not in EARTH_LINES or isinstance(value, bool))


def choices_of(scene: Scene) -> tuple[Header, ...]:
    """Return the scalars that can colour the surface, with their own ranges."""
    choices: list[Header] = []
    for name in scene.scalar_names:
        (low, high) = scene.usual_range(name)
        (least, most) = scene.scalar_range(name)
        values = scene.field.velocity
        if name in scene.field.scalars:
            values = scene.field.scalars[name]
        steps = len(values)
        choices.append(
            {
                "name": name,
                "label": scene.whole.label_of(name),
                "unit": scene.field.unit_of(name),
                "cmap": default_cmap(name),
                "low": low,
                "high": high,
                "least": least,
                "most": most,
                "steps": steps,
                "flat": name in scene.field.on_cells,
            }
        )
    return tuple(choices)


def browser_options(mesh: Any, **options: Any) -> tuple[Any, Options]:
    """Return the mesh or field to draw, and the sorted arguments.

    For a PyVista plotter they are those of its first flow texture, with the other objects of the
    scene; ``options`` have precedence.
    """
    # Where its module is not loaded, as it takes a while, there are no plotters.
    plotting = sys.modules.get("pyvista.plotting")
    if plotting is None or not isinstance(mesh, plotting.BasePlotter):
        return mesh, Options.split(**options)
    field, look, bodies = mesh.flowtex.for_browser()
    arguments = {}
    for name, value in options.items():
        if value is not None:
            arguments[name] = value
    return field, replace(Options.split(**{**look, **arguments}), bodies=bodies)


def web_views(mesh: Any, options: Options, *, steps: int | None = None) -> tuple[WebView, ...]:
    """Return the view of a mesh or a field, and one beside it if ``options.view`` asks for it."""
    scenes = make_scenes(mesh, options)
    notify_section(scenes[0].field.section)
    view = options.view
    make = partial(WebView, background=view.background, steps=steps, bodies=options.bodies)
    first, *others = scenes
    views = [make(first)]
    for scene in others:
        views.append(make(scene, own=tuple(view.beside or ())))
    return tuple(views)


def even_steps(count: int, steps: int | None) -> tuple[int, ...]:
    """Return evenly spaced time steps, ``steps`` out of ``count``; empty for all of them."""
    if steps is None:
        return ()
    steps = checked_count("steps", steps, expected=f"1 to {count}, the time steps of the field")
    if steps >= count:
        return ()
    if steps > 1:
        first = 0
    else:
        first = count - 1
    return tuple(np.rint(np.linspace(first, count - 1, steps)).astype(int).tolist())


@dataclass(frozen=True, eq=False)
class _Tile:
    """Textures of a tile, ``None`` if nothing of it is drawn, and their packed slices if any."""

    textures: TextureSet | None
    packing: Packing | None

    @property
    def nbytes(self) -> int:
        if self.textures is None:
            nodes = 0
        else:
            nodes = self.textures.geometry.field.valid.size
        nbytes = NODE_BYTES * nodes
        if self.packing is not None:
            nbytes += self.packing.nbytes
        return nbytes


class TileSource:
    """Source of the parts of a scene, by name; tiles are made on request.

    ::

        parts(None, ())          the parts of the whole surface that are the same at all times
        parts(None, (3,))        the flow and the values of the whole at a time step
        parts(key, (3, 4))       a tile: its header and surface, and flow and values at two steps
        parts(None, (3,), kind)  marks of a kind at a step: critical points, or separatrices
        parts(None, (), group)   those of the whole surface in one of PART_GROUPS

    A widget sends them in messages, the application as files, and an exported page holds them;
    ``client/src/sources`` is the other side. A store has the same parts in its own files, which
    :mod:`flowtex.pyramid.tasks` writes and a browser reads without a server.

    ``scene`` may be replaced at any time by the same scene in other colours. All methods may be
    called from any thread. ``generation`` is its number in this process.
    """

    def __init__(self, scene: ClientData, budget: int = BUDGET_BYTES) -> None:
        self.scene = scene
        self.generation = next(_generations)
        self._tiles: ByteCache[TileKey, _Tile] = ByteCache(budget)
        self._is_closed = False

    @classmethod
    def of(cls, scene: ClientData, before: TileSource | None) -> TileSource:
        """Return the source of a scene; reuse the one before for other colours, or close it."""
        if before is not None and before.scene.textures is scene.textures:
            before.scene = before.scene.recoloured(scene.colours)
            return before
        if before is not None:
            before.close()
        return cls(scene)

    def parts(self, key: TileKey | None, steps: Sequence[int], kind: str = "") -> Parts:
        """Return the parts of a tile at time steps, or of the whole; a LookupError if none."""
        if kind in PART_GROUPS:
            return _group(self.scene, kind)
        parts: Parts = {}
        if kind:
            for step in steps:
                parts |= self.scene.mark(kind, step)
            return parts
        if key is None:
            if not steps:
                parts |= self.scene.surface()
            for step in steps:
                parts |= self.scene.step(step)
            return parts
        tile = self.tile(key, steps)
        parts = tile_parts(key, tile, *steps)
        if tile is not None:
            tile.textures.forget()
        return parts

    def tile(self, key: TileKey, steps: Sequence[int]) -> ClientData | None:
        """Return a tile as it is sent, or ``None`` where nothing of it is drawn.

        Parameters
        ----------
        key
            Level, row and column of the tile.
        steps
            Time steps whose textures are sent.

        Raises
        ------
        LookupError
            When the surface has no tiles, because it is sent as a whole.
        """
        scene = self.scene
        pyramid = self.scene.pyramid
        if pyramid is None:
            raise LookupError(f"tile {tuple(key)} does not exist: the surface is sent as a whole")

        def make() -> _Tile:
            if scene.traced:
                return _Tile(pyramid.textures(key), None)
            # Slices that are sent have a halo large enough for these steps.
            textures = pyramid.tile(key, [scene.source(step) for step in steps])
            if textures is None:
                return _Tile(None, None)
            return _Tile(textures, packing_of(textures))

        textures = self._tiles.get(key, make).textures
        if textures is None:
            return None
        return scene.tile(textures, partial(steps_of, textures.geometry.field))

    def ask(
        self,
        key: TileKey | None,
        steps: Sequence[int],
        is_over: Callable[[], bool] = lambda: False,
        kind: str = "",
    ) -> Future[Parts]:
        """Make parts in a thread; ``Stopped`` once it ``is_over``, or the source is closed."""
        make = partial(self.parts, key, steps, kind)
        if kind in ("", *PART_GROUPS):
            executor = _pool
        else:
            executor = _marks_pool
        return in_pool(make, lambda: self._is_closed or is_over(), executor)

    def tiles(self) -> Iterator[Parts]:
        """Yield the parts of all tiles that are sent without a request, coarse ones first."""
        scene = self.scene
        steps = range(self.scene.steps)
        keys: list[TileKey] = []
        if scene.pyramid is None:
            level = []
        else:
            level = scene.pyramid.children(None)
        while scene.pyramid is not None and level and level[0].level >= scene.finest:
            keys += level
            finer: list[TileKey] = []
            for key in level:
                finer += scene.pyramid.children(key)
            level = finer
        groups = [[key] for key in keys]
        if scene.pyramid is not None and not scene.traced:
            # Windows of tiles that are traced here overlap.
            groups = scene.pyramid.groups(keys)
        starts = range(0, len(groups), MOST_THREADS)
        for n in track(starts, len(starts), "Packing tiles"):
            futures = []
            for group in groups[n : n + MOST_THREADS]:
                make = partial(self._parts_together, group, steps)
                futures.append(in_pool(make, lambda: self._is_closed))
            for future in futures:
                yield from future.result()

    def _parts_together(self, keys: Sequence[TileKey], steps: Sequence[int]) -> list[Parts]:
        """Return the parts of tiles of a level, which are traced together."""
        if len(keys) == 1:
            return [self.parts(keys[0], steps)]
        scene = self.scene
        assert scene.pyramid is not None
        made = scene.pyramid.tiles(keys, [scene.source(step) for step in steps])
        parts = []
        for key, textures in made.items():
            tile = None
            if textures is not None:
                tile = scene.tile(textures, partial(steps_of, textures.geometry.field))
            parts.append(tile_parts(key, tile, *steps))
        # Tiles share their slices, so that none is forgotten before all are packed.
        for textures in made.values():
            if textures is not None:
                textures.forget()
        return parts

    def close(self) -> None:
        """Stop making parts."""
        self._is_closed = True
        self._tiles.clear()


def _group(scene: ClientData, group: str) -> Parts:
    """Return a group of parts of the surface; for controls also its outermost nodes."""
    parts = {}
    for name, part in scene.surface().items():
        if name in PART_GROUPS[group]:
            parts[name] = part
    if group != "controls":
        return parts
    nodes = scene.textures.geometry.position.reshape(-1, 3)
    nodes = nodes[np.isfinite(nodes).all(axis=1)]
    directions = np.random.default_rng(0).normal(size=(DIRECTIONS, 3))
    directions = np.concatenate([directions, np.eye(3), -np.eye(3)])
    farthest = set()
    if len(nodes):
        for direction in directions:
            farthest.add(int((nodes @ direction).argmax()))
    return {**parts, "position": np.ascontiguousarray(nodes[sorted(farthest)], "<f4")}


def in_pool(
    work: Callable[[], T], is_over: Callable[[], bool], executor: Executor = _pool
) -> Future[T]:
    """Do work in a thread; ``Stopped`` once it ``is_over``."""

    def guarded() -> T:
        with stoppable(is_over):
            check()
            return work()

    return executor.submit(guarded)


def first_parts(scene: ClientData, time: float) -> Parts:
    """Return the arrays with which a client begins: the surface, and what shows one moment."""
    parts = scene.surface()
    for step in scene.moment(time):
        parts |= scene.values(step, shown=True)
        for name, part in scene.step(step).items():
            if not name.startswith("scalars/"):
                parts[name] = part
    return parts


def asset(name: str) -> Path:
    """Return the path of one of the client's files, such as ``"core.js"``."""
    return Path(__file__).resolve().parent / "static" / name


def client_module() -> str:
    """Return the client as the text of a module, for widgets and pages."""
    return client_script() + asset("exports.mjs").read_text("utf-8")


def client_script(*, with_store: bool = False) -> str:
    """Return the client as a script that defines ``flowtex``, and ``flowtexStore`` to read one."""
    script = asset("core.js").read_text("utf-8")
    if with_store:
        script += asset("store.js").read_text("utf-8")
    return script
