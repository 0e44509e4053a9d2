"""Slices that are saved and opened again."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zarr
from flows import scattered_gyre

import flowtex
from flowtex import FieldError, FlowField, TraceSlices, trace
from flowtex.examples import double_gyre_field, vortex_field
from flowtex.trace.slices import NODE_AXES

FLOWS: dict[str, Callable[[], TraceSlices]] = {
    "steady": lambda: trace(double_gyre_field(shape=(21, 41)), lags=[0.25, 1.0, 4.0]),
    "varying": lambda: trace(vortex_field().downsample(4), lags=[0.5, 1.0], steps=[0, 2]),
    "one side": lambda: trace(double_gyre_field(shape=(11, 21)), lags=[1.0], two_sided=False),
    "triangles": lambda: trace(scattered_gyre(), lags=[0.5, 1.0]),
}


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Slices that were saved once, and that no test changes."""
    path = tmp_path_factory.mktemp("slices") / "gyre.zarr"
    FLOWS["steady"]().save(path)
    return path


@pytest.fixture
def folder(saved: Path, tmp_path: Path) -> Path:
    """Return a copy of the saved slices."""
    return Path(shutil.copytree(saved, tmp_path / "gyre.zarr"))


@pytest.mark.parametrize("kind", FLOWS)
def test_opened_slices_have_every_bit(kind: str, tmp_path: Path) -> None:
    slices = FLOWS[kind]()
    slices.save(tmp_path / "flow.zarr")
    opened = TraceSlices.open(tmp_path / "flow.zarr")
    for field in fields(TraceSlices):
        before = getattr(slices, field.name)
        after = getattr(opened, field.name)
        if isinstance(before, np.ndarray):
            assert (after.dtype, after.shape) == (before.dtype, before.shape)
            assert after.tobytes() == before.tobytes()
        else:
            assert after == before


def test_values_that_are_no_numbers_are_kept(tmp_path: Path) -> None:
    slices = FLOWS["steady"]()
    reach = slices.reach.copy()
    reach[0, 0, :3] = np.nan, np.inf, -0.0
    replace(slices, reach=reach).save(tmp_path / "flow.zarr")
    assert TraceSlices.open(tmp_path / "flow.zarr").reach.tobytes() == reach.tobytes()


def test_attributes_describe_the_slices(folder: Path) -> None:
    about: Any = zarr.open_group(folder, mode="r").attrs["flowtex"]
    assert about["format"] == "flowtex-slices-1"
    assert (about["parameter"], about["shape"]) == ("arclength", [21, 41])
    assert (about["lags"], about["times"]) == ([0.25, 1.0, 4.0], [0.0])
    assert about["tolerance"] == 1e-3
    assert len(about["surface"]) == 32


def test_zarr_alone_reads_the_arrays(folder: Path) -> None:
    group: Any = zarr.open_group(folder, mode="r")
    np.testing.assert_array_equal(group["displacement"][...], FLOWS["steady"]().displacement)


def test_saving_again_replaces_slices_and_nothing_else(folder: Path) -> None:
    FLOWS["one side"]().save(folder)
    assert TraceSlices.open(folder).shape == (11, 21)
    other = folder.with_name("notes")
    other.mkdir()
    (other / "diary.txt").write_text("dear diary", encoding="utf-8")
    for place in (other, other / "diary.txt"):
        with pytest.raises(FieldError, match="contains no trace slices; choose another name"):
            FLOWS["one side"]().save(place)
    assert (other / "diary.txt").read_text(encoding="utf-8") == "dear diary"
    assert sorted(path.name for path in folder.parent.iterdir()) == ["gyre.zarr", "notes"]


# --- drawing --------------------------------------------------------------------------------


@pytest.mark.parametrize("field", [double_gyre_field(shape=(21, 41)), scattered_gyre()])
def test_picture_of_opened_slices_is_the_same(field: FlowField, tmp_path: Path) -> None:
    trace(field).save(tmp_path / "flow.zarr")
    opened = TraceSlices.open(tmp_path / "flow.zarr")
    options: dict[str, Any] = {"size": (160, 120), "samples": 7}
    expected = flowtex.render(field, slices=trace(field), **options)
    np.testing.assert_array_equal(flowtex.render(field, slices=opened, **options), expected)
    other = flowtex.render(field, slices=trace(field, lags=[0.01, 0.02]), **options)
    assert not np.array_equal(other, expected)


def test_plotter_draws_opened_slices(folder: Path) -> None:
    import pyvista as pv

    field = double_gyre_field(shape=(21, 41))
    opened = TraceSlices.open(folder)
    plotter: Any = pv.Plotter(off_screen=True)
    handle = plotter.flowtex.add(field, slices=opened)
    assert handle.scene.store.at(0).displacement.tobytes() == opened.displacement.tobytes()
    plotter.close()


def test_widget_sends_opened_slices(folder: Path) -> None:
    from flowtex.scene.scene import Scene

    field = double_gyre_field(shape=(21, 41))
    scene = Scene.of(field, slices=TraceSlices.open(folder))
    assert scene.store.lags.tolist() == [0.25, 1.0, 4.0]
    beside = scene.beside({"samples": 5})
    assert beside.store.lags.tolist() == [0.25, 1.0, 4.0]
    assert len(scene.beside({"parameter": "time"}).store.lags) > 3


def faster_gyre() -> FlowField:
    field = double_gyre_field(shape=(21, 41))
    return FlowField.from_arrays(field.points, 2 * field.velocity[0])


@pytest.mark.parametrize(
    ("field", "expected"),
    [
        (double_gyre_field(shape=(11, 21)), "21, 41. nodes and the field .11, 21"),
        (faster_gyre(), "another velocity at time step 0"),
    ],
)
def test_slices_of_another_flow_raise(field: FlowField, expected: str, folder: Path) -> None:
    with pytest.raises(FieldError, match=expected):
        flowtex.render(field, slices=TraceSlices.open(folder), size=(40, 30))


def test_slices_of_another_surface_raise(folder: Path) -> None:
    field = double_gyre_field(shape=(21, 41))
    moved = FlowField.from_arrays(2 * field.points, field.velocity)
    with pytest.raises(FieldError, match="another surface"):
        flowtex.render(moved, slices=TraceSlices.open(folder), size=(40, 30))


def test_slices_of_another_kind_raise() -> None:
    with pytest.raises(FieldError, match=r"slices is 'gyre\.zarr'; expected TraceSlices"):
        flowtex.render(double_gyre_field(), slices="gyre.zarr", size=(40, 30))


# --- folders that are not as they were written ----------------------------------------------


def changed(folder: Path, **changes: Any) -> None:
    """Change attributes of a group."""
    document = json.loads((folder / "zarr.json").read_text(encoding="utf-8"))
    document["attributes"]["flowtex"].update(changes)
    (folder / "zarr.json").write_text(json.dumps(document), encoding="utf-8")


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"format": "flowtex-slices-9"}, "format 'flowtex-slices-9'; expected 'flowtex-slices-1'"),
        ({"shape": [21, True]}, r"damaged \(shape\)"),
        ({"shape": [10**8, 10**8]}, r"damaged \(shape\)"),
        ({"lags": [1.0, 0.5, 4.0]}, r"damaged \(lags\)"),
        ({"lags": [1.0, float("nan"), 4.0]}, r"damaged \(lags\)"),
        ({"parameter": "space"}, r"damaged \(parameter\)"),
        ({"arrays": {"unit": "float64"}}, r"damaged \(arrays\)"),
        ({"arrays": dict.fromkeys(NODE_AXES, "object")}, r"damaged \(arrays\)"),
        ({"velocities": ["a", "b"]}, r"damaged \(velocities\)"),
        ({"shape": [10**4, 10**4]}, "declares .* of memory are available"),
        ({"shape": [22, 41]}, "the array .* is damaged"),
        ({"arrays": dict.fromkeys(NODE_AXES, "float32")}, "the array .* is damaged"),
    ],
)
def test_changed_attributes_raise(
    changes: dict[str, Any], expected: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flowtex._util.memory.available_bytes", lambda: 1_000_000_000)
    changed(folder, **changes)
    with pytest.raises(FieldError, match=expected):
        TraceSlices.open(folder)


def test_missing_and_changed_chunks_raise(folder: Path) -> None:
    chunk = next(path for path in (folder / "reach" / "c").rglob("*") if path.is_file())
    data = bytearray(chunk.read_bytes())
    data[-6] ^= 255
    chunk.write_bytes(data)
    with pytest.raises(FieldError, match=r"the array reach .* is damaged"):
        TraceSlices.open(folder)
    chunk.unlink()
    with pytest.raises(FieldError, match="1 of 1 chunks are missing"):
        TraceSlices.open(folder)


def test_codecs_of_a_store_are_never_used(folder: Path) -> None:
    """A document may name a codec that unpickles; arrays are read as they were written."""
    path = folder / "unit" / "zarr.json"
    document = json.loads(path.read_text(encoding="utf-8"))
    document["codecs"] = [{"name": "numcodecs.pickle", "configuration": {}}]
    path.write_text(json.dumps(document), encoding="utf-8")
    expected = FLOWS["steady"]().unit
    np.testing.assert_array_equal(TraceSlices.open(folder).unit, expected)


def test_other_places_raise(tmp_path: Path, folder: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"expected slices from TraceSlices.save"):
        TraceSlices.open(tmp_path / "missing.zarr")
    zarr.create_group(tmp_path / "other.zarr")
    with pytest.raises(FieldError, match="contains no trace slices"):
        TraceSlices.open(tmp_path / "other.zarr")
    shutil.copy(folder / "zarr.json", tmp_path / "file.zarr")
    with pytest.raises(FieldError, match="contains no trace slices"):
        TraceSlices.open(tmp_path / "file.zarr")


def test_missing_zarr_names_the_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    slices = FLOWS["one side"]()
    monkeypatch.setitem(sys.modules, "zarr", None)
    for call in (slices.save, TraceSlices.open):
        with pytest.raises(ModuleNotFoundError, match=r"zarr is missing; install it with .*store"):
            call(tmp_path / "flow.zarr")
