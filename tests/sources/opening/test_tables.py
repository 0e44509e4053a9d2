"""Tables, GeoJSON, CSV and vectors of particle image velocimetry as fields."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from earth_data import on_sphere
from scipy.spatial import cKDTree

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.field.earth.projection import EARTH_RADIUS
from flowtex.sources.opening.tables import of_table

pytestmark = pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")

FORMS = Path(os.environ.get("FLOWTEX_DATA", "")) / "forms"
needs_data = pytest.mark.skipif(
    not FORMS.is_dir(), reason="FLOWTEX_DATA names no folder of real data"
)


def plane(x: Any, y: Any) -> tuple[Any, Any]:
    return 1 + 0.5 * np.sin(3 * x), 0.7 * np.cos(2 * y) + 0.2 * x


def rows(x: Any, y: Any) -> pd.DataFrame:
    u, v = plane(x, y)
    return pd.DataFrame({"x": x, "y": y, "u": u, "v": v})


def lattice() -> pd.DataFrame:
    x, y = np.meshgrid(np.linspace(0, 3, 40), np.linspace(0, 1, 21))
    return rows(x.ravel(), y.ravel())


def scattered(count: int = 500) -> pd.DataFrame:
    return rows(*np.random.default_rng(0).uniform(0, 1, (2, count)))


def check(field: FlowField) -> None:
    expected = np.stack(plane(field.points[..., 0], field.points[..., 1]), axis=-1)
    for step in range(len(field.times)):
        drawn = np.asarray(field.velocity[step])[..., :2]
        assert np.allclose(drawn[field.valid], expected[field.valid])


def test_rows_of_grid_with_missing_row() -> None:
    frame = lattice().sample(frac=1, random_state=1).drop(index=100)
    field = FlowField.from_xarray(frame)
    check(field)
    assert field.shape == (21, 40) and field.triangles is None
    assert np.argwhere(~field.valid).tolist() == [[100 // 40, 100 % 40]]


def test_scattered_rows_are_points() -> None:
    field = FlowField.from_xarray(scattered())
    check(field)
    assert field.shape == (1, 500) and field.triangles is not None


@pytest.mark.parametrize("table", [lattice(), scattered()], ids=["grid", "points"])
def test_times_are_a_series(table: pd.DataFrame) -> None:
    dates = ["2024-01-01T00Z", "2024-01-01T06Z", "2024-01-02T00Z"]
    frame = pd.concat([table.assign(time=date) for date in dates]).sample(frac=1, random_state=2)
    field = FlowField.from_xarray(frame)
    check(field)
    assert field.times.tolist() == [0, 21600, 86400]
    assert str(field.start).startswith("2024-01-01")


def test_index_and_units_of_columns() -> None:
    frame = lattice().rename(columns={"x": "x [mm]", "u": "u (cm/s)"}).set_index(["y", "x [mm]"])
    ds = of_table(frame)
    assert ds["x"].attrs["units"] == "mm" and ds["u"].attrs["units"] == "cm/s"
    assert dict(ds.sizes) == {"y": 21, "x": 40}


def test_repeated_rows_raise() -> None:
    frame = scattered()
    with pytest.raises(FieldError, match=r"2 rows repeat a position, such as {'x': 0\.\d+, 'y'"):
        FlowField.from_xarray(pd.concat([frame, frame.iloc[[5]]]))


def test_trajectories_raise() -> None:
    frame = scattered().assign(time=pd.date_range("2024", periods=500))
    with pytest.raises(FieldError, match="own time and position: a trajectory"):
        FlowField.from_xarray(frame)


def test_moving_points_raise() -> None:
    parts = [
        scattered(100 + k).assign(time=t, x=lambda f, k=k: f.x + k) for k, t in enumerate(range(4))
    ]
    shared = [part.assign(time=9) for part in (scattered(50).assign(x=0.5 + np.arange(50)),)]
    frame = pd.concat([*parts, *shared, shared[0].assign(time=8)])
    with pytest.raises(FieldError, match="positions differ along time: points that move"):
        FlowField.from_xarray(frame)


def test_table_without_positions_raises() -> None:
    with pytest.raises(FieldError, match="the columns a, u, v; expected lon and lat, or x and y"):
        FlowField.from_xarray(scattered().drop(columns="y").rename(columns={"x": "a"}))


def test_polars() -> None:
    polars = pytest.importorskip("polars")
    check(FlowField.from_xarray(polars.DataFrame(scattered().to_dict("list"))))


@pytest.mark.parametrize("separator", [",", ";", "\t", "  "])
def test_csv(tmp_path: Path, separator: str) -> None:
    path = tmp_path / "flow.csv"
    lines = [separator.join(map(repr, row)) for row in lattice().to_numpy().tolist()]
    path.write_text("\n".join(["# made", separator.join("xyuv"), *lines]), encoding="utf-8")
    field = FlowField.from_file(path)
    check(field)
    assert field.shape == (21, 40)


@pytest.mark.parametrize("separator", [",", ";", "\t", " "])
@pytest.mark.parametrize("cut", [3, 12, 20, 25])
def test_csv_with_a_cut_row_names_it(tmp_path: Path, separator: str, cut: int) -> None:
    path = tmp_path / "flow.csv"
    lattice().to_csv(path, index=False, sep=separator, float_format="%.6f")
    text = path.read_text()
    last = text.rstrip("\n").rindex("\n") + 1
    path.write_text(text[: last + cut])
    with pytest.raises(FieldError, match=r"line 841 has .*write or copy it again, or remove"):
        FlowField.from_file(path)


def test_csv_with_a_short_row_within_names_it(tmp_path: Path) -> None:
    path = tmp_path / "flow.csv"
    lattice().to_csv(path, index=False)
    lines = path.read_text().splitlines()
    lines[99] = lines[99].rpartition(",")[0]
    path.write_text("\n".join(["# a comment, which has, many, values", "", *lines, ""]))
    with pytest.raises(FieldError, match="line 102 has 3 of 4 values"):
        FlowField.from_file(path)


def test_csv_with_a_cut_number_names_it(tmp_path: Path) -> None:
    path = tmp_path / "flow.csv"
    lattice().to_csv(path, index=False)
    lines = path.read_text().splitlines()
    lines[-1] = lines[-1].rpartition(",")[0] + ",-"
    path.write_text("\n".join(lines))
    with pytest.raises(FieldError, match="the last row has '-' in the column 'v' of numbers"):
        FlowField.from_file(path)


def test_csv_with_missing_values_and_texts_is_read(tmp_path: Path) -> None:
    path = tmp_path / "flow.csv"
    frame = lattice().assign(station=[f"A{n}" for n in range(840)])
    frame.loc[[5, 839], "u"] = np.nan
    path.write_text(frame.to_csv(index=False).rstrip("\n"))
    field = FlowField.from_file(path)
    assert (~field.valid).sum() == 2


def test_few_columns_without_header_raise(tmp_path: Path) -> None:
    path = tmp_path / "flow.csv"
    path.write_text("0,1,2\n4,5,6\n", encoding="utf-8")
    expected = r"flow.csv: its first line is '0,1,2'; expected names .* such as lon,lat,u,v"
    with pytest.raises(FieldError, match=expected):
        FlowField.from_file(path)


def test_geojson(tmp_path: Path) -> None:
    path = tmp_path / "flow.geojson"
    features: list[Any] = [
        {
            "type": "Feature",
            "geometry": {"type": "Point", "coordinates": [10 + row.x, 40 + row.y]},
            "properties": {"u": row.u, "v": row.v, "name": "a"},
        }
        for row in scattered().itertuples()
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    field = FlowField.from_file(path, globe=True)
    assert field.shape == (1, 500)
    assert np.allclose(field.speed[0][0], np.hypot(scattered().u, scattered().v))
    features[3]["geometry"]["type"] = "Polygon"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    with pytest.raises(FieldError, match="geometry 'Polygon'; expected points"):
        FlowField.from_file(path)


@needs_data
def test_swath_of_satellite() -> None:
    field = FlowField.from_file(FORMS / "ascat.geojson", globe=True)
    data = json.loads((FORMS / "ascat.geojson").read_text())["features"]
    lon, lat = np.array([f["geometry"]["coordinates"] for f in data]).T
    speed = np.array([np.hypot(f["properties"]["u"], f["properties"]["v"]) for f in data])
    tree = cKDTree(EARTH_RADIUS * on_sphere(lon, lat))
    distance, at = map(np.asarray, tree.query(field.points[0]))
    assert distance.max() < 10 and len(at) > 4880
    assert np.allclose(np.linalg.norm(field.velocity[0][0], axis=-1), speed[at])
    assert field.triangles is not None
    edges = np.diff(field.points[0][field.triangles], axis=1)
    assert np.linalg.norm(edges, axis=-1).max() < 250e3  # none from one swath to another


@needs_data
def test_flags_of_vec_are_blank() -> None:
    field = FlowField.from_file(FORMS / "piv.vec")
    table = np.loadtxt(FORMS / "piv.vec", delimiter=",", skiprows=1)
    order = np.lexsort((table[:, 0], table[:, 1]))
    assert field.shape == (63, 63)
    assert (field.valid.ravel() == (table[order, 4] > 0)).all()
    drawn, valid = np.asarray(field.velocity[0]).reshape(-1, 3), field.valid.ravel()
    assert (field.length_unit, field.time_unit) == ("mm", "s")
    assert np.allclose(drawn[valid, :2], 1e3 * table[order][valid, 2:4])  # from m/s


def test_columns_of_several_levels_are_positions_units_or_names() -> None:
    """As of pivot with times in the columns, and of read_csv with two rows of header."""
    x, y = map(np.ravel, np.meshgrid(np.arange(5.0), np.arange(4.0)))
    u, v = plane(x, y)
    steps = [pd.DataFrame({"time": t, "x": x, "y": y, "u": (1 + t) * u, "v": v}) for t in (0, 1)]
    wide = pd.concat(steps).pivot(index=["y", "x"], columns="time", values=["u", "v"])
    found = of_table(wide)
    assert dict(found.sizes) == {"time": 2, "y": 4, "x": 5}
    assert np.allclose(found.u[1], 2 * found.u[0])
    assert np.allclose(found.v[0].values.ravel(), v)
    columns = {("x", "mm"): x, ("y", "mm"): y, ("u", "m/s"): u, ("v", "m/s"): v}
    assert of_table(pd.DataFrame(columns)).u.attrs["units"] == "m/s"
    blank = [("x", "Unnamed: 0_level_1"), ("y", "Unnamed: 1_level_1")]
    names = pd.MultiIndex.from_tuples([*blank, ("wind", "u"), ("wind", "v")])
    found = of_table(pd.DataFrame(np.column_stack([x, y, u, v]), columns=names))
    assert np.allclose(found.wind_u.values.ravel(), u)


def test_a_table_of_one_component_names_the_remedy() -> None:
    component = pd.DataFrame(np.ones((3, 4)), columns=pd.Index([0.0, 0.1, 0.2, 0.3], name="x"))
    with pytest.raises(FieldError, match=r"positions, 0.0 to 0.3.*flowtex.show\(u, v\)"):
        of_table(component)


def test_points_of_the_compass_are_directions_in_degrees() -> None:
    x, y = map(np.ravel, np.meshgrid(np.arange(8.0), np.arange(4.0)))
    points = np.tile(["N", "ne", "E", "SSE", "S", "WSW", "W", "NNW"], 4).astype(object)
    table = pd.DataFrame({"lon": x, "lat": y, "wind_speed": 2.0, "wind_dir": points})
    field = FlowField.from_xarray(table)
    angles = np.radians([0, 45, 90, 157.5, 180, 247.5, 270, 337.5])
    assert field.projection is not None
    lon, lat = field.projection.lonlat(field.points[0])
    east, north = field.projection.components(lon, lat, field.velocity[0][0])
    assert np.allclose(east, -2 * np.sin(angles))
    assert np.allclose(north, -2 * np.cos(angles))
    table.loc[5, "wind_dir"] = "VRB"
    with pytest.raises(FieldError, match=r"column 'wind_dir' .* has the text 'VRB' in row 6"):
        of_table(table)
