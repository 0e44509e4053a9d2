"""Arrays with an axis of components."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.sources.opening.tables import split_components

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
