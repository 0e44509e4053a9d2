"""Builds that fail, and places where somebody else builds or has built."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from threading import Thread
from threading import enumerate as threads
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.field.steps import LazySteps
from flowtex.pyramid import PyramidError, build, open_store, tasks, verify
from flowtex.pyramid.build import MOST_FAILURES

zarr = pytest.importorskip("zarr")


def series(rows: int = 15, columns: int = 20) -> FlowField:
    """A flow that turns around from step to step, closed around along i."""
    y, x = np.mgrid[0:rows, 0:columns] / 100
    steps = [np.stack([np.cos(3 * y + t), np.sin(4 * x - t)], axis=-1) for t in range(3)]
    return FlowField.from_arrays(
        np.stack([x, y], axis=-1),
        np.stack(steps),
        times=range(3),
        periodic="",
        scalars={"heat": x + np.arange(3)[:, None, None]},
        units={"heat": "K"},
    )


def middle(field: FlowField) -> FlowField:
    velocity = np.array(field.velocity)
    velocity[1] *= -3
    return replace(field, velocity=velocity)


def middle_of_late(field: FlowField) -> FlowField:
    changed = middle(field).velocity
    return replace(field, velocity=LazySteps(3, lambda step: np.asarray(changed[step])))


def warmer(field: FlowField) -> FlowField:
    return field.same_flow(scalars={"heat": np.asarray(field.scalars["heat"]) + 1})


OTHERS: list[Any] = [
    middle,
    middle_of_late,
    warmer,
    lambda field: replace(field, units={"heat": "degC"}),
    lambda field: replace(field, time_unit="h"),
    lambda field: replace(field, periodic=(False, True)),
    lambda field: replace(field, points=1.01 * field.points),
]


def test_a_store_of_another_field_is_told(tmp_path: Path) -> None:
    build(series(), tmp_path / "a.zarr", progress=False)
    for other in OTHERS:
        with pytest.raises(PyramidError, match="pyramid of another field"):
            build(other(series()), tmp_path / "a.zarr", progress=False)
    assert build(series(), tmp_path / "a.zarr", progress=False).made == 0
    (tmp_path / "a.zarr/page.html").write_text("<p>")  # no part of the store, and left alone
    fresh = build(middle_of_late(series()), tmp_path / "a.zarr", fresh=True, progress=False)
    assert (tmp_path / "a.zarr/page.html").exists() and fresh.made and not fresh.kept
    assert build(middle_of_late(series()), tmp_path / "a.zarr", progress=False).made == 0


def test_a_build_writes_into_no_folder_of_other_data(tmp_path: Path) -> None:
    """Such as that of an OpenFOAM case, whose first time is a folder "0"."""
    case = tmp_path / "case"
    (case / "0").mkdir(parents=True)
    (case / "0/U").write_text("internalField uniform (1 0 0);")
    (case / "case.foam").touch()
    before = sorted(case.rglob("*"))
    for fresh in (False, True):
        with pytest.raises(
            PyramidError, match=r"case contains other data \(0, case.foam\); expected"
        ):
            build(series(), case, progress=False, fresh=fresh)
    assert sorted(case.rglob("*")) == before
    (tmp_path / "file.zarr").touch()
    with pytest.raises(PyramidError, match=r"file.zarr is a file; expected a new or empty"):
        build(series(), tmp_path / "file.zarr", progress=False)
    for text in ("notes", '{"zarr_format": 3, "node_type": "group", "attributes": {"of": "me"}}'):
        (tmp_path / "group").mkdir(exist_ok=True)
        (tmp_path / "group/zarr.json").write_text(text)
        for fresh in (False, True):
            with pytest.raises(PyramidError, match=r"group contains other data \(zarr.json\)"):
                build(series(), tmp_path / "group", progress=False, fresh=fresh)
        assert (tmp_path / "group/zarr.json").read_text() == text
    (tmp_path / "empty").mkdir()
    build(series(), tmp_path / "empty", progress=False)


def test_a_full_disk_is_told_and_a_build_goes_on_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write = zarr.storage.LocalStore.set

    async def full(store: Any, key: str, value: Any) -> None:
        raise OSError(28, "No space left on device", str(tmp_path / key))

    async def full_for_shards(store: Any, key: str, value: Any) -> None:
        await (full if "/c/" in key else write)(store, key, value)

    for refused in (full, full_for_shards):
        monkeypatch.setattr(zarr.storage.LocalStore, "set", refused)
        with pytest.raises((OSError, PyramidError), match="No space left on device"):
            build(series(), tmp_path / "a.zarr", progress=False)
    monkeypatch.setattr(zarr.storage.LocalStore, "set", write)
    build(series(), tmp_path / "a.zarr", progress=False)
    assert verify(tmp_path / "a.zarr", progress=False) == []


def test_scalars_whose_names_are_none_of_arrays(tmp_path: Path) -> None:
    field = series()
    scalars = dict.fromkeys(("c", "a b%"), field.scalars["heat"])
    named = field.same_flow(scalars=scalars, units={})
    build(named, tmp_path / "a.zarr", progress=False)
    for values in open_store(tmp_path / "a.zarr").scalars.values():
        np.testing.assert_allclose(values[2], field.scalars["heat"][2], rtol=1e-6)
    with pytest.raises(FieldError, match="scalar 'a/b' cannot be stored"):
        unnamable = field.same_flow(scalars={"a/b": field.scalars["heat"]})
        build(unnamable, tmp_path / "d", progress=False)
    assert not (tmp_path / "d").exists()


def test_build_stops_after_many_failures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tried = []

    def full(*given: Any) -> None:
        if given[2].step:  # the first one comes alone
            tried.append(given)
            msg = "no space left"
            raise OSError(msg)

    monkeypatch.setattr(tasks, "write_part", full)
    ends, steps = (np.arange(20), np.arange(15)), np.arange(300)
    many = FlowField.from_arrays(ends, np.ones((300, 15, 20, 2)), times=steps, periodic="")
    failed = rf"{MOST_FAILURES} in a row shards could not be built .* OSError: no space left"
    with pytest.raises(PyramidError, match=failed):
        build(many, tmp_path / "a.zarr", progress=False)
    assert not [one for one in threads() if one.name.startswith("flowtex-pyramid")]
    assert len(tried) <= tasks.MOST_TRIALS * (MOST_FAILURES + 4 * tasks.Threads().count(1))


class Refusing(BaseHTTPRequestHandler):
    """Object storage that repeats what it was sent, as S3 does for a wrong signature."""

    def answer(self) -> None:
        body = b"<CanonicalRequest>x-amz-security-token:HIDDEN</CanonicalRequest>"
        self.send_response(403)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    do_GET = do_PUT = do_POST = answer

    def log_message(self, *_: Any) -> None:
        """Say nothing."""


@pytest.fixture
def refusing(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    server = HTTPServer(("127.0.0.1", 0), Refusing)
    Thread(target=server.serve_forever, daemon=True).start()
    words = {"ENDPOINT_URL": f"http://127.0.0.1:{server.server_port}", "REGION": "us-east-1"}
    words |= {"ACCESS_KEY_ID": "me", "SECRET_ACCESS_KEY": "HIDDEN", "SESSION_TOKEN": "HIDDEN"}
    for name, value in words.items():
        monkeypatch.setenv(f"AWS_{name}", value)
    yield
    server.shutdown()
    server.server_close()


@pytest.mark.usefixtures("refusing")
def test_what_object_storage_says_is_not_repeated() -> None:
    pytest.importorskip("obstore")
    with pytest.raises(PyramidError, match="access is denied") as caught:
        build(series(), "s3://flows/a.zarr", progress=False)
    assert "HIDDEN" not in str(caught.value) and caught.value.__suppress_context__
