"""Each line of the page "Supported data" draws the flow of its files."""

from __future__ import annotations

from pathlib import Path

import array_files
import declared_files
import direction_files
import global_files
import grib_files
import mesh_files
import model_files
import point_files
import product_files
import pytest
import raster_files
import text_forms
from flow_at_points import check_at
from known_flow import check
from supported import ROWS, Supported, drawn

pytest.importorskip("pyproj")
MODULES = (
    array_files,
    declared_files,
    direction_files,
    global_files,
    grib_files,
    mesh_files,
    model_files,
    point_files,
    product_files,
    raster_files,
    text_forms,
)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.make.__name__)
def test_line_of_supported_data_draws_the_flow(
    row: Supported, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if row.needs:
        pytest.importorskip(row.needs.replace("-", "_"))
    monkeypatch.chdir(tmp_path)
    variables, truth = row.make(tmp_path)
    field = drawn(row.code, variables)
    check(field, truth)
    check_at(field, truth)
