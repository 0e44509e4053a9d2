"""Forms that differ in the labels of their axes: order, sign, origin, rounding, files, chunks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from form_table import form, variants
from known_flow import DEGREES, EAST_AT_SEA, NORTH_AT_SEA, earth, on_earth, wind, without

LON, LAT = np.arange(2.0, 38, 2), np.arange(-30.0, 31, 4)
HOURS = np.array([0.0, 6.0, 12.0])
#: Longitudes on both sides of Greenwich, and all of them.
AROUND_ZERO, ALL = np.arange(-18.0, 19, 2), np.arange(0.0, 360, 10)
BACK = slice(None, None, -1)
SERIES, STEADY = on_earth(LON, LAT, HOURS), on_earth(LON, LAT)


def parts(ds: xr.Dataset) -> tuple[xr.Dataset, xr.Dataset]:
    """Return datasets of the first and of the second component."""
    u, v = ds
    return ds[[u]], ds[[v]]


def series() -> xr.Dataset:
    return earth(LON, LAT, HOURS)


def with_lines(ds: xr.Dataset, **lines: Any) -> xr.Dataset:
    """Return a dataset with other values of coordinates, their attributes kept."""
    return ds.assign_coords({k: (k, v, DEGREES.get(k, {})) for k, v in lines.items()})


@variants(["time lat lon", "time lon lat", "lat lon time", "lon time lat"])
def order(dims: str) -> Any:
    return series().transpose(*dims.split()), SERIES


@form()
def v_in_another_order() -> Any:
    ds = series()
    return ds.assign(v=ds.v.transpose("lon", "lat", "time")), SERIES


@variants(["lat", "lon", "time"])
def both_reversed(dim: str) -> Any:
    return series().isel({dim: BACK}), SERIES


@variants(["lat", "lon", "time"], says=r"reverse")
def v_reversed(dim: str) -> Any:
    u, v = parts(series())
    return [u, v.isel({dim: BACK})], SERIES


@form(says="reverse")
def u_reversed_in_all_directions() -> Any:
    u, v = parts(series())
    return [u.isel(lat=BACK, lon=BACK, time=BACK), v], SERIES


@form()
def scalar_reversed() -> Any:
    ds = earth(LON, LAT)
    t = (280 + 0.3 * ds.lat + 0 * ds.lon).rename("T").to_dataset().isel(lat=BACK)
    warm = {"T": lambda lon, lat, hours: 280 + 0.3 * lat}
    return [ds, t], on_earth(LON, LAT, scalars=warm)


@variants(["u", "v", "u v"])
def counted_from_0_to_360(names: str) -> Any:
    """The longitudes of some components are 342, ..., 358, 0, ..., 18."""
    ds = earth(AROUND_ZERO, LAT)
    found = [with_lines(ds[[n]], lon=AROUND_ZERO % 360) for n in "uv" if n in names]
    kept = [ds[[n]] for n in "uv" if n not in names]
    return [*found, *kept] if kept else xr.merge(found), on_earth(AROUND_ZERO, LAT)


@form(says="align")
def v_sorted_from_0_to_360() -> Any:
    """Greenwich is in the middle of u, and v begins there."""
    u, v = parts(earth(AROUND_ZERO, LAT))
    v = with_lines(v, lon=AROUND_ZERO % 360).sortby("lon")
    return [u, v], on_earth(AROUND_ZERO, LAT)


@form(says="align")
def whole_circle_from_minus_180_in_v() -> Any:
    u, v = parts(earth(ALL, LAT))
    return [u, with_lines(v, lon=(ALL + 180) % 360 - 180).sortby("lon")], on_earth(ALL, LAT)


@form()
def whole_circle_with_its_first_column_repeated() -> Any:
    return earth(np.arange(0.0, 361, 10), LAT), on_earth(ALL, LAT)


@form()
def across_180_degrees() -> Any:
    lon = (np.arange(160.0, 201, 2) + 180) % 360 - 180
    return earth(lon, LAT), on_earth(lon, LAT)


@form()
def pacific() -> Any:
    lon = np.arange(120.0, 241, 5)
    return earth(lon, LAT), on_earth(lon, LAT)


@form(options={"projection": "+proj=robin"})
def pacific_on_a_map_around_greenwich() -> Any:
    return pacific()


def any_projection() -> Any:
    """The same nodes and the same flow on any map, of components in opposite directions."""
    u, v = parts(series())
    return [u, v.isel(lat=BACK)], SERIES


for projection in ("globe", "platecarree", "robinson", "mercator", "lambert", "EPSG:3857"):
    form(name=projection.replace(":", "_"), options={"projection": projection})(any_projection)


@form()
def v_with_rounded_places() -> Any:
    """float32 beside float64, of values that neither has exactly."""
    lon, lat = np.arange(20) / 3, 40 + np.arange(15) / 7
    u, v = parts(earth(lon, lat))
    return [u, v.assign_coords(lon=v.lon.astype("f4"), lat=v.lat.astype("f4"))], on_earth(lon, lat)


@form()
def v_with_places_of_four_digits() -> Any:
    lon, lat = np.arange(20) / 3, 40 + np.arange(15) / 7
    u, v = parts(earth(lon, lat))
    return [u, with_lines(v, lon=lon.round(4), lat=lat.round(4))], on_earth(lon, lat)


@form(says="lon")
def v_of_the_next_columns() -> Any:
    u, v = parts(earth(LON, LAT))
    return [u.isel(lon=slice(-3)), v.isel(lon=slice(3, None))], on_earth(LON[3:-3], LAT)


@form(says="lat")
def v_of_a_part_as_large() -> Any:
    """As many rows, of which all but two are the same."""
    u, v = parts(earth(LON, LAT))
    return [u.isel(lat=slice(0, 12)), v.isel(lat=slice(2, 14))], on_earth(LON, LAT[2:12])


@form(error=r"lon|lat")
def v_on_every_second_node() -> Any:
    u, v = parts(earth(LON, LAT))
    return [u, v.isel(lon=slice(0, None, 2), lat=slice(0, None, 2))], on_earth(LON[::2], LAT[::2])


@form(error=r"lon.*2\.6|2\.6.*lon|lon.*0\.6")
def v_a_third_of_a_cell_east() -> Any:
    return [earth(LON, LAT)[["u"]], earth(LON + 0.6, LAT)[["v"]]]


@form(error=r"lat.*-29|-29.*lat")
def v_a_quarter_of_a_cell_north() -> Any:
    return [earth(LON, LAT)[["u"]], earth(LON, LAT + 1)[["v"]]]


@form(error="lon|lat")
def v_elsewhere() -> Any:
    return [earth(LON, LAT)[["u"]], earth(LON + 100, LAT)[["v"]]]


@form(error="lon|coordinate|label|position")
def v_without_coordinates() -> Any:
    u, v = parts(earth(LON, LAT))
    return [u, v.drop_vars(["lon", "lat"])], STEADY


@form(says="sort")
def shuffled_latitudes() -> Any:
    lat = np.random.default_rng(1).permutation(LAT)
    return earth(LON, lat), STEADY


@form(says="align|sort")
def shuffled_longitudes_of_v() -> Any:
    u, v = parts(earth(LON, LAT))
    return [u, v.isel(lon=np.random.default_rng(1).permutation(len(LON)))], STEADY


@form(error="lat")
def latitudes_that_repeat() -> Any:
    lat = LAT.copy()
    lat[5] = lat[4]
    return earth(LON, lat)


@form(error="lon|NaN|missing")
def a_missing_longitude() -> Any:
    lon = LON.copy()
    lon[3] = np.nan
    return with_lines(earth(LON, LAT), lon=lon), on_earth(np.delete(LON, 3), LAT)


@variants(["radian", "radians", "rad"], says="radian")
def places_in(unit: str) -> Any:
    ds = earth(np.arange(-180.0, 180, 12), np.arange(-84.0, 85, 8))
    truth = on_earth(ds.lon.values, ds.lat.values)
    turned = {k: (k, np.radians(ds[k].values), {"units": unit}) for k in ("lon", "lat")}
    return ds.assign_coords(turned), truth


@form()
def names_without_units() -> Any:
    ds = earth(LON, LAT).rename(lon="longitude", lat="latitude")
    for name in ("longitude", "latitude"):
        ds[name].attrs.clear()
    return ds, STEADY


@form()
def two_dimensional_places_of_other_dimension_order() -> Any:
    a, b = np.meshgrid(LON, LAT, indexing="ij")
    ds = earth(LON, LAT, dims=("j", "i")).drop_vars(["i", "j"])
    coords = {"lon": (("i", "j"), a, DEGREES["lon"]), "lat": (("i", "j"), b, DEGREES["lat"])}
    return ds.assign_coords(coords), STEADY


@variants(["count", "one to n", "metres"])
def two_dimensional_places_beside_index_axes(kind: str) -> Any:
    """1-D axes x and y that number the nodes beside 2-D longitude and latitude."""
    lon, lat = curved()
    u, v = wind(lon, lat)
    rows, columns = lon.shape
    line = {"count": (0, 1.0, {}), "one to n": (1, 1.0, {"units": "1"}), "metres": (0, 5e3, {})}
    first, step, attrs = line[kind]
    return xr.Dataset(
        {"uo": (("y", "x"), u, EAST_AT_SEA), "vo": (("y", "x"), v, NORTH_AT_SEA)},
        {
            "x": ("x", first + step * np.arange(columns), attrs),
            "y": ("y", first + step * np.arange(rows), attrs),
            "lon": (("y", "x"), lon, DEGREES["lon"]),
            "lat": (("y", "x"), lat, DEGREES["lat"]),
        },
    ), on_earth(lon, lat)


def curved() -> tuple[Any, Any]:
    """Longitude and latitude of a grid whose rows and columns are turned and bent."""
    j, i = np.mgrid[0:16, 0:21]
    lon = 10 + 0.9 * i - 0.35 * j + 0.004 * i * j
    return lon, 35 + 0.3 * i + 0.8 * j - 0.003 * i * i


@form()
def lines_of_any_spacing() -> Any:
    lon, lat = LON**1.2, 30 * np.sin(np.radians(2 * LAT))
    return earth(lon, lat), on_earth(lon, lat)


@form(says="lon")
def first_column_repeated_in_v_alone() -> Any:
    u, v = earth(ALL, LAT)[["u"]], earth(np.append(ALL, 360.0), LAT)[["v"]]
    return [u, v], on_earth(ALL, LAT)


@form()
def lines_along_dimensions_of_other_names() -> Any:
    """longitude(x) and latitude(y) are no index of their dimensions."""
    ds = earth(LON, LAT).rename_dims(lon="x", lat="y")
    return ds.rename_vars(lon="longitude", lat="latitude"), STEADY


@form()
def places_in_a_dataset_of_their_own() -> Any:
    ds = earth(LON, LAT, dims=("j", "i")).drop_vars(["i", "j"])
    a, b = np.meshgrid(LON, LAT)
    dims = ("j", "i")
    places = {"lon": (dims, a, DEGREES["lon"]), "lat": (dims, b, DEGREES["lat"])}
    return [ds, xr.Dataset(places)], STEADY


@form()
def places_that_are_variables() -> Any:
    ds, truth = two_dimensional_places_beside_index_axes("count")
    return ds.reset_coords(["lon", "lat"]), truth


@variants(["y", "x"], error="lon|lat|position")
def two_dimensional_places_reversed_in_v(dim: str) -> Any:
    ds, truth = two_dimensional_places_beside_index_axes("count")
    u, v = parts(ds.drop_vars(["x", "y"]))
    return [u, v.isel({dim: BACK})], truth


@form()
def two_dimensional_longitudes_from_0_to_360_in_v() -> Any:
    lon, lat = curved()
    u, v = wind(lon - 20, lat)
    dims = ("y", "x")
    places = {"lat": (dims, lat, DEGREES["lat"])}
    counted = {"lon": (dims, (lon - 20) % 360, DEGREES["lon"])}
    return [
        xr.Dataset(
            {"uo": (dims, u, EAST_AT_SEA)}, {**places, "lon": (dims, lon - 20, DEGREES["lon"])}
        ),
        xr.Dataset({"vo": (dims, v, NORTH_AT_SEA)}, {**places, **counted}),
    ], on_earth(lon - 20, lat)


@form(error="lon|lat|position")
def two_dimensional_places_of_v_elsewhere() -> Any:
    ds, _ = two_dimensional_places_beside_index_axes("count")
    u, v = parts(ds.drop_vars(["x", "y"]))
    return [u, v.assign_coords(lon=v.lon + 0.3)]


@form()
def bytes_in_another_order() -> Any:
    """As in NetCDF 3 and files of Fortran."""
    ds = earth(LON, LAT)
    return ds.astype(">f4").assign_coords(lon=ds.lon.astype(">f4")), STEADY


@form()
def holes_of_u_and_v_differ() -> Any:
    ds = earth(LON, LAT)
    ds["u"][2, 3] = ds["v"][5, 4] = np.nan
    return ds, without(STEADY, (np.isnan(ds.u) | np.isnan(ds.v)).values)


# --- files --------------------------------------------------------------------------------------


def written(folder: Path, datasets: list[xr.Dataset], suffix: str = ".nc") -> list[Path]:
    paths = [folder / f"part_{n}{suffix}" for n in range(len(datasets))]
    for ds, path in zip(datasets, paths, strict=True):
        if suffix == ".zarr":
            ds.to_zarr(path, consolidated=False, zarr_format=2)
        else:
            ds.to_netcdf(path)
    return paths


@variants([".nc", ".zarr"])
def a_file(suffix: str, folder: Path) -> Any:
    return written(folder, [series()], suffix)[0], SERIES


@form()
def a_group_of_a_file(folder: Path) -> Any:
    series().to_netcdf(folder / "run.nc", group="ocean")
    return folder / "run.nc" / "ocean", SERIES


@form()
def a_tree() -> Any:
    return xr.DataTree.from_dict({"/ocean": series(), "/notes": xr.Dataset()}), SERIES


@form()
def files_by_variable(folder: Path) -> Any:
    u, v = parts(series())
    return written(folder, [u, v.isel(lat=BACK)]), SERIES


@form()
def files_by_time(folder: Path) -> Any:
    return written(folder, [series().isel(time=[n]) for n in (2, 0, 1)]), SERIES


@form()
def datasets_by_time_with_dates_without_axis() -> Any:
    """Each has a scalar coordinate of time."""
    return [series().isel(time=n) for n in (0, 2, 1)], SERIES


@form()
def files_by_variable_and_time(folder: Path) -> Any:
    u, v = parts(series())
    pieces = [v.isel(time=[0]), u.isel(time=[0, 1]), v.isel(time=[1, 2]), u.isel(time=[2])]
    return written(folder, pieces), SERIES


@form(says="time")
def files_by_time_that_overlap(folder: Path) -> Any:
    ds = earth(LON, LAT, np.arange(0.0, 25, 6))
    truth = on_earth(LON, LAT, np.arange(0.0, 25, 6))
    return written(folder, [ds.isel(time=slice(0, 3)), ds.isel(time=slice(2, 5))]), truth


@form(error="region|lon|overlap|belong|domain|part")
def datasets_by_region() -> Any:
    ds = earth(LON, LAT)
    return [ds.isel(lon=slice(0, 9)), ds.isel(lon=slice(9, None))], STEADY


@form()
def chunks() -> Any:
    return series().chunk(time=1, lat=5), SERIES


@form()
def chunks_of_files(folder: Path) -> Any:
    paths = written(folder, [series().isel(time=[n]) for n in range(3)])
    with xr.open_mfdataset(paths) as ds:
        return ds.load().chunk(time=1), SERIES


@form()
def packed_in_a_file(folder: Path) -> Any:
    """Integers with a scale, an offset and a fill value."""
    lon, lat = np.meshgrid(LON, LAT)
    hole = (lon > 20) & (lat > 10)
    ds = earth(LON, LAT).where(xr.DataArray(~hole, dims=("lat", "lon")))
    packing = {"dtype": "i2", "scale_factor": 0.001, "add_offset": 3.0, "_FillValue": -32767}
    for name, attrs in (("u", "eastward_wind"), ("v", "northward_wind")):
        ds[name].attrs = {"units": "m s-1", "standard_name": attrs}
    ds.to_netcdf(folder / "packed.nc", encoding={"u": packing, "v": packing})
    return folder / "packed.nc", without(on_earth(lon, lat), hole)


@form()
def packed_and_not_decoded() -> Any:
    """As ``xr.open_dataset(..., mask_and_scale=False)`` gives it, reversed in v."""
    ds = earth(LON, LAT)
    for name in "uv":
        attrs = {**ds[name].attrs, "scale_factor": 0.001, "add_offset": 2.0, "_FillValue": -9999}
        number = ((ds[name] - 2.0) / 0.001).round().astype("i2")
        number[2, 3] = -9999
        ds[name] = number.assign_attrs(attrs)
    lon, lat = np.meshgrid(LON, LAT)
    hole = np.zeros(lon.shape, dtype=bool)
    hole[2, 3] = True
    u, v = parts(ds)
    return [u, v.isel(lat=BACK)], without(on_earth(lon, lat), hole)


# --- levels and members -------------------------------------------------------------------------


def levels(values: Any, name: str, **attrs: str) -> xr.Dataset:
    """Return the flow at the first level, and twice as fast at the second."""
    ds = earth(LON, LAT)
    both = xr.concat([ds, 2 * ds], pd.Index(values, name=name))
    both[name].attrs = attrs
    return both.assign({n: both[n].assign_attrs(ds[n].attrs) for n in "uv"})


LEVELS: dict[str, tuple[Any, str, dict[str, str]]] = {
    "pascal without unit": ([100000.0, 50000.0], "plev", {}),
    "hectopascal without unit": ([1000.0, 500.0], "plev", {}),
    "levels of pressure without unit": ([850.0, 200.0], "level", {"standard_name": "air_pressure"}),
    "Pa": ([100000.0, 50000.0], "plev", {"units": "Pa"}),
    "hPa": ([1000.0, 250.0], "lev", {"units": "hPa"}),
    "depth": ([0.5, 100.0], "depth", {"units": "m", "positive": "down"}),
    "depth that is negative": ([-0.5, -100.0], "z", {"units": "m", "positive": "up"}),
    "height": ([10.0, 100.0], "height", {"units": "m", "positive": "up"}),
}


@variants(LEVELS, says="nearest to the surface|surface")
def level_nearest_to_the_surface(kind: str) -> Any:
    values, name, attrs = LEVELS[kind]
    return levels(values, name, **attrs), STEADY


@variants(LEVELS, says="nearest to the surface|surface")
def level_in_falling_order(kind: str) -> Any:
    values, name, attrs = LEVELS[kind]
    return levels(values, name, **attrs).isel({name: BACK}), STEADY


@form(options={"level": 500})
def a_chosen_level() -> Any:
    return levels([1000.0, 500.0], "plev", units="hPa"), on_earth(LON, LAT, scale=2.0)


@form(options={"level": 500})
def a_chosen_level_of_v_in_another_order() -> Any:
    u, v = parts(levels([1000.0, 500.0], "plev", units="hPa"))
    return [u, v.isel(plev=BACK)], on_earth(LON, LAT, scale=2.0)


@form(options={"level": 500})
def v_in_pascal_beside_u_in_hectopascal() -> Any:
    u, _ = parts(levels([1000.0, 500.0], "plev", units="hPa"))
    _, v = parts(levels([100000.0, 50000.0], "plev", units="Pa"))
    return [u, v.isel(plev=BACK)], on_earth(LON, LAT, scale=2.0)


@form(says="plev|level")
def v_of_one_of_the_levels() -> Any:
    u, v = parts(levels([1000.0, 500.0], "plev", units="hPa"))
    return [u, v.isel(plev=[1])], on_earth(LON, LAT, scale=2.0)


@form(error="level|plev")
def v_of_another_level() -> Any:
    u, v = parts(levels([1000.0, 500.0], "plev", units="hPa"))
    return [u.isel(plev=[0]), v.isel(plev=[1])]


@form(error="height")
def v_of_another_height_beside_the_data() -> Any:
    u, v = parts(earth(LON, LAT))
    metres = {"units": "m", "axis": "Z"}
    return [u.assign_coords(height=((), 10.0, metres)), v.assign_coords(height=((), 100.0, metres))]


@form(says="number|member")
def members_of_v_in_another_order() -> Any:
    u, v = parts(levels([0, 1], "number", standard_name="realization"))
    return [u, v.isel(number=BACK)], STEADY


@form(options={"sel": {"number": 1}})
def a_chosen_member() -> Any:
    return levels([0, 1], "number"), on_earth(LON, LAT, scale=2.0)


@form(says="kind")
def an_axis_without_coordinate() -> Any:
    """A further axis of one entry, and one of several of which the first is drawn."""
    ds = levels([0, 1], "kind").drop_vars("kind").expand_dims("surface")
    return ds, STEADY
