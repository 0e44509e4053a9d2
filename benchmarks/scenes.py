"""Scenes whose flow is known at every pixel, for the benchmarks of the picture."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

import flowtex

sys.path.append(str(Path(__file__).parents[1]))  # for paper
Floats = NDArray[np.float64]

#: A point of the double gyre where nothing special happens.
FOCUS = (0.63, 0.37)
#: Speed below which the direction of the flow counts as unknown, and the border in pixels.
SLOW, BORDER = 0.02, 14
#: How far the sheared grid bulges, and how much denser its rows are at one end.
BULGE, CROWDED = 0.12, 1.3


def gyre(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Velocity of the steady double gyre over (0, 2) x (0, 1)."""
    a = 0.1 * np.pi
    return (
        -a * np.sin(np.pi * x) * np.cos(np.pi * y),
        a * np.cos(np.pi * x) * np.sin(np.pi * y),
    )


#: Height of the waves of a crooked grid as a share of its sides, and radians of them along one.
CROOKED, WAVES = 0.02, 8 * np.pi


def gyre_field(columns: int = 120, rows: int = 60, *, crooked: bool = False) -> flowtex.FlowField:
    """Sample the double gyre on a sheared, stretched curvilinear grid.

    The lines of a crooked one are waves, so that it is nowhere straight.
    """
    s, t = np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows))
    if crooked:
        wave = CROOKED * np.sin(np.pi * s) * np.sin(np.pi * t)
        s, t = s + wave * np.sin(WAVES * t), t + wave * np.sin(WAVES * s)
    x = 2 * (s + 0.06 * np.sin(2 * np.pi * s)) + BULGE * np.sin(np.pi * t)
    y = t**CROWDED
    return flowtex.FlowField.from_arrays(np.stack([x, y], -1), np.stack(gyre(x, y), -1))


class View(NamedTuple):
    """A straight view: coordinates and velocity at the middle of each pixel, and what to judge."""

    x: Floats
    y: Floats
    u: Floats
    v: Floats
    pixel: float
    mask: NDArray[np.bool_]
    options: dict[str, Any]


def gyre_view(field: flowtex.FlowField, zoom: float, size: tuple[int, int]) -> View:
    """View the field at a zoom as ``flowtex.render`` does; ``options`` are its arguments."""
    width, height = size
    extent = np.ptp(field.points[field.valid][:, :2], axis=0)
    pixel = max(extent[1], extent[0] * height / width) / 0.92 / zoom / height
    focus = FOCUS if zoom > 1 else tuple(float(c) for c in field.surface.center[:2])
    x, y = np.meshgrid(
        focus[0] + (np.arange(width) + 0.5 - width / 2) * pixel,
        focus[1] - (np.arange(height) + 0.5 - height / 2) * pixel,
    )
    u, v = gyre(x, y)
    return View(
        x, y, u, v, pixel, _judged(x, y, u, v, pixel), {"size": size, "zoom": zoom, "focus": focus}
    )


#: Concentration of the vortices of Stuart's row, and how far the lines of its grid are bent.
STUART, BENT = 0.35, 0.04


def stuart(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Velocity of Stuart's row of vortices, which lie at y = 0 and multiples of 2 pi."""
    scale = np.cosh(y) - STUART * np.cos(x)
    return np.sinh(y) / scale, -STUART * np.sin(x) / scale


def stuart_field(size: tuple[int, int], columns: int = 301, rows: int = 201) -> flowtex.FlowField:
    """Sample one vortex of Stuart's row on a crooked grid with the shape of a picture."""
    half = np.pi * np.array([1, size[1] / size[0]])
    s, t = np.meshgrid(np.linspace(-1, 1, columns), np.linspace(-1, 1, rows))
    bent_s = s + BENT * np.sin(3 * np.pi * t) * (1 - s**2)
    bent_t = t + BENT * np.sin(3 * np.pi * s) * (1 - t**2)
    x = half[0] * bent_s
    y = half[1] * bent_t
    return flowtex.FlowField.from_arrays(np.stack([x, y], -1), np.stack(stuart(x, y), -1))


def stuart_view(zoom: float, size: tuple[int, int]) -> View:
    """View the vortex of :func:`stuart_field`, and at a zoom a point beside its centre."""
    width, height = size
    pixel = 2 * np.pi / width / 0.92 / zoom
    focus = (0.0, 0.0)
    if zoom > 1:
        focus = (1.1, 0.7)
    x, y = np.meshgrid(
        focus[0] + (np.arange(width) + 0.5 - width / 2) * pixel,
        focus[1] - (np.arange(height) + 0.5 - height / 2) * pixel,
    )
    u, v = stuart(x, y)
    far = BORDER * pixel
    mask = (np.abs(x) < np.pi - far) & (np.abs(y) < np.pi * height / width - far)
    mask[:BORDER], mask[-BORDER:], mask[:, :BORDER], mask[:, -BORDER:] = False, False, False, False
    mask &= np.hypot(u, v) > SLOW
    return View(x, y, u, v, pixel, mask, {"size": size, "zoom": zoom, "focus": focus})


def _judged(x: Floats, y: Floats, u: Floats, v: Floats, pixel: float) -> NDArray[np.bool_]:
    mask = np.zeros(x.shape, dtype=bool)
    mask[BORDER:-BORDER, BORDER:-BORDER] = True
    edge, far = BULGE * np.sin(np.pi * np.clip(y, 0, 1) ** (1 / CROWDED)), BORDER * pixel
    mask &= (x > edge + far) & (x < 2 + edge - far) & (y > far) & (y < 1 - far)
    return np.asarray(mask & (np.hypot(u, v) > SLOW))


def vortex_view(
    field: flowtex.FlowField, zoom: float, size: tuple[int, int], *, step: int, late: float
) -> View:
    """View a rectilinear field that varies in time, between a step and the next."""
    points = field.surface.points
    pixel = np.ptp(points[..., 1]) / 0.92 / zoom / size[1]
    rows, columns = np.indices(size[::-1])
    x = field.surface.center[0] + (columns + 0.5 - size[0] / 2) * pixel
    y = field.surface.center[1] - (rows + 0.5 - size[1] / 2) * pixel
    across, along = field.shape
    j = (y - points[0, 0, 1]) / np.ptp(points[..., 1]) * (across - 1)
    i = (x - points[0, 0, 0]) / np.ptp(points[..., 0]) * (along - 1)
    velocity = (1 - late) * field.velocity[step] + late * field.velocity[step + 1]
    u, v = (map_coordinates(velocity[..., c], [j, i], order=1, mode="nearest") for c in (0, 1))
    speed = np.hypot(u, v)
    mask = (j > 2) & (j < across - 3) & (i > 2) & (i < along - 3) & (speed > 0.1 * speed.max())
    mask[:BORDER], mask[-BORDER:], mask[:, :BORDER], mask[:, -BORDER:] = False, False, False, False
    return View(x, y, u, v, pixel, mask, {"zoom": zoom})


class Stage:
    """An off-screen plotter on which a field is drawn, by flowtex or by VTK's Surface LIC."""

    def __init__(self, field: flowtex.FlowField, size: tuple[int, int], **settings: Any) -> None:
        import pyvista as pv

        self.field = field
        self.plotter: Any = pv.Plotter(off_screen=True, window_size=list(size))
        self.plotter.disable_anti_aliasing()
        self.plotter.set_background("white")
        lic = settings.pop("surface_lic", False)
        self.handle = None
        if lic:
            self.plotter.add_actor(lic_actor(grid_of(field)))
        else:
            self.handle = self.plotter.flowtex.add(field, scalars=False, **settings)

    def picture(
        self, zoom: float = 1.0, focus: Any = None, roll: float = 0.0, **state: float
    ) -> NDArray[Any]:
        """Draw one frame; ``state`` sets the handle's ``time`` or ``clock``."""
        from flowtex.plotting.component import point_camera
        from flowtex.scene.options import ViewOptions

        for name, value in state.items():
            setattr(self.handle, name, value)
        view = ViewOptions(zoom=zoom, focus=focus)
        point_camera(self.plotter, self.field.surface, view)
        self.plotter.camera.roll += roll
        self.plotter.render()
        return np.asarray(self.plotter.screenshot(return_img=True))

    def close(self) -> None:
        """Free the window."""
        self.plotter.close()


def grid_of(field: flowtex.FlowField) -> Any:
    """Return the polygons of a structured field, with its vectors as ``velocity``."""
    import pyvista as pv

    rows, columns = field.shape
    grid = pv.StructuredGrid()
    grid.points, grid.dimensions = field.points.reshape(-1, 3), (columns, rows, 1)
    grid["velocity"] = field.velocity[0].reshape(-1, 3)
    return grid.extract_surface(algorithm="dataset_surface")


def lic_actor(surface: Any) -> Any:
    """Draw polygons with VTK's Surface LIC at its enhanced setting; without light it is noise."""
    from vtkmodules.vtkRenderingCore import vtkActor
    from vtkmodules.vtkRenderingLICOpenGL2 import vtkSurfaceLICInterface, vtkSurfaceLICMapper

    surface.set_active_vectors("velocity")
    mapper = vtkSurfaceLICMapper()
    mapper.SetInputData(surface)
    mapper.SetInputArrayToProcess(0, 0, 0, 0, "velocity")
    mapper.ScalarVisibilityOff()
    lic: vtkSurfaceLICInterface = mapper.GetLICInterface()
    lic.SetNumberOfSteps(20)
    lic.SetStepSize(0.5)
    lic.SetEnhancedLIC(1)
    actor = vtkActor()
    actor.SetMapper(mapper)
    return actor


def colour_lic(plotter: Any, name: str, mode: int) -> None:
    """Colour the Surface LIC of a plotter by speed, blended (mode 0) or multiplied (mode 1)."""
    import pyvista as pv

    actor = next(iter(plotter.renderer.GetActors()))
    mapper = actor.GetMapper()
    surface = pv.wrap(mapper.GetInput())
    surface["speed"] = np.linalg.norm(surface["velocity"], axis=1)
    table = pv.LookupTable(name, scalar_range=surface.get_data_range("speed"))
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("speed")
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    mapper.InterpolateScalarsBeforeMappingOn()
    mapper.ScalarVisibilityOn()
    mapper.GetLICInterface().SetColorMode(mode)
