"""Datasets as models write them: those of the package parcels, by its own account of them."""

from __future__ import annotations

import importlib.util
import re
import sys
import warnings
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.field.options import FieldOptions
from flowtex.sources.datasets.flow import read_flow
from flowtex.sources.notices import DatasetNotice, Record

#: What is recognised: the names of the components, along what they are, and the grid.
KNOWN = {
    "ds_copernicusmarine": ("uo", "vo", "earth", "both components at the same position"),
    "ds_copernicusmarine_waves": ("VSDX", "VSDY", "grid", "both components at the same position"),
    "ds_CESM": ("UVEL", "VVEL", "grid", "both components at the same position.*curvilinear"),
    "ds_MITgcm_netcdf": ("U", "V", "", "Arakawa C"),
    "ds_ERA5_wind": ("u10", "v10", "", "both components at the same position"),
    "ds_ecco4": ("UVEL", "VVEL", "grid", "Arakawa C"),
    "ds_CROCO_idealized": ("u", "v", "grid", "Arakawa C"),
}
#: What is refused, and with which words.
REFUSED = {
    "ds_NEMO_MOI_U": "one component of a velocity, 'vozocrtx'.*'sea_water_y_velocity'",
    "ds_NEMO_MOI_V": "one component of a velocity, 'vomecrty'.*'sea_water_x_velocity'",
    "ds_FES_tides": "one component of a velocity, 'Ua'",
    "ds_hycom_espc": "one component of a velocity, 'water_u'.*'northward_sea_water_velocity'",
    # Its coordinates are metres that are said to be degrees.
    "ds_MITgcm_mds": "YC reaches 5000 and XC 5000 in magnitude; expected degrees",
}


@cache
def models() -> dict[str, Any]:
    """Return the datasets; the rest of the package, and what it needs, is not loaded."""
    found = importlib.util.find_spec("parcels")
    if found is None or found.origin is None:
        pytest.skip("the package parcels is not installed")
    folder = Path(found.origin).parent / "_datasets" / "structured"
    name = "_parcels_structured"
    package = ModuleType(name)
    package.__path__ = [str(folder)]
    package.__dict__.update(X=30, Y=40, Z=5, T=13)
    sys.modules[name] = package
    spec = importlib.util.spec_from_file_location(
        f"{name}.circulation_models", folder / "circulation_models.py"
    )
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return dict(module.datasets)


@pytest.mark.parametrize("name", KNOWN)
def test_a_model_is_recognised(name: str) -> None:
    u, v, along, grid = KNOWN[name]
    ds = models()[name]
    face = {"tile": 0} if "tile" in ds.dims else None
    known = read_flow(ds, FieldOptions(isel=face), Record())
    assert (known.pair.u.name, known.pair.v.name, known.pair.along) == (u, v, along)
    assert re.match(grid, known.grid), known.grid
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DatasetNotice)
        field = FlowField.from_xarray(ds, isel=face, globe=known.places.is_earth)
    assert field.valid.mean() > 0.9
    assert np.isfinite(np.asarray(field.velocity[0])).all()
    # The components are random numbers from 0 to 1, in m/s or cm/s.
    assert field.unit_of("speed") == ("cm/s" if name == "ds_CESM" else "m/s")
    assert 0.3 < np.asarray(field.speed[0]).mean() < 1.5


@pytest.mark.parametrize("name", REFUSED)
def test_a_model_without_a_velocity_is_refused_with_the_reason(name: str) -> None:
    with pytest.raises(FieldError, match=REFUSED[name]):
        FlowField.from_xarray(models()[name])


def test_the_two_files_of_nemo_are_one_field() -> None:
    pair = [models()["ds_NEMO_MOI_U"], models()["ds_NEMO_MOI_V"]]
    known = read_flow(pair, FieldOptions(), Record())
    assert known.grid.startswith("Arakawa C")
    with pytest.warns(DatasetNotice, match="deptht is 1 m, the nearest to the surface of 5"):
        field = FlowField.from_xarray(pair, globe=True)
    u, v = (ds[n].values[0] for ds, n in zip(pair, ("vozocrtx", "vomecrty"), strict=True))
    # On lines of longitude and latitude the means of two sides are eastward and northward.
    mean = (u[1:, :-1] + u[1:, 1:]) / 2, (v[:-1, 1:] + v[1:, 1:]) / 2
    speed = np.hypot(*mean)
    drawn = np.linalg.norm(field.velocity[0], axis=-1)
    assert np.abs(drawn[1:-1, 1:29] - speed[1:-1, :28]).max() < 1e-3
