"""Remedies of errors can be typed in Python and in a shell, and change what is reported."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from known_flow import DEGREES, earth
from test_notices import typed_in_shell

from flowtex.cli import main
from flowtex.cli.console import typed
from flowtex.errors import FieldError
from flowtex.field.options import FieldOptions
from flowtex.remedies import error_for_page, lines_for_shell
from flowtex.scene.fields import read_field
from flowtex.scene.forms import FLAGS

pytest.importorskip("pyproj")
LON, LAT = np.arange(-20.0, 21, 4), np.arange(20.0, 61, 4)


def two_velocities() -> xr.Dataset:
    ds = earth(LON, LAT)
    return ds.assign(uo=ds.u, vo=ds.v)


def temperature_as_u() -> xr.Dataset:
    ds = earth(LON, LAT)
    ds.u.attrs["units"] = "K"
    return ds


def named_by_numbers() -> xr.Dataset:
    ds = earth(LON, LAT).rename(u="vel_1", v="vel_2")
    for name in ds.data_vars:
        ds[name].attrs = {"units": "m/s"}
    return ds


def nest_that_moves() -> xr.Dataset:
    ds = earth(LON, LAT, (0, 6)).drop_vars(["lon", "lat"]).rename(lon="i", lat="j")
    lon, lat = np.meshgrid(LON, LAT)
    dims = ("time", "j", "i")
    return ds.assign_coords(
        XLONG=(dims, np.stack([lon, lon + 1]), DEGREES["lon"]),
        XLAT=(dims, np.stack([lat, lat + 1]), DEGREES["lat"]),
    )


def plain() -> xr.Dataset:
    return earth(LON, LAT)


#: Data, options and the argument that the error proposes.
CASES: list[tuple[Callable[[], xr.Dataset], dict[str, Any], dict[str, Any]]] = [
    (two_velocities, {}, {"u": "u", "v": "v"}),
    (temperature_as_u, {}, {"u": "u", "v": "v", "velocity_unit": "m/s"}),
    (named_by_numbers, {}, {"vectors": "vel_1,vel_2"}),
    (nest_that_moves, {}, {"isel": {"time": 0}}),
    (plain, {"dims": "lat,lon"}, {"dims": "lon,lat"}),
    (plain, {"mask": "land"}, {"mask": False}),
]


@pytest.mark.parametrize(("make", "given", "proposed"), CASES)
def test_remedy_of_an_error_works(
    make: Callable[[], xr.Dataset], given: dict[str, Any], proposed: dict[str, Any]
) -> None:
    data = make()
    with pytest.raises(FieldError) as caught:
        read_field(data, FieldOptions.of(**given))
    text = str(caught.value)
    flags = re.search(r"--\S.*?(?=:|$)", typed(text))
    assert flags is not None, text
    assert typed_in_shell(flags[0]) == proposed
    assert "--" not in text
    read_field(data, FieldOptions.of(**{**given, **proposed}))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('as in u="uo", v="vo"', "as in --u uo --v vo"),
        ("name both, as in u=..., v=...", "name both, as in --u ... --v ..."),
        ('isel={\'face\': 0} or sel={"plev": "500 hPa"}', None),
        ("globe=True and mask=False", "--globe and --mask none"),
        ("omit lod=False", "omit --no-lod"),
        ("max_edge=1.5, or fewer points", "--max-edge 1.5, or fewer points"),
        ('flowtex.show(x, level=3), or level="3 m"', 'flowtex.show(x, level=3), or --level "3 m"'),
        ("ds.isel(time=0)", "ds.isel(time=0)"),
        ("the name number=3 is no flag", "the name number=3 is no flag"),
        ("slice is 'x=1'", "slice is 'x=1'"),
        ('use flowtex.show(numpy.load("a.npz")); vectors="a,b"', None),
    ],
)
def test_arguments_become_flags_outside_python(text: str, words: str | None) -> None:
    if words is None and "isel" in text:
        words = '--isel face=0 or --sel "plev=500 hPa"'
    assert typed(text) == (words or text)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a b/c.nc: as in ds.drop_vars('x')", 'ds is xarray.open_dataset("a b/c.nc")'),
        ("as after df.dropna()", 'df is pandas.read_csv("FILE")'),
        ("mesh.sample(step)", "flowtex.show(mesh) draws it"),
        ('flowtex.show(scipy.io.loadmat("a.mat"))', "python -c 'import flowtex, scipy.io; flow"),
        ("adds nothing to words", ""),
    ],
)
def test_lines_of_python_say_where_their_objects_come_from(text: str, words: str) -> None:
    lines = lines_for_shell(text)
    assert words in lines
    assert bool(words) == bool(lines)


def test_shell_reports_the_flags_and_the_dataset(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    several = tmp_path / "several.nc"
    two_velocities().to_netcdf(several)
    assert main(["info", str(several)]) == 2
    assert "as in --u u --v v" in capsys.readouterr().err
    texts = tmp_path / "texts.nc"
    ds = earth(LON, LAT, (0, 6))
    ds.assign_coords(time=["noon", "evening"]).to_netcdf(texts)
    assert main(["info", str(texts)]) == 2
    assert f'ds is xarray.open_dataset("{texts}")' in " ".join(capsys.readouterr().err.split())


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "it is empty"),
        (b"<!DOCTYPE html><title>404", "HTML or XML"),
        (b"version https://git-lfs.github.com/spec/v1\n", "git lfs pull"),
        (b"x,y,u,v\n1,2,3,4\n", "give it the ending"),
    ],
)
def test_other_content_of_a_netcdf_file_is_recognised(
    tmp_path: Path, content: bytes, words: str
) -> None:
    path = tmp_path / "flow.nc"
    path.write_bytes(content)
    with pytest.raises(FieldError, match=words):
        read_field(path, FieldOptions())


@pytest.mark.parametrize("option", [{"plane": "k=3"}, {"block": 1}])
def test_options_of_meshes_are_not_taken_for_axes(option: dict[str, Any]) -> None:
    from flowtex import FlowField

    with pytest.raises(FieldError, match="applies to meshes, but this is a dataset; omit it"):
        FlowField.from_xarray(plain(), **option)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('choose it, as in level="3 m"', "choose it, with the control Plane"),
        ('draw it, as in time="last".', "draw it, as in --time last (flags of flowtex show in a"),
        ('as in level=1, or mask="lsm"', "with the control Plane, or --mask lsm (flags of flowtex"),
        ("add ds.assign_coords(x=...)", "add ds.assign_coords(x=...). In Python ds is xarray."),
        ("the file is damaged", "the file is damaged"),
    ],
)
def test_errors_of_a_page_name_its_controls_or_flags(text: str, words: str) -> None:
    shown = error_for_page(text, FLAGS, {"level": "Plane"})
    assert shown.startswith(words)
    if text == words:
        assert shown == text
