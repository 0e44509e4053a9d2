"""Points that are no grid: scattered ones, and drifters."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from known_flow import Truth, at_points, plane
from supported import Made, supported

KIND = "Points"


def scattered() -> tuple[Any, Truth]:
    """Return a table of points around a hole, and the truth there."""
    x, y = np.random.default_rng(7).uniform(0.0, 4.0, (2, 400))
    outside = np.hypot(x - 2, y - 2) > 0.8
    x, y = x[outside], y[outside]
    u, v = plane(x, y)
    table = pd.DataFrame({"x": x, "y": y, "u": u, "v": v})
    return table, at_points(np.stack([x, y], axis=-1))


@supported(
    KIND,
    "scattered points in a table or in four arrays",
    "flowtex.show(table, max_edge=0.9)",
    "joined by triangles with edges up to `max_edge`, by default not across gaps",
)
def scattered_points(folder: Path) -> Made:
    table, truth = scattered()
    return {"table": table}, truth


@supported(
    KIND,
    "file of scattered points",
    'flowtex.show("points.csv")',
    "columns x, y, u, v, or lon, lat, u, v",
)
def file_of_points(folder: Path) -> Made:
    table, truth = scattered()
    table.to_csv(folder / "points.csv", index=False)
    return {}, truth


TIMES = np.arange(0.0, 4.1, 0.25)
TURN = 0.5  #: Radians per second.


def turning(x: Any, y: Any, t: Any = 0.0) -> tuple[Any, Any]:
    """The velocity of particles that turn around the origin."""
    return -TURN * y, TURN * x


def particles() -> tuple[Any, Any]:
    """Return x and y of the particles at all times, (N, T)."""
    random = np.random.default_rng(11)
    radius = np.sqrt(random.uniform(0.1, 1.0, (90, 1)))
    angle = random.uniform(0, 2 * np.pi, (90, 1)) + TURN * TIMES
    return radius * np.cos(angle), radius * np.sin(angle)


def at_time(number: int, **more: Any) -> Truth:
    x, y = (part[:, number] for part in particles())
    return at_points(np.stack([x, y], axis=-1), flow=turning, **more)


def rows(x: Any, y: Any) -> pd.DataFrame:
    """Return a row for each particle and time."""
    columns = {"id": np.repeat(np.arange(len(x)), len(TIMES)), "time": np.tile(TIMES, len(x))}
    return pd.DataFrame({**columns, "x": x.ravel(), "y": y.ravel()})


@supported(
    KIND,
    "drifters: rows of `id`, `time`, positions and velocity",
    'flowtex.show("drifters.csv", sel={"time": 1.5})',
    "points at one time; without `sel` the time that most have",
)
def drifters_in_rows(folder: Path) -> Made:
    x, y = particles()
    u, v = turning(x, y)
    table = rows(x, y).assign(u=u.ravel(), v=v.ravel())
    table.to_csv(folder / "drifters.csv", index=False)
    return {}, at_time(6)


@supported(
    KIND,
    "drifters without a velocity",
    'flowtex.show(table, sel={"time": 2})',
    "the velocity is the difference of positions in time",
)
def drifters_without_velocity(folder: Path) -> Made:
    x, y = particles()
    return {"table": rows(x, y)}, at_time(8, tolerance=6e-3)


@supported(
    KIND,
    "trajectories of CF, such as the Global Drifter Program, floats and Parcels",
    'flowtex.show(ds, sel={"time": "2024-01-01T00:00:01.5"})',
    "`featureType` or `cf_role`; two axes, or ragged arrays by counts or by an index",
)
def trajectories_of_cf(folder: Path) -> Made:
    x, y = particles()
    u, v = turning(x, y)
    dates = np.datetime64("2024-01-01", "ns") + (TIMES * 1e9).astype("m8[ns]")
    dims = ("trajectory", "obs")
    ds = xr.Dataset(
        {"u": (dims, u, {"units": "m/s"}), "v": (dims, v, {"units": "m/s"})},
        {
            "x": (dims, x, {"units": "m"}),
            "y": (dims, y, {"units": "m"}),
            "time": (dims, np.broadcast_to(dates, x.shape)),
        },
        {"featureType": "trajectory"},
    )
    return {"ds": ds}, at_time(6, times=(1.5 / 3600,), unit="m", speed_unit="m/s")
