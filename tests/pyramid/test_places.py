"""Where stores may be, and that no secret in an address is repeated."""

from __future__ import annotations

from pathlib import Path

import pytest
from range_server import range_server

from flowtex import FlowField
from flowtex.errors import FieldError
from flowtex.pyramid import PyramidError, is_store, open_store
from flowtex.pyramid.places import place_text, store_at

pytest.importorskip("zarr")
pytest.importorskip("obstore")


@pytest.mark.parametrize(
    ("place", "text"),
    [
        ("s3://bucket/a.zarr", "s3://bucket/a.zarr"),
        (Path("s3://bucket/a.zarr"), "s3://bucket/a.zarr"),
        ("https://host:8000/a/b.zarr/", "https://host:8000/a/b.zarr"),
        ("abfss://container@account.dfs.core.windows.net/a", None),
        ("file:///data/a.zarr", "/data/a.zarr"),
        ("/data/../data/a.zarr", "/data/a.zarr"),
    ],
)
def test_places(place: str | Path, text: str | None) -> None:
    assert place_text(place) == (place if text is None else text)


@pytest.mark.parametrize(
    "place",
    [
        "https://me:hidden@host/a.zarr",
        "https://hidden@host/a.zarr",
        "https://host/a.zarr?X-Amz-Signature=hidden",
        "s3://bucket/a.zarr#hidden",
        "s3://key:hidden@bucket/a.zarr",
        "abfss://c:hidden@account.dfs.core.windows.net/a",
        "ftp://me:hidden@host/a.zarr",
        "https://[hidden/a.zarr",
    ],
)
def test_secrets_are_refused_and_not_repeated(place: str) -> None:
    for ask in (place_text, open_store, is_store, lambda p: store_at(Path(p))):
        with pytest.raises(PyramidError, match=r"environment|expected") as caught:
            ask(place)
        assert "hidden" not in str(caught.value)
        assert caught.value.__cause__ is None


#: Data at addresses, and words of the error.
DATA = {
    "winds.nc": "Download the file",
    "thredds/dodsC/model/best.ncd": "OPeNDAP",
    "thredds/dodsC/model": "OPeNDAP",
    "winds.grib2": "Download the file",
    "points.csv": "Download the file",
}


@pytest.mark.parametrize("status", [400, 404])
def test_a_url_is_looked_at_before_it_is_called_a_store(tmp_path: Path, status: int) -> None:
    """Other Zarr has no such attribute, and OPeNDAP no such object."""
    with range_server(tmp_path) as server:
        server.fault = lambda path: status
        assert not is_store(server.address)
        server.fault = lambda path: b'{"zarr_format": 3, "node_type": "group", "attributes": {}}'
        assert not is_store(server.address + "other.zarr")
        server.fault = lambda path: b"<html>"
        assert not is_store(server.address)
        server.fault = lambda path: b'{"attributes": {"flowtex": {}}}'
        assert is_store(server.address)
        assert server.paths == ["zarr.json", "other.zarr/zarr.json", "zarr.json", "zarr.json"]
        server.fault = lambda path: 403
        with pytest.raises(PyramidError, match=r"zarr.json is missing or access is denied \(403\)"):
            is_store(server.address)
        server.fault = lambda path: 404
        with pytest.raises(FieldError, match="this address has no flowtex pyramid"):
            FlowField.from_file(server.address + "flow")
        for name, words in DATA.items():
            address = server.address + name
            for ask in (is_store, FlowField.from_file):
                with pytest.raises(FieldError, match=words) as caught:
                    ask(address)
                assert str(caught.value).startswith(f"{address}: only Zarr stores")
                assert f"curl -LO {address}" in str(caught.value) or "dodsC" in name
                assert f'open_dataset("{address}")' in str(caught.value) or "csv" in name
    with pytest.raises(PyramidError, match="no server answers at this address"):
        is_store("http://127.0.0.1:9/flow.zarr")


def test_nothing_is_written_to_the_web() -> None:
    assert not is_store(3) and not is_store("flow.vts")
    with pytest.raises(PyramidError, match="is read-only"):
        store_at("https://host/flow.zarr", read_only=False)
