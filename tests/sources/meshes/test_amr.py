"""Adaptively refined meshes: finer cells replace coarser ones, with the values of both."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flowtex.field.options import FieldOptions
from flowtex.scene.fields import read_field

CELLS = 8  #: Cells along each side of a box.


def write_amr(file: Path) -> None:
    """Write the flow (1 + y, z, x) in a unit cube, and with half the spacing in an eighth of it."""
    h5py: Any = pytest.importorskip("h5py")
    with h5py.File(file, "w") as opened:
        root = opened.create_group("VTKHDF")
        root.attrs["Version"] = (2, 0)
        root.attrs["Origin"] = np.zeros(3)
        for name, text in (("Type", b"OverlappingAMR"), ("GridDescription", b"XYZ")):
            kind = h5py.string_dtype("ascii", len(text))
            root.attrs.create(name, np.bytes_(text), dtype=kind)
        for number in range(2):
            spacing = 0.5**number / CELLS
            level = root.create_group(f"Level{number}")
            level.attrs["Spacing"] = np.full(3, spacing)
            level.create_dataset("AMRBox", data=np.array([[0, CELLS - 1] * 3]))
            middles = (np.arange(CELLS) + 0.5) * spacing
            z, y, x = np.meshgrid(middles, middles, middles, indexing="ij")
            velocity = np.stack([1 + y, z, x], axis=-1).reshape(-1, 3)
            level.create_group("CellData").create_dataset("velocity", data=velocity)


@pytest.mark.filterwarnings("ignore::flowtex.errors.Notice")
def test_finer_cells_replace_coarser_ones(tmp_path: Path) -> None:
    file = tmp_path / "levels.vtkhdf"
    write_amr(file)
    field = read_field(file, FieldOptions.of(slice="z=0.2"))
    for x, y in ((0.21, 0.29), (0.3, 0.1), (0.7, 0.3), (0.81, 0.77), (0.2, 0.8)):
        found = field.at(x, y)
        assert found is not None
        assert found.velocity == pytest.approx((1 + y, 0.2, x), abs=1e-6)
    assert field.triangles is not None
    corners = field.points[0][field.triangles[field.surface.cells]]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=-1
    )
    assert area.sum() / 2 == pytest.approx(1.0, rel=1e-6)  # nothing is drawn twice
