"""Flows on axes of maps: degrees, graticules at the border, and the projections of cartopy."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

pytest.importorskip("xarray")
pytest.importorskip("pyproj")

from earth_data import winds
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import flowtex
from flowtex import FieldError
from flowtex.plotting.offscreen.axes_kinds import latitude_text, longitude_text

pytestmark = pytest.mark.usefixtures("opengl")

LON, LAT = np.arange(-180.0, 180.0, 10.0), np.arange(-80.0, 81.0, 10.0)
REGION = np.arange(150.0, 211.0, 4.0), np.arange(-60.0, -29.0, 4.0)


@pytest.fixture
def figure() -> Figure:
    made = Figure(figsize=(4, 3), dpi=60)
    FigureCanvasAgg(made)
    return made


def ticks(axis: Any) -> dict[float, str]:
    """Labels of an axis within its limits, by their places."""
    low, high = sorted(axis.get_view_interval())
    places = [x for x in axis.get_major_locator()() if low - 1e-9 <= x <= high + 1e-9]
    texts = axis.get_major_formatter().format_ticks(places)
    return dict(zip(map(float, places), texts, strict=True))


def test_data_of_the_earth_are_in_degrees(figure: Figure) -> None:
    ax = figure.add_subplot()
    flowtex.axes(ax, winds(LON, LAT), samples=3)
    assert ax.get_xlim() == pytest.approx((-180, 180)) and ax.get_ylim() == pytest.approx((-80, 80))
    assert {0.0: "0°", 60.0: "60°E", -120.0: "120°W"}.items() <= ticks(ax.xaxis).items()
    assert ticks(ax.yaxis)[-60.0] == "60°S"
    figure.canvas.draw()


def test_limits_that_have_been_set_are_kept(figure: Figure) -> None:
    ax = figure.add_subplot()
    ax.set(xlim=(-20, 40))
    ax.invert_yaxis()
    flowtex.axes(ax, winds(LON, LAT), samples=3)
    assert ax.get_xlim() == (-20, 40) and ax.get_ylim() == pytest.approx((80, -80))


@pytest.mark.parametrize("projection", ["robinson", "north", "mercator", "lambert"])
def test_ticks_are_where_the_graticule_meets_the_border(figure: Figure, projection: str) -> None:
    ax = figure.add_subplot()
    lon, lat = (LON, LAT) if projection in ("robinson", "mercator") else (LON, LAT[LAT >= 20])
    if projection == "lambert":
        lon = np.arange(-30.0, 41.0, 5.0)
    image = flowtex.axes(ax, winds(lon, lat), projection=projection, samples=3)
    found = image._scene.field.projection
    assert found is not None
    bottom, left = ax.get_ylim()[0], ax.get_xlim()[0]
    shown = 0
    for x, text in ticks(ax.xaxis).items():
        place = np.array([x, bottom, 0.0])
        degrees, _ = found.lonlat(place)
        if np.allclose(found.positions(*found.lonlat(place)), place, atol=1e3):
            assert longitude_text(round(float(degrees), 1)) == text, (x, bottom)
            shown += 1
    for y, text in ticks(ax.yaxis).items():
        place = np.array([left, y, 0.0])
        here = found.lonlat(place)
        if np.allclose(found.positions(*here), place, atol=1e3):
            # Around a pole meridians meet the left border as well.
            texts = (
                longitude_text(round(float(here[0]), 1)),
                latitude_text(round(float(here[1]), 1)),
            )
            assert text == texts[projection != "north"]
            shown += 1
    assert shown >= (3 if projection != "robinson" else 0) and len(ticks(ax.yaxis)) >= 3


def test_the_title_tells_level_and_time_until_it_is_another(figure: Figure) -> None:
    ds = flowtex.examples.weather().isel(latitude=slice(None, None, 4))
    ax, other = figure.subplots(1, 2)
    flowtex.axes(ax, ds.sel(level=250), samples=3)
    assert ax.get_title() == "250 hPa, 2024-01-15 12:00"
    other.set_title("Winds")
    flowtex.axes(other, ds, level=500, samples=3)
    assert other.get_title() == "Winds"


def test_degrees_of_small_axes_have_room(figure: Figure) -> None:
    figure.set_size_inches(5.2, 3.3)
    currents = flowtex.examples.ocean().isel(time=[0], latitude=slice(None, None, 4))
    winds_ = flowtex.examples.weather().sel(level=500).isel(latitude=slice(None, None, 4))
    for number, ds in enumerate([currents, winds_], start=1):
        flowtex.axes(figure.add_subplot(2, 2, number), ds, samples=3)
    figure.canvas.draw()
    for ax in figure.axes:
        low, high = ax.get_xlim()
        labels = [text for text in ax.get_xticklabels() if low <= text.get_position()[0] <= high]
        assert labels and all(int(text.get_text().split("°")[0]) % 15 == 0 for text in labels)
        boxes = [text.get_window_extent() for text in labels]
        assert all(one.x1 < two.x0 for one, two in itertools.pairwise(boxes))


def _axes(figure: Figure, name: str, **options: Any) -> tuple[Any, Any]:
    crs: Any = pytest.importorskip("cartopy.crs")
    return figure.add_subplot(projection=getattr(crs, name)(**options)), crs


MAPS: list[tuple[str, dict[str, float]]] = [
    ("PlateCarree", {}),
    ("PlateCarree", {"central_longitude": 180}),
    ("Robinson", {"central_longitude": 150}),
    ("Orthographic", {"central_longitude": 10, "central_latitude": 50}),
    ("SouthPolarStereo", {"central_longitude": 30}),
    ("InterruptedGoodeHomolosine", {}),
    ("RotatedPole", {"pole_longitude": 177.5, "pole_latitude": 37.5}),
]


@pytest.mark.parametrize(("name", "options"), MAPS)
def test_directions_on_maps_of_cartopy_are_those_that_it_computes(
    figure: Figure, name: str, options: dict[str, float]
) -> None:
    ax, crs = _axes(figure, name, **options)
    image = flowtex.axes(ax, winds(LON, LAT), samples=3)
    field, unit = image._scene.field, image._unit
    assert field.projection is not None
    valid = field.surface.valid
    lon, lat = field.projection.lonlat(field.points[valid])
    east, north = field.projection.components(lon, lat, np.asarray(field.velocity[0])[valid])
    place = unit.inverted().transform(field.points[valid][:, :2])
    theirs = ax.projection.transform_points(crs.PlateCarree(), lon, lat)[:, :2]
    beside = np.abs(theirs - place).max(axis=1) < 1e-6 * np.ptp(ax.get_xlim())
    beside &= np.abs(lat) < 80  # where cartopy, too, takes differences
    assert beside.mean() > 0.8, "places on the two maps are the same"
    # Where a particle goes, and comes from, in a short time; across a tear the two differ.
    way = np.stack([east / np.cos(np.radians(lat)), north])[:, beside]
    way *= 0.02 / np.linalg.norm(way, axis=0)
    ends = (
        ax.projection.transform_points(crs.PlateCarree(), lon[beside] + s * a, lat[beside] + s * b)
        for a, b in [way]
        for s in (1, -1)
    )
    ahead, behind = (
        sign * (end[:, :2] - place[beside]) for end, sign in zip(ends, (1, -1), strict=True)
    )
    whole = np.linalg.norm(ahead - behind, axis=1) < 0.05 * np.linalg.norm(ahead, axis=1)
    assert whole.mean() > 0.85  # nodes beside a tear are not
    u, v = (ahead + behind)[whole].T
    ours = np.asarray(field.velocity[0])[valid][beside][whole]
    turned = np.angle((u + 1j * v) / (ours[:, 0] + 1j * ours[:, 1]))
    assert np.abs(turned).max() < np.radians(0.2)


@pytest.mark.parametrize("middle", [0, -160, 13])  # tears on columns of the data, and between them
def test_an_interrupted_map_is_drawn_up_to_where_it_is_torn(figure: Figure, middle: float) -> None:
    ax, crs = _axes(figure, "InterruptedGoodeHomolosine", central_longitude=middle)
    ax.set_facecolor("#ff0000")
    figure.set_dpi(200)
    data = winds(np.arange(-180.0, 180.0, 5.0), np.arange(-80.0, 81.0, 5.0))
    flowtex.axes(ax, data, samples=3, cmap="viridis")
    figure.canvas.draw()
    shot = np.asarray(figure.canvas.buffer_rgba())[..., :3]  # type: ignore[attr-defined]
    tears = {-40: 1, -100: -1, -20: -1, 80: -1}  # longitudes from the middle, north or south
    beside, lat = np.meshgrid([-1.5, 1.5], np.arange(2, 76, 3))
    for tear, side in tears.items():
        lon = (tear + middle + beside + 180) % 360 - 180
        places = ax.projection.transform_points(crs.PlateCarree(), lon, side * lat)[..., :2]
        x, y = ax.transData.transform(places.reshape(-1, 2)).astype(int).T
        bare = (shot[len(shot) - 1 - y, x] == (255, 0, 0)).all(axis=-1)
        assert not bare.any(), (tear, lat.ravel()[bare], beside.ravel()[bare])


def test_a_map_of_cartopy_keeps_its_extent_and_its_outline(figure: Figure) -> None:
    ax, crs = _axes(figure, "Robinson")
    ax.set_extent([-40, 60, -50, 50], crs.PlateCarree())
    limits = ax.get_xlim(), ax.get_ylim()
    flowtex.axes(ax, winds(LON, LAT), samples=3)
    assert (ax.get_xlim(), ax.get_ylim()) == limits
    figure.clear()
    ax, _ = _axes(figure, "Robinson")
    figure.set_facecolor("#00ff00")
    flowtex.axes(ax, winds(LON, LAT), samples=3)
    figure.canvas.draw()
    shot = np.asarray(figure.canvas.buffer_rgba())  # type: ignore[attr-defined]
    box = ax.get_window_extent()
    corner = shot[shot.shape[0] - int(box.y1) + 2, int(box.x0) + 2, :3]
    assert tuple(corner) == (0, 255, 0), "beside the outline there is the figure"


def test_what_does_not_fit_a_map_of_cartopy_is_refused(figure: Figure) -> None:
    ax, _ = _axes(figure, "Robinson")
    with pytest.raises(
        FieldError,
        match=r"^ax is a map, and .* is not of the Earth, as far as is known; give a data",
    ):
        flowtex.axes(ax, flowtex.examples.double_gyre_field())
    with pytest.raises(FieldError, match=r"^no\.nc: the file does not exist"):
        flowtex.axes(ax, "no.nc")
    with pytest.raises(FieldError, match=r"^projection and globe are those of the axes"):
        flowtex.axes(ax, winds(LON, LAT), projection="mercator")
