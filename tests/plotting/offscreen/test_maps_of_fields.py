"""Fields and stores on axes of cartopy lie where the data do, whichever map they come from."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("xarray")
pytest.importorskip("pyproj")
pytest.importorskip("cartopy")

import cartopy.crs as ccrs
from earth_data import components, winds
from flows import half_known
from map_places import turned_frame
from map_places import winds as curvilinear_winds
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import flowtex
from flowtex import FieldError, FlowField
from flowtex._util.array_types import Bytes, Floats
from flowtex.field.earth.projection import Projection
from flowtex.plotting.offscreen.flow_image import FlowImage
from flowtex.rendering.map_overlay import missing_colour

pytestmark = pytest.mark.usefixtures("opengl")

#: Data at 82 to 46 W, and all around the Earth.
REGION = np.arange(-82.0, -45.0, 2.0), np.arange(10.0, 51.0, 2.0)
AROUND = np.arange(-180.0, 180.0, 5.0), np.linspace(-90.0, 90.0, 37)
AXES: dict[str, Any] = {
    "PlateCarree": ccrs.PlateCarree(),
    "PlateCarree around 180": ccrs.PlateCarree(central_longitude=180),
    "Mercator": ccrs.Mercator(),
    "Web Mercator": ccrs.epsg(3857),
    "Robinson": ccrs.Robinson(central_longitude=-100),
    "polar": ccrs.NorthPolarStereo(),
    "rotated": ccrs.RotatedPole(pole_longitude=100, pole_latitude=50),
    "Lambert": ccrs.LambertConformal(central_longitude=-60, central_latitude=30),
}


def from_arrays() -> FlowField:
    lon, lat = np.meshgrid(*REGION)
    there = Projection("mercator", (-60.0, 0.0))
    velocity = there.vectors(lon, lat, *components(lon, lat))
    points = there.positions(lon, lat)
    return FlowField.from_arrays(points, velocity, projection=there, length_unit="m", time_unit="s")


def from_triangles() -> FlowField:
    field = from_arrays()
    number = np.arange(field.valid.size).reshape(field.shape)
    a, b = number[:-1, :-1].ravel(), number[:-1, 1:].ravel()
    c, d = number[1:, :-1].ravel(), number[1:, 1:].ravel()
    triangles = np.concatenate([np.stack([a, b, d], axis=-1), np.stack([a, d, c], axis=-1)])
    flat = field.points.reshape(-1, 3), triangles, field.velocity[0].reshape(-1, 3)
    return FlowField.from_triangles(*flat, projection=field.projection, length_unit="m")


def from_dataset(name: str | None) -> Callable[[], FlowField]:
    return lambda: FlowField.from_xarray(winds(*REGION), projection=name)


SOURCES: dict[str, Callable[[], Any]] = {
    "dataset": lambda: winds(*REGION),
    "globe": from_dataset("globe"),
    "flat": from_dataset(None),
    "mollweide": from_dataset("+proj=moll +lon_0=20"),
    "arrays": from_arrays,
    "triangles": from_triangles,
}


def shown(crs: Any, data: Any, **options: Any) -> tuple[FlowImage, Bytes]:
    """Draw data on axes of a map, and return the image and the pixels."""
    figure = Figure(figsize=(4, 3), dpi=60, facecolor="#ff00ff")
    canvas: Any = FigureCanvasAgg(figure)
    ax: Any = figure.add_axes((0, 0, 1, 1), projection=crs)
    ax.set_facecolor("#ff00ff")
    image = flowtex.axes(ax, data, samples=3, strength=0.0, cmap="gray", **options)
    canvas.draw()
    return image, np.asarray(canvas.buffer_rgba())[::-1, :, :3]


def pixel(image: FlowImage, lon: Any, lat: Any) -> tuple[Floats, Floats]:
    """Return the pixels of places."""
    ax: Any = image.axes
    places = ax.projection.transform_points(ccrs.PlateCarree(), np.asarray(lon), np.asarray(lat))
    x, y = ax.transData.transform(places[..., :2]).T
    return x, y


def assert_right(image: FlowImage, shot: Bytes) -> None:
    """Compare places and colours with cartopy's places and the data."""
    lon, lat = (at.ravel() for at in np.meshgrid(np.arange(-79.0, -48, 5), np.arange(14.0, 47, 5)))
    x, y = (np.floor(at).astype(int) for at in pixel(image, lon, lat))
    inside = (x >= 0) & (y >= 0) & (x < shot.shape[1]) & (y < shot.shape[0])
    assert inside.mean() > 0.6
    low, high = image.get_clim()
    speed = np.hypot(*components(lon, lat))[inside]
    drawn = shot[y[inside], x[inside]].astype(float)
    assert np.ptp(drawn, axis=1).max() <= 2, "grey, and not the ground"
    assert drawn[:, 0] / 255 == pytest.approx((speed - low) / (high - low), abs=0.04)
    beyond = np.array([-95.0, -30.0, -64.0, -64.0]), np.array([30.0, 30.0, 2.0, 62.0])
    x, y = (np.floor(at).astype(int) for at in pixel(image, *beyond))
    inside = (x > 3) & (y > 3) & (x < shot.shape[1] - 4) & (y < shot.shape[0] - 4)
    assert (shot[y[inside], x[inside]] == (255, 0, 255)).all(), "nothing beside the data"


@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize("name", ["PlateCarree", "Robinson"])
def test_fields_lie_where_the_data_do(name: str, source: str) -> None:
    assert_right(*shown(AXES[name], SOURCES[source]()))


@pytest.mark.parametrize("name", AXES)
def test_fields_lie_where_the_data_do_on_every_map(name: str) -> None:
    assert_right(*shown(AXES[name], SOURCES["flat"]()))


@pytest.mark.parametrize("source", ["globe", None, "robinson"])
def test_a_field_around_the_earth_has_no_hole_on_another_map(source: str | None) -> None:
    field = FlowField.from_xarray(winds(*AROUND), projection=source)
    lon, lat = (
        at.ravel() for at in np.meshgrid(np.arange(-177.0, 180, 6), np.arange(-75.0, 76, 10))
    )
    for name in ("PlateCarree around 180", "Robinson"):
        image, shot = shown(AXES[name], field)
        x, y = (np.clip(np.floor(at).astype(int), 0, None) for at in pixel(image, lon, lat))
        drawn = shot[np.minimum(y, 179), np.minimum(x, 239)].astype(float)
        low, high = image.get_clim()
        wanted = (np.hypot(*components(lon, lat)) - low) / (high - low)
        error = np.abs(drawn[:, 0] / 255 - np.clip(wanted, 0, 1))
        assert (np.ptp(drawn, axis=1) <= 2).mean() > 0.97
        assert np.quantile(error, 0.95) < 0.05


@pytest.mark.parametrize(
    "crs",
    [
        ccrs.PlateCarree(),
        ccrs.PlateCarree(central_longitude=180),
        ccrs.Mercator(),
        ccrs.Robinson(),
        ccrs.Mollweide(),
        ccrs.EqualEarth(central_longitude=-60),
    ],
    ids=lambda crs: type(crs).__name__,
)
def test_a_rotated_grid_is_drawn_up_to_the_poles_and_edges_of_a_map(crs: Any) -> None:
    lines = np.arange(-180.0, 180.0, 6.0), np.arange(-87.0, 88.0, 6.0)
    frame = turned_frame(77.3, 38.3)
    image, shot = shown(crs, curvilinear_winds(*frame.transform(*np.meshgrid(*lines))))
    rng = np.random.default_rng(2)
    lon = rng.uniform(-180.0, 180.0, 400)
    lat = rng.choice([-1, 1], 400) * (90.0 - rng.uniform(0.0, 30.0, 400))
    # Places beside the edge of the map, and at its poles.
    middle = float(ccrs.PlateCarree().transform_point(0.0, 0.0, crs)[0])
    lon[:100] = middle + 180.0 - rng.uniform(-2.0, 2.0, 100)
    lat[:100] = rng.uniform(-80.0, 80.0, 100)
    own = np.abs(np.array(frame.transform(lon, lat, direction="INVERSE"))[1]) < 84.0
    if isinstance(crs, ccrs.Mercator):
        own &= np.abs(lat) < 84.0
    x, y = pixel(image, lon, lat)
    x = np.clip(np.floor(0.99 * (x - 120.0) + 120.0), 0, 239).astype(int)  # not on the outline
    y = np.clip(np.floor(0.99 * (y - 90.0) + 90.0), 0, 179).astype(int)
    drawn = shot[y[own], x[own]].astype(float)
    # Grey, and not the ground, of which pixels on the outline have a part.
    assert np.ptp(drawn, axis=1).max() < 128
    grey = np.ptp(drawn, axis=1) <= 2
    assert grey.mean() > 0.7
    low, high = image.get_clim()
    wanted = (np.hypot(*components(lon, lat))[own] - low) / (high - low)
    error = np.abs(drawn[:, 0] / 255 - np.clip(wanted, 0, 1))
    assert np.quantile(error[grey], 0.9) < 0.06


def test_a_series_and_its_scalars_are_put_on_another_map() -> None:
    data = winds(*REGION)
    data["warmth"] = (data["u"] + 20).drop_attrs().assign_attrs(units="K")
    days = np.array(["2001-01-01", "2001-01-02"], "M8[ns]")
    series = data.expand_dims(time=days) * np.array([1.0, 3.0]).reshape(2, 1, 1)
    for key in "uv":
        series[key].attrs = data[key].attrs
    field = FlowField.from_xarray(series)
    image, _ = shown(AXES["rotated"], field, scalars="warmth")
    flow = image.flow
    assert (flow.start, flow.unit_of("speed")) == (field.start, field.speed_unit)
    for time in (None, field.times[-1], field.times[-1] / 3):
        one, other = field.at(-60.3, 33.3, time=time), flow.at(-60.3, 33.3, time=time)
        assert one is not None
        assert other is not None
        got = [other.eastward, other.northward, other.speed, other.scalars["warmth"]]
        wanted = [one.eastward, one.northward, one.speed, one.scalars["warmth"]]
        assert got == pytest.approx(wanted, rel=1e-3, abs=0.02)


def test_an_array_colours_a_dataset_on_axes_of_a_map() -> None:
    """The axes set the projection of the dataset, and the array comes along."""
    data = winds(*REGION)
    warmth = np.add.outer(REGION[1], 2.0 * REGION[0])
    for name in ("PlateCarree", "Mercator"):
        image, _ = shown(AXES[name], data, scalars=warmth)
        assert image.get_clim() == (warmth.min(), warmth.max())
        found = image.flow.at(-61.0, 33.0)
        assert found is not None
        assert found.scalars["Data"] == pytest.approx(33.0 - 2 * 61.0, abs=0.05)


def test_fields_without_a_place_on_the_earth_are_refused() -> None:
    x, y = np.meshgrid(*REGION)
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), np.ones((*x.shape, 2)))
    with pytest.raises(FieldError, match=r"not of the Earth.*projection=flowtex\.field\.earth"):
        shown(AXES["PlateCarree"], field)


def test_stores_are_drawn_on_their_own_map(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, small_tiles: None
) -> None:
    pytest.importorskip("zarr")
    for projection, own in ((None, "PlateCarree"), ("+proj=robin +lon_0=-100", "Robinson")):
        place = tmp_path / f"{own}.zarr"
        field = FlowField.from_xarray(winds(*REGION), projection=projection)
        with monkeypatch.context() as patch:
            patch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 150)
            flowtex.pyramid.build(field, place, progress=False)
        store = flowtex.pyramid.open(place)
        assert store.valid.size < 200
        for data in (store, place, str(place)):
            assert_right(*shown(AXES[own], data))
        with pytest.raises(
            FieldError, match=r"ax shows the map .* build it on the map of the axes"
        ):
            shown(AXES["polar"], store)


#: Longitudes of data, the map of their store, and axes that end elsewhere.
TURNED: dict[str, tuple[Floats, str, Any]] = {
    "around": (np.arange(0.0, 360.0, 5.0), "platecarree", ccrs.PlateCarree(180)),
    "region": (np.arange(140.0, 240.0, 4.0), "platecarree", ccrs.PlateCarree()),
    "Mercator": (np.arange(0.0, 360.0, 5.0), "+proj=merc +lon_0=180", ccrs.Mercator()),
    "region in two parts": (
        np.arange(-60.0, 61.0, 4.0),
        "+proj=eqc +lon_0=180 +R=6371000",  # newer PROJ has an ellipsoid without it
        ccrs.PlateCarree(),
    ),
}


@pytest.mark.parametrize("name", TURNED)
def test_a_store_is_drawn_on_axes_that_end_at_another_meridian(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, small_tiles: None, name: str
) -> None:
    pytest.importorskip("zarr")
    lon, projection, crs = TURNED[name]
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 150)
    # Blank lines remain in the coarsest level.
    monkeypatch.setattr("flowtex.sources.maps.COARSE_NODES", 100)
    place = tmp_path / "turned.zarr"
    flow = FlowField.from_xarray(winds(lon, np.arange(-80.0, 81.0, 4.0)), projection=projection)
    flowtex.pyramid.build(flow, place, progress=False)
    image, shot = shown(crs, place, coastlines=False)
    inner = (lon + 180.0) % 360.0 - 180.0 + 1.7
    places = np.meshgrid(inner[1:-1], np.arange(-70.0, 71.0, 10.0))
    a, b = (at.ravel() for at in places)
    x, y = (np.floor(at).astype(int) for at in pixel(image, a, b))
    inside = (x >= 0) & (y >= 0) & (x < shot.shape[1]) & (y < shot.shape[0])
    assert inside.mean() > 0.9
    drawn = shot[y[inside], x[inside]].astype(float)
    assert np.ptp(drawn, axis=1).max() <= 2, "grey, and not the ground"
    low, high = image.get_clim()
    wanted = (np.hypot(*components(a, b))[inside] - low) / (high - low)
    # Its coarsest level has a node in 30 degrees or so.
    assert np.quantile(np.abs(drawn[:, 0] / 255 - wanted), 0.9) < 0.06
    if name == "region":
        x, y = (
            np.floor(at).astype(int)
            for at in pixel(image, np.arange(-100.0, 130, 10.0), np.zeros(23))
        )
        assert (shot[y, x] == (255, 0, 255)).all(), "nothing beside the data"


def test_small_stores_are_drawn_on_every_map(tmp_path: Path, small_tiles: None) -> None:
    pytest.importorskip("zarr")
    place = tmp_path / "small.zarr"
    flowtex.pyramid.build(SOURCES["flat"](), place, progress=False)
    for name in ("polar", "PlateCarree around 180"):
        assert_right(*shown(AXES[name], place))


@pytest.mark.parametrize("name", ["PlateCarree", "Robinson", "usual"])
def test_a_legend_names_places_without_data(name: str) -> None:
    field = half_known("platecarree", np.linspace(-40, -20, 11), np.linspace(20, 40, 11), -32)
    figure = Figure()
    ax = figure.add_subplot(projection=AXES.get(name), facecolor="black")
    flowtex.axes(ax, field, samples=3)
    handles: Any
    handles, labels = ax.get_legend_handles_labels()
    assert labels == ["no data"]
    assert ax.get_legend() is not None
    assert handles[0].get_facecolor()[:3] == pytest.approx(missing_colour((0.0, 0.0, 0.0)))
    # A complete field has none, and neither has one whose gaps are not drawn.
    cases: list[tuple[FlowField, dict[str, Any]]] = [(from_arrays(), {}), (field, {"land": None})]
    for flow, look in cases:
        other = figure.add_subplot(projection=AXES.get(name))
        flowtex.axes(other, flow, samples=3, **look)
        assert other.get_legend() is None
