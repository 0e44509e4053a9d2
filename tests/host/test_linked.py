"""Pages whose tiles lie in a store: what is in them, and which stores and addresses they take."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from page_reader import Reader

from flowtex import FlowField
from flowtex.field import FieldError
from flowtex.host.export import export, page_text, source_of
from flowtex.host.view import web_views
from flowtex.pyramid import build, open_store
from flowtex.pyramid.layout import sealed
from flowtex.scene.options import Options

pytest.importorskip("zarr")

BUCKET = "https://bucket.s3.eu-central-1.amazonaws.com/flow.zarr"


@pytest.fixture(autouse=True)
def _small_roots(monkeypatch: pytest.MonkeyPatch, small_tiles: None) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 1250)
    monkeypatch.setattr("flowtex.host.export.PREVIEW", (24, 16))


def flow(steps: int = 1) -> FlowField:
    y, x = np.mgrid[0:33, 0:75].astype(float) / 25
    velocity = [np.stack([np.cos(3 * y + t), np.sin(4 * x - t)], axis=-1) for t in range(steps)]
    scalars = {"heat": np.stack([x + t for t in range(steps)]), "depth": x * y}
    return FlowField.from_arrays(np.stack([x, y], -1), np.stack(velocity), scalars=scalars)


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory, small_tiles: None) -> Path:
    place = tmp_path_factory.mktemp("store") / "flow.zarr"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 1250)
        build(flow(3), place, progress=False)
    return place


def text_of(store: Path, link: str = BUCKET, **options: Any) -> str:
    text = page_text(web_views(str(store), Options.split(**options)), store=link)
    assert str(store) not in text
    return text


@pytest.mark.parametrize(
    ("address", "source"),
    [
        (BUCKET, "https://bucket.s3.eu-central-1.amazonaws.com"),
        ("http://127.0.0.1:9000/b/flow.zarr/", "http://127.0.0.1:9000"),
        ("HTTPS://Example.org:8443/flow.zarr", "https://example.org:8443"),
        ("./flow.zarr", "'self'"),
        ("store/", "'self'"),
        ("../data/flow.zarr", "'self'"),
    ],
)
def test_the_policy_names_the_server_of_the_store(address: str, source: str) -> None:
    assert source_of(address) == source


@pytest.mark.parametrize(
    "address",
    [
        *("s3://bucket/flow.zarr", "file:///data/flow.zarr", "/data/flow.zarr", "~/flow.zarr", ""),
        *(r"C:\data\flow.zarr", r"\\host\flow.zarr", "//example.org/flow.zarr"),
        *("localhost:9000/flow.zarr", "javascript:alert(1)", "https:///flow.zarr"),
        *("https://exa'mple.org;script-src/flow.zarr", "https://example.org:port/flow.zarr"),
    ],
)
def test_what_no_browser_reads_is_refused(address: str) -> None:
    with pytest.raises(
        FieldError, match="expected the address from which a browser reads the store"
    ):
        source_of(address)


@pytest.mark.parametrize(
    "address",
    [
        "https://user:geheim@example.org/flow.zarr",
        "https://geheim@example.org/flow.zarr",
        BUCKET + "?X-Amz-Credential=geheim&X-Amz-Signature=geheim",
        BUCKET + "?token=geheim",
        "./flow.zarr?AccessKey=geheim",
        BUCKET + "#geheim",
    ],
)
def test_what_is_secret_never_enters_a_page(address: str, store: Path, tmp_path: Path) -> None:
    with pytest.raises(FieldError, match="everyone could read in the page") as told:
        export(str(store), tmp_path / "page.html", store=address)
    assert "geheim" not in str(told.value)
    assert not (tmp_path / "page.html").exists()


def test_a_page_has_the_root_and_one_moment(store: Path) -> None:
    read = Reader(text_of(store, scalars="depth"))
    assert f"connect-src {BUCKET.rsplit('/', 1)[0]};" in read.policy
    own = open_store(store)
    assert read.header()["store"] == {
        "url": BUCKET,
        "format": read.header()["store"]["format"],
        "fingerprint": read.header()["store"]["fingerprint"],
        "parameter": "arclength",
        "lines": "streamlines",
        "depth": 1,
        "derivesSpeed": True,
        "steps": [0, 1, 2],
    }
    assert own.name == read.header()["name"]
    assert (read.header()["pyramid"]["finest"], read.header()["slices"]["steps"]) == (0, 3)
    kinds = [name for name in read.names() if "/" in name]
    assert sorted(kinds) == ["flow/0", "flow/1", "scalars/0/2"]
    assert not [name for name in read.names() if name.startswith("tile")]
    some = Reader(text_of(store, scalars="heat"))
    assert sorted(name for name in some.names() if "sca" in name) == ["scalars/0/1", "scalars/1/1"]


def test_a_page_of_some_steps_and_of_two_views(store: Path) -> None:
    views = web_views(str(store), Options.split(beside={"lod": False}), steps=2)
    text = page_text(views, store="./flow.zarr")
    read = Reader(text)
    assert "connect-src 'self';" in read.policy
    assert read.header()["store"]["steps"] == [0, 2]
    assert read.names().count("flow/1") == 2
    assert "connect-src" not in page_text(web_views(str(store), Options.split(samples=5)))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"image": np.ones((2, 2))}, "with noise 'image'"),
        ({"parameter": "time"}, "expected 'time' along"),
        ({"lines": "pathlines"}, "along streamlines; expected .* along pathlines"),
    ],
)
def test_what_the_store_has_not_is_refused(
    store: Path, options: dict[str, Any], words: str
) -> None:
    with pytest.raises(FieldError, match=words):
        text_of(store, **options)


def test_a_flow_that_is_in_no_store_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FieldError, match=r"`flowtex pyramid FILE -o flow\.zarr` and export that"):
        export(flow(), tmp_path / "page.html", store=BUCKET)


def test_a_store_that_is_not_whole_is_told(tmp_path: Path) -> None:
    import zarr

    build(flow(), tmp_path / "a.zarr", progress=False)
    group = zarr.open_group(tmp_path / "a.zarr", mode="r+")
    told: Any = group.attrs["flowtex"]
    group.attrs["flowtex"] = sealed({**told, "complete": False})
    with pytest.warns(UserWarning, match="incomplete"):
        text_of(tmp_path / "a.zarr")
