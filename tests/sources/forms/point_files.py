"""Points that are no grid: scattered ones, and drifters."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
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
