"""Trajectories become points with velocities at one time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy.spatial import cKDTree

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.earth.projection import EARTH_RADIUS
from flowtex.sources.notices import DatasetNotice
from flowtex.sources.open_source import open_source

pytestmark = pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")

COUNT = 120
TURN = 0.7  #: Radians per unit of time.
TIMES = np.arange(0.0, 2.05, 0.1)
HOURS = np.arange(0.0, 49.0, 6.0)
DATES = np.datetime64("2024-01-01", "ns") + (HOURS * 3.6e12).astype("m8[ns]")


def rotating() -> tuple[Floats, Floats]:
    """Positions x and y of particles that turn around the origin, (trajectory, time)."""
    random = np.random.default_rng(3)
    radius = np.sqrt(random.uniform(0.05, 1, (COUNT, 1)))
    angle = random.uniform(0, 2 * np.pi, (COUNT, 1)) + TURN * TIMES
    return radius * np.cos(angle), radius * np.sin(angle)


def table(*, velocity: bool) -> pd.DataFrame:
    """Rows of the rotation in any order."""
    x, y = rotating()
    columns = {"id": np.repeat(np.arange(COUNT), len(TIMES)), "time": np.tile(TIMES, COUNT)}
    columns |= {"x": x.ravel(), "y": y.ravel()}
    if velocity:
        columns |= {"u": -TURN * y.ravel(), "v": TURN * x.ravel()}
    return pd.DataFrame(columns).sample(frac=1, random_state=2)


def rotation_error(field: FlowField) -> float:
    """The greatest error of the velocity at all points, as a share of the greatest speed."""
    x, y, _ = field.points[0].T
    expected = TURN * np.stack([-y, x], axis=-1)
    return float(np.abs(field.velocity[0, 0, :, :2] - expected).max() / TURN)


@pytest.mark.parametrize("time", [0.0, 0.7, 1.05, 2.0])
@pytest.mark.parametrize("velocity", [True, False])
def test_rows_of_a_table_at_a_time(time: float, velocity: bool) -> None:
    field = FlowField.from_xarray(table(velocity=velocity), time=time)
    x, y = rotating()
    exact = np.stack([np.interp(time, TIMES, line) for line in (*x, *y)]).reshape(2, -1).T
    distance, number = (np.asarray(n) for n in cKDTree(exact).query(field.points[0, :, :2]))
    assert distance.max() < 1e-9 and len(set(number.tolist())) == COUNT
    # Differences are of second order in the interval, also at the ends.
    assert rotation_error(field) < (2e-15 if velocity else 3e-3)


def drifting() -> tuple[xr.Dataset, Floats, Floats]:
    """Drifters with a constant velocity in degrees, (trajectory, obs), and their motion in m/s."""
    random = np.random.default_rng(4)
    lon, lat = random.uniform(-20, 20, (2, COUNT, 1))
    lon = lon + 179.5
    east, north = random.uniform(-0.02, 0.02, (2, COUNT, 1))
    dims = ("traj", "obs")
    longitude = (lon + east * HOURS + 180) % 360 - 180
    ds = xr.Dataset(
        {"temperature": (dims, 10 + 0 * lon + HOURS), "drogue": (dims, np.ones(longitude.shape))},
        {
            "longitude": (dims, longitude, {"units": "degrees_east"}),
            "latitude": (dims, lat + north * HOURS, {"units": "degrees_north"}),
            "time": (dims, np.broadcast_to(DATES, longitude.shape)),
        },
        {"featureType": "trajectory"},
    )
    return ds, east[:, 0], north[:, 0]


def ragged(ds: xr.Dataset, kind: str) -> xr.Dataset:
    """Return trajectories in another form of CF, or as models of particles write them."""
    if kind == "trajectory and obs":
        return ds
    if kind == "time and trajectory":
        lines = ds.drop_vars("time").rename_dims(obs="time", traj="drifter").transpose()
        return lines.assign_coords(time=DATES).drop_attrs(deep=False)
    if kind == "particles":
        return ds.rename_dims(traj="trajectory").drop_attrs(deep=False)
    rows = ds.stack(row=("traj", "obs"), create_index=False).reset_coords()
    count = ds.sizes["obs"]
    if kind == "contiguous":
        return rows.assign(rowsize=("traj", np.full(COUNT, count), {"sample_dimension": "row"}))
    number = np.repeat(np.arange(COUNT), count)
    if kind == "indexed":
        attrs = {"instance_dimension": "traj"}
        return rows.assign(number=("row", number, attrs)).isel(row=slice(None, None, -1))
    names = np.array([f"buoy {n}" for n in number])
    return rows.assign(wmo=("row", names, {"cf_role": "trajectory_id"}))


@pytest.mark.parametrize(
    "kind",
    ["trajectory and obs", "time and trajectory", "particles", "contiguous", "indexed", "named"],
)
def test_forms_of_trajectories_on_the_earth(kind: str) -> None:
    ds, east, north = drifting()
    field = FlowField.from_xarray(ragged(ds, kind), time="2024-01-01T21:00", globe=True)
    assert field.projection is not None and str(field.start) == "2024-01-01 21:00:00"
    lon, lat = field.projection.lonlat(field.points[0])
    at = (
        (ds.longitude.values[:, 0] + 21 * east + 180) % 360 - 180,
        ds.latitude.values[:, 0] + 21 * north,
    )
    exact = field.projection.positions(*at)
    distance, number = (np.asarray(n) for n in cKDTree(exact).query(field.points[0]))
    assert distance.max() < 1.0 and len(set(number.tolist())) == COUNT
    u, v = field.projection.components(lon, lat, np.asarray(field.velocity[0, 0]))
    per_hour = np.radians(1) * EARTH_RADIUS / 3600
    # The parallel on which a longitude changes is that of the point.
    np.testing.assert_allclose(u, east[number] * per_hour * np.cos(np.radians(lat)), atol=1e-5)
    np.testing.assert_allclose(v, north[number] * per_hour, atol=1e-5)
    np.testing.assert_allclose(field.scalars["temperature"][0], 31.0, atol=1e-6)


def test_without_a_time_the_fullest_one_is_drawn_with_a_notice() -> None:
    rows = table(velocity=True)
    late = rows.id < 40
    rows = rows[~late | (rows.time > 0.55)]
    with pytest.warns(DatasetNotice, match=r"120 of 120 .* time 0\.6, which most have; choose a"):
        field = FlowField.from_xarray(rows)
    assert field.valid.sum() == COUNT
    assert FlowField.from_xarray(rows, isel={"time": 0}).valid.sum() == COUNT - 40


def test_trajectories_with_a_gap_at_the_time_are_left_out() -> None:
    rows = table(velocity=True)
    gap = (rows.id < 10) & (rows.time > 0.45) & (rows.time < 1.55)
    field = FlowField.from_xarray(rows[~gap], time=1.0)
    assert field.valid.sum() == COUNT - 10


def test_longest_edge_between_drifters() -> None:
    most = FlowField.from_xarray(table(velocity=True), time=1.0)
    few = FlowField.from_xarray(table(velocity=True), time=1.0, max_edge=0.2)
    assert few.triangles is not None and most.triangles is not None
    assert len(few.triangles) < len(most.triangles)


@pytest.mark.parametrize(
    ("choice", "text"),
    [
        ({"time": 7.0}, r"time is 7\.0; expected one time from time 0 to time 2"),
        ({"time": "noon"}, r"time is 'noon'; expected one time from time 0"),
        ({"isel": {"time": 30}}, r"time has index 30 of 21; expected 0 to 20"),
    ],
)
def test_times_that_are_not_there(choice: dict[str, Any], text: str) -> None:
    with pytest.raises(FieldError, match=text):
        FlowField.from_xarray(table(velocity=True), **choice)


def test_few_trajectories_are_averaged_in_boxes() -> None:
    rows = table(velocity=True).rename(columns={"x": "lon", "y": "lat"})
    rows[["lon", "lat"]] *= 4
    rows["id"] %= 12
    rows["time"] += rows.index * 1e-6
    with pytest.raises(
        FieldError, match=r"12 of 12 trajectories .*; expected at least 30\. "
    ) as no:
        FlowField.from_xarray(rows)
    advice = 'rows.groupby([df.lat.round(), df.lon.round()])[["u", "v"]].mean()'
    assert advice.replace("rows", "df") in str(no.value)
    boxes = eval(advice, {"rows": rows, "df": rows})
    assert FlowField.from_xarray(boxes).valid.sum() == len(boxes)


def test_stations_with_an_identity_stay_points() -> None:
    x, y = np.random.default_rng(5).uniform(0, 9, (2, 60))
    steps = [
        {"station_id": np.arange(60), "time": t, "x": x, "y": y, "u": t, "v": x} for t in (1, 2)
    ]
    field = FlowField.from_xarray(pd.concat(map(pd.DataFrame, steps)))
    assert field.times.tolist() == [1, 2]
    assert np.all(field.velocity[1, 0, :, 0] == 2)


def test_file_of_drifters_on_the_page(tmp_path: Path) -> None:
    table(velocity=True).to_csv(tmp_path / "drifters.csv", index=False)
    source = open_source(tmp_path / "drifters.csv")
    assert source.vectors == ("u,v",)
    assert source.field().valid.sum() == COUNT
    at_end = FlowField.from_file(tmp_path / "drifters.csv", time=2.0)
    assert rotation_error(at_end) < 1e-8
