"""Files that meshio reads, and what their errors name."""

from __future__ import annotations

import sys
from pathlib import Path

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
