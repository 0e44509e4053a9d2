"""Two builders at one store: one continues, the other says so."""

from __future__ import annotations

import json
import platform
import subprocess
import sys
from pathlib import Path

import pytest

from flowtex.pyramid import PyramidError, places
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
