"""One number by every route: dataset, field, map, store, axes, point card and picture agree."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

pytest.importorskip("xarray")
pytest.importorskip("pyproj")

import xarray as xr
from case_counts import count_case
from earth_data import DEGREES
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import Delaunay
from strategies import property_test

import flowtex
from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.field.earth.projection import EARTH_RADIUS
from flowtex.field.quantities import PointValues, values_at
from flowtex.scene.probe import locate, probe
from flowtex.scene.scene import Scene
from flowtex.sources.reproject import reprojected

pytestmark = pytest.mark.hypothesis

KIND = "one number by every route"
#: Maps, with names and definitions of PROJ.
MAPS = [
    "globe",
    None,
    "mercator",
    "robinson",
    "equalearth",
    "lambert",
    "+proj=moll +lon_0=40",
    "+proj=eck4 +lon_0=-170",
    "+proj=laea +lat_0=30 +lon_0=-60",
    "+proj=aeqd +lat_0=50 +lon_0=20",
    "+proj=eqc +lon_0=180",
]
POINTS = 3  #: Points of a case.
PROBED = 0.1  #: Share of the points at which the method is computed, which needs all textures.


@pytest.fixture(autouse=True)
def _quiet() -> Iterator[None]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def waves(rng: np.random.Generator, a: Any, b: Any, steps: int) -> Floats:
    """Return smooth values (T, ...) of two coordinates, some tens of units long."""
    result = np.zeros((steps, *np.broadcast_shapes(np.shape(a), np.shape(b))))
    for step in range(steps):
        for _ in range(3):
            along, across = rng.uniform(-0.06, 0.06, 2)
            size, phase = rng.uniform(1, 8), rng.uniform(0, 7)
            result[step] += size * np.sin(along * a + across * b + phase)
    return result


def line(rng: np.random.Generator, low: float, high: float, count: int, *, even: bool) -> Floats:
    """Return increasing or decreasing coordinates."""
    steps = np.ones(count - 1)
    if not even:
        steps = rng.uniform(0.5, 1.5, count - 1)
    values = low + (high - low) * np.concatenate([[0], np.cumsum(steps)]) / steps.sum()
    if rng.uniform() < 0.3:
        values = values[::-1]
    return np.array(values)


def on_lines(rng: np.random.Generator) -> Any:
    """Return a dataset of a region or of all the Earth."""
    steps = int(rng.choice([1, 3]))
    if rng.uniform() < 0.5:
        lon = np.arange(-180.0, 180.0, 360 / rng.integers(20, 50)) + rng.uniform(0, 180)
        lat = line(rng, -90, 90, int(rng.integers(15, 30)), even=True)
    else:
        west, south = rng.uniform(-180, 180), rng.uniform(-70, 40)
        lon = line(rng, west, west + rng.uniform(10, 60), int(rng.integers(6, 25)), even=False)
        lat = line(rng, south, south + rng.uniform(10, 30), int(rng.integers(6, 25)), even=False)
    grid = np.meshgrid(lon, lat)
    shown = [waves(rng, np.abs((grid[0] - lon[0]) % 360 - 180), grid[1], steps) for _ in range(3)]
    poles = np.abs(lat) == 90.0  # one place each, with one value
    shown[2][:, poles] = shown[2][:, poles].mean(axis=-1, keepdims=True)
    dims = ("time", "lat", "lon")
    named = {
        "u": (dims, shown[0], {"standard_name": "eastward_wind", "units": "m s-1"}),
        "v": (dims, shown[1], {"standard_name": "northward_wind", "units": "m s-1"}),
        "q": (dims, shown[2], {"units": "K"}),
    }
    places = {"lon": ("lon", lon, DEGREES["lon"]), "lat": ("lat", lat, DEGREES["lat"])}
    times = {"time": ("time", 3600.0 * np.arange(steps), {"units": "s"})}
    return xr.Dataset(named, {**places, **times})


def between(rng: np.random.Generator, values: Floats) -> float:
    """Return a place within an interval of a line."""
    number = int(rng.integers(len(values) - 1))
    return float(values[number] + rng.uniform(0.02, 0.98) * (values[number + 1] - values[number]))


def moment(rng: np.random.Generator, times: Floats) -> float:
    """Return a time at a step or between two."""
    if len(times) == 1 or rng.uniform() < 0.3:
        return float(rng.choice(times))
    return between(rng, times)


def numbers(at: PointValues | None) -> list[float]:
    """Return what a point shows on the Earth."""
    assert at is not None
    return [at.eastward, at.northward, at.speed, at.scalars["q"]]


def assert_by_scene(field: Any, place: tuple[float, ...], time: float, *, probed: bool) -> None:
    """Compare the point with its index and the point card, and if ``probed`` with the method."""
    from flowtex.app.streaming.points import values_of

    wanted = field.at(*place, time=time)
    assert wanted is not None
    index = locate(field, wanted.position)
    assert index is not None
    scene = Scene.of(field, samples=3)
    scene.time = time
    read = [values_at(field, index, time), values_at(field, wanted.index, scene.time)]
    if probed and (wanted.lonlat is None or abs(wanted.lonlat[1]) < 85):
        read.append(probe(scene, wanted.index, pixel=field.surface.extent / 1000).field_values)
    for other in read:
        assert other.speed == pytest.approx(wanted.speed, rel=1e-3, abs=1e-3)
        assert other.scalars == pytest.approx(dict(wanted.scalars), rel=1e-3, abs=1e-3)
    card = values_of(wanted, wanted.index)
    assert card["values"] == {"speed": wanted.speed, **wanted.scalars}


def assert_in_picture(
    drawn: Any,
    places: Floats,
    values: Floats,
    crs: Any,
    limits: tuple[float, float],
    time: float,
    scalars: str = "q",
) -> None:
    """Compare colours of a picture on axes, read through the bar."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(3, 2), dpi=60)
    canvas: Any = FigureCanvasAgg(figure)
    ax: Any = figure.add_axes((0, 0, 1, 1), projection=crs)
    ax.set_facecolor("#ff00ff")  # where there are no data
    look: dict[str, Any] = {
        "scalars": scalars,
        "cmap": "gray",
        "clim": limits,
        "strength": 0.0,
        "samples": 3,
    }
    image = flowtex.axes(ax, drawn, time=time, **look)
    canvas.draw()
    shot = np.asarray(canvas.buffer_rgba())[::-1]
    at = places
    if crs is not None:
        import cartopy.crs as ccrs

        at = ax.projection.transform_points(ccrs.PlateCarree(), *places.T)[:, :2]
    x, y = np.floor(ax.transData.transform(at)).astype(int).T
    left, low, right, high = ax.get_window_extent().extents
    inside = (x > left + 2) & (y > low + 2) & (x < right - 3) & (y < high - 3)
    for column, row, value in zip(x[inside], y[inside], values[inside], strict=True):
        near = shot[row - 1 : row + 2, column - 1 : column + 2, :3].astype(float)
        if np.ptp(near, axis=-1).max() > 2:
            continue  # beside the data, or on the frame
        least, most = (limits[0] + np.ptp(limits) * end / 255 for end in (near.min(), near.max()))
        slack = 0.02 * np.ptp(limits)
        assert least - slack <= value <= most + slack
    assert image.time == time


def projections(rng: np.random.Generator) -> Any:
    """Return a map of cartopy, or ``None`` without it."""
    ccrs = pytest.importorskip("cartopy.crs")
    made = [
        ccrs.PlateCarree(),
        ccrs.PlateCarree(central_longitude=180),
        ccrs.Robinson(central_longitude=60),
        ccrs.RotatedPole(pole_longitude=100, pole_latitude=60),
        ccrs.Mercator(),
    ]
    return made[int(rng.integers(len(made)))]


@property_test(16, fuzz=100)
@given(seed=st.integers(0, 2**32 - 1))
@example(seed=104916)  # a map on which a pole is one point
def test_datasets_fields_and_maps_have_one_number(seed: int) -> None:
    rng = np.random.default_rng(seed)
    data = on_lines(rng)
    one, other, third = (MAPS[int(n)] for n in rng.integers(len(MAPS), size=3))
    fields = [FlowField.from_xarray(data, projection=name) for name in (one, other)]
    fields.append(reprojected(fields[0], third or "platecarree"))
    size = float(np.abs(data["u"]).max() + np.abs(data["v"]).max())
    for _ in range(POINTS):
        lon, lat = between(rng, data["lon"].values), between(rng, data["lat"].values)
        time = moment(rng, data["time"].values)
        exact = data.interp(lon=lon, lat=lat)
        exact["speed"] = np.hypot(exact["u"], exact["v"])
        if data.sizes["time"] > 1:
            exact = exact.interp(time=time)
        wanted = [float(exact[key].squeeze()) for key in ("u", "v", "speed", "q")]
        for field in fields:
            got = field.at(lon, lat, time=time)
            if got is None:
                continue  # beyond the edge of the map
            assert numbers(got) == pytest.approx(wanted, rel=2e-3, abs=5e-3 * size)
    got = fields[0].at(lon, lat, time=time)
    if got is not None:
        assert_by_scene(fields[0], (lon, lat), time, probed=rng.uniform() < PROBED)
    count_case(KIND)


@property_test(6, fuzz=40)
@given(seed=st.integers(0, 2**32 - 1))
@example(seed=1_455_530_506)  # beside the pole of the Earth, on a map with another one
@pytest.mark.usefixtures("opengl")
def test_colours_of_a_picture_are_the_numbers(seed: int) -> None:
    rng = np.random.default_rng(seed)
    data = on_lines(rng)
    name = MAPS[int(rng.integers(len(MAPS)))]
    drawn = data
    if rng.uniform() < 0.7:
        drawn = FlowField.from_xarray(data, projection=name)
    time = moment(rng, data["time"].values)
    places = np.array(
        [(between(rng, data["lon"].values), between(rng, data["lat"].values)) for _ in range(8)]
    )
    whole: Any = FlowField.from_xarray(data, projection="globe")
    values = np.array([numbers(whole.at(*place, time=time))[3] for place in places])
    limits = float(data["q"].min()), float(data["q"].max())
    assert_in_picture(drawn, places, values, projections(rng), limits, time)
    count_case(KIND)


def opposite(*, leaves: bool = False) -> dict[str, Any]:
    """Return steps (2, J, I, 3) of a flow that turns round, with their positions and times."""
    y, x = np.mgrid[0:5.0, 0:6.0]
    flow = np.stack([3 + 0 * x, 4 + 0 * x, 12.0 * leaves + 0 * x], axis=-1)
    return {
        "points": np.stack([x, y], axis=-1),
        "velocity": np.stack([flow, -2 * flow]),
        "times": [0.0, 1.0],
        "scalars": {"q": x},
    }


def turning(kind: str, place: Path) -> Any:
    """Return a field whose speed goes from 5 to 10 while its flow turns round."""
    parts = opposite(leaves=kind == "leaves the surface")
    if kind == "triangles":
        points = parts.pop("points").reshape(-1, 2)
        flow = parts.pop("velocity").reshape(2, -1, 3)[..., :2]
        warmth = {"q": parts.pop("scalars")["q"].ravel()}
        return FlowField.from_triangles(
            points, Delaunay(points).simplices, flow, times=parts["times"], scalars=warmth
        )
    if kind in ("globe", "robinson"):
        return FlowField.from_xarray(on_earth(parts), projection=kind)
    if kind != "store":
        return FlowField.from_arrays(**parts)
    pytest.importorskip("zarr")
    flowtex.pyramid.build(FlowField.from_arrays(**parts), place / "flow.zarr", progress=False)
    return flowtex.pyramid.open(place / "flow.zarr")


def on_earth(parts: dict[str, Any]) -> Any:
    """Return a dataset of steps whose x and y are longitude and latitude."""
    dims = ("time", "lat", "lon")
    data = xr.Dataset(
        {"u": (dims, parts["velocity"][..., 0]), "v": (dims, parts["velocity"][..., 1])},
        {
            "lon": ("lon", parts["points"][0, :, 0], DEGREES["lon"]),
            "lat": ("lat", parts["points"][:, 0, 1], DEGREES["lat"]),
            "time": ("time", parts["times"], {"units": "s"}),
        },
    )
    for key, way in (("u", "eastward"), ("v", "northward")):
        data[key].attrs = {"standard_name": f"{way}_wind", "units": "m s-1"}
    data["q"] = dims[1:], parts["scalars"]["q"]
    return data


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize(
    "kind", ["grid", "leaves the surface", "triangles", "globe", "robinson", "store"]
)
def test_speed_is_linear_between_steps_by_every_route(kind: str, tmp_path: Path) -> None:
    field = turning(kind, tmp_path)
    place: tuple[float, ...] = (2.3, 1.6)
    if kind == "leaves the surface":
        place = (*place, 0.0)
    for time in (0.0, 1 / 3, 0.75):
        got = field.at(*place, time=time)
        assert got is not None
        speed = 5 * (1 + time)
        assert got.speed == pytest.approx(speed, rel=1e-3)
        assert_by_scene(field, place, time, probed=kind != "store")
        scene = Scene.of(field)
        scene.time = time
        np.testing.assert_allclose(scene.scalar("speed")[field.valid], speed, rtol=2e-3)
    if kind != "globe":  # which lies on axes as the map of their projection
        spots, limits = np.array([place[:2]]), (4.0, 11.0)
        assert_in_picture(field, spots, np.array([speed]), None, limits, time, "speed")


@property_test(8, fuzz=60)
@given(seed=st.integers(0, 2**32 - 1))
def test_derived_quantities_are_finite_differences(seed: int) -> None:
    rng = np.random.default_rng(seed)
    lon = np.arange(-180.0, 180.0, 4.0)
    lat = np.linspace(-88.0, 88.0, 45)
    grid = np.meshgrid(lon, lat)
    data = on_lines(rng).isel(time=0)
    fields = [waves(rng, np.abs(grid[0]), grid[1], 1)[0] for _ in range(2)]
    data = xr.Dataset(
        {key: (("lat", "lon"), part) for key, part in zip("uv", fields, strict=True)},
        {"lon": ("lon", lon, DEGREES["lon"]), "lat": ("lat", lat, DEGREES["lat"])},
    )
    for key, way in (("u", "eastward"), ("v", "northward")):
        data[key].attrs = {"standard_name": f"{way}_wind", "units": "m s-1"}
    cos = np.cos(np.radians(data["lat"]))
    degree = np.radians(EARTH_RADIUS)
    by_lon = {key: data[key].differentiate("lon") / (degree * cos) for key in "uv"}
    turned = (data["u"] * cos).differentiate("lat") / (degree * cos)
    spread = (data["v"] * cos).differentiate("lat") / (degree * cos)
    exact = {"vorticity": by_lon["v"] - turned, "divergence": by_lon["u"] + spread}
    name = MAPS[int(rng.integers(len(MAPS)))]
    field = FlowField.from_xarray(data, projection=name)
    for key, values in exact.items():
        derived = field.with_derived(key)
        size = float(np.abs(values.sel(lat=slice(-75, 75))).max())
        for _ in range(2 * POINTS):
            j, i = int(rng.integers(5, 40)), int(rng.integers(2, 88))
            if abs(abs(lon[i]) - 180) < 9 or abs(lon[i]) < 9:
                continue  # the waves have a crease there
            got = derived.at(lon[i], lat[j])
            if got is None or not np.isfinite(got.scalars[key]):
                continue
            assert got.scalars[key] == pytest.approx(float(values[j, i]), abs=0.08 * size)
    count_case(KIND)


@property_test(8, fuzz=60)
@given(seed=st.integers(0, 2**32 - 1))
def test_triangles_and_sections_have_one_number(seed: int) -> None:
    rng = np.random.default_rng(seed)
    steps = int(rng.choice([1, 3]))
    times: Any = 2.0 * np.arange(steps)
    p = rng.uniform(0, 40, (int(rng.integers(30, 120)), 2))
    triangles = Delaunay(p)
    parts = [waves(rng, p[:, 0], p[:, 1], steps) for _ in range(3)]
    field: Any = FlowField.from_triangles(
        p,
        triangles.simplices,
        np.stack(parts[:2], axis=-1),
        times=times,
        scalars={"q": parts[2]},
    )
    time = moment(rng, times)
    before = min(int(time // 2), max(steps - 2, 0))
    share = (time - times[before]) / 2
    inside = p[triangles.simplices].mean(axis=1)
    for place in inside[rng.integers(len(inside), size=POINTS)] + rng.uniform(-0.1, 0.1, 2):
        got = field.at(*place.tolist(), time=time)
        if got is None or triangles.find_simplex(place) < 0:
            continue
        of_steps = []
        for step in (before, min(before + 1, steps - 1)):
            made = [LinearNDInterpolator(triangles, part[step]) for part in parts]
            u, v, q = (float(each(place)[0]) for each in made)
            of_steps.append([u, v, np.hypot(u, v), q])
        read = [*got.velocity[:2], got.speed, got.scalars["q"]]
        exact = np.average(of_steps, axis=0, weights=[1 - share, share])
        assert read == pytest.approx(exact.tolist(), abs=1e-6)
        assert_by_scene(field, tuple(place.tolist()), time, probed=rng.uniform() < PROBED)
    assert_section(rng, steps)
    count_case(KIND)


def assert_section(rng: np.random.Generator, steps: int) -> None:
    """Compare points of a vertical section with xarray."""
    lat = line(rng, -60, 60, 20, even=False)
    depth = np.sort(rng.uniform(0, 1000, 12))
    dims, shape = ("time", "depth", "lat"), np.meshgrid(lat, depth)
    parts = [waves(rng, *shape, steps) for _ in range(3)]
    kinds = ("northward_sea_water_velocity", "upward_sea_water_velocity")
    data = xr.Dataset(
        {
            "v": (dims, parts[0], {"units": "m/s", "standard_name": kinds[0]}),
            "w": (dims, 1e-4 * parts[1], {"units": "m/s", "standard_name": kinds[1]}),
            "q": (dims, parts[2]),
        },
        {
            "lat": ("lat", lat, {"units": "degrees_north"}),
            "depth": ("depth", depth, {"units": "m", "positive": "down"}),
            "time": ("time", 2.0 * np.arange(steps), {"units": "s"}),
        },
    )
    field = FlowField.from_xarray(data, vectors="v,w")
    for _ in range(POINTS):
        place = between(rng, lat), between(rng, depth)
        time = moment(rng, data["time"].values)
        exact = data.interp(lat=place[0], depth=place[1])
        if steps > 1:
            exact = exact.interp(time=time)
        got = field.at(*place, time=time)
        assert got is not None
        wanted = {key: float(exact[key].squeeze()) for key in "vwq"}
        assert {key: got.scalars[key] for key in wanted} == pytest.approx(wanted, abs=1e-6)


@property_test(2, fuzz=20)
@given(seed=st.integers(0, 2**32 - 1))
def test_stores_have_the_numbers_of_their_data(
    tmp_path_factory: pytest.TempPathFactory, seed: int
) -> None:
    pytest.importorskip("zarr")
    rng = np.random.default_rng(seed)
    data = on_lines(rng)
    name = MAPS[int(rng.integers(len(MAPS)))]
    field = FlowField.from_xarray(data, projection=name)
    place: Path = tmp_path_factory.mktemp("store") / "flow.zarr"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 60)
        flowtex.pyramid.build(field, place, progress=False)
        store = flowtex.pyramid.open(place)
    size = float(np.abs(data["u"]).max() + np.abs(data["v"]).max())
    for _ in range(2 * POINTS):
        lon, lat = between(rng, data["lon"].values), between(rng, data["lat"].values)
        time = moment(rng, data["time"].values)
        wanted, got = field.at(lon, lat, time=time), store.at(lon, lat, time=time)
        assert (wanted is None) == (got is None)
        if wanted is not None:
            assert numbers(got) == pytest.approx(numbers(wanted), rel=2e-3, abs=2e-3 * size)
    count_case(KIND)
