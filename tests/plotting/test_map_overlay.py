"""Coasts, meridians, land and the globe with a flow: drawn, changed, hidden and taken away."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import pyvista as pv
from earth_data import winds as winds_on_lines
from earth_fields import ocean, winds
from flows import gyre
from mesh_data import globe, ugrid
from small_tiles import shrink

import flowtex
from flowtex._util.array_types import Floats
from flowtex._util.colours import rgb
from flowtex.field.earth.projection import EARTH_RADIUS, Projection
from flowtex.plotting import component  # noqa: F401  which PyVista finds by its entry point
from flowtex.rendering.camera import Camera, apply_camera, read_camera
from flowtex.rendering.map_overlay import globe_radius, ground_cells, map_lines
from flowtex.scene.options import LAND_COLOR

pytestmark = [
    pytest.mark.usefixtures("opengl"),
    pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice"),
]

SIZE = (240, 200)
OFF: dict[str, Any] = {"coastlines": False, "graticule": False, "land": None}
#: For tests in which the texture does not matter: it takes most of the time to draw.
QUICK: dict[str, Any] = {"samples": 3}


@pytest.fixture
def plotter() -> Any:
    made: Any = pv.Plotter(off_screen=True, window_size=list(SIZE))
    made.disable_anti_aliasing()
    yield made
    made.close()


def shot(plotter: Any) -> Any:
    plotter.render()
    return plotter.screenshot(return_img=True).astype(float)


def at(picture: Any, field: flowtex.FlowField, camera: Camera, lon: float, lat: float) -> Floats:
    """Colours of the pixels around a place, (3, 3, 3)."""
    assert field.projection is not None
    height, width = picture.shape[:2]
    place = field.projection.positions(np.array(lon), np.array(lat))
    x, y = camera.project(place, width / height)
    column, row = int((x + 1) / 2 * width), int((1 - y) / 2 * height)
    return np.asarray(picture[row - 1 : row + 2, column - 1 : column + 2], dtype=float)


@pytest.mark.parametrize("name", ["globe", "robinson"])
def test_lines_are_drawn_unless_they_are_off(plotter: Any, name: str) -> None:
    field = winds(name)
    handle = plotter.flowtex.add(
        field, scalars=False, color="white", show_scalar_bar=False, **QUICK
    )
    camera = read_camera(plotter.camera)
    # Meridian 30 is not a coast there, and the coast of the gulf of Guinea no line of the
    # graticule.
    for option, place, darker in (("graticule", (30.0, 20.0), 15), ("coastlines", (9.45, 1.1), 60)):
        with_lines = at(shot(plotter), field, camera, *place)
        setattr(handle, option, False)
        without = at(shot(plotter), field, camera, *place)
        assert (without - with_lines).max() > darker
        setattr(handle, option, True)
        assert at(shot(plotter), field, camera, *place) == pytest.approx(with_lines)


@pytest.mark.parametrize("name", ["globe", "lambert"])
def test_no_surface_hides_its_lines(name: str) -> None:
    field = ocean(name)
    assert field.projection is not None
    focus = tuple(field.projection.positions(np.array(10.0), np.array(-20.0)))
    for zoom in (1.0, 300.0):
        drawn: dict[str, Any] = {"size": SIZE, "zoom": zoom, "focus": focus, "scalars": False}
        drawn |= QUICK
        off = flowtex.render(field, **drawn, **{**OFF, "land": LAND_COLOR}).astype(float)
        on = flowtex.render(field, **drawn, coastlines=False).astype(float)
        # Meridian 10 goes through the middle, from the lower border to the upper one, unbroken.
        middle = slice(SIZE[0] // 2 - 2, SIZE[0] // 2 + 2)
        rows = (np.abs(on - off).max(axis=-1) > 8)[:, middle].any(axis=1)
        assert rows[SIZE[1] // 4 : -SIZE[1] // 4].mean() > 0.97


@pytest.mark.parametrize("zoom", [0.3, 1.0, 6.0])
@pytest.mark.parametrize("name", ["lambert", "globe"])
def test_land_has_its_colour_or_none(plotter: Any, name: str, zoom: float) -> None:
    field = ocean(name)
    assert field.projection is not None
    assert ground_cells(field).land.any() and not ground_cells(winds("robinson")).land.any()
    plotter.set_background("blue")
    handle = plotter.flowtex.add(field, show_scalar_bar=False, graticule=False, **QUICK)
    focus = field.projection.positions(np.array(16.0), np.array(-12.0))
    camera = Camera.fit(field.surface, SIZE[0] / SIZE[1], zoom=zoom, focus=focus)
    apply_camera(camera, plotter.camera)

    def colour() -> Floats:
        return np.asarray(at(shot(plotter), field, camera, 16.0, -12.0)[1, 1])

    assert colour() == pytest.approx(255 * np.array(rgb(LAND_COLOR)), abs=2)
    handle.land = "tomato"
    assert colour() == pytest.approx(255 * np.array(rgb("tomato")), abs=2)
    handle.land = None
    assert colour() == pytest.approx([0, 0, 255], abs=2)
    with pytest.raises(ValueError, match="tomatoe"):
        handle.land = "tomatoe"


@pytest.mark.parametrize("name", ["platecarree", "globe"])
def test_islands_that_only_finer_levels_have_are_land(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 300)
    shrink(monkeypatch.setattr)
    lon, lat = np.linspace(5, 20, 151), np.linspace(5, 15, 101)
    data = winds_on_lines(lon, lat)
    # Of three nodes; the coarsest level has every 16th.
    data.u.values[52:55, 102:105] = np.nan
    field = flowtex.FlowField.from_xarray(data, projection=name)
    assert field.projection is not None
    focus = field.projection.positions(np.array(15.3), np.array(10.3))
    options: dict[str, Any] = {**OFF, "zoom": 20, "focus": tuple(focus), "size": (120, 80)}
    options |= QUICK
    middle = flowtex.render(field, **{**options, "land": "red"})[40, 60].astype(float)
    assert middle == pytest.approx([255, 0, 0], abs=40)
    # What is seen through the flow is the background, and no land.
    options |= {"opacity": 0.5, "scalars": False, "color": "black"}
    seen, other = (
        flowtex.render(field, **{**options, "land": land})[5, 5].astype(int)
        for land in ("red", None)
    )
    assert np.abs(seen - other).max() == 0 or name == "globe"


def test_a_globe_is_below_what_does_not_cover_the_earth() -> None:
    assert globe_radius(winds()) is None
    assert globe_radius(ocean("lambert")) is None
    radius = globe_radius(ocean("globe"))
    assert radius is not None and 0.999 * EARTH_RADIUS < radius < EARTH_RADIUS


def test_no_meridian_is_drawn_twice_where_a_field_has_finer_ones() -> None:
    projection = Projection("globe")
    lon, lat = np.meshgrid(np.arange(5.0, 56.0), np.arange(-25.0, 26.0))
    one = np.ones(lon.shape)
    field = flowtex.FlowField.from_arrays(
        projection.positions(lon, lat),
        projection.vectors(lon, lat, one, one),
        projection=projection,
    )
    lengths = []
    for has_globe in (False, True):
        lines = map_lines(field, has_globe=has_globe)["graticule"]
        first = np.delete(np.arange(len(lines.points)), lines.starts[1:] - 1)
        ends = lines.points[first], lines.points[first + 1]
        x, y = projection.lonlat((ends[0] + ends[1]) / 2)
        inside = (lon.min() + 1 < x) & (x < lon.max() - 1)
        inside &= (lat.min() + 1 < y) & (y < lat.max() - 1)
        lengths.append(np.linalg.norm(ends[1] - ends[0], axis=-1)[inside].sum())
    assert lengths[1] == pytest.approx(lengths[0]) and lengths[0] > 0


@pytest.mark.parametrize("name", ["globe", "lambert"])
def test_the_camera_and_the_bounds_are_those_of_the_flow(name: str) -> None:
    found: list[tuple[Any, ...]] = []
    for options in ({}, OFF):
        plotter: Any = pv.Plotter(off_screen=True, window_size=list(SIZE))
        plotter.flowtex.add(ocean(name), show_scalar_bar=False, **QUICK, **options)
        plotter.render()
        bounds = tuple(plotter.renderer.bounds)
        first = read_camera(plotter.camera)
        plotter.reset_camera()
        found.append((first, bounds, read_camera(plotter.camera)))
        plotter.close()
    assert found[0] == found[1]


def test_all_goes_with_the_flow(plotter: Any) -> None:
    plain = plotter.flowtex.add(gyre(), show_scalar_bar=False)
    count = plotter.renderer.GetActors().GetNumberOfItems()
    plain.coastlines = plain.graticule = True  # of a field that has no projection there are none
    assert plotter.renderer.GetActors().GetNumberOfItems() == count
    plain.remove()
    empty = shot(plotter)
    handle = plotter.flowtex.add(ocean("globe"), show_scalar_bar=False, reset_camera=True, **QUICK)
    shown = shot(plotter)
    assert np.abs(shown - empty).max() > 50
    actors = [a for a in plotter.renderer.GetActors() if not a.GetUseBounds()]
    assert len(actors) == 5 and not any(a.GetPickable() for a in actors)
    handle.visible = False
    np.testing.assert_array_equal(shot(plotter), empty)
    handle.visible = True
    np.testing.assert_array_equal(shot(plotter), shown)
    handle.remove()
    assert plotter.renderer.GetActors().GetNumberOfItems() == 0
    np.testing.assert_array_equal(shot(plotter), empty)


@pytest.mark.parametrize("root_nodes", [100_000, 20_000])
def test_the_ground_below_comes_through_nowhere(
    root_nodes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However coarse the triangles are that a view takes of a fine mesh, whole or in tiles."""
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", root_nodes)
    projection = Projection("globe")
    lon, lat = np.meshgrid(np.arange(-180.0, 180.0), np.arange(-80.0, 80.1))
    u, v = 10 * np.cos(np.radians(lat)), 3 * np.sin(np.radians(3 * lon))
    field = flowtex.FlowField.from_arrays(
        projection.positions(lon, lat), projection.vectors(lon, lat, u, v), projection=projection
    )
    focus = tuple(projection.positions(np.array(20.0), np.array(45.0)))
    for view in ({}, {"zoom": 30.0, "focus": focus}):
        options: dict[str, Any] = {**OFF, **QUICK, **view, "size": (120, 90)}
        with_ground, without = (
            flowtex.render(field, **{**options, "land": land}).astype(int) for land in ("red", None)
        )
        differs = np.abs(with_ground - without).max(axis=-1) > 0
        # Only beyond the last parallel is there anything of it, at the upper border of the globe.
        assert not differs[20:].any()
        assert differs.any() != bool(view)


@pytest.mark.parametrize("view", [{"globe": True}, {"projection": "robinson"}])
def test_a_mesh_has_the_colours_of_the_same_flow_on_a_grid(view: dict[str, Any]) -> None:
    options: dict[str, Any] = {"size": (240, 200), "lighting": False, "clim": (0.0, 10.0)}
    options |= {"cmap": "gray", "coastlines": False, "graticule": False, "show_scalar_bar": False}
    mesh, grid = (
        flowtex.render(ds, **view, **options).astype(float)
        for ds in (
            ugrid(globe(3000), at="node")[0],
            winds_on_lines(np.arange(-180.0, 180.0, 4.0), np.arange(-90.0, 90.1, 4.0)),
        )
    )
    # Patterns differ, and their means over some pixels are the speed.
    coarse = [p[:200, :240].reshape(10, 20, 12, 20, 3).mean(axis=(1, 3)) for p in (mesh, grid)]
    assert np.abs(coarse[0] - coarse[1]).mean() < 12
    assert coarse[0].std() > 20
