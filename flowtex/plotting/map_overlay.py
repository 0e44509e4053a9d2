"""Coasts, meridians and parallels over a flow, and land and the globe under it, as VTK actors."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkCamera

from flowtex._util.array_types import Bools
from flowtex.field import FlowField
from flowtex.field.earth import MapLines
from flowtex.plotting.overlay import Overlay, piece_mesh
from flowtex.plotting.vtk_camera import read_camera
from flowtex.rendering.constants import AMBIENT_LIGHT, DIFFUSE_LIGHT
from flowtex.rendering.map_overlay import SPACINGS, STROKES, globe_radius, land_cells, map_lines
from flowtex.rendering.vtk import FlowSurface
from flowtex.scene.scene import Scene

#: How much farther than the surface land is, as a share of the distance.
LAND_FARTHER = 2e-4
#: Pixels by which the globe is lower: coarse triangles sink by up to this many.
GLOBE_LOWER_PX = 0.5
#: Nearest that the front of the globe is drawn, as a share of the farthest.
NEAREST = 1e-3
#: Cells along a meridian of the globe below the surface.
GLOBE_CELLS = 180


class MapOverlay(Overlay):
    """The Earth behind one flow whose field has a projection."""

    def __init__(
        self, actor: pv.Actor, renderer: pv.Renderer, scene: Scene, surface: FlowSurface
    ) -> None:
        super().__init__(actor, renderer, surface)
        self._scene, self._field = scene, scene.whole
        self._lines: dict[tuple[str, bool], tuple[tuple[float, pv.PolyData], ...]] = {}
        self._radius: float | None = None
        self.show()

    def show(self) -> None:
        """Follow the appearance, and the coarsest level of a large field."""
        if self._field is not self._scene.whole:
            self._field, self._lines = self._scene.whole, {}
        self._clear()
        appearance = self._scene.appearance
        if appearance.land is not None:
            self._add_land(appearance.land)
        for option, stroke in STROKES.items():
            if getattr(appearance, option) is not False and (forms := self._forms_of(option)):
                self._add_lines(forms, stroke.width, stroke.color, stroke.opacity)

    def _forms_of(self, option: str) -> tuple[tuple[float, pv.PolyData], ...]:
        """Return the lines of an option, from coarse to fine; all are made once, together.

        A field far from any coast has none.
        """
        has_globe = self._radius is not None
        if (option, has_globe) not in self._lines:
            for name, lines in map_lines(self._field, has_globe=has_globe).items():
                forms = ((s, lines.thinned(s) if s else lines) for s in SPACINGS)
                self._lines[name, has_globe] = tuple(
                    (s, _line_mesh(form)) for s, form in forms if len(form.points)
                )
        return self._lines[option, has_globe]

    def _add_land(self, color: Any) -> None:
        """Draw cells without data, and the globe where the field does not cover it."""
        is_lit = self._scene.is_lit
        meshes = []
        # Behind a transparent flow there is the background instead of land.
        tiled = self._scene.pyramid is not None and self._scene.appearance.opacity == 1
        if (land := land_cells(self._field, tiled=tiled)).any():
            meshes.append((_cell_mesh(self._field, land), -LAND_FARTHER))
        self._radius = globe_radius(self._field)
        if self._radius is not None:
            around, along = 2 * GLOBE_CELLS, GLOBE_CELLS
            globe = pv.Sphere(radius=self._radius, theta_resolution=around, phi_resolution=along)
            meshes.append((globe, 0.0))
        for mesh, nearer in meshes:
            if self._field.surface.on_globe:
                mesh.point_data.active_normals = mesh.points / np.linalg.norm(
                    mesh.points, axis=1, keepdims=True
                )
            actor = self._add(mesh, nearer)
            actor.prop.color, actor.prop.lighting = color, is_lit
            if is_lit:
                actor.prop.ambient, actor.prop.diffuse = AMBIENT_LIGHT, DIFFUSE_LIGHT

    def _clear(self) -> None:
        super()._clear()
        self._radius = None

    def _look(self, camera: vtkCamera) -> None:
        if self._radius is None:
            return
        self._include_globe(camera, self._radius)
        for part in self._parts:
            if not part.nearer:
                part.actor.SetScale(1 - GLOBE_LOWER_PX * self._horizon_pixel() / self._radius)

    def _horizon_pixel(self) -> float:
        """Return the length of a pixel on the horizon, the farthest visible point of the globe."""
        view, eye = self._surface.view, self._surface.view.eye
        if not eye[3]:
            return view.pixel
        horizon = np.sqrt(max(float(eye[:3] @ eye[:3]) - (self._radius or 0.0) ** 2, 0.0))
        return view.pixel * float(horizon / np.linalg.norm(eye[:3] - view.focus))

    def _include_globe(self, camera: vtkCamera, radius: float) -> None:
        """Extend the clipping range to the globe, which has no bounds in VTK."""
        near, far = camera.GetClippingRange()
        matrix, view = pv.array_from_vtkmatrix(self._actor.GetMatrix()), read_camera(camera)
        depth = float(np.subtract(matrix[:3, 3], view.position) @ view.axes[2])
        radius *= float(np.linalg.norm(matrix[:3, 0]))
        far = max(far, depth + radius)
        near = min(near, max(depth - radius, NEAREST * far))
        camera.SetClippingRange(near, far)


def _line_mesh(lines: MapLines) -> pv.PolyData:
    joined = np.ones(len(lines.points), dtype=bool)
    joined[lines.starts[1:] - 1] = False
    first = np.flatnonzero(joined)
    return piece_mesh(lines.points[first], lines.points[first + 1])


def _cell_mesh(field: FlowField, cells: Bools) -> pv.PolyData:
    """Return the mesh of ``cells`` of a field's surface."""
    faces = field.surface.nodes_of(cells)
    points, numbers = np.unique(faces, return_inverse=True)
    shape: Any = numbers.reshape(faces.shape)
    return pv.PolyData.from_regular_faces(field.surface.points.reshape(-1, 3)[points], shape)
