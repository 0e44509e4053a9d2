"""Critical points and separatrices over a flow, of the step that is nearest to its time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future

import numpy as np
import pyvista as pv

from flowtex._util.array_types import Floats
from flowtex._util.threads import pool
from flowtex.plotting.overlay import Overlay, piece_mesh
from flowtex.rendering.structure_marks import (
    DOT_PX,
    KIND_MARKS,
    LINE_COLORS,
    LINE_PX,
    MIDDLE_COLOR,
    NULLCLINE_COLORS,
    RIM_COLOR,
    RIM_OPACITY,
)
from flowtex.rendering.vtk import FlowSurface
from flowtex.scene.scene import Scene
from flowtex.trace.structure import CriticalPoints

#: Structures are found one after the other, in the background.
_pool = pool(1, "flowtex-structure")


class StructureOverlay(Overlay):
    """The structure of one flow, as the settings request it."""

    def __init__(
        self, actor: pv.Actor, renderer: pv.Renderer, scene: Scene, surface: FlowSurface
    ) -> None:
        super().__init__(actor, renderer, surface)
        self._shown: tuple[int, ...] = ()
        self._notify: Callable[[], None] | None = None
        self._request: tuple[object, ...] = ()
        self._found: Future[None] | None = None
        self._scene = scene
        self.show(scene)

    def load_in_background(self, notify: Callable[[], None]) -> None:
        """Show the structure when it is found, and notify from a thread; else a change waits."""
        self._notify = notify

    @property
    def busy(self) -> bool:
        """Whether something is still to be found."""
        return self._found is not None and not self._found.done()

    @property
    def _key(self) -> tuple[int, ...]:
        scene, settings = self._scene, self._scene.settings
        counts = settings.critical_points, settings.separatrices, int(settings.nullclines)
        return id(scene.field), scene.step, *counts

    def show(self, scene: Scene) -> None:
        """Follow the settings and the time of a scene."""
        self._scene = scene
        if self._shown != self._key:
            self._clear()
            self._shown = ()
            self._show()

    def _before_frame(self) -> None:
        if self._shown != self._key:
            self._show()
        super()._before_frame()

    def _show(self) -> None:
        """Draw the requested structure, or find it in the background first."""
        scene, settings = self._scene, self._scene.settings
        request = (scene.step, settings.critical_points, settings.separatrices)
        if any(request[1:]) and self._notify is not None and not scene.structure.has(*request):
            if self._request != (scene.structure, request):
                self._request, notify = (scene.structure, request), self._notify
                self._found = _pool.submit(scene.structure.find, *request)
                self._found.add_done_callback(lambda _: notify())
            return
        self._shown = self._key
        if settings.nullclines:
            self._add_nullclines(scene.structure.nullclines(scene.step))
        if settings.separatrices:
            self._add_paths(scene.structure.paths(scene.step, settings.separatrices))
        if settings.critical_points:
            self._add_points(scene.structure.points(scene.step)[: settings.critical_points])

    def _add_nullclines(self, lines: Sequence[Floats]) -> None:
        outer, inner = LINE_PX
        drawn = [(inner, color, 1.0, 1) for color in NULLCLINE_COLORS.values()]
        looks = ((outer, RIM_COLOR, RIM_OPACITY, 0), *drawn)
        for pieces, (width, color, opacity, above) in zip(
            (np.concatenate(lines), *lines), looks, strict=True
        ):
            if len(pieces):
                mesh = piece_mesh(*np.swapaxes(pieces, 0, 1))
                self._add_lines(((0.0, mesh),), width, color, opacity, above=above)

    def _add_paths(self, by_name: Mapping[str, Sequence[Floats]]) -> None:
        outer, inner = LINE_PX
        all_paths = [path for paths in by_name.values() for path in paths]
        self._add_pieces(all_paths, outer, RIM_COLOR, RIM_OPACITY, above=0)
        for above, (name, color) in enumerate(LINE_COLORS.items(), 1):
            self._add_pieces(by_name[name], inner, color, above=above)

    def _add_points(self, points: CriticalPoints) -> None:
        outer, inner, middle = DOT_PX
        all_dots = [point.position[None] for point in points]
        self._add_pieces(all_dots, outer, RIM_COLOR, RIM_OPACITY, above=5)
        for kind, mark in KIND_MARKS.items():
            dots = [point.position[None] for point in points.of_kind(kind)]
            self._add_pieces(dots, inner, mark.color, above=6)
            if mark.turns:
                self._add_pieces(dots, middle, MIDDLE_COLOR, above=7)

    def _add_pieces(
        self, paths: Sequence[Floats], width: float, color: str, opacity: float = 1.0, *, above: int
    ) -> None:
        """Add paths (N, 3) each as lines, or as dots where they have one point."""
        if paths:
            start = np.concatenate([path[:-1] if len(path) > 1 else path for path in paths])
            end = np.concatenate([path[1:] if len(path) > 1 else path for path in paths])
            self._add_lines(((0.0, piece_mesh(start, end)),), width, color, opacity, above=above)
