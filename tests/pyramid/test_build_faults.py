"""Builds that fail, and places where somebody else builds or has built."""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.field.steps import LazySteps
from flowtex.pyramid import PyramidError, build, open_store, tasks
from flowtex.pyramid.build import MOST_FAILURES
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.workers import Threads
from flowtex.tiles import TileKey

zarr = pytest.importorskip("zarr")


def series(rows: int = 30, columns: int = 40) -> FlowField:
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
    return replace(field, scalars={"heat": [np.asarray(s) + 1 for s in field.scalars["heat"]]})


@pytest.mark.parametrize(
    "other",
    [
        middle,
        middle_of_late,
        warmer,
        lambda field: replace(field, units={"heat": "degC"}),
        lambda field: replace(field, time_unit="h"),
        lambda field: replace(field, periodic=(False, True)),
    ],
)
def test_a_store_of_another_field_is_told(tmp_path: Path, other: Any) -> None:
    build(series(), tmp_path / "a.zarr", progress=False)
    assert build(series(), tmp_path / "a.zarr", progress=False).made == 0
    with pytest.raises(PyramidError, match="pyramid of another field"):
        build(other(series()), tmp_path / "a.zarr", progress=False)


def test_scalars_whose_names_are_none_of_arrays(tmp_path: Path) -> None:
    field = series()
    for name, other in (("c", "heat"), ("a b%", "heat")):
        named = replace(field, scalars={name: field.scalars[other]}, units={})
        build(named, tmp_path / f"{name}.zarr", progress=False)
        root = open_store(tmp_path / f"{name}.zarr")
        np.testing.assert_allclose(root.scalars[name][2], field.scalars[other][2], rtol=1e-6)
    with pytest.raises(FieldError, match="scalar 'a/b' cannot be stored"):
        build(
            replace(field, scalars={"a/b": field.scalars["heat"]}), tmp_path / "d", progress=False
        )
    assert not (tmp_path / "d").exists()


def test_long_and_narrow_roots_are_read_as_they_were_built(tmp_path: Path) -> None:
    y, x = np.mgrid[0:5, 0:12_000] / 100
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack([1 + y, x], axis=-1))
    build(field, tmp_path / "a.zarr", progress=False)
    assert Levels(tmp_path / "a.zarr").tile(TileKey(0, 0, 0), 0).about["size"][1] > 10_000


def test_tasks_that_fail_keep_no_memory() -> None:
    def failing(number: int) -> None:
        data = np.full(1_000_000, number)
        msg = f"no room for {data.nbytes}"
        raise OSError(msg)

    errors = list(Threads().run(failing, [(n,) for n in range(8)], 1))
    gc.collect()
    frames = [error.__traceback__ for error in errors if error is not None]
    assert len(frames) == 8
    for last in frames:
        while last is not None:
            assert "data" not in last.tb_frame.f_locals
            last = last.tb_next


def test_a_build_of_which_all_fails_ends_soon(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flowtex.tiles.pyramid.ROOT_NODES", 1000)
    tried = []

    def full(*given: Any) -> Any:
        tried.append(given)
        msg = "no space left"
        raise OSError(msg)

    monkeypatch.setattr(tasks, "write_part", full)
    many = FlowField.from_arrays(
        (np.arange(40), np.arange(30)), np.ones((300, 30, 40, 2)), times=np.arange(300), periodic=""
    )
    with pytest.raises(PyramidError, match=r"1 of 1 shards .* OSError: no space left"):
        build(series(), tmp_path / "a.zarr", progress=False)
    # The first step comes alone.
    monkeypatch.setattr(tasks, "write_part", lambda *given: given[2].step and full(*given))
    tried.clear()
    with pytest.raises(PyramidError, match=rf"{MOST_FAILURES} in a row shards .* no space left"):
        build(many, tmp_path / "b.zarr", progress=False)
    assert len(tried) < 150


def test_another_builder_has_begun_meanwhile(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One of the finest tiles begins and ends while one of the coarse ones is at work."""
    monkeypatch.setattr("flowtex.tiles.pyramid.ROOT_NODES", 1000)
    store, field, make = tmp_path / "a.zarr", series(), tasks.make_tile
    builder = sys.modules["flowtex.pyramid.build"]

    def slow(*given: Any) -> None:
        monkeypatch.setattr(builder, "make_tile", make)
        build(field, store, levels="all", progress=False)
        make(*given)

    monkeypatch.setattr(builder, "make_tile", slow)
    built = build(field, store, progress=False)
    assert built.depth > 0
    about = Levels(store).about
    assert about["traced"] == list(range(built.depth + 1)) and about["complete"]


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
    with pytest.raises(PyramidError, match="not open to us") as caught:
        build(series(), "s3://flows/a.zarr", progress=False)
    assert "HIDDEN" not in str(caught.value) and caught.value.__suppress_context__
