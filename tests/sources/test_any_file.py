"""Broken files give an error of ours, whatever is broken in them."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st
from strategies import property_test

from flowtex import FlowField
from flowtex.errors import FieldError


def grid() -> Any:
    x, y, z = np.meshgrid(np.arange(4.0), np.arange(3.0), np.zeros(1), indexing="ij")
    mesh = pv.StructuredGrid(x, y, z)
    mesh["velocity"] = np.cos(mesh.points) + 1
    return mesh


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Small files by name, and what is in them."""
    folder = tmp_path_factory.mktemp("whole")
    grid().save(folder / "binary.vts")
    grid().save(folder / "text.vts", binary=False)
    grid().save(folder / "binary.vtk")
    grid().save(folder / "text.vtk", binary=False)
    pv.MultiBlock([grid()]).save(folder / "blocks.vtm")
    size = np.array([4, 3, 1], "<i4").tobytes()
    values = np.ones((5, 12), "<f4")
    (folder / "wing.xyz").write_bytes(size + np.float32(grid().points.T).tobytes())
    (folder / "wing.q").write_bytes(size + np.ones(4, "<f4").tobytes() + values.tobytes())
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


@pytest.mark.vtk_log_allowed("files are broken on purpose")
@property_test(60)
@given(
    st.sampled_from(
        ["binary.vts", "text.vts", "binary.vtk", "text.vtk", "wing.xyz", "wing.q", "blocks.vtm"]
    ),
    st.floats(0, 1.2),
    st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), max_size=3),
)
def test_a_broken_file_is_named(
    files: dict[str, bytes],
    tmp_path_factory: pytest.TempPathFactory,
    name: str,
    end: float,
    changes: list[tuple[float, int]],
) -> None:
    folder = tmp_path_factory.mktemp("broken")
    for other, content in files.items():
        (folder / other).write_bytes(content)
    data = bytearray(files[name][: int(len(files[name]) * end)])
    for place, value in changes:
        if data:
            data[int(place * (len(data) - 1))] = value
    (folder / name).write_bytes(data)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of what can be read all the same
        try:
            field = FlowField.from_file(folder / name)
        except FieldError as error:
            assert str(error).startswith(str(folder / name))
        else:
            assert np.isfinite(field.velocity).all()
