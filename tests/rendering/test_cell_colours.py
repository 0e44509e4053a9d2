"""Cell data are drawn flat per cell by VTK, WebGL2 and NumPy, in the colours of PyVista."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import matplotlib.colors
import numpy as np
import pytest
import pyvista as pv
import scipy
from matrix import GROUND, SIZE
from webgl_page import ClientPage, packed, state, tile_maker

from flowtex import FlowField
from flowtex._util.array_types import Bools, Bytes
from flowtex.host.still import _colour
from flowtex.host.view import web_views
from flowtex.rendering.camera import Camera, apply_camera
from flowtex.rendering.cpu.render import render
from flowtex.rendering.uniforms import ViewState
from flowtex.scene.options import Options

pytestmark = pytest.mark.filterwarnings("ignore:.*normal to the surface")

#: Steps of 8 bits by which colours may differ: entries of a map, and the rounding of Oklab.
STEPS = 3
#: Least share of the pixels that lie inside a cell, in pixels of this distance from its edges.
LEAST_INSIDE, EDGE = 0.1, 1
CUT = {"normal": (1.0, 0.3, 0.2), "origin": (2.3, 2.1, 1.4)}
CLIM = (-1.0, 1.0)


def with_cells(mesh: Any, seed: int = 3) -> Any:
    """Return a mesh with a velocity on its points, and random values on its cells."""
    x, y, _ = mesh.points.T
    mesh["U"] = np.stack([1 + 0 * x, 0.3 * np.sin(x), 0.2 * np.cos(y)], axis=-1)
    mesh.cell_data["c"] = np.random.default_rng(seed).uniform(-1, 1, mesh.n_cells)
    return mesh


def sheared(columns: int = 13, rows: int = 9, height: float = 0.0) -> Any:
    s, t = np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows), indexing="ij")
    x, y = 3 * s + 0.4 * t + 0.2 * np.sin(3 * s), 2 * t + 0.1 * np.sin(5 * s)
    return with_cells(pv.StructuredGrid(*(a[..., None] for a in (x, y, height * np.sin(2 * x)))))


def polygons() -> Any:
    """Return triangles, quadrilaterals and pentagons side by side."""
    points: list[list[float]] = []
    faces: list[int] = []
    for n in range(24):
        count, (row, column) = 3 + n % 3, divmod(n, 6)
        turns = 2 * np.pi * (np.arange(count) + 0.2 * n) / count
        corners = np.stack([np.cos(turns) + 2 * column, np.sin(turns) + 2 * row, 0 * turns], -1)
        faces += [count, *range(len(points), len(points) + count)]
        points += corners.tolist()
    return with_cells(pv.PolyData(np.array(points), faces))


def random_triangles(count: int = 60) -> Any:
    points = np.random.default_rng(1).uniform(0, 3, (count, 2))
    return with_cells(pv.PolyData(np.pad(points, ((0, 0), (0, 1)))).delaunay_2d())


def with_missing(mesh: Any) -> Any:
    mesh.cell_data["c"][::5] = np.nan
    return mesh


def volume() -> Any:
    return with_cells(pv.ImageData(dimensions=(8, 7, 6), spacing=(0.7, 0.8, 0.6)))


def section(mesh: Any) -> Any:
    return mesh.slice(**CUT, generate_triangles=True)


def series(mesh: Any) -> list[Any]:
    """Return a mesh at two times, with other values."""
    return [mesh, with_cells(mesh.copy(), seed=4)]


def mixed(steps: list[Any]) -> Any:
    """Return a series at a quarter of the way."""
    mesh = steps[0].copy()
    mesh.cell_data["c"] = 0.75 * steps[0].cell_data["c"] + 0.25 * steps[1].cell_data["c"]
    return mesh


def categories(count: int) -> Any:
    """Return a mesh with whole numbers, all at the borders of colours."""
    mesh = sheared(25, 17)
    mesh.cell_data["c"] = np.arange(mesh.n_cells) % count
    return mesh


@dataclass(frozen=True)
class Case:
    """A mesh, what is drawn of it, and the mesh that PyVista draws."""

    mesh: Callable[[], Any]
    options: dict[str, Any] = field(default_factory=dict)
    drawn: Callable[[Any], Any] = lambda mesh: mesh
    camera: Camera | None = None
    time: float = 0.0
    look: dict[str, Any] = field(default_factory=dict)


#: Of grids with tiles.
CLOSE = Camera((1.6, 1.0, 5.0), (1.6, 1.0, 0.0), (0, 1, 0), parallel=True, parallel_scale=0.06)
ASIDE = Camera((2.5, -3.0, 4.0), (1.7, 1.0, 0.0), (0, 0, 1))
SLICE: dict[str, Any] = {"slice": tuple(CUT.values())}

MAP = matplotlib.colors.ListedColormap(np.random.default_rng(0).random((23, 3)))

CASES = {
    "grid": Case(sheared),
    "grid in perspective": Case(lambda: sheared(height=0.4), camera=ASIDE),
    "missing cells": Case(lambda: with_missing(sheared())),
    "triangles": Case(random_triangles),
    "polygons": Case(polygons),
    "sphere": Case(lambda: with_cells(pv.Icosphere(nsub=1)), camera=ASIDE),
    "plane of nodes": Case(
        volume, {"plane": "k=2"}, lambda m: m.extract_subset((0, 7, 0, 6, 2, 2))
    ),
    "slice of hexahedra": Case(lambda: volume().cast_to_unstructured_grid(), SLICE, section),
    "slice of tetrahedra": Case(lambda: with_cells(volume().to_tetrahedra()), SLICE, section),
    "contour": Case(
        lambda: volume().elevation(scalar_range=(0.0, 1.0)),
        {"contour": ("Elevation", 0.5)},
        lambda m: m.contour([0.5], scalars="Elevation"),
    ),
    "series": Case(lambda: series(sheared()), {}, mixed, time=0.25),
    "series of triangles": Case(lambda: series(random_triangles()), {}, mixed, time=0.25),
    "categories": Case(lambda: categories(23), look={"cmap": MAP, "clim": (0, 23)}),
    "tiles": Case(lambda: sheared(241, 161), camera=CLOSE),
    "tiles of triangles": Case(
        lambda: sheared(81, 61).extract_surface(algorithm="dataset_surface").triangulate(),
        camera=CLOSE,
    ),
}


@pytest.fixture(autouse=True)
def small_root(monkeypatch: pytest.MonkeyPatch, small_tiles: None) -> None:
    """Let small surfaces have tiles."""
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 5000)
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 1500)


@cache
def read(name: str) -> FlowField:
    case = CASES[name]
    return FlowField.from_pyvista(case.mesh(), vectors="U", **case.options)


def seen(name: str) -> Camera:
    return CASES[name].camera or Camera.fit(read(name).surface, SIZE[0] / SIZE[1])


def by_pyvista(mesh: Any, camera: Camera, **options: Any) -> Bytes:
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(SIZE))
    plotter.disable_anti_aliasing()
    plotter.set_background(GROUND)
    plotter.add_mesh(mesh, lighting=False, show_scalar_bar=False, **options)
    apply_camera(camera, plotter.camera)
    plotter.renderer.reset_camera_clipping_range()
    picture = np.asarray(plotter.screenshot(return_img=True))
    plotter.close()
    return picture


@cache
def expected(name: str) -> tuple[Bytes, Bools]:
    """Return PyVista's picture, and the pixels that are inside of a cell."""
    case, camera = CASES[name], seen(name)
    mesh = case.drawn(case.mesh())
    look: dict[str, Any] = {"scalars": "c", "clim": CLIM, "cmap": "viridis", "preference": "cell"}
    look |= case.look
    picture = by_pyvista(mesh, camera, **look)
    number = np.arange(mesh.n_cells)
    codes = np.stack([number % 251, number // 251 % 251, 100 + number // 251**2], axis=-1)
    mesh.cell_data["code"] = codes.astype(np.uint8)
    cells = by_pyvista(mesh, camera, scalars="code", rgb=True, preference="cell").astype(int)
    size = (2 * EDGE + 1, 2 * EDGE + 1, 1)
    even = scipy.ndimage.maximum_filter(cells, size) == scipy.ndimage.minimum_filter(cells, size)
    ground = (cells == np.rint(255 * np.array(GROUND))).all(axis=-1)
    inside = even.all(axis=-1) & ~ground
    assert inside.mean() > LEAST_INSIDE
    return picture, inside


def check(picture: Bytes, name: str) -> None:
    reference, inside = expected(name)
    off = np.abs(picture[..., :3].astype(int) - reference)[inside]
    assert off.max() <= STEPS, f"{(off.max(axis=-1) > STEPS).mean():.1%} of the pixels"


LOOK: dict[str, Any] = {
    **{"scalars": "c", "clim": CLIM, "cmap": "viridis", "lighting": False, "strength": 0.0},
    "samples": 3,
}


@pytest.mark.parametrize("name", CASES)
def test_vtk_draws_cells_flat(plotter: Any, name: str) -> None:
    plotter.window_size = list(SIZE)
    plotter.set_background(GROUND)
    handle = plotter.flowtex.add(read(name), show_scalar_bar=False, **LOOK | CASES[name].look)
    if not handle.field.steady:
        handle.time = CASES[name].time
    apply_camera(seen(name), plotter.camera)
    plotter.camera_set = True
    plotter.renderer.reset_camera_clipping_range()
    check(np.asarray(plotter.screenshot(return_img=True)), name)


@pytest.mark.parametrize("name", [name for name in CASES if "tiles" not in name])
def test_numpy_draws_cells_flat(name: str) -> None:
    (view,) = web_views(read(name), Options.split(background=GROUND, **LOOK | CASES[name].look))
    data, scene, between = view.data(), view.scene, CASES[name].time
    state = ViewState(still=True, between=between)
    steps = (0, min(data.steps - 1, 1))
    picture = render(data.textures, scene.settings, seen(name), SIZE, view=state, steps=steps)
    check(picture.rgb(_colour(data, picture, steps, between), GROUND), name)


@pytest.mark.browser
@pytest.mark.parametrize("name", CASES)
def test_the_browser_draws_cells_flat(client: ClientPage, name: str) -> None:
    (view,) = web_views(read(name), Options.split(background=GROUND, **LOOK | CASES[name].look))
    data = view.data()
    client.tile = tile_maker(data)
    settings, time = view.scene.settings, CASES[name].time
    header = data.header(settings, camera=state(seen(name)), time=time)
    given = packed(data, header, tuple(range(data.steps)))
    number = client.mount(given, SIZE, controls=False, smooth=False)
    (client.complete if data.pyramid else client.sharp)(number)
    assert bool(client.tiles) == ("tiles" in name)
    check(client.pixels(number), name)


@pytest.mark.parametrize("name", ["grid", "triangles", "slice of tetrahedra"])
def test_points_have_the_value_of_their_cell(name: str) -> None:
    case, flow = CASES[name], read(name)
    mesh = case.drawn(case.mesh())
    middles, values = mesh.cell_centers().points, mesh.cell_data["c"]
    for middle, value in list(zip(middles, values, strict=True))[::7]:
        point = flow.at(*map(float, middle))
        assert point is not None
        assert point.scalars["c"] == value


CARD = """() => Object.fromEntries([...viewers[0].root.shadowRoot.querySelectorAll(".card dt")]
  .map((word) => [word.textContent, word.nextSibling.textContent]))"""


@pytest.mark.browser
@pytest.mark.parametrize("name", ["grid", "triangles"])
def test_the_card_has_the_value_of_the_cell(client: ClientPage, name: str) -> None:
    (view,) = web_views(read(name), Options.split(background=GROUND, **LOOK | CASES[name].look))
    data = view.data()
    client.mount(packed(data, data.header(view.scene.settings)), SIZE)
    client.page.wait_for_function("() => viewers[0].canPick")
    for place in ([0.1, 0.05], [-0.3, 0.2], [0.4, -0.33]):
        point = client.page.evaluate("(at) => viewers[0].card.choose(...at)", place)
        expected = read(name).at(*point["position"])
        assert expected is not None
        assert float(client.page.evaluate(CARD)["c"]) == pytest.approx(
            expected.scalars["c"], rel=5e-3
        )
