"""Surfaces of triangles in the browser: pictures, points, paths and tiles."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from matrix import ASIDE, COLOUR, GROUND, SIZE, straight
from triangle_meshes import random_plane, sphere, surface_of
from webgl_page import ClientPage, packed, state, tile_maker

from flowtex import FlowField
from flowtex._util.array_types import Bytes
from flowtex.field.locate import locate
from flowtex.host.view import web_views
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.render import render
from flowtex.rendering.uniforms import ViewState
from flowtex.rendering.webgl.client_data import ClientData, Colours
from flowtex.scene.options import Options
from flowtex.scene.probe import probe
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

pytestmark = pytest.mark.browser

#: How far one looks at the ball from, and a part of it that is so near.
NEAR = Camera((0.9, -0.75, 0.6), (0.7, -0.58, 0.42), (0, 0, 1), parallel=True, parallel_scale=1e-5)


@cache
def ball(subdivisions: int = 4) -> FlowField:
    """A sphere that turns, and more slowly above."""
    points, triangles = sphere(subdivisions)
    x, y, z = points.T
    velocity = np.stack([-y, x, 0 * x], axis=-1) * (1 - 0.4 * z)[:, None]
    return FlowField.from_triangles(points, triangles, velocity, scalars={"height": z})


@cache
def plane() -> FlowField:
    """A vortex that wanders over random triangles, at three times, and a hole."""
    points, triangles = random_plane(np.random.default_rng(5), 900)
    x, y = 2 * points[:, 0] - 1, 2 * points[:, 1] - 1
    points = np.stack([x, y, 0 * x], axis=-1)
    steps = [np.stack([-(y - 0.2 * t), x - 0.1 * t * t, 0 * x], axis=-1) for t in (0.0, 1.0, 2.0)]
    velocity = np.where((np.hypot(x + 0.4, y - 0.3) < 0.15)[:, None], np.nan, np.stack(steps))
    return FlowField.from_triangles(points, triangles, velocity, times=[0.0, 0.4, 0.8])


def mounted(client: ClientPage, scene: Scene, camera: Camera, **options: Any) -> None:
    data = ClientData(scene.textures, Colours(plain=COLOUR, background=GROUND))
    header = data.header(scene.settings, camera=state(camera), time=scene.time)
    options = {"controls": False, "smooth": False, **options}
    client.mount(packed(data, header, tuple(range(data.steps))), SIZE, **options)


def judged(scene: Scene, camera: Camera, size: tuple[int, int] = SIZE) -> Bytes:
    before, after, between = scene.moment
    view = ViewState(between=between)
    drawn = render(scene.textures, scene.settings, camera, size, view=view, steps=(before, after))
    return drawn.rgb(COLOUR, background=GROUND)


PATHS: dict[str, tuple[Any, Camera]] = {
    "ball": (ball, ASIDE),
    "near": (ball, NEAR),
    "plane": (plane, straight(0.9, (0.0, 0.0))),
}


@pytest.mark.parametrize("name", PATHS)
def test_points_and_paths_are_those_of_the_renderer(client: ClientPage, name: str) -> None:
    make, camera = PATHS[name]
    scene = Scene(make(), Settings(samples=21))
    mounted(client, scene, camera)
    client.sharp()
    client.page.wait_for_function("() => viewers[0].canPick")
    point = client.page.evaluate("() => viewers[0].card.choose(0.2, -0.14)")
    drawn = client.page.evaluate(
        "() => { const { path, point } = viewers[0].card.drawn; return { ...path, point }; }"
    )
    i, j = point["index"]
    surface = surface_of(make())
    if surface.cells.all():  # else drawn triangles have other numbers
        size = np.ptp(surface.points[0][surface.triangles[int(j)]], axis=0).max()
        at = surface.at(np.array([i, j]))
        np.testing.assert_allclose(at, point["position"], atol=1e-6 * size)
    index = locate(make(), point["position"])
    assert index is not None
    judge = probe(scene, index, pixel=camera, size=SIZE)
    length = float(np.linalg.norm(np.diff(judge.points, axis=0), axis=1).sum())
    assert length > 0
    ends = np.array([drawn["sampled"][0], drawn["sampled"][-1]])
    np.testing.assert_allclose(ends, judge.points[[0, -1]], atol=0.06 * length)
    sampled = np.array(drawn["sampled"])
    path = np.concatenate([np.linspace(a, b, 50) for a, b in pairwise(sampled)])
    gap = np.linalg.norm(judge.points[:, None] - path, axis=-1).min(axis=1)
    assert gap.max() < 0.1 * length
    speed = judge.field_values.speed
    np.testing.assert_allclose(drawn["velocity"], judge.field_values.velocity, atol=0.03 * speed)


def test_a_large_surface_is_shown_in_tiles(
    client: ClientPage, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 1000)
    field = ball(5)
    look: dict[str, Any] = {"scalars": False, "lighting": False, "color": COLOUR}
    view = web_views(field, Options.split(background=GROUND, samples=11, **look))[0]
    data = view.data()
    assert data.pyramid is not None and data.pyramid.depth > 1
    client.tile = tile_maker(data)
    near: dict[str, Any] = {"parallel": True, "parallel_scale": 0.1}
    camera = Camera((2.4, -1.9, 1.5), (0.0, 0.0, 0.0), (0, 0, 1), **near)
    header = data.header(view.scene.settings, camera=state(camera))
    viewer = client.mount(packed(data, header), SIZE, controls=False, smooth=False)
    client.complete(viewer)
    # Drafts of a slow machine, of fewer pixels, may ask for coarser ones before.
    assert 0 in {key[0] for key in client.tiles}
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 10**9)
    ours = judged(Scene(ball.__wrapped__(5), Settings(samples=11)), camera)
    theirs = client.pixels(viewer)
    assert not (theirs == np.rint(255 * np.array(GROUND))).all(axis=-1).any()  # no crack
    # The middle of the root is not quite that of the whole, and noise begins there; a line where
    # tiles meet would be many steps of 8 bits.
    off = np.abs(theirs.astype(float) - ours)
    assert off.mean() < 4
    assert (off > 30).mean() < 1e-3
    client.page.wait_for_function("(n) => viewers[n].canPick", arg=viewer)
    point = client.page.evaluate("(n) => viewers[n].point(0.3, -0.2)", viewer)
    assert np.linalg.norm(point["position"]) == pytest.approx(1, abs=2e-3)
