"""Files that are read in their own process: the same fields, and what becomes of bad ends."""

from __future__ import annotations

import gc
import logging
import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
import xarray as xr
from cfd_files import CGNS, TIMES, box
from child_handler import is_gone
from earth_data import winds
from lying_files import write_crashing
from waiting import wait_until

from flowtex import FlowField, examples
from flowtex._util.child.child import Child
from flowtex._util.progress import Stopped, stoppable
from flowtex.errors import FieldError, Notice
from flowtex.field.steps import LazySteps
from flowtex.sources.open_source import open_source
from flowtex.sources.remote import (
    CHOICES,
    Reader,
    RemoteSource,
    open_remote,
    pack_field,
    unpack_field,
)

TIP, BODY = box(4, 3, 2), box(6, 3, 2, 3.0)


def volume(path: Path) -> Path:
    """A volume, whose planes are to be chosen."""
    x, y, z = np.meshgrid(np.arange(7.0), np.arange(6.0), np.arange(5.0), indexing="ij")
    mesh = pv.StructuredGrid(x, y, z)
    mesh["wind"] = np.tile([1.0, 0.5, 0.0], (mesh.n_points, 1))
    mesh["water"] = np.tile([0.0, 2.0, 0.0], (mesh.n_points, 1))
    mesh["height"] = mesh.points[:, 2].copy()
    mesh.save(path)
    return path


def ball(path: Path) -> Path:
    mesh = pv.Sphere(theta_resolution=12, phi_resolution=9)
    mesh["velocity"] = np.cross(mesh.points, [0.0, 0.0, 1.0])
    mesh.save(path)
    return path


def wing(path: Path) -> Path:
    """Two zones at two times each."""
    with CGNS.write(path) as file:
        file.base("Base", [("Tip", TIP), ("Body", BODY)], times=TIMES)
    return path


def weather(path: Path, calendar: str = "noleap") -> Path:
    """Two levels at four times, of a calendar that Python has not."""
    ds = winds(np.arange(-180.0, 180.0, 20.0), np.arange(-80.0, 81.0, 20.0))
    ds = xr.concat([ds, 2 * ds], "level", coords="minimal", join="exact")
    ds = xr.concat([ds, 2 * ds, 3 * ds, 4 * ds], "time", coords="minimal", join="exact")
    for name, word in (("u", "eastward"), ("v", "northward")):
        ds[name].attrs = {"standard_name": f"{word}_wind", "units": "m/s"}
    units = {"units": "days since 2001-02-27", "calendar": calendar}
    ds = ds.assign_coords(
        level=("level", [200.0, 850.0], {"units": "hPa"}), time=("time", np.arange(4.0), units)
    )
    ds.to_netcdf(path)
    return path


def assert_same(one: FlowField, other: FlowField) -> None:
    for name in ("points", "velocity", "times", "valid"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), strict=False)
    for name in ("has_position", "triangles"):
        arrays = getattr(one, name), getattr(other, name)
        assert (arrays[0] is None) == (arrays[1] is None)
        assert arrays[0] is None or np.array_equal(*arrays)
    for name in ("periodic", "name", "length_unit", "time_unit", "sign_free", "units"):
        assert getattr(one, name) == getattr(other, name)
    assert one.long_names == other.long_names and one.projection == other.projection
    assert str(one.start) == str(other.start) and one.scalars.keys() == other.scalars.keys()
    for name, values in one.scalars.items():
        np.testing.assert_array_equal(values, other.scalars[name])
    assert isinstance(one.velocity, LazySteps) == isinstance(other.velocity, LazySteps)


@pytest.mark.parametrize(
    ("name", "write", "chosen"),
    [
        ("block.vts", volume, [{}, {"plane": "i=3", "vectors": "water"}, {"plane": "x=2.5"}]),
        ("ball.vtp", ball, [{}]),
        ("wing.cgns", wing, [{}, {"block": "Base/Body", "plane": "j=1"}]),
        ("weather.nc", weather, [{}, {"plane": "level=0", "block": "globe"}]),
        ("dates.nc", partial(weather, calendar="standard"), [{"block": "mercator"}]),
    ],
)
def test_what_another_process_reads_is_the_same(
    tmp_path: Path, name: str, write: Callable[[Path], Path], chosen: list[dict[str, str]]
) -> None:
    path = write(tmp_path / name)
    here, there = open_source(path), open_remote([path])
    assert all(getattr(there, name) == getattr(here, name) for name in CHOICES)
    for block in here.blocks:
        one, other = there.part(block), here.part(block)
        assert one.planes == other.planes and one.default_plane == other.default_plane
        assert one.vectors == other.vectors
    for options in chosen:
        assert_same(there.field(**options), here.field(**options))
    with pytest.raises(FieldError, match=r"expected one of|does not exist"):
        there.field(vectors="nothing,at all" if name.endswith(".nc") else "nothing")
    assert there.alive
    there.close()


def test_several_files_are_one_series(tmp_path: Path) -> None:
    ds = xr.open_dataset(weather(tmp_path / "all.nc", "standard"))
    paths = [tmp_path / f"winds_{n}.nc" for n in range(2)]
    for n, path in enumerate(paths):
        ds.isel(time=slice(2 * n, 2 * n + 2)).to_netcdf(path)
    source = open_remote(paths)
    assert source.name == "winds" and len(source.field().times) == 4


def tricky(path: Path, monkeypatch: pytest.MonkeyPatch, kind: str = "Tricky") -> RemoteSource:
    monkeypatch.setattr("flowtex.sources.remote.READER", f"child_handler:{kind}Reader")
    return open_remote([path])


def test_a_reader_that_dies_is_told_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = volume(tmp_path / "block.vts")
    source = tricky(path, monkeypatch)
    fault = rf"^{re.escape(str(path))}: the reader of this file crashed \(SIGSEGV\); it is "
    field = source.field()
    with pytest.raises(
        FieldError, match=fault + r"damaged, or needs more than [\d.]+ GB of memory"
    ):
        source._file.ask("trick", level="crash")
    with pytest.raises(FieldError, match=fault):
        source.field()
    assert not source.alive and field.speed.max() > 1
    monkeypatch.setattr("flowtex.sources.meshes.separate.REQUEST_TIMEOUT_S", 20.0)
    source = tricky(path, monkeypatch)
    pid, _ = source._file.ask("trick", level="")
    source._file._timeout = 0.2
    with pytest.raises(FieldError, match=r"block\.vts: the reader of this file did not end within"):
        source._file.ask("trick", level="hang")
    wait_until(lambda: is_gone(pid))


def test_a_reader_that_needs_too_much_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = volume(tmp_path / "block.vts")
    with pytest.raises(
        FieldError, match=r"block\.vts: the reader of this file needs more than [\d.]+ GB"
    ):
        tricky(path, monkeypatch, "Greedy")


def test_a_reader_that_fails_and_one_that_warns(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    source = tricky(volume(tmp_path / "block.vts"), monkeypatch)
    with (
        caplog.at_level(logging.ERROR),
        pytest.raises(FieldError, match=r"block\.vts: cannot be read: '"),
    ):
        source._file.ask("trick", level="fail")
    assert "do_trick" in caplog.text and "\x1b" not in caplog.text
    with pytest.warns(Warning) as caught:
        source._file.ask("trick", level="warn")
    assert [(w.category, str(w.message)) for w in caught] == [
        (Notice, "something was chosen"),
        (UserWarning, "odd"),
    ]


def test_steps_are_read_later_by_the_process_that_has_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = tricky(weather(tmp_path / "weather.nc"), monkeypatch)
    pid, _ = source._file.ask("trick", level="")
    field = source.field()
    del source
    gc.collect()
    assert not is_gone(pid)
    assert np.allclose(field.velocity[3], 2 * field.velocity[1])
    with pytest.raises(Stopped), stoppable(lambda: True):
        field.velocity[0]
    with pytest.raises(FieldError, match=r"weather\.nc: the reader of this file crashed"):
        field.velocity[2]
    assert np.isfinite(field.velocity[3]).all(), "what was read stays"
    wait_until(lambda: is_gone(pid))


def test_the_process_ends_with_what_needs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = tricky(weather(tmp_path / "weather.nc"), monkeypatch)
    pid, _ = source._file.ask("trick", level="")
    part, field = source.part("globe"), source.field()
    del source, part
    gc.collect()
    assert not is_gone(pid)
    del field
    gc.collect()
    wait_until(lambda: is_gone(pid))


def test_reader_forgets_steps_that_are_no_longer_used(tmp_path: Path) -> None:
    reader = Reader()
    reader({"do": "open", "paths": [str(weather(tmp_path / "weather.nc"))]})
    first, second = (
        reader({"do": "field"})[0]["value"]["arrays"]["velocity"]["steps"] for _ in range(2)
    )
    reader({"do": "step", "steps": second, "number": 1, "forgotten": [first]})
    with pytest.raises(KeyError):
        reader({"do": "step", "steps": first, "number": 1})


# --- files that change ------------------------------------------------------------------------


def test_a_file_that_changes_while_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, left = volume(tmp_path / "block.vts"), tmp_path / "block.count"
    left.write_text("2")
    source = tricky(path, monkeypatch, "Changing")
    assert left.read_text() == "0" and source.field().shape == (6, 7)
    left.write_text("9")
    with pytest.raises(FieldError, match=r"block\.vts: the file changed while it was read; open"):
        tricky(path, monkeypatch, "Changing")
    assert left.read_text() == "6"


def test_what_is_read_late_of_a_file_that_has_changed_is_refused(tmp_path: Path) -> None:
    path = weather(tmp_path / "weather.nc")
    source = open_remote([path])
    field = source.field()
    path.with_suffix(".other").write_bytes(path.read_bytes())
    path.with_suffix(".other").replace(path)
    for late in (source.field, lambda: field.velocity[0]):
        with pytest.raises(FieldError, match=r"weather\.nc: the file has changed since it was op"):
            late()
    held = volume(tmp_path / "block.vts")
    source = open_remote([held])
    held.unlink()
    assert source.field(plane="k=1").shape == (6, 7), "it is in memory"


# --- broken files -----------------------------------------------------------------------------


def test_a_file_whose_reader_crashes_takes_nobody_along(tmp_path: Path) -> None:
    path = tmp_path / "torn.case"
    write_crashing(path)
    with pytest.raises(FieldError, match=f"^{re.escape(str(path))}: the reader .* crashed"):
        open_remote([path])


# --- answers that make no sense ---------------------------------------------------------------


def packed(field: FlowField) -> tuple[dict[str, Any], list[Any]]:
    return pack_field(field, lambda _: 0)


def unpacked(value: Any, arrays: Any) -> FlowField:
    return unpack_field(value, arrays, lambda _: lambda _: np.zeros(0))


@pytest.mark.parametrize(
    ("name", "change", "fault"),
    [
        ("points", lambda a: a[:, :-1], "points is float64 of shape"),
        ("velocity", lambda a: a[..., :2], "velocity is float64"),
        ("velocity", lambda a: a.astype(int), "velocity is int64"),
        ("valid", lambda a: a.astype(float), "valid is float64"),
        ("triangles", lambda a: a + 9, "triangles have nodes 9 to"),
        ("triangles", lambda a: a - 1, "triangles have nodes -1 to"),
        ("triangles", lambda a: a[:, :2], "triangles is int64"),
        ("times", lambda a: a[:0], "velocity is float64"),
    ],
)
def test_arrays_that_do_not_fit_together_are_refused(
    tmp_path: Path, name: str, change: Callable[[Any], Any], fault: str
) -> None:
    field = FlowField.from_pyvista(pv.read(ball(tmp_path / "ball.vtp")))
    value, arrays = packed(field)
    assert_same(unpacked(value, arrays), field)
    at = value["arrays"][name]
    arrays[at] = change(arrays[at])
    with pytest.raises(ValueError, match=fault):
        unpacked(value, arrays)


@pytest.mark.parametrize(
    "answer", [None, {}, {"value": {}, "warnings": []}, {"value": {"periodic": 1}, "warnings": []}]
)
def test_an_answer_that_makes_no_sense_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answer: Any
) -> None:
    source = open_remote([volume(tmp_path / "block.vts")])
    monkeypatch.setattr(Child, "request", lambda *_, **__: (answer, []))
    with pytest.raises(FieldError, match=r"block\.vts: the reader of this file sent a malformed"):
        source.field()
    with pytest.raises(FieldError, match=r"block\.vts: the reader of this file sent a malformed"):
        open_remote([tmp_path / "block.vts"])


def test_steps_that_are_too_few_are_refused() -> None:
    value, arrays = packed(examples.airfoil_field())
    value["arrays"]["velocity"] = {"steps": 1, "count": 7}
    with pytest.raises(ValueError, match="velocity has 7 steps; expected 1"):
        unpacked(value, arrays)
