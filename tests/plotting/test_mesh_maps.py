"""Pictures of data on meshes of models: on the globe and on maps, with coasts and land."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from earth_data import winds
from mesh_data import globe, ugrid

import flowtex
from flowtex import FlowField
from flowtex.field.earth import EARTH_RADIUS
from flowtex.rendering.map_overlay import globe_radius, land_cells, map_lines

pytestmark = [
    pytest.mark.usefixtures("opengl"),
    pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice"),
]


@pytest.mark.parametrize("view", [{"globe": True}, {"projection": "robinson"}])
def test_a_mesh_has_the_colours_of_the_same_flow_on_a_grid(view: dict[str, Any]) -> None:
    options: dict[str, Any] = {"size": (240, 200), "lighting": False, "clim": (0.0, 10.0)}
    options |= {"cmap": "gray", "coastlines": False, "graticule": False, "show_scalar_bar": False}
    mesh, grid = (
        flowtex.render(ds, **view, **options).astype(float)
        for ds in (
            ugrid(globe(3000), at="node")[0],
            winds(np.arange(-180.0, 180.0, 4.0), np.arange(-90.0, 90.1, 4.0)),
        )
    )
    # Patterns differ, and their means over some pixels are the speed.
    coarse = [p[:200, :240].reshape(10, 20, 12, 20, 3).mean(axis=(1, 3)) for p in (mesh, grid)]
    assert np.abs(coarse[0] - coarse[1]).mean() < 12
    assert coarse[0].std() > 20


def test_lines_and_land_of_a_part_of_the_earth() -> None:
    (ds,) = ugrid(globe(2000))
    lat = globe(2000).middles[1]
    part = ds.isel(nFace=np.flatnonzero(np.abs(lat) < 50))
    field = FlowField.from_xarray(part, globe=True)
    radius = globe_radius(field)
    assert radius is not None and 0.98 * EARTH_RADIUS < radius < EARTH_RADIUS
    assert not land_cells(field).any()
    assert all(len(lines.points) for lines in map_lines(field, has_globe=False).values())
    assert globe_radius(FlowField.from_xarray(ds, globe=True)) is None
    dry = part.assign(ucx=part.ucx.where(np.abs(lat[np.abs(lat) < 50]) < 20))
    assert 0.3 < land_cells(FlowField.from_xarray(dry, globe=True)).mean() < 0.7
