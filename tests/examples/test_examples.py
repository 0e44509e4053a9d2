"""The examples as a user meets them: meshes, series, fields, and the exact solutions."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING

import delta_wing_run
import numpy as np
import pytest
from numpy.typing import NDArray

from flowtex import FlowField, examples
from flowtex.examples import delta_wing_field

if TYPE_CHECKING:
    import pyvista as pv

Real = NDArray[np.float64]
SHIPPED = list(examples.NAMES)


@pytest.fixture(scope="module")
def fields() -> dict[str, FlowField]:
    return {name: examples.NAMES[name]() for name in SHIPPED}


@pytest.mark.parametrize("name", SHIPPED)
def test_every_field_is_finite_named_and_moving(name: str, fields: dict[str, FlowField]) -> None:
    field = fields[name]
    assert field.name == name.replace("_", " ")
    assert np.isfinite(field.velocity).all()
    assert field.valid.all()
    assert np.abs(field.velocity).max() > 0.1
    assert field.scalars
    for values in field.scalars.values():
        assert np.isfinite(values).all()
    assert field.points[..., 2].any() == (name == "delta_wing")  # the one curved surface


@pytest.mark.parametrize(
    ("single", "series", "count"),
    [
        (examples.cylinder, examples.cylinder_series, 31),
        (examples.vortex, examples.vortex_series, 31),
        (examples.double_gyre, examples.double_gyre_series, 41),
    ],
)
def test_a_series_has_a_mesh_for_each_instant(
    single: Callable[[], pv.StructuredGrid],
    series: Callable[[], list[pv.StructuredGrid]],
    count: int,
) -> None:
    meshes = series()
    assert len(meshes) == count
    times = [float(mesh.field_data["TimeValue"][0]) for mesh in meshes]
    assert np.all(np.diff(times) > 0.0)
    assert times[0] == 0.0
    for mesh in meshes:
        assert set(mesh.point_data) == {"velocity", "vorticity"}
    shown = single()
    # The double gyre is requested at its first instant, which equals its last.
    np.testing.assert_allclose(shown["velocity"], meshes[-1]["velocity"], atol=1e-12)
    np.testing.assert_array_equal(shown.points, meshes[0].points)


def test_a_mesh_carries_its_field_unchanged() -> None:
    field = examples.airfoil_field()
    mesh = examples.airfoil()
    rows, columns = field.shape
    assert mesh.dimensions == (columns, rows, 1)
    np.testing.assert_allclose(
        mesh.points.reshape(rows, columns, 3), field.points, rtol=1e-6, atol=1e-6
    )
    np.testing.assert_array_equal(mesh["velocity"].reshape(rows, columns, 3), field.velocity[0])
    np.testing.assert_array_equal(
        mesh["pressure"].reshape(rows, columns), field.scalars["pressure"][0]
    )
    assert "TimeValue" not in mesh.field_data


@pytest.mark.parametrize("time", [0.0, 2.5, 6.1])
def test_the_double_gyre_is_the_published_one(time: float) -> None:
    """By differences of its streamfunction, which keeps the volume by its form."""

    def stream(x: Real, y: Real) -> Real:
        a = 0.25 * np.sin(2.0 * np.pi / 10.0 * time)
        return np.asarray(0.1 * np.sin(np.pi * (a * x**2 + (1 - 2 * a) * x)) * np.sin(np.pi * y))

    x, y = np.meshgrid(np.linspace(0.1, 1.9, 19), np.linspace(0.1, 0.9, 9))
    h = 1e-5
    found = examples.double_gyre_velocity(np.stack([x, y], axis=-1), time)
    np.testing.assert_allclose(
        found[..., 0], -(stream(x, y + h) - stream(x, y - h)) / (2 * h), atol=1e-9
    )
    np.testing.assert_allclose(
        found[..., 1], (stream(x + h, y) - stream(x - h, y)) / (2 * h), atol=1e-9
    )


def test_the_vorticity_of_the_double_gyre_is_that_of_its_velocity() -> None:
    mesh = examples.double_gyre(2.5)
    derived = mesh.compute_derivative("velocity", vorticity=True, gradient=False)["vorticity"]
    inside = np.zeros((101, 201), dtype=bool)
    inside[1:-1, 1:-1] = True
    scale = np.abs(mesh["vorticity"]).max()
    error = np.abs(derived[:, 2] - mesh["vorticity"]).reshape(101, 201)[inside].max()
    assert error < 2e-3 * scale


def test_the_flow_slides_along_the_airfoil_and_leaves_its_edge_smoothly() -> None:
    field = examples.airfoil_field(shape=(65, 1025))
    wall, velocity = field.points[0], field.velocity[0, 0]
    tangent = wall[2:] - wall[:-2]
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    through = np.cross(tangent, velocity[1:-1])[:, 2]
    # By differences of the wall's nodes; the last ones at the cusp see its whole turn.
    assert np.abs(through[4:-4]).max() < 5e-3
    # Lower and upper side leave with one velocity: the Kutta condition.
    np.testing.assert_allclose(velocity[1], velocity[0], atol=5e-3)
    np.testing.assert_allclose(velocity[-2], velocity[0], atol=5e-3)
    assert 0.5 < np.linalg.norm(velocity[0]) < 1.0


def test_fields_need_no_pyvista() -> None:
    code = (
        "import sys; from flowtex import examples; "
        "[make() for make in examples.NAMES.values()]; "
        "print(sorted({'vtk', 'vtkmodules', 'pyvista', 'matplotlib'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.fixture(scope="module")
def wing() -> FlowField:
    return delta_wing_field()


def test_the_flow_lies_along_the_surface(wing: FlowField) -> None:
    assert wing.normal_share < 0.02
    fine = FlowField.from_arrays(*delta_wing_run.run((206, 246)))
    assert fine.normal_share < wing.normal_share / 3
