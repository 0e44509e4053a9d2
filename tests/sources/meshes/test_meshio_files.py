"""Files that meshio reads, and what their errors name."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.errors import FieldError


def test_missing_meshio_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "meshio", None)
    path = tmp_path / "flow.msh"
    path.write_text("$MeshFormat\n")
    with pytest.raises(FieldError, match=r"a \.msh file needs meshio; install it with python -m"):
        FlowField.from_file(path)


def test_file_that_meshio_cannot_read_is_an_error(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("meshio")
    path = tmp_path / "flow.msh"
    path.write_text("no mesh\n")
    with pytest.raises(FieldError, match=r"flow\.msh: .*cannot"):
        FlowField.from_file(path)
    assert capfd.readouterr().err == ""


def test_mesh_without_arrays_has_a_line_to_type(tmp_path: Path) -> None:
    pytest.importorskip("meshio")
    path = tmp_path / "wing.su2"
    path.write_text(
        "NDIME= 2\nNELEM= 2\n5 0 1 2 0\n5 1 3 2 1\nNPOIN= 4\n0 0 0\n1 0 1\n0 1 2\n1 1 3\nNMARK= 0\n"
    )
    with pytest.raises(FieldError, match="it has a mesh without arrays, so there is no velocity"):
        FlowField.from_file(path)


def test_abaqus_is_told_from_avs(tmp_path: Path) -> None:
    pytest.importorskip("meshio")
    path = tmp_path / "plate.inp"
    nodes = "1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n"
    path.write_text(f"*HEADING\nplate\n*NODE\n{nodes}*ELEMENT, TYPE=CPS3\n1, 1, 2, 3\n*END\n")
    with pytest.raises(FieldError, match="it has a mesh without arrays"):
        FlowField.from_file(path)


@pytest.mark.parametrize("kind", ["vector", "components"])
def test_exodus_of_meshio_has_its_values(kind: str, tmp_path: Path) -> None:
    """VTK alone reads zeros."""
    meshio = pytest.importorskip("meshio")
    pytest.importorskip("netCDF4")
    x, y = (part.ravel() for part in np.meshgrid(np.arange(4.0), np.arange(3.0)))
    points = np.column_stack([x, y, 0 * x])
    corners = np.arange(12).reshape(3, 4)
    quads = [corners[:-1, :-1], corners[:-1, 1:], corners[1:, 1:], corners[1:, :-1]]
    cells = [("quad", np.stack(quads, axis=-1).reshape(-1, 4))]
    velocity = np.column_stack([1 + y, -0.5 * x, 0 * x])
    arrays = {"U": velocity}
    if kind == "components":
        arrays = {"vx": velocity[:, 0], "vy": velocity[:, 1]}
    path = tmp_path / "flow.e"
    meshio.write(path, meshio.Mesh(points, cells, point_data=arrays))
    field = FlowField.from_file(path)
    for place, vector in zip(points, velocity, strict=True):
        nearest = np.argmin(np.linalg.norm(field.points.reshape(-1, 3) - place, axis=1))
        found = np.asarray(field.velocity[0]).reshape(-1, 3)[nearest]
        np.testing.assert_allclose(found, vector, atol=1e-6)
