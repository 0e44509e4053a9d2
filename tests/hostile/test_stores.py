"""Stores that are cut, flipped, swapped or packed to burst: found, named and made again."""

from __future__ import annotations

import gzip
import json
import shutil
import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import google_crc32c
import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given
from lying_files import zarr_of_a_size
from range_server import range_server
from store_contents import contents
from strategies import property_test

from flowtex import FlowField, cli
from flowtex.errors import FieldError
from flowtex.pyramid import PyramidError, build, open_store, verify
from flowtex.pyramid.layout import sealed
from flowtex.pyramid.levels import Levels
from flowtex.textures.tiles.pyramid import TileKey

zarr = pytest.importorskip("zarr")

#: A root of 70 by 10 nodes, of which the finest level has 3 tiles and 2 parts.
ROOT_NODES = 1000

Harm = Callable[[Path], None]


def flow() -> FlowField:
    """Two steps on crooked lines, with land and a scalar."""
    y, x = np.mgrid[0:140, 0:20] / 100
    steps = [np.stack([np.cos(3 * y + t), np.sin(4 * x - t)], axis=-1) for t in range(2)]
    return FlowField.from_arrays(
        np.stack([x + 0.1 * y**2, y], axis=-1),
        np.stack(steps),
        times=range(2),
        periodic="",
        valid=np.hypot(x - 0.2, y - 0.1) > 0.05,
        scalars={"heat": x + np.arange(2)[:, None, None]},
    )


@pytest.fixture(autouse=True)
def _small_roots(monkeypatch: pytest.MonkeyPatch, small_tiles: None) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", ROOT_NODES)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory, small_tiles: None) -> Path:
    place = tmp_path_factory.mktemp("whole") / "flow.zarr"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", ROOT_NODES)
        assert build(flow(), place, progress=False).depth == 1
    return place


@pytest.fixture
def copy(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(whole, tmp_path / "flow.zarr"))


def objects_of(store: Path) -> list[Path]:
    """Return the chunks and shards of a store."""
    return sorted(path for path in (store).rglob("c/**/*") if path.is_file())


def first_of_each(store: Path) -> dict[str, Path]:
    """Return one object of each array."""
    found: dict[str, Path] = {}
    for path in objects_of(store):
        found.setdefault(path.relative_to(store).as_posix().partition("/c/")[0], path)
    return found


def cut(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-9])


def flip(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 3] ^= 4
    path.write_bytes(data)


def lengthen(path: Path) -> None:
    path.write_bytes(path.read_bytes() + bytes(9))


HARMS: list[Harm] = [cut, flip, lengthen, Path.unlink]


@pytest.mark.parametrize("first", [0, 2])
def test_what_is_corrupt_is_made_again(whole: Path, copy: Path, first: int) -> None:
    for number, path in enumerate(first_of_each(copy).values(), start=first):
        HARMS[number % len(HARMS)](path)
    assert len(verify(copy, progress=False)) == 4  # parts and tiles of both levels
    assert build(flow(), copy, progress=False).made > 3
    assert verify(copy, progress=False) == []
    assert contents(copy) == contents(whole)


@property_test(4)
@given(share=st.floats(0, 1, exclude_max=True), at=st.floats(0, 1, exclude_max=True))
def test_any_flipped_bit_is_mended(whole: Path, share: float, at: float) -> None:
    place = whole.parent / "flipped.zarr"
    shutil.rmtree(place, ignore_errors=True)
    shutil.copytree(whole, place)
    files = objects_of(place)
    path = files[int(share * len(files))]
    data = bytearray(path.read_bytes())
    data[int(at * len(data))] ^= 1 << int(share * 8)
    path.write_bytes(data)
    build(flow(), place, progress=False)
    assert contents(place) == contents(whole)


def test_swapped_shards_and_changed_metadata_are_made_again(whole: Path, copy: Path) -> None:
    one, other = (copy / f"0/velocity/c/{step}/0/0/0" for step in (0, 1))
    data = one.read_bytes()
    one.write_bytes(other.read_bytes())
    other.write_bytes(data)
    faults = verify(copy, progress=False)
    assert len(faults) == 2
    assert all("differs from what was written" in fault for fault in faults)
    (copy / "1/zarr.json").write_text("{")
    metadata = copy / "0/velocity/zarr.json"
    metadata.write_text(metadata.read_text().replace("float32", "float64"))
    build(flow(), copy, progress=False)
    assert contents(copy) == contents(whole)


def removed(path: Path) -> None:
    path.unlink()


def other_type(path: Path) -> None:
    path.write_text(path.read_text().replace("float32", "float64"))


def other_codec(path: Path) -> None:
    path.write_text(path.read_text().replace("bitshuffle", "noshuffle"))


def no_json(path: Path) -> None:
    path.write_text("{")


GROUPS, ARRAYS = ("0", "1"), ("0/velocity", "1/scalars/heat")


@pytest.mark.parametrize(
    ("harm", "names"),
    [
        (removed, (*GROUPS, *ARRAYS)),
        (no_json, (*GROUPS, *ARRAYS)),
        (other_type, ARRAYS),
        (other_codec, ARRAYS),
    ],
)
def test_missing_and_changed_metadata_are_reported(
    copy: Path, harm: Harm, names: tuple[str, ...]
) -> None:
    for name in names:
        harm(copy / name / "zarr.json")
    faults = verify(copy, progress=False)
    assert len(faults) == len(names)
    for name in names:
        assert any(fault.startswith(f"{name}/zarr.json of {copy} ") for fault in faults)
    assert build(flow(), copy, progress=False).made == 0
    assert verify(copy, progress=False) == []


def test_the_command_says_what_is_corrupt(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["pyramid", str(copy), "--verify"]) == 0
    assert "is whole" in capsys.readouterr().out
    flip(first_of_each(copy)["0/flow"])
    assert cli.main(["pyramid", str(copy), "--verify"]) == 1
    told = capsys.readouterr().err
    assert "tile (0, 0, 0) at step 0" in told and "checksum mismatch" in told
    text = (copy / "zarr.json").read_text()
    (copy / "zarr.json").write_text(text.replace('"depth": 1', '"depth": 0'))
    assert cli.main(["pyramid", str(copy), "--verify"]) == 1
    assert "damaged" in capsys.readouterr().err
    assert cli.main(["pyramid", str(copy.parent), "--verify"]) == 2


def test_a_fault_of_the_network_is_no_damage(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A build must not remove what it could not read."""
    read = zarr.storage.LocalStore.get

    async def refused(self: Any, key: str, *given: Any, **named: Any) -> Any:
        if "/velocity/c/" in key:
            raise PermissionError(13, "denied")
        return await read(self, key, *given, **named)

    before = objects_of(copy)
    monkeypatch.setattr(zarr.storage.LocalStore, "get", refused)
    with pytest.raises(PyramidError, match="cannot be read"):
        verify(copy, progress=False)
    with pytest.raises(PyramidError, match="cannot be read"):
        build(flow(), copy, progress=False)
    assert objects_of(copy) == before


# --- sizes that are declared --------------------------------------------------------------------


class Counted:
    """zlib's unpacking, which counts what comes out of it."""

    def __init__(self) -> None:
        self.sizes: list[int] = []
        self.make = zlib.decompressobj

    def __call__(self, window: int) -> Any:
        unpacking, sizes = self.make(window), self.sizes

        class Unpacking:
            eof = property(lambda _: unpacking.eof)

            def decompress(self, data: bytes, most: int = 0) -> bytes:
                result = unpacking.decompress(data, most)
                sizes.append(len(result))
                return result

        return Unpacking()


def packed(size: int) -> bytes:
    """Return a chunk of zeros, with its check sum."""
    data = gzip.compress(bytes(size))
    return data + struct.pack("<I", google_crc32c.value(data))


@pytest.mark.parametrize("size", [10, 50_000_000])
def test_a_chunk_unpacks_to_what_its_array_declares(
    copy: Path, monkeypatch: pytest.MonkeyPatch, size: int
) -> None:
    declared = zarr.open_array(copy / "0/digests", mode="r").chunks[-1]
    (copy / "0/digests/c/0/0/0/0").write_bytes(packed(size))
    counted = Counted()
    monkeypatch.setattr("flowtex._util.zarr_codecs.zlib.decompressobj", counted)
    (fault,) = verify(copy, progress=False)
    assert f"does not unpack to the {declared:,} bytes that its array declares" in fault
    assert min(size, declared + 1) in counted.sizes
    assert max(counted.sizes) <= max(declared + 1, 64 * 40 * 40 * 8 * 100)


def declared_store(place: Path, about: dict[str, Any], **other: Any) -> Path:
    """A store of metadata alone, whose seal is right."""
    place.mkdir()
    told = {"flowtex": sealed({**about, **other})}
    text = {"zarr_format": 3, "node_type": "group", "attributes": told}
    (place / "zarr.json").write_text(json.dumps(text))
    return place


def test_a_root_of_any_size_is_refused(whole: Path, tmp_path: Path) -> None:
    about = Levels(whole).about
    place = declared_store(tmp_path / "a.zarr", about, nodes=[10**6, 10**6], depth=0)
    with pytest.raises(PyramidError, match=r"damaged \(depth\)"):
        open_store(place)


def test_what_does_not_fit_into_the_memory_is_not_read(
    whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    levels = Levels(whole)
    monkeypatch.setattr("flowtex.pyramid.levels.available_bytes", lambda: 1000)
    with pytest.raises(
        PyramidError, match=r"takes [\d,]+ bytes, but only 1,000 bytes .* available"
    ):
        levels.check_tile(TileKey(0, 0, 0), 0)


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize(
    ("declared", "name"),
    [
        ({"lat": [10**12], "u": [10**12, 9], "v": [10**12, 9]}, "lat|u|v"),
        ({"u": [10**6, 10**6], "v": [10**6, 10**6]}, "u|v"),
    ],
)
def test_a_zarr_of_any_size_is_refused_as_a_source(
    tmp_path: Path, version: int, declared: dict[str, Any], name: str
) -> None:
    path = tmp_path / "flow.zarr"
    zarr_of_a_size(path, version, **declared)
    for read in (FlowField.from_file, lambda file: build(file, tmp_path / "a", progress=False)):
        with pytest.raises(FieldError, match=rf"the variable ({name}) declares \d+ TB"):
            read(path)
    assert not (tmp_path / "a").exists()


def test_a_zarr_of_any_size_at_a_url_is_refused(tmp_path: Path) -> None:
    zarr_of_a_size(tmp_path / "flow.zarr", 2, lat=[10**12], u=[10**12, 9], v=[10**12, 9])
    with range_server(tmp_path) as server, pytest.raises(FieldError, match=r"declares \d+ TB"):
        open_store(server.address + "flow.zarr")


@pytest.mark.parametrize("version", [2, 3])
def test_zarr_with_chunks_of_nothing_is_refused_as_a_source(tmp_path: Path, version: int) -> None:
    path = tmp_path / "flow.zarr"
    zarr_of_a_size(path, version)
    for file in (*path.rglob("zarr.json"), *path.rglob(".z*")):
        text = file.read_text().replace(" ", "").replace("\n", "")
        for key in ('"chunks":[6,9]', '"chunk_shape":[6,9]'):
            text = text.replace(key, key.replace("6", "0"))
        file.write_text(text)
    words = r"the array [uv] has the chunk\w* \[0, 9\]; expected a list"
    with pytest.raises(FieldError, match=words):
        FlowField.from_file(path)


def test_zarr_of_an_impossible_shape_is_refused_as_a_source(tmp_path: Path) -> None:
    zarr_of_a_size(tmp_path / "flow.zarr", 2)
    file = tmp_path / "flow.zarr" / ".zmetadata"
    told = json.loads(file.read_text())
    told["metadata"]["u/.zarray"]["shape"][0] = 10**30
    file.write_text(json.dumps(told))
    with pytest.raises(FieldError, match="its content is invalid"):
        FlowField.from_file(tmp_path / "flow.zarr")
