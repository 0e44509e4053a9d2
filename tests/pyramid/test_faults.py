"""Stores that came to harm: what is drawn is right, or coarser and told; nothing else happens."""

from __future__ import annotations

import json
import shutil
import threading
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given
from range_server import RangeServer, range_server
from strategies import property_test
from waiting import PATIENCE_S, wait_until

from flowtex import FlowField
from flowtex._util.array_types import AnyArray
from flowtex.errors import FieldError
from flowtex.pyramid import PyramidError, build, open_store
from flowtex.pyramid.layout import sealed
from flowtex.pyramid.levels import Levels
from flowtex.textures.tiles.loader import TileLoader
from flowtex.textures.tiles.pyramid import Pyramid, TileKey
from flowtex.textures.tiles.shared import shared_pyramid

pytest.importorskip("zarr")

KEYS = [TileKey(1, 0, 0), TileKey(0, 0, 0), TileKey(0, 2, 0)]
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner),
    max_leaves=4,
)


class Drawn(dict[Any, list[AnyArray] | None]):
    """What pictures are made of, by tile."""

    def __repr__(self) -> str:
        return f"what is drawn of {len(self)} parts"


def flow() -> FlowField:
    y, x = np.mgrid[0:145, 0:13].astype(float) / 25
    velocity = np.stack([np.cos(3 * y) + 0.3, np.sin(4 * x)], axis=-1)
    points = np.stack([x + 0.1 * np.sin(y), y], axis=-1)
    land = np.hypot(x - 0.6, y - 1.2) < 0.3
    return FlowField.from_arrays(
        points, velocity, valid=~land, periodic="", scalars={"depth": x * y}
    )


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory, small_tiles: None) -> Path:
    place = tmp_path_factory.mktemp("whole") / "flow.zarr"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 312)
        build(flow(), place, progress=False)
    return place


def drawn(place: Any, keys: list[TileKey] = KEYS) -> Drawn:
    """What pictures are made of; tiles that are told to be broken have none."""
    root = open_store(place)
    pyramid = shared_pyramid(root, "arclength", "pathlines")
    result = Drawn(root=[root.points, root.valid, root.velocity, root.scalars["depth"]])
    result["ranges"] = [np.array([pyramid.ranges["speed", False]])]
    for key in keys:
        try:
            result[key] = tile_of(pyramid, key)
        except PyramidError:
            result[key] = None
    return result


def tile_of(pyramid: Pyramid, key: TileKey) -> list[AnyArray]:
    textures = pyramid.tile(key, [0])
    assert textures is not None
    field = textures.geometry.field  # from which paths are traced
    nodal = (field.points, field.valid, field.velocity[0], field.scalars["depth"][0])
    told = np.array([textures.unit, textures.cell, textures.critical_cell])
    return [told, *nodal]


@pytest.fixture(scope="module")
def truth(whole: Path) -> Drawn:
    return drawn(whole)


def judge(place: Any, truth: Drawn) -> bool:
    """Whether something was told of a store; where nothing was, all has to be right."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            now = drawn(place)
        except FieldError as error:
            assert len(str(error)) < 1000
            return True
    told = bool(caught)
    for name, arrays in now.items():
        if arrays is None:
            told = True
            continue
        for one, other in zip(arrays, truth[name] or [], strict=True):
            assert told or np.array_equal(one, other, equal_nan=one.dtype != bool), name
    return told


def files_of(place: Path, kind: str) -> list[Path]:
    names = [path for path in place.rglob("*") if path.is_file()]
    is_metadata = [path.name == "zarr.json" for path in names]
    return sorted(p for p, known in zip(names, is_metadata, strict=True) if known == (kind == "m"))


@st.composite
def harm(draw: Any) -> tuple[str, float, float, Any]:
    kind = draw(st.sampled_from(["cut", "flip", "delete", "swap", "zeros", "garble", "about"]))
    share = st.floats(0, 1, exclude_max=True)
    return kind, draw(share), draw(share), draw(JSON)


def do_harm(place: Path, kind: str, first: float, second: float, value: Any) -> None:
    """Bring a store to harm, in a place between its first and its last."""
    chunks, metadata = files_of(place, "c"), files_of(place, "m")
    file = chunks[int(first * len(chunks))]
    data = bytearray(file.read_bytes())
    at = int(second * len(data))
    if kind == "cut":
        file.write_bytes(data[:at])
    elif kind == "flip":
        data[at] ^= 1 << int(first * 8)
        file.write_bytes(data)
    elif kind == "delete":
        (chunks + metadata)[int(first * len(chunks + metadata))].unlink()
    elif kind == "zeros":
        file.write_bytes(bytes(len(data)))
    elif kind == "swap":
        array = next(parent for parent in file.parents if parent.name == "c")
        others = sorted(path for path in array.rglob("*") if path.is_file())
        other = others[int(second * len(others))]
        file.write_bytes(other.read_bytes())
        other.write_bytes(data)
    else:
        file = place / "zarr.json" if kind == "about" else metadata[int(first * len(metadata))]
        text = json.loads(file.read_text())
        garble(text["attributes"]["flowtex"] if kind == "about" else text, second, value)
        file.write_text(json.dumps(text))


def garble(text: Any, share: float, value: Any) -> None:
    """Put another value of the same kind, or anything, into JSON."""
    places = []

    def look(inside: Any) -> None:
        for name in inside if isinstance(inside, dict) else range(len(inside)):
            places.append((inside, name))
            if isinstance(inside[name], (dict, list)):
                look(inside[name])

    look(text)
    inside, name = places[int(share * len(places))]
    old = inside[name]
    if type(old) in (int, float) and isinstance(value, (int, float)):
        inside[name] = old + type(old)(1 + abs(hash(value)) % 7)
    else:
        inside[name] = value


@property_test(8)
@given(harm())
def test_harm_is_told_or_does_no_harm(whole: Path, truth: Drawn, harmed: Any) -> None:
    place = whole.parent / "harmed.zarr"
    shutil.rmtree(place, ignore_errors=True)
    shutil.copytree(whole, place)
    do_harm(place, *harmed)
    judge(place, truth)


@pytest.mark.parametrize("array", ["velocity", "points", "valid", "scalars/depth"])
def test_shards_in_each_others_place_are_noticed(whole: Path, truth: Drawn, array: str) -> None:
    place = whole.parent / "swapped.zarr"
    shutil.rmtree(place, ignore_errors=True)
    shutil.copytree(whole, place)
    files = sorted(path for path in (place / "0" / array / "c").rglob("*") if path.is_file())
    if len(files) < 2:
        pytest.skip("there is one shard")
    one, other = files[0].read_bytes(), files[-1].read_bytes()
    files[0].write_bytes(other)
    files[-1].write_bytes(one)
    assert judge(place, truth)


@pytest.mark.parametrize("seal", [False, True])
@property_test(15)
@given(share=st.floats(0, 1, exclude_max=True), value=JSON)
def test_what_is_told_of_a_pyramid_is_checked(
    whole: Path, seal: bool, share: float, value: Any
) -> None:
    about = json.loads((whole / "zarr.json").read_text())["attributes"]["flowtex"]
    before = json.dumps(about, sort_keys=True)
    garble(about, share, value)
    place = whole.parent / "told.zarr"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir()
    text = {"zarr_format": 3, "node_type": "group", "attributes": {"flowtex": about}}
    if seal:
        text["attributes"] = {"flowtex": sealed(about)}
    (place / "zarr.json").write_text(json.dumps(text))
    if seal or json.dumps(about, sort_keys=True) == before:
        with pytest.raises(PyramidError):  # at the latest as there is nothing else
            open_store(place)
    else:
        with pytest.raises(PyramidError, match=r"damaged|has format"):
            Levels(place)


# --- servers ------------------------------------------------------------------------------------


@pytest.fixture
def server(whole: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[RangeServer]:
    monkeypatch.setattr("flowtex.pyramid.places.FIRST_PAUSE_S", 0.01)
    with range_server(whole) as server:
        yield server


@property_test(6)
@given(answers=st.lists(st.sampled_from([200, 403, 404, 500, "cut"]), min_size=1, max_size=9))
def test_a_server_with_faults_is_told_or_does_no_harm(
    whole: Path, truth: Drawn, answers: list[Any]
) -> None:
    with pytest.MonkeyPatch.context() as patch, range_server(whole) as server:
        patch.setattr("flowtex.pyramid.places.FIRST_PAUSE_S", 0.01)
        count = iter(range(10**9))

        def answer() -> Any:
            number = next(count)
            return answers[number % len(answers)] if number % 3 == 0 else 200

        def fault(path: str) -> Any:
            now = answer()
            server.cut = lambda path: now == "cut"
            return now if now in (403, 404, 500) else None

        server.fault = fault
        judge(server.address, truth)


def test_a_store_is_read_from_a_web_server(server: RangeServer, truth: Drawn) -> None:
    assert not judge(server.address, truth)
    assert {method for method, _, _ in server.asked} == {"GET"}


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (403, r"access is denied \(403\); credentials come from the environment"),
        (401, r"access is denied \(401\)"),
        (404, "zarr.json is missing|contains no readable pyramid"),
        (500, "status 500; try again later"),
        (302, "could not be read"),
    ],
)
def test_answers_of_a_server_in_words(server: RangeServer, answer: int, words: str) -> None:
    server.fault = lambda path: answer
    with pytest.raises(PyramidError, match=words) as caught:
        open_store(server.address)
    assert caught.value.__cause__ is None and caught.value.__suppress_context__
    assert "hidden" not in str(caught.value)


def test_a_server_that_is_silent_is_given_up(
    server: RangeServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flowtex.pyramid.places.SILENCE_S", 0.3)
    over = threading.Event()
    server.fault = lambda path: over.wait(PATIENCE_S) and None
    with pytest.raises(PyramidError, match=r"no answer within 0\.3 s; check"):
        open_store(server.address)
    assert server.paths == ["zarr.json"] * 3
    over.set()


def test_what_is_refused_is_missing_in_a_private_bucket(server: RangeServer, truth: Drawn) -> None:
    server.fault = lambda path: 403 if "/c/" in path and path.startswith("0/") else None
    with pytest.raises(PyramidError, match=r"is missing or access is denied \(403\)"):
        shared_pyramid(open_store(server.address), "arclength").tile(TileKey(0, 0, 0), [0])
    assert judge(server.address, truth)


def test_tile_is_read_once(server: RangeServer) -> None:
    pyramid = shared_pyramid(open_store(server.address), "arclength")
    pyramid.tile(TileKey(0, 0, 0), [0])
    server.asked.clear()
    pyramid.tile(TileKey(0, 0, 0), [0])
    assert not server.asked


def test_closing_a_loader_cancels_its_requests(server: RangeServer) -> None:
    loader = TileLoader(shared_pyramid(open_store(server.address), "arclength"))
    over = threading.Event()
    server.fault = lambda path: None if "/c/" not in path else over.wait(PATIENCE_S) and None
    loader.request([TileKey(0, 0, 0)], [0])
    wait_until(lambda: any("/c/" in path for path in server.paths))
    loader.close()
    wait_until(lambda: not loader._running)
    assert not loader.errors and not over.is_set()
    over.set()
