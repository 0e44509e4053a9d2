"""Arguments that PyVista has too: arrays as scalars, cameras of plotters, and sizes of windows."""

from __future__ import annotations

from contextlib import closing
from typing import Any

import numpy as np
import pytest
import pyvista as pv

import flowtex
from flowtex.plotting import component
from flowtex.scene.scene import Scene

pytestmark = [
    pytest.mark.usefixtures("opengl"),
    pytest.mark.filterwarnings("ignore::flowtex.errors.Notice"),
]
QUICK: dict[str, Any] = {"size": (160, 120), "samples": 1, "strength": 0.0}


def plane() -> Any:
    mesh: Any = pv.Plane(i_resolution=12, j_resolution=9)
    mesh["U"] = np.tile([1.0, 0.2, 0], (mesh.n_points, 1))
    mesh["x"] = np.array(mesh.points[:, 0])
    return mesh


def test_array_colours_as_if_it_were_in_the_mesh() -> None:
    mesh = plane()
    by_name = flowtex.render(mesh, scalars="x", **QUICK)
    for array in (np.array(mesh["x"]), mesh["x"].tolist()):
        np.testing.assert_array_equal(flowtex.render(mesh, scalars=array, **QUICK), by_name)
    assert "Data" not in mesh.array_names
    plotter: Any = pv.Plotter(off_screen=True, window_size=[160, 120])
    with closing(plotter):
        handle = plotter.flowtex.add(mesh, scalars=2 * mesh["x"])
        assert list(plotter.scalar_bars.keys()) == ["Data"]
        assert handle.scene.scalar_limits == pytest.approx((-1, 1))


def test_array_belongs_to_points_or_cells_of_a_volume_before_a_cut() -> None:
    grid: Any = pv.ImageData(dimensions=(9, 8, 7))
    grid["U"] = np.ones((grid.n_points, 3))
    heights = np.array(grid.points[:, 2])
    scene = Scene.of(grid, slice="z=2.5", scalars=heights)
    assert scene.scalar_limits == (0, 6)
    np.testing.assert_allclose(scene.scalar("Data"), 2.5)
    cells = np.array(grid.cell_centers().points[:, 0])
    assert Scene.of(grid, slice="z=2.5", scalars=cells).scalar_limits == (0.5, 7.5)


def test_array_of_a_field_has_its_nodes() -> None:
    field = flowtex.examples.vortex_field()
    steps = np.arange(np.prod((len(field.times), *field.shape)), dtype=float)
    scene = Scene.of(field, scalars=steps.reshape(-1, *field.shape))
    assert scene.scalar_limits == (0, steps[-1])


def test_camera_of_a_plotter_shows_the_same_view() -> None:
    plotter: Any = pv.Plotter(off_screen=True, window_size=[160, 120], lighting="light kit")
    with closing(plotter):
        plotter.disable_anti_aliasing()
        look: Any = {"scalars": "x", "show_scalar_bar": False, "samples": 1, "strength": 0.0}
        plotter.flowtex.add(plane(), **look)
        plotter.camera_position = [(0.6, -1.2, 1.5), (0.1, 0, 0), (0, 0, 1)]
        seen = plotter.screenshot(return_img=True).astype(int)
        image = flowtex.render(plane(), scalars="x", camera=plotter.camera, **QUICK).astype(int)
        widget = flowtex.FlowWidget(plane(), camera=plotter.camera)
        assert widget.camera["position"] == pytest.approx(plotter.camera.position)
        widget.close()
    assert (np.abs(seen - image).max(axis=-1) > 8).mean() < 0.03
    assert (seen < 250).any(axis=-1).mean() > 0.1


def test_what_is_added_later_is_seen(plotter: Any) -> None:
    plotter.flowtex.add(flowtex.examples.double_gyre_field(), samples=9, show_scalar_bar=False)
    plotter.render()
    # Nearer than the clipping range of the flat surface alone.
    plotter.add_mesh(pv.Sphere(radius=0.2, center=(1.0, 0.5, 0.5)), color="red", lighting=False)
    plotter.render()
    assert (plotter.screenshot()[120, 160] == [255, 0, 0]).all()
    # A range that somebody has set stays.
    plotter.camera.clipping_range = near, far = 0.01, 77.0
    plotter.render()
    np.testing.assert_allclose(plotter.camera.clipping_range, (near, far))


def test_a_frame_looks_at_the_bounds_once(plotter: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    field, frames = flowtex.examples.double_gyre_field(), []
    monkeypatch.setattr(component, "_follow_bounds", lambda *_: frames.append(1))
    for _ in range(3):
        plotter.flowtex.add(field, samples=9, show_scalar_bar=False)
        component.point_camera(plotter, field.surface)
        plotter.flowtex.clear()
    plotter.screenshot(return_img=True)
    frames.clear()
    plotter.render()
    assert len(frames) == 1
