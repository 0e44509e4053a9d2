"""Which tiles are drawn, and that nobody sees where one ends."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from waiting import PATIENCE_S

import flowtex
from flowtex.field import FlowField
from flowtex.rendering.tile_choice import TileView, choose_tiles, cover, finer_part, wanted_tiles
from flowtex.textures.tiles.grid_pyramid import TILE_BLOCKS, GridPyramid
from flowtex.textures.tiles.pyramid import Pyramid
from flowtex.textures.tiles.shared import _pyramids

SIZE = (320, 240)


@pytest.fixture
def _tiled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 3000)


def flat(rows: int = 300, columns: int = 420) -> FlowField:
    x, y = np.meshgrid(np.linspace(0, 2, columns), np.linspace(0, 1, rows) ** 1.2)
    velocity = [-np.sin(np.pi * x) * np.cos(np.pi * y), np.cos(np.pi * x) * np.sin(np.pi * y)]
    return FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack(velocity, axis=-1))


def varying() -> FlowField:
    x, y = np.meshgrid(np.linspace(0, 2, 300), np.linspace(0, 1, 280))
    steps = [np.stack([np.cos(3 * y + t), 0.4 * np.sin(4 * x - t)], -1) for t in (0.0, 0.5, 1.0)]
    return FlowField.from_arrays(np.stack([x, y], -1), np.stack(steps), times=[0.0, 0.1, 0.2])


def sphere() -> FlowField:
    a, b = np.meshgrid(np.linspace(0, 2 * np.pi, 265), np.linspace(-np.pi / 2, np.pi / 2, 101))
    points = np.stack([np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)], axis=-1)
    return FlowField.from_arrays(points, np.cross([0.5, 0.2, 1.0], points))


def land() -> FlowField:
    field = flat()
    hole = np.hypot(field.points[..., 0] - 0.7, field.points[..., 1] - 0.4) < 0.1
    return FlowField.from_arrays(field.points, field.velocity[0], valid=~hole)


NEAR = {"zoom": 4.0, "focus": (0.63, 0.37)}
PLAIN = {"scalars": False}
POLE = {"camera": [(0.9, 0.2, 1.9), (0, 0, 1), (0, 1, 0)]}
#: A field, how it is drawn, and how far pictures may be apart (RMS, of 255). A level may be coarser
#: than the whole, and the last lags of tiles are others. The middle of a curved surface is that of
#: its root, and tiles of a flow that varies are integrated, not composed.
CASES: dict[Any, list[tuple[dict[str, Any], float]]] = {
    flat: [(PLAIN, 1.6), (NEAR | {"scalars": "speed"}, 0.9), (PLAIN | NEAR | {"zoom": 60.0}, 0.5)],
    land: [(PLAIN | NEAR, 0.9)],
    varying: [(PLAIN | NEAR | {"time": 0.13}, 5.0)],
    sphere: [(PLAIN | POLE, 3.5)],
}


@pytest.mark.parametrize("make", CASES)
def test_tiles_draw_what_the_whole_draws(make: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    field, pictures = make(), []
    for root in (10**9, 3000):
        monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", root)
        _pyramids._values.clear()
        pictures.append(
            [flowtex.render(field, size=SIZE, grain=1.5, **how) for how, _ in CASES[make]]
        )
    for whole, tiles, (_, most) in zip(*pictures, CASES[make], strict=True):
        off = np.abs(whole.astype(float) - tiles).max(axis=-1)
        assert np.ptp(whole) > 100
        assert np.sqrt(np.mean(off**2)) < most
        assert (off > 16).mean() < 1e-3 * most**2


def test_tiles_in_the_background_come_after_a_coarse_picture(
    _tiled: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(SIZE))
    handle = plotter.flowtex.add(flat(), scalars=False)
    told: list[int] = []
    go, textures = threading.Event(), GridPyramid.region

    def slow(*arguments: Any) -> Any:
        go.wait(PATIENCE_S)
        return textures(*arguments)

    monkeypatch.setattr(GridPyramid, "region", slow)
    handle.load_in_background(lambda: told.append(1))
    first = np.asarray(plotter.screenshot(return_img=True), float)
    assert handle.busy
    go.set()
    handle.surface._loader.wait()
    assert told
    plotter.render()
    second = np.asarray(plotter.screenshot(return_img=True), float)
    assert not handle.busy
    assert np.abs(first - second).mean() > 0.1
    actors = plotter.renderer.GetActors().GetNumberOfItems()
    assert actors > 1
    handle.actor.SetVisibility(False)
    plotter.render()
    assert plotter.renderer.GetActors().GetNumberOfItems() == 1
    handle.remove()
    assert plotter.renderer.GetActors().GetNumberOfItems() == 0
    plotter.close()


def test_a_tile_that_fails_is_told_and_shown_coarse(
    _tiled: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*arguments: Any) -> Any:
        msg = "the disk is gone"
        raise OSError(msg)

    monkeypatch.setattr(GridPyramid, "region", broken)
    with pytest.warns(UserWarning, match="shown coarse.*the disk is gone"):
        shown = flowtex.render(flat(), size=SIZE, scalars=False)
    assert np.ptp(shown) > 100


def test_an_image_is_drawn_whole_and_back_in_tiles(_tiled: None) -> None:
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(SIZE))
    field = flat()
    handle = plotter.flowtex.add(field)
    tiled = np.asarray(plotter.screenshot(return_img=True), float)
    handle.set_image(np.indices((8, 8)).sum(axis=0) % 2 * 1.0)
    whole = np.asarray(plotter.screenshot(return_img=True), float)
    assert handle.actor.mapper.dataset.n_points == field.valid.size
    handle.settings.noise = "procedural"
    again = np.asarray(plotter.screenshot(return_img=True), float)
    assert handle.actor.mapper.dataset.n_points <= 3000
    assert np.abs(whole - tiled).mean() > 5
    assert np.abs(again - tiled).max() <= 2
    plotter.close()


@pytest.mark.parametrize("scalars", ["depth", "vorticity"])
def test_tiles_have_the_colours_of_this_moment(_tiled: None, scalars: str) -> None:
    first: dict[str, Any] = {"scalars": "speed", "cmap": "viridis"}
    then: dict[str, Any] = {"scalars": scalars, "cmap": "magma", "clim": (0.2, 1.5), "opacity": 0.7}
    depth = flat().points[..., 0]
    pictures = []
    for options, changes in ((first, then), (then, {})):
        plotter: Any = pv.Plotter(off_screen=True, window_size=list(SIZE))
        field = flat().same_flow(scalars={"depth": depth[None]})
        handle = plotter.flowtex.add(field, show_scalar_bar=False, **options)
        pictures.append(plotter.screenshot(return_img=True))
        assert len(handle.surface.meshes) > 1
        for name, value in changes.items():
            setattr(handle, name, value)
        if changes:
            plotter.render()
            pictures[-1] = plotter.screenshot(return_img=True)
        plotter.close()
    changed, made = (np.asarray(picture).astype(int) for picture in pictures)
    assert np.abs(changed - made).max() <= 2


def view(rng: np.random.Generator) -> TileView:
    """Look straight at some part of a flat field."""
    middle, half = rng.uniform([0, 0], [2, 1]), 0.6 * 10 ** rng.uniform(-2.5, 0)
    sides = [(1, 0, half * 4 / 3 - middle[0]), (-1, 0, half * 4 / 3 + middle[0])]
    sides += [(0, 1, half - middle[1]), (0, -1, half + middle[1])]
    return TileView(None, half, 600, np.array([(x, y, 0, d) for x, y, d in sides], dtype=float))


def test_root_is_traced_where_it_is_seen(_tiled: None) -> None:
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(SIZE))
    handle = plotter.flowtex.add(flat(290), scalars=False)
    plotter.camera_position = "xy"
    plotter.camera.zoom(4.0)
    near = plotter.screenshot(return_img=True)
    assert not handle.scene.store.traced
    plotter.camera.zoom(0.05)
    plotter.render()
    assert handle.scene.store.traced
    plotter.camera.zoom(20.0)
    plotter.render()
    assert np.array_equal(plotter.screenshot(return_img=True), near)
    plotter.close()


def test_what_is_in_view_is_covered_once_and_as_fine_as_pixels(_tiled: None) -> None:
    pyramid = GridPyramid(flat(700, 900))
    for seed in range(10):
        rng = np.random.default_rng(seed)
        check_cover(pyramid, view(rng), rng)


def check_cover(pyramid: Pyramid, seen: TileView, rng: np.random.Generator) -> None:
    choices = choose_tiles(pyramid, seen)
    for wanted in wanted_tiles(choices):
        places = pyramid.smooth_places(wanted.level)[pyramid.blocks_of(wanted)]
        sizes = seen.cell_sizes(places)[seen.sees(places[..., :3], places[..., 3])]
        assert wanted.level == 0 or sizes.min() <= seen.cell_pixels
    ready = {key for key in choices if rng.random() < 0.6}
    shown = cover(choices, lambda key: key in ready)
    counts = np.zeros(pyramid.blocks, dtype=int)
    for key, finer in shown.items():
        level = pyramid.depth if key is None else key.level
        rows, columns = pyramid.blocks_of(key)
        own = np.ones(pyramid.places(level)[rows, columns].shape[:2], dtype=int)
        assert key is None or key in ready
        for child in finer:
            own[finer_part(pyramid, child, key)] = 0
        spread = np.repeat(np.repeat(own, 1 << level, axis=0), 1 << level, axis=1)
        row, column = (0, 0) if key is None else (TILE_BLOCKS * at << level for at in key[1:])
        part = counts[row : row + len(spread), column : column + spread.shape[1]]
        part += spread[: part.shape[0], : part.shape[1]]
    assert (counts <= 1).all()
    center = pyramid.places(0)[..., :3] @ seen.planes[:, :3].T + seen.planes[:, 3]
    assert (counts[(center > 0).all(axis=-1)] == 1).all()
