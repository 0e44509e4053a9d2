"""Stores whose codecs would run code when a chunk is decoded are refused by every way in."""

from __future__ import annotations

import gc
import json
import logging
import pickle
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest
from range_server import RangeServer, range_server

from flowtex import FlowField, cli
from flowtex.errors import FieldError
from flowtex.pyramid import build, open_store

zarr = pytest.importorskip("zarr")
xr = pytest.importorskip("xarray")
numcodecs = pytest.importorskip("numcodecs")

from zarr.abc.codec import BytesBytesCodec  # noqa: E402
from zarr.registry import register_codec  # noqa: E402

ROWS, COLUMNS = 6, 9
Document: TypeAlias = dict[str, Any]
#: Name of a codec that touches a file, as a package that is installed may register one.
TOUCHES = "touches-a-file"
PICKLED = [{"id": "vlen-utf8"}, {"id": "pickle", "protocol": 5}]


class Touching:
    """An object whose pickle makes a file when it is loaded."""

    def __init__(self, marker: Path) -> None:
        self.marker = marker

    def __reduce__(self) -> tuple[Callable[..., None], tuple[Path]]:
        return Path.touch, (self.marker,)


class TouchingCodec(BytesBytesCodec):
    """A codec of Zarr 3 that makes a file when it decodes."""

    is_fixed_size = True

    def __init__(self, marker: str) -> None:
        self.marker = marker

    @classmethod
    def from_dict(cls, data: Document) -> TouchingCodec:
        return cls(data["configuration"]["marker"])

    def to_dict(self) -> Document:
        return {"name": TOUCHES, "configuration": {"marker": self.marker}}

    def compute_encoded_size(self, input_byte_length: int, _: Any) -> int:
        return input_byte_length

    async def _decode_single(self, chunk_bytes: Any, chunk_spec: Any) -> Any:
        Path(self.marker).touch()
        return chunk_bytes

    async def _encode_single(self, chunk_bytes: Any, chunk_spec: Any) -> Any:
        return chunk_bytes


@pytest.fixture(autouse=True)
def _codecs_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let both codecs decode, so that only a check before keeps them from it."""
    monkeypatch.setattr(numcodecs.pickles, "ALLOW_UNSAFE_PICKLE_DECODE", True, raising=False)
    register_codec(TOUCHES, TouchingCodec)


@pytest.fixture
def marker(tmp_path: Path) -> Path:
    return tmp_path / "code was run"


@pytest.fixture
def server(tmp_path: Path) -> Iterator[RangeServer]:
    with range_server(tmp_path) as server:
        yield server


def winds(place: Path, version: int, **options: Any) -> None:
    """Write winds on a grid, and a name for each row."""
    wind = np.ones((ROWS, COLUMNS))
    variables = {
        "u": (("lat", "lon"), wind, {"standard_name": "eastward_wind", "units": "m/s"}),
        "v": (("lat", "lon"), wind, {"standard_name": "northward_wind", "units": "m/s"}),
    }
    coordinates = {
        "lat": ("lat", np.linspace(0, 9, ROWS), {"units": "degrees_north"}),
        "lon": ("lon", np.linspace(0, 9, COLUMNS), {"units": "degrees_east"}),
        "place": ("lat", np.array(list("abcdef"), dtype=object)),
    }
    data = xr.Dataset(variables, coordinates)
    data.to_zarr(place, zarr_format=version, consolidated=version == 2, **options)


def change(file: Path, edit: Callable[[Document], None]) -> None:
    document = json.loads(file.read_text())
    edit(document)
    file.write_text(json.dumps(document))


def pickled(marker: Path, entry: Document) -> None:
    """Let an array of Zarr 2 unpickle its chunks."""
    del marker
    entry.update(dtype="|O", filters=PICKLED, compressor=None, fill_value=None)


def pickled_alone(marker: Path, entry: Document) -> None:
    """Let an array of numbers unpickle its chunks, in place of a compressor."""
    del marker
    entry.update(filters=None, compressor={"id": "pickle", "protocol": 5})


def touching(marker: Path) -> Document:
    return {"name": TOUCHES, "configuration": {"marker": str(marker)}}


def in_documents(place: Path, marker: Path) -> None:
    """Change the document of an array, and the consolidated one."""
    change(place / "lat/.zarray", lambda entry: pickled(marker, entry))
    change(place / ".zmetadata", lambda all_: pickled(marker, all_["metadata"]["lat/.zarray"]))


def in_compressor(place: Path, marker: Path) -> None:
    change(place / "lat/.zarray", lambda entry: pickled_alone(marker, entry))
    (place / ".zmetadata").unlink()


def in_consolidated(place: Path, marker: Path) -> None:
    change(place / ".zmetadata", lambda all_: pickled(marker, all_["metadata"]["lat/.zarray"]))


def in_group_entry(place: Path, marker: Path) -> None:
    """Hide the filters in an entry of a group, which Zarr adds to those of the array."""

    def hide(document: Document) -> None:
        hidden: Document = {}
        pickled(marker, hidden)
        document["metadata"]["lat/.zgroup"] = hidden

    change(place / ".zmetadata", hide)


def in_group(place: Path, marker: Path) -> None:
    """Hide the array in the document of the group of Zarr 2."""
    array = json.loads((place / "lat/.zarray").read_text())
    pickled(marker, array)
    array.update(node_type="array", attributes={"_ARRAY_DIMENSIONS": ["lat"]})
    hidden = {"kind": "inline", "must_understand": False, "metadata": {"lat": array}}
    change(place / ".zgroup", lambda group: group.update(consolidated_metadata=hidden))
    (place / ".zmetadata").unlink()


def in_drawn_values(place: Path, marker: Path) -> None:
    """Let the values of a component unpickle, which are read last."""
    change(place / "u/.zarray", lambda entry: pickled_alone(marker, entry))
    change(place / ".zmetadata", lambda all_: pickled_alone(marker, all_["metadata"]["u/.zarray"]))


def in_codecs(place: Path, marker: Path) -> None:
    change(place / "lat/zarr.json", lambda entry: entry["codecs"].append(touching(marker)))


def in_shards(place: Path, marker: Path) -> None:
    def add(entry: Document) -> None:
        inner = {"chunk_shape": [ROWS], "codecs": [{"name": "bytes"}, touching(marker)]}
        inner["index_codecs"] = [{"name": "bytes", "configuration": {"endian": "little"}}]
        entry["codecs"] = [{"name": "sharding_indexed", "configuration": inner}]

    change(place / "lat/zarr.json", add)


def in_consolidated_codecs(place: Path, marker: Path) -> None:
    zarr.consolidate_metadata(place)

    def add(group: Document) -> None:
        group["consolidated_metadata"]["metadata"]["lat"]["codecs"].append(touching(marker))

    change(place / "zarr.json", add)


OLD = [in_documents, in_compressor, in_consolidated, in_group_entry, in_group, in_drawn_values]
NEW = [in_codecs, in_shards, in_consolidated_codecs]


def hostile(place: Path, marker: Path, harm: Callable[[Path, Path], None]) -> None:
    """Write a store that makes a file when its chunks are decoded."""
    winds(place, 2 if harm in OLD else 3)
    payload = pickle.dumps(Touching(marker))
    harm(place, marker)
    if harm in OLD:
        (place / "lat/0").write_bytes(payload)
        (place / "u/0.0").write_bytes(payload)


@pytest.mark.parametrize("harm", [*OLD, *NEW])
@pytest.mark.filterwarnings("ignore:Consolidated metadata:UserWarning")
def test_a_codec_that_is_not_listed_is_refused(
    tmp_path: Path, marker: Path, harm: Callable[[Path, Path], None], server: RangeServer
) -> None:
    place = tmp_path / "winds.zarr"
    hostile(place, marker, harm)
    codec = "pickle" if harm in OLD else TOUCHES
    for read in (FlowField.from_file, open_store, lambda path: build(path, tmp_path / "new")):
        with pytest.raises(FieldError, match=f"the array (lat|u).* has the codec '{codec}'") as one:
            read(place)
        assert str(one.value).startswith(f"{place}: ")
    with pytest.raises(FieldError, match=f"codec '{codec}'|no readable pyramid"):
        open_store(server.address + "winds.zarr")
    assert cli.main(["info", str(place)]) == 2
    assert not marker.exists()


@pytest.mark.parametrize("version", [2, 3])
def test_listed_codecs_are_read(tmp_path: Path, version: int) -> None:
    place = tmp_path / "winds.zarr"
    encoding: dict[str, Any] = {"u": {"compressors": zarr.codecs.ZstdCodec()}}
    if version == 2:
        filters = [numcodecs.Delta("<f8"), numcodecs.Shuffle(8)]
        encoding = {"u": {"filters": filters, "compressors": numcodecs.Blosc()}}
    winds(place, version, encoding=encoding)
    assert FlowField.from_file(place).shape == (ROWS, COLUMNS)
    assert open_store(place).shape == (ROWS, COLUMNS)


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of Zarr 3, with metadata in each array alone."""
    wind = (("lat", "lon"), np.ones((ROWS, COLUMNS)))
    axes = {"lat": np.linspace(10.0, 20.0, ROWS), "lon": np.linspace(10.0, 20.0, COLUMNS)}
    ds = xr.Dataset({"u": wind, "v": wind}, coords=axes)
    ds["lat"].attrs["units"] = "degrees_north"
    ds["lon"].attrs["units"] = "degrees_east"
    path = tmp_path_factory.mktemp("plain") / "wind.zarr"
    ds.to_zarr(path, zarr_format=3, consolidated=False)
    return path


@pytest.mark.parametrize("read", [FlowField.from_file, open_store])
@pytest.mark.parametrize(
    "shape", ["[true, 9]", "[6, true]", "[1.5, 9]", "[0, 9]", "[-6, 9]", '["6", 9]', "true", "{}"]
)
def test_absurd_sizes_of_chunks_are_named(
    plain: Path, read: Callable[[Path], FlowField], shape: str
) -> None:
    document = plain / "u" / "zarr.json"
    whole = document.read_text(encoding="utf-8")
    node = json.loads(whole)
    node["chunk_grid"]["configuration"]["chunk_shape"] = json.loads(shape)
    document.write_text(json.dumps(node), encoding="utf-8")
    try:
        with pytest.raises(FieldError) as raised:
            read(plain)
    finally:
        document.write_text(whole, encoding="utf-8")
    assert f"the array u has the chunk_shape {shape}; expected a list of whole" in str(raised.value)


@pytest.mark.parametrize("read", [FlowField.from_file, open_store])
def test_absurd_attributes_are_an_error_of_ours(
    plain: Path, read: Callable[[Path], FlowField]
) -> None:
    document = plain / "u" / "zarr.json"
    whole = document.read_text(encoding="utf-8")
    node = json.loads(whole)
    node["attributes"]["standard_name"] = [1.5, 9]
    document.write_text(json.dumps(node), encoding="utf-8")
    try:
        with pytest.raises(FieldError, match="unhashable type: 'list'"):
            read(plain)
    finally:
        document.write_text(whole, encoding="utf-8")


@pytest.mark.parametrize("version", [2, 3])
def test_several_refused_arrays_are_one_error(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, version: int
) -> None:
    """Zarr reads them at once, and asyncio prints each error that nobody has taken."""
    wind = np.ones((ROWS, COLUMNS))
    root = zarr.open_group(tmp_path / "winds.zarr", mode="w", zarr_format=version)
    for name in "uvwp":
        array = root.create_array(name, shape=wind.shape, dtype=float)
        array[:] = wind
        document = tmp_path / "winds.zarr" / name / {2: ".zarray", 3: "zarr.json"}[version]
        values = json.loads(document.read_text())
        values["filters"] = values["codecs"] = [{"id": "pickle", "name": TOUCHES}]
        document.write_text(json.dumps(values))
    with caplog.at_level(logging.ERROR, "asyncio"), pytest.raises(FieldError, match="is refused"):
        FlowField.from_file(tmp_path / "winds.zarr")
    gc.collect()
    assert [record.getMessage() for record in caplog.records] == []
