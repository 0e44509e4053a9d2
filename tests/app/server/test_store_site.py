"""What a page of a pyramid is handed, what not, and to whom."""

from __future__ import annotations

import asyncio
import json
import re
import shutil
import signal
import urllib.request
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("zarr")
pytest.importorskip("obstore")
pytest.importorskip("aiohttp")
pytest.importorskip("wslink")

from aiohttp import ClientResponse
from aiohttp.test_utils import TestClient, TestServer
from page_reader import Reader
from served import start

from flowtex import FlowField
from flowtex.app.server.store_site import ServedStore, store_application
from flowtex.pyramid import build

TILE = "0/flow/c/0/1/0/0"


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    y, x = np.mgrid[0:400, 0:90].astype(float) / 100
    velocity = np.stack([np.cos(3 * y) + 0.3, np.sin(4 * x)], axis=-1)
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), velocity, periodic="")
    place = tmp_path_factory.mktemp("served") / "flow.zarr"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 4000)
        build(field, place, progress=False)
    return place


Client = TestClient[Any, Any]


def visit(store: Path, token: str, ask: Callable[[Client, str], Awaitable[None]]) -> None:
    """Ask a server, which has the store at an address."""

    async def run() -> None:
        served = ServedStore(store)
        server = TestServer(store_application(served, "<p>A page", token))
        async with TestClient(server) as client:
            await ask(client, f"/{token}/store/{served.run}")

    asyncio.run(run())


async def text_of(answer: ClientResponse) -> str:
    return (await answer.read()).decode()


def test_only_the_whole_address_opens(store: Path) -> None:
    async def ask(client: Client, at: str) -> None:
        wrong = f"{at}/zarr.json".replace("word", "wrong")
        for path in ("/", "/wrong/", wrong, "/wrong"):
            answer = await client.get(path)
            assert answer.status == 403 and "complete address" in await text_of(answer)
        assert (await client.get(wrong.removeprefix("/wrong"))).status in (403, 404)
        page = await client.get("/word")  # leads to the folder, so that relative addresses hold
        assert str(page.url).endswith("/word/") and await text_of(page) == "<p>A page"
        assert page.headers["Referrer-Policy"] == "no-referrer"
        answer = await client.get(f"{at}/zarr.json", headers={"Origin": "http://evil.example"})
        assert answer.status == 403
        led_here = {"Host": "evil.example", "Origin": "http://evil.example"}
        assert (await client.get(f"{at}/zarr.json", headers=led_here)).status == 403
        for method in ("PUT", "POST", "DELETE", "PATCH", "OPTIONS"):
            assert (await client.request(method, f"{at}/zarr.json")).status == 405
        told = json.loads(await text_of(await client.get(f"{at}/zarr.json")))
        assert told["attributes"]["flowtex"]["depth"] == 2

    visit(store, "word", ask)


NO_NAMES = [
    *("", "..", "../a.zarr/zarr.json", "/etc/passwd", "0", "0/flow", "0/flow/c", "c/0"),
    *("0/velocity/c/0/0", "0/velocity/c/0/0/0/0/0", "0/velocity/c/0/0/0/-1", "0/nothing/c/0"),
    *("0/velocity/c/0/0/../0", "0/velocity/c/0/0/0/٣", "0/velocity/c/0/99/0/0"),
    *("0/flow/c/0/99/0/0", "0/flow/c/5/0/0/0", "9/zarr.json", "building.json"),
    f"0/velocity/c/0/0/0/{'1' * 5000}",
]


def test_no_name_leads_elsewhere(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    served = ServedStore(store)
    for path in store.rglob("*"):
        # Those of ranges are for who builds.
        if path.is_file() and "samples" not in path.parts:
            name = path.relative_to(store).as_posix()
            assert asyncio.run(served.get(name)) == path.read_bytes()
    monkeypatch.setattr(served, "_reads", None)  # nothing is looked for
    for name in NO_NAMES:
        with pytest.raises(LookupError):
            asyncio.run(served.get(name))


def test_links_out_of_a_store_are_not_followed(store: Path, tmp_path: Path) -> None:
    place, secret = tmp_path / "a.zarr", tmp_path / "secret"
    shutil.copytree(store, place)
    secret.write_bytes(b"secret")
    served = ServedStore(place)
    (place / TILE).unlink()
    (place / TILE).symlink_to(secret)
    with pytest.raises(LookupError):
        asyncio.run(served.get(TILE))
    (place / TILE).unlink()
    (place / TILE).symlink_to(store / TILE)
    secret.unlink()
    secret.symlink_to(store)
    assert asyncio.run(ServedStore(secret).get(TILE)) == (store / TILE).read_bytes()


def test_nothing_else_is_found(store: Path) -> None:
    async def ask(client: Client, at: str) -> None:
        for name in ("..%2fzarr.json", "%2e%2e/%2e%2e/etc/passwd", "0/flow/c/0/99/0/0", "x"):
            assert (await client.get(f"{at}/{name}")).status == 404

    visit(store, "word", ask)


def test_what_a_browser_keeps_is_of_one_run(store: Path) -> None:
    places: list[str] = []

    async def ask(client: Client, at: str) -> None:
        answer = await client.get(f"{at}/1/velocity/c/0/0/0/0")
        assert answer.headers["Cache-Control"] == "private, max-age=3600"
        if places:
            assert (await client.get(f"{places[0]}/1/velocity/c/0/0/0/0")).status == 404
        places.append(at)

    visit(store, "word", ask)
    visit(store, "word", ask)
    assert places[0] != places[1]


@pytest.mark.slow
def test_the_shell_serves_a_store(store: Path, tmp_path: Path) -> None:
    word = tmp_path / "word"
    word.write_text("0123456789-abcde_\n")
    served = start("serve", str(store), "--token-file", str(word))
    try:
        assert served.address.endswith("/0123456789-abcde_/")
        with urllib.request.urlopen(served.address) as answer:
            address = str(Reader(answer.read().decode()).header())
            (found,) = re.findall(r"'(store/[^']+/)'", address)
        place = f"{served.address}{found}"
        with urllib.request.urlopen(f"{place}{TILE}") as answer:
            assert len(answer.read()) > 10_000
    finally:
        said = served.end(signal.SIGINT)
    assert served.process.returncode == 0 and "Traceback" not in said
