"""GRIB's flags say whether components are along the grid, also where ecCodes has no key."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("cfgrib")
pytest.importorskip("pyproj")

import xarray as xr
from form_table import read
from grib_files import ALONG_GRID, MAPS, write
from known_flow import check

from flowtex.field.options import FieldOptions
from flowtex.scene.fields import read_field
from flowtex.sources.notices import DatasetNotice


@pytest.mark.parametrize("flags", [0, ALONG_GRID])
@pytest.mark.parametrize("kind", MAPS)
def test_components_follow_the_flags(tmp_path: Path, kind: str, flags: int) -> None:
    truth = write(tmp_path / "wind.grib2", kind, flags)
    check(read(tmp_path / "wind.grib2"), truth)


def test_missing_flags_are_told(tmp_path: Path) -> None:
    """As of a dataset that the user opened with cfgrib, without the key."""
    truth = write(tmp_path / "wind.grib2", "polar_stereographic", ALONG_GRID)
    options: dict[str, Any] = {"engine": "cfgrib", "backend_kwargs": {"indexpath": ""}}
    ds = xr.open_dataset(tmp_path / "wind.grib2", **options, decode_timedelta=False)
    with pytest.warns(DatasetNotice, match='if they are along the grid, components="grid"'):
        read_field(ds, FieldOptions())
    check(read(ds, components="grid"), truth)
