"""What VTK draws, judged by what it shows; test_agreement.py judges it by the pictures of NumPy."""

from __future__ import annotations

import contextlib
import gc
import weakref
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from flows import scattered_swinging, swinging
from measures import carried, streaks
from plain_pyvista import off_colours
from scipy.ndimage import binary_erosion

import flowtex
from flowtex.plotting.component import point_camera
from flowtex.rendering import mesh_levels
from flowtex.rendering.camera import Camera, apply_camera
from flowtex.rendering.vtk import slice_levels
from flowtex.scene.options import ViewOptions

SIZE = (240, 180)


def gyre(x: Any, y: Any) -> tuple[Any, Any]:
    a = 0.1 * np.pi
    return (-a * np.sin(np.pi * x) * np.cos(np.pi * y), a * np.cos(np.pi * x) * np.sin(np.pi * y))


@cache
def gyre_field(columns: int = 100, rows: int = 50) -> flowtex.FlowField:
    x, y = np.meshgrid(np.linspace(0, 2, columns), np.linspace(0, 1, rows))
    return flowtex.FlowField.from_arrays(np.stack([x, y], -1), np.stack(gyre(x, y), -1))


def test_the_way_to_a_view_does_not_show_in_it(plotter: Any) -> None:
    field = gyre_field()
    plotter.flowtex.add(field, scalars=False)
    pictures = []
    for focus in ((0.63, 0.37), (0.63 + 3e-4, 0.37), (1.7, 0.8), (0.63, 0.37)):
        point_camera(plotter, field.surface, ViewOptions(zoom=2e4, focus=focus))
        plotter.render()
        pictures.append(plotter.screenshot(return_img=True).astype(float))
    assert np.sqrt(np.mean((pictures[0] - pictures[3]) ** 2)) < 2
    assert np.abs(pictures[0] - pictures[2]).mean() > 10


def test_far_from_the_origin_the_picture_is_as_sharp(opengl: Any) -> None:
    y, x = np.mgrid[0:0.5:51j, 0:1:101j]
    velocity = np.stack(gyre(2 * x, 2 * y), axis=-1)
    pictures = []
    for offset in (0.0, 1e6):
        points = np.stack([x + offset, y - offset], axis=-1)
        field = flowtex.FlowField.from_arrays(points, velocity)
        pictures.append(flowtex.render(field, size=SIZE, zoom=8, scalars=False).astype(float))
    assert np.corrcoef(pictures[0].ravel(), pictures[1].ravel())[0, 1] > 0.98


def ring(turned: int = 0) -> flowtex.FlowField:
    angle = np.linspace(0, 2 * np.pi, 65) + turned * 2 * np.pi / 64
    radius = np.geomspace(0.2, 1, 25)[:, None]
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    return flowtex.FlowField.from_arrays(np.stack([x, y], -1), np.stack([1 - y, 0.3 + x], -1))


@pytest.mark.parametrize("zoom", [0.25, 6])
def test_a_seam_is_not_seen(opengl: Any, zoom: float) -> None:
    # The same flow on the same ring, joined at another column: if the seam left a trace, the
    # two pictures would differ there.
    options: dict[str, Any] = {"size": SIZE, "zoom": zoom, "focus": (0.6, 0.0), "scalars": False}
    here, there = (flowtex.render(ring(n), **options).astype(float) for n in (0, 21))
    assert np.abs(here - there).mean() < 6.0


def test_what_changes_the_shader_or_a_value_comes_back(plotter: Any) -> None:
    handle = plotter.flowtex.add(gyre_field(), scalars=False)
    first = plotter.screenshot(return_img=True)
    for name, value in (("lod", False), ("texture", "streaklets"), ("motion", "speed")):
        was = getattr(handle.settings, name)
        setattr(handle.settings, name, value)
        handle.clock = 0.0
        pictures = [first, plotter.screenshot(return_img=True)]
        if name == "motion":
            handle.clock = 1.0
            pictures.append(plotter.screenshot(return_img=True))
        setattr(handle.settings, name, was)
        for before, after in pairwise(pictures):
            assert np.abs(before.astype(float) - after).mean() > 5
        np.testing.assert_array_equal(first, plotter.screenshot(return_img=True))


def crooked_grid() -> flowtex.FlowField:
    s, t = np.meshgrid(np.linspace(0, 1, 160), np.linspace(0, 1, 80))
    wave = 0.03 * np.sin(np.pi * s) * np.sin(np.pi * t)
    x, y = 2 * (s + wave * np.sin(20 * t)), t + wave * np.sin(20 * s)
    return flowtex.FlowField.from_arrays(np.stack([x, y], -1), np.stack(gyre(x, y), -1))


def globe() -> flowtex.FlowField:
    a, b = np.meshgrid(np.linspace(0, 2 * np.pi, 161), np.linspace(-np.pi / 2, np.pi / 2, 81))
    x, y, z = points = np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)])
    flow = np.stack([-y, x + 0.7 * z, -0.7 * y])  # around an axis that is not the poles'
    return flowtex.FlowField.from_arrays(np.moveaxis(points, 0, -1), np.moveaxis(flow, 0, -1))


@pytest.mark.parametrize(
    ("field", "zoom", "focus", "most"),
    [
        (crooked_grid, 1, (0.63, 0.37), 0.45),  # off by one where a card filters with few digits
        (crooked_grid, 6, (0.63, 0.37), 0.2),
        (globe, 1, (0.3, 0.2, 0.9), 0.4),  # a pole is seen
    ],
)
def test_large_triangles_draw_what_small_ones_do(
    opengl: Any, monkeypatch: pytest.MonkeyPatch, field: Any, zoom: float, focus: Any, most: float
) -> None:
    flow, pictures, counts = field(), [], []
    for shares in ((1.0, 1.0), (mesh_levels.PLACED_SHARE, mesh_levels.HEIGHT_SHARE)):
        monkeypatch.setattr(mesh_levels, "PLACED_SHARE", shares[0])
        monkeypatch.setattr(mesh_levels, "HEIGHT_SHARE", shares[1])
        with contextlib.closing(pv.Plotter(off_screen=True, window_size=list(SIZE))) as plotter:
            handle = plotter.flowtex.add(flow, scalars=False, lighting=False)
            if field is globe:
                plotter.camera.position, plotter.camera.focal_point = 4 * np.array(focus), (0, 0, 0)
            else:
                point_camera(plotter, flow.surface, ViewOptions(zoom=zoom, focus=focus))
            plotter.render()
            pictures.append(np.asarray(plotter.screenshot(return_img=True), float))
            counts.append(sum(mesh.n_cells for mesh in handle.surface.meshes))
    assert counts[0] > 3 * counts[1]
    covered: Any = (np.array(pictures) < 255).any(axis=(0, 3))
    inside = binary_erosion(covered, iterations=8)
    off = np.abs(pictures[0] - pictures[1])[inside]
    assert np.sqrt(np.mean(off**2)) < most


def test_scalars_keep_their_colours_and_their_bar(plotter: Any) -> None:
    field = gyre_field()
    handle = plotter.flowtex.add(field, scalars="speed", cmap="plasma", clim=(0, 0.3))
    assert list(plotter.scalar_bars.keys()) == ["speed"]
    assert handle.actor.mapper.scalar_range == (0, 0.3)
    handle.settings.strength = 0.0
    plain = plotter.screenshot(return_img=True)
    mesh: Any = pv.StructuredGrid(*(field.points[..., c][:, :, None] for c in range(3)))
    mesh["speed"] = field.speed[0].ravel(order="F")
    assert off_colours(plain, mesh, field, scalars="speed", cmap="plasma", clim=(0, 0.3)) < 2


def test_colours_outside_of_the_range_and_of_no_value(plotter: Any) -> None:
    handle = plotter.flowtex.add(
        gyre_field(), scalars="speed", clim=(0.1, 0.2), strength=0.0, lighting=False
    )
    table = handle.actor.mapper.lookup_table
    table.below_range_color, table.above_range_color = "red", "blue"
    table.nan_color = "lime"
    mesh = handle.actor.mapper.dataset
    values = np.array(mesh.point_data["speed"]).reshape(50, 100)
    values[:, :50] = np.nan
    mesh.point_data["speed"] = values.ravel()
    picture = plotter.screenshot(return_img=True).astype(int)
    right = picture[:, picture.shape[1] // 2 + 2 :]
    for colour in ([255, 0, 0], [0, 0, 255]):
        assert (right == colour).all(axis=-1).mean() > 0.02
        assert not (picture[:, : picture.shape[1] // 2 - 2] == colour).all(axis=-1).any()
    left = picture[:, : picture.shape[1] // 2 - 2]
    assert (left == [0, 255, 0]).all(axis=-1).mean() > 0.4


def test_edges_do_not_take_the_texture_away(plotter: Any) -> None:
    handle = plotter.flowtex.add(gyre_field(9, 5), scalars=False)
    plain = plotter.screenshot(return_img=True).astype(float)
    handle.actor.prop.show_edges = True
    handle.actor.prop.edge_color = "red"
    plotter.render()
    edged = plotter.screenshot(return_img=True).astype(float)
    red = edged[..., 0] - edged[..., 1] > 20
    assert 0.005 < red.mean() < 0.3
    same = (np.abs(edged - plain).max(axis=-1) < 2)[~red]
    assert same.mean() > 0.85


SERIES = {
    "grid": (swinging, {}),
    "streamlines": (swinging, {"lines": "streamlines"}),
    "triangles": (scattered_swinging, {}),
}


def shown_at(plotter: Any, time: float) -> Any:
    for handle in plotter.flowtex:
        handle.time = time
    return np.asarray(plotter.screenshot(return_img=True), float)


@pytest.mark.parametrize("name", SERIES)
def test_any_order_of_times_shows_what_a_new_plotter_does(name: str) -> None:
    make, options = SERIES[name]
    first, middle, last = make().times
    between = (first + middle) / 2
    orders = [first, middle, last, between, middle, first, between, last, middle]

    def opened() -> Any:
        plotter: Any = pv.Plotter(off_screen=True, window_size=[96, 96])
        plotter.flowtex.add(make(), scalars=False, **options)
        return plotter

    expected = {}
    for time in (first, middle, last, between):
        with contextlib.closing(opened()) as plotter:
            expected[time] = shown_at(plotter, time)
        assert expected[time][32:64, 32:64].std() > 12
    with contextlib.closing(opened()) as plotter:
        for time in orders:
            np.testing.assert_array_equal(shown_at(plotter, time), expected[time])


def test_several_on_one_plotter_and_removal_leaves_nothing(plotter: Any) -> None:
    empty = plotter.screenshot(return_img=True)
    left = plotter.flowtex.add(gyre_field())
    plotter.flowtex.add(gyre_field(), scalars=False)
    assert len(plotter.flowtex) == 2
    plotter.screenshot(return_img=True)
    actor = left.actor
    plotter.flowtex.clear()
    assert len(plotter.flowtex) == 0
    assert left.closed
    assert list(plotter.scalar_bars.keys()) == []
    assert not plotter.renderer.actors
    assert not actor.mapper.HasObserver("UpdateShaderEvent")
    assert actor.GetShaderProperty().GetNumberOfShaderReplacements() == 0
    left.remove()
    np.testing.assert_array_equal(plotter.screenshot(return_img=True), empty)


def test_a_closed_plotter_lets_everything_go(opengl: Any) -> None:
    plotter: Any = pv.Plotter(off_screen=True, window_size=[100, 100])
    handle = plotter.flowtex.add(gyre_field())
    plotter.screenshot(return_img=True)
    layer = weakref.ref(handle.surface)
    plotter.close()
    assert handle.closed
    del handle, plotter
    gc.collect()
    assert layer() is None


def test_a_period_closes_into_a_loop(plotter: Any) -> None:
    handle = plotter.flowtex.add(gyre_field(), scalars=False, motion="speed", period=2.0)
    frames = []
    for clock in (0.0, 0.5, 2.0, 6.5):
        handle.clock = clock
        frames.append(plotter.screenshot(return_img=True).astype(float))
    assert np.abs(frames[0] - frames[1]).mean() > 5
    np.testing.assert_array_equal(frames[0], frames[2])
    np.testing.assert_array_equal(frames[1], frames[3])


def uniform_field() -> flowtex.FlowField:
    y, x = np.mgrid[0:3:25j, 0:4:33j]
    return flowtex.FlowField.from_arrays(np.stack([x, y], -1), np.stack([2 + y, 0 * y], -1))


@pytest.mark.parametrize(("motion", "units"), [("uniform", "units"), ("speed", "pixels")])
def test_streaming_carries_the_picture_at_the_speed_asked_for(
    plotter: Any, motion: str, units: str
) -> None:
    field = uniform_field()
    point_camera(plotter, field.surface, ViewOptions(zoom=2))
    pixel = 2 * plotter.camera.parallel_scale / plotter.window_size[1]
    speed = 60.0 * (pixel if units == "units" else 1.0)
    handle = plotter.flowtex.add(
        field, scalars=False, motion=motion, speed=speed, speed_in=units, reset_camera=False
    )
    point_camera(plotter, field.surface, ViewOptions(zoom=2))
    frames = []
    for clock in (0.5, 0.6):
        handle.clock = clock
        frames.append(plotter.screenshot(return_img=True))
    height, width = frames[0].shape[:2]
    y = field.surface.center[1] - (np.arange(height) + 0.5 - height / 2) * pixel
    pace = (2 + y) / np.sqrt(np.mean(field.speed**2)) if motion == "speed" else np.ones(height)
    right = np.repeat((60.0 * 0.1 * pace)[:, None], width, axis=1)
    with_it = carried(frames[0], frames[1], right, 0 * right, 20)
    assert with_it > 0.93
    # Neither twice as fast nor the other way.
    for other in (2 * right, 0 * right, -right):
        assert carried(frames[0], frames[1], other, 0 * right, 20) < with_it - 0.03


def test_streaks_along_an_oblique_view_are_as_long_as_others(opengl: Any) -> None:
    tilt = 75
    y, x = np.mgrid[-5:5:21j, -5:5:21j]
    points = np.stack([x, y], axis=-1)
    field = flowtex.FlowField.from_arrays(points, np.stack([0.05 + 0 * x, 1 + 0 * x], axis=-1))
    coherence = []
    for degrees in (0, tilt):
        angle = np.radians(degrees)
        eye = 20.0 * np.array([0, -np.sin(angle), np.cos(angle)])
        up = (0.0, float(np.cos(angle)), float(np.sin(angle)))
        camera = flowtex.Camera(tuple(eye), (0.0, 0.0, 0.0), up, view_angle=3.0)
        picture = flowtex.render(field, size=(300, 240), scalars=False, camera=camera)
        middle = np.zeros(picture.shape[:2], bool)
        middle[75:-75, 15:-15] = True
        right = np.full(middle.shape, 0.05)
        found = streaks(picture, right, np.full(middle.shape, np.cos(angle)), middle)
        coherence.append(found["coherence"])
    # Streaks half as long have 0.83.
    assert coherence[1] > coherence[0] - 0.05


@pytest.mark.parametrize("tilt", [60, 75, 80])
def test_streaks_do_not_smear_towards_the_horizon(tilt: int, opengl: Any) -> None:
    y, x = np.mgrid[-10:10:41j, -10:10:41j]
    points = np.stack([x, y], axis=-1)
    field = flowtex.FlowField.from_arrays(points, np.stack([0 * x, 1 + 0 * x], axis=-1))
    # The flow leads to its vanishing point, straight above the middle of the picture.
    angle, half = np.radians(tilt), np.tan(np.radians(15))
    eye = 14.0 * np.array([0, -np.sin(angle), np.cos(angle)])
    camera = flowtex.Camera(tuple(eye), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), view_angle=30.0)
    picture = flowtex.render(field, size=(450, 300), scalars=False, camera=camera)
    rows, columns = np.mgrid[0:300, 0:450]
    right = (columns - 224.5) / 150 * half
    up = (149.5 - rows) / 150 * half
    vanishing = 1 / np.tan(angle)
    drawn = np.flatnonzero((picture[:, 200:250] < 250).all(axis=(1, 2)))
    far = np.zeros(rows.shape, bool)
    far[drawn[0] + 10 : drawn[0] + len(drawn) // 3, 60:-60] = True
    found = streaks(picture, -right, vanishing - up, far)
    assert found["angle"] < {60: 4.0, 75: 7.0, 80: 9.0}[tilt]


def level_of_slices(handle: Any) -> int:
    """Return the coarsest mip level of the slices that are drawn."""
    return int(handle.surface._base._gpu["u_slices"].GetMaxLevel())


@pytest.mark.parametrize("field", [gyre_field, globe, ring])
def test_near_views_need_no_mip_levels(
    opengl: Any, monkeypatch: pytest.MonkeyPatch, field: Any
) -> None:
    """They are the same pictures with all levels, and farther ones get these."""
    flow = field()
    first = Camera.aside(flow.points[flow.valid], 1.5)
    focus = np.array(first.focal_point)
    pictures: dict[str, list[Any]] = {}
    levels: dict[str, list[int]] = {}
    for name, cells in (("needed", slice_levels.FINEST_CELLS), ("all", 0.0), ("none", np.inf)):
        monkeypatch.setattr(slice_levels, "FINEST_CELLS", cells)
        pictures[name], levels[name] = [], []
        with contextlib.closing(pv.Plotter(off_screen=True, window_size=[120, 90])) as plotter:
            handle = plotter.flowtex.add(flow, scalars=False, lighting=False)
            for distance in (0.05, 0.5, 1.0, 2.0):
                place = focus + distance * (np.array(first.position) - focus)
                apply_camera(replace(first, position=tuple(place)), plotter.camera)
                plotter.camera_set = True
                plotter.renderer.reset_camera_clipping_range()
                plotter.render()
                pictures[name].append(plotter.screenshot(return_img=True))
                levels[name].append(level_of_slices(handle))
    np.testing.assert_array_equal(pictures["needed"], pictures["all"])
    assert levels["needed"][-1] == levels["all"][0] > 0
    if field is gyre_field:  # the other grids have cells without a width, or narrow ones
        assert levels["needed"][0] == 0
    assert levels["none"] == [0, 0, 0, 0]
    assert (np.array(pictures["none"]) != pictures["all"]).any(), "no view reads levels"
