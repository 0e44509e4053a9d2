"""Two builders at one store: one continues, the other says so."""

from __future__ import annotations

import json
import platform
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.pyramid import PyramidError, build, places
from flowtex.pyramid.places import BUILDING, building

zarr = pytest.importorskip("zarr")


@pytest.fixture(params=["folder", "objects"])
def place(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A folder, and storage that writes on a condition."""
    if request.param == "objects":
        memory = pytest.importorskip("obstore.store").MemoryStore()
        monkeypatch.setattr(places, "store_at", lambda *_, **__: zarr.storage.ObjectStore(memory))
    return str(tmp_path / "flow.zarr")


def test_second_build_is_refused_until_first_ends(place: str) -> None:
    told = r"is being built by process \d+ on .*delete building"
    with building(place), pytest.raises(PyramidError, match=told), building(place):
        pass
    with building(place):
        pass


def mark(folder: Path, process: int, host: str) -> None:
    told = {"id": "another", "process": process, "host": host}
    (folder / BUILDING).write_text(json.dumps(told))


def test_mark_of_ended_process_is_removed(tmp_path: Path) -> None:
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    mark(tmp_path, ended.pid, platform.node())
    with building(str(tmp_path)):
        assert (tmp_path / BUILDING).exists()
    mark(tmp_path, ended.pid, "elsewhere")
    with pytest.raises(PyramidError, match="on elsewhere"), building(str(tmp_path)):
        pass


@pytest.mark.parametrize("text", ["", "{", "[]", "1"])
def test_unreadable_mark_is_removed(tmp_path: Path, text: str) -> None:
    (tmp_path / BUILDING).write_text(text)
    with building(str(tmp_path)):
        pass
    assert not (tmp_path / BUILDING).exists()


def field() -> FlowField:
    y, x = np.mgrid[0:10, 0:12] / 10
    return FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack([1 + y, x], axis=-1))


@pytest.fixture
def builders(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """Have a second builder begin while the first is at its tiles; it gives what that one says."""
    module, said = sys.modules["flowtex.pyramid.build"], list[str]()
    make: Any = module.make_tile

    def slow(place: str, *given: Any) -> None:
        with pytest.raises(PyramidError) as caught:
            build(field(), place, progress=False)
        said.append(str(caught.value))
        make(place, *given)

    monkeypatch.setattr(module, "make_tile", slow)
    yield said


def test_one_of_two_builders_goes_on(tmp_path: Path, builders: list[str]) -> None:
    build(field(), tmp_path / "a.zarr", progress=False)
    assert len(builders) == 1 and "is being built by process" in builders[0]
    assert build(field(), tmp_path / "a.zarr", progress=False).made == 0
    assert not (tmp_path / "a.zarr" / BUILDING).exists()
