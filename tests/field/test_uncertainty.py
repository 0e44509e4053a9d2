"""What a flow is told of its uncertainty, and what the texture makes of that."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import pyvista as pv
import xarray as xr
from flows import scattered_gyre

from flowtex import FlowField, quality
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.options import FieldOptions
from flowtex.field.uncertainty import UNCERTAINTY, unknown_share, with_uncertainty
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.render import Picture, render
from flowtex.scene.fields import read_field, share_field
from flowtex.scene.scene import Scene
from flowtex.settings import Settings


def straight() -> FlowField:
    y, x = np.mgrid[-1:1:41j, -1.5:1.5:61j]
    return FlowField.from_arrays(np.stack([x, y], axis=-1), np.ones((41, 61, 2)) * (1.0, 0.5))


def picture(field: FlowField, **settings: Any) -> Picture:
    scene = Scene(field, Settings(**settings))
    camera = Camera((0, 0, 5), (0, 0, 0), (0, 1, 0), parallel=True, parallel_scale=0.9)
    return render(scene.textures, scene.settings, camera, (180, 120))


def coherence(drawn: Picture) -> float:
    u, v = np.ones(drawn.value.shape), 0.5 * np.ones(drawn.value.shape)
    return quality.alignment(drawn.value, u, v, drawn.covered).coherence


@pytest.mark.parametrize("kernel", ["hann", "box"])
def test_no_uncertainty_changes_nothing(kernel: str) -> None:
    for field in (straight(), scattered_gyre()):
        told = with_uncertainty(field, np.zeros(field.shape))
        ours, theirs = (picture(one, kernel=kernel) for one in (field, told))
        assert np.array_equal(ours.value, theirs.value, equal_nan=True)


def test_streaks_are_shorter_and_fainter_until_there_is_no_direction() -> None:
    field = straight()
    shown = [
        picture(with_uncertainty(field, np.full(field.shape, share))) for share in (0, 0.5, 0.9, 1)
    ]
    contrast = [one.value[one.covered].std() for one in shown]
    assert np.all(np.diff(contrast) < -0.05)
    assert contrast[-1] == pytest.approx(0.3 * contrast[0], rel=0.1)
    agreed = [coherence(one) for one in shown]
    assert np.all(np.diff(agreed) < 0)
    assert agreed[0] > 0.9 and agreed[-1] < 0.25
    # Other paths through the same noise: with no direction there is none to be seen.
    other = FlowField.from_arrays(field.points, field.velocity[0, ..., [1, 0, 2]].T.swapaxes(0, 1))
    same = picture(with_uncertainty(other, np.full(field.shape, 2.0)))
    assert np.allclose(same.value, shown[-1].value, atol=1e-3, equal_nan=True)


def test_a_scalar_is_named_and_an_array_becomes_one() -> None:
    field = straight()
    sigma = np.linspace(0, 2, 41 * 61).reshape(41, 61)
    named = FlowField.from_arrays(field.points, field.velocity[0], scalars={"sigma": sigma})
    options = FieldOptions(uncertainty="sigma")
    assert read_field(named, options).uncertainty == "sigma"
    given = read_field(field, FieldOptions(uncertainty=sigma))
    assert given.uncertainty == UNCERTAINTY and list(given.scalars) == [UNCERTAINTY]
    assert given.surface is field.surface
    assert np.array_equal(unknown_share(given, 0), np.minimum(sigma, 1))
    # Nodes without a value are not known at all, and blanked ones are as those beside them.
    sigma[3, 4], valid = np.nan, np.ones(field.shape, dtype=bool)
    valid[:, :2] = False
    holed = FlowField.from_arrays(field.points, field.velocity[0], valid=valid)
    share = unknown_share(with_uncertainty(holed, sigma), 0)
    assert share[3, 4] == 1 and np.array_equal(share[:, 0], share[:, 2])
    assert share_field(given) is not share_field(field)


def test_a_scalar_on_cells_is_averaged_to_the_nodes() -> None:
    grid = pv.ImageData(dimensions=(4, 3, 1))
    grid["U"], grid.cell_data["sigma"] = np.ones((12, 2)), np.arange(6) / 10
    expected = grid.cell_data_to_point_data().point_data["sigma"]
    field = FlowField.from_pyvista(grid, uncertainty="sigma")
    assert field.on_cells == () and field.uncertainty == "sigma"
    np.testing.assert_allclose(field.scalars["sigma"][0].ravel(), expected)
    triangles = with_uncertainty(FlowField.from_pyvista(grid.cast_to_unstructured_grid()), "sigma")
    assert triangles.on_cells == () and triangles.scalars["sigma"].shape == (1, 1, 12)
    assert triangles.scalars["sigma"].max() <= 0.5


def ensemble(angles: Floats, dims: tuple[str, ...] = ("number", "lat", "lon")) -> xr.Dataset:
    """Winds of 10 m/s of members, in directions (M, J, I)."""
    units = {"units": "m s-1"}
    u, v = 10 * np.cos(angles), 10 * np.sin(angles)
    kinds = ({"standard_name": f"{way}ward_wind"} for way in ("east", "north"))
    data: dict[str, Any] = {
        n: (dims, c, units | k) for n, c, k in zip("uv", (u, v), kinds, strict=True)
    }
    data["t"], data["t2"] = (dims, angles), (dims, 10 + np.abs(angles))
    data["mask"] = (dims[1:], np.ones(angles.shape[1:]))
    line = {"lat": np.linspace(-20, 20, 9), "lon": np.linspace(0, 60, 13)}
    return xr.Dataset(data, coords=line | {dims[0]: np.arange(len(angles))})


@pytest.mark.parametrize("dim", ["number", "realization", "time"])
def test_the_mean_of_members_is_drawn_with_their_spread(dim: str) -> None:
    half = np.linspace(0, np.pi / 2, 13) + np.zeros((9, 13))
    ds = ensemble(np.stack([half, -half]), (dim, "lat", "lon"))
    field = FlowField.from_xarray(ds, globe=True, uncertainty=dim)
    assert field.steady and field.uncertainty == f"spread over {dim}"
    assert np.allclose(field.scalars["t"][0], 0) and np.allclose(field.scalars["t2"][0], 10 + half)
    # Two at angles a and -a: the mean is 10 cos(a), and the deviation 10 sin(a).
    assert np.allclose(field.speed[0], 10 * np.cos(half), atol=1e-6)
    wanted = np.minimum(np.tan(half), 1)
    assert np.allclose(np.asarray(field.scalars[field.uncertainty][0]), wanted, atol=1e-6)
    assert "mean over" in field.name


def test_a_dataset_may_name_a_variable_and_nothing_else() -> None:
    ds = ensemble(np.zeros((3, 9, 13)))
    with pytest.warns(UserWarning, match="number is 0"):
        assert FlowField.from_xarray(ds, uncertainty="t").uncertainty == "t"
    with pytest.raises(FieldError, match="'lat', which is not a further axis of the data"):
        FlowField.from_xarray(ds, uncertainty="lat", isel={"number": 0})
    with pytest.raises(FieldError, match="number is 1, but uncertainty is the spread"):
        FlowField.from_xarray(ds, uncertainty="number", isel={"number": 1})
