"""``ds.flowtex``: the calls of the package on a dataset."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("xarray")
pytest.importorskip("cf_xarray")

from earth_data import winds

import flowtex
import flowtex.xarray
from flowtex import FieldError
from flowtex.settings import SettingsError


def test_a_dataset_has_the_calls_of_the_package(opengl: Any, tmp_path: Path) -> None:
    del opengl
    ds = winds(np.arange(-180.0, 180.0, 20.0), np.arange(-80.0, 81.0, 20.0))
    assert ds.flowtex.field(globe=True).projection.is_globe
    picture = ds.flowtex.render(globe=True, size=(60, 40))
    assert np.array_equal(picture, flowtex.render(ds, globe=True, size=(60, 40)))
    ds.flowtex.export(tmp_path / "page.html", projection="robinson")
    assert (tmp_path / "page.html").stat().st_size > 10_000
    pytest.importorskip("anywidget")
    assert ds.flowtex.widget(globe=True).settings.samples > 0
    with pytest.raises(SettingsError, match="globe"):
        ds.flowtex.render(glob=True)
    with pytest.raises(FieldError, match="plane is for meshes"):
        ds.flowtex.render(plane="k=2")
    with pytest.raises(FieldError, match="globe is for data of the Earth"):
        flowtex.render(flowtex.examples.double_gyre(), globe=True)
