"""The passes before a frame draw what sums in the fragments of the mesh do, whatever VTK does."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkRenderingCore import vtkHardwareSelector

import flowtex.plotting.component  # noqa: F401 plotter.flowtex
from flowtex import FlowField
from flowtex._util.array_types import Bytes
from flowtex.rendering import uniforms
from flowtex.rendering.vtk import layer
from flowtex.textures.tiles.grid_pyramid import GridPyramid

pytestmark = [
    pytest.mark.usefixtures("opengl"),
    pytest.mark.filterwarnings("ignore::flowtex.errors.Notice"),
]
SIZE = [240, 180]
#: Greatest share of pixels that may differ by more than rounding: some at outlines.
MOST_OTHERS = 0.002


def saddle() -> Any:
    """Return a curved grid that hides a part of itself."""
    s, t = np.meshgrid(np.linspace(0, 1.7 * np.pi, 41), np.linspace(-1, 1, 17))
    mesh: Any = pv.StructuredGrid(np.cos(s), np.sin(s), t + 0.2 * np.sin(3 * s))
    x, y, _ = mesh.points.T
    mesh["U"] = np.column_stack([-y, x, 0.6 * np.cos(3 * np.arctan2(y, x))])
    return mesh


def ball() -> Any:
    """Return triangles with a crease in their shading, which is none."""
    mesh: Any = pv.Icosphere(radius=1.1, nsub=3)
    mesh.clear_data()
    mesh["U"] = np.cross([0.2, 0.5, 1.0], mesh.points)
    return mesh


def clip(plotter: Any, handle: Any) -> None:
    cut = vtkPlane()
    cut.SetOrigin(0, 0, 0.1)
    cut.SetNormal(0.3, 0.1, 1)
    handle.actor.mapper.AddClippingPlane(cut)


def cull(plotter: Any, handle: Any) -> None:
    handle.actor.prop.culling = "front"


def edges(plotter: Any, handle: Any) -> None:
    handle.actor.prop.show_edges = True


def place(plotter: Any, handle: Any) -> None:
    handle.actor.scale, handle.actor.orientation = (0.5, 1.5, 1.0), (20, 30, 40)


def hide(plotter: Any, handle: Any) -> None:
    plotter.add_mesh(pv.Sphere(radius=0.6, center=(0.9, 0.4, 0.3)), color="red")


def veil(plotter: Any, handle: Any) -> None:
    plotter.enable_depth_peeling()
    plotter.add_mesh(pv.Sphere(radius=1.4), color="red", opacity=0.3)


def parallel(plotter: Any, handle: Any) -> None:
    plotter.enable_parallel_projection()


def shade(plotter: Any, handle: Any) -> None:
    plotter.enable_ssao(radius=0.5)


def enlarge(plotter: Any, handle: Any) -> None:
    plotter.enable_anti_aliasing("ssaa")


def sample(plotter: Any, handle: Any) -> None:
    plotter.enable_anti_aliasing("msaa", multi_samples=4)


def silhouette(plotter: Any, handle: Any) -> None:
    plotter.add_silhouette(handle.actor.mapper.dataset, color="blue")


def see_through(plotter: Any, handle: Any) -> None:
    handle.actor.prop.opacity = 0.5


def lines(plotter: Any, handle: Any) -> None:
    handle.actor.prop.style = "wireframe"


def dots(plotter: Any, handle: Any) -> None:
    handle.actor.prop.style, handle.actor.prop.point_size = "points", 5


def near(plotter: Any, handle: Any) -> None:
    plotter.camera.zoom(60)


def depths(plotter: Any, handle: Any) -> None:
    plotter.enable_eye_dome_lighting()


CHANGES = [clip, cull, edges, place, hide, veil, parallel, sample, silhouette, near, shade, depths]
#: Those that keep the sum in the fragments of the mesh.
FORWARD = [see_through, lines, dots]


def picture(mesh: Any, change: Callable[[Any, Any], None] | None, **options: Any) -> Bytes:
    """Draw a mesh with a change."""
    plotter: Any = pv.Plotter(off_screen=True, window_size=SIZE)
    with closing(plotter):
        plotter.disable_anti_aliasing()
        handle = plotter.flowtex.add(mesh, show_scalar_bar=False, samples=15, **options)
        plotter.camera_position = "iso"
        plotter.reset_camera()
        if change:
            change(plotter, handle)
        return np.asarray(plotter.screenshot(return_img=True))


def assert_alike(one: Bytes, other: Bytes, least: int = 2) -> None:
    """Fail unless only some pixels at outlines differ, by more than rounding or at ``least``."""
    change = np.abs(one.astype(int) - other).max(axis=-1)
    assert (change > least).mean() < MOST_OTHERS
    assert one.std() > 20, "nothing is drawn"


def assert_same_in_fragments(
    draw: Callable[[], Bytes], monkeypatch: pytest.MonkeyPatch, least: int = 2
) -> None:
    """Fail unless sums in the fragments of the mesh give the picture that passes give.

    Without the local mean of pixels around, which fragments do not see.
    """
    for module in (layer, uniforms):
        monkeypatch.setattr(module, "is_even", lambda *_: False)
    drawn = draw()
    monkeypatch.setattr(layer, "is_deferred", lambda *_: False)
    assert_alike(drawn, draw(), least)


@pytest.mark.parametrize("make", [saddle, ball])
@pytest.mark.parametrize("change", [None, *CHANGES, *FORWARD])
def test_passes_draw_what_fragments_do(
    make: Callable[[], Any],
    change: Callable[[Any, Any], None] | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    mesh = make()
    deferred: list[bool] = []
    decide = layer.is_deferred

    def decided(*words: Any) -> bool:
        deferred.append(decide(*words))
        return deferred[-1]

    monkeypatch.setattr(layer, "is_deferred", decided)

    def draw() -> Bytes:
        drawn = picture(mesh, change)
        assert not deferred or deferred[-1] == (change not in FORWARD)
        return drawn

    if change in FORWARD:  # by sums in the fragments, as the other picture would be
        assert draw().std() > 20, "nothing is drawn"
    else:
        # Samples beside the middle of a pixel belong to triangles that do not cover it.
        assert_same_in_fragments(draw, monkeypatch, 16 if change is sample else 2)
    assert deferred


@pytest.mark.parametrize("change", [None, near, place, edges])
@pytest.mark.parametrize("make", [saddle, ball])
def test_larger_picture_of_a_pass_has_the_pixels_of_the_frame(
    make: Callable[[], Any], change: Callable[[Any, Any], None] | None
) -> None:
    """A pass that smooths a picture draws it with four times as many pixels along a side."""

    def both(plotter: Any, handle: Any) -> None:
        enlarge(plotter, handle)
        if change:
            change(plotter, handle)

    mesh = make()
    plain = picture(mesh, change).astype(float)
    smooth = picture(mesh, both).astype(float)
    # The filter of the pass, over a bit more than a pixel, takes contrast and moves nothing.
    difference = np.abs(smooth - plain).mean()
    for axis in (0, 1):
        for pixels in (-1, 1):
            moved = np.roll(plain, pixels, axis)
            assert difference < 0.7 * np.abs(smooth - moved).mean()
    assert smooth.std() > 0.9 * plain.std() > 20


def test_renderers_of_a_window_and_linked_views_have_their_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def draw() -> Bytes:
        plotter: Any = pv.Plotter(off_screen=True, window_size=[401, 201], shape=(1, 2))
        with closing(plotter):
            plotter.disable_anti_aliasing()
            for column, mesh in enumerate((saddle(), ball())):
                plotter.subplot(0, column)
                plotter.flowtex.add(mesh, show_scalar_bar=False, samples=15)
            plotter.link_views()
            plotter.camera_position = "iso"
            plotter.camera.zoom(4)
            return np.asarray(plotter.screenshot(return_img=True))

    assert_same_in_fragments(draw, monkeypatch)


def test_flows_of_one_renderer_hide_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    def draw() -> Bytes:
        plotter: Any = pv.Plotter(off_screen=True, window_size=SIZE)
        with closing(plotter):
            plotter.disable_anti_aliasing()
            for mesh in (saddle(), ball()):
                plotter.flowtex.add(mesh, show_scalar_bar=False, samples=15)
            handle = plotter.flowtex.add(pv.Sphere(), vectors="Normals", show_scalar_bar=False)
            plotter.camera_position = "iso"
            plotter.screenshot(return_img=True)
            handle.remove()
            plotter.render()
            return np.asarray(plotter.screenshot(return_img=True))

    assert_same_in_fragments(draw, monkeypatch)


def test_flow_that_is_hidden_for_a_while_comes_back() -> None:
    plotter: Any = pv.Plotter(off_screen=True, window_size=SIZE)
    with closing(plotter):
        plotter.disable_anti_aliasing()
        handles = [
            plotter.flowtex.add(mesh, show_scalar_bar=False, samples=5)
            for mesh in (saddle(), ball())
        ]
        pictures = []
        for hidden in (None, 0, 1, 0, None):
            for number, handle in enumerate(handles):
                handle.actor.SetVisibility(number != hidden)
            plotter.render()
            pictures.append(np.asarray(plotter.screenshot(return_img=True)))
        np.testing.assert_array_equal(pictures[0], pictures[4])
        np.testing.assert_array_equal(pictures[1], pictures[3])
        assert (pictures[1] != pictures[0]).mean() > 0.02


def test_large_picture_is_drawn_part_by_part(monkeypatch: pytest.MonkeyPatch) -> None:
    def draw() -> Bytes:
        plotter: Any = pv.Plotter(off_screen=True, window_size=SIZE)
        with closing(plotter):
            plotter.disable_anti_aliasing()
            plotter.flowtex.add(saddle(), show_scalar_bar=False, samples=15)
            plotter.camera_position = "iso"
            return np.asarray(plotter.screenshot(return_img=True, scale=2))

    assert_same_in_fragments(draw, monkeypatch)


def test_selection_finds_the_surface() -> None:
    plotter: Any = pv.Plotter(off_screen=True, window_size=SIZE)
    with closing(plotter):
        plotter.flowtex.add(ball(), show_scalar_bar=False, samples=15)
        plotter.show(auto_close=False)
        selector = vtkHardwareSelector()
        selector.SetRenderer(plotter.renderer)
        selector.SetArea(0, 0, SIZE[0] - 1, SIZE[1] - 1)
        assert selector.Select().GetNumberOfNodes() == 1


def test_hidden_blocks_are_left_out_but_not_where_the_root_has_no_cells(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 5000)
    x, y = np.meshgrid(np.arange(257.0), np.arange(193.0))
    velocity = np.stack([1 + 0 * x, 0.5 + 0 * x], axis=-1)
    velocity[100:120, 200:215] = np.nan
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), velocity)
    pyramid = GridPyramid(field)
    assert pyramid.depth >= 1 and pyramid.blocks == (3, 4)
    expected = np.zeros((3, 4), dtype=bool)
    expected[1, 3] = True  # of the hole
    assert (pyramid.visible_blocks(np.empty((0, 4), np.float32)) == expected).all()
    geometry = pyramid.root_geometry
    seen = geometry.coordinate[geometry.shape[0] - 3, 2]
    expected[2, 0] = True
    assert (pyramid.visible_blocks(np.array([[*seen, 0, 1]], np.float32)) == expected).all()
