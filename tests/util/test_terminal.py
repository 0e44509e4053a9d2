from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.table import Table
from strategies import property_test

from flowtex._util.terminal import plain_text, terminal
from flowtex.cli import main
from flowtex.cli.console import complain, say

#: A unit that is a mark-up of rich's, a title of the window, and text that is turned round.
EVIL = "hPa[/dim] [red]x[/] :smile: \x1b]0;owned\x9c \x1b[2J\u202edrow"
WRITTEN = r"hPa[/dim] [red]x[/] :smile: \x1b]0;owned\x9c \x1b[2J\u202edrow"


def test_text_of_data_is_text_wherever_it_is_written(capsys: pytest.CaptureFixture[str]) -> None:
    table = Table(EVIL)
    table.add_row(EVIL)
    console = terminal()
    console.width = 200
    console.print(EVIL, table)
    say((EVIL, "bold"), EVIL)
    complain(ValueError(EVIL))
    out, err = capsys.readouterr()
    assert out.count(WRITTEN) == 5
    assert err.count(WRITTEN) == 1


@property_test(40)
@given(st.text())
def test_no_text_moves_the_cursor(text: str) -> None:
    plain = plain_text(text)
    assert not any(c < " " or "\x7f" <= c <= "\x9f" for c in plain if c not in "\n\t")
    plain.encode()


def test_units_of_a_file_do_not_crash_info(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    xarray = pytest.importorskip("xarray")
    axes = {
        "level": ("level", [500.0, 850.0], {"units": EVIL, "long_name": EVIL}),
        "lat": ("lat", [10.0, 20.0, 30.0], {"units": "degrees_north"}),
        "lon": ("lon", [1.0, 2.0, 3.0], {"units": "degrees_east"}),
    }
    wind = xarray.DataArray([[[1.0] * 3] * 3] * 2, axes, dims=("level", "lat", "lon"))
    wind = wind.assign_attrs(units="m/s", long_name=EVIL)
    path = tmp_path / "wind\x1b[2J.nc"
    xarray.Dataset({"u": wind, "v": wind}).to_netcdf(path)
    assert main(["info", str(path)]) == 0
    assert main(["info", str(tmp_path / "missing\x1b[2J.nc")]) == 2
    out, err = capsys.readouterr()
    assert "hPa[/dim]" in out
    assert r"missing\x1b[2J.nc" in err
    assert "\x1b" not in out + err
