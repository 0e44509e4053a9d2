from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from small_tiles import TILE_CELLS
from triangle_meshes import sphere

import flowtex
from flowtex import FlowField, examples
from flowtex.host.view import TileSource, WebView, even_steps, web_views
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.scene.options import Options
from flowtex.settings import Settings
from flowtex.textures.tiles.grid_pyramid import GridPyramid
from flowtex.textures.tiles.pyramid import TileKey
from flowtex.textures.tiles.shared import coarsened_field


def plane(times: int = 1, shape: tuple[int, int] = (9, 12)) -> flowtex.FlowField:
    """A flow on a flat, blanked grid."""
    x, y = np.meshgrid(np.linspace(0, 3, shape[1]), np.linspace(0, 2, shape[0]))
    points = np.stack([x, y], axis=-1)
    velocity = np.stack([np.stack([1 + 0.1 * y, np.cos(x + t)], axis=-1) for t in range(times)])
    velocity[:, 0, 0] = np.nan
    return flowtex.FlowField.from_arrays(points, velocity, name="plane")


def ball() -> flowtex.FlowField:
    """A flow on a bent strip."""
    a, b = np.meshgrid(np.linspace(0, 2, 14), np.linspace(-0.8, 0.8, 10))
    points = np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], axis=-1)
    velocity = np.stack([-np.sin(a), np.cos(a), 0 * a], axis=-1)
    return flowtex.FlowField.from_arrays(points, velocity)


def web_view(field: flowtex.FlowField, *, steps: int | None = None, **options: Any) -> WebView:
    return web_views(field, Options.split(**options), steps=steps)[0]


def staged(field: flowtex.FlowField, **options: Any) -> tuple[WebView, ClientData]:
    view = web_view(field, **options)
    return view, replace(view.data(), traces=False)


@pytest.mark.parametrize("make", [plane, ball, lambda: plane(3)])
@pytest.mark.parametrize("image", [None, np.ones((2, 3))])
def test_arrays_are_those_of_the_texture_set(make: Any, image: Any) -> None:
    view, scene = staged(make(), image=image)
    header = json.loads(json.dumps(scene.header(view.scene.settings), allow_nan=False))
    textures = view.scene.textures
    geometry = textures.geometry
    for step in range(scene.steps):
        parts = scene.step(step)
        layers = textures.layers(step)
        channels = header["slices"]["channels"]
        slices = parts[f"slices/{step}"]
        assert slices.dtype == np.float16
        shape = (header["slices"]["count"], *geometry.size, channels)
        assert slices.shape == shape
        np.testing.assert_allclose(slices, layers[..., :channels], rtol=1e-3, atol=1e-4)
        assert channels == 4 or not layers[..., channels:3].any()  # nothing is lost
        extra = parts[f"extra/{step}"]
        fourth = layers[header["slices"]["extra"], ..., 3]
        np.testing.assert_allclose(extra, fourth, rtol=1e-3, atol=1e-6)
        others = np.delete(layers[..., 3], header["slices"]["extra"], axis=0)
        assert not others.any()
        speed = geometry.field.speed[min(step, len(geometry.field.speed) - 1)]
        np.testing.assert_allclose(parts[f"scalars/{step}"], speed, rtol=1e-6)
    surface = scene.surface()
    np.testing.assert_array_equal(surface["position"], geometry.position)
    if not geometry.planar:
        np.testing.assert_allclose(surface["normal"] / 32767, geometry.normal, atol=2e-5)
    assert ("cells" in surface) == (not geometry.field.valid.all())
    if "cells" in surface:
        np.testing.assert_array_equal(surface["cells"], geometry.field.surface.cells)
    if textures.image is not None:
        np.testing.assert_allclose(surface["image"], textures.image.texels, rtol=1e-3, atol=1e-6)
        np.testing.assert_allclose(surface["step"], textures.image.step, rtol=1e-3)
        nodes = np.stack(np.meshgrid(header["image"]["alongI"], header["image"]["alongJ"]), axis=-1)
        np.testing.assert_allclose(nodes, textures.image.coordinate, atol=1e-6)


@pytest.mark.usefixtures("small_tiles")
def test_a_node_has_one_position_at_all_levels(monkeypatch: pytest.MonkeyPatch) -> None:
    """So no crack opens between tiles; and what is rounded is a hundredth of a cell at most."""
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 3000)
    lon, lat = np.meshgrid(np.linspace(0, 2 * np.pi, 257), np.linspace(-0.5, 0.5, 129) * np.pi)
    points = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
    field = FlowField.from_arrays(700 * points + [4e5, -300, 20], np.cross([0.3, 1, 0.1], points))
    root = web_view(field).data()
    pyramid = root.pyramid
    assert isinstance(pyramid, GridPyramid) and pyramid.depth == 2
    source, found = TileSource(root), np.full(field.surface.points.shape, np.nan)
    coarse = pyramid.children(None)
    keys = [None, *coarse, *(child for key in coarse for child in pyramid.children(key))]
    for key in keys:
        data = root if key is None else source.tile(key, ())
        assert data is not None
        rows, columns = data.textures.grid.drawn
        middle = data.tile_header["slices"]["trace"]["middle"]
        drawn = data.surface()["padded"][1:-1, 1:-1].astype(float)[rows, columns] + middle
        j, i = pyramid.line_numbers(pyramid.depth if key is None else key.level)
        _, row, column = key or TileKey(0, 0, 0)
        first = row * TILE_CELLS, column * TILE_CELLS
        at = np.ix_(*(n[f : f + s] for n, f, s in zip((j, i), first, drawn.shape, strict=False)))
        before = found[at]
        np.testing.assert_array_equal(np.where(np.isnan(before), drawn, before), drawn)
        found[at] = drawn
    surface = field.surface
    away = np.linalg.norm(found - (surface.points - surface.center), axis=-1)
    narrow = np.linalg.norm(surface.tangents, axis=-1).min(axis=0)
    assert (away[1:-1] / narrow[1:-1]).max() < 0.01


def test_a_time_needs_the_steps_around_it() -> None:
    view, scene = staged(plane(3))
    assert scene.moment(0.0) == (0, 1) == view.scene.moment[:2]
    assert scene.moment(1.0) == (1, 2)
    assert scene.moment(2.0) == (1, 2)
    assert staged(plane())[1].moment(0.0) == (0,)
    with pytest.raises(IndexError, match=r"^time step 3 does not exist: expected 0 to 2$"):
        scene.step(3)


def test_fewer_steps_are_traced_through_all_of_them() -> None:
    whole, some = staged(plane(5))[1], staged(plane(5), steps=3)[1]
    assert some.header(Settings())["slices"]["times"] == [0.0, 2.0, 4.0]
    np.testing.assert_array_equal(some.step(1)["slices/1"], whole.step(2)["slices/2"])
    np.testing.assert_array_equal(some.step(2)["scalars/2"], whole.step(4)["scalars/4"])
    one = staged(plane(5), steps=1)[1]
    np.testing.assert_array_equal(one.step(0)["slices/0"], whole.step(4)["slices/4"])
    assert "FLOWTEX_UNSTEADY" not in one.constants()["variant"]


def test_evenly_chosen_numbers() -> None:
    assert even_steps(5, None) == even_steps(5, 5) == even_steps(5, 9) == ()
    assert even_steps(11, 3) == (0, 5, 10)
    assert even_steps(4, 1) == (3,)
    with pytest.raises(ValueError, match=r"^steps is 0; expected 1 to 4"):
        even_steps(4, 0)


def test_a_coarse_field_keeps_its_edges_and_its_data() -> None:
    fine = examples.double_gyre_field()
    coarse = coarsened_field(fine, 1000)
    assert 700 < coarse.valid.size <= 1000
    for corner in ((0, 0), (0, -1), (-1, 0), (-1, -1)):
        np.testing.assert_array_equal(coarse.points[corner], fine.points[corner])
    assert coarse.surface.extent == pytest.approx(fine.surface.extent)
    assert coarsened_field(fine, 10**6) is fine


def test_a_coarse_surface_of_triangles_has_means(monkeypatch: pytest.MonkeyPatch) -> None:
    points, triangles = sphere(4)
    fine = FlowField.from_triangles(points, triangles, np.cross([0.0, 0, 1], points))
    coarse = coarsened_field(fine, 500)
    assert 100 < coarse.valid.size <= 500
    assert coarse.surface.extent == pytest.approx(fine.surface.extent, rel=0.1)
    places = coarse.points[0]
    np.testing.assert_allclose(coarse.velocity[0, 0], np.cross([0.0, 0, 1], places), atol=1e-9)
    assert coarsened_field(fine, 10**6) is fine
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 1000)
    assert coarsened_field(fine, 500) is fine  # its levels come one after the other anyway
