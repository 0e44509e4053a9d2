"""Tiles of a large surface in the browser: the picture of VTK, without a line where tiles meet."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from matrix import COLOUR, GROUND, ROOT, SHARE, SIZE, TILTED, difference, straight
from page_reader import Reader
from pages import COMPLETE
from triangle_meshes import sphere
from webgl_page import ClientPage, TileMaker, packed, state, tile_maker

import flowtex
from flowtex._util.array_types import Bytes, Floats, Indices
from flowtex.host.export import export, page_text
from flowtex.host.view import WebView, web_views
from flowtex.rendering.camera import Camera, apply_camera
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.scene.options import Options
from flowtex.textures.tiles.blocks import triangle_roughness
from flowtex.textures.tiles.pyramid import TileKey

if TYPE_CHECKING:
    from playwright.sync_api import Page


LOOK: dict[str, Any] = {"scalars": False, "lighting": False, "color": COLOUR, "samples": 11}
CAMERAS = {"near": straight(10, (0.6, 0.2)), "tilted": TILTED}


@pytest.fixture(autouse=True)
def small_root(monkeypatch: pytest.MonkeyPatch, small_tiles: None) -> None:
    """Let a small field have four levels: tiles are made while the browser waits for them."""
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 625)
    monkeypatch.setattr("flowtex.textures.tiles.grid_pyramid.has_roughness", lambda field: False)
    monkeypatch.setattr("flowtex.host.still.NODES", 600)
    monkeypatch.setattr("flowtex.host.export.PREVIEW", (24, 16))


def place(s: Any, t: Any) -> Any:
    """Where a share of the columns and of the rows lies."""
    x = 2 * (s + 0.06 * np.sin(2 * np.pi * s)) + 0.12 * np.sin(np.pi * t)
    return np.stack([x, t], axis=-1)


def vortices(points: Any) -> Any:
    """Two of them, side by side."""
    a, b = np.moveaxis(np.pi * points, -1, 0)
    return np.stack([-np.sin(a) * np.cos(b), np.cos(a) * np.sin(b)], axis=-1)


@cache
def field() -> flowtex.FlowField:
    """Two vortices on a bent grid, with a hole."""
    points = place(*np.meshgrid(np.linspace(0, 1, 225), np.linspace(0, 1, 125)))
    velocity = vortices(points)
    velocity[75:85, 62:82] = np.nan
    return flowtex.FlowField.from_arrays(points, velocity)


@cache
def viewed(
    make: Callable[[], flowtex.FlowField] = field, **options: Any
) -> tuple[WebView, ClientData, TileMaker]:
    view = web_views(make(), Options.split(background=GROUND, **{**LOOK, **options}))[0]
    data = view.data()
    assert data.pyramid is not None
    return view, data, tile_maker(data)


def mounted(
    client: ClientPage,
    camera: Camera,
    make: Callable[[], flowtex.FlowField] = field,
    *,
    tiles: Callable[[TileKey], bool] = lambda key: True,
    time: float | None = None,
    **options: Any,
) -> int:
    """Show a view whose tiles, or some of them, are made when the client asks for them."""
    view, data, made = viewed(make, **options)

    def tile(key: Any, steps: Any) -> Any:
        if not tiles(TileKey(*key)):
            return {}
        return made(key, steps)

    client.tile = tile
    client.tiles.clear()
    header = data.header(view.scene.settings, camera=state(camera), time=time)
    given = packed(data, header, tuple(range(data.steps)))
    return client.mount(given, SIZE, controls=False, smooth=False)


def drawn_by_vtk(
    plotter: Any,
    camera: Camera,
    make: Callable[[], flowtex.FlowField] = field,
    time: float | None = None,
    **options: Any,
) -> Bytes:
    plotter.window_size = list(SIZE)
    plotter.set_background(GROUND)
    handle = plotter.flowtex.add(make(), **{**LOOK, **options})
    handle.surface.view.still = True
    if time is not None:
        handle.time = time
    apply_camera(camera, plotter.camera)
    plotter.camera_set = True
    plotter.renderer.reset_camera_clipping_range()
    return np.asarray(plotter.screenshot(return_img=True))[..., :3]


def layers(client: ClientPage, viewer: int) -> list[str]:
    """Names of what is drawn, the root as that of its level."""
    found = "(n) => viewers[n].tiles.layers.map(({ key }) => key.join('/'))"
    return list(client.page.evaluate(found, viewer))


@pytest.mark.browser
@pytest.mark.parametrize("name", CAMERAS)
def test_the_picture_is_that_of_vtk_and_tiles_draw_the_arrows_where_they_are(
    client: ClientPage, plotter: Any, name: str
) -> None:
    camera = CAMERAS[name]
    viewer = mounted(client, camera)
    client.complete(viewer)
    theirs, ours = client.pixels(viewer), drawn_by_vtk(plotter, camera)
    assert len(layers(client, viewer)) > 1
    root, share, only_one = difference(theirs, ours)
    # A line where tiles meet would be some of the pixels, and many steps of 8 bits.
    assert root < ROOT
    assert share < SHARE
    assert only_one <= 3

    options: dict[str, Any] = {"arrows": 24, "strength": 0.0}
    client.page.evaluate("([n, options]) => viewers[n].setSettings(options)", [viewer, options])
    client.complete(viewer)
    shares = "(n) => [...viewers[n].scene.arrows.last.shared.values()].map((seeds) => seeds.length)"
    assert np.count_nonzero(client.page.evaluate(shares, viewer)) > 1
    [handle] = plotter.flowtex
    handle.settings.update(**options)
    theirs, ours = client.pixels(viewer), np.asarray(plotter.screenshot(return_img=True))[..., :3]
    grey = np.abs(ours.astype(int) - np.rint(255 * np.array(COLOUR))).max(axis=-1)
    assert (grey > 60).mean() > 0.05
    off = np.abs(theirs.astype(int) - ours).max(axis=-1)
    assert (off > 40).mean() < 0.005


@pytest.mark.browser
def test_colours_and_places_are_those_of_the_tiles(client: ClientPage, plotter: Any) -> None:
    options: dict[str, Any] = {"scalars": "speed", "cmap": "viridis", "strength": 0.0}
    viewer = mounted(client, CAMERAS["near"], **options)
    client.complete(viewer)
    theirs = client.pixels(viewer)
    ours = drawn_by_vtk(plotter, CAMERAS["near"], **options, show_scalar_bar=False)
    off = np.abs(theirs.astype(int) - ours).max(axis=-1)
    assert (off > 3).mean() < 0.01
    client.page.wait_for_function("(n) => viewers[n].canPick", arg=viewer)
    point = client.page.evaluate("(n) => viewers[n].point(0.3, -0.2)", viewer)
    i, j = point["index"]
    found = np.array(point["position"][:2])
    assert np.abs(place(i / 224, j / 124) - found).max() < 0.001
    speed = np.linalg.norm(vortices(found))
    assert point["values"]["speed"] == pytest.approx(speed, abs=0.002)


@pytest.mark.browser
def test_coarse_first_and_finer_where_the_view_goes(client: ClientPage) -> None:
    viewer = mounted(client, CAMERAS["near"], tiles=lambda key: False)
    client.sharp(viewer)
    coarse = client.pixels(viewer)
    assert layers(client, viewer) == ["3/0/0"]
    client.page.wait_for_function("(n) => viewers[n].tiles.missing.length", arg=viewer)
    client.clear()
    viewer = mounted(client, CAMERAS["near"])
    client.complete(viewer)
    first = client.tiles.copy()
    assert {key[0] for key in first} == {0}
    assert set(layers(client, viewer)) == {"3/0/0", "0/0/0", "0/0/1"}
    # Noise continues from level to level: where a flow is smooth nothing jumps.
    assert np.abs(client.pixels(viewer).astype(int) - coarse).mean() < 1
    # Aside other tiles are requested, and those that are there are not.
    aside = state(straight(10, (1.6, 0.2)))
    client.page.evaluate("([n, camera]) => viewers[n].setCamera(camera)", [viewer, aside])
    client.page.wait_for_function("(n) => viewers[n].tiles.missing.length", arg=viewer)
    client.complete(viewer)
    later = client.tiles[len(first) :]
    assert later
    assert not set(later) & set(first)


@pytest.mark.browser
def test_a_page_holds_the_tiles_that_fit(
    page: Page, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flowtex.host.export.TILE_BYTES", 60_000)
    made = export(field(), tmp_path / "page.html", zoom=10, focus=(0.6, 0.2), **LOOK)
    page.set_viewport_size({"width": 300, "height": 200})
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(made.path.as_uri())
    page.wait_for_selector(COMPLETE)
    text = made.path.read_text("utf-8")
    assert "tile/2/0/0/flow/0" in text
    assert "tile/1/" not in text
    assert not [address for address in asked if not address.startswith(("file:", "blob:", "data:"))]


def test_a_page_without_room_has_no_tiles(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.host.export.TILE_BYTES", 0)
    text = page_text([viewed()[0]])
    assert "tile/2/0/0" not in text
    assert Reader(text).header()["pyramid"] is None


def triangles_of_ball(tilt: float = 0.3) -> flowtex.FlowField:
    """A flow on triangles, which clients do not trace."""
    points, triangles = sphere(4)
    return flowtex.FlowField.from_triangles(points, triangles, np.cross(points, [tilt, 0.2, 1.0]))


def test_room_for_slices_does_not_limit_velocities(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 350)
    view = viewed(triangles_of_ball)[0]
    assert Reader(page_text([view])).header()["pyramid"] is not None
    monkeypatch.setattr("flowtex.host.export.SLICE_BYTES", 0)
    assert Reader(page_text([view])).header()["pyramid"] is None
    assert Reader(page_text([viewed()[0]])).header()["pyramid"] is not None


def test_levels_that_are_not_in_a_page_are_not_searched(monkeypatch: pytest.MonkeyPatch) -> None:
    searched: list[int] = []

    def roughness(field: flowtex.FlowField, triangles: Indices, parts: list[Indices]) -> Floats:
        searched.append(field.shape[1])
        return triangle_roughness(field, triangles, parts)

    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.triangle_roughness", roughness)
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 350)
    monkeypatch.setattr("flowtex.host.export.SLICE_BYTES", 200_000)
    ball = triangles_of_ball(0.1)  # Equal fields would share what is searched.
    (view,) = web_views(ball, Options.split(**LOOK))
    pyramid = Reader(page_text([view])).header()["pyramid"]
    assert pyramid["finest"] == 1 < pyramid["depth"] == 2
    assert max(searched) == pyramid["shapes"][1][1] < ball.shape[1]


def test_a_tile_that_fails_fails_the_page(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rather than be missing in it without a word."""

    def fail(*args: object, **kwargs: object) -> None:
        msg = "the disk is gone"
        raise OSError(msg)

    monkeypatch.setattr("flowtex.textures.tiles.pyramid.Pyramid.textures", fail)
    with pytest.raises(OSError, match="the disk is gone"):
        page_text([viewed()[0]])


@cache
def swinging() -> flowtex.FlowField:
    """A vortex that wanders, at three times."""
    y, x = np.mgrid[-1:1:50j, -1:1:65j]
    steps = [np.stack([-(y - 0.2 * t), x - 0.1 * t * t], axis=-1) for t in (0.0, 1.0, 2.0)]
    return flowtex.FlowField.from_arrays(np.stack([x, y], -1), np.stack(steps), times=[0, 0.4, 0.8])


@pytest.mark.browser
def test_tiles_of_the_times_around_that_of_the_view(client: ClientPage, plotter: Any) -> None:
    camera = straight(6, (-0.3, 0.1))
    viewer = mounted(client, camera, swinging, time=0.55)
    client.complete(viewer)
    assert len(layers(client, viewer)) > 1
    root, share, _ = difference(
        client.pixels(viewer), drawn_by_vtk(plotter, camera, swinging, time=0.55)
    )
    assert root < ROOT
    assert share < SHARE
    # Of the next moment one step is there already, and only the other is requested.
    client.page.evaluate("(n) => viewers[n].setTime(0.2)", viewer)
    client.page.wait_for_function("(n) => viewers[n].tiles.missing.length", arg=viewer)
    client.complete(viewer)
    asked = [address for address in client.asked if "tiles.test" in address]
    assert asked[-1].endswith(",[0]]")


@cache
def ball() -> flowtex.FlowField:
    """Most of a sphere, over which everything turns."""
    a, b = np.meshgrid(np.linspace(0, 2 * np.pi, 201), np.linspace(-1.3, 1.3, 125))
    points = np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], axis=-1)
    velocity = np.stack([-np.sin(a), np.cos(a), 0.3 * np.cos(b)], axis=-1)
    return flowtex.FlowField.from_arrays(points, velocity)


@pytest.mark.browser
def test_no_crack_opens_where_some_tiles_are_there(client: ClientPage) -> None:
    camera = Camera((1.6, -1.0, 0.7), (0.0, 0.0, 0.0), (0, 0, 1))
    # Long streaks are drawn on tiles of several levels.
    streaks: dict[str, Any] = {"spacing": 3, "grain": 8}
    viewer = mounted(client, camera, ball, tiles=lambda key: sum(key) % 3 > 0, **streaks)
    client.page.wait_for_function("(n) => viewers[n].tiles.layers.length > 3", arg=viewer)
    client.sharp(viewer)
    ground = (client.pixels(viewer) == np.rint(255 * np.array(GROUND))).all(axis=-1)
    assert {name[0] for name in layers(client, viewer)} == {"3", "1", "0"}
    # From the first to the last pixel of the ball in each row there is no ground.
    for row in ground[~ground.all(axis=1)]:
        inside = np.flatnonzero(~row)
        assert not row[inside[0] : inside[-1]].any()
