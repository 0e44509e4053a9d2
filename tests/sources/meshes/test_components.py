"""Single components become vectors by their names, or when they are named."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.sources.meshes.vectors import find_vectors
from flowtex.sources.open_source import MeshSource
from flowtex.sources.read_files import describe

#: The flows of these tests go through their meshes.
pytestmark = pytest.mark.filterwarnings(
    "ignore:.*of the flow is normal to the surface:flowtex.errors.Notice"
)


def says(text: str) -> pytest.RaisesExc[FieldError]:
    """Expect an error with exactly this text."""
    return pytest.raises(FieldError, match=f"^{re.escape(text)}$")


@pytest.mark.parametrize(
    ("names", "vector"),
    [
        ("X Velocity|Y Velocity|Z Velocity", "Velocity"),
        ("x_velocity|y_velocity|z_velocity", "velocity"),
        ("x-velocity|y-velocity|z-velocity", "velocity"),
        ("XVelocity|YVelocity|ZVelocity", "Velocity"),
        ("VelocityX|VelocityY|VelocityZ", "Velocity"),
        ("velocity_x|velocity_y|velocity_z", "velocity"),
        ("Velocity_0|Velocity_1|Velocity_2", "Velocity"),
        ("velocity:0|velocity:1|velocity:2", "velocity"),
        ("Vorticity:0|Vorticity:1|Vorticity:2", "Vorticity"),
        ("U[0]|U[1]|U[2]", "U[0],U[1],U[2]"),
        ("vel1|vel2|vel3", "vel"),
        ("velx|vely|velz", "vel"),
        ("vx|vy|vz", "vx,vy,vz"),
        ("Ux|Uy|Uz", "Ux,Uy,Uz"),
        ("VX|VY|VZ", "VX,VY,VZ"),
        ("u|v|w", "u,v,w"),
        ("U|V|W", "U,V,W"),
        ("u_velocity|v_velocity|w_velocity", "velocity"),
        ("Velocity u [m s^-1]|Velocity v [m s^-1]|Velocity w [m s^-1]", "Velocity"),
        ("Velocity X (m/s)|Velocity Y (m/s)|Velocity Z (m/s)", "Velocity"),
        ("Mean Velocity X|Mean Velocity Y|Mean Velocity Z", "Mean Velocity"),
        ("BX|BY|BZ", None),
        ("B_x|B_y|B_z", "B_x,B_y,B_z"),
        ("Wall Shear-x|Wall Shear-y|Wall Shear-z", "Wall Shear"),
        ("MomentumX|MomentumY|MomentumZ", None),
        ("CoordinateX|CoordinateY|CoordinateZ", None),
        ("Points:0|Points:1|Points:2", None),
        ("Normals_X|Normals_Y|Normals_Z", None),
        ("x|y|z", None),
        ("X|Y|Z", None),
        ("species_0|species_1|species_2", None),
        ("velocity_0|velocity_1|velocity_2|velocity_3", None),
        ("StressXX|StressXY|StressXZ", None),
        ("u|v", None),
        ("VelocityX|VelocityY|velocityZ", None),
        ("VelocityX|VelocityY", None),
        ("p", None),
    ],
)
def test_names_that_belong_together(names: str, vector: str | None) -> None:
    parts = tuple(names.split("|"))
    expected = {} if vector is None else {vector: parts}
    for order in (parts, parts[::-1], ("p", *parts, "T")):
        assert find_vectors(order) == expected


def test_pairs_do_where_there_is_no_third() -> None:
    assert find_vectors(["u", "v"], (0, 1)) == {"u,v": ("u", "v")}
    assert find_vectors(["u", "v", "w"], (0, 1)) == {"u,v,w": ("u", "v", "w")}
    assert find_vectors(["v", "w"], (0, 1)) == {}


def test_a_name_that_is_taken_is_not_given_again() -> None:
    parts = ["VelocityX", "VelocityY", "VelocityZ"]
    assert find_vectors([*parts, "Velocity"]) == {",".join(parts): tuple(parts)}


NAMES = ("X Velocity", "Y Velocity", "Z Velocity")


def mesh(names: tuple[str, ...] = NAMES, where: str = "points", k: int = 1) -> Any:
    """A grid with components (1, 2, 3) everywhere, and a pressure."""
    grid = pv.ImageData(dimensions=(4, 3, k)).cast_to_structured_grid()
    data = grid.point_data if where == "points" else grid.cell_data
    count = grid.n_points if where == "points" else grid.n_cells
    for n, name in enumerate(names, 1):
        data[name] = np.full(count, float(n))
    data["p"] = np.arange(float(count))
    return grid


@pytest.mark.parametrize("where", ["points", "cells"])
@pytest.mark.parametrize(
    "vectors",
    [None, "Velocity", "X Velocity,Y Velocity,Z Velocity", " X Velocity , Y Velocity,Z Velocity "],
)
def test_three_components(where: str, vectors: str | None) -> None:
    field = FlowField.from_pyvista(mesh(where=where), vectors=vectors)
    assert np.all(field.velocity == (1, 2, 3))
    assert set(field.scalars) == {*NAMES, "p"}, "components stay to colour by"


def test_components_in_another_order() -> None:
    field = FlowField.from_pyvista(mesh(), vectors="Z Velocity,X Velocity,Y Velocity")
    assert np.all(field.velocity == (3, 1, 2))


def test_two_components_of_a_solid_mesh_are_named_or_none() -> None:
    with pytest.raises(FieldError, match="the mesh has no vectors that could be the velocity"):
        FlowField.from_pyvista(mesh(NAMES[:2], k=2), plane="k=1")
    field = FlowField.from_pyvista(
        mesh(NAMES[:2], k=2), plane="k=1", vectors="X Velocity,Y Velocity"
    )
    assert np.all(field.velocity == (1, 2, 0))


def test_real_vectors_come_before_components() -> None:
    grid = mesh()
    grid["wind"] = np.ones((grid.n_points, 3))
    assert np.all(FlowField.from_pyvista(grid).velocity == 1)
    assert np.all(FlowField.from_pyvista(grid, vectors="Velocity").velocity == (1, 2, 3))


def test_an_array_whose_own_name_has_commas_wins() -> None:
    grid = mesh(("u", "v", "w"))
    grid["u,v,w"] = np.full((grid.n_points, 3), 7.0)
    assert np.all(FlowField.from_pyvista(grid, vectors="u,v,w").velocity == 7)


@pytest.mark.parametrize(
    "vectors", ["X Velocity,Y Velocity,Z Velocit", "X Velocity,Y Velocity,q", "p,p,p,p", "p,"]
)
def test_components_that_make_no_vector(vectors: str) -> None:
    grid = mesh()
    grid.cell_data["q"] = np.ones(grid.n_cells)
    with says(
        f"vectors is {vectors!r}; expected an array of 2 or 3 components, or the names of 2 or 3 "
        "arrays of one component, all on points or all on cells, separated by commas. The arrays "
        "of the mesh, with their numbers of components: X Velocity (points, 1), Y Velocity "
        "(points, 1), Z Velocity (points, 1), p (points, 1), q (cells, 1)"
    ):
        FlowField.from_pyvista(grid, vectors=vectors)


def test_components_of_a_file(tmp_path: Path) -> None:
    mesh(k=3).save(tmp_path / "flow.vts")
    source = MeshSource.from_file(tmp_path / "flow.vts")
    assert source.vectors == ("Velocity",)
    assert np.all(source.field(plane="k=1").velocity == (1, 2, 3))
    summary = describe(tmp_path / "flow.vts")
    assert summary.candidates == ("Velocity",)
    joined = [a for a in summary.arrays if a.parts]
    assert [(a.name, a.where, a.components, a.parts) for a in joined] == [
        ("Velocity", "points", 3, NAMES)
    ]
    assert joined[0].high == pytest.approx(np.sqrt(14))


def test_single_components_come_before_a_vorticity() -> None:
    mesh = pv.Plane(i_resolution=4, j_resolution=3)
    for name, value in zip("uvw", (1.0, 2.0, 0.0), strict=True):
        mesh[name] = np.full(mesh.n_points, value)
    mesh["vorticity"] = np.tile([0.0, 0.0, 5.0], (mesh.n_points, 1))
    with pytest.warns(UserWarning, match='vectors="vorticity"'):
        field = FlowField.from_pyvista(mesh)
    assert np.allclose(field.velocity[0], (1, 2, 0))
