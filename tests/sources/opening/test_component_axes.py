"""Arrays with an axis of components."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray as xr

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.sources.notices import DatasetNotice
from flowtex.sources.opening.component_axes import split_components

pytestmark = pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")

A, B, C = np.linspace(0, 4, 16), np.linspace(0, 1, 9), np.linspace(0, 2, 5)


def flow(axes: str, labels: list[str] | None, dim: str = "vdims") -> xr.DataArray:
    """An array over two axes with two components, or one for each label."""
    a, b = np.meshgrid(A, B, indexing="ij")
    parts = [1 + a, 2 - a * b, 3 * b + 9][: len(labels) if labels else 2]
    array = xr.DataArray(
        np.stack(parts), dims=(dim, *axes), coords=dict(zip(axes, (A, B), strict=True))
    )
    return array if labels is None else array.assign_coords({dim: labels})


def check(field: FlowField, one: int, two: int) -> None:
    a, b = np.meshgrid(A, B)
    parts = [1 + a, 2 - a * b, 3 * b + 9]
    assert np.allclose(field.points[..., 0], a) and np.allclose(field.points[..., 1], b)
    assert np.allclose(field.velocity[0][..., 0], parts[one])
    assert np.allclose(field.velocity[0][..., 1], parts[two])


@pytest.mark.parametrize(
    ("axes", "labels", "one", "two"),
    [
        ("xy", ["x", "y"], 0, 1),
        ("xy", ["y", "x"], 1, 0),
        ("xy", ["u", "v"], 0, 1),
        ("xy", ["m_x", "m_y", "m_z"], 0, 1),
        ("xz", ["x", "z"], 0, 1),
        ("xz", ["z", "x"], 1, 0),
        ("xz", ["x", "y", "z"], 0, 2),
        ("yz", ["y", "z"], 0, 1),
        ("yz", ["x", "y", "z"], 1, 2),
        ("xz", None, 0, 1),
        ("xy", None, 0, 1),
    ],
)
@pytest.mark.parametrize("last", [True, False])
def test_labels_pair_with_axes(
    axes: str, labels: list[str] | None, one: int, two: int, *, last: bool
) -> None:
    array = flow(axes, labels)
    check(FlowField.from_xarray(array.transpose(..., "vdims") if last else array), one, two)


def test_labels_of_other_axes_raise() -> None:
    with pytest.raises(FieldError, match="components x, y along 'vdims' on the axes x and z"):
        FlowField.from_xarray(flow("xz", ["x", "y"]))


def test_third_component_is_a_scalar() -> None:
    field = FlowField.from_xarray(flow("xy", ["x", "y", "z"]))
    assert np.allclose(field.scalars["w"][0], 3 * np.meshgrid(A, B)[1] + 9)


def test_volume_has_levels() -> None:
    values = np.ones((16, 9, 5, 3)) * [1.0, 2, 3] * np.arange(1.0, 6)[:, None]
    array = xr.DataArray(values, dims=(*"xyz", "vdims"), coords={"x": A, "y": B, "z": C})
    field = FlowField.from_xarray(array, level=1.0)
    assert np.allclose(field.velocity[0][..., :2], [3, 6])


def test_directions_of_the_earth() -> None:
    lon, lat = np.arange(0.0, 20, 2), np.arange(40.0, 50, 2)
    values = np.stack([np.full((5, 10), 3.0), np.full((5, 10), 4.0)])
    array = xr.DataArray(
        values,
        dims=("direction", "lat", "lon"),
        coords={"direction": ["northward", "eastward"], "lat": lat, "lon": lon},
    )
    field = FlowField.from_xarray(array, globe=True)
    assert np.allclose(np.linalg.norm(field.velocity[0], axis=-1), 5)
    split = split_components(array.to_dataset(name="wind"))
    assert np.allclose(split["wind_eastward"], 4) and np.allclose(split["wind_northward"], 3)


def test_bounds_are_not_components() -> None:
    ds = xr.Dataset({"lat_bnds": (("lat", "two"), np.zeros((5, 2)))})
    assert set(split_components(ds)) == {"lat_bnds"}


def test_scalar_raises() -> None:
    with pytest.raises(FieldError, match=r"DataArray 'p' .*'x': 16, 'z': 9.* of one scalar"):
        FlowField.from_xarray(flow("xz", ["x", "z"])[0].drop_vars("vdims").rename("p"))


def test_arrays_of_components_are_a_pair() -> None:
    ds = flow("xy", ["u", "v"]).to_dataset("vdims")
    check(FlowField.from_xarray([ds["u"], ds["v"]]), 0, 1)


# --- one array, by labels, names and sizes --------------------------------------------------------

LINES = {"x": np.linspace(-1, 1, 8), "y": np.linspace(-2, 2, 11)}
ACROSS, UPWARD = np.meshgrid(LINES["x"], LINES["y"])
#: A flow that tells its place and its components apart at every node.
PARTS = np.stack([1 - UPWARD + 0.3 * ACROSS, 2 * ACROSS + 0.1 * UPWARD, 0 * ACROSS])


def check_analytic(field: FlowField) -> None:
    x, y, _ = np.moveaxis(field.points, -1, 0)
    expected = np.stack([1 - y + 0.3 * x, 2 * x + 0.1 * y], axis=-1)
    np.testing.assert_allclose(field.velocity[0][..., :2], expected, atol=1e-12)


@pytest.mark.parametrize(
    "labels",
    ["x y", "u v", "U V", "E N", "east north", "vx vy", "Bx By", "u_x u_y", "x y z", "E N U"],
)
def test_labels_of_an_axis_of_any_name_are_components(labels: str) -> None:
    names = labels.split()
    order = np.arange(len(names))[::-1]
    values = PARTS[: len(names)][order]
    coordinates = {**LINES, "which": [names[number] for number in order]}
    array = xr.DataArray(values, coordinates, ("which", "y", "x"), name="flow")
    check_analytic(FlowField.from_xarray(array))
    check_analytic(FlowField.from_xarray(array.transpose("y", "which", "x")))


@pytest.mark.parametrize("labels", [None, [0, 1], ["first", "second"]])
def test_the_size_of_an_axis_tells_its_components(labels: list[Any] | None) -> None:
    coordinates = LINES if labels is None else {**LINES, "which": labels}
    array = xr.DataArray(PARTS[:2], coordinates, ("which", "y", "x"))
    with pytest.warns(DatasetNotice, match="the components lie along which, by its size"):
        field = FlowField.from_xarray(array)
    check_analytic(field)
    with pytest.warns(DatasetNotice, match="dim_0, by its size.*nodes are counted from 0"):
        field = FlowField.from_xarray(xr.DataArray(PARTS[:2]))
    assert field.points[4, 3].tolist() == [3, 4, 0]
    assert np.array_equal(field.velocity[0][..., 1], PARTS[1])


def test_two_axes_that_may_have_components_are_named() -> None:
    array = xr.DataArray(PARTS[None, :2].repeat(3, axis=0), LINES, ("a", "b", "y", "x"))
    words = r"'a': 3, 'b': 2, 'y': 11, 'x': 8}, .* along a or b; .* da.rename\({'a': 'component'}\)"
    with pytest.raises(FieldError, match=words):
        FlowField.from_xarray(array)


def test_complex_values_are_two_components() -> None:
    array = xr.DataArray(PARTS[0] + 1j * PARTS[1], LINES, ("y", "x"), attrs={"units": "m/s"})
    field = FlowField.from_xarray(array)
    check_analytic(field)
    assert field.velocity_unit == "m/s"


def test_time_and_one_axis_of_space_are_no_surface() -> None:
    days = np.datetime64("2000-01-01") + np.arange(5) * np.timedelta64(1, "D")
    values = np.ones((5, 8)), {"units": "m/s"}
    arrays = {name: (("time", "x"), *values) for name in "uv"}
    ds = xr.Dataset(arrays, {"time": days, "x": LINES["x"]})
    with pytest.raises(FieldError, match=r"axes time and x, .* flowtex.render\(x, t, u, np.ones"):
        FlowField.from_xarray(ds)
