"""Forms of flows on PyVista meshes: planes, kinds of components, and data of cells."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv
from form_table import form, variants
from known_flow import Truth, at_points, plane

#: Normals of planes and the axes that span them.
PLANES = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
NORMALS = {"xy": (0, 0, 1), "xz": (0, 1, 0), "yz": (1, 0, 0)}


def sheet(kind: str) -> tuple[Any, Any, Any]:
    """Return a mesh in a plane, and its flow along the axes of the plane."""
    mesh = pv.Plane(direction=NORMALS[kind], i_resolution=20, j_resolution=12)
    a, b = (mesh.points[:, axis].astype(float) for axis in PLANES[kind])
    return mesh, *plane(a, b)


def truth_of(mesh: Any, kind: str, **more: Any) -> Truth:
    return at_points(mesh.points[:, PLANES[kind]], axes=PLANES[kind], **more)


@variants(PLANES)
def two_components_on_a_sheet(kind: str) -> Any:
    """They are along the axes of the plane."""
    mesh, u, v = sheet(kind)
    mesh["U"] = np.stack([u, v], axis=-1)
    return mesh, truth_of(mesh, kind)


@variants(PLANES)
def three_components_on_a_sheet(kind: str) -> Any:
    mesh, u, v = sheet(kind)
    mesh["U"] = np.zeros((mesh.n_points, 3))
    for axis, value in zip(PLANES[kind], (u, v), strict=True):
        mesh["U"][:, axis] = value
    return mesh, truth_of(mesh, kind)


@form(says="normal")
def a_component_normal_to_a_sheet() -> Any:
    mesh, u, v = sheet("xz")
    mesh["U"] = np.stack([u, np.full(len(u), 0.5), v], axis=-1)
    return mesh, truth_of(mesh, "xz")


@variants(PLANES)
def components_in_arrays_of_their_own(kind: str) -> Any:
    mesh, u, v = sheet(kind)
    for letter, value in zip(kind, (u, v), strict=True):
        mesh[f"velocity_{letter}"] = value
    return mesh, truth_of(mesh, kind)


@variants(["xy", "xz", "yz"], options={"vectors": "u,v"})
def named_components_in_arrays_of_their_own(kind: str) -> Any:
    mesh, u, v = sheet(kind)
    mesh["u"], mesh["v"] = u, v
    return mesh, truth_of(mesh, kind)


@variants(PLANES)
def two_components_on_rows_and_columns(kind: str) -> Any:
    a, b = np.meshgrid(np.linspace(0, 3, 21), np.linspace(0, 1, 13), indexing="ij")
    xyz = [np.zeros_like(a)] * 3
    for axis, value in zip(PLANES[kind], (a, b), strict=True):
        xyz[axis] = value
    mesh = pv.StructuredGrid(*(value[..., None] for value in xyz))
    p = mesh.points[:, PLANES[kind]].astype(float)
    mesh["U"] = np.stack(plane(*p.T), axis=-1)
    return mesh, truth_of(mesh, kind)


@variants(["xy", "xz"])
def values_of_cells(kind: str) -> Any:
    """Means at the points; those of the border have values on one side only."""
    mesh, *_ = sheet(kind)
    p = mesh.cell_centers().points[:, PLANES[kind]].astype(float)
    mesh.cell_data["U"] = np.stack(plane(*p.T), axis=-1)
    return mesh, truth_of(mesh, kind, tolerance=0.06)


@form(options={"slice": "y=0"})
def a_slice_of_a_volume() -> Any:
    volume = pv.ImageData(dimensions=(21, 5, 13), spacing=(0.1,) * 3, origin=(0, -0.2, 0))
    x, _, z = volume.points.T.astype(float)
    u, v = plane(x, z)
    volume["U"] = np.stack([u, 0 * u, v], axis=-1)
    kept = np.abs(volume.points[:, 1]) < 1e-9
    return volume, at_points(np.stack([x, z], axis=-1)[kept], axes=(0, 2))


@form()
def steps_of_a_mesh() -> Any:
    """A list of meshes, at times 0, 1 and 2."""
    found = []
    for time in range(3):
        mesh, *_ = sheet("xy")
        p = mesh.points.astype(float)
        mesh["U"] = np.stack([*plane(p[:, 0], p[:, 1], time), 0 * p[:, 0]], axis=-1)
        found.append(mesh)
    return found, at_points(found[0].points[:, :2], times=(0.0, 1.0, 2.0), undated=True)
