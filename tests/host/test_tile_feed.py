"""Tiles that a client asks the kernel for."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from heard import Heard
from waiting import PATIENCE_S

from flowtex._util.progress import check
from flowtex.host.flow_widget import FlowWidget
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.grid_pyramid import GridPyramid


def swirl(times: int = 1) -> Any:
    """A vortex that wanders, and nothing in a corner."""
    import flowtex

    y, x = np.mgrid[-1:1:76j, -1:1:151j]
    steps = np.stack([np.stack([-(y - 0.1 * t), x], axis=-1) for t in range(times)])
    steps[:, :73, :73] = np.nan
    points = np.stack([x, y], axis=-1)
    return flowtex.FlowField.from_arrays(points, steps, scalars={"depth": x * x + y})


@pytest.fixture
def make(monkeypatch: pytest.MonkeyPatch, small_tiles: None) -> Iterator[Callable[..., Heard]]:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 1250)
    for name in ("COARSE_STEADY", "COARSE_VARYING"):
        monkeypatch.setattr(f"flowtex.host.feed.{name}", 400)
    made: list[FlowWidget] = []

    def call(field: Any, **options: Any) -> Heard:
        made.append(FlowWidget(field, samples=9, **options))
        client = Heard(made[-1], monkeypatch)
        client.say(kind="ready")
        client.wait(lambda: bool(client.header["pyramid"]))
        return client

    yield call
    for widget in made:
        widget.close()


def test_tiles_come_with_all_that_draws_them(make: Callable[..., Heard]) -> None:
    client = make(swirl(2), scalars="speed", clim=(0.0, 1.0))
    pyramid = client.header["pyramid"]
    assert pyramid["depth"] == 2
    assert pyramid["shapes"] == [[76, 151], [39, 76], [20, 39]]
    client.load((0, 0, 1), 0, 1)
    client.load((0, 0, 0), 0, 1)
    own = json.loads(client.arrays["tile/0/0/1/header"].tobytes())
    rows, columns = own["geometry"]["shape"]
    assert (rows, columns) == (65, 65)
    nodes = tuple(own["slices"]["trace"]["nodes"])
    assert client.arrays["tile/0/0/1/flow/1"].shape[:2] == nodes
    assert client.arrays["tile/0/0/1/padded"].shape == (nodes[0] + 2, nodes[1] + 2, 3)
    speed = swirl(2).speed[1, :65, 64:129]
    np.testing.assert_allclose(client.arrays["tile/0/0/1/scalars/1"], speed, rtol=1e-6)
    # Of a tile without cells there is nothing to draw.
    assert client.arrays["tile/0/0/0/header"].tobytes() == b"null"
    assert "tile/0/0/0/position" not in client.arrays


def test_marks_are_made_when_they_are_asked_for(make: Callable[..., Heard]) -> None:
    client = make(swirl(2))
    assert client.header["structure"]["parts"] == ["critical", "separatrices", "nullclines"]
    assert not any(name.startswith("critical") for name in client.arrays)
    message = {"kind": "load", "key": None, "steps": [1], "view": 0, "mark": "critical"}
    client.say(**{**message, "request": "marks", "mark": "other"})
    client.say(**message, request="marks")
    client.wait(lambda: "marks" in client.loaded)
    (row,) = client.arrays["critical/1"]
    assert client.header["structure"]["kinds"][int(row[3])]["name"] == "centre"
    assert row[:2] + client.header["geometry"]["center"][:2] == pytest.approx([0, 0.1], abs=1e-3)
    assert "separatrices/1" not in client.arrays


@pytest.mark.threads
def test_what_is_given_up_is_neither_made_nor_sent(
    make: Callable[..., Heard], monkeypatch: pytest.MonkeyPatch
) -> None:
    client = make(swirl())
    client.load((1, 0, 1), 0)
    client.load((1, 0, 1), 0)  # a client that has dropped it asks again
    assert client.order.count("tile/1/0/1/header") == 2
    began, go = threading.Event(), threading.Event()
    textures = GridPyramid.region

    def slow(*arguments: Any) -> Any:
        began.set()
        assert go.wait(PATIENCE_S)
        check()
        return textures(*arguments)

    monkeypatch.setattr(GridPyramid, "region", slow)
    client.ask("dropped", (1, 0, 0), 0)
    assert began.wait(PATIENCE_S)
    client.say(kind="drop", request="dropped")
    go.set()
    client.load((0, 0, 1), 0)
    client.load((1, 0, 0), 0)  # the first has made nothing
    assert client.order.count("tile/1/0/0/header") == 1
    assert "dropped" not in client.loaded
    assert client.errors == []


def test_tiles_in_other_colours_are_the_same(
    make: Callable[..., Heard], monkeypatch: pytest.MonkeyPatch
) -> None:
    client = make(swirl(), cmap="magma")
    client.load((0, 0, 1), 0)
    before, generation = client.arrays.copy(), client.header["generation"]
    tile = "tile/0/0/1"
    monkeypatch.setattr(TextureSet, "layers", None)
    scene = client.widget.scene
    scene.appearance = replace(scene.appearance, scalars="depth", clim=(0.0, 3.0))
    client.wait(lambda: "scalars/0/1" in client.arrays)
    client.load((0, 0, 1), 0)
    assert (client.header["scalars"]["name"], client.header["generation"]) == ("depth", generation)
    depth = swirl().scalars["depth"][0, :65, 64:129]
    np.testing.assert_allclose(client.arrays[f"{tile}/scalars/0/1"], depth, rtol=1e-6)
    assert client.arrays["scalars/0/1"].shape == before["scalars/0"].shape
    same = (client.arrays[f"{tile}/flow/0"], before[f"{tile}/flow/0"])
    np.testing.assert_array_equal(*same)
    np.testing.assert_array_equal(client.arrays[f"{tile}/mesh"], before[f"{tile}/mesh"])
    assert client.errors == []


def test_errors_are_told_to_who_asked(
    make: Callable[..., Heard], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    client = make(swirl())

    def fail(*arguments: Any) -> None:
        msg = "the disk is gone"
        raise OSError(msg)

    with monkeypatch.context() as patch:
        patch.setattr(GridPyramid, "region", fail)
        client.load((1, 0, 1), 0)
    assert "disk is gone" in capsys.readouterr().err
    client.load((1, 0, 1), 0)
    assert client.errors == ["OSError: the disk is gone"]
    assert "tile/1/0/1/header" in client.order
    client.load((7, 0, 0), 0)
    client.load(None, 9)
    assert [error.split(":")[0] for error in client.errors[1:]] == ["KeyError", "IndexError"]
