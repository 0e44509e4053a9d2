"""Maps of the Earth in the browser: lines, land and the globe as VTK draws them, and readouts."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from flows import half_known
from numpy.typing import NDArray
from scipy import ndimage
from webgl_page import ClientPage, packed, state

import flowtex
from flowtex import FlowField
from flowtex.field.earth.projection import Projection
from flowtex.host.view import web_views
from flowtex.rendering.camera import Camera
from flowtex.rendering.map_overlay import missing_colour
from flowtex.scene.options import Options

pytestmark = pytest.mark.browser

Pixels = NDArray[np.uint8]

SIZE = (360, 240)
WITH_AXES = (450, 300)  #: There is room for ticks.
#: A plain surface, so that what is dark is a line.
PLAIN: dict[str, Any] = {
    "scalars": False,
    "color": "white",
    "strength": 0.0,
    "samples": 3,
    "lighting": False,
}
#: Greatest difference from VTK, root mean square, relative to that of a picture without lines:
#: pieces that overlap are darker there, and its globe is made of triangles.
SHARE = 0.5


@cache
def earth(name: str) -> FlowField:
    """A flow to the east around the Atlantic, with land in the middle."""
    if name != "globe":
        pytest.importorskip("pyproj")
    projection = Projection(name)
    lon, lat = np.meshgrid(np.linspace(-60, 30, 61), np.linspace(-30, 60, 61))
    east = np.full(lon.shape, 10.0)
    east[20:30, 40:50] = np.nan
    velocity = projection.vectors(lon, lat, east, 0 * lon)
    points = projection.positions(lon, lat)
    return FlowField.from_arrays(
        points, velocity, length_unit="m", time_unit="s", projection=projection
    )


def scene(field: FlowField, camera: Camera, **options: Any) -> Any:
    view = web_views(field, Options.split(**PLAIN | options))[0]
    data = view.data()
    header = data.header(view.scene.settings, camera=state(camera))
    return packed(data, header | {"camera": state(camera)}, tuple(range(data.steps)))


def camera_of(field: FlowField, zoom: float) -> Camera:
    """See all of a flow, or its middle from near, where there are coasts."""
    assert field.projection is not None
    focus = field.projection.positions(np.array(-9.45), np.array(38.8)) if zoom > 1 else None
    return Camera.fit(field.surface, SIZE[0] / SIZE[1], zoom=zoom, focus=focus)


def shown(client: ClientPage, field: FlowField, camera: Camera, **options: Any) -> Pixels:
    number = client.mount(scene(field, camera, **options), SIZE, controls=False, smooth=True)
    return client.picture(number)


@pytest.mark.parametrize(("name", "zoom"), [("globe", 30.0), ("mercator", 1.0)])
def test_the_picture_is_that_of_vtk(client: ClientPage, name: str, zoom: float) -> None:
    field = earth(name)
    camera = camera_of(field, zoom)
    ours = shown(client, field, camera).astype(float)
    theirs = flowtex.render(field, camera=camera, size=SIZE, **PLAIN).astype(float)
    without = shown(client, field, camera, coastlines=False, graticule=False).astype(float)
    near, far = (np.sqrt(np.mean((p - theirs) ** 2)) for p in (ours, without))
    assert near < SHARE * far
    # Lines are at the same pixels: what they darken is dark in the other picture too.
    drawn = (without - ours).mean(axis=-1)
    assert (drawn > 60).sum() > 100
    assert np.mean((without - theirs).mean(axis=-1)[drawn > 60] > 30) > 0.95


def test_colours_of_a_globe_are_those_of_the_bar_as_far_as_the_limb(client: ClientPage) -> None:
    projection = Projection("globe")
    lon, lat = np.meshgrid(np.linspace(-180, 180, 73), np.linspace(-88, 88, 45))
    field = FlowField.from_arrays(
        projection.positions(lon, lat),
        projection.vectors(lon, lat, np.full(lon.shape, 10.0), 0 * lon),
        projection=projection,
    )
    camera = camera_of(field, 1)
    look: dict[str, Any] = {"scalars": "speed", "cmap": "gray", "clim": (0.0, 20.0)}
    look |= {"lighting": None, "coastlines": False, "graticule": False, "background": "red"}
    ours = shown(client, field, camera, **look)
    options = {**PLAIN, **look, "show_scalar_bar": False}
    theirs = flowtex.render(field, camera=camera, size=SIZE, **options)
    for picture in (ours, theirs):
        colours = picture.astype(int)
        globe = colours[..., 1] > 20
        limb = globe & ~ndimage.binary_erosion(globe, iterations=8)
        limb &= ndimage.binary_erosion(globe, iterations=2)
        assert limb.sum() > 500
        # Half of the range is grey of 127 or 128.
        assert np.abs(colours[limb] - 127.5).max() < 0.02 * 255


def test_the_far_side_of_a_globe_is_hidden(client: ClientPage) -> None:
    field = earth("globe")
    # From the other side there are no data, and the globe below hides them.
    whole = camera_of(field, 1)
    away = Camera(tuple(-2.2 * np.array(whole.position)), (0, 0, 0), (0, 0, 1))
    options = {"coastlines": False, "graticule": False, "color": "red"}
    picture = shown(client, field, away, land="blue", **options)
    globe = np.rint(255 * missing_colour((1.0, 1.0, 1.0)))
    assert (np.abs(picture - globe) <= 1).all(axis=-1).sum() > 5000
    assert not (picture[..., 0].astype(int) - picture[..., 1] > 100).any()


@pytest.mark.parametrize("width", [300, 700])
def test_the_legend_names_places_without_data(client: ClientPage, width: int) -> None:
    field = half_known("globe", np.linspace(-40, -30, 11), np.linspace(20, 30, 11), -35)
    made = scene(field, camera_of(field, 1), color="red", land="blue")
    number = client.mount(made, (width, 300), smooth=True)
    client.sharp(number)
    kinds = client.page.locator(".kinds .ground")
    lacking = kinds.filter(has_text="no data")
    assert lacking.is_visible()
    box = lacking.bounding_box()
    assert box is not None and box["x"] >= 0 and box["x"] + box["width"] <= width
    colour = lacking.locator("i").evaluate("(mark) => getComputedStyle(mark).backgroundColor")
    red, green, blue = np.rint(255 * missing_colour((1.0, 1.0, 1.0))).astype(int)
    assert colour == f"rgb({red}, {green}, {blue})"


@pytest.mark.parametrize("name", ["globe", "mercator"])
def test_land_is_where_there_are_no_data(client: ClientPage, name: str) -> None:
    field = earth(name)
    camera = camera_of(field, 1)
    options: dict[str, Any] = {"coastlines": False, "graticule": False}
    picture = shown(client, field, camera, land="blue", **options)
    theirs = flowtex.render(field, camera=camera, size=SIZE, land="blue", **PLAIN, **options)
    ours, expected = ((p == [0, 0, 255]).all(axis=-1) for p in (picture, theirs))
    assert expected.sum() > 200
    assert (ours ^ expected).mean() < 0.01


def test_lines_are_as_wide_in_every_draft_and_at_every_zoom(client: ClientPage) -> None:
    field = earth("mercator")
    for zoom in (10.0, 1000.0):
        camera = camera_of(field, zoom)
        with_lines = shown(client, field, camera, graticule=False).astype(float)
        without = shown(client, field, camera, graticule=False, coastlines=False)
        darker = (without - with_lines).mean(axis=-1) / without.mean(axis=-1)
        across = darker[(darker.max(axis=1) > 0.4)].sum(axis=1)
        assert len(across) > 20
        # A line that goes down at an angle is wider along a row.
        assert 0.55 < np.min(across) < 1.8


def test_switches_hide_lines(client: ClientPage) -> None:
    field = earth("globe")
    number = client.mount(scene(field, camera_of(field, 1)), WITH_AXES)
    before = client.picture(number)
    client.page.evaluate("(n) => viewers[n].panel.fold(true)", number)
    for name in ("coastlines", "graticule"):
        switch = client.page.locator(f'[data-lines="{name}"] input')
        assert switch.is_checked()
        switch.evaluate("(input) => input.click()")
    bare = scene(field, camera_of(field, 1), coastlines=False, graticule=False)
    hidden = client.picture(client.mount(bare, WITH_AXES))
    after = client.picture(number)
    assert (before.astype(int) - after).min() < -60
    assert np.abs(after.astype(int) - hidden).mean() < 0.5


def test_the_readout_tells_longitude_and_latitude(client: ClientPage) -> None:
    for name in ("globe", "mercator"):
        field = earth(name)
        number = client.mount(scene(field, camera_of(field, 1)), WITH_AXES)
        client.sharp(number)
        client.page.wait_for_function("(n) => viewers[n].canPick", arg=number)
        point, text = client.page.evaluate(
            """(n) => {
              const point = viewers[n].point(0.1, 0.2);
              viewers[n].panel.read(point);
              return [point.position,
                viewers[n].root.shadowRoot.querySelector(".readout").textContent];
            }""",
            number,
        )
        assert field.projection is not None
        lon, lat = field.projection.lonlat(np.array(point))
        assert text == (
            f"{abs(lon):.2f}° {'W' if lon < 0 else 'E'}, {abs(lat):.2f}° {'S' if lat < 0 else 'N'}"
        )
        client.clear()
