from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from flowtex import examples
from flowtex.errors import FieldError
from flowtex.sources.open_source import MeshSource


def block(steps: int = 1) -> pv.StructuredGrid:
    """A block of 7 x 6 x 5 nodes with two arrays that may be a velocity."""
    x, y, z = np.meshgrid(np.arange(7.0), np.arange(6.0), np.arange(5.0), indexing="ij")
    mesh = pv.StructuredGrid(x, y, z)
    mesh["wind"] = np.tile([1.0, 0.5, 0.0], (mesh.n_points, 1)) * steps
    mesh["water"] = np.tile([0.0, 2.0, 0.0], (mesh.n_points, 1))
    mesh["height"] = mesh.points[:, 2].copy()
    return mesh


def test_a_block_offers_its_planes_and_vectors() -> None:
    source = MeshSource(block(), name="block")
    assert source.dimensions == (7, 6, 5)
    assert source.planes == {"i": 7, "j": 6, "k": 5, "x": 101, "y": 101, "z": 101}
    assert source.vectors == ("wind", "water") and not source.blocks
    field = source.field()
    assert field.name == "block" and np.all(field.scalars["height"] == 2)
    assert source.field(plane="i=3", vectors="water").speed.max() == pytest.approx(2)


def test_a_field_is_given_as_it_is() -> None:
    field = examples.airfoil_field()
    source = MeshSource(field)
    assert source.field() is field and source.vectors == () and source.name == field.name


def test_grids_that_differ_are_blocks_to_choose_from() -> None:
    source = MeshSource(pv.MultiBlock({"near": block(), "far": examples.double_gyre()}))
    assert source.blocks == ("near", "far")
    assert source.field(block="far").shape == examples.double_gyre_field().shape
    with pytest.raises(FieldError, match="block is 'nowhere'; expected one of near, far"):
        source.field(block="nowhere")


def test_a_series_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for n in range(3):
        block(n + 1).save(tmp_path / f"step{n}.vts")
    lines = [f'<DataSet timestep="{0.5 * n}" part="0" file="step{n}.vts"/>' for n in range(3)]
    text = '<?xml version="1.0"?><VTKFile type="Collection" version="0.1"><Collection>'
    path = tmp_path / "series.pvd"
    path.write_text(text + "".join(lines) + "</Collection></VTKFile>")
    source = MeshSource.from_file(path)
    for file in tmp_path.glob("*.vts"):
        file.unlink()
    field = source.field(plane="k=1")
    assert list(field.times) == [0.0, 0.5, 1.0]
    assert field.velocity[2, 0, 0, 0] == pytest.approx(3 * field.velocity[0, 0, 0, 0])
