"""Points as a page shows them: values and paths."""

from __future__ import annotations

import asyncio
import json
import math
from typing import Any

import numpy as np
import pytest
from earth_fields import winds
from triangle_meshes import sphere

pytest.importorskip("trame_rca")

from small_pages import small_page

from flowtex import FlowField
from flowtex.app import FlowApp
from flowtex.app.streaming.points import path_of
from flowtex.field.earth.projection import Projection
from flowtex.scene.probe import locate, probe
from flowtex.scene.scene import Scene
from flowtex.settings import Settings


def flat() -> FlowField:
    y, x = np.mgrid[-1:1:21j, -2:2:41j]
    velocity = np.stack([1 + 0 * x, 0.25 * x], axis=-1)
    points = np.stack([x, y], -1)
    return FlowField.from_arrays(points, velocity, periodic="", length_unit="m", time_unit="s")


def view_of(field: FlowField, **settings: object) -> Scene:
    chosen = Settings()
    chosen.update(**settings)
    return Scene(field, chosen)


def test_a_path_can_be_sent() -> None:
    view = view_of(flat(), samples=21)
    at = locate(view.field, (0.3, 0.1))
    assert at is not None
    found = probe(view, at, pixel=0.01)
    told = json.loads(json.dumps(path_of(found, at, view.field), allow_nan=False))
    assert told["point"]["position"] == pytest.approx([0.3, 0.1, 0.0])
    assert told["point"]["index"] == pytest.approx([23, 11])
    # The part with samples goes from the first of them to the last.
    ends = [told["path"]["sampled"][n] for n in (0, -1)]
    assert ends == [pytest.approx(found.points[n]) for n in (0, -1)]
    assert told["path"]["directed"] is True
    samples = told["path"]["samples"]
    # The kernel is a Hann window over 21 samples at equal distances.
    assert [sample["lag"] for sample in samples] == pytest.approx(found.lags)
    assert np.diff([sample["lag"] for sample in samples]) == pytest.approx(-found.step, rel=0.01)
    window = 0.5 + 0.5 * np.cos(np.pi * np.arange(-10, 11) / 11)
    weights = [sample["weight"] for sample in samples]
    assert weights == pytest.approx(window / window.sum(), rel=1e-3)
    assert [sample["noise"] for sample in samples] == pytest.approx(found.noise)


def read(app: FlowApp, **at: Any) -> Any:
    return asyncio.run(app.area.points.read(0, at))


@pytest.mark.usefixtures("opengl")
def test_a_place_of_the_view_is_a_point_of_the_surface() -> None:
    app = small_page(flat(), 5, 240, 160)
    middle = read(app, place=[0.0, 0.0])["point"]
    assert middle["position"] == pytest.approx([0, 0, 0], abs=1e-9)
    assert middle["values"]["speed"] == pytest.approx(1.0)
    assert read(app, place=[0.0, 0.999]) is None
    assert read(app, index=[20, 10])["point"]["position"] == pytest.approx(middle["position"])
    for at in ({"index": [41.0, 1.0]}, {"index": [math.nan, 1]}, {"place": "ab"}, {}):
        assert read(app, **at) is None
    app.close()


@pytest.mark.usefixtures("opengl")
def test_a_point_of_a_globe_has_the_values_of_the_field() -> None:
    field = winds(cells=36)
    app = small_page(field, 5, 240, 160)
    # The mesh that is drawn has only the triangles of this part.
    app.area.viewport.draw(240, 160, (0, 0, 20, 20))
    for place in ([0.0, 0.0], [0.2, -0.3]):
        told = read(app, place=place, path=True)["point"]
        lon, lat = (float(part) for part in Projection("globe").lonlat(np.array(told["position"])))
        expected = field.at(lon, lat)
        assert expected is not None
        assert told["eastNorth"] == pytest.approx([expected.eastward, expected.northward])
        assert told["values"]["speed"] == pytest.approx(expected.speed)
    app.close()


@pytest.mark.usefixtures("opengl")
def test_a_point_on_triangles_is_told_by_its_place() -> None:
    points, triangles = sphere(3)
    field = FlowField.from_triangles(points, triangles, np.cross([0.0, 0.0, 1.0], points))
    app = small_page(field, 5, 240, 160)
    place = np.array([0.6, 0.64, 0.48])
    told = read(app, position=(1.2 * place).tolist())["point"]
    np.testing.assert_allclose(told["position"], place, atol=0.05)
    assert read(app, index=[1.0, 1.0]) is None
    assert np.linalg.norm(read(app, place=[0.0, 0.0])["point"]["position"]) > 0.97
    app.close()


def wandering() -> FlowField:
    """A vortex that moves to the right, at five times."""
    y, x = np.mgrid[-1:1:21j, -2:2:41j]
    times = np.linspace(0.0, 0.8, 5)
    steps = [np.stack([-y, x - 1.5 * t + 0.4], axis=-1) for t in times]
    return FlowField.from_arrays(np.stack([x, y], -1), np.stack(steps), times=times)


@pytest.mark.usefixtures("opengl")
def test_each_pane_has_its_own_path_at_the_time_of_the_page() -> None:
    app = small_page(wandering(), 21, 240, 160, lines="pathlines")
    app.area.compare({"lines": "streamlines"})
    at = {"index": [24.0, 12.0], "path": True}
    for time in (0.0, 0.3):
        told = []
        for number in (0, 1):
            answer: Any = asyncio.run(app.area.points.read(number, {**at, "time": time}))
            told.append(answer["path"]["sampled"])
        for pane, sampled in zip(app.viewport.panes, told, strict=True):
            scene = pane.scene.copy()
            scene.time = time
            camera, size = app.viewport.camera, app.viewport.pane_size
            found = probe(scene, (12.0, 24.0), pixel=camera, size=size)
            np.testing.assert_allclose(sampled[0], found.points[0])
            np.testing.assert_allclose(sampled[-1], found.points[-1])
        assert np.abs(np.subtract(told[0][0], told[1][0])).max() > 1e-4
    answer = asyncio.run(app.area.points.read(0, {"index": [24.0, 12.0], "time": 0.3}))
    point = answer["point"]
    x, y, _ = point["position"]
    expected = app.field.at(x, y, time=0.3)
    assert expected is not None
    assert point["values"]["speed"] == pytest.approx(expected.speed)
    assert app.viewport.handle.time == 0.0, "the time of the server is that of its own messages"
    app.close()
