"""Every form is right at every node and time, or raises an error that names the cause."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import declared_forms
import grid_forms
import label_forms
import mesh_forms
import model_forms
import numpy as np
import product_forms
import public_forms
import pytest
import time_forms
import topology_forms
import triangle_forms
import turned_forms
import user_forms
import value_forms
from form_table import FORMS, judge, read
from known_flow import check, in_plane, lab, plane, ratio

from flowtex import FlowField
from flowtex.errors import FieldError

pytest.importorskip("pyproj")
MODULES = (
    declared_forms,
    grid_forms,
    label_forms,
    mesh_forms,
    model_forms,
    product_forms,
    public_forms,
    time_forms,
    topology_forms,
    triangle_forms,
    turned_forms,
    user_forms,
    value_forms,
)


@pytest.mark.parametrize("name", FORMS)
def test_form_is_right_or_names_the_cause(name: str, tmp_path: Path) -> None:
    judge(FORMS[name], tmp_path)


def test_positions_in_millimetres_leave_legends_true() -> None:
    """Solid rotation of 150 per second: vorticity is 300 per second."""
    import xarray as xr

    x, y = np.linspace(-20, 20, 41), np.linspace(-10, 10, 21)
    across, up = np.meshgrid(x, y)
    unit = {"units": "m/s"}
    ds = xr.Dataset(
        {"u": (("y", "x"), -0.15 * up, unit), "v": (("y", "x"), 0.15 * across, unit)},
        {"x": ("x", x, {"units": "mm"}), "y": ("y", y, {"units": "mm"})},
    )
    field = read(ds)
    speed = np.asarray(field.speed).max() * ratio(field.unit_of("speed"), "m/s")
    assert speed == pytest.approx(0.15 * np.hypot(20, 10))
    found = field.with_derived("vorticity")
    values = np.asarray(found.scalars["vorticity"]) * ratio(found.unit_of("vorticity"), "1/s")
    assert np.allclose(values, 300)


def test_errors_about_laboratory_axes_have_no_longitude() -> None:
    ds = lab(np.linspace(0, 3, 9), np.linspace(0, 1, 7)).rename(y="row", x="column")
    ds = ds.drop_vars(["row", "column"])
    try:
        read(ds)
    except FieldError as error:
        assert "longitude" not in str(error)


def test_shuffled_x_of_arrays_is_sorted_or_refused() -> None:
    x, y = np.random.default_rng(0).permutation(np.linspace(0, 3, 25)), np.linspace(0, 1, 16)
    velocity = np.stack(plane(*np.meshgrid(x, y)), axis=-1)
    try:
        field = FlowField.from_arrays((x, y), velocity)
    except FieldError as error:
        assert "x" in str(error)
        return
    check(field, in_plane(x, y))
    assert (np.diff(field.points[0, :, 0]) > 0).all()


def test_check_finds_each_kind_of_fault() -> None:
    """The comparison can fail: on places, values, units and coverage."""
    x, y = np.linspace(0, 3, 9), np.linspace(0, 1, 7)
    field = read(lab(x, y))
    check(field, in_plane(x, y))
    wrong: list[Any] = [
        in_plane(x + 0.1, y),
        in_plane(np.append(x, 4.0), y),
        in_plane(x[:-1], y),
        in_plane(x, y, (0.0, 1.0)),
        in_plane(x, y, (0.3,)),
        in_plane(x, y, unit="m"),
        in_plane(x, y, scale=1.01),
    ]
    for truth in wrong:
        with pytest.raises(AssertionError):
            check(field, truth)
