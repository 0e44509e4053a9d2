"""Two builders at one store: one continues, the other says so."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.pyramid import PyramidError, build, places
from flowtex.pyramid.places import LEASE, STALE_S, Lease

zarr = pytest.importorskip("zarr")


class Clock:
    """A clock that is set by hand."""

    now = 1000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture(params=["folder", "objects"])
def place(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A folder, and storage that writes on a condition."""
    if request.param == "objects":
        memory = pytest.importorskip("obstore.store").MemoryStore()
        monkeypatch.setattr(places, "store_at", lambda *_, **__: zarr.storage.ObjectStore(memory))
    return str(tmp_path / "flow.zarr")


@pytest.fixture
def clock() -> Clock:
    return Clock()


def test_a_lease_is_held_by_one(place: str, clock: Clock) -> None:
    with Lease(place, clock) as first:
        clock.now += STALE_S / 2
        with pytest.raises(
            PyramidError, match=r"is being built by process \d+ on .*last active 60 s ago"
        ):
            Lease(place, clock).__enter__()
        first.check()
    with Lease(place, clock) as second:
        second.check()


def test_of_two_who_found_none_one_holds_it(
    place: str, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    late = Lease(place, clock)
    read, found = late._read, [dict[str, Any]()]
    monkeypatch.setattr(late, "_read", lambda: found.pop() if found else read())
    with Lease(place, clock) as first:
        with pytest.raises(PyramidError, match="is being built"):
            late.__enter__()
        first.check()


def test_a_lease_that_is_renewed_is_not_stale(place: str, clock: Clock) -> None:
    with Lease(place, clock) as first:
        clock.now += STALE_S - 1
        first.renew()
        clock.now += STALE_S - 1
        with pytest.raises(PyramidError, match="is being built"):
            Lease(place, clock).__enter__()


def test_a_stale_lease_is_taken_over_and_its_holder_stops(place: str, clock: Clock) -> None:
    with Lease(place, clock) as first:
        clock.now += STALE_S + 1
        with Lease(place, clock) as second:
            with pytest.raises(PyramidError, match="was taken over by process"):
                first.check()
            second.check()
            first.__exit__()  # which does not end that of the other
            with pytest.raises(PyramidError, match="is being built"):
                Lease(place, clock).__enter__()


def test_the_lease_of_a_process_that_ended_is_taken_over(tmp_path: Path, clock: Clock) -> None:
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    own = Lease(str(tmp_path), clock)
    told = {**own._identity, "id": "another", "process": ended.pid, "at": clock.now}
    (tmp_path / LEASE).write_text(json.dumps(told))
    with own:
        own.check()


@pytest.mark.parametrize("text", ["", "{", "[]", '{"at": "now"}'])
def test_a_lease_that_was_cut_is_nobodys(tmp_path: Path, clock: Clock, text: str) -> None:
    (tmp_path / LEASE).write_text(text)
    with Lease(str(tmp_path), clock) as own:
        own.check()
    assert not (tmp_path / LEASE).exists()


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
    assert not (tmp_path / "a.zarr" / LEASE).exists()
