"""Names of magnitudes and components of vectors, and of values that some blocks lack."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import pyvista as pv
import xarray as xr

from flowtex import FieldError, FlowField
from flowtex.field.vector_names import is_velocity, magnitude_label
from flowtex.scene.scene import Scene

VELOCITIES = (
    *("U", "u", "V", "velocity", "Velocity", "VELOCITY", "vel", "wind", "current", "UMean"),
    *("U_0", "U.air", "u,v", "u,v,w", "vx,vy,vz", "RelativeVelocity", "velocity [m/s]"),
    *("U10, V10", "uo, vo", "ua, va", "water_u, water_v", "mean_flow", "solid_velocity", "Urel"),
)
OTHERS = (
    *("wallShearStress", "Momentum", "vorticity", "B", "heatFlux", "gradP", "vectors", "data"),
    *("current_density", "wind_stress", "rhoU", "E", "displacement", "curl(U)", "tauuo, tauvo"),
    *("Bx, By", "magnetic_field", "mass_flow", "heat_flow", "q", "acceleration"),
)


def test_the_speed_is_the_magnitude_of_a_velocity_only() -> None:
    assert [name for name in VELOCITIES if magnitude_label(name) != "speed"] == []
    assert [name for name in OTHERS if magnitude_label(name) != f"|{name}|"] == []
    assert magnitude_label("") == "speed" and magnitude_label("", "T") == "magnitude"


@pytest.mark.parametrize(
    ("name", "unit", "expected"),
    [
        ("B", "m/s", True),
        ("B", "knots", True),
        ("x", "px/frame", True),
        ("U", "m", False),
        ("velocity", "T", False),
        ("U", "unknown words", True),
        ("B", "1", False),
    ],
)
def test_a_known_unit_decides(name: str, unit: str, expected: bool) -> None:
    assert is_velocity(name, unit) == expected


def block(**arrays: Any) -> pv.PolyData:
    mesh = pv.Plane(i_resolution=8, j_resolution=6)
    for name, values in arrays.items():
        mesh[name] = np.broadcast_to(values, (mesh.n_points, *np.shape(values)))
    return mesh


def test_arrays_of_a_mesh_name_their_magnitudes() -> None:
    stress = Scene.of(block(wallShearStress=(3.0, 4.0, 0.0)))
    assert stress.title_of("speed") == "|wallShearStress|"
    point: Any = stress.field.at(0.1, 0.1)
    assert point.speed_label == "|wallShearStress|"
    two = block(U=(1.0, 0.0, 0.0), B=(3.0, 4.0, 0.0))
    scene = Scene.of(two, vectors="U", scalars="B")
    assert scene.title_of("B") == "|B|" and np.allclose(scene.scalar("B"), 5)
    assert scene.title_of("speed") == "speed"
    component = Scene.of(two, vectors="U", scalars="B", component=0)
    assert np.allclose(component.scalar(component.scalar_name or ""), 3)
    assert component.title_of("B_x") == "B_x"
    assert component.scalar_names == ("speed", "B_x")
    own = Scene.of(two, vectors="B", scalars="B", component="y")
    assert np.allclose(own.scalar("B_y"), 4)
    with pytest.raises(FieldError, match=r"component is 3; expected 0 to 2, or x to z"):
        Scene.of(two, vectors="U", scalars="B", component=3)
    with pytest.raises(FieldError, match=r"no scalar 'speeds_x'; .* 'U', 'B', .* component=0"):
        Scene.of(two, vectors="U", scalars="speeds", component=0)


def test_datasets_without_a_unit_keep_their_names() -> None:
    x, y = np.linspace(0, 1, 8), np.linspace(0, 1, 7)
    values = (("y", "x"), np.ones((7, 8)))
    fields = xr.Dataset({"Bx": values, "By": values}, {"x": x, "y": y})
    assert FlowField.from_xarray(fields, u="Bx", v="By").label_of("speed") == "|Bx, By|"
    winds = xr.Dataset({"u": values, "v": values}, {"x": x, "y": y})
    assert FlowField.from_xarray(winds).label_of("speed") == "speed"


@pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")
def test_a_scalar_that_some_blocks_lack_is_missing_there() -> None:
    flow = {"U": (1.0, 0.5, 0.0)}
    first, second = block(**flow, T=300.0), block(**flow, q=1)
    second.points += (1.2, 0, 0)
    first["T"] = first["T"].astype(np.float32)
    scene = Scene.of(pv.MultiBlock([first, second]), scalars="T")
    left = scene.field.points[0, :, 0] < 0.55
    assert np.isnan(scene.scalar("T")[0][~left]).all()
    np.testing.assert_allclose(scene.scalar("T")[0][left], 300)
    assert {"T", "q"} <= set(scene.scalar_names)
    assert any("'T' has no values in Block-01" in step.text for step in scene.field.reading)
