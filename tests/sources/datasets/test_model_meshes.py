"""Data on the meshes of models: the turning Earth, known exactly, as each convention has it."""

from __future__ import annotations

import os
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from earth_data import RATE, on_sphere, turning
from mesh_data import CONVENTIONS, Globe, fvcom, globe, icon, mpas, ugrid
from scipy.spatial import ConvexHull, cKDTree

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.earth.projection import EARTH_RADIUS
from flowtex.field.options import FieldOptions
from flowtex.field.steps import LazySteps
from flowtex.field.triangles.triangle_surface import TriangleSurface
from flowtex.sources.datasets.flow import read_flow
from flowtex.sources.notices import DatasetNotice, Record
from flowtex.sources.open_source import DatasetSource

pytestmark = pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")


def faults(field: FlowField) -> Floats:
    """How far the velocity on a globe is from the rotation, (N,), in m/s."""
    p = field.points[0] / EARTH_RADIUS
    return np.asarray(np.linalg.norm(np.asarray(field.velocity[0])[0] - turning(p), axis=-1))


@pytest.mark.parametrize("name", CONVENTIONS)
def test_the_turning_earth_is_what_every_convention_has(name: str) -> None:
    build, exact = CONVENTIONS[name]
    mesh = globe()
    field = FlowField.from_xarray(build(mesh), globe=True)
    assert field.shape == (1, 600) and field.triangles is not None and field.valid.all()
    assert len(field.triangles) == len(mesh.triangles) == 2 * 600 - 4
    assert field.length_unit == "m" and field.surface.on_globe
    assert faults(field).max() < (1e-6 if exact else 0.04) * RATE
    # The surface is closed: each triangle has three others beside it.
    assert isinstance(field.surface, TriangleSurface)
    assert (field.surface.neighbours >= 0).all()
    like = FlowField.from_xarray(ugrid(mesh, at="node" if exact else "face"), globe=True)
    _, at = cKDTree(field.points[0]).query(like.points[0])
    assert np.allclose(field.points[0, at], like.points[0], atol=10.0)  # bounds are rounded
    assert np.allclose(field.velocity[0][0, at], like.velocity[0][0], atol=1e-3)


def test_levels_and_times_have_names_and_are_read_late() -> None:
    mesh = globe(200)
    (ds,) = fvcom(mesh)
    field = FlowField.from_xarray(ds, globe=True)
    assert isinstance(field.velocity, LazySteps) and len(field.times) == 2
    assert str(field.start).startswith("2024-01-01") and field.times[1] == 86400
    assert np.allclose(field.velocity[1], 2 * field.velocity[0])
    assert np.allclose(field.scalars["zeta"][1], 2)
    deep = FlowField.from_xarray(ds, level=-0.5, time="2024-01-02", globe=True)
    assert deep.steady and np.allclose(deep.velocity[0], 2 * 0.6 * field.velocity[0])
    assert np.allclose(deep.scalars["zeta"][0], 2), "it has no levels"
    with pytest.warns(DatasetNotice, match="siglay is -0.1, the nearest to the surface of 3"):
        FlowField.from_xarray(ds, globe=True)
    mean = FlowField.from_xarray(ds, "ua", "va", globe=True)
    assert np.allclose(mean.velocity[0], field.velocity[0])
    assert set(field.scalars) == {"ua", "va", "zeta"}


def test_the_levels_of_icon_count_down_and_its_dates_are_numbers() -> None:
    field = FlowField.from_xarray(icon(globe(200)), globe=True)
    assert str(field.start).startswith("2024-01-01 12:00") or "12:00" in str(field.start)
    (ds,) = mpas(globe(200))
    known = read_flow(ds, FieldOptions(), Record())
    assert known.pair.u.name == "uReconstructZonal" and "2024-01-01T06" in str(known.drawn.times)


def test_scalars_at_nodes_and_in_faces() -> None:
    mesh = globe(800)
    field = FlowField.from_xarray(ugrid(mesh), globe=True)
    lat = np.degrees(np.arcsin(field.points[0, :, 2] / EARTH_RADIUS))
    assert np.allclose(field.scalars["height"][0, 0], lat)
    assert field.on_cells == ("twice",)
    assert np.array_equal(field.scalars["twice"][0, 0], 2 * mesh.middles[1])
    assert field.units == {"height": "m", "twice": "m"} and set(field.scalars) == set(field.units)


@pytest.mark.parametrize("projection", ["platecarree", "robinson", "north"])
def test_parts_of_a_face_on_a_map_have_its_value(projection: str) -> None:
    mesh = globe(800)
    field = FlowField.from_xarray(ugrid(mesh), projection=projection)
    assert field.projection is not None and field.triangles is not None
    values = field.scalars["twice"][0, 0]
    assert len(values) == len(field.triangles)
    middle = field.points[0][field.triangles].mean(axis=1)
    point = on_sphere(*field.projection.lonlat(middle))
    # A face of which it is a part is nearer than its longest side.
    faces = on_sphere(mesh.lon, mesh.lat)[mesh.triangles]
    far = np.linalg.norm(point[:, None] - faces.mean(axis=1), axis=-1)
    owner = np.abs(values[:, None] - 2 * mesh.middles[1]).argmin(axis=1)
    assert np.array_equal(values, 2 * mesh.middles[1][owner])
    sides = np.linalg.norm(faces - np.roll(faces, 1, axis=1), axis=-1).max(axis=1)
    assert (far[np.arange(len(values)), owner] < sides[owner]).all()


@pytest.mark.parametrize(
    "projection",
    [None, "robinson", "mercator", "north", "EPSG:3413", "+proj=igh", "+proj=moll +lon_0=150"],
)
def test_a_global_mesh_on_flat_maps(projection: str | None) -> None:
    mesh = globe(2000)
    field = FlowField.from_xarray(ugrid(mesh, at="node"), projection=projection)
    assert field.projection is not None and field.triangles is not None
    if projection is None:
        assert field.projection.name == "platecarree"
    corners = field.points[0][field.triangles]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1)
    assert sides.max() < 0.25 * np.ptp(field.points[0], axis=0).max()
    assert np.median(sides) < 0.03 * np.ptp(field.points[0], axis=0).max()
    lon, lat = field.projection.lonlat(field.points)
    east, north = field.projection.components(lon, lat, field.velocity[0])
    inside = np.abs(lat) < 80
    speed = np.linalg.norm(turning(on_sphere(lon, lat)), axis=-1)
    # Triangles are cut at the edge of the map, where values lie between those of nodes.
    assert np.allclose(np.hypot(east, north)[inside], speed[inside], atol=0.02 * RATE)
    assert np.median(np.abs(np.hypot(east, north) - speed)[inside]) < 1e-3
    assert np.allclose(field.scalars["speed"][0], np.hypot(east, north), atol=0.02 * RATE)
    assert np.abs(lon).max() <= 180.0
    if projection is None:
        # Nothing is lost but what is around the poles, and nothing is there twice.
        ends = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(ends, axis=-1).sum() / 2
        whole = 2 * np.pi**2 * EARTH_RADIUS**2
        assert 0.95 * whole < area < whole


def test_a_mesh_of_the_earth_is_drawn_around_greenwich() -> None:
    """Whatever the widest gap is between longitudes of nodes that lie anywhere."""
    rng = np.random.default_rng(5)
    lon, lat = rng.uniform(-180, 180, 400), np.degrees(np.arcsin(rng.uniform(-1, 1, 400)))
    mesh = Globe(lon, lat, ConvexHull(on_sphere(lon, lat)).simplices.astype(np.int64))
    field = FlowField.from_xarray(ugrid(mesh, at="node"))
    assert field.projection is not None and field.projection.center == (0.0, 0.0)


def test_what_a_map_tears_apart_is_told() -> None:
    with pytest.warns(DatasetNotice, match="triangles are left out, because the map cuts them"):
        FlowField.from_xarray(ugrid(globe(200)))


def lake(**attrs: str) -> xr.Dataset:
    """Quadrilaterals and triangles in a plane, in kilometres, with a shear along x."""
    x, y = np.meshgrid(np.arange(6.0), np.arange(5.0))
    n = np.arange(30).reshape(5, 6)
    quads = np.stack([n[:-1, :-1], n[:-1, 1:], n[1:, 1:], n[1:, :-1]], axis=-1).reshape(-1, 4)
    split = quads[:5]
    three = np.concatenate([split[:, [0, 1, 2]], split[:, [0, 2, 3]]])
    three = np.concatenate([three, np.full((10, 1), -999)], axis=1)
    corners = np.concatenate([three, quads[5:]])
    real = corners >= 0
    middle = (y.ravel()[np.where(real, corners, 0)] * real).sum(axis=1) / real.sum(axis=1)
    told = {"cf_role": "mesh_topology", "node_coordinates": "mx my", "face_node_connectivity": "fn"}
    return xr.Dataset(
        {
            "m": ((), 0, told),
            "fn": (("f", "k"), corners, {"start_index": 0, "_FillValue": -999}),
            "mx": ("n", x.ravel(), {"units": "km", "standard_name": "projection_x_coordinate"}),
            "my": ("n", y.ravel(), {"units": "km", "standard_name": "projection_y_coordinate"}),
            "u": ("f", middle, {"units": "m/s", "standard_name": "sea_water_x_velocity", **attrs}),
            "v": ("f", 0 * middle, {"units": "m/s", "standard_name": "sea_water_y_velocity"}),
        }
    )


def test_mixed_polygons_in_a_plane_keep_their_components() -> None:
    field = FlowField.from_xarray(lake())
    assert field.projection is None and field.length_unit == "km"
    assert field.shape == (1, 30) and field.triangles is not None and len(field.triangles) == 40
    assert np.ptp(field.points[0], axis=0).tolist() == [5.0, 4.0, 0.0]
    inside = (field.points[0, :, 1] > 1.5) & (field.points[0, :, 1] < 3.5)
    assert np.allclose(field.speed[0, 0, inside], field.points[0, inside, 1])
    assert field.unit_of("speed") == "m/s"
    assert np.allclose(field.velocity[0, 0, :, 1:], 0)


def test_fill_values_and_what_is_dry_are_blanked() -> None:
    ds = lake()
    ds["u"][:] = 1.0
    ds["u"][15:] = np.nan
    field = FlowField.from_xarray(ds)
    assert 0 < field.valid.sum() < 30 and np.allclose(field.speed[0][field.valid], 1)
    (wet,) = fvcom(globe(200))
    cells = np.ones((2, 396), dtype=int)
    cells[:, wet.nv.values[0] == 1] = cells[0, 300:] = 0
    field = FlowField.from_xarray(wet.assign(wet_cells=(("time", "nele"), cells)), globe=True)
    dry = np.isfinite(field.scalars["zeta"][0]) & ~field.valid
    assert field.valid.mean() > 0.9, "what is wet later is there"
    assert np.all(field.velocity[0][dry] == 0)


def test_a_source_offers_levels_and_maps() -> None:
    source = DatasetSource(fvcom(globe(200)))
    assert source.vectors == ("u,v", "ua,va") and source.planes == {"level": 3}
    assert source.default_plane == "level=0" and source.plane_text("level=2") == "-0.9"
    assert source.blocks[:2] == ("platecarree", "globe")
    field = source.field(plane="level=1", block="globe")
    assert field.name == "siglay -0.5" and field.surface.on_globe
    assert source.field(vectors="ua,va", block="globe").name == ""


def test_files_of_a_mesh_and_of_its_values(tmp_path: Path, capsys: Any) -> None:
    from flowtex.cli.commands import main

    mesh = globe(200)
    for kind in ("fesom", "icon", "schism"):
        parts = CONVENTIONS[kind][0](mesh)
        paths = [tmp_path / f"{kind}{n}.nc" for n in range(len(parts))]
        for part, path in zip(parts, paths, strict=True):
            part.to_netcdf(path)
        field = FlowField.from_file(paths, globe=True)
        assert field.shape == (1, 200) and faults(field).max() < 0.06 * RATE
        assert main(["info", *map(str, paths)]) == 0
        assert "200 nodes, 396 triangles" in capsys.readouterr().out


def test_what_is_missing_is_told() -> None:
    _, u, v = CONVENTIONS["fesom"][0](globe(100))
    with pytest.raises(FieldError, match="has no positions"):
        FlowField.from_xarray([u, v])
    (ds,) = ugrid(globe(100))
    with pytest.raises(
        FieldError, match="'Mesh2' names Mesh2_face_nodes, which the data do not contain"
    ):
        FlowField.from_xarray(ds.drop_vars("Mesh2_face_nodes"))
    nodes = xr.zeros_like(ds.height).assign_attrs(ds.ucy.attrs)
    with pytest.raises(FieldError, match="expected both at nodes, or both in faces"):
        FlowField.from_xarray(ds.assign(ucy=nodes), "ucx", "ucy")


@pytest.fixture
def san_francisco() -> Path:
    folder = os.environ.get("FLOWTEX_DATA", "")
    path = Path(folder) / "fvcom_sfbofs.nc"
    if not folder or not path.exists():
        pytest.skip("FLOWTEX_DATA has no fvcom_sfbofs.nc")
    return path


def test_the_tide_at_san_francisco(san_francisco: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DatasetNotice)
        field = FlowField.from_file(san_francisco)
    assert field.shape == (1, 551) and field.triangles is not None and len(field.triangles) == 903
    assert str(field.start) == "2024-05-23 00:00:00" and field.times[-1] == 9 * 3600
    assert field.projection is not None
    lon, lat = field.projection.lonlat(field.points)
    assert -122.6 < lon.min() < lon.max() < -122.4 and 37.8 < lat.min() < lat.max() < 38.0
    most = [float(np.max(step)) for step in field.speed]
    assert 0.3 < min(most) < max(most) < 1.5
    assert "uwind_speed" in field.scalars
